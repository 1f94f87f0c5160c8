"""The best pose for an antenna with any pattern."""

import math
from typing import Any

import numpy as np
import pytest
from sizes import and_slow

from nullpose import Scenario, apply_overrides, compare, load, solve, solve_many
from nullpose.antenna.harmonics import directions, fit
from nullpose.antenna.table import PatternTable
from nullpose.errors import UsageError
from nullpose.physics import Pose, evaluate, min_sinr
from nullpose.problem.build import build_family
from nullpose.solver.certificate_from_proof import certificate_of, verified
from nullpose.solver.options import SolveOptions
from nullpose.solver.pattern import PatternRun, reach_of

PAPER = load("examples/paper.toml")


def pattern_rows(function: Any, degree: int) -> list[list[float]]:
    """Return the harmonics of a gain given by x, y and z."""
    grid = np.arange(0.0, 181.0, 5.0), np.arange(0.0, 360.0, 5.0)
    gain = function(*np.moveaxis(directions(*grid), -1, 0))
    table = PatternTable(theta_deg=grid[0], phi_deg=grid[1], gain=gain)
    return fit(table, degree).rows()


def lobed(x: Any, y: Any, z: Any) -> Any:
    """Return a pattern of degree 4 without symmetry."""
    return (1.0 - z**2) * (1.0 + 0.3 * x + 0.2 * y * z) + 0.01 + 0.05 * x**2 * z**2


UNEVEN = [[1.0], [-0.3, 0.0, 0.0], [0.25, 0.0, 0.0, 0.0, 0.0]]
"""A gain that is the same all round, but not upside down."""


def with_antenna(scenario: Scenario, antenna: dict[str, Any], power_w: float = 1.0) -> Scenario:
    """Return a scenario with another antenna, and the jammer's power."""
    return apply_overrides(
        Scenario.from_dict(scenario.to_dict() | {"antenna": antenna}), [f"jammers.M.power_w={power_w}"]
    )


@pytest.mark.parametrize(("power_w", "value"), [(0.01, 1.444305), (1.0, 1.242530), (100.0, 1.150646)])
def test_half_wave(power_w: float, value: float) -> None:
    """The paper's scene with a half-wave dipole: known values, certified to 1e-3."""
    result = solve(with_antenna(PAPER, {"kind": "half-wave"}, power_w))
    assert result.status == "certified"
    assert result.objective.relative_gap <= 1e-3
    assert result.objective.value == pytest.approx(value, abs=2e-6)
    assert result.rigour == "verifiable"


def test_lobed_pattern() -> None:
    """A pattern without symmetry: the known value, certified; roll, pitch and yaw all matter."""
    result = solve(with_antenna(PAPER, {"kind": "pattern", "harmonics": pattern_rows(lobed, 4)}), gap=1e-2)
    assert result.status == "certified"
    assert result.objective.value == pytest.approx(1.33940, abs=1e-5)
    assert result.rigour == "floating-point"
    with pytest.raises(UsageError, match="floating point"):
        certificate_of(result)
    links = evaluate(result.scenario, result.pose)
    assert min(link.sinr for link in links) == result.objective.value


def test_a_dipole_as_a_pattern_is_a_dipole() -> None:
    """``1 - z^2`` as a pattern has the optimum of the dipole, and every pose the same SINR."""
    scenario = with_antenna(
        PAPER, {"kind": "pattern", "harmonics": pattern_rows(lambda x, y, z: 1 - z**2, 2)}
    )
    dipole, pattern = solve(PAPER), solve(scenario, gap=0.1)
    assert pattern.objective.value == pytest.approx(dipole.objective.value, rel=1e-6)
    assert pattern.objective.upper_bound >= dipole.objective.value
    assert min_sinr(PAPER, pattern.pose) == pytest.approx(pattern.objective.value, rel=1e-9)


