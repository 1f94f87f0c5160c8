"""Many scenes in one call, and arrays of results."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import SolveError, UsageError, checked, require_usage
from nullpose.notebook import html_table, imported
from nullpose.objectives import FloatArray, IntArray, Quantity
from nullpose.physics import Pose, evaluate, to_db
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.scenario import Airframe, Scenario
from nullpose.solver.branch_and_bound import INTERRUPT
from nullpose.solver.objective import objective_of, status_of
from nullpose.solver.options import SolveKeywords, SolveOptions
from nullpose.solver.rigour import Rigour
from nullpose.solver.solve_and_prove import Outcome, solve_and_prove

if TYPE_CHECKING:
    import pandas as pd

NOWHERE = "no position was found at which every node is received"
"""The reason of a scene without a pose."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class ManySolutions:
    """The answers to many scenes: arrays by scene and airframe, (s, a); printed, a line and a table in dB.

    Args:
        value: the smallest margin over the nodes, which is the smallest SINR (paper eq. 2.2) where no node
            states a weight or a requirement, evaluated at the pose: a power ratio. Not a number where there
            is no pose.
        upper_bound: no pose exceeds this; infinity where nothing is proved.
        status: how each ended, a :class:`nullpose.solver.Status`; None where there is no pose.
        reason: what kept it from being certified; empty where it was.
        position_m: (s, a, 3) metres.
        roll_rad: radians, as yaw and pitch.
        pitch_rad: likewise.
        yaw_rad: likewise.
        binding_node: index of the node with the smallest value.
        boxes: boxes of positions that the proof examined; 0 where a vehicle with more freedom had shown it.
    """

    value: FloatArray
    upper_bound: FloatArray
    status: NDArray[np.object_]
    reason: NDArray[np.object_]
    position_m: FloatArray
    roll_rad: FloatArray
    pitch_rad: FloatArray
    yaw_rad: FloatArray
    binding_node: IntArray
    boxes: IntArray

    @property
    def rigour(self) -> Rigour:
        """How sure the bounds are: no certificates are kept of many scenes."""
        return Rigour.FLOATING_POINT if np.any(np.isfinite(self.upper_bound)) else Rigour.NONE

    @property
    def relative_gap(self) -> FloatArray:
        """``(upper_bound - value) / value``, (s, a)."""
        return np.asarray((self.upper_bound - self.value) / self.value)

    def __repr__(self) -> str:
        scenes, vehicles = self.value.shape
        counts = Counter(getattr(each, "value", "without a pose") for each in self.status.flat)
        words = ", ".join(f"{count} {name}" for name, count in counts.items())
        return f"ManySolutions(scenes: {scenes}, vehicles: {vehicles}; {words})"

    def _repr_html_(self) -> str | None:
        return html_table(self._rows())

    def frame(self) -> pd.DataFrame:
        """Tabulate the answers in dB, metres and degrees as a data frame of pandas, a row for each pose.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame(self._rows())

    def _rows(self) -> list[dict[str, object]]:
        """List a row for each scene and vehicle; a missing number is not a number."""
        columns = {
            **dict(zip(("scene", "vehicle"), np.indices(self.value.shape), strict=True)),
            "value_db": to_db(self.value),
            "upper_bound_db": to_db(np.where(np.isfinite(self.upper_bound), self.upper_bound, math.nan)),
            "status": self.status,
            **dict(zip(("x_m", "y_m", "z_m"), np.moveaxis(self.position_m, -1, 0), strict=True)),
            "roll_deg": np.degrees(self.roll_rad),
            "pitch_deg": np.degrees(self.pitch_rad),
            "yaw_deg": np.degrees(self.yaw_rad),
            "binding_node": self.binding_node,
            "boxes": self.boxes,
            "reason": self.reason,
        }
        return [
            dict(zip(columns, row, strict=True))
            for row in zip(*(values.ravel().tolist() for values in columns.values()), strict=True)
        ]

    @classmethod
    def blank(cls, scenes: int, airframes: int) -> ManySolutions:
        """Make one to be filled.

        Args:
            scenes: how many.
            airframes: for each.
        """
        shape = (scenes, airframes)
        return cls(
            value=np.full(shape, math.nan),
            upper_bound=np.full(shape, math.inf),
            status=np.full(shape, None, dtype=object),
            reason=np.full(shape, "", dtype=object),
            position_m=np.full((*shape, 3), math.nan),
            roll_rad=np.full(shape, math.nan),
            pitch_rad=np.full(shape, math.nan),
            yaw_rad=np.full(shape, math.nan),
            binding_node=np.full(shape, -1),
            boxes=np.zeros(shape, dtype=np.int64),
        )


@checked
def solve_many(
    scenarios: Sequence[Scenario],
    *,
    airframes: Sequence[Airframe | None] | None = None,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> ManySolutions:
    """Find the best poses of many scenes, each for one airframe or for several, with their bounds.

    What :func:`solve` does for one scene with the scheme optimum, without what it tells of each. Airframes
    are solved from the one with most freedom down: what bounds a vehicle bounds any that reaches fewer axes,
    and its pose is theirs if they reach it, so that most of them need no proof of their own. Values are
    evaluated by :mod:`nullpose.physics`.

    Args:
        scenarios: what to solve; the smallest SINR, SNR or margin, not a secrecy rate, and one dipole each.
        airframes: the vehicles to try in every scene, None for an omnidirectional one; each scenario's own
            without them.
        on_progress: called now and then with the number of scenes done and of all.
        options: as for :func:`solve`.

    Raises:
        UsageError: a scenario of another kind, no scenario, a bad seed or limit.
        KeyboardInterrupt: Ctrl-C; nothing is returned.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> strong = nullpose.apply_overrides(scenario, ["jammers.M.power_w=100"])
        >>> vehicles = [None, nullpose.Airframe(preset="level")]
        >>> many = nullpose.solve_many([scenario, strong], airframes=vehicles)
        >>> many.value.round(3)  # a row for each scene, a column for each vehicle
        array([[1.254, 0.608],
               [1.206, 0.608]])
    """
    limits = SolveOptions(**options)
    _check(scenarios)
    require_usage(airframes is None or len(airframes), "airframes: given none; allowed: one or more")
    results = ManySolutions.blank(len(scenarios), 1 if airframes is None else len(airframes))
    flown = [scenarios[0].model_copy(update={"airframe": each}) for each in airframes or ()]
    for row, scenario in enumerate(scenarios):
        vehicles, of_scene = flown or [scenario], limits.of(scenario)  # of which the airframe counts
        for column, (vehicle, outcome) in enumerate(
            zip(vehicles, _by_vehicle(scenario, [each.airframe for each in vehicles], of_scene), strict=True)
        ):
            if outcome is None:
                results.reason[row, column] = NOWHERE
            else:
                pose = Pose.of_airframe(vehicle, outcome.incumbent.position_m, outcome.incumbent.axis)
                _fill(results, (row, column), scenario, pose, outcome, of_scene.target)
        if on_progress is not None:
            on_progress(row + 1, len(scenarios))
    return results


def _check(scenarios: Sequence[Scenario]) -> None:
    require_usage(len(scenarios), "scenarios: given none; allowed: one or more")
    for index, scenario in enumerate(scenarios):
        quantity = Quantity.of(scenario)
        if quantity.is_rate or quantity.whole or scenario.array is not None:
            kind = "an array" if scenario.array is not None else f"the {quantity.smallest}"
            raise UsageError(
                f"scenarios[{index}]: asks for {kind}; allowed: the smallest SINR or margin of one dipole; "
                "use solve"
            )


def _by_vehicle(
    scenario: Scenario, vehicles: Sequence[Airframe | None], options: SolveOptions
) -> list[Outcome | None]:
    """Solve for each vehicle, that with most freedom first; None where no pose was found."""
    family = build_family(scenario, any_channel=True)
    bands = [(0.0, 1.0) if vehicle is None else vehicle.axis_band for vehicle in vehicles]
    solved: dict[tuple[float, float], Outcome | None] = {}
    for band in sorted(dict.fromkeys(bands), key=lambda band: band[0] - band[1]):
        wider = [each for (low, high), each in solved.items() if each and low <= band[0] and band[1] <= high]
        solved[band] = _solve_band(family, band, wider, options)
    return [solved[band] for band in bands]


def _solve_band(
    family: Family, band: tuple[float, float], wider: list[Outcome], options: SolveOptions
) -> Outcome | None:
    """Solve for a band of axes, using the bounds and poses of wider bands."""
    bound = min((each.upper_bound for each in wider if each.upper_bound is not None), default=math.inf)
    shared = [each.incumbent for each in wider if band[0] <= _upright(each.incumbent.axis) <= band[1]]
    start = max(shared, key=lambda incumbent: incumbent.log_value, default=None)
    try:
        outcome = solve_and_prove(family, [AxisField.within(*band)], options, incumbent=start, bound=bound)
    except SolveError:
        return None
    if outcome.reason == INTERRUPT:
        raise KeyboardInterrupt
    return replace(outcome, proofs=(), cells=outcome.nodes)  # the next takes the memory of the leaves


def _upright(axis: FloatArray) -> float:
    """Evaluate ``u_z^2`` of an axis of any length."""
    return float(axis[2] ** 2 / (axis @ axis))


def _fill(
    results: ManySolutions,
    at: tuple[int, int],
    scenario: Scenario,
    pose: Pose,
    outcome: Outcome,
    target: float,
) -> None:
    """Put one answer into the results, its value evaluated at the pose."""
    of_nodes = [Quantity.of(scenario).at(link) for link in evaluate(scenario, pose)]
    objective = objective_of(scenario, min(of_nodes), outcome.upper_bound)
    results.status[at], results.reason[at] = status_of(objective, target, outcome.reason)
    results.value[at], results.binding_node[at] = objective.value, int(np.argmin(of_nodes))
    if objective.upper_bound is not None:
        results.upper_bound[at] = objective.upper_bound
    results.position_m[at], results.boxes[at] = pose.position_m, outcome.nodes
    for name in ("roll_rad", "pitch_rad", "yaw_rad"):
        getattr(results, name)[at] = getattr(pose, name)
