"""Numbers are typed at any speed: what stands in a field is in the scenario, and is what is solved."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import replace
from typing import Any

import pytest
from playwright.sync_api import Locator, Page

from nullpose import Scenario, ScenarioError, solve
from nullpose.scenario import Node, NoFlyZone
from nullpose.studio.edits import Entry, entries_of
from nullpose.studio.server import Studio
from nullpose.studio.session import Session
from nullpose.studio.state import Key, State

DELAYS_MS = (0, 5, 10, 20, 40)
TRIES = ("36", "7", "12.5", "3.25", "40", "0.75", "18", "2", "29.5", "11", "36", "5.125", "23")
FAULTS = "document.querySelector('[data-np=faults]').innerText"


class Typist:
    """Types into the fields of a page.

    Args:
        page: the browser's side.
        ours: the server's side.
    """

    def __init__(self, page: Page, ours: Any) -> None:
        self.page, self.ours, self.session = page, ours, ours.session

    def select(self, key: Key | None) -> None:
        """Show the values of a point or a zone, as a click on it does; those of the vehicle without one."""
        self.ours.change(lambda state: replace(state, selected=key))
        self.page.get_by_role("tab", name="Edit").click()
        self.page.wait_for_timeout(300)

    def field(self, label: str) -> Locator:
        """Return the field of the panel that stands beside a label."""
        return self.page.locator(f"xpath=//label[.='{label}']/ancestor::*[.//input][1]//input").first

    def typed(self, label: str, text: str, delay_ms: float, *, ends: str = "Enter") -> Locator:
        """Type a text over what stands in a field, and press the key that ends it."""
        field = self.field(label)
        field.click()
        field.press("Control+A")
        field.press_sequentially(text, delay=delay_ms)
        field.press(ends)
        return field

    def until(self, met: Callable[[], object], words: str) -> None:
        """Wait until something holds."""
        for _ in range(100):
            if met():
                return
            self.page.wait_for_timeout(50)
        raise AssertionError(words)

    def entry(self, key: Key | None, label: str, scenario: Scenario | None = None) -> Entry:
        """Return what the server has under a label, of the scene now or of another."""
        view = self.session.state if scenario is None else State(scenario=scenario)
        return next(one for one in entries_of(view, key) if one.label == label)

    def agree(self, key: Key | None, label: str, text: str) -> None:
        """Wait for a typed value to be solved, and check field, scenario and solved scenario."""
        case = self.session.state.case
        self.until(lambda: self.entry(key, label).text == text, f"{label}: {text} is not in the scenario")
        self.until(lambda: self.session.state.current(case), f"{label}: {text} is not solved")
        answer = self.session.state.current(case)
        assert answer is not None
        assert self.entry(key, label, answer.result.scenario).text == text
        self.page.wait_for_timeout(150)
        assert self.field(label).input_value() == text


@pytest.fixture
def typist(page: Page, session: Session, running: Studio) -> Iterator[Typist]:
    """A typist at the shared page, which shows the paper's scene."""
    typist = Typist(page, next(one for one in running.pages.values() if one.session is session))
    yield typist
    typist.select(None)


@pytest.mark.parametrize("delay_ms", DELAYS_MS)
def test_a_power_is_solved_as_it_was_typed(typist: Typist, delay_ms: float) -> None:
    """Thirteen powers of a jammer at each speed, the last one with its proof."""
    page, session, key = typist.page, typist.session, ("jammers", 0)
    typist.select(key)
    for text in TRIES:
        typist.typed("power (W)", text, delay_ms)
        typist.agree(key, "power (W)", text)
    page.wait_for_function(
        f"+document.querySelector('[data-np=readout]').dataset.version == {session.state.version} "
        "&& document.querySelector('[data-np=status-0]').innerText.includes('certified to')"
    )
    shown = float(page.locator("[data-np=value-0]").get_attribute("data-value") or "nan")
    assert session.state.scenario.jammers[0].power_w == float(TRIES[-1])
    assert shown == pytest.approx(solve(session.state.scenario).objective.value, rel=1e-9)


_FIELDS: dict[Key | None, dict[str, str]] = {
    ("nodes", 0): {"east (m)": "-12.25", "north (m)": "31", "up (m)": "1.5", "power (dBm)": "27.5"},
    ("jammers", 0): {"east (m)": "21", "power (W)": "1e-05", "position error (m)": "[2, 3, 0.5]"},
    ("no_fly", 0): {"centre (m)": "[35, -12.5]", "radius (m)": "11", "altitudes (m)": "[0, 25]"},
    ("no_fly", 1): {"west, east (m)": "[50, 61]", "south, north (m)": "[10, 20.5]"},
    None: {
        "tilt limit (deg)": "22.5",
        "antenna mount (deg)": "36",
        "lowest altitude (m)": "10",
        "highest altitude (m)": "45",
        "fence corners (m)": "[[-40, -40], [60, -40], [60, 60], [-40, 60]]",
        "distance to points (m)": "4.5",
    },
}


