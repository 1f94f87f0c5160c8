"""What no combining of an array exceeds, from a proof about one dipole."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from nullpose.family import AxisField
from nullpose.solve.array_task import ArrayTask
from nullpose.solve.effort import Effort
from nullpose.solve.limits import Limits, default_gap
from nullpose.solve.settle import settle

__all__ = ["ArrayBound", "array_bound"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ArrayBound:
    """A bound on the smallest ratio of an array.

    Args:
        value: no position, yaw and weights exceed this.
        position_m: (3,) where the dipole of the proof hears best.
        nodes: boxes examined.
    """

    value: float
    position_m: NDArray[np.float64]
    nodes: int


def array_bound(task: ArrayTask, *, seed: int, time_limit_s: float) -> ArrayBound:
    """Return K times the certified bound of one vertical dipole with the jammers silent.

    With ``R >= sigma^2 I``, ``h_k^H R^-1 h_k <= |h_k|^2 / sigma^2``, and ``|h_k|^2`` is K times what one
    vertical dipole receives at the same position. A shared beam is one choice of every node's weights, and so
    never better. One element alone combines nothing, so for it the jammers are left in, and the bound is
    that of the vertical case itself.

    Args:
        task: the array and its scene.
        seed: seed of the search before the proof.
        time_limit_s: seconds after which the proof stops with the bound reached.

    Raises:
        SolveError: no position reaches every node.
    """
    family = task.family
    nodes = task.scene[2]
    if len(task.base) > 1:
        family = replace(
            family,
            denominator_start=np.zeros(len(family.denominator_isotropic) + 1, dtype=np.int64),
            denominator_point=np.zeros(0, dtype=np.int64),
            denominator_weight=np.zeros(0),
        )
    limits = Limits(gap=default_gap(nodes), time_limit_s=time_limit_s)
    settled = settle(family, [AxisField.vertical()], Effort(seed=seed, limits=limits))
    assert settled.upper_bound is not None, "a proof was asked for"
    return ArrayBound(
        value=len(task.base) * settled.upper_bound,
        position_m=settled.found.position_m,
        nodes=settled.nodes,
    )
