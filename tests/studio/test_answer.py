"""The words for how far a solve has come."""

import re

from nullpose.scenario import Scenario
from nullpose.solver import Status, solve
from nullpose.studio.answer import answer_of, signed, status_words, with_errors
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.state import State


def test_words_follow_what_is_proved(paper: Scenario) -> None:
    """No answer is no answer; a search is the best so far; a proof names its gap."""
    searched = answer_of(3, OPTIMUM, solve(paper, certify=False))
    proved = answer_of(3, OPTIMUM, solve(paper))
    cut = answer_of(3, OPTIMUM, solve(paper, node_limit=1))
    assert status_words(None) == "solving"
    assert status_words(searched) == "Best found so far"
    assert status_words(proved) == "Proved optimal (gap 0.0001 %)"
    assert cut.result.status is Status.GAP_NOT_REACHED
    assert cut.result.objective.upper_bound is not None
    below = 1.0 - cut.result.objective.value / cut.result.objective.upper_bound
    words = re.fullmatch(r"At most ([\d.]+) % below the optimum", status_words(cut))
    assert words is not None
    assert 100.0 * below <= float(words[1]) <= 103.0 * below
    assert cut.note.startswith("The proof stopped")


def test_a_robust_answer_is_what_is_guaranteed(unsure: Scenario) -> None:
    """Its value is the solver's, at or below what the pose gives without errors, which it allows for."""
    solution = solve(unsure, robust=True, certify=False)
    answer = answer_of(1, case_named("Robust pose"), solution)
    assert answer.result.objective.value == solution.details.robust.guaranteed
    assert answer.result.objective.value <= min(link.sinr for link in answer.result.links) * (1.0 + 1e-9)
    assert status_words(answer) == "Best found so far"
    assert with_errors(answer).errors == ()


def test_the_loss_under_errors_is_that_of_the_result(paper: Scenario) -> None:
    """With a sentence on the null if it is above 3 dB."""
    far = State(scenario=paper).moved(("jammers", 0), (9e3, 9e3, 4.0)).scenario
    for scenario in (paper, far):
        found = solve(scenario, certify=False)
        assert found.sensitivity is not None
        errors = with_errors(answer_of(1, OPTIMUM, found)).errors
        loss_db = found.sensitivity.loss_db()
        assert errors[0].startswith(f"can lose {signed(loss_db)} dB or more")
        assert (len(errors) > 1 and "null (towards M)" in errors[1]) == (loss_db > 3.0)
