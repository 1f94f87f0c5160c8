"""Trajectories: what they keep to, and that no flight exceeds their bound."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given, strategies as st
from sizes import few_examples

import nullpose
from nullpose import Scenario, Trajectory
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.physics.decibel import to_db

_AIMS = ("worst", "mean-db", "mean-rate")


def scene(speed_m_s: float = 4.0, instants: int = 7, **tables: object) -> Scenario:
    """Build a scene in which a jammer drives past two nodes, one of which walks."""
    return Scenario.from_dict(
        {
            "time": {"duration_s": instants - 1.0, "step_s": 1.0},
            "airspace": {"altitude_m": [8.0, 30.0]},
            "airframe": {"preset": "omnidirectional", "speed_max_m_s": speed_m_s},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [
                {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
                {"position_m": [0.0, 50.0, 0.0], "power_w": 1.0, "velocity_m_s": [0.0, -1.0, 0.0]},
            ],
            "jammers": [{"position_m": [-30.0, 15.0, 4.0], "power_w": 10.0, "velocity_m_s": [8.0, 1.0, 0.0]}],
        }
        | tables
    )


def score(found: Trajectory, positions_m: np.ndarray, axes: np.ndarray) -> float:
    """Evaluate a flight by the physics, in the unit of a trajectory."""
    scenes = [found.scenario.at(float(t_s)) for t_s in found.times_s]
    ratios = [
        objective_of_links(each, evaluate(each, Pose.of_airframe(each, place_m, axis)))
        for each, place_m, axis in zip(scenes, positions_m, axes, strict=True)
    ]
    if found.maximise == "worst":
        return float(to_db(min(ratios)))
    return float(np.mean(to_db(ratios) if found.maximise == "mean-db" else np.log2(1.0 + np.array(ratios))))


def value_of_poses(found: Trajectory) -> float:
    """Evaluate the poses that a trajectory reports."""
    return score(found, found.positions_m, np.array([pose.antenna_axis for pose in found.poses]))


@pytest.fixture(scope="module", params=_AIMS)
def found(request: pytest.FixtureRequest) -> Trajectory:
    """Solve a small scene for each aim."""
    return nullpose.solve_trajectory(scene(), request.param, time_limit_s=6.0)


def test_the_value_is_that_of_its_poses_and_below_every_bound(found: Trajectory) -> None:
    """By the physics at every instant."""
    assert value_of_poses(found) == pytest.approx(found.value, abs=1e-9)
    hover = found.baselines["hover"]
    assert hover is not None
    assert hover <= found.value + 1e-9 <= found.upper_bound + 2e-9
    assert found.upper_bound <= found.baselines["clairvoyant"] + 1e-9
    assert np.all(found.values <= found.optimum_values * (1.0 + 1e-9))


def test_it_keeps_to_the_speed_and_the_airspace(found: Trajectory) -> None:
    """Speed and altitude."""
    assert np.max(found.speeds_m_s) <= 4.0 * (1.0 + 1e-9)
    heights_m = found.positions_m[:, 2]
    assert np.all((heights_m >= 8.0 - 1e-9) & (heights_m <= 30.0 + 1e-9))


@few_examples(12)
@given(seed=st.integers(0, 10**6))
def test_no_random_flight_exceeds_the_bound(found: Trajectory, seed: int) -> None:
    """Flights near the best one, as fast as allowed, with other attitudes."""
    random = np.random.default_rng(seed)
    steps_m = random.normal(size=(len(found.times_s), 3))
    steps_m *= 4.0 / np.maximum(4.0, np.linalg.norm(steps_m, axis=1, keepdims=True) * random.uniform(1, 6))
    wander_m = found.positions_m + random.uniform() * (np.cumsum(steps_m, axis=0) - steps_m[0])
    speeds = np.linalg.norm(np.diff(wander_m, axis=0), axis=1)
    wander_m = wander_m[0] + (wander_m - wander_m[0]) * min(1.0, 4.0 / float(np.max(speeds)))
    wander_m[:, 2] = np.clip(wander_m[:, 2], 8.0, 30.0)
    axes = np.array([pose.antenna_axis for pose in found.poses]) + 0.1 * random.normal(size=(7, 3))
    assert score(found, wander_m, axes) <= found.upper_bound + 1e-9


def test_axes_that_are_level_are_those_of_the_poses() -> None:
    """A vehicle on its side flies over a node without a jammer; its pitch comes to 90 degrees."""
    lone = {"nodes": [{"position_m": [9.0, 2.0, 0.0], "power_w": 1.0, "velocity_m_s": [6.0, 7.0, 0.0]}]}
    found = nullpose.solve_trajectory(scene(**lone, jammers=[]), "mean-db", time_limit_s=2.0)
    assert value_of_poses(found) == pytest.approx(found.value, abs=1e-9)


_URBAN = {"model": "elevation", "environment": "dense-urban", "average": "power"}
_TILTED = {"tilt_max_deg": 20.0, "mount_deg": 20.0, "speed_max_m_s": 1000.0}


@pytest.mark.parametrize("maximise", _AIMS)
@pytest.mark.parametrize(
    "tables", [{}, {"channel": _URBAN}, {"airframe": _TILTED}], ids=["free", "elevation", "tilt"]
)
def test_a_vehicle_that_could_be_anywhere_gets_the_best_of_each_instant(
    maximise: str, tables: dict[str, object]
) -> None:
    """A speed that is no limit, wherever the best is: high up, or at an axis that is hard to guess."""
    found = nullpose.solve_trajectory(scene(1000.0, 5, **tables), maximise, time_limit_s=4.0)
    assert found.baselines["clairvoyant"] == pytest.approx(found.value, abs=0.01)


@pytest.mark.parametrize("tilt_max_deg", [180.0, 10.0])
def test_where_nothing_moves_it_is_the_best_pose(tilt_max_deg: float) -> None:
    """What stands is a scene of one instant, with any attitude or few."""
    points = scene().at(0.0).to_dict()
    still = {"jammers": [{**points["jammers"][0], "velocity_m_s": [0.0, 0.0, 0.0]}], "nodes": points["nodes"]}
    still["airframe"] = {"tilt_max_deg": tilt_max_deg, "mount_deg": 30.0, "speed_max_m_s": 4.0}
    found = nullpose.solve_trajectory(scene(instants=4, **still), time_limit_s=4.0)
    best = nullpose.solve(scene(instants=4, **still).at(0.0))
    assert found.value == pytest.approx(best.objective.value_db, abs=1e-4)


def test_a_slower_vehicle_never_exceeds_the_bound_of_a_faster_one() -> None:
    """What is proved of more speed holds of less."""
    slow, fast = (nullpose.solve_trajectory(scene(v), time_limit_s=4.0) for v in (1.0, 3.0))
    assert slow.value <= fast.upper_bound + 1e-9


def test_it_starts_and_ends_where_it_is_told() -> None:
    """Exactly."""
    start_m, end_m = [10.0, 20.0, 9.0], [15.0, 30.0, 8.0]
    ends = {"preset": "omnidirectional", "speed_max_m_s": 4.0, "start_m": start_m, "end_m": end_m}
    found = nullpose.solve_trajectory(scene(airframe=ends), time_limit_s=2.0)
    np.testing.assert_allclose(found.positions_m[[0, -1]], [start_m, end_m], atol=1e-12)
    assert np.max(found.speeds_m_s) <= 4.0 * (1.0 + 1e-9)


def test_no_flight_that_misses_the_end_takes_its_place() -> None:
    """One that sees a second ahead does not know of the end; the flight given gets there all the same."""
    ends = {"preset": "omnidirectional", "speed_max_m_s": 4.0, "start_m": [0.0, 25.0, 8.0]}
    far = {"airframe": ends | {"end_m": [20.0, 25.0, 8.0]}}
    found = nullpose.solve_trajectory(scene(**far), "mean-db", gap_db=100.0, window_s=1.0)
    np.testing.assert_allclose(found.positions_m[-1], [20.0, 25.0, 8.0], atol=1e-9)
    assert found.baselines["window"] is None


@few_examples(5)
@given(east_m=st.floats(-12.0, 12.0), north_m=st.floats(15.0, 35.0), speed_m_s=st.sampled_from([4.0, 10.0]))
def test_no_segment_cuts_a_mast(east_m: float, north_m: float, speed_m_s: float) -> None:
    """A mast 1 m wide is thinner than what is flown in a step."""
    mast = shapely.box(east_m - 0.5, north_m - 0.5, east_m + 0.5, north_m + 0.5)
    zone = {"polygon_m": [list(corner) for corner in mast.exterior.coords[:-1]]}
    masted = scene(speed_m_s, airspace={"altitude_m": [8.0, 30.0], "no_fly": [zone]})
    found = nullpose.solve_trajectory(masted, "mean-db", gap_db=100.0)
    assert not shapely.LineString(found.positions_m[:, :2]).intersects(mast.buffer(-1e-6))


def test_the_attitude_is_continuous_where_the_flight_is() -> None:
    """The body turns no more than the antenna does."""
    found = nullpose.solve_trajectory(scene(), "mean-db", gap_db=100.0)
    axes = np.array([pose.antenna_axis for pose in found.poses])
    turned = np.arccos(np.clip(np.abs(np.sum(axes[1:] * axes[:-1], axis=1)), 0.0, 1.0))
    assert np.all(found.turn_rates_rad_s <= turned + 1e-6)
    assert np.all(turned < math.pi / 2)


def test_a_vehicle_turns_no_more_than_its_dipole() -> None:
    """A flat dipole on a vehicle of little tilt goes round: the body goes round with it, and not back."""
    angles = np.linspace(0.0, 2.0 * math.pi, 13)
    track = np.column_stack(
        [np.arange(13.0), 30.0 * np.cos(angles), 25.0 + 30.0 * np.sin(angles), 0 * angles + 4]
    )
    jammer = {"position_m": track[0, 1:].tolist(), "track": track.tolist(), "power_w": 100.0}
    airframe = {"tilt_max_deg": 20.0, "mount_deg": 90.0, "speed_max_m_s": 3.0}
    found = nullpose.solve_trajectory(
        scene(instants=13, jammers=[jammer], airframe=airframe), time_limit_s=2.0
    )
    axes = np.array([pose.antenna_axis for pose in found.poses])
    along = np.clip(np.abs(np.sum(axes[1:] * axes[:-1], axis=1)), 0.0, 1.0)
    assert np.all(found.turn_rates_rad_s <= np.arccos(along) + 0.1)
    assert np.max(np.abs(np.diff(np.unwrap([pose.yaw_rad for pose in found.poses])))) < math.pi / 2


@pytest.mark.parametrize("speed_m_s", [1e-3, 5.0])
def test_a_start_on_the_border_of_a_zone_is_no_trap(speed_m_s: float) -> None:
    """The value is that of staying there or better, and a drone that hardly moves has a trajectory, too."""
    zone = {"centre_m": [20.0, 0.0], "radius_m": 10.0}
    tables = {
        "airspace": {"altitude_m": [8.0, 30.0], "no_fly": [zone]},
        "airframe": {"preset": "omnidirectional", "speed_max_m_s": speed_m_s, "start_m": [10.0, 0.0, 9.0]},
    }
    found = nullpose.solve_trajectory(scene(**tables), time_limit_s=3.0)
    hover = found.baselines["hover"]
    assert hover is not None
    assert hover <= found.value <= found.upper_bound + 1e-9
    if speed_m_s > 1.0:
        assert found.value > hover + 0.5


def test_hovering_is_compared_with_a_good_place() -> None:
    """The example's best place was found by a search over all places and instants by itself."""
    example = nullpose.load(Path(__file__).parents[3] / "examples" / "moving_jammer.toml")
    hover = nullpose.solve_trajectory(example, gap_db=100.0).baselines["hover"]
    assert hover is not None
    assert hover == pytest.approx(-0.64, abs=0.02)


