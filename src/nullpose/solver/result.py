"""What a solve returns: a pose, what it gives, what is proved about it, and how it was found."""

from __future__ import annotations

import math
import platform
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from functools import cache, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from nullpose.files import PlainTable
from nullpose.notebook import html_table, imported
from nullpose.physics import Link, Pose, pose_frames
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.compiling import working_clock
from nullpose.solver.objective import Objective, objective_of, status_of
from nullpose.solver.options import SolveOptions
from nullpose.solver.proof import Proof
from nullpose.solver.rigour import Rigour, Status
from nullpose.solver.sensitivity import ErrorSizes, Sensitivity, sensitivity
from nullpose.version import __version__

if TYPE_CHECKING:
    import pandas as pd


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

    wall_s: float = 0.0
    starts: int = 0
    evaluations: int = 0
    boxes: int = 0
    searches: int | None = None
    agreeing: int | None = None


class Details(Protocol):
    """What a result of an array, a robust pose, a hover or a given pose has beside the numbers of all."""

    @property
    def label(self) -> str:
        """The name of the case for tables."""

    def to_dict(self, objective: PlainTable) -> PlainTable:
        """Write plain data for JSON, over the keys of a result, whose objective is given."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BoundedPose:
    """What a way of solving finds, from which the result is made.

    Args:
        scheme: the case.
        pose: position and attitude.
        links: every node's link at the pose.
        value: the number that was maximised, there.
        upper_bound: no pose has its smallest ratio above this; None if nothing is proved.
        reason: why the proof stopped short of the gap; empty if it did not.
        settings: what of the options produced it.
        stats: counts.
        rigour: of the bound; None if it has no certificate.
        note: as in a result, like the rest.
        proofs: see there.
        details: see there.
    """

    scheme: Scheme | str
    pose: Pose
    links: tuple[Link, ...]
    value: float
    upper_bound: float | None
    reason: str
    settings: dict[str, float]
    stats: Stats
    rigour: Rigour | None = None
    note: str = ""
    proofs: tuple[Proof, ...] = ()
    details: Details | None = None


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
            pose, :class:`nullpose.solver.HoverDetails` of a hover; None of one antenna.
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
        state = {each.name: getattr(self, each.name) for each in fields(self)}
        return partial(type(self), **state | {"provenance": dict(self.provenance)}), ()

    @property
    def label(self) -> str:
        """The name of the case for tables."""
        return self.details.label if self.details is not None else Scheme(self.scheme).label

    @property
    def binding_node(self) -> str | None:
        """Name of the node with the smallest SINR, margin or rate (the first, if several share it).

        None where a sum or a mean is maximised, to which every node adds.
        """
        quantity = self.objective.quantity
        return None if quantity.whole else min(self.links, key=quantity.at).node

    @property
    def rigour(self) -> Rigour:
        """How sure the bound is."""
        return self.objective.rigour

    @property
    def sensitivity(self) -> Sensitivity | None:
        """The smallest values found when attitude, position or jammers are off, in milliseconds."""
        if self.error_sizes is None or self.scenario.objective_record.of_nodes is not None:
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
        """Write the result as a row of a table: numbers by name and unit, angles in degrees."""
        quantity, bound = self.objective.quantity, self.objective.upper_bound
        angles = {name: getattr(self.pose, f"{name}_rad") for name in ("roll", "pitch", "yaw")}
        return {
            "case": self.label,
            f"{quantity.name}_{quantity.ending}": quantity.in_unit(self.objective.value),
            f"upper_bound_{quantity.ending}": None if bound is None else quantity.in_unit(bound),
            "status": self.status.value,
            **dict(zip(("x_m", "y_m", "z_m"), self.pose.position_m.tolist(), strict=True)),
            **{f"{name}_deg": math.degrees(angle_rad) for name, angle_rad in angles.items()},
            "binding_node": self.binding_node,
        }

    def frame(self) -> pd.DataFrame:
        """Tabulate the links as a data frame of pandas, a row for each node.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame([link.to_dict() for link in self.links])

    def to_dict(self) -> PlainTable:
        """Write the result as plain data for JSON; a number that JSON cannot hold becomes None."""
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


def result_of(
    scenario: Scenario,
    answer: BoundedPose,
    options: SolveOptions,
    began: float,
    error_sizes: ErrorSizes | None,
    null_jammer: str | None = None,
) -> Result:
    """Make the result of an answer.

    Args:
        scenario: what was solved.
        answer: the pose and what is proved.
        options: those of the scenario.
        began: when the solve began, on ``working_clock``.
        error_sizes: as in a result.
        null_jammer: likewise.
    """
    objective = objective_of(scenario, answer.value, answer.upper_bound, answer.rigour)
    status, reason = status_of(objective, options.target, answer.reason)
    return Result(
        scenario=scenario,
        scheme=answer.scheme,
        status=status,
        reason=reason,
        objective=objective,
        pose=answer.pose,
        links=answer.links,
        stats=replace(answer.stats, wall_s=working_clock() - began),
        provenance=provenance(options.seed) | answer.settings,
        note=answer.note,
        null_jammer=null_jammer,
        proofs=answer.proofs,
        details=answer.details,
        error_sizes=error_sizes,
    )


class Results(tuple[Result, ...]):
    """Results of several cases of a scenario, in order."""

    __slots__ = ()

    def frame(self) -> pd.DataFrame:
        """Tabulate the results as a data frame of pandas, a row for each.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame([result.row() for result in self])

    def _repr_html_(self) -> str | None:
        return html_table([result.row() for result in self])


def provenance(seed: int) -> dict[str, object]:
    """Record the versions and the seed behind a result.

    Args:
        seed: the seed of the search.
    """
    return _versions() | {"seed": seed}


@cache
def _versions() -> dict[str, object]:
    import numba

    return {
        "nullpose": __version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "numba": numba.__version__,
        "machine": platform.machine(),
        "system": platform.system(),
    }
