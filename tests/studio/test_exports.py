"""What is taken away."""

import ast
import json
import time
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from nullpose.errors import UsageError
from nullpose.scenario import Scenario
from nullpose.studio import exports
from nullpose.studio.answer import PowerCurve
from nullpose.studio.exports import figure_png, pose_json
from nullpose.studio.session import Session
from nullpose.studio.state import State

STUDIO = Path(exports.__file__).parent


def test_pose_and_figure_are_of_the_present_scene(paper: Scenario) -> None:
    """The pose is the solver's JSON, the figure a picture; before there is an answer both say so."""
    session = Session(State(scenario=paper), rest_s=0.01)
    for export in (pose_json, figure_png):
        with pytest.raises(UsageError, match="try again"):
            export(session.state)
    session.start()
    until = time.monotonic() + 600.0
    while (curve := session.state.latest(PowerCurve)) is None or not curve.complete:
        assert time.monotonic() < until
        time.sleep(0.02)
    answer = session.state.answer(session.state.case)
    assert answer is not None
    solved = json.loads(pose_json(session.state))
    assert solved["pose"]["position_m"] == list(answer.result.pose.position_m)
    assert solved["status"] == "certified"
    assert figure_png(session.state).startswith(b"\x89PNG")
    assert session.close(600.0)


def test_no_module_of_the_studio_needs_itself_by_way_of_others() -> None:
    """Neither as it is loaded nor later: pages export, and what exports knows nothing of pages."""
    needs = {
        path.stem: {
            node.module.removeprefix("nullpose.studio.")
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("nullpose.studio.")
        }
        for path in STUDIO.glob("*.py")
    }
    assert "exports" in set().union(*needs.values())
    TopologicalSorter(needs).prepare()
