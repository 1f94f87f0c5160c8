"""What a robust solve hands back."""

import json
from dataclasses import replace

import pytest

from nullpose.solver import Result


def test_as_plain_data(solved: Result) -> None:
    """The solution is plain data with both poses, their values and errors, and what is proved."""
    data = json.loads(json.dumps(solved.to_dict(), allow_nan=False))
    assert data["status"] == "certified"
    assert data["upper_bound"] == solved.objective.upper_bound
    assert data["relative_gap"] == solved.objective.relative_gap
    assert data["error_cases"] == solved.details.cases
    assert data["stats"]["boxes"] == solved.stats.boxes
    for key, held in (("robust", solved.details.robust), ("nominal", solved.details.nominal)):
        one = data[key]
        assert one["guaranteed"] == held.guaranteed == min(node["guaranteed"] for node in one["nodes"])
        assert one["worst_found"] == held.worst == min(node["worst_found"] for node in one["nodes"])
        assert one["nominal"] == held.nominal == pytest.approx(min(node["nominal"] for node in one["nodes"]))
        assert one["position_m"] == [float(x) for x in held.pose.position_m]
        assert one["worst_case_errors"]["axis_error_deg"] == pytest.approx(2.0, rel=1e-9)
        assert one["worst_case"].startswith("axis 2 deg off")
        assert [node["node"] for node in one["nodes"]] == ["S1", "S2"]


def test_gap_and_gain(solved: Result) -> None:
    """The gap is the bound over the guaranteed value less one; the gain compares both poses' guarantees."""
    assert solved.objective.upper_bound is not None
    assert solved.objective.relative_gap == pytest.approx(
        solved.objective.upper_bound / solved.details.robust.guaranteed - 1.0
    )
    assert solved.label == solved.scheme == "robust"
    assert solved.details.gain == pytest.approx(
        solved.details.robust.guaranteed / solved.details.nominal.guaranteed
    )
    assert replace(solved.details, nominal=solved.details.robust).gain == 1.0


def test_the_answer_cannot_be_changed(solved: Result) -> None:
    """Provenance and arrays are read-only."""
    with pytest.raises(TypeError):
        solved.provenance["seed"] = 1  # type: ignore[index]
    with pytest.raises(ValueError, match="read-only"):
        solved.details.robust.guarantee.position_m[0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        solved.details.robust.guarantee.case.jammer_offsets_m[0] = 0.0
