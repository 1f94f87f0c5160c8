"""A bar that closes between a value and the bound on it, as HTML."""

from __future__ import annotations

import math
from html import escape

from nullpose.report.numbers import fixed, short
from nullpose.solver import Result
from nullpose.solver.proof_steps import ProofStep
from nullpose.studio.answer import Answer, signed
from nullpose.studio.colours import css
from nullpose.studio.events import Progress
from nullpose.studio.replay import BOX_COLOUR

_WIDEST_GAP = 1.0
_FAR_M = 10.0  # beyond it whole metres
_CLOSED = 2.0  # per cent of the bar that stay, so that it can be seen
_STYLE = "min-width:300px;margin:4px 0"  # as wide at each step
_ENDS = "display:flex;justify-content:space-between"
_TRACK = "height:9px;border-radius:5px;overflow:hidden;background:rgba(128,128,128,.25);margin:2px 0"


def bar_html(bound: str, gap: float, target: float, words: str, *, again: bool = False) -> str:
    """Return a bar from a value, at its left, to the bound on it; on a log scale from 100 % to a target.

    Args:
        bound: what the bound is called, or how large it is.
        gap: the bound above the value, relative.
        target: the gap at which the bar is closed.
        words: what to say below.
        again: whether it is of a proof that is shown again, whose bound is not the one proved.
    """
    share = 100.0
    if gap < _WIDEST_GAP:
        share = _CLOSED + (100.0 - _CLOSED) * max(0.0, math.log(gap / target) / math.log(1.0 / target))
    fill = f"width:{share:.1f}%;height:100%;background:{css(BOX_COLOUR)}"
    return (
        f'<div data-np="proof"{" data-again" * again} data-gap="{gap!r}" style="{_STYLE}">'
        f'<div style="{_ENDS}"><span>value</span><span>{escape(bound)}</span></div>'
        f'<div style="{_TRACK}"><div style="{fill}"></div></div>'
        f'<div data-np="proof-words">{escape(words)}</div></div>'
    )


OPEN_BAR = bar_html("no bound yet", math.inf, _WIDEST_GAP, "Not proved yet")
"""The bar of what is not proved; the same at each step of a drag, so that it is sent once."""


def answer_bar(answer: Answer) -> str:
    """Return the bar of an answer; empty if nothing is proved of it.

    Args:
        answer: to the present scene.
    """
    gap = answer.result.objective.relative_gap
    if gap is None:
        return ""
    target = min(float(answer.result.provenance["gap"]), 0.5)
    words = f"Gap {gap_words(gap)}: proved in {answer.result.stats.boxes:,} boxes"
    return bar_html("bound", max(gap, target), target, words)


def progress_bar(progress: Progress) -> str:
    """Return the bar of a proof that runs.

    Args:
        progress: how far the proof has come.
    """
    words = f"Gap {gap_words(progress.gap)} so far: {progress.boxes:,} boxes examined"
    return bar_html("bound", progress.gap, progress.target, words)


def step_bar(result: Result, step: ProofStep, last: ProofStep) -> str:
    """Return the bar of a step of a proof that is shown again.

    Args:
        result: with the proof.
        step: one of its steps.
        last: the last of them.
    """
    objective = result.objective
    quantity, value = objective.quantity, objective.value
    ratio = 2.0**value if quantity.is_rate else value
    bound = quantity.of_ratio(ratio * (1.0 + step.gap))
    gap = quantity.gap(value, bound)
    target = min(quantity.gap(value, quantity.of_ratio(ratio * (1.0 + last.gap))), 0.5)
    shown = f"bound {signed(quantity.in_unit(bound), 4)} {quantity.unit}"
    words = f"Replay, bound {gap_words(gap)} above: {open_words(step, result)}"
    return bar_html(shown, max(gap, target), target, words, again=True)


def open_words(step: ProofStep, result: Result) -> str:
    """Return how many boxes are open at a step, and how far from the pose, in words.

    Args:
        step: of the result's proof.
        result: with the pose.
    """
    count = len(step.half_m)
    if not count:
        return "no box left"
    reach_m = step.reach_m(result.pose.position_m)
    reach = short(reach_m) if reach_m < _FAR_M else f"{math.ceil(reach_m):,}"
    return f"{count:,} {'box' if count == 1 else 'boxes'} within {reach} m"


def gap_words(gap: float) -> str:
    """Return a relative gap, rounded up: in per cent, or as a small number.

    Args:
        gap: at least 0.
    """
    if not math.isfinite(gap):
        return "not finite"
    if gap >= 1.0:
        return f"{fixed(100.0 * gap, 0)} %"
    return f"{short(100.0 * gap)} %" if gap > 1e-3 else short(gap)
