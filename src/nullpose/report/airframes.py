"""A comparison of airframes as a table for a terminal, and its answer in words."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nullpose.objectives import Quantity
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import document, head, table
from nullpose.report.numbers import begun, fixed, share_text, short
from nullpose.report.quantity import bound_text
from nullpose.solve import Status
from nullpose.study import AirframeComparison, AirframeResult

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["airframes_view", "answer_lines", "proof_lines"]

_WITHIN = "1 %"  # the tolerance of the study, in words
_STATUS = {
    Status.CERTIFIED: "certified",
    Status.GAP_NOT_REACHED: "bounded",
    Status.BEST_FOUND: "found",
    None: "no pose",
}


def airframes_view(comparison: AirframeComparison) -> RenderableType:
    """Return a table with a row for each vehicle, what is proved of it, and the answer in words.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    quantity = Quantity.of(comparison.scenario)
    title = f"S{quantity.smallest[1:]} over the nodes ({quantity.unit})"
    rows = [_value_cells(comparison, quantity, result) for result in comparison.results]
    rows.insert(len(comparison.dipoles), {})
    guaranteed = []
    if comparison.scenario.is_uncertain:
        guaranteed = [_guaranteed_cells(comparison, quantity, result) for result in comparison.dipoles]
    bold = [] if comparison.stated is None else [comparison.stated.case.label]
    return document(
        head(comparison.scenario.name),
        "",
        table(title, rows, bold=bold, left=["status"], no_wrap=True),
        table(f"Guaranteed under the file's errors ({quantity.unit})", guaranteed, bold=bold, no_wrap=True),
        "\n".join(proof_lines(comparison)),
        "",
        head("\n".join(answer_lines(comparison))),
    )


def _value_cells(
    comparison: AirframeComparison, quantity: Quantity, result: AirframeResult
) -> dict[str, str]:
    """Return a vehicle's ratio, value, bound, difference from the omnidirectional one, and status."""
    objective, cells = result.objective, {"vehicle, dipole": result.case.label}
    if not quantity.is_rate:
        cells["ratio"] = "-" if objective is None else f"{objective.value:.5g}"
    value = math.nan if objective is None else quantity.in_unit(objective.value)
    bound = "-" if objective is None or objective.upper_bound is None else bound_text(objective, 4)
    return {
        **cells,
        "value": _number(value),
        "at most": bound,
        "difference": _number(value - quantity.in_unit(comparison.omnidirectional.value), 3),
        "status": _STATUS[result.status],
    }


def _guaranteed_cells(
    comparison: AirframeComparison, quantity: Quantity, result: AirframeResult
) -> dict[str, str]:
    """Return what a dipole guarantees under the file's errors."""
    found, best = result.guaranteed, comparison.omnidirectional.guaranteed
    known = [None] * 3 if found is None else [found.nominal_pose, found.robust_pose, found.upper_bound]
    whole = None if best is None else best.robust_pose
    nominal, robust, bound, most = (
        math.nan if value is None else quantity.in_unit(value) for value in (*known, whole)
    )
    return {
        "vehicle, dipole": result.case.label,
        "pose above": _number(nominal, 3),
        "robust pose": _number(robust, 3),
        "at most": _number(bound, 3),
        "difference": _number(robust - most, 3),
    }


def _number(value: float, digits: int = 4) -> str:
    if math.isnan(value):
        return "-"
    return fixed(value, digits) if math.isfinite(value) else "nothing"


