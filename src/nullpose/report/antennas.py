"""What the antennas that a scenario states change, as a table and in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, beside, document, grouped, head, rows, table
from nullpose.report.numbers import bound_text, capitalised, less_or_more, with_unit
from nullpose.report.results import pose_cells
from nullpose.study import ResultTable


def antennas_view(comparison: ResultTable) -> View:
    """Set the values with the paper's and the stated antennas, both poses side by side, and the answer."""
    row = {row.name: row for row in comparison.rows}
    promised, possible = row["promised"], row["possible"]
    scenario, quantity = possible.scenario, possible.objective.quantity
    values = {
        "1 best pose for the paper's antennas": promised.objective.value,
        "2 pose 1 with the stated antennas": row["received"].objective.value,
    }
    if scenario.antenna is not None and scenario.antenna_record.leak > 0.0:
        values["  as 2, isotropic ground antennas"] = row["with_null"].objective.value
        values["  as 2, perfect null of the drone's antenna"] = row["with_ground"].objective.value
    values["3 best pose for the stated antennas"] = possible.objective.value
    numbers = [quantity.in_unit(value) for value in values.values()]
    none = [None] * (len(numbers) - 2)
    columns: dict[str, Sequence[str | None]] = {
        "pose and antennas": list(values),
        "value": [_text(number, 4) for number in numbers],
        "bound": [bound_text(promised.objective, 4), *none, bound_text(possible.objective, 4)],
        "difference": [_text(number - numbers[0], 3) for number in numbers],
    }
    labelled = {"paper's antennas": promised, "antennas as stated": possible}
    title = f"{capitalised(quantity.smallest)} over the nodes ({quantity.unit})"
    return document(
        head(scenario.name),
        "",
        table(title, rows(columns), left=["pose and antennas"]),
        table("Best poses", beside({label: pose_cells(result.pose) for label, result in labelled.items()})),
        "Difference: from row 1. Bounds are rounded up.",
        "Isotropic ground antennas lose nothing to polarisation.",
        *dict.fromkeys(result.status.message for result in labelled.values()),
        *grouped((label, result.reason) for label, result in labelled.items()),
        *rigour_lines((label, result.objective.rigour) for label, result in labelled.items()),
        "",
        head(answer(comparison)),
    )


def answer(comparison: ResultTable) -> str:
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
        f"{pose} gives {less_or_more(received - promised, quantity)} if the antennas are the stated ones. "
        f"{other} gives {with_unit(abs(possible - received), quantity)} more than that."
    )


def _text(number: float, digits: int) -> str:
    return f"{number:z.{digits}f}" if math.isfinite(number) else "nothing"
