"""The formats by ending: which there are, what each needs, and that a file is whole or not there."""

import io
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import shapely
from earth import local_m
from export_scene import ANGLES_DEG, ORIGIN, POSITION_M
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from pyogrio.raw import read
from scipy.spatial.transform import Rotation

from nullpose import Result
from nullpose.errors import OutputError, UsageError
from nullpose.report.export import EXPORTS, require_exports, write_export
from nullpose.report.export.kml import kml_file
from nullpose.report.export.mcap import mcap_file, require_foxglove

Placed = Callable[..., Result]
ON_EARTH = {".geojson", ".kml", ".plan"}


@pytest.mark.parametrize("ending", EXPORTS)
def test_every_format_is_written(placed: Placed, tmp_path: Path, ending: str) -> None:
    """A file has what its format writes, whatever the case of the ending; a plan alone loses something."""
    result, path = placed("alt_m"), tmp_path / f"pose{ending.upper()}"
    path.write_text("old", encoding="utf-8")
    lost = write_export(result, path)
    assert bool(lost) == (ending == ".plan")
    assert path.read_bytes() == EXPORTS[ending].content(result)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("name", ["pose.xyz", "pose", ".json", "pose.json.gz"])
def test_an_unknown_ending(placed: Placed, tmp_path: Path, name: str) -> None:
    """Any other ending is refused, before a solve and at the end, with those that are allowed."""
    result, path = placed("alt_m"), tmp_path / name
    for refused in (lambda: require_exports(result.scenario, [path]), lambda: write_export(result, path)):
        with pytest.raises(UsageError, match=r"given .*; allowed endings: \.json, \.tum, \.csv, .*\.mcap$"):
            refused()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ending", EXPORTS)
def test_what_needs_an_origin(placed: Placed, tmp_path: Path, ending: str) -> None:
    """Formats of maps and of autopilots need one; the others are written without."""
    scenario = placed("alt_m").scenario.model_copy(update={"origin": None})
    path = tmp_path / f"pose{ending}"
    if ending in ON_EARTH:
        with pytest.raises(UsageError, match="has no origin"):
            require_exports(scenario, [path])
    else:
        require_exports(scenario, [path])


def test_a_fault_leaves_what_was_there(placed: Placed, tmp_path: Path) -> None:
    """A folder in the way is a message, and nothing else is left behind."""
    (tmp_path / "pose.kml").mkdir()
    with pytest.raises(OutputError, match="in the way"):
        write_export(placed("alt_m"), tmp_path / "pose.kml")
    assert [path.name for path in tmp_path.iterdir()] == ["pose.kml"]


def columns(content: bytes) -> tuple[dict[str, list[object]], np.ndarray]:
    """Returns what GDAL reads: the fields by name, and longitude, latitude and altitude of each point."""
    about, _, geometry, fields = read(content)
    return dict(zip(about["fields"], map(list, fields), strict=True)), shapely.get_coordinates(
        shapely.from_wkb(geometry), include_z=True
    )


@pytest.mark.parametrize(
    ("stated", "mode", "base_m"),
    [
        (("alt_m",), "relativeToGround", 0.0),  # over the ellipsoid, which KML does not know
        (("alt_msl_m",), "absolute", 185.0),
        (("alt_m", "alt_msl_m"), "absolute", 185.0),
    ],
)
def test_points_are_where_the_scenario_has_them(
    placed: Placed, stated: tuple[str, ...], mode: str, base_m: float
) -> None:
    """Longitude and latitude in this order; altitudes over the sea, or over the ground at the origin."""
    result = placed(*stated)
    fields, coordinates = columns(kml_file(result))
    scenario = result.scenario
    places_m = [result.pose.position_m, *scenario.node_positions_m, *scenario.jammer_positions_m]
    for (lon_deg, lat_deg, altitude_m), place_m in zip(coordinates, places_m, strict=True):
        found_m = local_m(lat_deg, lon_deg, altitude_m, (*ORIGIN[:2], base_m))
        np.testing.assert_allclose(found_m, place_m, rtol=0, atol=2e-3)
    assert set(fields["altitudeMode"]) == {mode}
    assert fields["Name"][1:] == [*scenario.node_names, *scenario.jammer_names]
    assert fields["kind"] == ["pose", "node", "node", "jammer"]
    angles = {name: float(fields[f"enu_{name}"][0]) for name in ANGLES_DEG}
    assert angles == pytest.approx(ANGLES_DEG)


