"""The panel's numbers."""

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from nullpose import load
from nullpose.errors import ScenarioError
from nullpose.report.numbers import MINUS
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.solver import solve
from nullpose.studio.answer import answer_of
from nullpose.studio.card import card_html
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.readout import failure_html, readout_html
from nullpose.studio.state import State
from nullpose.studio.steps import quick_answers


class _Text(HTMLParser):
    def __init__(self, html: str) -> None:
        super().__init__()
        self.text = ""
        self.open: list[str] = []
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag != "br":
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_two_cases_differ_by_what_is_known_of_both(unsure: Scenario) -> None:
    """A robust case counts with what it guarantees, once that is known, and it is said that it does."""
    robust = case_named("Robust pose")
    state = State(scenario=unsure, compared=robust)
    (first,) = quick_answers(state, OPTIMUM)
    state = state.with_event(first).with_event(replace(first, case=robust))
    assert 'data-np="difference"' not in readout_html(state)
    guarded = answer_of(1, robust, solve(unsure, robust=True, certify=False))
    difference = f"{first.shown_value - guarded.shown_value:z.2f}"
    text = _Text(readout_html(state.with_event(guarded))).text
    assert f"A over B: {difference} dB (B guaranteed, A without errors)" in text


def test_the_worst_node_has_the_smallest_number(unsure: Scenario) -> None:
    """Beside each node of a robust case stands what it is guaranteed, and the smallest is the value."""
    robust = case_named("Robust pose")
    guarded = answer_of(1, robust, solve(unsure, robust=True, certify=False))
    html = readout_html(State(scenario=unsure, case=robust).with_event(guarded))
    (table,) = re.findall(r'<table data-np="guaranteed".*</table>', html, re.DOTALL)
    found = re.findall(r"<td>(\w+)</td><td[^>]*>([^<]+)</td><td[^>]*>([^<]+)</td><td>([^<]*)</td>", table)
    numbers = {row[0]: float(row[2].replace(MINUS, "-")) for row in found}
    (worst,) = (row[0] for row in found if "worst" in row[3])
    assert list(numbers) == [link.node for link in guarded.result.links]
    assert numbers[worst] == min(numbers.values()) == pytest.approx(guarded.shown_value, abs=0.006)
    assert "guaranteed SINR" in _Text(html).text


def test_a_margin_stands_beside_the_node_that_it_decides(paper: Scenario) -> None:
    """Where nodes require an SINR, each has its margin shown, of which the smallest decides."""
    nodes = (paper.nodes[0].model_copy(update={"min_sinr_db": 3.0}), paper.nodes[1])
    state = State(scenario=paper.model_copy(update={"nodes": nodes}))
    (answer,) = quick_answers(state, OPTIMUM)
    text = _Text(readout_html(state.with_event(answer))).text
    for link in answer.result.links:
        assert link.margin_db is not None
        assert f"margin {link.margin_db:z.2f} dB".replace("-", MINUS) in text


def test_what_is_left_out_is_said(unsure: Scenario) -> None:
    """The optimum of a scene with errors says that they are left out; a robust pose does not."""
    array = load(Path(__file__).parents[2] / "examples" / "array.toml")
    robust = case_named("Robust pose")
    for write in (readout_html, card_html):
        assert "errors of the file are left out" in _Text(write(State(scenario=unsure))).text
        assert "left out" not in _Text(write(State(scenario=unsure, case=robust))).text
        assert "array of the file is not shown" in _Text(write(State(scenario=array))).text


def test_faults_are_listed_by_their_path() -> None:
    """Each fault of a file stands with its path, markup in it being harmless."""
    with pytest.raises(ScenarioError) as raised:
        scenario_from_text(b'[[nodes]]\n"<b>x" = 1\n', "<i>.toml")
    html = failure_html(raised.value, "<i>.toml")
    text = _Text(html)
    assert text.open == []
    assert "<i>.toml was not taken" in text.text
    assert "airspace" in text.text
    assert "<i>" not in html
