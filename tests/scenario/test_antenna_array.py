"""Arrays of dipoles."""

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Airframe, Array, Scenario

GOOD = {"elements": 4, "layout": "linear", "spacing_wavelengths": 0.5}


def test_values() -> None:
    """An array keeps what was stated; a number of elements is whole, however it was written."""
    array = Array.from_dict(GOOD | {"elements": 4.0})
    assert (array.elements, array.layout, array.spacing_wavelengths) == (4, "linear", 0.5)
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
    with pytest.raises(ScenarioError) as caught:
        Array.from_dict(GOOD | {key: value})
    (fault,) = caught.value.faults
    assert fault.path == key
    assert words in fault.message


def scene(**tables: object) -> Scenario:
    """Returns a scene with an array and other tables."""
    return Scenario(
        airspace={"altitude_m": [8, 30]},
        receiver={"noise_w": 1e-3, "reference_gain_db": 0.0},
        nodes=[{"position_m": [0, 0, 0], "power_w": 1}],
        array=GOOD,
        **tables,
    )


def test_an_array_stands_upright() -> None:
    """An array goes with a level vehicle and an upright dipole only, which may be said."""
    assert scene().array == Array(**GOOD)
    assert scene(airframe=Airframe(preset="level")).airframe is not None
    for airframe in (Airframe(tilt_max_deg=10), Airframe(preset="level", mount_deg=90)):
        with pytest.raises(ScenarioError) as caught:
            scene(airframe=airframe)
        (fault,) = caught.value.faults
        assert fault.path == "array"
        assert "remove either table" in fault.message
