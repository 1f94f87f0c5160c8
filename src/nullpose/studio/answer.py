"""What is found for a version of a scene: answers, progress, the power curve; and the words for them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from decimal import Decimal

from nullpose.report.links import binding_nodes
from nullpose.report.numbers import MINUS, rounded_up
from nullpose.report.sensitivity import sensitivity_words, sizes_words
from nullpose.scenario import Scenario
from nullpose.solver import Result, Rigour, Status
from nullpose.solver.robust import GuardedPose, RobustDetails
from nullpose.solver.trajectory import Trajectory
from nullpose.studio.case import PoseCase
from nullpose.study import MountTilt, ResultTable


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Event:
    """What a worker finds for a version of a scene.

    Args:
        version: the version of the scene that it belongs to.
    """

    version: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Answer(Event):
    """A result and what is said of it, for one version of a scene.

    Args:
        case: the case it answers.
        result: what the solver returned; the value of a robust one is what its pose guarantees.
        worst_nodes: those with the smallest value; of a robust pose the one with the smallest guarantee.
        note: a sentence on it; may be empty.
        errors: what is lost if attitude, position and jammers are off, a line and perhaps a sentence; empty
            before it is worked out.
    """

    case: PoseCase
    result: Result
    worst_nodes: frozenset[str]
    note: str
    errors: tuple[str, ...] = ()

    @property
    def guarded(self) -> GuardedPose | None:
        """What the pose guarantees, node by node; None of a case without errors, or while it is not known."""
        details = self.result.details
        return details.robust if self.case.robust and isinstance(details, RobustDetails) else None

    @property
    def shown_value(self) -> float:
        """The value in the unit that is shown: dB, or bits/s/Hz."""
        return self.result.objective.quantity.in_unit(self.result.objective.value)

    @property
    def unit(self) -> str:
        """Its unit."""
        return self.result.objective.quantity.unit


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Notice(Event):
    """Why there is no answer: a case that cannot be solved, or kernels that are being compiled.

    Args:
        case: the case that cannot be solved; None while the kernels are compiled, once after an installation.
        words: what to show.
    """

    case: PoseCase | None
    words: str


class TiltNotice(Notice):
    """The least tilt that the vehicle needs, in words; empty where nothing is known of it."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PowerCurve(Event):
    """The objective of several schemes against the jamming power, as far as it has been worked out.

    Args:
        table: one row for each power, in dB, and scheme.
        complete: whether all powers are there.
    """

    table: ResultTable
    complete: bool


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Progress(Event):
    """How far a proof that runs has come.

    Args:
        case: the case that is proved.
        gap: the bound above the value, relative.
        boxes: how many were examined.
    """

    case: PoseCase
    gap: float
    boxes: int


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Flight(Event):
    """A flight through a scene in motion, whose instants are all one to it.

    Args:
        motion: the scene in motion.
        words: on the flight, its value first; that it is planned, or why there is none.
        found: the flight; None while it is planned, or if there is none.
    """

    motion: Scenario
    words: tuple[str, ...]
    found: Trajectory | None = None


def signed(number: float, digits: int = 2) -> str:
    """Return a number as a page writes it.

    Args:
        number: any.
        digits: how many decimals.
    """
    return f"{number:z.{digits}f}".replace("-", MINUS).replace("inf", "\N{INFINITY}")


def answer_of(version: int, case: PoseCase, result: Result) -> Answer:
    """Return the answer that a result is.

    Args:
        version: the version of the scene that was solved.
        case: the case that was solved.
        result: what the solver returned.
    """
    worst, note = binding_nodes(result), result.note
    if case.robust and isinstance(result.details, RobustDetails):
        robust = result.details.robust
        # whose guarantee is the value
        worst = frozenset({min(robust.guarantee.ratios, key=lambda ratio: ratio.lower).node})
        note = f"Worst case: {robust.worst_case}"
    note = ". ".join(filter(None, (note, result.reason and f"The proof stopped: {result.reason}")))
    return Answer(version=version, case=case, result=result, worst_nodes=worst, note=note)


def with_errors(answer: Answer) -> Answer:
    """Return an answer with what is lost if attitude, position and jammers are off; takes milliseconds.

    A robust answer, whose value allows for the stated errors, is returned as it is.

    Args:
        answer: whose proof has ended.
    """
    result = answer.result
    found = None if answer.case.robust else result.sensitivity
    if found is None:
        return answer
    quantity = found.quantity
    loss = signed(quantity.in_unit(found.nominal) - quantity.in_unit(found.all))
    sizes = sizes_words(result, found.sizes).replace(" m", "\N{NO-BREAK SPACE}m")
    line = f"can lose {loss} {quantity.unit} or more with errors up to {sizes}"
    sentence = (sensitivity_words(result) or "").partition(":")[0]
    return replace(answer, errors=(line, f"{sentence}.") if sentence else (line,))


def tilt_words(mount: MountTilt, share: float) -> str:
    """Say which least tilt suffices, and what is proved of less.

    Args:
        mount: the tilts of the vehicle's mount.
        share: of the value that suffices.
    """
    at = f"(mount {mount.mount_deg:g}\N{DEGREE SIGN}) for {percent_rounded_up(share)} of the best value"
    if mount.suffices_deg is None:
        return (
            "" if mount.fails_deg is None else f"Least tilt above {mount.fails_deg:.1f}\N{DEGREE SIGN} {at}"
        )
    less = "" if mount.fails_deg is None else f"; {mount.fails_deg:.1f}\N{DEGREE SIGN} is proved too little"
    return (
        f"Least tilt {'' if mount.is_known else 'at most '}{mount.suffices_deg:.1f}\N{DEGREE SIGN} {at}{less}"
    )


def status_words(answer: Answer | None) -> str:
    """Say how far the solve of the present scene has come.

    Args:
        answer: the latest to the present scene, or None.
    """
    if answer is None:
        return "solving"
    result, gap = answer.result, answer.result.objective.relative_gap
    if result.status is Status.BEST_FOUND or gap is None or not math.isfinite(gap):
        return "Best found so far"
    if result.status is Status.CERTIFIED:
        unsure = ", in floating point" if result.rigour is Rigour.FLOATING_POINT else ""
        return f"Proved optimal (gap {percent_rounded_up(gap)}{unsure})"
    return f"At most {percent_rounded_up(gap / (1.0 + gap))} below the optimum"


def percent_rounded_up(share: float) -> str:
    """Write a share in per cent, rounded up.

    Args:
        share: at least 0.
    """
    return f"{Decimal(rounded_up(100.0 * share)):f} %" if math.isfinite(share) else "not finite"
