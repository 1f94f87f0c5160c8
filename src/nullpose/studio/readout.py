"""What a page says of a state: status, value and bound, nodes, pose, colours; laid out by a template."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from nullpose.physics import Pose
from nullpose.report.numbers import MINUS
from nullpose.solver import Status
from nullpose.studio.answer import Answer, Progress, TiltNotice, percent_rounded_up, signed
from nullpose.studio.camera import centre_of_m
from nullpose.studio.field_map import Scale
from nullpose.studio.look import COLOURS, css, either, scale_colours
from nullpose.studio.state import State

if TYPE_CHECKING:
    from jinja2.environment import TemplateModule

_TONES = {
    "no pose": "\N{BALLOT X}",
    "Proved": "\N{CHECK MARK}",
    "Best found": "\N{BLACK CIRCLE}",
    "At most": "\N{BLACK CIRCLE}",
    "": "\N{WHITE CIRCLE}",
}
"""The mark of each verdict, by how its words begin."""


def tone(status: str) -> tuple[str, str]:
    """Look up how a status begins, by which the card has its colour, and its mark.

    Args:
        status: in words.
    """
    return next(pair for pair in _TONES.items() if status.startswith(pair[0]))


def letter(state: State, slot: int) -> str:
    """Write the letter of one of two cases, "A: " or "B: "; nothing for one case.

    Args:
        state: of the page.
        slot: 0 for the chosen case, 1 for the compared one.
    """
    return "" if state.compared is None else f"{'AB'[slot]}: "


def drone_text(state: State, slot: int) -> str:
    """Write a drone's label: its letter and its value, or that it is not known yet.

    Args:
        state: of the page.
        slot: 0 for the chosen case, 1 for the compared one.
    """
    case = state.cases[slot]
    answer = state.current(case)
    value = state.status(case) if answer is None else f"{signed(answer.shown_value)} {answer.unit}"
    return f"{letter(state, slot)}{value}"


def node_rows(answer: Answer) -> Iterator[tuple[str, list[str], bool]]:
    """List the nodes with the numbers of each, guaranteed or of its link, and whether it is a worst one.

    Args:
        answer: of a case.
    """
    quantity, guarded = answer.result.objective.quantity, answer.guarded
    for link in answer.result.links:
        if guarded is not None:
            lower = min(ratio.lower for ratio in guarded.guarantee.ratios if ratio.node == link.node)
            numbers = [
                signed(quantity.in_unit(number)) for number in (quantity.at(link), quantity.of_ratio(lower))
            ]
        else:
            numbers = [
                f"{signed(link.sinr_db)} dB",
                *([] if link.margin_db is None else [f"margin {signed(link.margin_db)} dB"]),
                *([f"{quantity.at(link):.3f} bits/s/Hz"] if quantity.is_rate else []),
            ]
        yield link.node, numbers, link.node in answer.worst_nodes


def attitude_words(pose: Pose) -> str:
    """Write roll, pitch, yaw and tilt.

    Args:
        pose: of the drone.
    """
    roll, pitch, yaw, tilt = (
        f"{signed(angle, 1)}\N{DEGREE SIGN}"
        for angle in np.degrees([pose.roll_rad, pose.pitch_rad, pose.yaw_rad, pose.tilt_rad])
    )
    return f"roll {roll}, pitch {pitch}, yaw {yaw} (tilt {tilt})"


def readout_html(state: State) -> str:
    """Write the numbers of every case that is shown, greyed where they are not of the present scene.

    Args:
        state: of the page.
    """
    return str(macros().readout(state, _difference(state)))


def _difference(state: State) -> tuple[str, str] | None:
    """Set the values of two cases beside each other, once what each is worth is known, with what differs."""
    answers = [answer for answer in map(state.current, state.cases) if answer is not None]
    if len(answers) < 2 or any(answer.case.robust and answer.guarded is None for answer in answers):
        return None
    first, second, unlike = *answers, ""
    if first.case.robust != second.case.robust:
        robust, other = "AB" if first.case.robust else "BA"
        unlike = f" ({robust} guaranteed, {other} without errors)"
    return f"A over B: {signed(first.shown_value - second.shown_value)} {first.unit}", unlike


@cache
def macros(template: str = "page.html.jinja") -> TemplateModule:
    """Load the macros of a template; a text of a scenario is never markup.

    Args:
        template: its file.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("nullpose.studio"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        function.__name__: function for function in (signed, tone, letter, node_rows, attitude_words)
    }
    environment.globals["colours"] = {name: either(*map(css, pair)) for name, pair in COLOURS.items()}
    return environment.get_template(template).module


_GAPS = 1e-6, 1.0  # at which the bar is closed, and as open as can be
_CLOSED = 2.0  # per cent of the bar that stay, so that it can be seen


def card_html(state: State) -> str:
    """Write the card; its look is :func:`nullpose.studio.guard.look_html`.

    Args:
        state: of the page.
    """
    scale = state.scale and _scale(state, state.scale)
    return str(
        macros().card(state, proof(state), state.present(TiltNotice), scale, centre_of_m(state.scenario))
    )


def _scale(state: State, scale: Scale) -> dict[str, object]:
    """Describe the map's colours, and the place of the value on them."""
    answer, (low, high), unit, tick = state.current(state.case), scale.ends, scale.field.unit, None
    # a guaranteed value has no place on the map, which is of the scene without errors
    if scale.of_value and answer is not None and not answer.case.robust and low <= answer.shown_value <= high:
        tick = 100.0 * (answer.shown_value - low) / (high - low)
    low_db, high_db = state.link_range_db
    return {
        "gradient": ",".join(map(css, scale_colours([share / 8 for share in range(9)], 0.0, 1.0))),
        "tick": tick,
        "low": f"{low:g}".replace("-", MINUS),
        "high": f"{high:g} {unit}".replace("-", MINUS),
        "title": scale.field.title,
        "links": f"lines to nodes: {low_db:g} to {high_db:g} dB".replace("-", MINUS),
    }


class Bar(NamedTuple):
    """A bar from a value, at its left, to the bound on it.

    Args:
        gap: the bound above the value, relative.
        words: what stands below.
    """

    gap: float
    words: str

    @property
    def share(self) -> float:
        """How much of the bar is open, per cent, on a log scale between the ends."""
        return float(np.interp(math.log(max(self.gap, _GAPS[0])), np.log(_GAPS), (_CLOSED, 100.0)))


def proof(state: State) -> Bar:
    """Describe how far the proof of the chosen case has come.

    Args:
        state: of the page.
    """
    answer, progress = state.current(state.case), state.present(Progress, state.case)
    if answer is not None and (gap := answer.result.objective.relative_gap) is not None:
        is_proved = answer.result.status is Status.CERTIFIED  # to the gap that was aimed at
        return Bar(0.0 if is_proved else gap, f"{answer.result.stats.boxes:,} boxes examined")
    if progress is not None:
        return Bar(
            progress.gap, f"gap {percent_rounded_up(progress.gap)} so far, {progress.boxes:,} boxes examined"
        )
    return Bar(math.inf, "no bound yet")
