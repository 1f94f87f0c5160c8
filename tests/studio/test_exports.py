"""What is taken away."""

import json
import time

import pytest

from nullpose.errors import UsageError
from nullpose.scenario import Scenario
from nullpose.studio.exports import figure_png, pose_json
from nullpose.studio.session import Session


def test_pose_and_figure_are_of_the_present_scene(paper: Scenario) -> None:
    """The pose is the solver's JSON and the figure a picture; before there is an answer both say so."""
    session = Session(paper, rest_s=0.01)
    for export in (pose_json, figure_png):
        with pytest.raises(UsageError, match="try again"):
            export(session)
    session.start()
    until = time.monotonic() + 120.0
    while session.curve is None or not session.curve.complete:
        assert time.monotonic() < until
        time.sleep(0.02)
    answer = session.answer(session.view.case)
    assert answer is not None
    solved = json.loads(pose_json(session))
    assert solved["pose"]["position_m"] == list(answer.result.pose.position_m)
    assert solved["status"] == "certified"
    assert figure_png(session).startswith(b"\x89PNG")
    assert session.close(120.0)
