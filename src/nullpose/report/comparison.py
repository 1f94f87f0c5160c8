"""Schemes, vehicles and antennas compared: their values, what is proved of them, and the answer in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from nullpose.physics.types import FloatArray
from nullpose.report.answer import answer_lines, antennas_answer, rigour_lines, sufficing
from nullpose.report.document import Row, View, beside, cell, document, grouped, head, rows, table
from nullpose.report.geometry import axis_angle_rad
from nullpose.report.links import binding_nodes
from nullpose.report.numbers import bound_text, capitalised
from nullpose.report.results import pose_cells, work_words
from nullpose.report.words import requirement_words
from nullpose.solver import Rigour, Status
from nullpose.study import ResultRow, ResultTable
from nullpose.study.case import FILE_VEHICLE, OMNIDIRECTIONAL
from nullpose.study.vehicle_search import AS_NEEDED
from nullpose.study.vehicles import dipoles, verdict_on

_STATUS = {
    Status.CERTIFIED: "certified",
    Status.GAP_NOT_REACHED: "bounded",
    Status.BEST_FOUND: "found",
    Status.POSE_GIVEN: "given",
}


def comparison_view(comparison: ResultTable) -> View:
    """Set the schemes of a scenario: values, poses and links, and what is to be said of them below."""
    found = comparison.rows
    quantity, best = found[0].objective.quantity, max(found, key=lambda row: row.objective.value)
    details: list[Row] = beside(
        {row.label: pose_cells(row.scenario, row.pose) | _null_cells(row) for row in found}
    )
    details += [{}, *beside({row.label: _link_cells(row) for row in found})]
    starts, boxes = (sum(getattr(row.stats, name) for row in found) for name in ("starts", "boxes"))
    labelled = [(row.label, row) for row in found]
    lines = [
        *grouped((label, row.note) for label, row in labelled),
        *grouped((label, requirement_words(row)) for label, row in labelled),
        *_absent(comparison),
        *_proof_lines(comparison),
        f"{work_words(starts, boxes)} (all cases together)",
        f"* worst node: the {quantity.smallest} is here. " * (not quantity.whole)
        + "Change: from the best case.",
        "Each upper bound holds for the poses that its scheme allows.",
        "All cases use one antenna on this file's vehicle. Other vehicles and arrays: compare --airframes",
    ]
    return document(
        head(found[0].scenario.name),
        "",
        _values(found, best, "case", [row.label for row in found]),
        table("", details),
        "\n".join(lines),
    )


def airframes_view(comparison: ResultTable) -> View:
    """Set a row for each vehicle, what it guarantees under errors, what is proved, and the answer."""
    found, count = comparison.rows, len(dipoles(comparison))
    scenario, quantity = found[0].scenario, found[0].objective.quantity
    whole = comparison.of(OMNIDIRECTIONAL)[0]
    labels = [row.label for row in found]
    bold = [row.label for row in found if row.name == FILE_VEHICLE]
    verdicts = [verdict_on(comparison, row).value for row in found]
    with_errors = [index for index, row in enumerate(found) if row.guaranteed is not None]
    nominal, robust, most = numbers_of(comparison)[2:]
    guaranteed = rows(
        {
            "vehicle, dipole": [labels[index] for index in with_errors],
            "pose above": _texts(nominal[with_errors], 3),
            "robust pose": _texts(robust[with_errors], 3),
            "bound": _texts(most[with_errors], 3),
            f"change ({quantity.unit})": _texts(robust[with_errors] - robust[found.index(whole)], 3),
        }
    )
    lines = [*sufficing(quantity), *_vehicle_proof_lines(found), *_absent(comparison)]
    if scenario.is_uncertain:
        lines += [
            "Guaranteed: proved for every error within the stated limits, but not for arrays.",
            "The answer is about the values without errors.",
        ]
    return document(
        head(scenario.name),
        "",
        _values(found, whole, "vehicle, dipole", labels, bold=bold, rule=count, verdicts=verdicts),
        table(f"Guaranteed under the file's errors ({quantity.unit})", guaranteed, bold=bold)
        if scenario.is_uncertain
        else None,
        "\n".join(lines),
        "",
        head("\n".join(answer_lines(comparison))),
    )


def antennas_view(comparison: ResultTable) -> View:
    """Set the values with the paper's and the stated antennas, both poses side by side, and the answer."""
    row = {row.name: row for row in comparison.rows}
    names = {
        "promised": "1 the paper's",
        "received": "2 stated, pose 1",
        "with_null": "  isotropic ground",
        "with_ground": "  perfect null",
        "possible": "3 stated",
    }
    scenario = row["possible"].scenario
    if scenario.antenna is None or scenario.antenna_record.leak == 0.0:
        del names["with_null"], names["with_ground"]
    best = {"paper's antennas": row["promised"], "antennas as stated": row["possible"]}
    return document(
        head(scenario.name),
        "",
        _values([row[name] for name in names], row["promised"], "antennas", list(names.values())),
        table(
            "Best poses",
            beside({label: pose_cells(each.scenario, each.pose) for label, each in best.items()}),
        ),
        "Change: from row 1.",
        "Isotropic ground antennas lose nothing to polarisation.",
        *_proof_lines(comparison),
        "",
        head(antennas_answer(comparison)),
    )


