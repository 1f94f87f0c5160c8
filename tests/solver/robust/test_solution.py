"""What a robust solve hands back."""

import json
from collections.abc import Callable
from dataclasses import replace

import pytest

from nullpose.objectives import Quantity
from nullpose.solver.robust import RobustSolution


def test_as_plain_data(solved: RobustSolution) -> None:
    """The solution is plain data with both poses, their values and errors, and what is proved."""
    data = json.loads(json.dumps(solved.to_dict(), allow_nan=False))
    assert data["status"] == "certified"
    assert data["upper_bound"] == solved.upper_bound
    assert data["relative_gap"] == solved.relative_gap
    assert data["error_cases"] == solved.cases
    assert data["stats"]["boxes"] == solved.stats.boxes
    for key, held in (("robust", solved.robust), ("nominal", solved.nominal)):
        one = data[key]
        assert one["guaranteed"] == held.guaranteed == min(node["guaranteed"] for node in one["nodes"])
        assert one["worst_found"] == held.worst == min(node["worst_found"] for node in one["nodes"])
        assert one["nominal"] == held.nominal == pytest.approx(min(node["nominal"] for node in one["nodes"]))
        assert one["position_m"] == [float(x) for x in held.pose.position_m]
        assert one["worst_case_errors"]["axis_error_deg"] == pytest.approx(2.0, rel=1e-9)
        assert one["worst_case"].startswith("axis 2 deg off")
        assert [node["node"] for node in one["nodes"]] == ["S1", "S2"]


def test_gap_and_gain(solved: RobustSolution) -> None:
    """The gap is the bound over the guaranteed value less one; the gain compares both poses' guarantees."""
    assert solved.upper_bound is not None
    assert solved.relative_gap == pytest.approx(solved.upper_bound / solved.robust.guaranteed - 1.0)
    assert solved.label == solved.scheme == "robust"
    assert solved.gain == pytest.approx(solved.robust.guaranteed / solved.nominal.guaranteed)
    assert replace(solved.details, nominal=solved.robust).gain == 1.0


def test_the_answer_cannot_be_changed(solved: RobustSolution) -> None:
    """Provenance and arrays are read-only."""
    with pytest.raises(TypeError):
        solved.provenance["seed"] = 1  # type: ignore[index]
    with pytest.raises(ValueError, match="read-only"):
        solved.robust.guarantee.position_m[0] = 0.0
    with pytest.raises(ValueError, match="read-only"):
        solved.robust.guarantee.case.jammer_offsets_m[0] = 0.0


def test_ratios_are_worth_a_rate_with_secrecy(paper: Callable, listened: Callable) -> None:
    """A ratio is worth itself, or with secrecy rates its logarithm to base 2, never below zero."""
    assert Quantity.of(paper(1.0)).of_ratio(0.25) == 0.25
    assert Quantity.of(listened(paper(1.0))).of_ratio(8.0) == 3.0
    assert Quantity.of(listened(paper(1.0))).of_ratio(0.5) == 0.0
