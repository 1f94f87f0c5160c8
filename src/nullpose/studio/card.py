"""The card that stays on the page: value, bound, status, the bar of the proof, the map's colours."""

from __future__ import annotations

import math
from typing import NamedTuple

from nullpose.report.numbers import MINUS
from nullpose.solver import Status
from nullpose.studio.answer import Progress, TiltNotice, percent_rounded_up
from nullpose.studio.camera import centre_of_m
from nullpose.studio.field_map import Scale
from nullpose.studio.look import css, scale_colours
from nullpose.studio.readout import macros
from nullpose.studio.state import State

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
        least, widest = _GAPS
        gap = min(max(self.gap, least), widest)
        return _CLOSED + (100.0 - _CLOSED) * (math.log(gap / least) / math.log(widest / least))


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
