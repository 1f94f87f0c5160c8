"""The solution as data: the JSON contract, and a value that is the pose's."""

import copy
import dataclasses
import json
import math
import platform
from collections.abc import Callable
from importlib.metadata import version

import pytest

from nullpose.objectives import RECORDS, USUAL
from nullpose.physics import Link, Pose, evaluate
from nullpose.scenario import Scenario
from nullpose.solver import Objective, Result, Status, solve
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.result import provenance


@pytest.fixture(scope="module")
def solution(paper: Callable) -> Result:
    """Returns the paper's solution at P_M/P = 1."""
    return solve(paper(1.0))


def test_the_json_object_is_the_contract(solution: Result) -> None:
    """The JSON object has the keys that files and programs rely on, in order, and nothing else."""
    data = solution.to_dict()
    assert list(data) == [
        "scenario",
        "scheme",
        "status",
        "reason",
        "rigour",
        "objective",
        "pose",
        "links",
        "binding_node",
        "stats",
        "provenance",
        "note",
        "sensitivity",
    ]
    assert list(data["objective"]) == ["name", "value", "value_db", "upper_bound", "relative_gap"]
    angles = ["roll_rad", "pitch_rad", "yaw_rad", "tilt_rad", "mount_rad"]
    assert list(data["pose"]) == ["position_m", *angles, "antenna_axis", "frames"]
    assert [list(link) for link in data["links"]] == [["node", "sinr", "sinr_db"]] * 2
    assert list(data["stats"]) == ["wall_s", "starts", "evaluations", "boxes"]
    assert {"nullpose", "seed", "gap"} <= set(data["provenance"])


def test_the_json_object_survives_json(solution: Result) -> None:
    """The object goes through strict JSON unchanged, and its scenario loads as the one that was solved."""
    data = solution.to_dict()
    assert json.loads(json.dumps(data, allow_nan=False)) == data
    assert Scenario.from_dict(data["scenario"]) == solution.scenario
    assert (data["scheme"], data["status"], data["objective"]["name"]) == (
        "optimum",
        "certified",
        "min_sinr",
    )


def test_a_certified_solution_has_its_bound(solution: Result) -> None:
    """Bound and gap are numbers that agree, boxes were examined, and no reason is given."""
    data = solution.to_dict()
    objective = data["objective"]
    assert solution.status is Status.CERTIFIED
    assert data["reason"] == ""
    assert objective["value"] <= objective["upper_bound"] <= objective["value"] * (1.0 + 1e-6)
    assert objective["relative_gap"] == pytest.approx(
        objective["upper_bound"] / objective["value"] - 1.0, rel=1e-6
    )
    assert data["stats"]["boxes"] > 0
    assert data["provenance"]["gap"] == 1e-6
    assert len(solution.proofs) == 1


def test_without_a_proof_nothing_is_claimed(paper: Callable) -> None:
    """A search alone has neither bound nor gap, asks for no gap, and its status says so in a sentence."""
    fast = solve(paper(1.0), certify=False)
    data = fast.to_dict()
    assert fast.status is Status.BEST_FOUND
    assert "not proved" in Status.BEST_FOUND.message
    assert (data["objective"]["upper_bound"], data["objective"]["relative_gap"]) == (None, None)
    assert data["stats"]["boxes"] == 0
    assert "gap" not in data["provenance"]
    assert fast.proofs == ()


def test_an_interrupt_is_told_by_its_reason(solution: Result) -> None:
    """Ctrl-C is one reason among others."""
    assert not solution.interrupted
    assert dataclasses.replace(solution, reason=INTERRUPT).interrupted
    assert not dataclasses.replace(solution, reason="the time limit of 1 s").interrupted


def test_the_value_is_that_of_the_reported_angles(solution: Result) -> None:
    """From the numbers of the JSON object alone, roll, pitch and yaw, the physics gives the value again."""
    data = solution.to_dict()
    pose = Pose(
        data["pose"]["position_m"], *(data["pose"][angle] for angle in ("roll_rad", "pitch_rad", "yaw_rad"))
    )
    links = evaluate(Scenario.from_dict(data["scenario"]), pose)
    assert [link.sinr for link in links] == [link["sinr"] for link in data["links"]]
    assert min(link.sinr for link in links) == data["objective"]["value"]
    assert data["objective"]["value_db"] == pytest.approx(10.0 * math.log10(data["objective"]["value"]))
    assert data["pose"]["antenna_axis"] == list(pose.antenna_axis)
    assert data["pose"]["yaw_rad"] == 0.0


def test_a_number_that_json_lacks_is_null(solution: Result) -> None:
    """A link in the null is minus infinity in dB, which JSON cannot hold: it becomes null."""
    silent = dataclasses.replace(
        solution,
        objective=Objective(quantity=RECORDS[USUAL].quantities[0], value=0.0, value_db=-math.inf),
        links=(Link("S1", {"sinr": 0.0, "sinr_db": -math.inf}), solution.links[1]),
    )
    data = json.loads(json.dumps(silent.to_dict(), allow_nan=False))
    assert data["objective"]["value_db"] is None
    assert data["links"][0]["sinr_db"] is None


def test_a_solution_is_frozen(solution: Result) -> None:
    """Neither fields nor provenance can be set, and what to_dict returns is a copy."""
    with pytest.raises(dataclasses.FrozenInstanceError):
        solution.note = "other"
    with pytest.raises(TypeError):
        solution.provenance["seed"] = 9
    before = copy.deepcopy(solution.to_dict())
    data = solution.to_dict()
    data["provenance"]["seed"] = 9
    data["links"][0]["sinr"] = 0.0
    assert solution.to_dict() == before


def test_the_binding_node_has_the_smallest_ratio(solution: Result) -> None:
    """The binding node is the one with the smallest SINR, the first of equals."""
    links = tuple(
        Link(name, {"sinr": ratio, "sinr_db": 0.0})
        for name, ratio in zip("abc", (2.0, 1.0, 1.0), strict=True)
    )
    assert dataclasses.replace(solution, links=links).binding_node == "b"


def test_versions_and_seed_are_there() -> None:
    """The versions of what computed the numbers and the seed are named, ready for JSON."""
    record = provenance(7)
    versions = {name: version(name) for name in ("nullpose", "numba", "numpy")}
    assert record.items() >= (versions | {"python": platform.python_version(), "seed": 7}).items()
    assert json.loads(json.dumps(record, allow_nan=False)) == record
