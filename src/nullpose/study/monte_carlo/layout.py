"""How the points of one kind are placed: nodes, jammers or eavesdroppers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field

from nullpose.physics.types import FloatArray
from nullpose.scenario.faults import Place, key_faults, plain
from nullpose.scenario.ground_points import GroundAntennaKind, GroundPoint
from nullpose.scenario.rules import Choice, Count, Limits, ListOf, ascending
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import (
    ALTITUDE_KEYS,
    GEODETIC_KEYS,
    AttitudeDegrees,
    AxisDirection,
    DecibelMilliwatts,
    DecibelsIsotropic,
    ErrorMetres,
    Label,
    Metres,
    NullDepthDecibels,
    PlanePoint,
    RadiusMetres,
    Range,
    RatioDecibels,
    Seconds,
    Watts,
    Weight,
)
from nullpose.scenario.ways import Ways, at_most_one, exactly_one
from nullpose.study.monte_carlo.distribution import Distribution, Drawn

MOST_POINTS = 10_000  # of one kind in a scene


@dataclass(frozen=True, slots=True)
class _CountRange(ListOf):
    """A whole number, or a range of them that one is drawn from evenly."""

    low: int

    def read(self, value: object) -> list[object]:
        count = Count(self.noun.split(",")[0], self.low, MOST_POINTS, "or a range, as in [2, 10]")
        ends = plain(value)
        ends = ListOf.read(self, ends) if isinstance(ends, list | tuple) else [ends, ends]
        return [count.read(end) for end in ends]


_NEEDED = {
    "disc": ("centre_m", "radius_m", "count"),
    "rectangle": ("x_m", "y_m", "count"),
    "poisson": ("density_per_m2",),
    "clusters": ("parents", "count", "spread_m"),
}
_IN_A_REGION = ("poisson", "clusters")
_REGIONS = (("centre_m", "radius_m"), ("x_m", "y_m"))
_PLACING = ("count", "density_per_m2", "parents", "spread_m", *_REGIONS[0], *_REGIONS[1])
_PLACE = ("name", "position_m", *GEODETIC_KEYS, *ALTITUDE_KEYS, "velocity_m_s", "track", "track_from")
_MOTIONS = {"constant-velocity": ("speed_m_s", "direction_deg"), "random-waypoint": ("speed_m_s", "pause_s")}
_MOVING = ("speed_m_s", "direction_deg", "pause_s")
_GroundSpeed = Annotated[float, Limits("a speed in m/s", 1e-3, 1e5, "36 km/h are 10 m/s")]
_DETAILS = {
    "antenna": ("antenna_axis", "antenna_file", "antenna_profile", "gain_dbi", "null_depth_db"),
}


class Points(Section):
    """Where the points of one kind are drawn, how many, how high and how strong.

    Args:
        layout: disc, rectangle, poisson or clusters.
        count: how many, a number or a range; of clusters, in each of them.
        centre_m, radius_m: the disc that they lie in; or else
        x_m, y_m: the rectangle.
        density_per_m2: of a Poisson process: the mean number over the area.
        parents: how many clusters, a number or a range.
        spread_m: of clusters: standard deviation of each coordinate from its cluster's centre.
        height_m: altitude.
        antenna: the kind of each antenna, a key of ``GROUND_ANTENNAS``.
        antenna_axis: the direction of each dipole's wire, (3,), of any length.
        null_depth_db: how far each dipole's gain along its axis is below that across it [dB].
        gain_dbi: each antenna's gain at its peak over an isotropic one [dBi].
        motion: constant-velocity or random-waypoint; None where they stand.
        speed_m_s: of a point, or of each of its legs from waypoint to waypoint [m/s].
        direction_deg: of a constant velocity, from east towards north; None for any.
        pause_s: at each waypoint [s].
        name: the name of one alone; the beginning of the names of several.
    """

    layout: Annotated[str, Choice("a layout", tuple(_NEEDED))] = Field(
        description="How they are placed: disc or rectangle (evenly in it), poisson (a Poisson process in "
        "either) or clusters (around centres that lie evenly in either).",
        examples=["disc"],
    )
    count: (
        Annotated[
            tuple[int, int],
            _CountRange("a number of points, or two, the smaller first", 2, 2, 0),
            AfterValidator(ascending),
        ]
        | None
    ) = optional(
        "How many: a number, or a range [fewest, most] that one is drawn from evenly. Of "
        "clusters: in each. Not with poisson.",
        10,
    )
    centre_m: PlanePoint | None = optional("Centre of the disc [east, north].", [0.0, 25.0])
    radius_m: RadiusMetres | None = optional("Radius of the disc, in metres.", 60.0)
    x_m: Range | None = optional("Western and eastern end of the rectangle.", [-50.0, 50.0])
    y_m: Range | None = optional("Southern and northern end of the rectangle.", [0.0, 80.0])
    density_per_m2: (
        Annotated[float, Limits("a density per square metre", 1e-12, 1e6, "the mean number over the area")]
        | None
    ) = optional("Of poisson: the mean number over the area.", 1e-3)
    parents: (
        Annotated[
            tuple[int, int],
            _CountRange("a number of clusters, or two, the smaller first", 2, 2, 1),
            AfterValidator(ascending),
        ]
        | None
    ) = optional("Of clusters: how many, a number or a range.", [2, 4])
    spread_m: RadiusMetres | None = optional(
        "Of clusters: standard deviation of east and of north from the cluster's centre.", 5.0
    )
    height_m: Annotated[Distribution, Drawn.of(Metres)] | None = optional(
        "Altitude in metres: a number or a distribution. Left out: that of the scene's points, "
        "or 0 if it has none.",
        4.0,
    )
    antenna: GroundAntennaKind | None = optional(
        "Antenna of every point: isotropic, circular or dipole. Left out: that of the scene's "
        "points, or isotropic if it has none.",
        "dipole",
    )
    antenna_axis: AxisDirection | None = optional("Direction of every dipole's wire.", [0.0, 0.0, 1.0])
    null_depth_db: NullDepthDecibels | None = optional("How deep the null of every dipole is, in dB.", 20.0)
    gain_dbi: DecibelsIsotropic | None = optional("Gain of every antenna where it is largest.", 2.15)
    motion: Annotated[str, Choice("a motion", tuple(_MOTIONS))] | None = optional(
        "How they move, in a scene with a time: constant-velocity, or random-waypoint (straight to a point "
        "drawn evenly in the same disc or rectangle, and so on). Left out: they stand.",
        "random-waypoint",
    )
    speed_m_s: Annotated[Distribution, Drawn.of(_GroundSpeed)] | None = optional(
        "Speed over the ground in m/s of each point, or of each of its legs from waypoint to waypoint: a "
        "number or a distribution.",
        {"uniform": [1.0, 3.0]},
    )
    direction_deg: Annotated[Distribution, Drawn.of(AttitudeDegrees)] | None = optional(
        "Direction of a constant velocity in degrees, 0 for east and 90 for north: a number or a "
        "distribution. Left out: any, each as likely.",
        90.0,
    )
    pause_s: Annotated[Distribution, Drawn.of(Seconds)] | None = optional(
        "How long a point stays at each waypoint: a number or a distribution. Left out: 0.", 5.0
    )
    name: Label | None = optional(
        "Name of one alone; several are numbered after it. Left out: S1, M1 or E1 and so on.", "M"
    )

    def faults(self, raw: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Yield the faults between the layout and the keys that place its points."""
        if self.layout is None:
            return
        may = {*_NEEDED[self.layout]}
        present = [key for key in _PLACING if getattr(self, key) is not None]
        for key in _NEEDED[self.layout]:
            if key not in present:
                meant = (type(self).model_fields[key].description or "").rstrip(".")
                yield (key,), f'missing; layout "{self.layout}" needs it: {meant}'
        if self.layout in _IN_A_REGION:
            may |= {*_REGIONS[0], *_REGIONS[1]}
            yield from (((), message) for message in Ways(_REGIONS).faults(present))
        strange = [key for key in present if key not in may]
        yield from key_faults(raw, strange, f'has no meaning with layout "{self.layout}"; remove it')
        may_move = _MOTIONS.get(self.motion or "", _MOVING if "motion" in raw else ())
        words = f'with motion "{self.motion}"; remove it' if self.motion else "without motion; add it"
        yield from key_faults(raw, [key for key in _MOVING if key not in may_move], f"has no meaning {words}")
        if self.motion is not None and "speed_m_s" not in raw:
            yield ("speed_m_s",), f'missing; motion "{self.motion}" needs it, as in {{ uniform = [1, 3] }}'

    def values(self, replaced: Sequence[GroundPoint]) -> dict[str, list[Any]]:
        """Return the values by key, places apart: what is stated here, else what the scene's points have.

        A key that is stated here takes the place of its other units and of what describes it further. The
        scene's points may have several values of a key.

        Args:
            replaced: the scene's points, in whose place these are drawn; there may be none.
        """
        keys = [
            key
            for key in type(self).model_fields
            if key not in ("layout", "name", "motion", *_MOVING, *_PLACING)
        ]
        drawn = {key: [getattr(self, key)] for key in keys if getattr(self, key) is not None}
        others = {other for key in drawn for ways in self.ways for other in ways.others(key)}
        dropped = {*_PLACE, *others, *(detail for key in drawn for detail in _DETAILS.get(key, ()))}
        kept = {"height_m": [point.position_m[2] for point in replaced] or [0.0]} | {
            key: [getattr(point, key) for point in replaced]
            for key in (type(replaced[0]).model_fields if replaced else ())
        }
        return {
            key: list(dict.fromkeys(values)) for key, values in kept.items() if key not in dropped
        } | drawn

    @property
    def extent_m(self) -> FloatArray:
        """Ends of the area in which they are drawn [m], (2, 2): west and east, south and north."""
        if self.radius_m is not None:
            return np.asarray(np.add.outer(np.array(self.centre_m), [-self.radius_m, self.radius_m]))
        return np.array([self.x_m, self.y_m])

    def evenly_m(self, placing: np.random.Generator, count: int) -> FloatArray:
        """Draw places evenly in the disc or the rectangle: the first few are the same for any count.

        Args:
            placing: where chance comes from.
            count: how many.
        """
        shares = placing.random((count, 2))
        if self.radius_m is not None:
            radii_m, angles = self.radius_m * np.sqrt(shares[:, 0]), 2.0 * np.pi * shares[:, 1]
            around_m = radii_m[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
            return np.asarray(np.array(self.centre_m) + around_m)
        low_m, high_m = self.extent_m.T
        return np.asarray(low_m + shares * (high_m - low_m))

    def names(self, count: int) -> list[str]:
        """Return the points' names.

        Args:
            count: how many points there are.
        """
        may_be_several = self.layout in _IN_A_REGION or (self.count or (0, 0))[1] > 1
        if self.name is not None and not may_be_several:
            return [self.name] * count
        return [f"{self.name or self.letter}{number}" for number in range(1, count + 1)]


class Nodes(
    Points,
    letter="S",
    ways=(
        at_most_one("power_w", "power_dbm"),
        at_most_one("weight", "min_sinr_db"),
    ),
):
    """Where the nodes are drawn, and how strong they are.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm; neither where the drone transmits.
        weight: what each node's SINR is divided by; or else
        min_sinr_db: what it requires [dB].
    """

    power_w: Annotated[Distribution, Drawn.of(Watts)] | None = optional(
        "Transmit power in watts: a number or a distribution.", 1.0
    )
    power_dbm: Annotated[Distribution, Drawn.of(DecibelMilliwatts)] | None = optional(
        "The same in dBm. Either this or power_w.", {"normal": [20, 6]}
    )
    weight: Annotated[Distribution, Drawn.of(Weight)] | None = optional(
        "What a node's SINR is divided by: a number or a distribution.", 2
    )
    min_sinr_db: Annotated[Distribution, Drawn.of(RatioDecibels)] | None = optional(
        "The SINR that a node requires, in dB. Either this or weight.", 3
    )


class Jammers(Points, letter="M", ways=(exactly_one("power_w", "power_dbm"),)):
    """Where the jammers are drawn, and how strong they are.

    Args:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
        uncertainty_m: radius of the ball that each is known to be in [m].
    """

    power_w: Annotated[Distribution, Drawn.of(Watts)] | None = optional(
        "Transmit power in watts: a number or a distribution.", {"log_uniform": [0.1, 100.0]}
    )
    power_dbm: Annotated[Distribution, Drawn.of(DecibelMilliwatts)] | None = optional(
        "The same in dBm. Either this or power_w.", {"normal": [30, 6]}
    )
    uncertainty_m: Annotated[Distribution, Drawn.of(ErrorMetres)] | None = optional(
        "Radius of the ball that a jammer is known to be in: a number or a distribution.", 2.0
    )


class Eavesdroppers(Points, letter="E"):
    """Where the eavesdroppers are drawn.

    Args:
        uncertainty_m: radius of the ball that each is known to be in [m].
    """

    uncertainty_m: Annotated[Distribution, Drawn.of(ErrorMetres)] | None = optional(
        "Radius of the ball that one is known to be in: a number or a distribution.", 2.0
    )