def test_names_are_escaped(placed: Placed) -> None:
    """A name with marks of XML is the name that any reader finds."""
    result = placed("alt_m")
    jammer = result.scenario.jammers[0].model_copy(update={"name": '<van> & "co"'})
    scenario = result.scenario.model_copy(update={"jammers": (jammer,)})
    root = ElementTree.fromstring(kml_file(replace(result, scenario=scenario)))
    *_, name = root.findall(".//{*}name")
    assert name.text == '<van> & "co"'


def test_without_an_origin(placed: Placed) -> None:
    """A scenario that lies nowhere on the Earth is refused, with what to add."""
    result = placed("alt_m")
    nowhere = result.scenario.model_copy(update={"origin": None})
    with pytest.raises(UsageError, match=r"KML.*has no origin.*add a table headed \[origin\]"):
        kml_file(replace(result, scenario=nowhere))


def messages(result: Result) -> dict[str, tuple[str, Any]]:
    """Returns schema and message by topic, one each, at t = 0."""
    reader = make_reader(io.BytesIO(mcap_file(result)), decoder_factories=[DecoderFactory()])
    found = {
        channel.topic: (schema.name, decoded)
        for schema, channel, message, decoded in reader.iter_decoded_messages()
        if message.log_time == 0
    }
    assert reader.get_summary().statistics.message_count == len(found)
    return found


def place_and_rotation(pose: Any) -> tuple[list[float], Rotation]:
    """Returns metres and the rotation of a pose in a message."""
    place, turn = pose.position, pose.orientation
    return [place.x, place.y, place.z], Rotation.from_quat([turn.x, turn.y, turn.z, turn.w])


def test_the_pose_is_a_message(placed: Placed, turned: Rotation) -> None:
    """Topic /pose has a foxglove.PoseInFrame in ENU: metres, and the rotation to the world from the body."""
    name, message = messages(placed("alt_m"))["/pose"]
    assert (name, message.frame_id) == ("foxglove.PoseInFrame", "enu")
    place_m, rotation = place_and_rotation(message.pose)
    assert place_m == list(POSITION_M)
    assert (rotation.inv() * turned).magnitude() < 1e-12


def test_the_scene_has_every_point(placed: Placed) -> None:
    """Topic /scene has a named sphere for pose, nodes and jammers, where the scenario has them."""
    result = placed("alt_m")
    name, message = messages(result)["/scene"]
    arrow, *points = message.entities
    scenario = result.scenario
    assert name == "foxglove.SceneUpdate"
    assert [each.texts[0].text for each in points[1:]] == [*scenario.node_names, *scenario.jammer_names]
    places_m = [place_and_rotation(each.spheres[0].pose)[0] for each in points]
    expected = [result.pose.position_m, *scenario.node_positions_m, *scenario.jammer_positions_m]
    np.testing.assert_array_equal(places_m, expected)
    assert {each.frame_id for each in message.entities} == {"enu"}
    assert [len(each.arrows) for each in message.entities] == [1, 0, 0, 0, 0]
    place_m, rotation = place_and_rotation(arrow.arrows[0].pose)
    assert place_m == list(POSITION_M)
    np.testing.assert_allclose(rotation.apply([1.0, 0.0, 0.0]), result.pose.antenna_axis, rtol=0, atol=1e-12)


def test_without_the_library(placed: Placed, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where foxglove-sdk is not installed, the message says what to install."""
    monkeypatch.setattr("nullpose.report.export.mcap.find_spec", lambda _: None)
    path = tmp_path / "pose.mcap"
    for refused in (
        lambda: require_foxglove(placed("alt_m").scenario),
        lambda: write_export(placed("alt_m"), path),
    ):
        with pytest.raises(UsageError, match=r"pip install -e '\.\[flight\]'"):
            refused()
    assert not path.exists()
