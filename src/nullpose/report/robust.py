"""A robust solution as tables for a terminal: what is guaranteed, beside the pose that is best as stated."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nullpose.objectives import Quantity
from nullpose.report.document import beside, document, head, table
from nullpose.report.numbers import count_words, degrees_text, fixed
from nullpose.report.tables import azimuth_text, work_words
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
    scenario = solution.scenario
    quantity, guaranteed = Quantity.of(scenario), solution.robust.guaranteed
    value = f"{guaranteed:.7g} {quantity.unit}"
    if not quantity.is_rate:
        value = f"{quantity.in_unit(guaranteed):.5g} dB ({guaranteed:.5g})"
    lines = (_bound_words(solution), _status_words(solution), f"errors: {error_words(scenario)}")
    columns = {"robust pose": solution.robust, "best pose as stated": solution.nominal}
    rows = beside({name: _cells(quantity, one) for name, one in columns.items()})
    return document(
        head(scenario.name, "Robust", f"{quantity.smallest} guaranteed {value}", lines),
        table("", rows, bold=[f"guaranteed ({quantity.unit})"]),
        f"worst for the robust pose: {solution.robust.worst_case}",
        f"worst for the best as stated: {solution.nominal.worst_case}\n",
        _gain_words(solution, quantity),
    )


def _cells(quantity: Quantity, one: GuardedPose) -> dict[str, str]:
    pose, unit = one.pose, quantity.unit
    angles = (pose.roll_rad, pose.pitch_rad, pose.yaw_rad)
    return {
        f"guaranteed ({unit})": f"{quantity.in_unit(one.guaranteed):.4f}",
        f"worst found ({unit})": f"{quantity.in_unit(one.worst):.4f}",
        f"without errors ({unit})": f"{quantity.in_unit(one.nominal):.4f}",
        "position (m)": ", ".join(fixed(float(x), 3) for x in pose.position_m),
        "roll, pitch, yaw (deg)": ", ".join(map(degrees_text, angles)),
        "azimuth of the axis (deg)": azimuth_text(pose),
        "worst off": one.binding_node,
    }


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
    work = f"{count_words(solution.cases, 'error case')}, {work_words(stats.starts, stats.boxes)}"
    return f"{solution.status.value}{reason}\n{solution.rigour.message}\n{work}, {stats.wall_s:.2g} s"


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
