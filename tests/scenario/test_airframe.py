"""Which axes an airframe reaches."""

import math
import re

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.errors import ScenarioError
from nullpose.scenario import Airframe, Scenario, apply_overrides
from nullpose.scenario.airframe import PRESET_TILTS_DEG

tilts = st.floats(0.0, 180.0)
mounts = st.floats(0.0, 90.0)


@given(tilt=tilts, mount=mounts, seed=st.integers(0, 2**32 - 1))
def test_every_attitude_puts_the_dipole_in_the_band(tilt: float, mount: float, seed: int) -> None:
    """However the vehicle yaws and tilts within its limit, the dipole's u_z^2 lies in the band."""
    rng = np.random.default_rng(seed)
    body = Rotation.from_euler("z", rng.uniform(-np.pi, np.pi, (200, 1)))
    heading = rng.uniform(-np.pi, np.pi, 200)
    lean = np.radians(tilt) * rng.uniform(0.0, 1.0, 200)
    tilting = Rotation.from_rotvec(
        np.stack([np.cos(heading), np.sin(heading), np.zeros(200)], axis=1) * lean[:, None]
    )
    axes = (tilting * body).apply([math.sin(math.radians(mount)), 0.0, math.cos(math.radians(mount))])
    low, high = Airframe(tilt_max_deg=tilt, mount_deg=mount).axis_band
    assert 0.0 <= low <= high <= 1.0
    assert (axes[:, 2] ** 2 >= low - 1e-12).all()
    assert (axes[:, 2] ** 2 <= high + 1e-12).all()


@pytest.mark.parametrize(
    ("airframe", "band"),
    [
        (Airframe(preset="omnidirectional"), (0.0, 1.0)),
        (Airframe(preset="omnidirectional", mount_deg=37.0), (0.0, 1.0)),
        (Airframe(preset="level"), (1.0, 1.0)),
        (Airframe(preset="level", mount_deg=90.0), (0.0, 0.0)),
        (Airframe(tilt_max_deg=90.0), (0.0, 1.0)),
        (Airframe(tilt_max_deg=45.0, mount_deg=45.0), (0.0, 1.0)),
        (Airframe(preset="hexarotor-tilted-30"), (0.75, 1.0)),
        (Airframe(tilt_max_deg=10.0, mount_deg=90.0), (0.0, math.sin(math.radians(10.0)) ** 2)),
    ],
)
def test_known_bands(airframe: Airframe, band: tuple[float, float]) -> None:
    """The ends are exact at 0 and 90 degrees; all of [0, 1] is what omnidirectional means."""
    assert airframe.axis_band == pytest.approx(band, rel=1e-15, abs=0.0)
    assert airframe.is_omnidirectional is (band == (0.0, 1.0))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({}, "neither preset nor tilt_max_deg"),
        ({"preset": "level", "tilt_max_deg": 0.0}, "both preset and tilt_max_deg"),
        ({"tilt_max_deg": -1e-9}, "reaches no axis"),
        ({"tilt_max_deg": 180.5}, "from 0 to 180"),
        ({"tilt_max_deg": math.nan}, "got NaN"),
        ({"tilt_max_deg": 1.0, "mount_deg": 90.5}, "from 0 to 90"),
        ({"tilt_max_deg": 1.0, "mount_deg": -1.0}, "0 is along the body's vertical"),
        ({"preset": "quadcopter"}, 'or "omnidirectional"; did you mean "quadrotor"?'),
        ({"preset": 3}, 'got 3, must be a preset: "level" or "quadrotor" or'),
    ],
)
def test_airframes_that_are_none(values: dict[str, object], words: str) -> None:
    """A tilt that is no angle, two tilts, or none, are refused in plain words."""
    with pytest.raises(ScenarioError, match=re.escape(words)):
        Airframe.from_dict(values)


@pytest.mark.parametrize("name", PRESET_TILTS_DEG)
def test_a_name_stands_for_the_airframe(name: str) -> None:
    """``airframe = "quadrotor"`` is the preset of that name, from a file or an override, with its tilt."""
    free = Scenario.from_arrays([[0, 0, 0]], noise_w=1e-3, altitude_m=(8, 30))
    named = Scenario.from_dict(free.to_dict() | {"airframe": name})
    assert named.airframe == Airframe(preset=name)
    assert apply_overrides(free, [f"airframe={name}"]) == named == Scenario.from_dict(named.to_dict())
    assert math.degrees(named.airframe.tilt_max_rad) == pytest.approx(PRESET_TILTS_DEG[name])


def test_an_airframe_of_no_name_is_refused() -> None:
    """A misspelt name is met with the names there are."""
    free = Scenario.from_arrays([[0, 0, 0]], noise_w=1e-3, altitude_m=(8, 30))
    with pytest.raises(ScenarioError, match=r'or a name: "level" or .*did you mean "quadrotor"'):
        Scenario.from_dict(free.to_dict() | {"airframe": "quadroter"})
