"""Many poses at once: the same numbers as one at a time."""

import time
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose import NullposeError
from nullpose.physics import Pose, Poses, evaluate, min_margin, min_secrecy_rate, min_sinr
from nullpose.scenario import Airframe, Antenna, Scenario, apply_overrides


def _random_poses(rng: np.random.Generator, count: int, mount_rad: float = 0.0) -> Poses:
    places = rng.uniform([-20.0, -20.0, 8.0], [80.0, 80.0, 30.0], (count, 3))
    return Poses(places, *rng.uniform(-3.0, 3.0, (3, count)), mount_rad)


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 5), mount_rad=st.floats(0.0, 1.5))
def test_each_pose_has_its_own_value(seed: int, count: int, mount_rad: float, random_scene: Callable) -> None:
    """The smallest SINR, the smallest margin and every link are those of each pose alone."""
    rng = np.random.default_rng(seed)
    scene = apply_overrides(random_scene(rng, 3, 2), ["nodes.S2.weight=2"])
    poses = _random_poses(rng, count, mount_rad)
    table = evaluate(scene, poses)
    assert table["sinr_db"].shape == (count, 3)
    for index in range(count):
        one = poses[index]
        assert isinstance(one, Pose)
        assert min_sinr(scene, poses)[index] == pytest.approx(min_sinr(scene, one), rel=1e-12)
        assert min_margin(scene, poses)[index] == pytest.approx(min_margin(scene, one), rel=1e-12)
        for node, link in enumerate(evaluate(scene, one)):
            for name in ("sinr", "sinr_db", "margin", "margin_db"):
                assert table[name][index, node] == pytest.approx(getattr(link, name), rel=1e-9, abs=1e-9)


def test_the_downlink_and_a_pattern(paper: Scenario) -> None:
    """Secrecy rates, and an antenna that is no short dipole, agree with one at a time too."""
    poses = _random_poses(np.random.default_rng(1), 20)
    changes = ["transmitter.power_w=2", "eavesdroppers=[{position_m = [-20, 15, 4]}]"]
    secret = apply_overrides(paper, ["objective=secrecy-rate", *changes])
    expected = [min_secrecy_rate(secret, pose) for pose in poses]
    np.testing.assert_allclose(min_secrecy_rate(secret, poses), expected, rtol=1e-9)
    rates = evaluate(secret, poses)["secrecy_rate_bps_hz"]
    np.testing.assert_allclose(rates.min(axis=-1), expected, rtol=1e-9)
    vehicle = Airframe(tilt_max_deg=30.0, mount_deg=40.0)
    half = paper.model_copy(update={"antenna": Antenna(kind="half-wave"), "airframe": vehicle})
    leaning = _random_poses(np.random.default_rng(2), 20, vehicle.mount_rad)
    np.testing.assert_allclose(min_sinr(half, leaning), [min_sinr(half, pose) for pose in leaning], rtol=1e-9)


def test_a_million_poses_take_seconds(paper: Scenario) -> None:
    """Not the minutes of a loop in Python, on the paper's scene; the blocks' borders leave nothing out."""
    poses = _random_poses(np.random.default_rng(3), 10**6)
    began = time.process_time()
    values = min_sinr(paper, poses)
    assert time.process_time() - began < 10.0
    assert values.shape == (10**6,)
    for index in (0, 8191, 8192, 999_999):
        assert values[index] == pytest.approx(min_sinr(paper, poses[index]), rel=1e-12)


def test_one_number_stands_for_all(paper: Scenario) -> None:
    """One position goes with many attitudes, and one angle with many positions."""
    rolls = np.linspace(-1.0, 1.0, 7)
    here = Poses([3.0, 24.0, 9.0], rolls, -1.1)
    assert len(here) == 7
    assert here[2] == Pose([3.0, 24.0, 9.0], rolls[2], -1.1)
    axes = np.array([[1.0, 0.0, 0.2], [0.0, 1.0, 0.2]])
    along = Poses.from_axis([3.0, 24.0, 9.0], axes)
    assert along[1] == Pose.from_axis([3.0, 24.0, 9.0], axes[1])
    assert min_sinr(paper, Poses(np.zeros((0, 3)), 0.0, 0.0)).shape == (0,)


@pytest.mark.parametrize(
    ("position_m", "roll_rad", "told"),
    [
        (np.zeros((4, 2)), 0.0, r"position_m of shape \(4, 2\)"),
        (np.zeros((4, 3)), np.zeros(3), r"roll_rad of shape \(3,\)"),
        (np.zeros((4, 3)), np.zeros((4, 1)), r"allowed: position_m of shape \(n, 3\)"),
        (np.full((4, 3), np.nan), 0.0, "not finite"),
    ],
)
def test_shapes_that_do_not_go_together(position_m: np.ndarray, roll_rad: np.ndarray, told: str) -> None:
    """The message names the shapes that were given and those that are allowed."""
    with pytest.raises(NullposeError, match=told):
        Poses(position_m, roll_rad, 0.0)
