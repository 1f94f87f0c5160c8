"""What is shown for one case of one version of a scene."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nullpose.objectives import Quantity
from nullpose.physics import Link, Pose, evaluate
from nullpose.report.numbers import short
from nullpose.scenario import Scenario
from nullpose.solve import Solution, Status
from nullpose.solve.robust import RobustSolution
from nullpose.studio.case import Case

__all__ = ["Answer", "answer_of", "status_words"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answer:
    """A pose and what is known of it, for one version of a scene.

    Args:
        version: the version of the scene that it belongs to.
        case: the case it answers.
        status: how far it is proved.
        pose: where the drone is, and its attitude.
        links: what every node has there.
        value: the objective: a power ratio, or bits/s/Hz; of the robust case, what the pose guarantees.
        bound: no pose exceeds this; None if nothing is proved.
        gap: relative gap between the two; None if nothing is proved.
        binding_node: the node that decides.
        note: a sentence on the answer; may be empty.
        solution: what the solver returned.
    """

    version: int
    case: Case
    status: Status
    pose: Pose
    links: tuple[Link, ...]
    value: float
    bound: float | None
    gap: float | None
    binding_node: str
    note: str
    solution: Solution | RobustSolution

    @property
    def scenario(self) -> Scenario:
        """What was solved for it."""
        return self.solution.scenario

    @property
    def quantity(self) -> Quantity:
        """What the value is of, and its unit."""
        return Quantity.of(self.scenario)

    @property
    def shown_value(self) -> float:
        """The value in the unit that is shown: dB, or bits/s/Hz."""
        return self.quantity.in_unit(self.value)


def answer_of(version: int, case: Case, solution: Solution | RobustSolution) -> Answer:
    """Return the answer that a solution is; the value of a robust one is what its pose guarantees.

    Args:
        version: the version of the scene that was solved.
        case: the case that was solved.
        solution: what the solver returned.
    """
    stopped = f"The proof stopped: {solution.reason}" if solution.reason else ""
    if isinstance(solution, RobustSolution):
        best, note = solution.robust, f"Worst case: {solution.robust.worst_case}"
        pose, links, node = best.pose, evaluate(solution.scenario, best.pose), best.binding_node
        value, bound, gap = best.guaranteed, solution.upper_bound, solution.relative_gap
    else:
        pose, links, node, note = solution.pose, solution.links, solution.binding_node, solution.note
        objective = solution.objective
        value, bound, gap = objective.value, objective.upper_bound, objective.relative_gap
    return Answer(
        version=version,
        case=case,
        status=solution.status,
        pose=pose,
        links=links,
        value=value,
        bound=bound,
        gap=gap,
        binding_node=node,
        note=". ".join(filter(None, (note, stopped))),
        solution=solution,
    )


def status_words(version: int, answer: Answer | None) -> str:
    """Return how far the solve of the present scene has come, in words.

    An answer to another version of the scene counts for nothing.

    Args:
        version: the present version of the scene.
        answer: the latest answer, or None.
    """
    if answer is None or answer.version != version:
        return "solving"
    if answer.status is Status.BEST_FOUND or answer.gap is None:
        return "best so far"
    reach = short(answer.gap) if math.isfinite(answer.gap) else "no gap that is finite"
    if answer.status is Status.CERTIFIED:
        return f"certified to {reach}, {answer.solution.rigour.value}"
    return f"best so far, proved to {reach}"
