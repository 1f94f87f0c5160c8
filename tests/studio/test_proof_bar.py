"""The bar between a value and its bound."""

import re

import numpy as np
import pytest

from nullpose import solve
from nullpose.scenario import Scenario
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM
from nullpose.studio.events import Progress
from nullpose.studio.proof_bar import bar_html, gap_words, proof_html
from nullpose.studio.session import Session


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


def test_the_bar_follows_the_proof_of_the_present_scene(
    paper: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Open for what a search finds; then the gap and boxes that the solver reports; closed when proved."""
    monkeypatch.setattr("nullpose.studio.worker.Worker._serve", lambda self, version, view: None)
    session, result = Session(paper), solve(paper)
    session.start()
    session.take(answer_of(1, OPTIMUM, solve(paper, certify=False)))
    assert width(proof_html(session)) == 100.0
    session.take(Progress(version=1, case=OPTIMUM, gap=0.12, target=1e-4, boxes=12345))
    assert "Gap 12 % so far: 12,345 boxes examined" in proof_html(session)
    assert 50.0 < width(proof_html(session)) < 100.0
    session.take(answer_of(1, OPTIMUM, result))
    assert width(proof_html(session)) == 2.0
    assert f"Gap 1e-6: proved in {result.stats.boxes:,} boxes" in proof_html(session)
    session.change(lambda view: view.with_power_db(3.0))
    assert width(proof_html(session)) == 100.0
    session.close()


@pytest.mark.parametrize(("gap", "words"), [(1.0, "100 %"), (0.034, "3.4 %"), (2e-5, "2e-5")])
def test_gaps_are_told_in_per_cent_or_as_small_numbers(gap: float, words: str) -> None:
    """Small ones as the status has them."""
    assert gap_words(gap) == words