@pytest.mark.parametrize("maximise", _AIMS)
def test_a_time_limit_that_is_over_at_once_leaves_a_flight_and_a_bound(maximise: str) -> None:
    """Both weak, perhaps, and neither wrong; what is too late to compare is left out."""
    found = nullpose.solve_trajectory(scene(), maximise, time_limit_s=1e-6, window_s=3.0)
    assert np.max(found.speeds_m_s) <= 4.0 * (1.0 + 1e-9)
    axes = np.array([pose.antenna_axis for pose in found.poses])
    assert score(found, found.positions_m, axes) == pytest.approx(found.value, abs=1e-9)
    assert found.value <= found.upper_bound + 1e-9
    assert found.baselines["window"] is None


@pytest.mark.parametrize("least_db", [-30.0, 0.0])
def test_every_node_has_what_it_requires_at_every_instant(least_db: float) -> None:
    """Of a sum of rates, which would rather serve the others."""
    nodes = [*scene().to_dict()["nodes"], {"position_m": [45.0, 25.0, 0.0], "min_sinr_db": least_db}]
    nodes[2]["power_w"] = 1.0
    found = nullpose.solve_trajectory(scene(objective="sum-rate", nodes=nodes), "mean-db", time_limit_s=2.0)
    for t_s, pose in zip(found.times_s, found.poses, strict=True):
        links = nullpose.evaluate(found.scenario.at(float(t_s)), pose)
        assert links[2].sinr_db >= least_db - 1e-9


