"""The bar between a value and its bound."""

import re

import numpy as np
import pytest

from nullpose import solve
from nullpose.scenario import Scenario
from nullpose.solver.proof_steps import ProofStep, proof_steps
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM
from nullpose.studio.events import Progress
from nullpose.studio.proof_bar import answer_bar, bar_html, gap_words, open_words, progress_bar, step_bar


def width(bar: str) -> float:
    """Return how much of the bar is open, per cent."""
    found = re.search(r"width:([0-9.]+)%", bar)
    assert found is not None
    return float(found.group(1))


def test_the_bar_closes_as_the_gap_falls_to_the_one_aimed_at() -> None:
    """It is open without a bound and at 100 %, half open half way on the log scale, and all but closed."""
    widths = [width(bar_html("", gap, 1e-6, "")) for gap in (np.inf, 1.0, 1e-3, 1e-6, 1e-8)]
    assert widths[:2] == [100.0, 100.0]
    assert widths[2] == pytest.approx(51.0)
    assert widths[3] == widths[4] == 2.0


def test_an_answer_without_a_bound_has_no_bar(paper: Scenario) -> None:
    """What is found by a search alone is not shown as proved."""
    assert answer_bar(answer_of(1, OPTIMUM, solve(paper, certify=False))) == ""


def test_a_proved_answer_closes_the_bar(paper: Scenario) -> None:
    """The words have the gap and the boxes of the result."""
    result = solve(paper)
    bar = answer_bar(answer_of(1, OPTIMUM, result))
    assert width(bar) == 2.0
    assert f"Gap 1e-6: proved in {result.stats.boxes:,} boxes" in bar


def test_a_proof_that_runs_tells_its_gap_and_its_boxes() -> None:
    """The numbers are those that the solver told."""
    bar = progress_bar(Progress(version=1, case=OPTIMUM, gap=0.12, target=1e-4, boxes=12345))
    assert "Gap 12 % so far: 12,345 boxes examined" in bar
    assert 50.0 < width(bar) < 100.0


def test_a_step_has_its_own_bound_and_boxes_and_the_last_one_closes_the_bar(paper: Scenario) -> None:
    """The bound is the value and the step's gap above it."""
    result = solve(paper)
    steps = proof_steps(result)
    middle = steps[len(steps) // 2]
    bound_db = 10.0 * np.log10(result.objective.value * (1.0 + middle.gap))
    assert f"bound {bound_db:.4f} dB" in step_bar(result, middle, steps[-1])
    assert f"{len(middle.half_m)} boxes within" in step_bar(result, middle, steps[-1])
    assert "no box left" in step_bar(result, steps[-1], steps[-1])
    assert width(step_bar(result, steps[-1], steps[-1])) == 2.0


def test_the_distance_in_words_is_that_of_the_farthest_corner(paper: Scenario) -> None:
    """It is rounded up, so that no box reaches farther than it says."""
    result = solve(paper, certify=False)
    away_m = result.pose.position_m + np.array([[20.0, 0.0, 0.0]])
    one = ProofStep(gap=0.1, centre_m=away_m, half_m=np.full((1, 3), 2.0))
    assert open_words(one, result) == "1 box within 23 m"  # 22.2 m


@pytest.mark.parametrize(("gap", "words"), [(1.0, "100 %"), (0.034, "3.4 %"), (2e-5, "2e-5")])
def test_gaps_are_told_in_per_cent_or_as_small_numbers(gap: float, words: str) -> None:
    """Small ones as the status has them."""
    assert gap_words(gap) == words
