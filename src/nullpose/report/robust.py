"""A robust solution as tables for a terminal: what is guaranteed, beside the pose that is best as stated."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nullpose.physics.quantity import Quantity
from nullpose.report.tables import azimuth_text, count_words, degrees_text, fixed, new_table
from nullpose.scenario import Scenario
from nullpose.solve.robust import GuardedPose, RobustSolution

if TYPE_CHECKING:
    from rich.console import RenderableType

__all__ = ["error_words", "robust_view"]


def error_words(scenario: Scenario) -> str:
    """Return the errors that a scenario states, in words, as in ``axis 2 deg, M 3 m``.

    Args:
        scenario: with its errors.
    """
    parts = []
    if scenario.receiver.attitude_error_deg:
        parts.append(f"axis {scenario.receiver.attitude_error_deg:g} deg")
    if scenario.receiver.position_error_m:
        parts.append(f"position {scenario.receiver.position_error_m:g} m")
    names = (*scenario.jammer_names, *scenario.eavesdropper_names)
    reaches_m = [point.uncertainty_reach_m for point in (*scenario.jammers, *scenario.eavesdroppers)]
    parts += [f"{name} up to {m:g} m" for name, m in zip(names, reaches_m, strict=True) if m > 0.0]
    return ", ".join(parts)


def robust_view(solution: RobustSolution) -> RenderableType:
    """Return a robust solution as tables: the guarantee, its bound, and both poses side by side.

    Args:
        solution: what was found.
    """
    from rich.console import Group
    from rich.text import Text

    scenario = solution.scenario
    quantity = Quantity.of(scenario)
    title = scenario.name or "scenario"
    head = Text.assemble((title, "bold"), "\n", ("Robust", "bold blue"), ": ")
    head.append(
        f"{quantity.smallest} guaranteed {_value(quantity, solution.robust.guaranteed)}", style="bold"
    )
    for line in (_bound_words(solution), _status_words(solution), f"errors: {error_words(scenario)}"):
        head.append(f"\n{line}")
    table = new_table("", ("robust pose", "best pose as stated"))
    both = (solution.robust, solution.nominal)
    rows = {
        f"guaranteed ({quantity.unit})": [_unit(quantity, one.guaranteed) for one in both],
        f"worst found ({quantity.unit})": [_unit(quantity, one.worst) for one in both],
        f"without errors ({quantity.unit})": [_unit(quantity, one.nominal) for one in both],
        "position (m)": [", ".join(fixed(float(x), 3) for x in one.pose.position_m) for one in both],
        "roll, pitch, yaw (deg)": [_angles(one) for one in both],
        "azimuth of the axis (deg)": [azimuth_text(one.pose) for one in both],
        "worst off": [one.binding_node for one in both],
    }
    for name, cells in rows.items():
        table.add_row(name, *cells, style="bold" if name.startswith("guaranteed") else "")
    worst = Text()
    for name, one in zip(("robust pose", "best as stated"), both, strict=True):
        worst.append(f"worst for the {name}: {one.worst_case}\n")
    return Group(head, Text(), table, worst, Text(_gain_words(solution, quantity)))


def _value(quantity: Quantity, value: float) -> str:
    if quantity.is_rate:
        return f"{value:.7g} {quantity.unit}"
    return f"{quantity.in_unit(value):.5g} dB ({value:.5g})"


def _unit(quantity: Quantity, value: float) -> str:
    return f"{quantity.in_unit(value):.4f}" if value > 0.0 or quantity.is_rate else "-inf"


def _angles(one: GuardedPose) -> str:
    pose = one.pose
    return ", ".join(degrees_text(angle) for angle in (pose.roll_rad, pose.pitch_rad, pose.yaw_rad))


def _bound_words(solution: RobustSolution) -> str:
    if solution.upper_bound is None or solution.relative_gap is None:
        return "no bound on what another pose could guarantee"
    quantity = Quantity.of(solution.scenario)
    bound = math.ceil(quantity.in_unit(solution.upper_bound) * 1e4) / 1e4
    return (
        f"no pose guarantees more than {bound:.4f} {quantity.unit} (relative gap {solution.relative_gap:.1e})"
    )


def _status_words(solution: RobustSolution) -> str:
    reason = f": {solution.reason}" if solution.reason else ""
    stats = solution.stats
    effort = (
        count_words(solution.cases, "error case"),
        count_words(stats.starts, "start"),
        count_words(stats.boxes, "box", "boxes"),
    )
    rigour = solution.rigour.message
    return f"{solution.status.value}{reason}\n{rigour}\n{', '.join(effort)}, {stats.wall_s:.2g} s"


def _gain_words(solution: RobustSolution, quantity: Quantity) -> str:
    robust, nominal = solution.robust.guaranteed, solution.nominal.guaranteed
    if not nominal > 0.0:
        return "The best pose as stated guarantees nothing under these errors."
    if quantity.is_rate:
        return f"The robust pose guarantees {robust - nominal:.4g} bits/s/Hz more than the best as stated."
    return (
        f"The robust pose guarantees {robust / nominal:.3g} times as much as the best as stated "
        f"({quantity.in_unit(robust) - quantity.in_unit(nominal):+.2f} dB)."
    )
