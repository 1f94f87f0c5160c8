"""Soundness of trajectories: the first scenes of ``benchmarks.soundness.trajectories``, and its judges."""

import numpy as np
import pytest
from benchmarks.soundness.airways import Airways
from benchmarks.soundness.flights import Attack, scores
from benchmarks.soundness.motion import make_motion_scene, make_zoned_scene, with_mast
from benchmarks.soundness.trajectories import check_bounds, check_ways, main
from sizes import and_slow

import nullpose
from nullpose import Scenario
from nullpose.solver.trajectory.course import Aim, Course


@pytest.mark.parametrize("number", and_slow([0, 10], range(1, 6)))
def test_no_flight_exceeds_a_bound(number: int) -> None:
    """Random and optimised flights; slower, fastest and standing scenes have answers that agree."""
    verdict = check_bounds(number)
    assert verdict.faults == ()
    assert verdict.flights >= 20


@pytest.mark.parametrize("number", and_slow([2, 7], range(8, 20)))
def test_no_flight_cuts_what_is_in_its_way(number: int) -> None:
    """Zones, fences and points nearby; the second has a mast put where it flew."""
    verdict = check_ways(number)
    assert verdict.faults == ()
    assert verdict.segments > 0


def _field(**tables: object) -> Scenario:
    """Build three instants, a second apart, at 10 m/s, between which a jammer drives past at 8 m."""
    return Scenario.from_dict(
        {
            "time": {"duration_s": 2.0, "step_s": 1.0},
            "airspace": {"altitude_m": [8.0, 30.0], "keep_out_m": 2.0},
            "airframe": {"preset": "omnidirectional", "speed_max_m_s": 10.0},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [{"position_m": [0.0, -30.0, 0.0], "power_w": 1.0}],
            "jammers": [{"position_m": [5.0, -4.0, 8.0], "power_w": 1.0, "velocity_m_s": [0.0, 8.0, 0.0]}],
        }
        | tables
    )


_MAST = {"x_m": [14.5, 15.5], "y_m": [-0.5, 0.5]}
_WEDGE = [[-5.0, -9.0], [25.0, -9.0], [25.0, 9.0], [15.0, 1.0], [-5.0, 9.0]]


@pytest.mark.parametrize(
    ("height_m", "airspace", "words"),
    [
        (15.0, {}, ""),
        (8.0, {}, "comes too near a point"),
        (7.0, {"keep_out_m": 0.1}, "leaves the ranges"),
        (15.0, {"no_fly": [_MAST]}, "enters Z1"),
        (15.0, {"no_fly": [_MAST | {"altitude_m": [0.0, 14.0]}]}, ""),
        (15.0, {"no_fly": [_MAST | {"altitude_m": [0.0, 14.0]}], "margin_m": 1.5}, "enters Z1"),
        (15.0, {"no_fly": [{"centre_m": [15.0, 2.0], "radius_m": 1.9}]}, ""),
        (15.0, {"no_fly": [{"centre_m": [15.0, 2.0], "radius_m": 2.1}]}, "enters Z1"),
        (15.0, {"geofence_m": _WEDGE}, ""),
        (15.0, {"geofence_m": [*_WEDGE[:3], [15.0, -1.0], _WEDGE[4]]}, "leaves the fence"),
    ],
)
def test_the_judge_knows_what_is_in_the_way(height_m: float, airspace: dict, words: str) -> None:
    """A straight flight whose instants are all clear, past something between them."""
    airways = Airways(_field(airspace={"altitude_m": [8.0, 30.0], "keep_out_m": 2.0} | airspace))
    flight = np.array([[[0.0, 0.0, height_m], [10.0, 0.0, height_m], [20.0, 0.0, height_m]]])
    assert [name for name, broken in airways.faults(flight).items() if broken] == [words] * bool(words)
    assert airways.keeps(flight)[0] == (not words)
    assert not airways.keeps(flight * [1.01, 1.0, 1.0])[0]


def test_the_attack_would_notice_a_bound_that_is_too_low() -> None:
    """Flights near the best one are as good as it to a thousandth, by no help of its axes."""
    scenario = make_motion_scene(0)
    found = nullpose.solve_trajectory(scenario, "mean-db", time_limit_s=1.0)
    courses = {Aim.MEAN_DB: Course.of(scenario, Aim.MEAN_DB)}
    attack = Attack(Airways(scenario), courses, np.random.default_rng(0))
    flights = attack.bettered(np.tile(found.positions_m, (9, 1, 1)))
    assert np.max(scores(scenario.at(0.0), attack.values(flights))["mean-db"]) > found.value - 1e-3


def test_a_number_always_gives_the_same_scene() -> None:
    """Of both kinds; a mast stands in the middle of the longest step."""
    assert make_motion_scene(4) == make_motion_scene(4)
    assert make_zoned_scene(4) == make_zoned_scene(4)
    masted = with_mast(_field(), np.array([[0.0, 0.0, 9.0], [2.0, 0.0, 9.0], [10.0, 4.0, 9.0]]))
    assert masted.airspace.no_fly[0].x_m == (5.5, 6.5)
    assert masted.airspace.no_fly[0].y_m == (1.5, 2.5)


def test_the_command_states_counts_and_faults(capsys: pytest.CaptureFixture[str]) -> None:
    """In its last line; the exit code is 0 without a fault."""
    assert main(["--scenes", "0", "--zoned", "1"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("1 scenes, ")
