"""What a pose guarantees: its smallest ratio over all errors together, proved."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from nullpose.channel.model import BY_ELEVATION, CONSTANT
from nullpose.errors import checked, require_usage
from nullpose.objectives import FloatArray, IntArray
from nullpose.physics import ErrorCase, ratios_under, rotation_between
from nullpose.physics.gain import worst_polarised
from nullpose.physics.pose import as_position
from nullpose.problem.build import build_family
from nullpose.problem.robust import point_uncertainty_m
from nullpose.scenario import Scenario
from nullpose.solver.robust.solution import Guarantee, RatioGuarantee

ACCURACY = 3e-3
"""Relative distance between a guarantee and the worst case found, unless another is asked for."""

_FINEST = 1e-6
_EXACT = 1e-9  # accuracy where nothing has to be split
_STAGE_CELLS = 100_000  # cells of a node after which the level is lowered
_STAGE_CELLS_LEAK, _STAGE_CELLS_DIPOLES = 4_000, 1_000  # whose bounds take so much longer


@checked
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
        accuracy: relative distance of each bound from the worst case found, 1e-6 to 0.5. Where that
            would take too long, the bound is farther from it.

    Raises:
        UsageError: the pose or the accuracy is not one, or the antenna is an array or has a pattern.

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
    require_usage(
        u.shape == (3,) and np.all(np.isfinite(u)) and np.any(u),
        f"axis: given {axis!r}; allowed: three finite numbers, not all zero",
    )
    require_usage(
        _FINEST <= accuracy <= 0.5, f"accuracy: given {accuracy!r}; allowed: {_FINEST:g} to 0.5, relative"
    )
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
    """Refuse a scenario with an array, buildings or a profile on the ground; return any other.

    Args:
        scenario: any.

    Raises:
        UsageError: it has one of these.
    """
    require_usage(
        scenario.prisms is None,
        "buildings: a guarantee would end at the edge of a shadow; remove [[buildings]], or solve "
        "without robust",
    )
    require_usage(
        all(point.antenna != "profile" for point in scenario.points),
        'antenna: guarantees are not for antenna = "profile"; write "isotropic" with gain_dbi, the least '
        "that a node has towards the drone, the most of an interferer, or solve without robust",
    )
    require_usage(
        scenario.array is None,
        "array: guarantees are for one dipole; remove [array], or solve without robust",
    )
    return scenario


class Inner:
    """What may go wrong in a scenario, prepared once for many poses.

    Args:
        scenario: nodes, jammers or eavesdroppers, receiver, and how well all of it is known.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self.family = build_family(scenario, any_channel=True)
        self.reach_m = float(scenario.receiver.position_error_m)
        channels = self.family.ratios.channels
        require_usage(
            self.reach_m == 0.0 or not np.any(channels[:, 0] == BY_ELEVATION),
            f"receiver.position_error_m: given {self.reach_m:g} with line of sight by elevation; allowed "
            'there for guarantees: 0, or average = "guaranteed"',
        )
        self.angle_rad = math.radians(scenario.receiver.attitude_error_deg)
        self.none = ErrorCase.none(scenario)
        self.moved = f"{scenario.interferer}_offsets_m"
        axes = self.family.ratios.ground_axes
        self.dipoles = axes if len(axes) else np.zeros_like(self.family.ratios.points_m)
        self.radii = point_uncertainty_m(scenario)
        self.is_closed = (self.family.ratios.leak == 0.0) & ~np.any(self.dipoles, axis=1)  # lemma 2
        if len(channels):
            self.is_closed &= channels[:, 0] == CONSTANT
        self.is_closed |= self.radii == 0.0

    def worst(
        self, position_m: FloatArray, axis: FloatArray, accuracy: float = 1.0
    ) -> tuple[RatioGuarantee, ...]:
        """Find the worst error case of every ratio at a pose.

        Args:
            position_m: (3,) the commanded position.
            axis: (3,) the commanded antenna axis, of unit length.
            accuracy: relative distance of the bound from the worst found; 1 asks for no bound.
        """
        nominal = ratios_under(self.scenario, position_m, axis, self.none)
        return tuple(
            self._worst(ratio, position_m, axis, accuracy, nominal) for ratio in range(self.n_ratios)
        )

    @property
    def n_ratios(self) -> int:
        """How many ratios the nominal family has."""
        return len(self.family.ratios.numerator_point)

    def _worst(
        self, ratio: int, p: FloatArray, u: FloatArray, accuracy: float, nominal: FloatArray
    ) -> RatioGuarantee:
        from nullpose.solver.kernels.bounds.worst_case_bound import worst_case
        from nullpose.solver.kernels.search.set_links import Sets
        from nullpose.solver.kernels.search.worst_case import Errors, Ratio

        ratios = self.family.ratios
        group = ratios.denominator_of[ratio]
        entries = slice(ratios.denominator_start[group], ratios.denominator_start[group + 1])
        points = ratios.denominator_point[entries]
        noise, node = float(ratios.denominator_isotropic[group]), ratios.numerator_point[ratio]
        # a copy, also of none: a kernel is compiled again for what is read-only
        channels = ratios.channels[[*points, node] if len(ratios.channels) else []]
        numbers = Ratio(
            isotropic=float(ratios.numerator_isotropic[ratio]) / noise,
            weight=float(ratios.numerator_weight[ratio]) / noise,
            node=tuple((ratios.points_m[node] - p).tolist()),
            shares=ratios.denominator_weight[entries] / noise,
            centres=ratios.points_m[points] - p,
            sets=Sets(self.radii[points], self.dipoles[points], channels),
            leak=ratios.leak,
            dipole=tuple(self.dipoles[node].tolist()),
        )
        errors = Errors(_frame(u), math.cos(self.angle_rad), math.sin(self.angle_rad), self.reach_m)
        is_closed = np.all(self.is_closed[points])
        if is_closed and self.angle_rad == self.reach_m == 0.0:
            accuracy = min(accuracy, _EXACT)  # closed form
        y, offset, places = np.empty(3), np.empty(3), np.empty((len(points), 3))
        most = _STAGE_CELLS if is_closed else _STAGE_CELLS_LEAK
        is_slow = len(channels) or np.any(numbers.sets.dipoles)
        most = _STAGE_CELLS_DIPOLES if is_slow else most
        lower, worst, cells = worst_case(numbers, errors, accuracy, most, y, offset, places)
        case = self._case(u, y, offset, points, places - (numbers.centres - offset))
        node, eavesdropper = divmod(ratio, nominal.shape[1])
        listeners = self.scenario.eavesdropper_names
        # a null on the node is exact in the case, not in its rounded evaluation
        value = float(ratios_under(self.scenario, p, u, case)[node, eavesdropper]) if worst > 0.0 else 0.0
        return RatioGuarantee(
            node=self.scenario.terminal_names[node],
            eavesdropper=listeners[eavesdropper] if listeners else "",
            nominal=float(nominal[node, eavesdropper]),
            lower=float(lower),
            worst=value,
            case=case,
            ratio=ratio,
            cells=int(cells),
        )

    def _case(
        self, u: FloatArray, y: FloatArray, offset: FloatArray, points: IntArray, moved: FloatArray
    ) -> ErrorCase:
        offsets_m = np.array(getattr(self.none, self.moved))
        offsets_m[points - len(self.scenario.nodes)] = np.where(
            (self.radii[points] == 0.0)[:, None], 0.0, moved
        )
        case = replace(self.none, **{self.moved: offsets_m})
        if self.reach_m > 0.0:  # what cannot err has no rounding error either
            case = replace(case, position_offset_m=offset)
        if self.angle_rad > 0.0:
            case = replace(case, rotation_world=rotation_between(u, y if float(u @ y) >= 0.0 else -y))
        return case


def _frame(u: FloatArray) -> Any:
    """Return the axis and two unit vectors across it."""
    first = np.cross(u, np.eye(3)[np.argmin(np.abs(u))])
    first /= np.linalg.norm(first)
    return tuple(tuple(each.tolist()) for each in (u, first, np.cross(u, first)))
