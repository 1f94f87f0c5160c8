"""The card that stays on the page whatever the panel does: value, bound, status, and the map's colours."""

from __future__ import annotations

from functools import cache
from html import escape
from typing import NamedTuple

from nullpose.report.numbers import MINUS
from nullpose.studio.answer import Answer, signed
from nullpose.studio.colours import css, scale_colours
from nullpose.studio.proof_bar import proof_html
from nullpose.studio.readout import status_look
from nullpose.studio.session import Session
from nullpose.study.value_map import Field


class Scale(NamedTuple):
    """The map that is shown, and its colours.

    Args:
        field: the map.
        ends: values of the dark and of the bright end.
        of_value: whether it is of the value that is maximised, so that the pose's own has a place on it.
        links_db: SINRs of the dark and of the bright end of the links' colours, dB.
    """

    field: Field
    ends: tuple[float, float]
    of_value: bool
    links_db: tuple[float, float]


def overlay_html(session: Session, scale: Scale | None = None) -> str:
    """Return the card; its look is :func:`nullpose.studio.frame.look_html`.

    Args:
        session: whose.
        scale: the map that is shown, or None.
    """
    cases = "".join(_case_html(session, slot) for slot in range(len(session.view.cases)))
    colours = "" if scale is None else _scale_html(scale, session.current(session.view.case))
    return (
        f'<div data-np="overlay" data-version="{session.version}">{cases}{proof_html(session)}{colours}</div>'
    )


def _case_html(session: Session, slot: int) -> str:
    case = session.view.cases[slot]
    answer, status = session.answer(case), session.status(case)
    tone, _, mark = status_look(status)
    letter = f"{'AB'[slot]}: " if session.view.compared is not None else ""
    named = f'class="np-status" data-np="overlay-status-{slot}" data-tone="{tone}"'
    numbers = "" if answer is None or tone == "no pose" else _numbers(session, answer, slot)
    label = f'<div class="np-label">{letter}{escape(case.label)}</div>'
    left_out = f'<div class="np-title">{escape(case.left_out(session.view.scenario))}</div>'
    told = f"{label}{numbers}{left_out}<div {named}>{mark} {escape(status)}</div>"
    return f'<div class="{"np-second" if slot else "np-first"}">{told}</div>'


def _numbers(session: Session, answer: Answer, slot: int) -> str:
    value, unit = answer.result.objective.value, answer.result.objective.quantity.unit
    old = "" if session.current(answer.case) is answer else " np-old"
    bound = answer.bound_text and f"{answer.bound_text} {unit}"
    errors = "".join(f'<div class="np-errors">{escape(words)}</div>' for words in answer.errors)
    return (
        f'<div class="np-numbers{old}"><span class="np-value" data-np="overlay-value-{slot}" '
        f'data-value="{value!r}">{signed(answer.shown_value, 4)} {unit}</span>'
        f'{escape(answer.value_words)}<div class="np-bound">{bound}</div>{errors}</div>'
    )


def _scale_html(scale: Scale, answer: Answer | None) -> str:
    (low, high), unit, tick = scale.ends, scale.field.unit, ""
    # a guaranteed value has no place on the map, which is of the scene without errors
    if scale.of_value and answer is not None and not answer.case.robust and low <= answer.shown_value <= high:
        share = (answer.shown_value - low) / (high - low)
        tick = f'<i data-np="overlay-tick" style="left:{100.0 * share:.1f}%"></i>'
    low_db, high_db = scale.links_db
    shared = scale.of_value and unit == "dB"
    links = "lines to nodes: the same colours" + ("" if shared else f" from {low_db:g} to {high_db:g} dB")
    ends = "".join(
        f"<span>{end:g}{more}</span>".replace("-", MINUS) for end, more in ((low, ""), (high, f" {unit}"))
    )
    return (
        f'<div class="np-scale" style="background:linear-gradient(90deg,{_gradient()})">{tick}</div>'
        f'<div class="np-ends" data-np="overlay-ends">{ends}</div>'
        f'<div class="np-title">{escape(scale.field.title)}</div>'
        f'<div class="np-title" data-np="overlay-links">{links.replace("-", MINUS)}</div>'
    )


@cache
def _gradient() -> str:
    return ",".join(css(colour) for colour in scale_colours([share / 8 for share in range(9)], 0.0, 1.0))
