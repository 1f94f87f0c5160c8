"""The least tilt that suffices: two proved sides, checked by solves with that tilt and by brute force."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import and_slow, few_examples

import nullpose
from nullpose import Scenario
from nullpose.errors import UsageError
from nullpose.physics import objective_value
from nullpose.study.least_tilt import LeastTilt, MountTilt, least_tilt, values_by_angle
from scenes import EXAMPLES


def with_vehicle(scenario: Scenario, tilt_deg: float, mount_deg: float) -> Scenario:
    """Put a vehicle into a scene."""
    airframe = {"tilt_max_deg": tilt_deg, "mount_deg": mount_deg}
    return Scenario.from_dict(scenario.to_dict() | {"airframe": airframe})


def field(seed: int, whips: bool = False) -> Scenario:
    """Return a random scene of 2 to 4 nodes and 1 or 2 jammers."""
    rng = np.random.default_rng(seed)
    nodes, jammers = int(rng.integers(2, 5)), int(rng.integers(1, 3))
    points_m = np.column_stack([rng.uniform(0.0, 60.0, (nodes + jammers, 2)), np.ones(nodes + jammers)])
    scenario = Scenario.from_arrays(points_m[:nodes], points_m[nodes:], noise_w=1e-3, altitude_m=(8, 40))
    if not whips:
        return scenario
    plain = scenario.to_dict()
    return Scenario.from_dict(
        plain
        | {kind: [point | {"antenna": "dipole"} for point in plain[kind]] for kind in ("nodes", "jammers")}
    )


def checked(scenario: Scenario, found: LeastTilt, mount: MountTilt, apart_deg: float = 0.1) -> None:
    """Check both sides of a mount by solves with the tilt stated."""
    assert mount.suffices_deg is not None
    enough = nullpose.solve(
        with_vehicle(scenario, mount.suffices_deg, mount.mount_deg), gap=1e-6, certify=False
    )
    assert enough.objective.value >= found.target * (1.0 - 1e-6)
    assert mount.pose is not None
    assert math.degrees(mount.pose.tilt_rad) <= mount.suffices_deg + 1e-6
    if mount.fails_deg is not None:
        assert mount.suffices_deg - mount.fails_deg <= apart_deg + 1e-9
        assert mount.upper_bound is not None
        assert mount.upper_bound < found.target
        little = nullpose.solve(
            with_vehicle(scenario, mount.fails_deg, mount.mount_deg), gap=1e-6, certify=False
        )
        assert little.objective.value < found.target


@pytest.mark.parametrize(
    ("file", "power_w"),
    and_slow([("paper.toml", 100.0), ("whips.toml", 1.0)], [("paper.toml", 0.01), ("paper.toml", 1.0)]),
)
def test_both_sides_hold_in_the_examples(file: str, power_w: float) -> None:
    """With the tilt that suffices a solve reaches the target, and with the one below it none does."""
    scenario = nullpose.load(EXAMPLES / file, overrides=[f"jammers.M.power_w={power_w}"])
    found = least_tilt(scenario)
    for mount in found.mounts:
        checked(scenario, found, mount)
    assert found.best is not None
    assert found.best.suffices_deg == 0.0
    checked(scenario, found, found.best)


@pytest.mark.parametrize("seed", and_slow([2], [1, 3]))
def test_no_pose_of_a_grid_reaches_the_target_with_too_little_tilt(seed: int) -> None:
    """Positions and axes at random, those that the vehicle reaches: all below the bound."""
    scenario, rng = field(seed, whips=seed == 2), np.random.default_rng(seed)
    found = least_tilt(scenario, share=0.9)
    positions_m = rng.uniform([-20.0, -20.0, 8.0], [80.0, 80.0, 40.0], (20_000, 3))
    away_m = np.linalg.norm(positions_m[:, None] - scenario.source_positions_m, axis=-1)
    positions_m = positions_m[away_m.min(axis=1) >= 1.0]
    for mount in found.mounts:
        if mount.fails_deg is not None and mount.upper_bound is not None:
            ends_deg = np.clip(mount.mount_deg + np.array([-1.0, 1.0]) * mount.fails_deg, 0.0, 90.0)
            angle = np.radians(rng.uniform(*ends_deg, len(positions_m)))
            turn = rng.uniform(0.0, 2.0 * math.pi, len(positions_m))
            axes = np.column_stack(
                [np.sin(angle) * np.cos(turn), np.sin(angle) * np.sin(turn), np.cos(angle)]
            )
            assert objective_value(scenario, positions_m, axes).max() <= mount.upper_bound


@few_examples(2)
@given(seed=st.integers(0, 10_000), whips=st.booleans())
def test_more_is_asked_for_more_and_the_best_mount_asks_for_least(seed: int, whips: bool) -> None:
    """A larger share never needs less tilt; no stated mount needs less than the best one."""
    scenario = field(seed, whips)
    some, more = (
        least_tilt(scenario, share=share, mounts_deg=[0.0, 90.0], node_limit=50_000) for share in (0.9, 0.999)
    )
    for less, larger in zip(some.mounts, more.mounts, strict=True):
        assert (less.suffices_deg or 0.0) <= (larger.suffices_deg or 0.0) + 0.1 + 1e-9
    for found in (some, more):
        assert found.best is not None
        assert found.best.suffices_deg is not None
        assert all(found.best.suffices_deg <= (mount.suffices_deg or 0.0) for mount in found.mounts)


@pytest.mark.parametrize("seeds", and_slow([range(3)], [range(3, 50)]))
def test_nearly_all_of_the_value_takes_the_tilt_of_the_best_pose(seeds: range) -> None:
    """Both sides agree with solve; less is asked for less; no stated mount needs less than the best one."""
    for seed in seeds:
        rng = np.random.default_rng(seed)
        points_m = np.column_stack([rng.uniform(0.0, 60.0, (3, 2)), np.ones(3)])
        scenario = Scenario.from_arrays(points_m[:2], points_m[2:], noise_w=1e-3, altitude_m=(8, 40))
        mount_deg = float(rng.choice([0.0, 45.0, 90.0]))
        more, less = (
            least_tilt(scenario, share=share, mounts_deg=[mount_deg], threads=1)
            for share in (1.0 - 1e-6, 0.9)
        )
        (mount,), (easier,) = more.mounts, less.mounts
        checked(scenario, more, mount, apart_deg=0.5)  # the value hardly changes with the tilt there
        assert more.best is not None
        assert more.best.suffices_deg is not None
        assert mount.suffices_deg is not None
        assert easier.suffices_deg is not None
        assert max(more.best.suffices_deg, easier.suffices_deg) <= mount.suffices_deg
        best = nullpose.solve(scenario, gap=1e-8).objective
        assert more.omnidirectional.objective.value == pytest.approx(best.value, rel=1e-7)


def test_values_by_angle_are_what_level_vehicles_reach() -> None:
    """Their largest is the omnidirectional value, at the angle of the best pose."""
    found = least_tilt(nullpose.load(EXAMPLES / "paper.toml"), mounts_deg=[])
    angles_deg, values = values_by_angle(found)
    assert values.max() == pytest.approx(found.omnidirectional.objective.value, rel=1e-3)
    assert angles_deg[np.argmax(values)] == pytest.approx(79.6, abs=2.0)
    assert values[0] == pytest.approx(
        nullpose.solve(found.omnidirectional.scenario, "vertical").objective.value
    )


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"share": 0.0}, r"share \(--reach\): given 0.0; allowed: above 0 to 1"),
        ({"share": 1.5}, r"share \(--reach\): given 1.5; allowed: above 0 to 1"),
        ({"mounts_deg": [91.0]}, "mount: given 91.0 degrees; allowed: 0"),
    ],
)
def test_what_is_not_allowed_is_refused(options: dict[str, float], message: str) -> None:
    """By name, with what is allowed."""
    with pytest.raises(UsageError, match=message):
        least_tilt(nullpose.load(EXAMPLES / "paper.toml"), **options)  # type: ignore[arg-type]
