"""What tables amount to, in words: which vehicle suffices, what antennas cost, how certain values are."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence

from nullpose.files import PlainTable
from nullpose.objectives import Quantity
from nullpose.report.document import grouped
from nullpose.report.numbers import capitalised, rounded_up, with_unit
from nullpose.solver import Rigour, Status
from nullpose.study import ResultRow, ResultTable, Sufficiency
from nullpose.study.case import FILE_VEHICLE, OMNIDIRECTIONAL
from nullpose.study.least_tilt import STEP_DEG
from nullpose.study.vehicles import (
    BEST_MOUNT,
    TOLERANCE,
    difference,
    dipoles,
    verdict_on,
)

_VERDICTS = {
    Sufficiency.SUFFICES: "is proved enough",
    Sufficiency.FALLS_SHORT: "is proved too little",
    Sufficiency.NOT_PROVED: "is proved neither enough nor too little",
}
# Of a kind of vehicle: whether some were found enough, and whether all that is said of them is proved.
_LEAST = {
    (True, True): "{vehicle} {reach}. Proved enough.{others}",
    (True, False): "{vehicle} {reach}. Found enough, not proved.{others}",
    (False, True): "No {kind} compared is enough (proved). The nearest, {phrase}, {reach}.",
    (False, False): "No {kind} compared was found enough (not proved of all). "
    "The nearest, {phrase}, {reach}.",
}
# Of stated antennas: whether every node is received at the best pose for the paper's.
_ANTENNAS = {
    True: "The best pose for the paper's antennas gives {change} if the antennas are the stated ones. "
    "The best pose for the stated antennas gives {gain} more than that.",
    False: "The best pose for the paper's antennas leaves a node without signal if the antennas are the "
    "stated ones. The best pose for the stated antennas reaches {possible}.",
}
_KINDS = {
    "dipole at the best mount": (BEST_MOUNT,),
    "vertical or horizontal dipole": ("-vertical", "-horizontal"),
}


def answer_lines(comparison: ResultTable) -> list[str]:
    """Answer which of the vehicles compared can stand in for the omnidirectional one, so far as it is proved.

    Of each kind the least that suffices, or the nearest.
    """
    single = dipoles(comparison)
    if all(row.objective.value <= 0.0 for row in single):
        return ["No vehicle compared with one dipole was found to reach every node."]
    kinds = {kind: [row for row in single if row.name.endswith(end)] for kind, end in _KINDS.items()}
    kinds["array"] = [row for row in comparison.rows if row.case.array is not None]
    return [
        *(_least_line(comparison, kind, found) for kind, found in kinds.items() if found),
        *(
            f"{capitalised(row.case.phrase)} {_VERDICTS[verdict_on(comparison, row)]}: "
            f"it {_reach(comparison, row)}."
            for row in comparison.rows
            if row.name == FILE_VEHICLE
        ),
        "The least tilt for each mount of the dipole: nullpose vehicle FILE",
    ]


def sufficing(quantity: Quantity) -> list[str]:
    """Say what a vehicle has to reach to suffice, and how either answer is proved."""
    loss = "" if quantity.is_rate else f" ({-10.0 * math.log10(1.0 - TOLERANCE):.2f} dB)"
    return [
        f"yes: the value is at most {100.0 * TOLERANCE:g} %{loss} below the omnidirectional bound.",
        f"no: the bound is more than {100.0 * TOLERANCE:g} %{loss} below the omnidirectional value.",
    ]


def _least_line(comparison: ResultTable, kind: str, found: Sequence[ResultRow]) -> str:
    """Name the least of a kind's vehicles, in the order of what they take, that suffices or is nearest."""
    enough = (1.0 - TOLERANCE) * comparison.of(OMNIDIRECTIONAL)[0].objective.value
    close = [row for row in found if row.objective.value >= enough]
    proved = [row for row in close if verdict_on(comparison, row) is Sufficiency.SUFFICES]
    are_short = all(verdict_on(comparison, row) is Sufficiency.FALLS_SHORT for row in found)
    row = (proved or close or [max(found, key=lambda row: row.objective.value)])[0]
    less = "fewer elements" if row.case.array else "less tilt"
    return _LEAST[bool(close), bool(proved) if close else are_short].format(
        kind=kind,
        phrase=row.case.phrase,
        vehicle=capitalised(row.case.phrase),
        reach=_reach(comparison, row),
        others=f" No {kind} with {less} was." if _size(found[0]) < _size(row) else "",
    )


