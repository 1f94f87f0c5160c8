"""A comparison of airframes as a table for a terminal, and its answer in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, document, grouped, head, rows, table
from nullpose.report.numbers import begun, bound_text, fixed, less_or_more, percent, short
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
    """Return a table with a row for each vehicle, what is proved of it, and the answer in words.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    quantity = Quantity.of(comparison.scenario)
    results, dipoles = comparison.results, len(comparison.dipoles)
    value, _, nominal, robust, most = numbers_of(comparison)
    whole = results.index(comparison.omnidirectional)
    labels = [result.case.label for result in results]
    objectives = [result.objective for result in results]
    values = rows(
        {
            "vehicle, dipole": labels,
            "power ratio": [
                None if of is None or quantity.is_rate else f"{of.value:.5g}" for of in objectives
            ],
            "value": _told(value, 4),
            "bound": [None if of is None else bound_text(of, 4) for of in objectives],
            "difference": _told(value - value[whole], 3),
            "status": [_STATUS[result.status] for result in results],
        }
    )
    guaranteed = rows(
        {
            "vehicle, dipole": labels[:dipoles],
            "pose above": _told(nominal[:dipoles], 3),
            "robust pose": _told(robust[:dipoles], 3),
            "bound": _told(most[:dipoles], 3),
            "difference": _told((robust - robust[whole])[:dipoles], 3),
        }
    )
    values.insert(dipoles, {})
    bold = [] if comparison.stated is None else [comparison.stated.case.label]
    kept = f"Guaranteed under the file's errors ({quantity.unit})"
    title = f"{begun(quantity.smallest)} over the nodes ({quantity.unit})"
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
    """Return what is known of each vehicle in the quantity's unit, shape ``(5, n)``; NaN for nothing.

    Its value and the bound on it; what the pose shown and the robust pose guarantee, and the bound on that.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    quantity, columns = Quantity.of(comparison.scenario), []
    for result in comparison.results:
        of, kept = result.objective, result.guaranteed
        found = [None] * 2 if of is None else [of.value, of.upper_bound]
        found += [None] * 3 if kept is None else [kept.nominal_pose, kept.robust_pose, kept.upper_bound]
        columns.append([math.nan if number is None else quantity.in_unit(number) for number in found])
    return np.transpose(columns)


def _told(numbers: FloatArray, digits: int) -> list[str | None]:
    words = [fixed(number, digits) if math.isfinite(number) else "nothing" for number in numbers]
    return [None if math.isnan(number) else text for number, text in zip(numbers, words, strict=True)]


def proof_lines(comparison: AirframeComparison) -> list[str]:
    """Return what is proved of the table's numbers, in sentences.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    labelled = [(result.case.label, result) for result in comparison.results]
    gaps = [each.objective.relative_gap for _, each in labelled if each.objective is not None]
    known = [gap for gap in gaps if gap is not None]
    lines = [
        "Omnidirectional: the vehicle can take any attitude. Difference: from that vehicle.",
        "Bounds are rounded up.",
    ]
    statuses = dict.fromkeys(each.status for _, each in labelled if each.status is not None)
    legend = {status: status.message for status in statuses}
    lines += [
        f"{_STATUS[status]}: {message.removeprefix('certified ')}" for status, message in legend.items()
    ]
    lines += grouped((label, each.reason) for label, each in labelled)
    lines += [f"The widest relative gap between value and bound is {short(max(known))}."] if known else []
    lines += rigour_lines(
        ("arrays" if each in comparison.arrays else "one dipole", each.objective.rigour)
        for _, each in labelled
        if each.objective
    )
    if comparison.scenario.is_uncertain:
        lines.append(
            "Guaranteed: proved for every error within the stated limits. "
            "No guarantee is computed for arrays."
        )
    return lines


def answer_lines(comparison: AirframeComparison) -> list[str]:
    """Return what the numbers say of the question whether the vehicle has to be omnidirectional.

    The least of the vehicles compared that suffices, what the others fall short by in dB or bits/s/Hz, what
    an array would take, and what of it holds under errors. No vehicle that was not compared is judged.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    least, own, arrays = comparison.least_sufficient, comparison.stated, comparison.arrays
    if least is None:
        return ["Of the vehicles compared, none with one dipole gives every node a signal in this scene."]
    lesser = [result for result in comparison.dipoles if result is not comparison.omnidirectional]
    lines = [_least_line(comparison, lesser)] if lesser else []
    if least is comparison.omnidirectional:
        only = "Of the vehicles compared with one dipole, only the omnidirectional one was found to suffice."
        lines.insert(0, f"{only} Another tilt or mount may: state it in [airframe] to compare it.")
    if own is not None and own is not least:
        verdict = "suffices too" if comparison.suffices(own) else "does not suffice"
        lines.append(f"{begun(own.case.phrase)} {verdict}: it reaches {_difference(comparison, own)}.")
    if arrays:
        lines.append(_least_line(comparison, arrays))
    if comparison.scenario.is_uncertain:
        lines.append(_errors_line(comparison))
    return lines


def _least_line(comparison: AirframeComparison, results: Sequence[AirframeResult]) -> str:
    """Return which of a kind's vehicles, by what they take, is the least that suffices, or comes nearest."""
    best, verdict = max(results, key=lambda result: result.value), "comes nearest"
    least = next((result for result in results if comparison.suffices(result)), None)
    if least is not None:
        best, verdict = least, f"is the simplest {_near(comparison)} of that"
    return (
        f"{begun(best.case.phrase)} reaches {_difference(comparison, best)} in this scene. Of the vehicles "
        f"compared with {'an array' if best.case.array else 'one dipole'}, it {verdict}."
    )


def _difference(comparison: AirframeComparison, result: AirframeResult) -> str:
    quantity = Quantity.of(comparison.scenario)
    return f"{less_or_more(comparison.difference(result), quantity)} than the omnidirectional vehicle"


def _near(comparison: AirframeComparison) -> str:
    """Return how near to the omnidirectional vehicle suffices: as a rate, or in decibels of a power ratio."""
    if Quantity.of(comparison.scenario).is_rate:
        return f"within {percent(TOLERANCE)}"
    return f"within {-10.0 * math.log10(1.0 - TOLERANCE):.2f} dB"


def _errors_line(comparison: AirframeComparison) -> str:
    """Return what of the answer is left under the errors that the scenario states."""
    whole = comparison.omnidirectional.guaranteed
    if whole is None or not whole.robust_pose:
        return "Under the stated errors no vehicle has a guaranteed value above zero."
    quantity = Quantity.of(comparison.scenario)
    least, robust_pose = next(
        (result, result.guaranteed.robust_pose)
        for result in comparison.dipoles
        if result.guaranteed is not None
        and result.guaranteed.robust_pose is not None
        and result.guaranteed.robust_pose >= (1.0 - TOLERANCE) * whole.robust_pose
    )
    all_tilt = quantity.in_unit(whole.robust_pose)
    kept = less_or_more(all_tilt - quantity.in_unit(comparison.omnidirectional.value), quantity)
    lost = less_or_more(quantity.in_unit(robust_pose) - all_tilt, quantity)
    return (
        f"Under the stated errors an omnidirectional vehicle guarantees {kept} at its robust pose than it "
        f"reaches without errors. {begun(least.case.phrase)} guarantees {lost} than that. Of the vehicles "
        f"compared with one dipole, it is the simplest {_near(comparison)} of that guarantee."
    )
