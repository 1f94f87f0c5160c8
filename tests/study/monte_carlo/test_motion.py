"""Drawn points move as the spec says, the same for a seed, and flights through such scenes are compared."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from nullpose import ScenarioError
from nullpose.study.monte_carlo import StudySpec, draw_scene, read_study, run_study
from nullpose.study.monte_carlo.chunk import rows_of
from nullpose.study.monte_carlo.draw import Draws
from nullpose.study.monte_carlo.loading import require_sound

Spec = Callable[..., StudySpec]

WAYPOINTS = {
    "scenes": 10**6,
    "scene__time": {"duration_s": 60.0, "step_s": 10.0},
    "jammers__motion": "random-waypoint",
    "jammers__speed_m_s": {"uniform": [2.0, 8.0]},
    "jammers__pause_s": {"uniform": [1.0, 10.0]},
}
VELOCITY = {
    "scenes": 10**6,
    "scene__time": {"duration_s": 60.0, "step_s": 10.0},
    "nodes__motion": "constant-velocity",
    "nodes__speed_m_s": {"uniform": [1.0, 3.0]},
}
FLIGHTS: list[dict[str, Any]] = [
    {"name": "hover", "flight": "hover"},
    {"name": "trajectory", "flight": "trajectory"},
]
SMALL = WAYPOINTS | {
    "scenes": 2,
    "gap": 5e-2,
    "scene__time": {"duration_s": 20.0, "step_s": 10.0},
    "scene__airframe": {"preset": "omnidirectional", "speed_max_m_s": 5.0},
    "cases": FLIGHTS,
    "sweep": {"airframe.speed_max_m_s": [2.0, 10.0]},
}


def _track(spec: StudySpec, index: int, place: int = 0) -> np.ndarray[Any, Any]:
    return np.array(draw_scene(spec, index).jammers[place].track)


@given(index=st.integers(0, 10**5))
def test_waypoints_are_in_the_area_at_the_speeds_stated(spec: Spec, index: int) -> None:
    """A track begins where its point is drawn, covers the scene, and keeps area, height, speed and pause."""
    scene = draw_scene(spec(**WAYPOINTS), index)
    rows = _track(spec(**WAYPOINTS), index)
    assert tuple(rows[0, 1:]) == scene.jammers[0].position_m
    assert rows[0, 0] == 0.0
    assert rows[-1, 0] >= 60.0
    assert np.all(np.hypot(rows[:, 1], rows[:, 2] - 25.0) <= 60.0 * (1.0 + 1e-12))
    assert np.all(rows[:, 3] == 4.0)
    steps_s, steps_m = np.diff(rows[:, 0]), np.linalg.norm(np.diff(rows[:, 1:], axis=0), axis=1)
    speeds, pauses = steps_m[::2] / steps_s[::2], steps_s[1::2]
    assert np.all((speeds >= 2.0 - 1e-9) & (speeds <= 8.0 + 1e-9))
    assert np.all(steps_m[1::2] == 0.0)
    assert np.all((pauses >= 1.0 - 1e-9) & (pauses <= 10.0 + 1e-9))


@given(index=st.integers(0, 10**5))
def test_a_track_depends_on_seed_and_number_alone(spec: Spec, index: int) -> None:
    """More points or a longer scene keep the rows, other speeds the waypoints; another seed has others."""
    rows = _track(spec(**WAYPOINTS), index)
    assert np.array_equal(rows, _track(spec(**WAYPOINTS, jammers__count=3), index))
    longer = _track(spec(**WAYPOINTS | {"scene__time": {"duration_s": 600.0, "step_s": 10.0}}), index)
    assert np.array_equal(rows, longer[: len(rows)])
    faster = _track(spec(**WAYPOINTS | {"jammers__speed_m_s": 8.0}), index)
    assert np.array_equal(rows[:3, 1:], faster[:3, 1:])
    assert not np.array_equal(rows[0], _track(spec(**WAYPOINTS, seed=4), index)[0])
    still = spec(
        **WAYPOINTS | {"jammers__motion": None, "jammers__speed_m_s": None, "jammers__pause_s": None}
    )
    standing = still.model_copy(update={"scene": {**still.scene.to_dict(), "time": None}})
    assert draw_scene(standing, index).jammers[0].position_m == tuple(rows[0, 1:])


def test_a_velocity_has_the_speed_and_direction_stated(spec: Spec) -> None:
    """Speeds are uniform in their range; directions are all alike likely, or the one that is stated."""
    drawn = [
        point.velocity_m_s for index in range(200) for point in draw_scene(spec(**VELOCITY), index).nodes
    ]
    east, north, up = np.array(drawn).T
    assert stats.kstest((np.hypot(east, north) - 1.0) / 2.0, "uniform").pvalue > 0.01
    assert stats.kstest(np.arctan2(north, east) / (2.0 * math.pi) + 0.5, "uniform").pvalue > 0.01
    assert np.all(up == 0.0)
    northward = draw_scene(spec(**VELOCITY, nodes__direction_deg=90.0), 3).nodes[0].velocity_m_s
    assert northward == pytest.approx(
        (0.0, np.hypot(*draw_scene(spec(**VELOCITY), 3).nodes[0].velocity_m_s[:2]), 0.0)
    )


def test_blocks_leave_room_for_what_drives(spec: Spec) -> None:
    """No building stands where a jammer is at any instant."""
    drawn = spec(**WAYPOINTS, scene__airspace={"altitude_m": [80, 120]}, buildings={"environment": "urban"})
    for index in range(5):
        scene = draw_scene(drawn, index)
        assert scene.buildings
        assert [len(scene.at(t_s).jammers) for t_s in scene.instants_s] == [1] * 7


def test_a_flight_is_worth_no_less_than_a_hover(spec: Spec, tmp_path: Path) -> None:
    """In every row the bound is above the flight, and the flight above the pose held; two workers agree."""
    study = spec(**SMALL)
    tables = []
    for workers in (0, 2):
        run_study(study, tmp_path / str(workers), workers=workers, chunk=1)
        tables.append(read_study(tmp_path / str(workers)).frame())
    pd.testing.assert_frame_equal(*(table.drop(columns="seconds") for table in tables))
    frame = tables[0].set_index(["scene", "point"])
    assert list(frame["status"]) == ["certified"] * 8
    hover, flight = (frame[frame["case"] == case["name"]] for case in FLIGHTS)
    assert np.all(hover["value"] <= flight["value"])
    assert np.all(frame["value"] <= frame["bound"])
    assert np.all(frame["gap"] <= 5e-2 * (1.0 + 1e-9))
    assert np.all(flight["value"].xs(0, level="point") <= flight["bound"].xs(1, level="point"))


def test_a_time_limit_is_a_status(spec: Spec) -> None:
    """A flight that meets it has its value, a bound above it, and a reason."""
    hard = SMALL | {"scenes": 1, "gap": 1e-8, "sweep": {}, "cases": [{**FLIGHTS[1], "time_limit_s": 1e-3}]}
    (row,) = rows_of(spec(**hard, jammers__power_w=100.0), 0, 0)
    assert (row["status"], row["value"] <= row["bound"]) == ("gap-not-reached", True)
    assert row["reason"]


def test_other_cases_are_of_the_first_instant(spec: Spec) -> None:
    """A scene in motion has the rows of the scene that stands where it is at t = 0."""
    moving = spec(**SMALL | {"scenes": 1, "cases": [{"name": "free"}, {"name": "over", "pose": "centroid"}]})
    rows, first = list(rows_of(moving, 0, 0)), Draws(moving).at(0, 0).at(0.0)
    tables = {kind: [each.to_dict() for each in getattr(first, kind)] for kind in ("nodes", "jammers")}
    still = spec(
        scenes=1,
        gap=5e-2,
        nodes=None,
        jammers=None,
        cases=[case.to_dict() for case in moving.cases],
        scene__nodes=tables["nodes"],
        scene__jammers=tables["jammers"],
        scene__airframe={"preset": "omnidirectional"},
    )
    for row, same in zip(rows[:2], rows_of(still, 0, 0), strict=True):
        assert {**row, "seconds": 0} == {**same, "seconds": 0}


def test_a_vehicle_of_a_case_keeps_the_speed(spec: Spec) -> None:
    """A case that states an airframe flies at the scene's speed, which is swept, unless it states one."""
    slow = {"flight": "trajectory", "airframe": {"tilt_max_deg": 30, "mount_deg": 90, "speed_max_m_s": 1.0}}
    study = spec(**SMALL | {"cases": [{"flight": "trajectory", "airframe": "tilt-30-horizontal"}, slow]})
    scene = Draws(study).at(0, 1)
    vehicles = [case.on(scene).airframe for case in study.cases]
    assert [each.speed_max_m_s for each in vehicles if each] == [10.0, 1.0]
    assert [each.tilt_max_rad for each in vehicles if each] == pytest.approx([math.radians(30.0)] * 2)
    assert study.cases[0].phrase == "the best flight of a 30 degree tilt with a horizontal dipole"