def _size(row: ResultRow) -> float:
    """Measure the effort of a vehicle: elements of its array, or else its tilt [rad]."""
    if row.case.array:
        return row.case.array.elements
    return row.case.airframe.tilt_max_rad if row.case.airframe else 0.0


def _reach(comparison: ResultTable, row: ResultRow) -> str:
    if row.objective.value <= 0.0:
        return "leaves a node without signal"
    loss = difference(comparison, row)
    # one dipole cannot reach more: what it is found to reach beyond is within the gaps
    words = _less_or_more(loss if row.case.array else min(loss, 0.0), row.objective.quantity)
    return f"reaches {words} than the omnidirectional vehicle"


def antennas_answer(comparison: ResultTable) -> str:
    """Say in two sentences what the stated antennas cost and what the best pose for them recovers."""
    objectives = [comparison.of(name)[0].objective for name in ("promised", "received", "possible")]
    quantity = objectives[0].quantity
    promised, received, possible = (quantity.in_unit(objective.value) for objective in objectives)
    return _ANTENNAS[math.isfinite(received)].format(
        change=_less_or_more(received - promised, quantity),
        gain=with_unit(abs(possible - received), quantity),
        possible=with_unit(possible, quantity),
    )


def _less_or_more(difference: float, quantity: Quantity) -> str:
    """Write a difference in words, as in ``0.03 dB less`` or ``under 0.01 dB more``."""
    is_tiny = not quantity.is_rate and abs(difference) < 0.01
    size = f"under 0.01 {quantity.unit}" if is_tiny else with_unit(abs(difference), quantity)
    return f"{size} {'less' if difference <= 0.0 else 'more'}"


_ORDER = (Status.CERTIFIED, Status.GAP_NOT_REACHED, Status.BEST_FOUND)


def counted(rows: Iterable[ResultRow]) -> PlainTable:
    """Count values by status, with the widest gap of those with a bound; None if there are none."""
    rows = tuple(rows)
    counts = Counter(row.status for row in rows)
    return {
        "values": len(rows),
        "certified": counts[Status.CERTIFIED],
        "gap_not_reached": counts[Status.GAP_NOT_REACHED],
        "best_found": counts[Status.BEST_FOUND],
        "largest_relative_gap": max(
            [row.objective.relative_gap for row in rows if row.objective.relative_gap is not None],
            default=None,
        ),
    }


def _sentence(status: Status, rows: Sequence[ResultRow]) -> str:
    """Write what is true of every value of a status at least, with the widest gap."""
    counts = counted(rows)
    if rows[0].tilt is not None:
        count = f"{counts['certified']} of {counts['values']} points"
        target = f"the least tilt for {rows[0].case.reach:.7g} of the value"
        return f"{target} is proved to {STEP_DEG:g} degrees at {count}"
    gap = "none" if counts["largest_relative_gap"] is None else rounded_up(counts["largest_relative_gap"])
    return {
        Status.CERTIFIED: f"each point is certified optimal within {gap} (relative)",
        Status.GAP_NOT_REACHED: "all bounds are valid, but the requested gap is not reached at "
        f"{counts['gap_not_reached']} of {counts['values']} points; relative gap up to {gap}",
        Status.BEST_FOUND: "best found by search, no upper bound",
    }[status]


def certainty_lines(table: ResultTable) -> list[str]:
    """Write how certain the curves of a sweep are, a sentence for each kind of certainty that occurs."""
    weakest = {name: max((row.status for row in table.of(name)), key=_ORDER.index) for name in table.names}
    sentences = {
        status: _sentence(status, [row for row in table.rows if weakest[row.name] is status])
        for status in weakest.values()
    }
    labelled = (
        (table.of(name)[0].label, sentences[weakest[name]])
        for name in sorted(weakest, key=lambda name: _ORDER.index(weakest[name]))
    )
    return list(map(capitalised, grouped(labelled)))


def rigour_lines(rigours: Iterable[tuple[str, Rigour]]) -> list[str]:
    """Write how sure bounds are, a sentence for each rigour that occurs; labels may repeat."""
    labelled = list(rigours)
    counts, among = Counter(labelled), Counter(label for label, _ in labelled)
    shares = {
        each: "" if count == among[each[0]] else f"at {count} of {among[each[0]]} points "
        for each, count in counts.items()
    }
    return grouped(
        (label, "" if rigour is Rigour.NONE else f"{shares[label, rigour]}{rigour.message}.")
        for label, rigour in shares
    )
