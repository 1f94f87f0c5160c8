"""A bar that closes between a value and the bound on it as the solver proves, as HTML."""

from __future__ import annotations

import math

from nullpose.report.numbers import rounded_up
from nullpose.studio.session import Session

_COLOUR = "#d63384"  # a pink that stands out from all else in the page, light or dark
_WIDEST_GAP = 1.0
_CLOSED = 2.0  # per cent of the bar that stay, so that it can be seen
_STYLE = "min-width:300px;margin:4px 0"  # as wide at each step
_ENDS = "display:flex;justify-content:space-between"
_TRACK = "height:9px;border-radius:5px;overflow:hidden;background:rgba(128,128,128,.25);margin:2px 0"


def proof_html(session: Session) -> str:
    """Write how far the proof of the chosen case has come.

    Args:
        session: of the page.
    """
    case = session.view.case
    answer, progress = session.current(case), session.progress(case)
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
    fill = f"width:{share:.1f}%;height:100%;background:{_COLOUR}"
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
