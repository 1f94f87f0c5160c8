"""A flight as tables, files, figures and a film: what is read back is what was flown."""

import csv
import io
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from earth import local_m
from flown import ORIGIN, PLACES_M, TIMES_S, flown, moving
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rich.console import Console
from scipy.spatial.transform import Rotation

from nullpose import Trajectory
from nullpose.report.export.geojson import flight_geojson_file
from nullpose.report.export.mcap import flight_mcap_file
from nullpose.report.export.plan import flight_plan_file
from nullpose.report.figures.trajectory import draw_flight
from nullpose.report.trajectory import file_names, trajectory_view, write_trajectory
from nullpose.solver.trajectory import Aim
from nullpose.study.between_instants import sample_between

WAYPOINT, CHANGE_SPEED = 16, 178  # MAV_CMD of MAVLink's common.xml


@pytest.fixture(scope="module")
def flight() -> Trajectory:
    """A flight with an origin."""
    return flown()


@pytest.fixture(scope="module")
def folder(flight: Trajectory, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with its files."""
    path = tmp_path_factory.mktemp("flight") / "out"
    written = write_trajectory(flight, sample_between(flight), path)
    assert sorted(written) == sorted(path.iterdir())
    assert [each.name for each in written] == file_names(flight.scenario)
    return path


def shown(flight: Trajectory) -> str:
    """Returns the tables as they are printed, words apart by one space."""
    console = Console(width=200)
    with console.capture() as capture:
        console.print(trajectory_view(flight, sample_between(flight)))
    return " ".join(capture.get().split())


def test_tables_state_value_bound_motion_and_what_is_proved(flight: Trajectory) -> None:
    """The bound is not rounded down; the largest speed and turn rate are those of the flight."""
    words = shown(flight)
    assert f"{flight.value:.4f} dB" in words
    bound = float(words.split("upper bound ")[1].split()[0])
    assert flight.upper_bound <= bound <= flight.upper_bound + 1e-4
    assert f"{max(flight.speeds_m_s):.4g} m/s, limit 5 m/s" in words
    assert f"{math.degrees(max(flight.turn_rates_rad_s)):.3g} deg/s" in words
    lowest = 10.0 * np.log10(np.min(sample_between(flight)[1]))
    assert f"lowest {lowest:.4f} dB" in words
    assert "continuous time" in words
    assert "of the instants only" in shown(flown(Aim.MEAN_RATE))


def test_csv_and_tum_hold_the_poses(flight: Trajectory, folder: Path) -> None:
    """Place and rotation of every instant; TUM has the scalar of the quaternion last."""
    with (folder / "trajectory.csv").open() as file:
        rows = [{name: float(cell) for name, cell in row.items()} for row in csv.DictReader(file)]
    tum = np.loadtxt(folder / "trajectory.tum")
    for row, line, pose, time_s in zip(rows, tum, flight.poses, TIMES_S, strict=True):
        angles = (pose.yaw_rad, pose.pitch_rad, pose.roll_rad)
        turned = Rotation.from_euler("ZYX", angles)
        assert [row["time_s"], row["x_m"], row["y_m"], row["z_m"]] == [time_s, *pose.position_m]
        assert line[:4] == pytest.approx([time_s, *pose.position_m])
        for quaternion in ([row[f"q{name}"] for name in "xyzw"], line[4:]):
            assert (Rotation.from_quat(quaternion).inv() * turned).magnitude() < 1e-9
    assert min(row["value_db"] for row in rows) == pytest.approx(flight.value)
    assert json.loads((folder / "trajectory.json").read_text())["objective"]["value_db"] == flight.value


def test_a_map_has_the_flight_as_a_line_with_times(flight: Trajectory) -> None:
    """Each corner is where the drone is at its time."""
    line = json.loads(flight_geojson_file(flight))["features"][0]
    assert line["geometry"]["type"] == "LineString"
    assert line["properties"]["time_s"] == TIMES_S.tolist()
    found_m = [local_m(lat, lon, alt, ORIGIN) for lon, lat, alt in line["geometry"]["coordinates"]]
    np.testing.assert_allclose(found_m, PLACES_M, rtol=0, atol=1e-3)


def test_a_recording_has_the_flight_as_ros_2_reads_it(flight: Trajectory) -> None:
    """Each stamp has base_link's place and rotation in the ENU frame map, and its place on the Earth."""
    found: dict[str, list[Any]] = {"/tf": [], "/fix": []}
    reader = make_reader(io.BytesIO(flight_mcap_file(flight)), decoder_factories=[DecoderFactory()])
    for _, channel, _, message in reader.iter_decoded_messages():
        found[channel.topic].append(message)
    instants = zip(found["/tf"], found["/fix"], flight.poses, TIMES_S, strict=True)
    for (transform,), fix, pose, time_s in ((tf.transforms, *others) for tf, *others in instants):
        moved = transform.transform
        place, turn = moved.translation, moved.rotation
        for stamp in (transform.header.stamp, fix.header.stamp):
            assert stamp.sec + 1e-9 * stamp.nanosec == pytest.approx(time_s)
        assert (transform.header.frame_id, transform.child_frame_id) == ("map", "base_link")
        assert [place.x, place.y, place.z] == pose.position_m.tolist()
        turned = Rotation.from_euler("ZYX", (pose.yaw_rad, pose.pitch_rad, pose.roll_rad))
        assert (Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).inv() * turned).magnitude() < 1e-9
        found_m = local_m(fix.latitude, fix.longitude, fix.altitude, ORIGIN)
        assert found_m == pytest.approx(pose.position_m, abs=1e-3)


