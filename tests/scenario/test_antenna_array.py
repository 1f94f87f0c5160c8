"""Arrays of dipoles."""

import pytest

from nullpose.scenario import Airframe, Array, Scenario
from scenes import require_fault, small

GOOD = {"elements": 4, "layout": "linear", "spacing_wavelengths": 0.5}


def test_values() -> None:
    """An array keeps what was stated; a number of elements is whole, however it was written."""
    array = Array.from_dict(GOOD | {"elements": 4.0})
    assert type(array.elements) is int
    assert array.to_dict() == GOOD


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("elements", 0, "got 0, must be a number of elements from 1 to 64"),
        ("elements", 65, "got 65"),
        ("elements", 2.5, "got 2.5, must be a whole number"),
        ("elements", "4", "write it without quotes"),
        ("elements", True, "got the truth value true"),
        ("elements", float("nan"), "got NaN"),
        ("layout", "ring", 'must be a layout: "linear" or "circular"'),
        ("layout", "Linear", 'did you mean "linear"?'),
        ("combining", "analogue", "must be digital combining, which nullpose solves with a bound"),
        ("spacing_wavelengths", 0.0, "got 0.0, must be a length in wavelengths"),
        ("spacing_wavelengths", float("inf"), "half a wavelength is 0.5"),
    ],
)
def test_faults(key: str, value: object, words: str) -> None:
    """Each number out of range, and each word that is no layout, is refused at its key."""
    require_fault(lambda: Array.from_dict(GOOD | {key: value}), key, words)


def test_an_array_stands_upright() -> None:
    """An array goes with a level vehicle and an upright dipole only, which may be said."""
    assert Scenario.from_dict(small(array=GOOD, airframe=Airframe(preset="level"))).array == Array(**GOOD)
    for airframe in (Airframe(tilt_max_deg=10), Airframe(preset="level", mount_deg=90)):
        data = small(array=GOOD, airframe=airframe)
        require_fault(lambda data=data: Scenario.from_dict(data), "array", "remove either table")