def test_a_flight_that_sees_ahead_keeps_to_the_speed() -> None:
    """It knows less, and gets no more."""
    found = nullpose.solve_trajectory(scene(), "mean-db", gap_db=100.0, window_s=3.0)
    window = found.baselines["window"]
    assert window is not None
    assert window <= found.value + 1e-6


@pytest.mark.parametrize("maximise", ["worst", "mean-db"])
@pytest.mark.parametrize(
    "tables",
    [
        {"channel": {"model": "elevation", "environment": "urban", "average": "power"}},
        {"airframe": {"tilt_max_deg": 20.0, "speed_max_m_s": 4.0}},
        {"airframe": {"preset": "level", "speed_max_m_s": 4.0}},
        {"airframe": {"preset": "level", "mount_deg": 90.0, "speed_max_m_s": 4.0}},
        {"objective": "sum-rate"},
    ],
    ids=["elevation", "tilt", "level", "flat", "sum rate"],
)
def test_it_knows_channels_vehicles_and_objectives(tables: dict[str, object], maximise: str) -> None:
    """With a bound below the clairvoyant one."""
    found = nullpose.solve_trajectory(scene(instants=4, **tables), maximise, time_limit_s=2.0)
    assert found.value <= found.upper_bound + 1e-9
    assert found.upper_bound <= found.baselines["clairvoyant"] + 1e-9


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"airframe": {"preset": "omnidirectional"}}, "speed_max_m_s"),
        ({"antenna": {"kind": "half-wave"}}, "an antenna that is no dipole"),
    ],
)
def test_what_it_does_not_know_is_refused_in_words(change: dict[str, object], words: str) -> None:
    """Not searched in vain."""
    with pytest.raises(nullpose.NullposeError, match=words):
        nullpose.solve_trajectory(scene(**change))