@pytest.mark.parametrize(
    ("changes", "path", "message"),
    [
        ({"jammers__speed_m_s": {"uniform": [8.0, 2.0]}}, "jammers.speed_m_s.uniform", "the lower first"),
        ({"jammers__speed_m_s": 0.0}, "jammers.speed_m_s", "0.001"),
        ({"jammers__speed_m_s": None}, "jammers.speed_m_s", "missing"),
        ({"jammers__motion": "random-walk"}, "jammers.motion", 'did you mean "random-waypoint"'),
        ({"jammers__motion": None}, "jammers.speed_m_s", "no meaning without motion"),
        ({"jammers__direction_deg": 10.0}, "jammers.direction_deg", "no meaning with motion"),
        ({"jammers__centre_m": [1e9, 0.0]}, "jammers.centre_m[0]", "got 1000000000.0"),
        ({"scene__time": None}, "jammers.motion", r"no \[time\]; add a table headed \[scene\.time\]"),
        ({"scene__airframe": None, "sweep": {}}, "cases[1]", "airframe.speed_max_m_s: missing"),
        ({"cases": [{"flight": "orbit"}]}, "cases[0].flight", "hover"),
        ({"cases": [{"flight": "hover", "scheme": "vertical"}]}, "cases[0]", "at most one"),
        ({"cases": [{"flight": "trajectory", "certify": False}]}, "cases[0].certify", "always has a bound"),
    ],
)  # fmt: skip
def test_bad_motions_are_refused(spec: Spec, changes: dict[str, Any], path: str, message: str) -> None:
    """Before anything is solved, by the path of what is wrong."""
    with pytest.raises(ScenarioError, match=message) as caught:
        require_sound(spec(**SMALL | changes))
    assert path in [fault.path for fault in caught.value.faults]


def test_a_flight_needs_a_scene_in_motion(spec: Spec) -> None:
    """In a scene that stands it is refused, and the message says what to add."""
    with pytest.raises(ScenarioError, match=r"cases\[0\].*hover: asked for, but the scene has no \[time\]"):
        require_sound(spec(cases=FLIGHTS))


def test_a_track_of_a_million_rows_is_refused(spec: Spec) -> None:
    """A scene that lasts too long for its waypoints ends in a message, not in a full memory."""
    years = {"scene__time": {"duration_s": 1e8, "step_s": 1e5}, "scenes": 1}
    with pytest.raises(ScenarioError, match="rows; make the area larger"):
        draw_scene(spec(**WAYPOINTS | years), 0)
