"""The card that stays on the page."""

import re
from dataclasses import replace

import numpy as np
import pytest

from nullpose import solve
from nullpose.report.numbers import MINUS
from nullpose.scenario import Scenario
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.events import Notice
from nullpose.studio.overlay import Scale, overlay_html
from nullpose.studio.readout import readout_html
from nullpose.studio.session import Session
from nullpose.study.value_map import Field


@pytest.fixture
def idle(paper: Scenario, monkeypatch: pytest.MonkeyPatch) -> Session:
    """A session whose worker never answers."""
    monkeypatch.setattr("nullpose.studio.worker.Worker._serve", lambda self, version, view: None)
    session = Session(paper)
    session.start()
    return session


@pytest.fixture
def proved(idle: Session, paper: Scenario) -> Session:
    """A session with a proved answer."""
    idle.take(answer_of(idle.version, OPTIMUM, solve(paper)))
    return idle


def _scale(low: float, high: float) -> Scale:
    grid = np.linspace(0.0, 1.0, 3)
    field = Field(
        east_m=grid,
        north_m=grid,
        altitude_m=8.0,
        values=np.zeros((3, 3)),
        unit="dB",
        title="best <SINR>",
        name="best",
    )
    return Scale(field=field, ends=(low, high), of_value=True, links_db=(low, high))


def test_it_says_what_the_panel_says(proved: Session) -> None:
    """The same value with its unit, bound, status and rigour."""
    answer = proved.current(OPTIMUM)
    assert answer is not None
    html, bound = overlay_html(proved), answer.result.objective.upper_bound
    assert bound is not None
    value = f"{answer.shown_value:z.4f}".replace("-", MINUS)
    assert f">{value} dB<" in html
    assert f"upper bound {answer.result.objective.quantity.in_unit(bound):z.4f} dB" in html
    assert "certified to 1e-6, verifiable" in html
    for name in ("data-value", "data-version"):
        (own,), panel = set(re.findall(f'{name}="([^"]+)"', html)), readout_html(proved)
        assert f'{name}="{own}"' in panel
    proved.close()


def test_what_is_of_an_older_scene_is_grey(proved: Session) -> None:
    """Until there is an answer to the present one."""
    assert "np-old" not in overlay_html(proved)
    proved.change(lambda view: view.with_power_db(20.0))
    assert "np-old" in overlay_html(proved)
    assert "solving" in overlay_html(proved)
    proved.close()


def test_while_the_solver_is_compiled_it_says_so(idle: Session) -> None:
    """There is no number then."""
    idle.take(Notice(version=idle.version, case=None, words="compiling the solver"))
    html = overlay_html(idle)
    assert "compiling the solver" in html
    assert "data-value" not in html
    idle.close()


def test_what_is_left_out_is_said(idle: Session, paper: Scenario) -> None:
    """As the panel says it."""
    jammer = paper.jammers[0].model_copy(update={"uncertainty_m": 2.0})
    idle.change(lambda view: view.with_scenario(paper.model_copy(update={"jammers": (jammer,)})))
    assert "The errors of the file are left out" in overlay_html(idle)
    idle.close()


def test_two_cases_are_both_there(proved: Session, paper: Scenario) -> None:
    """Each with its letter."""
    vertical = case_named("Vertical")
    proved.change(lambda view: view.with_compared(vertical))
    for case in (OPTIMUM, vertical):
        proved.take(answer_of(proved.version, case, solve(paper, case.scheme)))
    html = overlay_html(proved)
    assert re.findall(r'class="np-label">(\w: [^<]+)<', html) == [f"A: {OPTIMUM.label}", "B: Vertical"]
    assert len(re.findall("data-value=", html)) == 2
    proved.close()


def test_the_value_is_marked_where_it_is_on_the_scale(proved: Session) -> None:
    """On the map of the values; not on that of another quantity, nor beyond the ends."""
    answer = proved.current(OPTIMUM)
    assert answer is not None
    value = answer.shown_value
    html = overlay_html(proved, _scale(value - 3.0, value + 1.0))
    assert 'data-np="overlay-tick" style="left:75.0%"' in html
    assert "best &lt;SINR&gt;" in html
    whole = overlay_html(proved, _scale(-10.0, 2.0))
    assert f"<span>{MINUS}10</span><span>2 dB</span>" in whole
    other = _scale(value - 3.0, value + 1.0)._replace(of_value=False, links_db=(-6.0, 12.0))
    assert "lines to nodes: the same colours<" in whole
    assert f"lines to nodes: the same colours from {MINUS}6 to 12 dB<" in overlay_html(proved, other)
    for unmarked in (other, _scale(value + 1.0, value + 2.0)):
        assert "overlay-tick" not in overlay_html(proved, unmarked)
    proved.close()


def test_a_guaranteed_value_is_not_marked_on_a_map_without_errors(proved: Session) -> None:
    """Their values are not of the same thing."""
    answer = proved.current(OPTIMUM)
    assert answer is not None
    robust = case_named("Robust pose")
    proved.history = replace(
        proved.history, present=proved.view.with_scenario(proved.view.scenario).with_case(robust)
    )
    proved.take(replace(answer, case=robust))
    assert "overlay-tick" not in overlay_html(proved, _scale(-50.0, 50.0))
    proved.close()
