"""What the antennas that a scenario states change, as a table and in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.certainty import rigour_lines
from nullpose.report.document import View, beside, document, grouped, head, rows, table
from nullpose.report.geometry import tilt_rad
from nullpose.report.numbers import begun, bound_text, degrees_text, fixed, with_unit
from nullpose.report.results import azimuth_text
from nullpose.solver import Result
from nullpose.study import AntennaComparison


def antennas_view(comparison: AntennaComparison) -> View:
    """Return the values with the paper's and the stated antennas, both poses side by side, and the answer.

    Args:
        comparison: of the paper's antennas with those of a scenario.
    """
    scenario, quantity = comparison.scenario, Quantity.of(comparison.scenario)
    promised, possible = comparison.promised, comparison.possible
    values = {
        "1 best pose for the paper's antennas": promised.objective.value,
        "2 pose 1 with the stated antennas": comparison.received,
    }
    if scenario.antenna is not None and scenario.antenna_record.leak > 0.0:
        values["  as 2, isotropic ground antennas"] = comparison.with_null
        values["  as 2, perfect null of the drone's antenna"] = comparison.with_ground
    values["3 best pose for the stated antennas"] = possible.objective.value
    numbers = [quantity.in_unit(value) for value in values.values()]
    whole, none = numbers[0], [None] * (len(numbers) - 2)
    columns: dict[str, Sequence[str | None]] = {
        "pose and antennas": list(values),
        "value": [_told(number, 4) for number in numbers],
        "bound": [bound_text(promised.objective, 4), *none, bound_text(possible.objective, 4)],
        "difference": [_told(number - whole, 3) for number in numbers],
    }
    poses = {"paper's antennas": _pose_cells(promised), "antennas as stated": _pose_cells(possible)}
    both = [("paper's antennas", promised), ("antennas as stated", possible)]
    return document(
        head(scenario.name),
        "",
        table(
            f"{begun(quantity.smallest)} over the nodes ({quantity.unit})",
            rows(columns),
            left=["pose and antennas"],
        ),
        table("Best poses", beside(poses)),
        "Difference: from row 1. Bounds are rounded up.",
        "Isotropic ground antennas lose nothing to polarisation.",
        *dict.fromkeys(result.status.message for _, result in both),
        *grouped((label, result.reason) for label, result in both),
        *rigour_lines((label, result.objective.rigour) for label, result in both),
        "",
        head(answer(comparison)),
    )


def answer(comparison: AntennaComparison) -> str:
    """Return in two sentences what the stated antennas cost and what the best pose for them recovers.

    Args:
        comparison: of the paper's antennas with those of a scenario.
    """
    quantity = Quantity.of(comparison.scenario)
    flown = "The best pose for the paper's antennas"
    received, possible = (
        quantity.in_unit(x) for x in (comparison.received, comparison.possible.objective.value)
    )
    if not math.isfinite(received):
        best = with_unit(possible, quantity)
        return (
            f"{flown} leaves a node without signal if the antennas are the stated ones. The best pose for "
            f"the stated antennas reaches {best}."
        )
    lost = quantity.in_unit(comparison.promised.objective.value) - received
    gained = with_unit(abs(possible - received), quantity)
    less = f"{with_unit(abs(lost), quantity)} {'less' if lost >= 0.0 else 'more'}"
    return (
        f"{flown} gives {less} if the antennas are the stated ones. The best pose for the stated antennas "
        f"gives {gained} more than that."
    )


def _told(number: float, digits: int) -> str:
    return fixed(number, digits) if math.isfinite(number) else "nothing"


def _pose_cells(result: Result) -> dict[str, str]:
    pose = result.pose
    place: FloatArray = pose.position_m
    return {
        **{f"{axis} (m)": fixed(float(at), 3) for axis, at in zip("xyz", place, strict=True)},
        "roll (deg)": degrees_text(pose.roll_rad),
        "pitch (deg)": degrees_text(pose.pitch_rad),
        "yaw (deg)": degrees_text(pose.yaw_rad),
        "axis tilt (deg)": degrees_text(tilt_rad(pose)),
        "axis azimuth (deg)": azimuth_text(pose),
    }
