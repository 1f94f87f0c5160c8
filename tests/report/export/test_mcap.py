"""A recording for Foxglove, read by the reader of the format's authors."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from export_scene import POSITION_M
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from scipy.spatial.transform import Rotation

from nullpose import Result
from nullpose.errors import UsageError
from nullpose.report.export import write_export
from nullpose.report.export.mcap import mcap_file, require_foxglove

Placed = Callable[..., Result]


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
