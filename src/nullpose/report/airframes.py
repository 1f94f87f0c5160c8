"""A comparison of airframes as a table for a terminal, and its answer in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, document, grouped, head, rows, table
from nullpose.report.numbers import bound_text, capitalised, less_or_more, rounded_up
from nullpose.solver import Status
from nullpose.study import AirframeComparison, AirframeResult
from nullpose.study.airframe_comparison import TOLERANCE

_STATUS = {
    Status.CERTIFIED: "certified",
    Status.GAP_NOT_REACHED: "bounded",
    Status.BEST_FOUND: "found",
    None: "no pose",
}


def airframes_view(comparison: AirframeComparison) -> View:
    """Set a row for each vehicle, what is proved of it, and the answer in words."""
    quantity = Quantity.of(comparison.scenario)
    results, dipoles = comparison.results, len(comparison.dipoles)
    value, _, nominal, robust, most = numbers_of(comparison)
    whole = results.index(comparison.omnidirectional)
    labels = [result.case.label for result in results]
    objectives = [result.objective for result in results]
    no_ratio = quantity.is_rate
    values = rows(
        {
            "vehicle, dipole": labels,
            "power ratio": [None if x is None or no_ratio else f"{x.value:.5g}" for x in objectives],
            "value": _texts(value, 4),
            "bound": [None if x is None else bound_text(x, 4) for x in objectives],
            "difference": _texts(value - value[whole], 3),
            "status": [_STATUS[result.status] for result in results],
        }
    )
    values.insert(dipoles, {})
    guaranteed = rows(
        {
            "vehicle, dipole": labels[:dipoles],
            "pose above": _texts(nominal[:dipoles], 3),
            "robust pose": _texts(robust[:dipoles], 3),
            "bound": _texts(most[:dipoles], 3),
            "difference": _texts((robust - robust[whole])[:dipoles], 3),
        }
    )
    bold = [] if comparison.stated is None else [comparison.stated.case.label]
    title = f"{capitalised(quantity.smallest)} over the nodes ({quantity.unit})"
    kept = f"Guaranteed under the file's errors ({quantity.unit})"
    return document(
        head(comparison.scenario.name),
        "",
        table(title, values, bold=bold, left=["status"]),
        table(kept, guaranteed, bold=bold) if comparison.scenario.is_uncertain else None,
        "\n".join(proof_lines(comparison)),
        "",
        head("\n".join(answer_lines(comparison))),
    )


def numbers_of(comparison: AirframeComparison) -> FloatArray:
    """Convert each vehicle's numbers to the quantity's unit, shape ``(5, n)``; NaN for none.

    Its value and the bound on it; what the pose shown and the robust pose guarantee, and the bound on that.
    """
    quantity, columns = Quantity.of(comparison.scenario), []
    for result in comparison.results:
        objective, kept = result.objective, result.guaranteed
        numbers = [None] * 2 if objective is None else [objective.value, objective.upper_bound]
        numbers += [None] * 3 if kept is None else [kept.nominal_pose, kept.robust_pose, kept.upper_bound]
        columns.append([math.nan if number is None else quantity.in_unit(number) for number in numbers])
    return np.transpose(columns)


def _texts(numbers: FloatArray, digits: int) -> list[str | None]:
    texts = [f"{x:z.{digits}f}" if math.isfinite(x) else "nothing" for x in numbers.tolist()]
    return [None if math.isnan(number) else text for number, text in zip(numbers, texts, strict=True)]


def proof_lines(comparison: AirframeComparison) -> list[str]:
    """Write what is proved of the table's numbers."""
    labelled = [(result.case.label, result) for result in comparison.results]
    found = [result for result in comparison.results if result.objective is not None]
    gaps = [each.objective.relative_gap for each in found if each.objective.relative_gap is not None]
    statuses = dict.fromkeys(result.status for result in found)
    lines = [
        "Omnidirectional: the vehicle can take any attitude. Difference: from that vehicle.",
        "Bounds are rounded up.",
        *(f"{_STATUS[status]}: {status.message.removeprefix('certified ')}" for status in statuses),
        *grouped((label, result.reason) for label, result in labelled),
        *([f"The widest relative gap between value and bound is {rounded_up(max(gaps))}."] if gaps else []),
        *rigour_lines(
            ("arrays" if result in comparison.arrays else "one dipole", result.objective.rigour)
            for result in found
        ),
    ]
    if comparison.scenario.is_uncertain:
        guarantee = "Guaranteed: proved for every error within the stated limits."
        lines.append(f"{guarantee} No guarantee is computed for arrays.")
    return lines


def answer_lines(comparison: AirframeComparison) -> list[str]:
    """Answer whether the vehicle has to be omnidirectional, by the vehicles that were compared alone.

    The least of them that suffices or the one that comes nearest, with one dipole and with an array.
    """
    least, mine = comparison.least_sufficient, comparison.stated
    if least is None:
        return ["Of the vehicles compared, none with one dipole gives every node a signal in this scene."]
    lesser = [result for result in comparison.dipoles if result is not comparison.omnidirectional]
    lines = [_least_line(comparison, kind) for kind in (lesser, comparison.arrays) if kind]
    if least is comparison.omnidirectional:
        only = "Of the vehicles compared with one dipole, only the omnidirectional one was found to suffice."
        lines.insert(0, f"{only} Another tilt or mount may: state it in [airframe] to compare it.")
    if mine is not None and mine is not least:
        verdict = "suffices too" if comparison.suffices(mine) else "does not suffice"
        lines.append(f"{capitalised(mine.case.phrase)} {verdict}: it {_reach(comparison, mine)}.")
    return lines


def _least_line(comparison: AirframeComparison, results: Sequence[AirframeResult]) -> str:
    """Name the least of a kind's vehicles, in the order of what they take, that suffices or is nearest."""
    best, verdict = max(results, key=lambda result: result.value), "comes nearest"
    least = next((result for result in results if comparison.suffices(result)), None)
    if least is not None:
        is_rate = Quantity.of(comparison.scenario).is_rate
        within = f"{100.0 * TOLERANCE:g} %" if is_rate else f"{-10.0 * math.log10(1.0 - TOLERANCE):.2f} dB"
        best, verdict = least, f"is the simplest within {within} of that"
    kind = "an array" if best.case.array else "one dipole"
    reach = f"{capitalised(best.case.phrase)} {_reach(comparison, best)} in this scene."
    return f"{reach} Of the vehicles compared with {kind}, it {verdict}."


def _reach(comparison: AirframeComparison, result: AirframeResult) -> str:
    difference = less_or_more(comparison.difference(result), Quantity.of(comparison.scenario))
    return f"reaches {difference} than the omnidirectional vehicle"
