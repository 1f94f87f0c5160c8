"""The card that stays on the page: value, bound, status, the bar of the proof, the map's colours."""

from __future__ import annotations

import math
from functools import cache
from html import escape

from nullpose.report.numbers import MINUS, rounded_up
from nullpose.studio.answer import Answer, signed
from nullpose.studio.field_map import Scale
from nullpose.studio.look import css, scale_colours
from nullpose.studio.readout import status_look
from nullpose.studio.state import State

_BAR_COLOUR = "#d63384"  # a pink that stands out from all else in the page, light or dark
_WIDEST_GAP = 1.0
_CLOSED = 2.0  # per cent of the bar that stay, so that it can be seen
_STYLE = "min-width:300px;margin:4px 0"  # as wide at each step
_ENDS = "display:flex;justify-content:space-between"
_TRACK = "height:9px;border-radius:5px;overflow:hidden;background:rgba(128,128,128,.25);margin:2px 0"


def card_html(state: State) -> str:
    """Write the card; its look is :func:`nullpose.studio.guard.look_html`.

    Args:
        state: of the page.
    """
    cases = "".join(_case_html(state, slot) for slot in range(len(state.cases)))
    scale = "" if state.scale is None else _scale_html(state, state.scale)
    content = f"{cases}{proof_html(state)}{scale}"
    return f'<div data-np="overlay" data-version="{state.version}">{content}</div>'


def _case_html(state: State, slot: int) -> str:
    case = state.cases[slot]
    answer, status = state.answer(case), state.status(case)
    tone, _, mark = status_look(status)
    numbers = "" if answer is None or tone == "no pose" else _numbers(state, answer, slot)
    name = f'data-np="overlay-status-{slot}" data-tone="{tone}"'
    return (
        f'<div class="{"np-second" if slot else "np-first"}">'
        f'<div class="np-label">{state.letter(slot)}{escape(case.label)}</div>{numbers}'
        f'<div class="np-title">{escape(case.left_out(state.scenario))}</div>'
        f'<div class="np-status" {name}>{mark} {escape(status)}</div></div>'
    )


def _numbers(state: State, answer: Answer, slot: int) -> str:
    value, unit = answer.result.objective.value, answer.result.objective.quantity.unit
    old = "" if state.current(answer.case) is answer else " np-old"
    bound = answer.bound_text and f"{answer.bound_text} {unit}"
    errors = "".join(f'<div class="np-errors">{escape(words)}</div>' for words in answer.errors)
    return (
        f'<div class="np-numbers{old}"><span class="np-value" data-np="overlay-value-{slot}" '
        f'data-value="{value!r}">{signed(answer.shown_value, 4)} {unit}</span>'
        f'{escape(answer.value_words)}<div class="np-bound">{bound}</div>{errors}</div>'
    )


def _scale_html(state: State, scale: Scale) -> str:
    answer, (low, high), unit, tick = state.current(state.case), scale.ends, scale.field.unit, ""
    # a guaranteed value has no place on the map, which is of the scene without errors
    if scale.of_value and answer is not None and not answer.case.robust and low <= answer.shown_value <= high:
        share = (answer.shown_value - low) / (high - low)
        tick = f'<i data-np="overlay-tick" style="left:{100.0 * share:.1f}%"></i>'
    low_db, high_db = state.link_range_db
    is_shared = scale.of_value and unit == "dB"
    links = "lines to nodes: the same colours" + ("" if is_shared else f" from {low_db:g} to {high_db:g} dB")
    ends = f"<span>{low:g}</span><span>{high:g} {unit}</span>".replace("-", MINUS)
    return (
        f'<div class="np-scale" style="background:linear-gradient(90deg,{_gradient()})">{tick}</div>'
        f'<div class="np-ends" data-np="overlay-ends">{ends}</div>'
        f'<div class="np-title">{escape(scale.field.title)}</div>'
        f'<div class="np-title" data-np="overlay-links">{links.replace("-", MINUS)}</div>'
    )


@cache
def _gradient() -> str:
    return ",".join(css(colour) for colour in scale_colours([share / 8 for share in range(9)], 0.0, 1.0))


def proof_html(state: State) -> str:
    """Write how far the proof of the chosen case has come.

    Args:
        state: of the page.
    """
    answer, progress = state.current(state.case), state.progress(state.case)
    if answer is not None and (gap := answer.result.objective.relative_gap) is not None:
        target = min(float(answer.result.provenance["gap"]), 0.5)
        words = f"Gap {gap_words(gap)}: proved in {answer.result.stats.boxes:,} boxes"
        return bar_html("bound", max(gap, target), target, words)
    if progress is not None:
        words = f"Gap {gap_words(progress.gap)} so far: {progress.boxes:,} boxes examined"
        return bar_html("bound", progress.gap, progress.target, words)
    return bar_html("no bound yet", math.inf, _WIDEST_GAP, "Not proved yet")


def bar_html(bound: str, gap: float, target: float, words: str) -> str:
    """Write a bar from a value, at its left, to the bound on it; on a log scale from 100 % to a target.

    Args:
        bound: what stands above its right end.
        gap: the bound above the value, relative.
        target: the gap at which the bar is closed.
        words: what stands below.
    """
    share = 100.0
    if gap < _WIDEST_GAP:
        share = _CLOSED + (100.0 - _CLOSED) * max(0.0, math.log(gap / target) / math.log(1.0 / target))
    fill = f"width:{share:.1f}%;height:100%;background:{_BAR_COLOUR}"
    return (
        f'<div data-np="proof" data-gap="{gap!r}" style="{_STYLE}">'
        f'<div style="{_ENDS}"><span>value</span><span>{bound}</span></div>'
        f'<div style="{_TRACK}"><div style="{fill}"></div></div>'
        f'<div data-np="proof-words">{words}</div></div>'
    )


def gap_words(gap: float) -> str:
    """Write a relative gap, rounded up: in per cent, or as a small number.

    Args:
        gap: at least 0.
    """
    if not math.isfinite(gap):
        return "not finite"
    if gap >= 1.0:
        return f"{100.0 * gap:z.0f} %"
    return f"{rounded_up(100.0 * gap)} %" if gap > 1e-3 else rounded_up(gap)