def test_a_plan_flies_the_same_places_in_the_same_time(flight: Trajectory) -> None:
    """Before each waypoint is its speed; where the flight stands, the plan waits."""
    items = json.loads(flight_plan_file(flight))["mission"]["items"]
    assert [item["doJumpId"] for item in items] == list(range(1, len(items) + 1))
    assert [item["command"] for item in items] == [WAYPOINT, *[CHANGE_SPEED, WAYPOINT] * 4]
    places = [item["params"] for item in items if item["command"] == WAYPOINT]
    found_m = [local_m(lat, lon, up, (*ORIGIN[:2], 0.0)) for *_, lat, lon, up in places]
    np.testing.assert_allclose(found_m, PLACES_M, rtol=0, atol=5e-3)
    speeds_m_s = [item["params"][1] for item in items if item["command"] == CHANGE_SPEED]
    legs_m = np.linalg.norm(np.diff(PLACES_M, axis=0), axis=1)
    waits_s = [params[0] for params in places[1:]]
    np.testing.assert_allclose(legs_m / speeds_m_s + waits_s, np.diff(TIMES_S))
    assert min(speeds_m_s) > 0.0


def test_without_an_origin_there_is_no_map() -> None:
    """A place on the Earth is then not known; all else is written."""
    names = file_names(moving())
    assert {"trajectory.geojson", "trajectory.plan"} == set(names) - set(
        file_names(moving().model_copy(update={"origin": None}))
    )


def test_the_film_is_small(folder: Path) -> None:
    """It has a frame for each instant and is 480 pixels wide."""
    film = (folder / "flight.gif").read_bytes()
    assert (film[:6], int.from_bytes(film[6:8], "little")) == (b"GIF89a", 480)
    assert film.count(b"\x21\xf9\x04") == len(TIMES_S)  # each frame begins with this block


@pytest.mark.parametrize("aim", [Aim.WORST, Aim.MEAN_RATE])
def test_the_figure_over_time_has_values_and_bound_in_the_unit_of_the_aim(aim: Aim) -> None:
    """No value of the flight is above the best of its instant, and the line of the bound is the bound."""
    flight = flown(aim)
    (axes,) = draw_flight(flight, sample_between(flight))["values"].axes
    best, _, values, own, bound = (np.asarray(line.get_ydata(), dtype=float) for line in axes.lines)
    assert np.all(values < best)
    score = np.min(values) if aim.is_worst else np.mean(values)
    assert own == pytest.approx([score] * 2)
    assert bound == pytest.approx([flight.upper_bound] * 2)
