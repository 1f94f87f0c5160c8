"""A comparison of airframes as a table for a terminal, and its answer in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from nullpose.physics.types import FloatArray
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, document, grouped, head, rows, table
from nullpose.report.numbers import bound_text, capitalised, less_or_more, rounded_up
from nullpose.solver import Status
from nullpose.study import Case, ResultRow, ResultTable
from nullpose.study.vehicles import (
    TOLERANCE,
    arrays,
    difference,
    dipoles,
    least_sufficient,
    omnidirectional,
    own_vehicle,
    suffices,
)

_STATUS = {
    Status.CERTIFIED: "certified",
    Status.GAP_NOT_REACHED: "bounded",
    Status.BEST_FOUND: "found",
}


def airframes_view(comparison: ResultTable) -> View:
    """Set a row for each vehicle, what is proved of it, and the answer in words."""
    scenario, quantity = comparison.rows[0].scenario, comparison.rows[0].objective.quantity
    results, dipole_count = comparison.rows, len(dipoles(comparison))
    value, _, nominal, robust, most = numbers_of(comparison)
    whole = results.index(omnidirectional(comparison))
    labels = [case_of(row).label for row in results]
    objectives = [result.objective for result in results]
    no_ratio = quantity.is_rate
    values = rows(
        {
            "vehicle, dipole": labels,
            "power ratio": [None if no_ratio else f"{x.value:.5g}" for x in objectives],
            "value": _texts(value, 4),
            "bound": [bound_text(x, 4) for x in objectives],
            "difference": _texts(value - value[whole], 3),
            "status": [_STATUS[result.status] for result in results],
        }
    )
    values.insert(dipole_count, {})
    guaranteed = rows(
        {
            "vehicle, dipole": labels[:dipole_count],
            "pose above": _texts(nominal[:dipole_count], 3),
            "robust pose": _texts(robust[:dipole_count], 3),
            "bound": _texts(most[:dipole_count], 3),
            "difference": _texts((robust - robust[whole])[:dipole_count], 3),
        }
    )
    own = own_vehicle(comparison)
    bold = [] if own is None else [case_of(own).label]
    title = f"{capitalised(quantity.smallest)} over the nodes ({quantity.unit})"
    kept = f"Guaranteed under the file's errors ({quantity.unit})"
    return document(
        head(scenario.name),
        "",
        table(title, values, bold=bold, left=["status"]),
        table(kept, guaranteed, bold=bold) if scenario.is_uncertain else None,
        "\n".join(proof_lines(comparison)),
        "",
        head("\n".join(answer_lines(comparison))),
    )


def case_of(row: ResultRow) -> Case:
    """Return the vehicle of a row."""
    return row.case or Case(name=row.name)


def numbers_of(comparison: ResultTable) -> FloatArray:
    """Convert each vehicle's numbers to the quantity's unit, shape ``(5, n)``; NaN for none.

    Its value and the bound on it; what the pose shown and the robust pose guarantee, and the bound on that.
    """
    columns = []
    for row in comparison.rows:
        kept = row.guaranteed
        numbers = [row.objective.value, row.objective.upper_bound]
        numbers += [None] * 3 if kept is None else [kept.nominal_pose, kept.robust_pose, kept.upper_bound]
        in_unit = row.objective.quantity.in_unit
        columns.append([math.nan if number is None else in_unit(number) for number in numbers])
    return np.transpose(columns)


def _texts(numbers: FloatArray, digits: int) -> list[str | None]:
    texts = [f"{x:z.{digits}f}" if math.isfinite(x) else "nothing" for x in numbers.tolist()]
    return [None if math.isnan(number) else text for number, text in zip(numbers, texts, strict=True)]


def proof_lines(comparison: ResultTable) -> list[str]:
    """Write what is proved of the table's numbers."""
    found = comparison.rows
    reasons = [(case_of(row).label, row.reason) for row in found]
    reasons += [(name, f"no pose: {reason}") for name, reason in comparison.left_out.items()]
    gaps = [each.objective.relative_gap for each in found if each.objective.relative_gap is not None]
    statuses = dict.fromkeys(result.status for result in found)
    lines = [
        "Omnidirectional: the vehicle can take any attitude. Difference: from that vehicle.",
        "Bounds are rounded up.",
        *(f"{_STATUS[status]}: {status.message.removeprefix('certified ')}" for status in statuses),
        *grouped(reasons),
        *([f"The widest relative gap between value and bound is {rounded_up(max(gaps))}."] if gaps else []),
        *rigour_lines(
            ("arrays" if result in arrays(comparison) else "one dipole", result.objective.rigour)
            for result in found
        ),
    ]
    if found[0].scenario.is_uncertain:
        guarantee = "Guaranteed: proved for every error within the stated limits."
        lines.append(f"{guarantee} No guarantee is computed for arrays.")
    return lines


def answer_lines(comparison: ResultTable) -> list[str]:
    """Answer whether the vehicle has to be omnidirectional, by the vehicles that were compared alone.

    The least of them that suffices or the one that comes nearest, with one dipole and with an array.
    """
    least, mine = least_sufficient(comparison), own_vehicle(comparison)
    if least is None:
        return ["Of the vehicles compared, none with one dipole gives every node a signal in this scene."]
    lesser = [row for row in dipoles(comparison) if row is not omnidirectional(comparison)]
    lines = [_least_line(comparison, kind) for kind in (lesser, arrays(comparison)) if kind]
    if least is omnidirectional(comparison):
        only = "Of the vehicles compared with one dipole, only the omnidirectional one was found to suffice."
        lines.insert(0, f"{only} Another tilt or mount may: state it in [airframe] to compare it.")
    if mine is not None and mine is not least:
        verdict = "suffices too" if suffices(comparison, mine) else "does not suffice"
        lines.append(f"{capitalised(case_of(mine).phrase)} {verdict}: it {_reach(comparison, mine)}.")
    return lines


def _least_line(comparison: ResultTable, results: Sequence[ResultRow]) -> str:
    """Name the least of a kind's vehicles, in the order of what they take, that suffices or is nearest."""
    best, verdict = max(results, key=lambda row: row.objective.value), "comes nearest"
    least = next((result for result in results if suffices(comparison, result)), None)
    if least is not None:
        is_rate = best.objective.quantity.is_rate
        within = f"{100.0 * TOLERANCE:g} %" if is_rate else f"{-10.0 * math.log10(1.0 - TOLERANCE):.2f} dB"
        best, verdict = least, f"is the simplest within {within} of that"
    kind = "an array" if case_of(best).array else "one dipole"
    reach = f"{capitalised(case_of(best).phrase)} {_reach(comparison, best)} in this scene."
    return f"{reach} Of the vehicles compared with {kind}, it {verdict}."


def _reach(comparison: ResultTable, result: ResultRow) -> str:
    words = less_or_more(difference(comparison, result), result.objective.quantity)
    return f"reaches {words} than the omnidirectional vehicle"
