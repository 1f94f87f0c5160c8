"""Families of one shape, stacked for the kernel that settles them all in one call."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.family import AxisField, Family
from nullpose.solve.incumbent import Incumbent
from nullpose.solve.multistart import CLIMBS, landmarks, search_settings, shift_of
from nullpose.solve.options import SolveOptions
from nullpose.solve.precompile import ready
from nullpose.solve.proof import DIRECT_NODES, INSIDE, BudgetUsed, late_nodes, prove

__all__ = ["Batch", "BatchOutcome", "same_shape"]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]

_SHARED = ("numerator_point", "denominator_of", "denominator_start", "denominator_point", "turn")
_VARIED = (
    "points_m",
    "numerator_isotropic",
    "numerator_weight",
    "denominator_isotropic",
    "denominator_weight",
)
_PLACES = (
    "low_m",
    "high_m",
    "piece_start",
    "piece_sides",
    "zone_kind",
    "zone_start",
    "zone_edges",
    "zone_range_m",
)
_OPEN, _PROVED, _UNPLACED = 0, 1, 2  # as in the kernel, which is not loaded before it is needed


def same_shape(family: Family) -> tuple[object, ...]:
    """Return what families must have in common to be stacked.

    Args:
        family: one of them.
    """
    alike = [getattr(family, name).tobytes() for name in (*_SHARED, *_PLACES)]
    sizes = [getattr(family, name).shape for name in (*_VARIED, "keep_out_points_m")]
    return (family.keep_out_m, *alike, *sizes)


@dataclass(slots=True, eq=False)
class BatchOutcome:
    """Poses of a batch's families under one axis field, and what is proved of them; arrays by family.

    Args:
        position_m: (s, 3).
        axis: (s, 3).
        multipliers: (s, r) of the ratios at the pose.
        log_value: (s,) the smallest log ratio; minus infinity where no pose was found yet.
        bound: (s,) no pose has its smallest ratio above this; infinity if nothing is proved.
        boxes: (s,) boxes of positions examined.
        code: (s,) open, proved, or no position found, as the kernel has them.
        reason: why the gap was not reached; empty where it was.
    """

    position_m: FloatArray
    axis: FloatArray
    multipliers: FloatArray
    log_value: FloatArray
    bound: FloatArray
    boxes: IntArray
    code: IntArray
    reason: list[str]

    @classmethod
    def blank(cls, count: int, ratios: int) -> BatchOutcome:
        """Return one in which nothing is known.

        Args:
            count: how many families.
            ratios: of each.
        """
        return cls(
            position_m=np.zeros((count, 3)),
            axis=np.tile([0.0, 0.0, 1.0], (count, 1)),
            multipliers=np.zeros((count, ratios)),
            log_value=np.full(count, -math.inf),
            bound=np.full(count, math.inf),
            boxes=np.zeros(count, np.int64),
            code=np.zeros(count, np.int64),
            reason=[""] * count,
        )

    def learn_from(self, larger: BatchOutcome, band: tuple[float, float]) -> None:
        """Take over the bounds of a field with more axes, and its poses whose axis this field has too.

        Args:
            larger: of a field that holds all the axes of this one.
            band: least and greatest ``u_z^2`` of this one.
        """
        self.bound = np.minimum(self.bound, larger.bound)
        upright = larger.axis[:, 2] ** 2 / np.sum(larger.axis**2, axis=1)
        within = (band[0] <= upright) & (upright <= band[1]) & (larger.log_value > self.log_value)
        for name in ("position_m", "axis", "multipliers", "log_value"):
            getattr(self, name)[within] = getattr(larger, name)[within]

    @property
    def placed(self) -> NDArray[np.bool_]:
        """Where there is a pose, (s,)."""
        return np.asarray(self.code != _UNPLACED)

    @property
    def certified(self) -> NDArray[np.bool_]:
        """Where the gap that was asked for is reached, (s,)."""
        return np.asarray(self.code == _PROVED)


class Batch:
    """Families of one shape.

    Args:
        families: one or more with the same :func:`same_shape`.
    """

    def __init__(self, families: Iterable[Family]) -> None:
        self.families = list(families)
        first = self.families[0]
        self._shape = tuple(getattr(first, name) for name in _SHARED)
        self._varied = tuple(self._stacked(name) for name in _VARIED)
        self._keep_out = self._stacked("keep_out_points_m")
        self._landmarks = np.stack([landmarks(family) for family in self.families])

    def _stacked(self, name: str) -> FloatArray:
        together = np.stack([getattr(family, name) for family in self.families])
        together.flags.writeable = False  # as a family's own, so that kernels have one type of it
        return together

    def solve_and_prove(self, field: AxisField, options: SolveOptions, known: BatchOutcome) -> None:
        """Find every family's best pose under an axis field, and prove it if that is asked for.

        Args:
            field: the axes.
            options: what is asked for, and what each family may cost.
            known: what is known before; what is found is put there.
        """
        from nullpose.solve.kernels.many import solve_and_prove_many

        ready(self.families[0], field)
        solve_and_prove_many(
            self._shape,
            self._varied,
            self.families[0].domain,
            self._keep_out,
            field.arrays,
            self._landmarks,
            shift_of(options.seed),
            search_settings(options.certify),
            np.array(CLIMBS),
            INSIDE * options.target if options.certify else -1.0,
            self._budget(options) if options.certify else (1, 1, 1),
            known.position_m,
            known.axis,
            known.multipliers,
            known.log_value,
            known.bound,
            known.boxes,
            known.code,
        )
        if options.certify:
            for one in np.flatnonzero(known.code == _OPEN):
                self._go_on(int(one), field, options, known)

    def _budget(self, options: SolveOptions) -> tuple[int, int, int]:
        """Return the nodes of the two tries, and of all."""
        return late_nodes(self.families[0]), DIRECT_NODES, options.node_limit

    def _go_on(self, one: int, field: AxisField, options: SolveOptions, known: BatchOutcome) -> None:
        """Give a proof that is longer than most its stages and its clock."""
        found = Incumbent(
            position_m=known.position_m[one].copy(),
            axis=known.axis[one].copy(),
            log_value=float(known.log_value[one]),
            multipliers=known.multipliers[one].copy(),
            starts=0,
            evaluations=0,
        )
        used = BudgetUsed(nodes=int(known.boxes[one]), direct=True)
        proof = prove(self.families[one], field, found, options, used=used)
        known.position_m[one], known.axis[one] = proof.incumbent.position_m, proof.incumbent.axis
        known.multipliers[one], known.log_value[one] = proof.incumbent.multipliers, proof.incumbent.log_value
        known.bound[one] = min(known.bound[one], proof.upper_bound)
        known.boxes[one] += proof.nodes
        known.reason[one] = proof.reason
        if not proof.reason:
            known.code[one] = _PROVED
