"""All the cases of one scenario, with a reason for each that is missing."""

from nullpose import Scenario
from nullpose.study import compare_schemes


def test_the_optimum_is_the_best(field: Scenario) -> None:
    """No case beats the optimum."""
    optimum, *others = compare_schemes(field).rows
    assert all(other.objective.value <= optimum.objective.value for other in others)


def test_what_does_not_apply_has_its_reason(paper: Scenario) -> None:
    """Without a jammer zero interference is reported, not dropped."""
    comparison = compare_schemes(Scenario.from_dict({**paper.to_dict(), "jammers": []}))
    ((scheme, reason),) = comparison.left_out.items()
    assert scheme == "zero-interference"
    assert "jammer" in reason
    assert len(comparison.to_dict()["rows"]) == 3


def test_progress_counts_the_cases(paper: Scenario) -> None:
    """Each case is one step."""
    ticks: list[tuple[int, int]] = []
    compare_schemes(paper, on_progress=lambda *tick: ticks.append(tick))
    assert ticks == [(1, 4), (2, 4), (3, 4), (4, 4)]
