"""The words for how far a solve has come."""

from nullpose.scenario import Scenario
from nullpose.solve import Status, solve
from nullpose.solve.robust import solve_robust
from nullpose.studio.answer import answer_of, status_words
from nullpose.studio.case import OPTIMUM, case_named


def test_words_follow_what_is_proved(paper: Scenario) -> None:
    """No answer is no answer; a search is the best so far; a proof names its gap."""
    searched = answer_of(3, OPTIMUM, solve(paper, certify=False))
    proved = answer_of(3, OPTIMUM, solve(paper))
    cut = answer_of(3, OPTIMUM, solve(paper, node_limit=1))
    assert status_words(None) == "solving"
    assert status_words(searched) == "best so far"
    assert status_words(proved) == "certified to 1e-6, verifiable"
    assert cut.result.status is Status.GAP_NOT_REACHED
    assert status_words(cut).startswith("best so far, proved to ")
    assert cut.note.startswith("The proof stopped")


def test_a_robust_answer_is_what_is_guaranteed(paper: Scenario) -> None:
    """Its value lies at or below what the pose gives without errors, and is the solver's."""
    unsure = paper.jammers[0].model_copy(update={"uncertainty_m": 2.0})
    scenario = paper.model_copy(update={"jammers": (unsure,)})
    solution = solve_robust(scenario, certify=False)
    answer = answer_of(1, case_named("Robust pose"), solution)
    assert answer.result.objective.value == solution.robust.guaranteed
    assert answer.result.objective.value <= min(link.sinr for link in answer.result.links) * (1.0 + 1e-9)
    assert status_words(answer) == "best so far"
