"""What a pose guarantees: its smallest ratio over all errors together, proved."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from nullpose.errors import UsageError
from nullpose.objectives import FloatArray
from nullpose.physics.error_case import ErrorCase
from nullpose.physics.gain import worst_polarised
from nullpose.physics.pose import as_position
from nullpose.scenario import Scenario
from nullpose.solver.robust.inner import Inner, RatioGuarantee

ACCURACY = 3e-3
"""Relative distance between a guarantee and the worst case found, unless another is asked for."""

_FINEST = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Guarantee:
    """What a pose guarantees: the smallest ratio over the nodes and over all errors together.

    A ratio is a node's margin (its SINR where it states no weight and no requirement), or for
    a secrecy rate ``(1 + SNR_k) / (1 + SNR_e)``, two to the power of the secrecy rate.

    Args:
        position_m: (3,) the commanded position.
        axis: (3,) the commanded unit antenna axis.
        ratios: one for every node, or for every node and eavesdropper.
        cells: cells of errors examined.
    """

    position_m: FloatArray
    axis: FloatArray
    ratios: tuple[RatioGuarantee, ...]
    cells: int

    @property
    def nominal(self) -> float:
        """The smallest ratio without errors."""
        return min(ratio.nominal for ratio in self.ratios)

    @property
    def lower(self) -> float:
        """A proved lower bound on the smallest ratio over all errors."""
        return min(ratio.lower for ratio in self.ratios)

    @property
    def worst(self) -> float:
        """The smallest ratio in the worst cases found: an upper bound on the same number."""
        return self.binding.worst

    @property
    def binding(self) -> RatioGuarantee:
        """The ratio that is smallest in its worst case."""
        return min(self.ratios, key=lambda ratio: ratio.worst)

    @property
    def case(self) -> ErrorCase:
        """The worst error case found."""
        return self.binding.case


def guarantee(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, *, accuracy: float = ACCURACY
) -> Guarantee:
    """Prove what a pose guarantees over all errors that the scenario allows.

    The errors are all of these together: an actual axis within ``attitude_error_deg`` of the commanded one,
    an actual position within ``position_error_m`` of the commanded one, every jammer or eavesdropper anywhere
    in its set. Branch and bound over axis and position, with closed forms for the rest; see docs/robust.md.

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver; its airspace is not consulted.
        position_m: (3,) the commanded position, metres.
        axis: (3,) the commanded antenna axis, of any length but zero.
        accuracy: relative distance of each bound from the worst case found, 1e-6 to 0.5. A bound that would
            take too long is given lower.

    Raises:
        UsageError: a pose or an accuracy that is none, or an array in place of the dipole.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> best = nullpose.solve(scenario).pose
        >>> uncertain = nullpose.apply_overrides(scenario, ["receiver.attitude_error_deg=2"])
        >>> proved = nullpose.guarantee(uncertain, best.position_m, best.antenna_axis)
        >>> round(proved.nominal, 3), proved.lower < proved.nominal
        (1.254, True)
    """
    return guarantee_of(Inner(worst_polarised(require_dipole(scenario))), position_m, axis, accuracy)


def guarantee_of(inner: Inner, position_m: ArrayLike, axis: ArrayLike, accuracy: float) -> Guarantee:
    """Prove what a pose guarantees in a scenario that was prepared before.

    Args:
        inner: the scenario, prepared.
        position_m: (3,) the commanded position, metres.
        axis: (3,) the commanded antenna axis, of any length but zero.
        accuracy: relative distance of each bound from the worst case found.

    Raises:
        UsageError: a pose or an accuracy that is none.
    """
    p, u = as_position(position_m), np.array(axis, dtype=float)
    if u.shape != (3,) or not np.all(np.isfinite(u)) or not np.any(u):
        raise UsageError(f"axis: given {axis!r}; allowed: three finite numbers, not all zero")
    if not _FINEST <= accuracy <= 0.5:
        raise UsageError(f"accuracy: given {accuracy!r}; allowed: {_FINEST:g} to 0.5, relative")
    u /= np.linalg.norm(u)
    found = inner.worst(p, u, accuracy)
    for array in (p, u):
        array.flags.writeable = False
    return Guarantee(
        position_m=p,
        axis=u,
        ratios=found,
        cells=sum(ratio.cells for ratio in found),
    )


def require_dipole(scenario: Scenario) -> Scenario:
    """Refuse a scenario with an array; return any other.

    Args:
        scenario: any.

    Raises:
        UsageError: it has an array.
    """
    if scenario.array is not None:
        raise UsageError("array: guarantees are for one dipole; remove [array], or solve without robust")
    return scenario
