"""The answers of comparisons in words: which vehicle suffices, and what stated antennas cost."""

from __future__ import annotations

import math
from collections.abc import Sequence

from nullpose.objectives import Quantity
from nullpose.report.numbers import capitalised, with_unit
from nullpose.study import ResultRow, ResultTable
from nullpose.study.case import FILE_VEHICLE, OMNIDIRECTIONAL
from nullpose.study.vehicles import TOLERANCE, arrays, difference, dipoles, least_sufficient, suffices


def answer_lines(comparison: ResultTable) -> list[str]:
    """Answer whether the vehicle has to be omnidirectional, by the vehicles that were compared alone.

    The least of them that suffices or the one that comes nearest, with one dipole and with an array.
    """
    least, whole = least_sufficient(comparison), comparison.of(OMNIDIRECTIONAL)[0]
    if least is None:
        return ["Of the vehicles compared, none with one dipole gives every node a signal in this scene."]
    lesser = [row for row in dipoles(comparison) if row is not whole]
    lines = [_least_line(comparison, kind) for kind in (lesser, arrays(comparison)) if kind]
    if least is whole:
        only = "Of the vehicles compared with one dipole, only the omnidirectional one was found to suffice."
        lines.insert(0, f"{only} Another tilt or mount may: state it in [airframe] to compare it.")
    for row in comparison.rows:
        if row.name == FILE_VEHICLE and row is not least:
            verdict = "suffices too" if suffices(comparison, row) else "does not suffice"
            lines.append(f"{capitalised(row.case.phrase)} {verdict}: it {_reach(comparison, row)}.")
    return lines


def _least_line(comparison: ResultTable, found: Sequence[ResultRow]) -> str:
    """Name the least of a kind's vehicles, in the order of what they take, that suffices or is nearest."""
    best, verdict = max(found, key=lambda row: row.objective.value), "comes nearest"
    least = next((row for row in found if suffices(comparison, row)), None)
    if least is not None:
        is_rate = best.objective.quantity.is_rate
        within = f"{100.0 * TOLERANCE:g} %" if is_rate else f"{-10.0 * math.log10(1.0 - TOLERANCE):.2f} dB"
        best, verdict = least, f"is the simplest within {within} of that"
    kind = "an array" if best.case.array else "one dipole"
    reach = f"{capitalised(best.case.phrase)} {_reach(comparison, best)} in this scene."
    return f"{reach} Of the vehicles compared with {kind}, it {verdict}."


def _reach(comparison: ResultTable, row: ResultRow) -> str:
    words = _less_or_more(difference(comparison, row), row.objective.quantity)
    return f"reaches {words} than the omnidirectional vehicle"


def antennas_answer(comparison: ResultTable) -> str:
    """Say in two sentences what the stated antennas cost and what the best pose for them recovers."""
    objectives = [comparison.of(name)[0].objective for name in ("promised", "received", "possible")]
    quantity = objectives[0].quantity
    promised, received, possible = (quantity.in_unit(objective.value) for objective in objectives)
    pose, other = "The best pose for the paper's antennas", "The best pose for the stated antennas"
    if not math.isfinite(received):
        return (
            f"{pose} leaves a node without signal if the antennas are the stated ones. "
            f"{other} reaches {with_unit(possible, quantity)}."
        )
    return (
        f"{pose} gives {_less_or_more(received - promised, quantity)} if the antennas are the stated ones. "
        f"{other} gives {with_unit(abs(possible - received), quantity)} more than that."
    )


def _less_or_more(difference: float, quantity: Quantity) -> str:
    """Write a difference in words, as in ``0.03 dB less`` or ``under 0.01 dB more``."""
    size = with_unit(abs(difference), quantity)
    if not quantity.is_rate and abs(difference) < 0.01:
        size = f"under 0.01 {quantity.unit}"
    return f"{size} {'less' if difference <= 0.0 else 'more'}"
