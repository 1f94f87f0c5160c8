"""What is shown for one case of one version of a scene."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from nullpose.objectives import Quantity
from nullpose.physics import Link, Pose, evaluate, to_db
from nullpose.report.numbers import short
from nullpose.scenario import Scenario
from nullpose.solve import Solution, Status
from nullpose.solve.robust import RobustSolution
from nullpose.studio.case import Case

__all__ = ["Answer", "Stage", "answer_of", "robust_answer_of", "status_words"]


class Stage(StrEnum):
    """How far the solve of a case has come."""

    BEST_SO_FAR = "best so far"
    CERTIFIED = "certified"
    NOT_CERTIFIED = "not certified"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answer:
    """A pose and what is known of it, for one version of a scene.

    Args:
        version: the version of the scene that it belongs to.
        case: the case it answers.
        scenario: what was solved for it.
        stage: how far it has come.
        pose: where the drone is and how it is turned.
        links: what every node has there.
        value: the objective: a power ratio, or bits/s/Hz; of the robust case, what the pose guarantees.
        bound: no pose exceeds this; None if nothing is proved.
        gap: relative gap between the two; None if nothing is proved.
        binding_node: the node that decides.
        note: a sentence on the answer; may be empty.
        seconds: what its solve took.
        solution: what the solver returned.
    """

    version: int
    case: Case
    scenario: Scenario
    stage: Stage
    pose: Pose
    links: tuple[Link, ...]
    value: float
    bound: float | None
    gap: float | None
    binding_node: str
    note: str
    seconds: float
    solution: Solution | RobustSolution

    @property
    def quantity(self) -> Quantity:
        """What the value is of, and its unit."""
        return Quantity.of(self.scenario)

    @property
    def shown_value(self) -> float:
        """The value in the unit that is shown: dB, or bits/s/Hz."""
        return self._in_unit(self.value)

    @property
    def shown_bound(self) -> float | None:
        """The bound in the unit that is shown; None if nothing is proved."""
        return None if self.bound is None else self._in_unit(self.bound)

    def _in_unit(self, value: float) -> float:
        return value if self.quantity.is_rate else float(to_db(value))


def answer_of(version: int, case: Case, solution: Solution) -> Answer:
    """Return the answer that a solution is.

    Args:
        version: the version of the scene that was solved.
        case: the case that was solved.
        solution: what the solver returned.
    """
    objective = solution.objective
    return Answer(
        version=version,
        case=case,
        scenario=solution.scenario,
        stage=_STAGES[solution.status],
        pose=solution.pose,
        links=solution.links,
        value=objective.value,
        bound=objective.upper_bound,
        gap=objective.relative_gap,
        binding_node=solution.binding_node,
        note=". ".join(text for text in (solution.note, _stopped(solution.reason)) if text),
        seconds=solution.stats.wall_s,
        solution=solution,
    )


def robust_answer_of(version: int, case: Case, solution: RobustSolution) -> Answer:
    """Return the answer that a robust solution is: its value is what the pose guarantees.

    Args:
        version: the version of the scene that was solved.
        case: the case that was solved.
        solution: what the robust solver returned.
    """
    robust = solution.robust
    return Answer(
        version=version,
        case=case,
        scenario=solution.scenario,
        stage=_STAGES[solution.status],
        pose=robust.pose,
        links=evaluate(solution.scenario, robust.pose),
        value=robust.guaranteed,
        bound=solution.upper_bound,
        gap=solution.relative_gap,
        binding_node=robust.binding_node,
        note=". ".join(
            text for text in (f"Worst case: {robust.worst_case}", _stopped(solution.reason)) if text
        ),
        seconds=solution.stats.wall_s,
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
    if answer.stage is Stage.BEST_SO_FAR or answer.gap is None:
        return "best so far"
    reach = short(answer.gap) if math.isfinite(answer.gap) else "no gap that is finite"
    if answer.stage is Stage.CERTIFIED:
        return f"certified to {reach}, {answer.solution.rigour.value}"
    return f"best so far, proved to {reach}"


def _stopped(reason: str) -> str:
    return f"The proof stopped: {reason}" if reason else ""


_STAGES = {
    Status.CERTIFIED: Stage.CERTIFIED,
    Status.GAP_NOT_REACHED: Stage.NOT_CERTIFIED,
    Status.BEST_FOUND: Stage.BEST_SO_FAR,
}
