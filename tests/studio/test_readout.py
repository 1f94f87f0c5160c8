"""The panel's numbers."""

from dataclasses import replace
from html.parser import HTMLParser

import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.readout import about_html, failure_html, readout_html
from nullpose.studio.session import Session
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


@pytest.fixture
def idle(paper: Scenario, monkeypatch: pytest.MonkeyPatch) -> Session:
    """A session whose worker never answers."""
    monkeypatch.setattr("nullpose.studio.worker.Worker._serve", lambda self, version, view: None)
    session = Session(paper)
    session.start()
    return session


def test_without_an_answer_there_are_no_numbers(idle: Session) -> None:
    """Before the first answer it says that it is solving, and no value is shown."""
    html = readout_html(idle)
    assert "solving" in _Text(html).text
    assert "data-value" not in html
    assert idle.close()


def test_two_cases_differ_by_what_is_known_of_both(idle: Session) -> None:
    """A robust case counts with what it guarantees, once that is known, and it is said that it does."""
    robust = case_named("Robust pose")
    idle.change(lambda view: view.with_compared(robust))
    (first,) = quick_answers(idle.version, idle.view, OPTIMUM)
    objective = first.result.objective
    half = replace(objective, value=0.5 * objective.value)
    second = replace(first, case=robust, result=replace(first.result, objective=half))
    idle._take(first)
    idle._take(second)
    assert 'data-np="difference"' not in readout_html(idle)
    known = replace(half, upper_bound=0.6 * objective.value)
    idle._take(replace(second, result=replace(first.result, objective=known)))
    assert "A over B: 3.01 dB (B guaranteed, A without errors)" in _Text(readout_html(idle)).text
    assert idle.close()


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


def test_the_explanation_is_short_and_closed() -> None:
    """What am I looking at fits a panel."""
    text = _Text(about_html())
    assert text.open == []
    assert len(text.text.split()) < 110