@pytest.mark.parametrize("kind", ["half-wave", "pattern"])
def test_airframe(kind: str) -> None:
    """A vehicle that tilts less gets less, and its attitude is one that it reaches."""
    rows = {"harmonics": pattern_rows(lobed, 4)} if kind == "pattern" else {}
    free = with_antenna(PAPER, {"kind": kind} | rows)
    tilted = apply_overrides(free, ["airframe.tilt_max_deg=20", "airframe.mount_deg=30"])
    whole, less = solve(free, gap=0.3), solve(tilted, gap=0.3)
    assert less.pose.tilt_rad <= math.radians(20.0) + 1e-9
    assert less.objective.value <= whole.objective.upper_bound
    for roll, pitch, yaw, x, y in np.random.default_rng(1).uniform(-1.0, 1.0, (2000, 5)):
        place_m = less.pose.position_m + 20.0 * np.array([x, y, 0.0])
        pose = Pose(place_m, 0.4 * roll, 0.4 * pitch, math.pi * yaw, math.radians(30.0))
        if pose.tilt_rad <= math.radians(20.0):
            assert min_sinr(tilted, pose) <= less.objective.upper_bound


@pytest.mark.parametrize(
    ("kind", "mount_deg"),
    and_slow([("half-wave", 0.0), ("uneven", 45.0)], [("half-wave", 89.999), ("pattern", 30.0)]),
)
def test_level_vehicles(kind: str, mount_deg: float) -> None:
    """Roll and pitch are exactly zero, no less than the search alone finds, what is promised is verified."""
    rows = {"pattern": pattern_rows(lobed, 4), "uneven": UNEVEN, "half-wave": None}[kind]
    antenna = {"kind": "half-wave"} if rows is None else {"kind": "pattern", "harmonics": rows}
    level = apply_overrides(
        with_antenna(PAPER, antenna), ["airframe.tilt_max_deg=0", f"airframe.mount_deg={mount_deg}"]
    )
    result = solve(level, gap=0.5, node_limit=200_000)
    assert (result.pose.roll_rad, result.pose.pitch_rad) == (0.0, 0.0)
    assert result.objective.value >= solve(level, certify=False).objective.value * (1.0 - 1e-6)
    if kind != "pattern":
        assert verified(result).rigour == "verified"


def test_leaves_stay_with_their_root() -> None:
    """A stage that stops short leaves bound, root and leaves of the one before, which belong together."""
    data = load("examples/eavesdropper.toml").to_dict() | {"antenna": {"kind": "half-wave"}}
    scenario = Scenario.from_dict(data)
    antenna, options = scenario.antenna_record, SolveOptions(threads=1, gap=0.3).of(scenario)
    run = PatternRun(build_family(scenario, any_antenna=True), antenna, reach_of(scenario, antenna), options)
    run.outcome()
    before = run.proved, run.root.tolist(), len(run.leaves)
    assert run._stage(1e-6, 0.0) == f"the time limit of {options.time_limit_s:g} s"
    assert (run.proved, run.root.tolist(), len(run.leaves)) == before


def test_limits_leave_a_bound() -> None:
    """A limit ends the proof with the best pose so far, a bound that holds, and the reason."""
    scenario = with_antenna(PAPER, {"kind": "pattern", "harmonics": pattern_rows(lobed, 4)})
    result = solve(scenario, node_limit=50_000)
    assert result.status == "gap-not-reached"
    assert result.objective.upper_bound >= 1.33940
    assert "node limit" in result.reason


def test_what_is_there_for_dipoles_alone_says_so() -> None:
    """Robust poses and many scenes at once refuse the pattern in words."""
    scenario = with_antenna(PAPER, {"kind": "half-wave"})
    with pytest.raises(UsageError, match="a dipole"):
        solve_many([scenario])
    with pytest.raises(UsageError, match="a dipole"):
        solve(apply_overrides(scenario, ["receiver.attitude_error_deg=1"]), robust=True)
    assert [result.scheme for result in compare(scenario, gap=0.1)] == ["optimum"]
