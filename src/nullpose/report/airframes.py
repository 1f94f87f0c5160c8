"""A comparison of airframes as a table for a terminal, and its answer in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from nullpose.physics.quantity import Quantity
from nullpose.report.certainty import rigour_lines, short
from nullpose.report.quantity import bound_text
from nullpose.report.tables import fixed, new_table
from nullpose.solve import Status
from nullpose.study import AirframeComparison, AirframeResult

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

__all__ = ["airframes_view", "answer_lines", "proof_lines", "share_text"]

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
    from rich.console import Group
    from rich.text import Text

    answer = Text("\n".join(answer_lines(comparison)), style="bold")
    parts: list[RenderableType] = [
        Text(f"{comparison.scenario.name or 'scenario'}\n", style="bold"),
        _values_table(comparison),
    ]
    if comparison.scenario.is_uncertain:
        parts.append(_guaranteed_table(comparison))
    return Group(*parts, Text("\n".join(proof_lines(comparison))), Text(), answer)


def _values_table(comparison: AirframeComparison) -> Table:
    """Return the table of values: ratio, value, bound, difference from the omnidirectional one, status."""
    quantity = Quantity.of(comparison.scenario)
    heads = ([] if quantity.is_rate else ["ratio"]) + ["value", "at most", "difference"]
    table = _table(f"S{quantity.smallest[1:]} over the nodes ({quantity.unit})", heads)
    table.add_column("status", no_wrap=True)
    whole = quantity.in_unit(comparison.omnidirectional.value)
    for index, result in enumerate(comparison.results):
        if index == len(comparison.dipoles):
            table.add_section()
        objective, cells = result.objective, ["-"] * len(heads)
        if objective is not None:
            value = quantity.in_unit(objective.value)
            cells = [] if quantity.is_rate else [f"{objective.value:.5g}"]
            cells.append(_number(value))
            cells.append("-" if objective.upper_bound is None else bound_text(objective, 4))
            cells.append(_number(value - whole, 3))
        style = "bold" if result is comparison.stated else ""
        table.add_row(result.case.label, *cells, _STATUS[result.status], style=style)
    return table


def _guaranteed_table(comparison: AirframeComparison) -> Table:
    """Return the table of what each dipole guarantees under the file's errors."""
    quantity = Quantity.of(comparison.scenario)
    heads = ["pose above", "robust pose", "at most", "difference"]
    table = _table(f"Guaranteed under the file's errors ({quantity.unit})", heads)
    best = comparison.omnidirectional.guaranteed
    whole = best.robust_pose if best is not None and best.robust_pose is not None else math.nan
    for result in comparison.dipoles:
        found, cells = result.guaranteed, ["-"] * len(heads)
        if found is not None:
            robust = math.nan if found.robust_pose is None else found.robust_pose
            bound = math.nan if found.upper_bound is None else found.upper_bound
            values = [quantity.in_unit(value) for value in (found.nominal_pose, robust, bound, whole)]
            cells = [_number(value, 3) for value in (*values[:3], values[1] - values[3])]
        table.add_row(result.case.label, *cells, style="bold" if result is comparison.stated else "")
    return table


def _table(title: str, heads: Sequence[str]) -> Table:
    table = new_table(title, heads, first="vehicle, dipole")
    for column in table.columns[1:]:
        column.no_wrap = True
    return table


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
        gaps = [r.objective.relative_gap for r in certified if r.objective is not None]
        widest = short(max(gap for gap in gaps if gap is not None))
        who = "Every dipole's value is" if len(certified) == len(dipoles) else f"{_names(certified)}:"
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


def _names(results: list[AirframeResult]) -> str:
    return ", ".join(result.case.label for result in results)


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
    lines = [_least_line(comparison, least)]
    if comparison.stated is not None and comparison.stated is not least:
        lines.append(_stated_line(comparison, comparison.stated))
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
            f"{_begun(nearest.case.phrase)} comes nearest, with {_share(comparison, nearest)} of its value."
        )
    rank = "the least of these that comes" if least is not comparison.results[0] else "it comes"
    return (
        f"{_begun(least.case.phrase)} gives {_share(comparison, least)} of what an omnidirectional "
        f"vehicle gives here: {rank} within {_WITHIN} of it."
    )


def _stated_line(comparison: AirframeComparison, own: AirframeResult) -> str:
    enough = "suffices too" if comparison.suffices(own) else "does not suffice"
    return f"{_begun(own.case.phrase)} {enough}: it gives {_share(comparison, own)}."


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
    lead = [f"On a level vehicle an array is enough {' or '.join(enough)}"] if enough else []
    if not lead:
        return f"An array on a level vehicle: {'; '.join(short_of_it)}."
    return f"{'; '.join([*lead, *short_of_it])}."


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


def share_text(share: float) -> str:
    """Return a share in per cent: three digits, whole numbers from 100 on, as in ``99.3 %``.

    Never rounded up to 100 by more than a twentieth of a per cent.

    Args:
        share: at least 0.
    """
    per_cent = 100.0 * share
    return f"{per_cent:.0f} %" if per_cent >= 99.95 else f"{per_cent:.3g} %"


def _begun(phrase: str) -> str:
    return phrase[0].upper() + phrase[1:]
