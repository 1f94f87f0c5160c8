"""What a solve returns: a pose, what it gives, what is proved about it, and how it was found."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from enum import StrEnum
from functools import partial
from types import MappingProxyType
from typing import Any, Protocol

from nullpose.errors import SolveError
from nullpose.notebook import html_table, imported
from nullpose.objectives import Quantity
from nullpose.physics import Link, Pose, pose_frames
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.solver.proof import INTERRUPT, Proof
from nullpose.solver.rigour import Rigour, bound_above
from nullpose.solver.sensitivity import ErrorSizes, Sensitivity, sensitivity


class Status(StrEnum):
    """How a solve ended."""

    CERTIFIED = "certified"
    GAP_NOT_REACHED = "gap-not-reached"
    BEST_FOUND = "best-found"
    GIVEN = "given"

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return _MESSAGES[self]


_MESSAGES = {
    Status.CERTIFIED: "certified optimal within the requested gap",
    Status.GAP_NOT_REACHED: "the upper bound is valid, but the requested gap was not reached",
    Status.BEST_FOUND: "best of many local optima, not proved to be global",
    Status.GIVEN: "the pose was given, not searched for",
}

_ROUNDING = 1e-6  # of a gap, by the rounding of value and bound: 1e-9 of a ratio is 1e-6 of the least rate


@dataclass(frozen=True, slots=True, kw_only=True)
class Stats:
    """What the solve cost.

    Args:
        wall_s: wall-clock time, seconds, without that in which this process waited for compiled kernels.
        starts: local searches run.
        evaluations: poses evaluated.
        boxes: boxes of positions examined by the proof; 0 without one.
        searches: independent searches made, where several were.
        agreeing: those of them that ended at the best value, within 1e-4.
    """

    wall_s: float
    starts: int
    evaluations: int
    boxes: int = 0
    searches: int | None = None
    agreeing: int | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Objective:
    """The number that was maximised, evaluated at the reported pose, and what is proved about it.

    Args:
        name: that of its quantity, as in ``"min_sinr"``, the smallest SINR over the nodes (paper eq. 2.2).
        value: that number: a power ratio, or bits/s/Hz for a rate.
        value_db: the same in dB; not a number for a rate.
        upper_bound: no pose exceeds this; None if nothing is proved.
        relative_gap: ``(upper_bound - value) / value``, a rate below 1e-3 bits/s/Hz counting as so much; None
            if nothing is proved.
        rigour: how sure the bound is.
    """

    name: str
    value: float
    value_db: float
    upper_bound: float | None = None
    relative_gap: float | None = None
    rigour: Rigour = Rigour.NONE

    @property
    def quantity(self) -> Quantity:
        """What the number is of, and its unit."""
        return Quantity.named(self.name)

    def to_dict(self) -> dict[str, Any]:
        """Return value and bound as plain data for JSON; None for a number that JSON cannot hold."""
        return {
            "name": self.name,
            "value": self.value,
            "value_db": _finite(self.value_db),
            "upper_bound": self.upper_bound,
            "relative_gap": _finite(self.relative_gap),
        }


def objective_of(
    scenario: Scenario, value: float, ratio_bound: float | None, rigour: Rigour = Rigour.FLOATING_POINT
) -> Objective:
    """Return the objective at a pose with what is proved about it.

    Args:
        scenario: what it asks for decides which number it is.
        value: that number.
        ratio_bound: no pose has its smallest ratio above this; None if nothing is proved.
        rigour: of the bound, if there is one.

    Raises:
        SolveError: the bound is below the value: a fault of nullpose.
    """
    quantity = Quantity.of(scenario)
    bound = gap = None
    if ratio_bound is not None:
        ratio = 2.0**value if quantity.is_rate else value
        bound = max(value, quantity.of_ratio(float(bound_above(ratio, ratio_bound))))  # log2 is rounded
        gap = quantity.gap(value, bound)
    return Objective(
        name=quantity.name,
        value=value,
        value_db=math.nan if quantity.is_rate else quantity.in_unit(value),
        upper_bound=bound,
        relative_gap=gap,
        rigour=Rigour.NONE if bound is None else rigour,
    )


def status_of(objective: Objective, requested_gap: float, reason: str) -> tuple[Status, str]:
    """Return how a solve ended and why not better, decided from the numbers that are reported.

    Certified means that the reported gap, by the quantity's own rule, is at most the one requested.

    Args:
        objective: value and bound, as reported.
        requested_gap: relative.
        reason: why the solver's proof stopped short of that gap; empty if it says that it did not.

    Raises:
        SolveError: the solver says that the gap is reached and the reported numbers do not, by more than
            1e-6: a fault of nullpose.
    """
    gap = objective.relative_gap
    if gap is None:
        return Status.BEST_FOUND, reason
    if gap <= requested_gap:
        return Status.CERTIFIED, reason if reason == INTERRUPT else ""
    if not reason and gap > requested_gap + _ROUNDING * (1.0 + requested_gap):
        raise SolveError(
            f"the proof reached a relative gap of {requested_gap:g}, but the reported value "
            f"{objective.value!r} and bound {objective.upper_bound!r} are {gap:.3g} apart; "
            "this is a fault of nullpose: please report it with the scenario"
        )
    return Status.GAP_NOT_REACHED, reason or "the rounding of value and bound"


class Details(Protocol):
    """What a result of an array, of a robust pose or of a given pose has beside the numbers of all."""

    @property
    def label(self) -> str:
        """The name of the case for tables."""

    def to_dict(self, objective: dict[str, Any]) -> dict[str, Any]:
        """Return plain data for JSON, over the keys of a result, whose objective is given."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Result:
    """A pose, what it gives, and how it was found.

    Args:
        scenario: what was solved.
        scheme: the case.
        status: how the solve ended.
        objective: the value at the pose and the bound on it.
        pose: position and attitude.
        links: every node's link at the pose (paper eq. 2.1), in the scenario's order.
        stats: time and counts.
        provenance: versions, seed and settings that produced it.
        note: a sentence on what the scheme did here, such as which jammer the null points at; may be empty.
        reason: what kept the gap from being reached, or the pose from being certified; empty if nothing did.
        null_jammer: the jammer that was asked to be nulled, if one was.
        proofs: what the branch and bound showed, for each axis field of the scheme.
        error_sizes: the errors that :attr:`sensitivity` tries; None for one of many poses, which tells none.
        details: :class:`ArrayDetails` of an array, :class:`nullpose.solver.robust.RobustDetails` of a robust
            pose; None of one antenna.
    """

    scenario: Scenario
    scheme: Scheme | str
    status: Status
    objective: Objective
    pose: Pose
    links: tuple[Link, ...]
    stats: Stats
    provenance: Mapping[str, Any]
    note: str = ""
    reason: str = ""
    null_jammer: str | None = None
    proofs: tuple[Proof, ...] = field(default=(), repr=False)
    error_sizes: ErrorSizes | None = field(default=ErrorSizes(), repr=False)
    details: Details | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "provenance", MappingProxyType(dict(self.provenance)))

    def __reduce__(self) -> tuple[Callable[[], Result], tuple[()]]:
        state = {one.name: getattr(self, one.name) for one in fields(self)}
        return partial(type(self), **state | {"provenance": dict(self.provenance)}), ()

    @property
    def label(self) -> str:
        """The name of the case for tables."""
        return self.details.label if self.details is not None else Scheme(self.scheme).label

    @property
    def binding_node(self) -> str:
        """Name of the node with the smallest SINR, margin or rate (the first, if several share it)."""
        return min(self.links, key=self.objective.quantity.at).node

    @property
    def rigour(self) -> Rigour:
        """How sure the bound is."""
        return self.objective.rigour

    @property
    def sensitivity(self) -> Sensitivity | None:
        """The smallest values found when attitude, position or jammers are off, in milliseconds."""
        if self.error_sizes is None:
            return None
        return sensitivity(self.scenario, self.pose, self.error_sizes)

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended its proof."""
        return self.reason == INTERRUPT

    def __repr__(self) -> str:
        quantity, bound = self.objective.quantity, self.objective.upper_bound
        value = f"{quantity.smallest} {quantity.in_unit(self.objective.value):.7g} {quantity.unit}"
        above = "" if bound is None else f", at most {quantity.in_unit(bound):.7g}"
        place = ", ".join(f"{x:z.3f}" for x in self.pose.position_m)
        return f"{type(self).__name__}({self.label}, {self.status.value}: {value}{above}; at ({place}) m)"

    def row(self) -> dict[str, object]:
        """Return the result as a row of a table: numbers by name and unit, angles in degrees."""
        quantity, bound = self.objective.quantity, self.objective.upper_bound
        unit = "bps_hz" if quantity.is_rate else "db"
        angles = {name: getattr(self.pose, f"{name}_rad") for name in ("roll", "pitch", "yaw")}
        return {
            "case": self.label,
            f"{quantity.name}_{unit}": quantity.in_unit(self.objective.value),
            f"upper_bound_{unit}": None if bound is None else quantity.in_unit(bound),
            "status": self.status.value,
            **dict(zip(("x_m", "y_m", "z_m"), self.pose.position_m.tolist(), strict=True)),
            **{f"{name}_deg": math.degrees(angle_rad) for name, angle_rad in angles.items()},
            "binding_node": self.binding_node,
        }

    def frame(self) -> Any:
        """Return the links as a data frame of pandas, a row for each node.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame([link.to_dict() for link in self.links])

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain data for JSON; a number that JSON cannot hold becomes None."""
        stats = {key: value for key, value in asdict(self.stats).items() if value is not None}
        objective, sensitivity = self.objective.to_dict(), self.sensitivity
        return {
            "scenario": self.scenario.to_dict(),
            "scheme": str(self.scheme),
            "status": self.status.value,
            "reason": self.reason,
            "rigour": self.rigour.value,
            "objective": objective,
            "pose": self.pose.to_dict() | {"frames": pose_frames(self.scenario, self.pose).to_dict()},
            "links": [link.to_dict() for link in self.links],
            "binding_node": self.binding_node,
            "stats": stats,
            "provenance": dict(self.provenance),
            "note": self.note,
            **({} if sensitivity is None else {"sensitivity": sensitivity.to_dict()}),
            **({} if self.details is None else self.details.to_dict(objective)),
        }


class Results(tuple[Result, ...]):
    """Results of several cases of a scenario, in order."""

    __slots__ = ()

    def frame(self) -> Any:
        """Return the results as a data frame of pandas, a row for each.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame([one.row() for one in self])

    def _repr_html_(self) -> str | None:
        return html_table([result.row() for result in self])


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None