def proof_lines(comparison: AirframeComparison) -> list[str]:
    """Return what is proved of the table's numbers, in sentences.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    dipoles = [result for result in comparison.dipoles if result.objective is not None]
    certified = [result for result in dipoles if result.status is Status.CERTIFIED]
    lines = ["Difference: from the omnidirectional vehicle."]
    if certified:
        widest = short(max(each.objective.relative_gap or 0.0 for each in certified if each.objective))
        names = ", ".join(result.case.label for result in certified)
        who = "Every dipole's value is" if len(certified) == len(dipoles) else f"{names}:"
        lines.append(f"{who} certified: proved to be within {widest} of the best that the vehicle can reach.")
    lines += [f"{result.case.label}: {result.reason}" for result in comparison.dipoles if result.reason]
    if any(result.status is Status.BEST_FOUND for result in dipoles):
        lines.append("Without proofs each value is the best of a search.")
    lines += _array_proof(comparison)
    lines += rigour_lines((r.case.label, r.objective.rigour) for r in comparison.results if r.objective)
    if comparison.scenario.is_uncertain:
        lines.append(_guaranteed_line(comparison))
        lines += ["Nothing is guaranteed of arrays."] if comparison.arrays else []
    return lines


def _array_proof(comparison: AirframeComparison) -> list[str]:
    """Return how many values of arrays are certified, and why the others are not."""
    arrays = [result for result in comparison.arrays if result.objective is not None]
    others = [result for result in arrays if result.status is not Status.CERTIFIED]
    if all(result.status is Status.BEST_FOUND for result in arrays):
        return []  # without proofs, which is said of all values
    if not others:
        return ["The values of the arrays are certified as well."]
    share = f"{len(arrays) - len(others)} of {len(arrays)}"
    reasons = "; ".join(dict.fromkeys(result.reason for result in others if result.reason))
    return [f"Arrays: {share} values are certified, the others the best found{reasons and f' ({reasons})'}."]


def _guaranteed_line(comparison: AirframeComparison) -> str:
    line = "Guaranteed: proved to be reached whatever the errors do."
    found = [result.guaranteed for result in comparison.dipoles if result.guaranteed is not None]
    gaps = [
        one.upper_bound / one.robust_pose - 1.0
        for one in found
        if one.upper_bound is not None and one.robust_pose
    ]
    if not gaps or len(gaps) < len(found):
        return line
    return f"{line} No other pose guarantees over {short(100.0 * max(gaps))} % more than the robust one."


def answer_lines(comparison: AirframeComparison) -> list[str]:
    """Return what the numbers say of the question whether the vehicle has to be omnidirectional.

    The least vehicle that suffices, what the others fall short by, what an array would take, and what of it
    holds under errors.

    Args:
        comparison: what each vehicle makes of a scenario.
    """
    least = comparison.least_sufficient
    if least is None:
        return ["No vehicle with one dipole gives every node anything here."]
    lines, own = [_least_line(comparison, least)], comparison.stated
    if own is not None and own is not least:
        enough = "suffices too" if comparison.suffices(own) else "does not suffice"
        lines.append(f"{begun(own.case.phrase)} {enough}: it gives {_share(comparison, own)}.")
    if comparison.arrays:
        lines.append(_array_line(comparison))
    if comparison.scenario.is_uncertain:
        lines += _errors_lines(comparison)
    return lines


def _least_line(comparison: AirframeComparison, least: AirframeResult) -> str:
    if least is comparison.omnidirectional:
        others = [result for result in comparison.dipoles if result is not least]
        nearest = max(others, key=lambda result: result.value)
        return (
            f"It takes an omnidirectional vehicle here: none of the others comes within {_WITHIN} of it. "
            f"{begun(nearest.case.phrase)} comes nearest, with {_share(comparison, nearest)} of its value."
        )
    rank = "the least of these that comes" if least is not comparison.results[0] else "it comes"
    return (
        f"{begun(least.case.phrase)} gives {_share(comparison, least)} of what an omnidirectional "
        f"vehicle gives here: {rank} within {_WITHIN} of it."
    )


def _array_line(comparison: AirframeComparison) -> str:
    enough, short_of_it = [], []
    for combining, words in (("digital", "digital combining"), ("analogue", "one analogue beam")):
        arrays = [result for result in comparison.arrays if result.case.combining == combining]
        least = next((result for result in arrays if comparison.suffices(result)), None)
        if least is not None:
            enough.append(f"with {_size(least)} elements and {words} ({_times(comparison, least)})")
        elif arrays:
            best = max(arrays, key=lambda result: result.value)
            short_of_it.append(
                f"with {words} none of up to {_size(arrays[-1])} elements was found to be enough "
                f"({_share(comparison, best)} with {_size(best)})"
            )
    if not enough:
        return f"An array on a level vehicle: {'; '.join(short_of_it)}."
    lead = f"On a level vehicle an array is enough {' or '.join(enough)}"
    return f"{'; '.join([lead, *short_of_it])}."


def _times(comparison: AirframeComparison, result: AirframeResult) -> str:
    share = comparison.share(result)
    return _share(comparison, result) if share is None or share < 1.1 else f"{share:.3g} times as much"


def _size(result: AirframeResult) -> int:
    assert result.case.array is not None, "only arrays are asked for their size"
    return result.case.array.elements


def _errors_lines(comparison: AirframeComparison) -> list[str]:
    """Return what of the answer is left under the errors that the scenario states."""
    best = comparison.omnidirectional.guaranteed
    if best is None or not best.robust_pose:
        return ["Under the file's errors nothing is guaranteed, whatever the vehicle."]
    shares = [
        (result, result.guaranteed.robust_pose / best.robust_pose)
        for result in comparison.dipoles
        if result.guaranteed is not None and result.guaranteed.robust_pose is not None
    ]
    least, share = next(one for one in shares if one[1] >= 1.0 - comparison.tolerance)
    who = least.case.phrase
    kept = best.robust_pose / comparison.omnidirectional.value
    line = (
        "Under the file's errors an omnidirectional vehicle guarantees "
        f"{share_text(kept)} of its value, at its robust pose"
    )
    if least is comparison.omnidirectional:
        return [f"{line}; none of the others comes within {_WITHIN} of that."]
    return [f"{line}; {who} guarantees {share_text(share)} of that, the least that comes within {_WITHIN}."]


def _share(comparison: AirframeComparison, result: AirframeResult) -> str:
    share = comparison.share(result)
    return "nothing" if share is None else share_text(share)
