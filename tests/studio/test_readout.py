"""The panel's numbers."""

import re
from dataclasses import replace
from html import unescape
from pathlib import Path
from xml.etree import ElementTree

import pytest

from nullpose import load
from nullpose.errors import ScenarioError
from nullpose.report.numbers import MINUS
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.solver import solve
from nullpose.studio.answer import Answer, answer_of
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.readout import card_html, macros, readout_html
from nullpose.studio.state import State
from nullpose.studio.worker import quick_answers

ROBUST = case_named("Robust pose")


@pytest.fixture
def guarded(unsure: Scenario) -> Answer:
    """The robust answer, before there is a proof."""
    return answer_of(1, ROBUST, solve(unsure, robust=True, certify=False))


def _text(html: str) -> str:
    return unescape(re.sub("<[^>]*>", "", html))


def test_two_cases_differ_by_what_is_known_of_both(unsure: Scenario, guarded: Answer) -> None:
    """A robust case counts with what it guarantees, once that is known, and it is said that it does."""
    state = State(scenario=unsure, compared=ROBUST)
    (first,) = quick_answers(state, OPTIMUM)
    state = state.with_event(first).with_event(replace(first, case=ROBUST))
    assert 'data-np="difference"' not in readout_html(state)
    difference = f"{first.shown_value - guarded.shown_value:z.2f}"
    text = _text(readout_html(state.with_event(guarded)))
    assert f"A over B: {difference} dB (B guaranteed, A without errors)" in text


def test_the_worst_node_has_the_smallest_number(unsure: Scenario, guarded: Answer) -> None:
    """Beside each node of a robust case stands what it is guaranteed, and the smallest is the value."""
    html = readout_html(State(scenario=unsure, case=ROBUST).with_event(guarded))
    (table,) = re.findall(r'<table data-np="guaranteed".*</table>', html, re.DOTALL)
    found = re.findall(r"<td>(\w+)</td><td[^>]*>([^<]+)</td><td[^>]*>([^<]+)</td><td>([^<]*)</td>", table)
    numbers = {row[0]: float(row[2].replace(MINUS, "-")) for row in found}
    (worst,) = (row[0] for row in found if "worst" in row[3])
    assert list(numbers) == [link.node for link in guarded.result.links]
    assert numbers[worst] == min(numbers.values()) == pytest.approx(guarded.shown_value, abs=0.006)
    assert "guaranteed SINR" in _text(card_html(State(scenario=unsure, case=ROBUST).with_event(guarded)))


def test_a_margin_stands_beside_the_node_that_it_decides(paper: Scenario) -> None:
    """Where nodes require an SINR, each has its margin shown, of which the smallest decides."""
    nodes = (paper.nodes[0].model_copy(update={"min_sinr_db": 3.0}), paper.nodes[1])
    state = State(scenario=paper.model_copy(update={"nodes": nodes}))
    (answer,) = quick_answers(state, OPTIMUM)
    text = _text(readout_html(state.with_event(answer)))
    for link in answer.result.links:
        assert link.margin_db is not None
        assert f"margin {link.margin_db:z.2f} dB".replace("-", MINUS) in text


def test_what_is_left_out_is_said(unsure: Scenario) -> None:
    """The optimum of a scene with errors says that they are left out; a robust pose does not."""
    array = load(Path(__file__).parents[2] / "examples" / "array.toml")
    assert "errors of the file are left out" in _text(card_html(State(scenario=unsure)))
    assert "left out" not in _text(card_html(State(scenario=unsure, case=ROBUST)))
    assert "array of the file is not shown" in _text(card_html(State(scenario=array)))


def test_faults_are_listed_by_their_path() -> None:
    """Each fault of a file stands with its path, markup in it being harmless."""
    with pytest.raises(ScenarioError) as raised:
        scenario_from_text(b'[[nodes]]\n"<b>x" = 1\n', "<i>.toml")
    html = str(macros().faults(raised.value, "<i>.toml"))
    assert "<i>.toml was not taken" in _text(html)
    assert "airspace" in html
    assert not re.search("<i>|<b>x", html)
    ElementTree.fromstring(f"<div>{html.replace('<br>', '<br/>')}</div>")
