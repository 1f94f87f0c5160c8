"""Given poses, compared with the bound that no pose exceeds."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, TypeAdapter

from nullpose.errors import checked, require_usage
from nullpose.files import PlainTable
from nullpose.objectives import Quantity
from nullpose.physics import Pose, evaluate, objective_of_links
from nullpose.scenario import Scenario
from nullpose.scenario.airspace import BORDER_M
from nullpose.scenario.section import Section
from nullpose.scenario.units import AttitudeDegrees, Position
from nullpose.solver import Result, Status
from nullpose.solver.objective import objective_of

_TILT_RAD = 1e-9  # rounding of a stated tilt


@dataclass(frozen=True, slots=True, kw_only=True)
class GivenDetails:
    """How a given pose compares with the best one.

    Args:
        best: the result that it is held against.
        below_bound: how far its value is below the bound, in dB or bits/s/Hz; None if no bound holds for it.
        not_allowed: why the vehicle may not take this pose; empty if it may.
    """

    best: Result
    below_bound: float | None
    not_allowed: tuple[str, ...]
    label: str = "Given pose"

    def to_dict(self, objective: object) -> PlainTable:
        """Return it as plain data.

        Args:
            objective: of the pose; it has a key of its own.
        """
        best = {"objective": self.best.objective.to_dict(), "pose": self.best.pose.to_dict()}
        return {"below_bound": self.below_bound, "not_allowed": list(self.not_allowed), "best": best}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Evaluation:
    """Several poses, each held against the same bound.

    Args:
        best: the result that they are held against.
        results: one for each pose, in order.
    """

    best: Result
    results: tuple[Result, ...]

    def __repr__(self) -> str:
        return f"Evaluation({len(self.results)} poses, against {self.best!r})"

    @property
    def interrupted(self) -> bool:
        """Whether Ctrl-C ended the proof of the bound."""
        return self.best.interrupted

    def to_dict(self) -> PlainTable:
        """Return the evaluation as plain data, the scenario once for all poses."""
        once = ("scenario", "provenance", "best")
        poses = [
            {key: value for key, value in pose.to_dict().items() if key not in once} for pose in self.results
        ]
        best = self.best.to_dict()
        return {
            "scenario": best.pop("scenario"),
            "cases": poses,
            "best": best,
            "provenance": best.pop("provenance"),
        }


@checked
def evaluate_against(best: Result, poses: Iterable[Pose]) -> Evaluation:
    """Evaluate poses, each with the bound of a result.

    Args:
        best: of a solve of the optimum pose, whose bound holds for every pose that the vehicle may take.
        poses: any; one that the vehicle may not take has no bound.

    Raises:
        UsageError: a pose is at a ground point, where the model has no value; or the result is of an array.

    Example:
        >>> import nullpose
        >>> best = nullpose.solve(nullpose.load("examples/paper.toml"))
        >>> upright = nullpose.Pose(position_m=[0.0, 25.0, 8.0], roll_rad=0.0, pitch_rad=0.0)
        >>> (result,) = nullpose.evaluate_against(best, [upright]).results
        >>> round(result.objective.value_db, 2), round(result.details.below_bound, 2)  # dB
        (-4.08, 5.07)
    """
    require_one_antenna(best.scenario, "evaluate")
    results = tuple(_against(best, pose) for pose in poses)
    sizes = best.error_sizes if len(results) == 1 else None
    return Evaluation(best=best, results=tuple(replace(result, error_sizes=sizes) for result in results))


def require_one_antenna(scenario: Scenario, verb: str) -> None:
    """Refuse a scenario with an array.

    Raises:
        UsageError: it has one.
    """
    require_usage(
        scenario.array is None,
        f"{verb}: given a scenario with an [array]; allowed: one antenna; remove [array]",
    )


def evaluated(result: Result, scenario: Scenario, pose: Pose, upper_bound: float | None = None) -> Result:
    """Evaluate a pose in a scenario, with a bound if one holds; how it was found is that of a result."""
    links, quantity = tuple(evaluate(scenario, pose)), Quantity.of(scenario)
    ratio_bound = None if upper_bound is None else quantity.to_ratio(upper_bound)
    rigour = None if upper_bound is None else result.rigour
    return replace(
        result,
        scenario=scenario,
        scheme="given",
        status=Status.POSE_GIVEN,
        objective=objective_of(scenario, objective_of_links(scenario, links), ratio_bound, rigour),
        pose=pose,
        links=links,
        reason="",
        note="",
        proofs=(),
    )


def _against(best: Result, pose: Pose) -> Result:
    scenario, quantity = best.scenario, Quantity.of(best.scenario)
    not_allowed = tuple(pose_faults(scenario, pose))
    bound = None if not_allowed else best.objective.upper_bound
    result = evaluated(best, scenario, pose, bound)
    below = None if bound is None else quantity.in_unit(bound) - quantity.in_unit(result.objective.value)
    place = ", ".join(f"{x:z.3f}" for x in best.pose.position_m)
    return replace(
        result,
        note="\n".join(
            [
                *(f"not allowed, so that the bound does not hold: {reason}" for reason in not_allowed),
                *([] if below is None else [f"{below:.3g} {quantity.unit} below the bound"]),
                f"best pose: {quantity.in_unit(best.objective.value):.4f} {quantity.unit} at ({place}) m",
            ]
        ),
        details=GivenDetails(best=best, below_bound=below, not_allowed=not_allowed),
    )


def pose_faults(scenario: Scenario, pose: Pose) -> Iterable[str]:
    """Yield why the vehicle may not take a pose.

    Args:
        scenario: with airspace and airframe.
        pose: any.

    Raises:
        UsageError: the pose is at a ground point.
    """
    distances_m = np.linalg.norm(scenario.point_positions_m - pose.position_m, axis=-1)
    near_m, keep_out_m = float(np.min(distances_m)), scenario.airspace.keep_out_m
    nearest = scenario.points[int(np.argmin(distances_m))].name
    require_usage(
        near_m > 0.0, f"pose: given the position of {nearest}; allowed: {keep_out_m:g} m or more from it"
    )
    for words, clearance_m in scenario.open_airspace.clearances_m(pose.position_m):
        if clearance_m < -BORDER_M:
            yield f"the position is {-clearance_m:.3g} m {words}"
    if near_m < keep_out_m - BORDER_M:
        yield f"{near_m:.3g} m from {nearest}, closer than keep_out_m = {keep_out_m:g} m"
    if scenario.airframe is not None and pose.tilt_rad > scenario.airframe.tilt_max_rad + _TILT_RAD:
        yield "tilted by {:.3f} deg, more than the airframe's {:g} deg".format(
            *np.degrees([pose.tilt_rad, scenario.airframe.tilt_max_rad])
        )


_POSITION: TypeAdapter[tuple[float, float, float]] = TypeAdapter(Position)
_Place = Annotated[
    tuple[float, float, float] | Literal["centroid"],
    BeforeValidator(lambda value: value if value in ("centroid",) else _POSITION.validate_python(value)),
]


class FixedPose(
    Section,
    header="a table such as { position_m = [0, 0, 20], roll_deg = 90 }",
    unstated=("roll_deg", "pitch_deg", "yaw_deg"),
):
    """A pose that is evaluated in every scene, with nothing searched and nothing proved.

    Args:
        position_m: where the drone hovers; "centroid" for the lowest allowed position over
            the centroid of the nodes.
        roll_deg, pitch_deg, yaw_deg: how it is turned.
    """

    position_m: _Place = Field(
        description="Where the drone hovers: [east, north, up], or centroid for the lowest allowed position "
        "over the centroid of the nodes.",
        examples=[[0.0, 25.0, 8.0]],
    )
    roll_deg: AttitudeDegrees = Field(default=0.0, description="Roll in degrees.", examples=[90.0])
    pitch_deg: AttitudeDegrees = Field(default=0.0, description="Pitch in degrees.", examples=[0.0])
    yaw_deg: AttitudeDegrees = Field(default=0.0, description="Yaw in degrees.", examples=[0.0])

    def on(self, scenario: Scenario) -> Pose:
        """Return the pose on the scenario's vehicle.

        Args:
            scenario: with its airframe, which says how the dipole is mounted.
        """
        roll, pitch, yaw = (math.radians(angle) for angle in (self.roll_deg, self.pitch_deg, self.yaw_deg))
        mount_rad = 0.0 if scenario.airframe is None else scenario.airframe.mount_rad
        position_m = (
            _over_centroid_m(scenario) if self.position_m == "centroid" else np.array(self.position_m)
        )
        return Pose(position_m, roll, pitch, yaw, mount_rad)


def _over_centroid_m(scenario: Scenario) -> NDArray[np.float64]:
    """Return the lowest allowed position over the nodes' centroid; the lowest of all if none is allowed.

    It is at the lowest altitude of the airspace, on the ceiling of a no-fly zone or on a keep-out ball.
    """
    points_m = scenario.point_positions_m
    across_m = scenario.node_positions_m[:, :2].mean(axis=0)
    squares_m2 = scenario.airspace.keep_out_m**2 - np.sum((points_m[:, :2] - across_m) ** 2, axis=1)
    heights_m = [scenario.airspace.altitude_m[0], *(points_m[:, 2] + np.sqrt(np.maximum(squares_m2, 0.0)))]
    heights_m += [
        zone.ceiling_m for zone in scenario.open_airspace.inner.no_fly if math.isfinite(zone.ceiling_m)
    ]
    positions_m = [np.append(across_m, height_m) for height_m in sorted(heights_m)]
    return next(
        (each for each in positions_m if not list(pose_faults(scenario, Pose(each, 0.0, 0.0)))),
        np.append(across_m, heights_m[0]),
    )