def _values(
    found: Sequence[ResultRow],
    whole: ResultRow,
    heading: str,
    labels: Sequence[str],
    *,
    bold: Sequence[str] = (),
    rule: int = 0,
    verdicts: Sequence[str] | None = None,
) -> View | None:
    """Set the value and the bound of each row, its difference from one of them, and its status.

    Args:
        found: the rows.
        whole: the row that the others are compared with.
        heading: of the labels.
        labels: of the rows.
        bold: those that stand out.
        rule: place of a line between rows; 0 for none.
        verdicts: whether each vehicle suffices, in place of the power ratio.
    """
    quantity, objectives = whole.objective.quantity, [row.objective for row in found]
    values = np.array([quantity.in_unit(each.value) for each in objectives])
    has_ratio = verdicts is None and not quantity.is_rate
    cells = rows(
        {
            heading: labels,
            "power ratio": [f"{each.value:.5g}" if has_ratio else None for each in objectives],
            "value": _texts(values, 4),
            "bound": [bound_text(each, 4) for each in objectives],
            "Mbit/s": [cell(each.value_mbps, ".4f") for each in objectives],
            f"change ({quantity.unit})": _texts(values - quantity.in_unit(whole.objective.value), 3),
            "suffices": verdicts or [None] * len(found),
            "status": [_STATUS[row.status] for row in found],
        }
    )
    if rule:
        cells.insert(rule, {})
    return table(
        f"{capitalised(quantity.smallest_over)} ({quantity.unit})",
        cells,
        bold=bold,
        left=["suffices", "status"],
    )


def _texts(numbers: FloatArray, digits: int) -> list[str | None]:
    return [
        f"{number:z.{digits}f}" if math.isfinite(number) else None if math.isnan(number) else "nothing"
        for number in numbers.tolist()
    ]


def numbers_of(comparison: ResultTable) -> FloatArray:
    """Convert each row's numbers to the quantity's unit, shape ``(5, n)``; NaN for none.

    Its value and the bound on it; what the pose shown and the robust pose guarantee, and the bound on that.
    """
    in_unit = comparison.rows[0].objective.quantity.in_unit
    guaranteed = [row.guaranteed for row in comparison.rows]
    columns: list[list[float | None]] = [
        [row.objective.value for row in comparison.rows],
        [row.objective.upper_bound for row in comparison.rows],
        [kept.nominal_pose if kept else None for kept in guaranteed],
        [kept.robust_pose if kept else None for kept in guaranteed],
        [kept.upper_bound if kept else None for kept in guaranteed],
    ]
    return np.array([[math.nan if x is None else in_unit(x) for x in column] for column in columns])


def _null_cells(row: ResultRow) -> dict[str, str]:
    """Write how far the null is off what it is for."""
    points, is_even = row.scenario.interferers, row.scenario.antenna_record.is_even
    angles_rad = [(point.name, axis_angle_rad(row.pose, point.position_m, is_even)) for point in points]
    return {f"axis to {name} (deg)": f"{math.degrees(angle_rad):.2f}" for name, angle_rad in angles_rad}


def _link_cells(row: ResultRow) -> dict[str, str]:
    """Write each node's ratio, and its SINR, margin or rate with a mark where the node binds."""
    quantity, links, binding = row.objective.quantity, row.links, binding_nodes(row)
    return {f"{quantity.ratio} {link.node} (dB)": f"{link.sinr_db:.4f} " for link in links} | {
        f"{quantity.short} {link.node} ({quantity.unit})": (
            f"{quantity.in_unit(quantity.at(link)):.4f}{'*' if link.node in binding else ' '}"
        )
        for link in links
    }


def _absent(comparison: ResultTable) -> list[str]:
    """Write why cases have no row."""
    present = [(row.label, "") for row in comparison.rows]
    return grouped([*((name, f"left out: {why}") for name, why in comparison.left_out.items()), *present])


def _vehicle_proof_lines(found: Sequence[ResultRow]) -> list[str]:
    """Write what is proved of vehicles in a line, and below it what kept proofs short."""
    unchecked = dict.fromkeys(
        "arrays" if row.case.array else "dipoles" for row in found if row.rigour is Rigour.FLOATING_POINT
    )
    searched = [Status.BEST_FOUND.message for row in found if row.status is Status.BEST_FOUND]
    return [
        *["bounded: the proof stopped as soon as the verdict was clear."]
        * any(row.reason == AS_NEEDED for row in found),
        *[f"Proofs of {' and '.join(unchecked)} are not checked against rounding."] * bool(unchecked),
        *(f"{_STATUS[Status.BEST_FOUND]}: {message}." for message in dict.fromkeys(searched)),
        *grouped((row.label, "" if row.reason == AS_NEEDED else row.reason) for row in found),
    ]


def _proof_lines(comparison: ResultTable) -> list[str]:
    """Write what is proved of a table's values, of poses that were given apart."""
    solved = [row for row in comparison.rows if row.status is not Status.POSE_GIVEN]
    return [
        *(
            f"{_STATUS[status]}: {status.message.removeprefix('certified ')}."
            for status in dict.fromkeys(row.status for row in solved)
        ),
        *grouped((row.label, row.reason) for row in solved),
        *(f"Bounds: {line}" for line in rigour_lines((row.label, row.rigour) for row in solved)),
    ]
