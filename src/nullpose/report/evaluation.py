"""Given poses as tables: one in full, several in a row each."""

from __future__ import annotations

from nullpose.report.document import View, document, head, rows, table
from nullpose.report.numbers import bound_words, degrees_text, fixed, stated, with_unit
from nullpose.report.results import solution_view
from nullpose.study import Evaluation

_SHOWN = 40  # rows of a longer list are thinned out on the screen


def evaluation_view(evaluation: Evaluation) -> View:
    """Return what poses give: one in full, several as a table.

    Args:
        evaluation: one pose or more.
    """
    results, best = evaluation.results, evaluation.best
    if len(results) == 1:
        return solution_view(results[0])
    quantity = best.objective.quantity
    step = -(-len(results) // _SHOWN)
    shown = list(enumerate(results, start=1))[::step]
    poses = [one.pose for _, one in shown]
    angles = ("roll_rad", "pitch_rad", "yaw_rad")
    columns: dict[str, list[str | None]] = {
        "pose": [str(number) for number, _ in shown],
        "position (m)": [" ".join(fixed(float(x), 2) for x in pose.position_m) for pose in poses],
        "attitude (deg)": [
            " ".join(degrees_text(getattr(pose, angle), 1) for angle in angles) for pose in poses
        ],
        f"{quantity.short} ({quantity.unit})": [
            f"{quantity.in_unit(one.objective.value):.4f}" for _, one in shown
        ],
        "worst node": [one.binding_node for _, one in shown],
        f"to bound ({quantity.unit})": [
            "not allowed" if one.not_allowed else stated(one.below_bound, ".4f") for _, one in shown
        ],
    }
    value = with_unit(quantity.in_unit(best.objective.value), quantity)
    lines = (bound_words(best.objective), best.objective.rigour.message, f"{len(results)} poses given")
    return document(
        head(best.scenario.name, "Best pose", f"{quantity.smallest} {value}", lines),
        table("", rows(columns), left=["worst node"]),
        f"One row in {step} is shown." if step > 1 else None,
        "Not allowed: --pose and --json tell why." if any(one.not_allowed for one in results) else None,
    )
