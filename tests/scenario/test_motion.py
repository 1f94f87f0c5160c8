"""Scenes in motion: where everything is at each instant, and what is no such scene."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

import nullpose
from nullpose.errors import ScenarioError, UsageError
from nullpose.scenario import Scenario, apply_overrides, load
from nullpose.scenario.geodesy import geodetic_from_enu
from scenes import faults_of, small

EXAMPLE = Path(__file__).parents[2] / "examples" / "moving_jammer.toml"
TIME = {"duration_s": 60.0, "step_s": 1.0}
METRES = st.floats(-1e3, 1e3)
PLACES = st.tuples(METRES, METRES, st.floats(1.0, 5.0))
ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0, "alt_msl_m": 185.0}
ROWS = [[0.0, 5.0, 6.0, 7.0], [20.0, 30.0, -10.0, 2.0], [60.0, 80.0, 4.0, 3.0]]


def moving(**keys: Any) -> dict[str, Any]:
    """Return a scene in motion with a jammer of these keys beside a node."""
    return small(time=TIME, jammers=[{"power_w": 1.0, **keys}])


@st.composite
def tracks(draw: st.DrawFn) -> list[list[float]]:
    """Draw the rows of a track from 0 to 60 s or later."""
    between_s = draw(st.lists(st.integers(1, 59), unique=True, max_size=5))
    times_s = [0.0, *sorted(map(float, between_s)), draw(st.sampled_from([60.0, 61.5]))]
    return [[t_s, *draw(PLACES)] for t_s in times_s]


@given(tracks(), st.data())
def test_a_track_is_straight_and_even_between_its_rows(rows: list[list[float]], data: st.DataObject) -> None:
    """A share of the time between two rows is that share of the way from one to the next."""
    scene = Scenario.from_dict(moving(track=rows))
    index, share = data.draw(st.integers(0, len(rows) - 2)), data.draw(st.floats(0.0, 1.0))
    first, second = np.array(rows[index]), np.array(rows[index + 1])
    t_s, *place_m = first + share * (second - first)
    if t_s <= 60.0:
        assert scene.at(t_s).jammers[0].position_m == pytest.approx(place_m, abs=1e-9)


@given(PLACES, st.tuples(*[st.floats(-10.0, 10.0)] * 2, st.floats(0.0, 1.0)), st.floats(0.0, 60.0))
def test_a_velocity_is_a_track_of_two_rows(
    start_m: tuple[float, ...], velocity_m_s: tuple[float, ...], t_s: float
) -> None:
    """Both state the same motion, with or without the place beside the track."""
    end_m = (np.array(start_m) + 60.0 * np.array(velocity_m_s)).tolist()
    rows = {"track": [[0.0, *start_m], [60.0, *end_m]]}
    even = {"position_m": start_m, "velocity_m_s": velocity_m_s}
    stated = [even, rows, rows | {"position_m": start_m}, {"position_m": start_m, "track": [[60.0, *end_m]]}]
    places_m = [Scenario.from_dict(moving(**keys)).at(t_s).jammers[0].position_m for keys in stated]
    assert places_m == [pytest.approx(places_m[0], abs=1e-9)] * 4


@given(st.floats(1e-2, 1e4), st.integers(1, 50), st.sampled_from([0.0, 0.01, 0.5, 0.99]))
def test_instants_go_from_zero_to_the_end(step_s: float, steps: int, more: float) -> None:
    """They are a step apart, the last step may be shorter, and the last is exactly the duration."""
    duration_s = step_s * (steps + more)
    times = {"duration_s": duration_s, "step_s": step_s}
    instants_s = Scenario.from_dict(moving(track=[[0, 1, 1, 1], [1e6, 2, 2, 2]]) | {"time": times}).instants_s
    assert instants_s[0] == 0.0
    assert instants_s[-1] == duration_s
    assert len(instants_s) == steps + 1 + (more > 0.0)
    apart_s = np.diff(instants_s)
    assert apart_s[:-1] == pytest.approx(np.full(len(apart_s) - 1, step_s), rel=1e-9)
    assert 0.0 < apart_s[-1] <= step_s * (1.0 + 1e-9)


def test_the_scene_at_an_instant_is_still() -> None:
    """It states its instant and no motion, is equal when read again, and has the speed of no vehicle."""
    vehicle = {"preset": "level", "speed_max_m_s": 5.0, "start_m": [0, 0, 10], "end_m": [9, 0, 10]}
    scene = Scenario.from_dict(
        moving(track=ROWS, uncertainty_m=0.5) | {"airframe": vehicle, "name": "convoy"}
    )
    still = scene.at(20.0)
    assert (still.time, still.at_s, still.name) == (None, 20.0, "convoy (at 20 s)")
    assert still.jammers[0].position_m == (30.0, -10.0, 2.0)
    assert still.jammers[0].uncertainty_m == 0.5
    assert still.airframe == nullpose.Airframe(preset="level")
    assert still.nodes == scene.nodes
    assert Scenario.from_dict(still.to_dict()) == still
    assert still.still() == still
    assert scene.still() == scene.at(0.0)


def test_everyone_on_the_ground_may_move() -> None:
    """Nodes, jammers, the destination, eavesdroppers and sources are where their motion leads them."""
    east = {"velocity_m_s": [1.0, 0.0, 0.0]}

    def point(x_m: float, **keys: object) -> dict[str, Any]:
        return {"position_m": [x_m, 0.0, 0.0], **east, **keys}

    power = {"power_w": 1.0}
    relay = {"objective": "relay", "transmitter": power, "destination": point(40.0)}
    jamming = {"objective": "friendly-jamming", "transmitter": power, "eavesdroppers": [point(50.0)]}
    sides = {"altitude_m": [8.0, 30.0], "x_m": [-50.0, 50.0], "y_m": [-50.0, 50.0]}
    jamming |= {"sources": [point(60.0, **power)], "nodes": [point(0.0)], "airspace": sides}
    for more in ({"nodes": [point(0.0, **power)], "jammers": [point(20.0, **power)]} | relay, jamming):
        scene = Scenario.from_dict(small(time=TIME) | more)
        still = scene.at(7.0)
        starts_m = np.array([each.position_m for each in scene.points])
        assert np.all(still.point_positions_m - starts_m == np.array([7.0, 0.0, 0.0]))


def test_it_begins_with_the_still_scene() -> None:
    """At 0 it is the scene without its motion, which has the same best value."""
    scene, data = load(EXAMPLE), load(EXAMPLE).to_dict()
    del data["time"], data["jammers"][0]["velocity_m_s"], data["airframe"]["speed_max_m_s"]
    still, begun = Scenario.from_dict(data), scene.at(0.0)
    assert begun.model_copy(update={"at_s": None, "name": still.name}) == still
    values = [nullpose.solve(each).objective for each in (still, begun)]
    assert values[0].value == values[1].value
    assert values[0].upper_bound == values[1].upper_bound


@pytest.mark.parametrize("keys", [{"track": ROWS}, {"position_m": [5, 6, 7], "velocity_m_s": [1, 2, 0.5]}])
def test_round_trips_keep_the_motion(keys: dict[str, Any]) -> None:
    """Plain data and the text of a file give an equal scene in motion back."""
    scene = Scenario.from_dict(moving(**keys))
    assert Scenario.from_dict(scene.to_dict()) == scene
    assert "in motion for 60 s" in repr(scene)


@pytest.mark.parametrize(("key", "base_m"), [("alt_m", 230.0), ("alt_msl_m", 185.0), ("alt_agl_m", 0.0)])
@pytest.mark.parametrize("is_beside", [True, False])
def test_a_track_on_the_earth_is_that_in_metres(key: str, base_m: float, is_beside: bool) -> None:
    """Whatever its altitudes count from, it leads to the same places, which are stated on the Earth too."""
    times_s, *_ = np.transpose(ROWS)
    geodetic = geodetic_from_enu(np.array(ROWS)[:, 1:], [50.0, 14.5, 230.0])
    geodetic[:, 2] += base_m - 230.0
    keys = {"track": np.column_stack([times_s, geodetic]).tolist()}
    if is_beside or key != "alt_m":  # alone, altitudes are over what the origin states
        keys |= dict(zip(("lat_deg", "lon_deg", key), geodetic[0].tolist(), strict=True))
    node = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0, "power_w": 1.0}
    scene = Scenario.from_dict(moving(**keys) | {"origin": ORIGIN, "nodes": [node]})
    plain = Scenario.from_dict(moving(track=ROWS))
    moved = apply_overrides(scene, ["origin.lat_deg=50.001"])
    for t_s in (0.0, 13.0, 20.0, 60.0):
        still = scene.at(t_s)
        assert still.jammers[0].position_m == pytest.approx(plain.at(t_s).jammers[0].position_m, abs=1e-6)
        assert Scenario.from_dict(still.to_dict()) == still
        there_m = apply_overrides(still, ["origin.lat_deg=50.001"]).jammers[0].position_m
        assert there_m == pytest.approx(moved.at(t_s).jammers[0].position_m, abs=1e-6)
    assert Scenario.from_dict(scene.to_dict()) == scene


def test_a_velocity_is_in_metres_on_the_earth_too() -> None:
    """East, north and up at the origin, from a place that is stated by latitude and longitude."""
    place = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_msl_m": 187.0}
    node = {"lat_deg": 50.001, "lon_deg": 14.5, "alt_m": 230.0, "power_w": 1.0}
    scene = Scenario.from_dict(
        moving(**place, velocity_m_s=[1, -2, 0.1]) | {"origin": ORIGIN, "nodes": [node]}
    )
    still = scene.at(10.0).jammers[0]
    assert still.position_m == pytest.approx((10.0, -20.0, 3.0), abs=1e-6)
    assert still.alt_msl_m == pytest.approx(188.0, abs=1e-3)


@pytest.mark.parametrize(
    ("override", "place_m"),
    [
        ("time.step_s=2", (1.0, 2.0, 3.0)),
        ("jammers.M1.velocity_m_s=[1, 0, 0]", (11.0, 2.0, 3.0)),
        ("jammers.M1.velocity_m_s[1]=3", (1.0, 32.0, 3.0)),
        ("jammers.M1.track=[[10, 5, 6, 7], [60, 8, 8, 8]]", (5.0, 6.0, 7.0)),
        ("jammers.M1.position_m=[4, 4, 4]", (4.0, 4.0, 4.0)),
    ],
)
def test_overrides_change_the_motion(override: str, place_m: tuple[float, ...]) -> None:
    """A velocity or a track takes the place of the other; a place moves the start."""
    scene = Scenario.from_dict(moving(position_m=[1, 2, 3], velocity_m_s=[0, 0, 0]))
    changed = apply_overrides(scene, [override])
    assert changed.at(10.0).jammers[0].position_m == place_m
    assert len(changed.instants_s) == (31 if "step_s" in override else 61)


PLACED = {"position_m": [1, 2, 3], "velocity_m_s": [0, 0, 1]}
TRACK = "jammers[0].track"
NAN = float("nan")
FAULTS: list[tuple[dict[str, Any], str, str]] = [
    (moving(**PLACED) | {"time": None}, "jammers[0].velocity_m_s", "the scene has no [time]"),
    (moving(track=ROWS) | {"time": None}, TRACK, "the scene has no [time]"),
    (moving(position_m=[1, 2, 3]), "time", "nothing moves"),
    (moving(**PLACED, track=[[60, 1, 1, 1]]), "jammers[0]", "both velocity_m_s and track are given"),
    (moving(**PLACED) | {"at_s": 3.0}, "at_s", "remove either"),
    *[
        (moving(**PLACED) | {"time": TIME | {"step_s": step_s}}, "time.step_s", words)
        for step_s, words in {
            0.0: "got 0.0, must be a time in s",
            -1.0: "got -1.0, must be a time in s",
            61.0: "must be at most duration_s = 60",
            NAN: "got NaN",
            1e-4: "600,001 instants, must be at most 100,000",
        }.items()
    ],
    (moving(**PLACED) | {"time": {"step_s": 1.0}}, "time.duration_s", "missing"),
    (moving(position_m=[1, 2, 3], velocity_m_s=[0, NAN, 0]), "jammers[0].velocity_m_s[1]", "got NaN"),
    (moving(position_m=[1, 2, 3], velocity_m_s=[0, 1]), "jammers[0].velocity_m_s", "three numbers"),
    (moving(track=[ROWS[0], [20, 1, NAN, 1], ROWS[2]]), f"{TRACK}[1][2]", "got NaN"),
    (moving(track=[ROWS[0], [20, 1, 1], ROWS[2]]), f"{TRACK}[1]", "a list of 3 values"),
    (moving(track=[ROWS[0], None, ROWS[2]]), f"{TRACK}[1]", "got nothing"),
    (moving(track=[]), TRACK, "an empty list"),
    (moving(track=[ROWS[0], ROWS[2], ROWS[1]]), f"{TRACK}[2][0]", "t = 20 after t = 60, must be later"),
    (moving(track=[*ROWS, ROWS[2]]), f"{TRACK}[3][0]", "must be later"),
    (moving(track=ROWS[:2]), f"{TRACK}[1][0]", "ends at t = 20, must go on to duration_s = 60"),
    (moving(track=ROWS[1:]), f"{TRACK}[0][0]", "state the place at t = 0 too"),
    (moving(track=[[-1, 0, 0, 0], *ROWS]), f"{TRACK}[0][0]", "got -1"),
    (moving(track=ROWS, position_m=[5, 6, 8]), f"{TRACK}[0]", "1 m from the place stated beside it"),
    (moving(track_from="drone.csv"), "jammers[0].track_from", "only a scenario file"),
    (moving(track=[[0, 0, 0, 0], [60, 1, 1, 1]]), "jammers[0].position_m", "the place of nodes[0] already"),
]


@pytest.mark.parametrize(("data", "path", "words"), FAULTS)
def test_each_fault_is_told_once_at_its_place(data: dict[str, Any], path: str, words: str) -> None:
    """A motion that cannot be, and times without one, give one message with its path."""
    found = faults_of({key: value for key, value in data.items() if value is not None})
    assert list(found) == [path]
    assert words in found[path]


TOWER = {"name": "tower", "centre_m": [100, 0], "radius_m": 10}
HOUSE = {"polygon_m": [[60, 60], [80, 60], [80, 80]], "height_m": 20.0}


@pytest.mark.parametrize(
    ("keys", "path"),
    [
        ({"start_m": [0, 0, 3]}, "airframe.start_m"),
        ({"start_m": [100, 0, 10]}, "airframe.start_m"),
        ({"end_m": [75, 65, 15]}, "airframe.end_m"),
        ({"end_m": [1, 2, 63.5]}, "airframe.end_m"),
        ({"start_m": [0, 0, 10], "end_m": [0, 400, 10], "speed_max_m_s": 5.0}, "airframe.end_m"),
        ({"speed_max_m_s": -1.0}, "airframe.speed_max_m_s"),
        ({"start_m": [0, 0]}, "airframe.start_m"),
    ],
)
def test_the_flight_begins_and_ends_where_the_vehicle_may_be(keys: dict[str, Any], path: str) -> None:
    """In the airspace, in no zone and no building, away from who is there then, and near enough."""
    airspace = {"altitude_m": [8.0, 70.0], "no_fly": [TOWER], "keep_out_m": 2.0}
    scene = moving(**PLACED) | {"airspace": airspace, "buildings": [HOUSE]}
    assert (
        faults_of(scene | {"airframe": {"preset": "level", "start_m": [0, 0, 10], "end_m": [1, 2, 50]}}) == {}
    )
    assert list(faults_of(scene | {"airframe": {"preset": "level", **keys}})) == [path]
    still = {**scene, "time": None, "jammers": [{"power_w": 1.0, "position_m": [1, 2, 3]}]}
    still = {key: value for key, value in still.items() if value is not None}
    assert list(faults_of(still | {"airframe": {"preset": "level", "speed_max_m_s": 1.0}})) == [
        "airframe.speed_max_m_s"
    ]


def test_places_that_are_refused_of_still_points_are_so_at_their_instant() -> None:
    """A point may go below the origin, as a still one may be there, but not to the place of another."""
    scene = Scenario.from_dict(moving(position_m=[-10, 0, 10], velocity_m_s=[1, 0, -1]))
    assert scene.at(20.0).jammers[0].position_m == (10.0, 0.0, -10.0)
    with pytest.raises(ScenarioError, match=r"the scene \(at 10 s\).*") as caught:
        scene.at(10.0)
    assert [fault.path for fault in caught.value.faults] == ["jammers[0].position_m"]


@pytest.mark.parametrize("t_s", [-1.0, 60.5, NAN])
def test_instants_outside_the_scene_are_refused(t_s: float) -> None:
    """So is any instant of a still scene, which has no times either, and what is no time."""
    scene = load(EXAMPLE)
    with pytest.raises(UsageError, match="allowed: 0 to 60 s"):
        scene.at(t_s)
    for wrong in (lambda: scene.at(0.0).at(t_s), lambda: scene.at(0.0).instants_s):
        with pytest.raises(UsageError, match=r"no \[time\]"):
            wrong()
    with pytest.raises(UsageError, match="given 'noon'; allowed: float"):
        scene.at("noon")  # type: ignore[arg-type]


def test_what_needs_a_still_scene_refuses_one_in_motion() -> None:
    """No function answers for an instant that nobody stated: each says how to state it."""
    scene, pose = load(EXAMPLE), nullpose.Pose([0.0, 20.0, 10.0], 0.0, 0.0, 0.0)
    calls = [
        lambda: nullpose.solve(scene),
        lambda: nullpose.solve(scene, robust=True),
        lambda: nullpose.solve(scene, certify=False),
        lambda: nullpose.solve_many([scene]),
        lambda: nullpose.compare(scene),
        lambda: nullpose.compare_airframes(scene),
        lambda: nullpose.sweep(scene, "jammers.M.power_w", [1.0, 2.0]),
        lambda: nullpose.least_tilt(scene),
        lambda: nullpose.evaluate(scene, pose),
        lambda: nullpose.min_sinr(scene, pose),
        lambda: nullpose.sensitivity(scene, pose),
        lambda: nullpose.guarantee(scene, pose.position_m, pose.antenna_axis),
    ]
    for call in calls:
        with pytest.raises(UsageError, match=r"call \.at\(t\)"):
            call()
