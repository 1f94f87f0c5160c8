"""What each kind of vehicle makes of a scenario: the question whether it has to be an omnidirectional one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from nullpose.errors import SolveError
from nullpose.objectives import Quantity
from nullpose.physics import Pose
from nullpose.scenario import Scenario
from nullpose.solve import (
    NODE_LIMIT,
    TIME_LIMIT_S,
    ArraySolution,
    Objective,
    Solution,
    Status,
    default_gap_of,
    solve,
    solve_array,
)
from nullpose.solve.options import SolveOptions
from nullpose.solve.provenance import provenance
from nullpose.solve.robust import guarantee, solve_robust
from nullpose.study.airframe_cases import OMNIDIRECTIONAL, STATED, AirframeCase, cases_of

__all__ = ["TOLERANCE", "AirframeComparison", "AirframeResult", "Guaranteed", "compare_airframes"]

TOLERANCE = 0.01
"""A vehicle suffices if it gives no less than the omnidirectional one but for this share."""

_ROBUST_S = 10.0  # for each vehicle's robust pose, at most


@dataclass(frozen=True, slots=True, kw_only=True)
class Guaranteed:
    """What a vehicle gives whatever the scenario's errors do: power ratios, or bits/s/Hz.

    Args:
        nominal_pose: what the pose guarantees that is best without errors; proved.
        robust_pose: what the pose guarantees that guarantees most; proved. None after an interrupt.
        upper_bound: no pose of the vehicle guarantees more; None if nothing is proved.
    """

    nominal_pose: float
    robust_pose: float | None
    upper_bound: float | None

    def to_dict(self) -> dict[str, float | None]:
        """Return the numbers as plain data."""
        return {
            "nominal_pose": self.nominal_pose,
            "robust_pose": self.robust_pose,
            "upper_bound": self.upper_bound,
        }


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AirframeResult:
    """What one vehicle gives.

    Args:
        case: the vehicle.
        status: how sure the value is; None if no pose was found.
        objective: the value and what is proved about it; None if no pose was found.
        pose: where that is reached; None if no pose was found.
        guaranteed: what is left of it under errors; None if the scenario states none.
        reason: what kept the value from being certified, or a pose from being found.
    """

    case: AirframeCase
    status: Status | None
    objective: Objective | None
    pose: Pose | None
    guaranteed: Guaranteed | None = None
    reason: str = ""

    @property
    def value(self) -> float:
        """The value: a power ratio, or bits/s/Hz; 0 if no pose was found."""
        return 0.0 if self.objective is None else self.objective.value

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain data, angles in radians."""
        objective, pose = self.objective, self.pose
        return {
            "name": self.case.name,
            "label": self.case.label,
            "airframe": self.case.airframe.to_dict(),
            "array": self._array_dict(),
            "status": None if self.status is None else self.status.value,
            "reason": self.reason,
            "rigour": None if objective is None else objective.rigour.value,
            "objective": None if objective is None else objective.to_dict(),
            "pose": None
            if pose is None
            else {
                "position_m": [float(x) for x in pose.position_m],
                "roll_rad": pose.roll_rad,
                "pitch_rad": pose.pitch_rad,
                "yaw_rad": pose.yaw_rad,
                "tilt_rad": pose.tilt_rad,
            },
            "guaranteed": None if self.guaranteed is None else self.guaranteed.to_dict(),
        }

    def _array_dict(self) -> dict[str, Any] | None:
        array = self.case.array
        return None if array is None else array.to_dict() | {"combining": self.case.combining}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AirframeComparison:
    """What each vehicle makes of a scenario.

    Args:
        scenario: what was solved.
        results: one for each vehicle, by the tilt that it takes.
        interrupted: whether Ctrl-C ended a proof.
        provenance: versions, seed and settings.
    """

    scenario: Scenario
    results: tuple[AirframeResult, ...]
    interrupted: bool
    provenance: Mapping[str, Any]

    def __post_init__(self) -> None:
        object.__setattr__(self, "provenance", MappingProxyType(dict(self.provenance)))

    def of(self, name: str) -> AirframeResult:
        """Return what one vehicle gives.

        Args:
            name: the vehicle's name, as in ``tilt-10``.

        Raises:
            KeyError: there is no such vehicle.
        """
        for result in self.results:
            if result.case.name == name:
                return result
        raise KeyError(f"no vehicle {name!r}; there are {', '.join(one.case.name for one in self.results)}")

    @property
    def omnidirectional(self) -> AirframeResult:
        """What the omnidirectional vehicle gives."""
        return self.of(OMNIDIRECTIONAL)

    def share(self, result: AirframeResult) -> float | None:
        """Return what a vehicle gives over what the omnidirectional one does; None if that gives nothing.

        Of power ratios, not of decibels; or of rates.

        Args:
            result: one of the results.
        """
        whole = self.omnidirectional.value
        return result.value / whole if whole > 0.0 else None

    def suffices(self, result: AirframeResult, tolerance: float = TOLERANCE) -> bool:
        """Return whether a vehicle gives as much as the omnidirectional one, but for a tolerance.

        Measured against the upper bound of the omnidirectional one where there is one, so that a yes is
        proved.

        Args:
            result: one of the results.
            tolerance: relative.
        """
        objective = self.omnidirectional.objective
        if objective is None or not objective.value > 0.0:
            return False
        whole = objective.value if objective.upper_bound is None else objective.upper_bound
        return result is self.omnidirectional or result.value >= (1.0 - tolerance) * whole

    @property
    def least_sufficient(self) -> AirframeResult | None:
        """The vehicle with one dipole that suffices with the least tilt; None if none gives anything."""
        return next((one for one in self.dipoles if self.suffices(one)), None)

    @property
    def tolerance(self) -> float:
        """What a vehicle may fall short of the omnidirectional one by and still suffice, relative."""
        return TOLERANCE

    @property
    def stated(self) -> AirframeResult | None:
        """What the scenario's own vehicle gives; None if it states none, or one of the usual."""
        return next((result for result in self.results if result.case.name == STATED), None)

    @property
    def dipoles(self) -> tuple[AirframeResult, ...]:
        """The results of the vehicles with one dipole, by the tilt that they take."""
        return tuple(result for result in self.results if result.case.array is None)

    @property
    def arrays(self) -> tuple[AirframeResult, ...]:
        """The results of the level vehicles with an array."""
        return tuple(result for result in self.results if result.case.array is not None)

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as plain data, the scenario once for all vehicles."""
        least = self.least_sufficient
        return {
            "scenario": self.scenario.to_dict(),
            "cases": [
                result.to_dict() | {"share_of_omnidirectional": self.share(result)} for result in self.results
            ],
            "tolerance": self.tolerance,
            "least_sufficient": None if least is None else least.case.name,
            "provenance": dict(self.provenance),
        }


def compare_airframes(
    scenario: Scenario,
    *,
    cases: Sequence[AirframeCase] | None = None,
    gap: float | None = None,
    time_limit_s: float = TIME_LIMIT_S,
    node_limit: int = NODE_LIMIT,
    certify: bool = True,
    seed: int = 0,
    on_progress: Callable[[int, int], None] | None = None,
) -> AirframeComparison:
    """Return what each kind of vehicle makes of a scenario: level, tilting, omnidirectional, with an array.

    The scenario's own airframe is tried as well if it states one that is none of the others. Where it states
    errors, what each dipole guarantees is worked out at the pose that is best without them, and at the pose
    that guarantees most. After an interrupt during a proof the remaining vehicles are solved without one.

    Args:
        scenario: what to solve.
        cases: the vehicles, by the tilt that they take, the omnidirectional one among them; without it
            those of :func:`cases_of`.
        gap: relative gap at which each proof is done; without it, by the number of nodes.
        time_limit_s: seconds after which each proof stops.
        node_limit: boxes after which each proof stops.
        certify: whether to prove anything.
        seed: the random seed of every solve.
        on_progress: called after each vehicle with how many are done and how many there are.

    Raises:
        UsageError: a bad seed or limit.
        SolveError: no pose of the omnidirectional vehicle reaches every node.
    """
    vehicles = cases_of(scenario) if cases is None else tuple(cases)
    limits = SolveOptions(
        gap=default_gap_of(scenario) if gap is None else gap, time_limit_s=time_limit_s, node_limit=node_limit
    )
    results: list[AirframeResult] = []
    interrupted = False
    for done, case in enumerate(vehicles, start=1):
        proved = limits if certify and not interrupted else None
        try:
            if case.array is None:
                solution = _solved(case, scenario, proved, seed)
                interrupted = interrupted or solution.interrupted
                results.append(_dipole_result(case, solution, None if interrupted else limits, certify))
            else:
                found = solve_array(
                    case.on(scenario),
                    case.combining,
                    gap=limits.target,
                    certify=proved is not None,
                    seed=seed,
                )
                results.append(_array_result(case, found))
        except SolveError as error:
            if case.name == OMNIDIRECTIONAL:
                raise
            results.append(_nothing(case, error))
        if on_progress is not None:
            on_progress(done, len(vehicles))
    return AirframeComparison(
        scenario=scenario,
        results=tuple(results),
        interrupted=interrupted,
        provenance=provenance(seed) | ({"gap": limits.target} if certify else {}),
    )


def _solved(case: AirframeCase, scenario: Scenario, limits: SolveOptions | None, seed: int) -> Solution:
    if limits is None:
        return solve(case.on(scenario), certify=False, seed=seed)
    return solve(
        case.on(scenario),
        gap=limits.target,
        time_limit_s=limits.time_limit_s,
        node_limit=limits.node_limit,
        seed=seed,
    )


def _nothing(case: AirframeCase, error: SolveError) -> AirframeResult:
    return AirframeResult(case=case, status=None, objective=None, pose=None, reason=str(error))


def _array_result(case: AirframeCase, solution: ArraySolution) -> AirframeResult:
    return AirframeResult(
        case=case,
        status=solution.status,
        objective=solution.objective,
        pose=solution.pose,
        reason=solution.reason,
    )


def _dipole_result(
    case: AirframeCase, solution: Solution, limits: SolveOptions | None, certify: bool
) -> AirframeResult:
    return AirframeResult(
        case=case,
        status=solution.status,
        objective=solution.objective,
        pose=solution.pose,
        guaranteed=_guaranteed(solution, limits, certify) if solution.scenario.is_uncertain else None,
        reason=solution.reason,
    )


def _guaranteed(solution: Solution, limits: SolveOptions | None, certify: bool) -> Guaranteed:
    """Return what the pose that was found guarantees, and the robust pose unless the work was interrupted."""
    scenario, pose = solution.scenario, solution.pose
    nominal = Quantity.of(scenario).of_ratio(guarantee(scenario, pose.position_m, pose.antenna_axis).lower)
    if limits is None:
        return Guaranteed(nominal_pose=nominal, robust_pose=None, upper_bound=None)
    robust = solve_robust(
        scenario,
        time_limit_s=min(_ROBUST_S, limits.time_limit_s),
        node_limit=limits.node_limit,
        certify=certify,
        seed=int(solution.provenance["seed"]),
    )
    return Guaranteed(
        nominal_pose=nominal,
        robust_pose=max(nominal, robust.robust.guaranteed),
        upper_bound=robust.upper_bound,
    )
