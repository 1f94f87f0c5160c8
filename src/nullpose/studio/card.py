"""The card that stays on the page: value, bound, status, the bar of the proof, the map's colours."""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

from nullpose.report.numbers import MINUS, rounded_up
from nullpose.studio.field_map import Scale
from nullpose.studio.look import css, scale_colours
from nullpose.studio.readout import macros
from nullpose.studio.state import State

_WIDEST_GAP = 1.0
_CLOSED = 2.0  # per cent of the bar that stay, so that it can be seen


def card_html(state: State) -> str:
    """Write the card; its look is :func:`nullpose.studio.guard.look_html`.

    Args:
        state: of the page.
    """
    scale = None if state.scale is None else _scale(state, state.scale)
    return str(macros().card(state, proof(state), scale))


def _scale(state: State, scale: Scale) -> dict[str, object]:
    """Describe the map's colours, and the place of the value on them."""
    answer, (low, high), unit, tick = state.current(state.case), scale.ends, scale.field.unit, None
    # a guaranteed value has no place on the map, which is of the scene without errors
    if scale.of_value and answer is not None and not answer.case.robust and low <= answer.shown_value <= high:
        tick = 100.0 * (answer.shown_value - low) / (high - low)
    low_db, high_db = state.link_range_db
    is_shared = scale.of_value and unit == "dB"
    links = "lines to nodes: the same colours" + ("" if is_shared else f" from {low_db:g} to {high_db:g} dB")
    return {
        "gradient": _gradient(),
        "tick": tick,
        "low": f"{low:g}".replace("-", MINUS),
        "high": f"{high:g} {unit}".replace("-", MINUS),
        "title": scale.field.title,
        "links": links.replace("-", MINUS),
    }


@cache
def _gradient() -> str:
    return ",".join(css(colour) for colour in scale_colours([share / 8 for share in range(9)], 0.0, 1.0))


class Bar(NamedTuple):
    """A bar from a value, at its left, to the bound on it.

    Args:
        gap: the bound above the value, relative.
        target: the gap at which the bar is closed.
        words: what stands below.
        bound: what stands above its right end.
    """

    gap: float
    target: float
    words: str
    bound: str = "bound"

    @property
    def share(self) -> float:
        """How much of the bar is open, per cent, on a log scale from 100 % to the target."""
        if self.gap >= _WIDEST_GAP:
            return 100.0
        open_part = math.log(self.gap / self.target) / math.log(1.0 / self.target)
        return _CLOSED + (100.0 - _CLOSED) * max(0.0, open_part)


def proof(state: State) -> Bar:
    """Describe how far the proof of the chosen case has come.

    Args:
        state: of the page.
    """
    answer, progress = state.current(state.case), state.progress(state.case)
    if answer is not None and (gap := answer.result.objective.relative_gap) is not None:
        target = min(float(answer.result.provenance["gap"]), 0.5)
        words = f"Gap {gap_words(gap)}: proved in {answer.result.stats.boxes:,} boxes"
        return Bar(max(gap, target), target, words)
    if progress is not None:
        words = f"Gap {gap_words(progress.gap)} so far: {progress.boxes:,} boxes examined"
        return Bar(progress.gap, progress.target, words)
    return Bar(math.inf, _WIDEST_GAP, "Not proved yet", "no bound yet")


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