def _everything(paper: Scenario) -> Scenario:
    """Return the paper's scene with every kind of field that a page has for numbers."""
    first, second = paper.nodes
    node = Node(name=first.name, position_m=first.position_m, power_dbm=30.0)
    zones = (
        NoFlyZone(name="Z1", centre_m=(40.0, -10.0), radius_m=5.0),
        NoFlyZone(name="Z2", x_m=(50.0, 60.0), y_m=(0.0, 10.0)),
    )
    airspace = paper.airspace.model_copy(update={"no_fly": zones})
    return paper.model_copy(update={"nodes": (node, second), "airspace": airspace})


@pytest.mark.parametrize("delay_ms", DELAYS_MS[::2])
def test_every_field_takes_the_number_that_stands_in_it(
    typist: Typist, paper: Scenario, delay_ms: float
) -> None:
    """Of points, zones, vehicle and airspace: numbers and lists, with Enter and by leaving the field."""
    typist.session.change(lambda view: view.with_scenario(_everything(paper)))
    for key, texts in _FIELDS.items():
        typist.select(key)
        for i, (label, text) in enumerate(texts.items()):
            typist.typed(label, text, delay_ms, ends="Tab" if i % 2 else "Enter")
            typist.agree(key, label, text)


@pytest.mark.parametrize("delay_ms", DELAYS_MS[::2])
def test_the_jamming_power_is_the_one_in_its_field(typist: Typist, delay_ms: float) -> None:
    """In decibels, to a millionth; with Enter, by leaving, and by a click into the scene."""
    page, session = typist.page, typist.session
    page.get_by_role("tab", name="Scene").click()
    field = typist.field("typed (dB)")
    texts = {"36": "36", "-12.3456789": "-12.345679", "1e1": "10", "\N{MINUS SIGN}7.5": "-7.5"}
    for text, taken in texts.items():
        typist.typed("typed (dB)", text, delay_ms)
        typist.until(lambda taken=taken: session.state.power_text == taken, text)
        typist.until(lambda taken=taken: field.input_value() == taken, text)
        assert session.state.power_db == pytest.approx(float(taken), abs=1e-9)
    field.click()
    field.press("Control+A")
    field.press_sequentially("25", delay=delay_ms)
    page.mouse.click(500, 400)
    typist.until(lambda: math.isclose(session.state.power_db, 25.0), "the field was left")
    assert session.state.scenario.jammers[0].power_w == pytest.approx(10.0**2.5, rel=1e-9)


@pytest.mark.parametrize("text", ["abc", "36,5", "3 6", "", "nan", "-3", "36 W"])
def test_what_is_no_power_is_refused_in_words(typist: Typist, text: str) -> None:
    """The value that holds is put back, for a jammer and for the whole scene, and nothing is solved anew."""
    session = typist.session
    typist.select(("jammers", 0))
    typist.typed("power (W)", "36", 0)
    typist.until(lambda: session.state.scenario.jammers[0].power_w == 36.0, "36")
    version = session.state.version
    field = typist.typed("power (W)", text or "Delete", 0) if text else _emptied(typist, "power (W)")
    typist.page.wait_for_function(f"{FAULTS}.includes('jammers[0]')")
    typist.until(lambda: field.input_value() == "36", "the power that holds is not put back")
    typist.page.get_by_role("tab", name="Scene").click()
    if text != "-3":  # which is a number of decibels
        field = typist.typed("typed (dB)", text, 0) if text else _emptied(typist, "typed (dB)")
        typist.page.wait_for_function(f"{FAULTS}.includes('allowed: a number from')")
        typist.until(lambda: field.input_value() == session.state.power_text, "it is not put back")
    assert session.state.version == version


def _emptied(typist: Typist, label: str) -> Locator:
    field = typist.field(label)
    field.fill("")
    field.press("Enter")
    return field


def test_escape_puts_back_and_a_number_written_otherwise_is_written_as_it_holds(typist: Typist) -> None:
    """Nothing of what was typed before Escape is taken later; +7.0e0 becomes 7."""
    page, session = typist.page, typist.session
    page.get_by_role("tab", name="Scene").click()
    before = session.state.power_text
    field = typist.typed("typed (dB)", "17", 0, ends="Escape")
    typist.until(lambda: field.input_value() == before, "Escape has not put it back")
    field.press("Tab")
    page.wait_for_timeout(300)
    assert (field.input_value(), session.state.power_text) == (before, before)
    for _ in range(2):  # the second time nothing changes, and it is written back all the same
        typist.typed("typed (dB)", "+7.0e0", 0)
        typist.until(lambda: field.input_value() == "7", "it is not written back")
        assert session.state.power_text == "7"


def test_answers_and_changes_leave_what_is_being_typed(typist: Typist) -> None:
    """Undo by a button takes the number first; a change of the scene from elsewhere leaves the text."""
    session = typist.session
    typist.select(("jammers", 0))
    field = typist.field("power (W)")
    field.click()
    field.press("Control+A")
    field.press_sequentially("36")
    with suppress(ScenarioError):
        session.change(lambda view: view.with_power_db(13.0))
    typist.page.wait_for_timeout(700)
    assert field.input_value() == "36"
    field.press("Enter")
    typist.agree(("jammers", 0), "power (W)", "36")
