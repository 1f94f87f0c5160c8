"""The card that stays on the page."""

import re
from dataclasses import replace

import numpy as np
import pytest

from nullpose import Scenario, load, solve
from nullpose.report.numbers import MINUS
from nullpose.solver import Result
from nullpose.studio.answer import Notice, Progress, answer_of, signed
from nullpose.studio.case import OPTIMUM, case_named
from nullpose.studio.field_map import MAPS, FieldMap
from nullpose.studio.look import scale_colours
from nullpose.studio.readout import card_html, proof, readout_html
from nullpose.studio.state import State
from nullpose.study import Field

_PAPER = load("examples/paper.toml")


@pytest.fixture(scope="module")
def result() -> Result:
    """The proved result of the paper's scene."""
    return solve(_PAPER)


@pytest.fixture
def proved(result: Result) -> State:
    """A state with a proved answer."""
    return State(scenario=_PAPER).with_event(answer_of(1, OPTIMUM, result))


def _mapped(state: State, lowest: float, highest: float, map_name: str = MAPS[0]) -> State:
    """Return a state with maps of values between two ends."""
    grid, values = np.linspace(0.0, 1.0, 3), np.linspace(lowest, highest, 9).reshape(3, 3)
    best = Field(
        east_m=grid, north_m=grid, altitude_m=8.0, values=values, unit="dB", title="best <SINR>", name="best"
    )
    maps = FieldMap(version=state.version, best=best, footprint=best)
    return replace(state.with_event(maps), map_name=map_name)


def test_it_says_how_good_the_pose_is(proved: State) -> None:
    """The value with its unit, its bound, and the verdict once."""
    answer, html = proved.current(OPTIMUM), card_html(proved)
    assert answer is not None
    assert f">{signed(answer.shown_value, 4)} dB<" in html
    bound_db = 10.0 * np.log10(answer.result.objective.upper_bound)
    assert f"upper bound {signed(bound_db, 4)} dB" in html
    assert "Proved optimal (gap 0.0001 %)" in html
    assert "np-old" not in html
    older = card_html(replace(proved, version=2))  # numbers of an older scene are grey
    assert "np-old" in older
    assert "solving" in older
    assert "Mbit/s" not in html
    (on_card,) = set(re.findall('data-version="([^"]+)"', html))
    assert f'data-version="{on_card}"' in readout_html(proved)


def test_a_rate_with_a_bandwidth_is_in_mbit_too() -> None:
    """The value and the bound of the proof."""
    receiver = {"bandwidth_hz": 20e6, "noise_figure_db": 6.0, "reference_gain_db": -80.0}
    table = _PAPER.to_dict() | {"objective": "sum-rate", "receiver": receiver}
    found = solve(Scenario.from_dict(table), gap=1e-2)
    html = card_html(State(scenario=found.scenario).with_event(answer_of(1, OPTIMUM, found)))
    value, bound = (signed(20.0 * each, 4) for each in (found.objective.value, found.objective.upper_bound))
    assert f"{value} Mbit/s, upper bound {bound}" in html


def test_while_the_solver_is_compiled_it_says_so() -> None:
    """There is no number then, in the card and in the panel."""
    state = State(scenario=_PAPER)
    compiling = state.with_event(Notice(version=1, case=None, words="compiling the solver"))
    for shown, words in ((state, "solving"), (compiling, "compiling the solver")):
        assert words in card_html(shown)
        assert "data-value" not in card_html(shown) + readout_html(shown)


def test_two_cases_are_both_there(proved: State) -> None:
    """Each with its letter."""
    vertical = case_named("Vertical")
    state = replace(proved, compared=vertical)
    state = state.with_event(answer_of(1, vertical, solve(_PAPER, vertical.scheme)))
    html = card_html(state)
    assert re.findall(r'class="np-label">(\w: [^<]+)<', html) == [f"A: {OPTIMUM.label}", "B: Vertical"]
    assert len(re.findall("data-value=", html)) == 2


def test_the_value_is_marked_at_its_place_on_the_scale(proved: State) -> None:
    """On the map of the values; not on that of another quantity, nor beyond the ends, nor of a guarantee."""
    answer = proved.current(OPTIMUM)
    assert answer is not None
    state = _mapped(proved, -8.0, 2.0)
    assert state.scale is not None
    low, high = state.scale.ends
    share = 100.0 * (answer.shown_value - low) / (high - low)
    html = card_html(state)
    assert f'data-np="overlay-tick" style="left:{share:.1f}%"' in html
    assert "best &lt;SINR&gt;" in html
    assert f"<span>{low:g}</span><span>{high:g} dB</span>".replace("-", MINUS) in html
    other = card_html(_mapped(proved, -8.0, 2.0, MAPS[1]))
    robust = case_named("Robust pose")
    guaranteed = _mapped(replace(proved, case=robust).with_event(replace(answer, case=robust)), -50.0, 50.0)
    for unmarked in (other, card_html(_mapped(proved, 20.0, 30.0)), card_html(guaranteed)):
        assert "overlay-tick" not in unmarked


def test_links_differ_in_colour_where_nodes_differ_in_sinr() -> None:
    """The ends are around the nodes' SINR, with a map of the smallest values or without."""
    vertical = case_named("Vertical")
    answer = answer_of(1, vertical, solve(_PAPER, vertical.scheme, certify=False))
    found_db = [link.sinr_db for link in answer.result.links]
    assert max(found_db) - min(found_db) > 1.0
    plain = State(scenario=_PAPER, case=vertical).with_event(answer)
    for state in (plain, _mapped(plain, -20.0, min(found_db))):
        low, high = state.link_range_db
        assert low <= min(found_db)
        assert high >= max(found_db)
        assert len(np.unique(scale_colours(found_db, low, high), axis=0)) == 2
    assert f"lines to nodes: {low:g} to {high:g} dB<".replace("-", MINUS) in card_html(state)


def test_the_bar_follows_the_proof_of_the_present_scene(result: Result) -> None:
    """Open for what a search finds; then the gap and boxes that the solver reports; closed when proved."""
    state = State(scenario=_PAPER).with_event(answer_of(1, OPTIMUM, solve(_PAPER, certify=False)))
    assert proof(state).share == pytest.approx(100.0)
    state = state.with_event(Progress(version=1, case=OPTIMUM, gap=0.12, boxes=12345))
    assert "gap 12 % so far, 12,345 boxes examined" in card_html(state)
    assert 50.0 < proof(state).share < 100.0
    half = Progress(version=1, case=OPTIMUM, gap=1e-3, boxes=1)
    assert proof(state.with_event(half)).share == pytest.approx(51.0)  # half way on the log scale
    state = state.with_event(answer_of(1, OPTIMUM, result))
    assert f"{result.stats.boxes:,} boxes examined" in card_html(state)
    assert "width:2.0%" in card_html(state)
    assert proof(replace(state, version=2)).share == pytest.approx(100.0)
