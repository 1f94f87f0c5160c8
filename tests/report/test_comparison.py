"""All the cases of one scenario, with a reason for each that is missing."""

from nullpose import Scenario
from nullpose.report.comparison import compare_all


def test_the_optimum_is_the_best(field: Scenario) -> None:
    """No case beats the optimum."""
    optimum, *others = compare_all(field).solutions
    assert all(other.objective.value <= optimum.objective.value for other in others)


def test_what_does_not_apply_has_its_reason(paper: Scenario) -> None:
    """Without a jammer zero interference is reported, not dropped."""
    comparison = compare_all(Scenario.from_dict({**paper.to_dict(), "jammers": []}))
    ((scheme, reason),) = comparison.left_out
    assert scheme == "zero-interference"
    assert "jammer" in reason
    cases = comparison.to_dict()["cases"]
    assert [case["status"] for case in cases].count("not-applicable") == 1
    assert len(cases) == 4


def test_progress_counts_the_cases(paper: Scenario) -> None:
    """Each case is one step."""
    ticks: list[tuple[int, int]] = []
    compare_all(paper, on_progress=lambda *tick: ticks.append(tick))
    assert ticks == [(1, 4), (2, 4), (3, 4), (4, 4)]
