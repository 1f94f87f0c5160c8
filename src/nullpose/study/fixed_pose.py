"""A pose that is evaluated in every scene of a study, with nothing searched and nothing proved."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, TypeAdapter

from nullpose.physics import Pose
from nullpose.scenario import Scenario
from nullpose.scenario.section import Section
from nullpose.scenario.units import AttitudeDegrees, Position
from nullpose.study.evaluation import pose_faults

_POSITION: TypeAdapter[tuple[float, float, float]] = TypeAdapter(Position)
_Place = Annotated[
    tuple[float, float, float] | Literal["centroid"],
    BeforeValidator(lambda value: value if value in ("centroid",) else _POSITION.validate_python(value)),
]


class FixedPose(Section):
    """A pose that is evaluated in every scene, with nothing searched and nothing proved.

    Args:
        position_m: where the drone hovers; "centroid" for the lowest allowed position over
            the centroid of the nodes.
        roll_deg, pitch_deg, yaw_deg: how it is turned.
    """

    header: ClassVar[str] = "a table such as { position_m = [0, 0, 20], roll_deg = 90 }"
    unstated: ClassVar[frozenset[str]] = frozenset({"roll_deg", "pitch_deg", "yaw_deg"})

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
