"""What each kind of vehicle makes of a scenario: the question whether it has to be an omnidirectional one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from types import MappingProxyType
from typing import Any, Unpack

from nullpose.errors import SolveError
from nullpose.notebook import html_table, imported
from nullpose.objectives import Quantity
from nullpose.scenario import Scenario
from nullpose.solver import (
    TIME_LIMIT_S,
    Result,
    SolveKeywords,
    SolveOptions,
    solve,
)
from nullpose.solver.provenance import provenance
from nullpose.solver.robust import guarantee
from nullpose.study.airframe_cases import OMNIDIRECTIONAL, STATED, AirframeCase, cases_of
from nullpose.study.grid import solved_grid

TOLERANCE = 0.01  # a vehicle suffices if it gives no less than the omnidirectional one but for this share
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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AirframeResult:
    """What one vehicle gives. What its result has is read on it too, and is None if no pose was found.

    Args:
        case: the vehicle.
        result: of its solve; None if no pose was found.
        guaranteed: what is left of the value under errors; None if the scenario states none.
        reason: what kept the value from being certified, or a pose from being found.
    """

    case: AirframeCase
    result: Result | None
    guaranteed: Guaranteed | None = None
    reason: str = ""

    def __getattr__(self, name: str) -> Any:
        """Return what the result has of that name."""
        if name.startswith("_"):
            raise AttributeError(name)
        return None if self.result is None else getattr(self.result, name)

    @property
    def value(self) -> float:
        """The value: a power ratio, or bits/s/Hz; 0 if no pose was found."""
        return 0.0 if self.result is None else self.result.objective.value

    def to_dict(self) -> dict[str, Any]:
        """Return the result as plain data, angles in radians."""
        found, array = self.result, self.case.array
        return {
            "name": self.case.name,
            "label": self.case.label,
            "airframe": self.case.airframe.to_dict(),
            "array": None if array is None else array.to_dict() | {"combining": "digital"},
            "status": None if found is None else found.status.value,
            "reason": self.reason,
            "rigour": None if found is None else found.rigour.value,
            "objective": None if found is None else found.objective.to_dict(),
            "pose": None if found is None else found.pose.to_dict(),
            "guaranteed": None if self.guaranteed is None else asdict(self.guaranteed),
        }


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
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

    def of(self, name: str) -> AirframeResult:
        """Return what one vehicle gives.

        Args:
            name: the vehicle's name, as in ``tilt-10``.

        Raises:
            KeyError: there is no such vehicle.
        """
        named = {result.case.name: result for result in self.results}
        if name not in named:
            raise KeyError(f"no vehicle {name!r}; there are {', '.join(named)}")
        return named[name]

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

    def difference(self, result: AirframeResult) -> float:
        """Return what a vehicle gives more than the omnidirectional one, in dB or bits/s/Hz; below 0 if less.

        Args:
            result: one of the results.
        """
        quantity = Quantity.of(self.scenario)
        return quantity.in_unit(result.value) - quantity.in_unit(self.omnidirectional.value)

    def suffices(self, result: AirframeResult, tolerance: float = TOLERANCE) -> bool:
        """Return whether a vehicle gives as much as the omnidirectional one, but for a tolerance.

        Measured against the upper bound of the omnidirectional one where there is one, so that a yes is
        proved.

        Args:
            result: one of the results.
            tolerance: relative.
        """
        best = self.omnidirectional
        bound = None if best.result is None else best.result.objective.upper_bound
        whole = best.value if bound is None else bound
        return best.value > 0.0 and (result is best or result.value >= (1.0 - tolerance) * whole)

    @property
    def least_sufficient(self) -> AirframeResult | None:
        """The vehicle with one dipole that suffices with the least tilt; None if none gives anything."""
        return next((one for one in self.dipoles if self.suffices(one)), None)

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

    def __repr__(self) -> str:
        least = self.least_sufficient
        enough = "none suffices" if least is None else f"{least.case.name} suffices"
        return f"AirframeComparison({self.scenario.name!r}: {len(self.results)} vehicles, {enough})"

    def _repr_html_(self) -> str | None:
        return html_table(self._records())

    def frame(self) -> Any:
        """Return the comparison as a data frame of pandas, a row for each vehicle.

        Raises:
            UsageError: pandas is not installed.
        """
        return imported("pandas").DataFrame(self._records())

    def _records(self) -> list[dict[str, object]]:
        """Return a row for each vehicle; of one without a pose, its name and the reason alone."""
        whole = self.omnidirectional.result
        none: dict[str, object] = dict.fromkeys(whole.row()) if whole is not None else {}
        return [
            {
                "vehicle": one.case.label,
                **(none if one.result is None else one.result.row()),
                "reason": one.reason,
            }
            for one in self.results
        ]

    def to_dict(self) -> dict[str, Any]:
        """Return the comparison as plain data, the scenario once for all vehicles."""
        least = self.least_sufficient
        return {
            "scenario": self.scenario.to_dict(),
            "cases": [
                result.to_dict()
                | {
                    "share_of_omnidirectional": self.share(result),
                    "difference_from_omnidirectional": self.difference(result),
                }
                for result in self.results
            ],
            "tolerance": TOLERANCE,
            "least_sufficient": None if least is None else least.case.name,
            "provenance": dict(self.provenance),
        }


def compare_airframes(
    scenario: Scenario,
    *,
    cases: Sequence[AirframeCase] | None = None,
    on_progress: Callable[[int, int], None] | None = None,
    **options: Unpack[SolveKeywords],
) -> AirframeComparison:
    """Return what each kind of vehicle makes of a scenario: level, tilting, omnidirectional, with an array.

    The scenario's own airframe is tried as well if it states one that is none of the others. Where it states
    errors, what each dipole guarantees is worked out at the pose that is best without them, and at the pose
    that guarantees most. After an interrupt during a proof the remaining vehicles are solved without one.

    Args:
        scenario: what to solve.
        cases: the vehicles, by the tilt that they take, the omnidirectional one among them; without it
            those of :func:`cases_of`.
        on_progress: called after each vehicle with how many are done and how many there are.
        options: as for :func:`nullpose.solve`.

    Raises:
        UsageError: a bad seed or limit.
        SolveError: no pose of the omnidirectional vehicle reaches every node.

    Example:
        >>> import nullpose
        >>> scenario = nullpose.load("examples/paper.toml")
        >>> found = nullpose.compare_airframes(scenario, certify=False)
        >>> found.least_sufficient.case.name
        'tilt-10'
    """
    asked = SolveOptions(**options).of(scenario)
    options["gap"] = asked.target
    interrupted: list[bool] = []

    def solved(own: Scenario, case: AirframeCase) -> AirframeResult:
        now = options | {"certify": asked.certify and not any(interrupted)}
        try:
            result = solve(case.on(own), **now)
        except SolveError as error:
            if case.name == OMNIDIRECTIONAL:
                raise
            return AirframeResult(case=case, result=None, reason=str(error))
        interrupted.append(result.interrupted)
        known = case.array is None and own.is_uncertain
        return AirframeResult(
            case=case,
            result=result,
            guaranteed=_guaranteed(result, None if any(interrupted) else options) if known else None,
            reason=result.reason,
        )

    vehicles = cases_of(scenario) if cases is None else cases
    return AirframeComparison(
        scenario=scenario,
        results=tuple(solved_grid([scenario], vehicles, solved, on_progress)),
        interrupted=any(interrupted),
        provenance=MappingProxyType(provenance(asked.seed) | asked.settings),
    )


def _guaranteed(result: Result, options: SolveKeywords | None) -> Guaranteed:
    """Return what the pose that was found guarantees, and the robust pose unless the work was interrupted."""
    scenario, pose = result.scenario, result.pose
    nominal = Quantity.of(scenario).of_ratio(guarantee(scenario, pose.position_m, pose.antenna_axis).lower)
    if options is None:
        return Guaranteed(nominal_pose=nominal, robust_pose=None, upper_bound=None)
    limit_s = min(_ROBUST_S, options.get("time_limit_s", TIME_LIMIT_S))
    robust = solve(scenario, robust=True, **options | {"gap": None, "time_limit_s": limit_s})
    return Guaranteed(
        nominal_pose=nominal,
        robust_pose=max(nominal, robust.objective.value),
        upper_bound=robust.objective.upper_bound,
    )
