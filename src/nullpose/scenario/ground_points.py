"""Who is on the ground: nodes, jammers, sources, those who listen in, and the far end of a relay."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, ClassVar, Self

from pydantic import Field, create_model

from nullpose.antenna import GROUND_ANTENNAS, short_dipole
from nullpose.channel.profile import MOST_ROWS, mean_gain
from nullpose.files import PlainTable
from nullpose.scenario.channel import NamedChannel
from nullpose.scenario.faults import ONLY_LOCAL, Place, faults_of
from nullpose.scenario.radio import Noisy, Powered, Uncertain
from nullpose.scenario.rules import Choice, Limits, ListOf
from nullpose.scenario.section import Section, optional
from nullpose.scenario.track import MOTION, Track, Velocity, place_of_start, track_faults
from nullpose.scenario.units import (
    ALTITUDE_KEYS,
    GEODETIC_KEYS,
    MOST_OVER_FED_DB,
    PLACE_KEYS,
    Altitude,
    AxisDirection,
    DecibelMilliwatts,
    DecibelsIsotropic,
    ElevationDegrees,
    Label,
    Latitude,
    Longitude,
    NullDepthDecibels,
    Position,
    RatioDecibels,
    SeaAltitude,
    Watts,
    Weight,
    ratio_from_db,
)
from nullpose.scenario.ways import Ways, at_most_one

GroundAntennaKind = Annotated[str, Choice("an antenna on the ground", tuple(GROUND_ANTENNAS))]
_Row = Annotated[
    tuple[ElevationDegrees, DecibelsIsotropic],
    ListOf("a list of two numbers [elevation in degrees, gain in dBi]", 2, 2),
]
SAME_PLACE_M = 1e-6
"""Two ground points closer than this are at the same place [m]."""
_LEAST_STEP_DEG = 0.01
ALIKE = ((-90.0, 0.0), (90.0, 0.0))
"""The profile of an isotropic antenna."""
_PARTS = {
    "antenna_axis": ("axis", "dipole"),
    "null_depth_db": ("null", "dipole"),
    "antenna_file": ("file", "profile"),
    "antenna_profile": ("profile", "profile"),
}  # keys that only one antenna has
PLACE = Ways(
    (("position_m",), GEODETIC_KEYS),
    fewest=0,
    most=2,
    twins=tuple((key, "alt_m") for key in ALTITUDE_KEYS[1:]),
    instead=("track", "track_from"),
)
"""The ways to state a place."""


class GroundPoint(
    Section, ways=(PLACE, at_most_one(*ALTITUDE_KEYS), MOTION), unstated=("antenna", "gain_dbi")
):
    """Someone at a place, with an antenna.

    Args:
        name: how results and overrides refer to it; a scenario names it by its place when left out.
        position_m: east, north and up from the origin [m], (3,).
        lat_deg, lon_deg, alt_m: the same place on the Earth, from which a scenario with an origin fills in
            position_m; None if the place was not stated so.
        alt_msl_m, alt_agl_m: in place of alt_m, the altitude over the sea or above the ground at the origin.
        velocity_m_s: of a point that moves evenly from its place at t = 0: east, north and up [m/s], (3,).
        track: (n, 4) times [s] and places of one that moves from row to row: in metres, or as lat_deg,
            lon_deg and the altitude if its place is stated by these.
        track_from: the name of a file that states the track, in whose place that comes when it is read.
        antenna: the kind of its antenna, a key of ``GROUND_ANTENNAS``.
        antenna_axis: the direction of a dipole's wire, (3,), of any length; None for an upright one.
        antenna_file: name of the file that a profile is from, relative to the scenario's.
        antenna_profile: (n, 2) elevations [deg] and gains there [dBi]: stated, or what was read of the file.
        null_depth_db: how far a dipole's gain along its axis is below that across it [dB]; None for a
            perfect null.
        gain_dbi: the antenna's gain at its peak over an isotropic one [dBi].
        channel: of its link with the drone; None for the scenario's.
    """

    is_interferer: ClassVar[bool] = True
    """Whether its link is unwanted."""

    name: Label = Field(
        default="",
        description="Name, unique among all points on the ground. Left out: S1, S2, ... for nodes, M1, M2, "
        "... for jammers, E1, E2, ... for eavesdroppers and A1, A2, ... for sources, by their place in the "
        "file.",
    )
    position_m: Position = Field(
        description="Position in metres from the origin: [east, north, up]. Either this, or lat_deg, lon_deg "
        "and an altitude in a scenario with an [origin]. Of a point that moves: its place at t = 0.",
        examples=[[17.0, 15.0, 4.0]],
    )
    lat_deg: Latitude | None = optional(
        "Latitude in degrees (WGS-84), north positive; with lon_deg and alt_m in place of "
        "position_m, in a scenario with an [origin].",
        50.001,
    )
    lon_deg: Longitude | None = optional(
        "Longitude in degrees (WGS-84), east positive; with lat_deg and alt_m.", 14.502
    )
    alt_m: Altitude | None = optional(
        "Altitude in metres over the WGS-84 ellipsoid; with lat_deg and lon_deg.", 252.0
    )
    alt_msl_m: SeaAltitude | None = optional(
        "Altitude in metres over the sea (the geoid), in place of alt_m; where [origin] states its own.",
        207.0,
    )
    alt_agl_m: (
        Annotated[
            float, Limits("a height in m above the ground at the origin", -1e4, 1e5, "not over the sea")
        ]
        | None
    ) = optional(
        "Height in metres above the ground at the origin, which counts as level, in place of alt_m.", 2.0
    )
    velocity_m_s: Velocity | None = optional(
        "How it moves from its place at t = 0, in metres a second: [east, north, up]. In a scene with "
        "[time].",
        [0.0, 5.0, 0.0],
    )
    track: Track | None = optional(
        "How it moves, in place of velocity_m_s: rows [t, x, y, z] of seconds and metres, straight and even "
        "from each to the next; or [t, lat, lon, alt] where its place is stated so. A row at t = 0 states "
        "its place too.",
        [[0.0, 17.0, 15.0, 4.0], [60.0, 17.0, 315.0, 4.0]],
    )
    track_from: Label | None = optional(
        "Name of the file of its track, in the scenario's folder or below it: a CSV file of t, x, y, z or t, "
        "lat, lon, alt, a GeoJSON LineString with times, or GPX.",
        "drone.csv",
    )
    antenna: GroundAntennaKind = Field(
        default="isotropic",
        description="What antenna it has: isotropic, which loses nothing to polarisation; circular, which "
        "takes part with half the power; dipole, a short one; or profile, isotropic times a gain by "
        "elevation, as of a collinear whip.",
        examples=list(GROUND_ANTENNAS),
    )
    antenna_axis: AxisDirection | None = optional(
        "How a dipole lies: the direction of its wire, [east, north, up], of any length. Left out: upright.",
        [0.0, 0.0, 1.0],
    )
    antenna_file: str | None = optional(
        "Name of the file of a profile, in the scenario's folder or below it: a CSV file of elevation_deg, "
        "from -90 to 90, or angle_deg, from the zenith, from 0 to 180, and gain_dbi; or .msi.",
        "whip.csv",
    )
    antenna_profile: (
        Annotated[
            tuple[_Row, ...], ListOf("a list of rows [elevation in degrees, gain in dBi]", 2, MOST_ROWS)
        ]
        | None
    ) = optional(
        "The gain of a profile, in place of a file: rows of an elevation in degrees and the gain there in "
        "dBi, from -90 (right below) over 0 (the horizon) to 90.",
        [[-90.0, -20.0], [0.0, 6.0], [90.0, -20.0]],
    )
    null_depth_db: NullDepthDecibels | None = optional(
        "How deep a dipole's null is, in dB below its broadside gain: beside a mast or a body 15 "
        "to 35. What is received through it has no known polarisation. Left out: the null is perfect.",
        20.0,
    )
    gain_dbi: DecibelsIsotropic = Field(
        default=0.0,
        description="Gain of its antenna in the direction where it is largest, in dBi (dBic for a circular "
        "one): 1.76 for a short dipole, 2.15 for a half-wave dipole. Left out: 0, as in the paper; the power "
        "of a transmitter is then its EIRP.",
        examples=[2.15],
    )
    channel: NamedChannel | None = optional(
        'Its own channel: "free-space", or a table like [channel]. Left out: that of the scenario.',
        "free-space",
    )

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> Mapping[str, object]:
        """Fill in the place at which a track in metres begins."""
        if data.keys() & PLACE_KEYS or not data.keys() & {"track", "track_from"}:
            return data
        return {**data, "position_m": place_of_start(data) or [0.0, 0.0, 0.0]}  # refused then for its track

    def faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        """List the faults of the keys of an antenna where there is none, of a profile and of a track."""
        yield from super().faults(raw)
        yield from track_faults(self.track, raw)
        yield from (
            (
                (key,),
                f'given, but antenna = "{self.antenna}" has no {noun}; remove it, or write antenna = '
                f'"{owner}"',
            )
            for key, (noun, owner) in _PARTS.items()
            if getattr(self, key) is not None and self.antenna in GROUND_ANTENNAS.keys() - {owner}
        )
        if self.antenna == "profile":
            yield from self._profile_faults(raw)

    def _profile_faults(self, raw: PlainTable) -> Iterable[tuple[Place, str]]:
        deg = [row[0] for row in self.antenna_profile or ALIKE]
        least_deg = min(map(operator.sub, deg[1:], deg))
        is_whole = (deg[0], deg[-1]) == (-90.0, 90.0) and least_deg >= _LEAST_STEP_DEG
        over_fed_db = self.over_fed_db if is_whole else 0.0
        is_missing, is_unread = "antenna_profile" not in raw, self.antenna_file is not None
        return faults_of(
            (
                self.gain_dbi,
                ("gain_dbi",),
                f"got {self.gain_dbi}, but a profile's gains are in dBi: it would add to them; remove it",
            ),
            (is_missing and is_unread, ("antenna_file",), f"{ONLY_LOCAL}; load that file by its path"),
            (
                is_missing and not is_unread,
                ("antenna_profile",),
                'missing, but antenna = "profile" needs it, or antenna_file; add either',
            ),
            (
                not is_whole,
                ("antenna_profile",),
                f"elevations go from {deg[0]:g} to {deg[-1]:g} degrees, must rise from -90, right below, to "
                f"90 by {_LEAST_STEP_DEG:g} or more a row; state what the antenna does there",
            ),
            (
                over_fed_db > MOST_OVER_FED_DB,
                ("antenna_profile",),
                f"its gain averages to {over_fed_db:.1f} dB over the sphere: it would radiate more than it "
                "is fed; must be 0 dB at most. Are its gains in dBi?",
            ),
        )

    @property
    def largest_gain(self) -> float:
        """The largest gain of a link that its antenna allows, linear: its own, halved for a circular one."""
        return GROUND_ANTENNAS[self.antenna] * ratio_from_db(self.peak_dbi)

    @property
    def peak_dbi(self) -> float:
        """The gain of its antenna in the direction where it is largest [dBi]."""
        return max((dbi for _, dbi in self.antenna_profile or ()), default=self.gain_dbi)

    @property
    def leak(self) -> float:
        """The gain along a dipole's axis, linear, 1 being the gain across it; 1 without a dipole."""
        return short_dipole(self.null_depth_db).leak if self.antenna == "dipole" else 1.0

    @property
    def over_fed_db(self) -> float:
        """How much more than it is fed its antenna would radiate over the whole sphere by its gain [dB]."""
        if self.antenna_profile is not None:
            return 10.0 * math.log10(mean_gain(*zip(*self.antenna_profile, strict=True)))
        mean = short_dipole(self.null_depth_db).mean if self.antenna == "dipole" else 1.0
        return (self.gain_dbi or 0.0) + 10.0 * math.log10(mean)

    @property
    def isotropic(self) -> Self:
        """The point with an isotropic antenna of the same gain."""
        return self.model_copy(
            update={"antenna": "isotropic", "gain_dbi": self.peak_dbi} | dict.fromkeys(_PARTS)
        )


class Terminal(Noisy, ways=(at_most_one("jamming_w", "jamming_dbm"),)):
    """An end of a link that counts: what it asks for, and what its receiver gets beside the signal.

    Args:
        weight: its margin is its SINR over this, or how often it counts in a mean.
        min_sinr_db: the SINR that it requires [dB]; its margin is its SINR over this.
        noise_w: noise of its own receiver [W], where the drone transmits to it; or else
        noise_dbm: the same in dBm; or else
        bandwidth_hz: of the receiver, with
        noise_figure_db: from which the noise follows; that of [receiver] when all are left out.
        jamming_w: jamming power that its own receiver gets [W], likewise; or else
        jamming_dbm: the same in dBm; worked out from the jammers when both are left out.
    """

    is_interferer: ClassVar[bool] = False

    weight: Weight | None = optional(
        "What the node's SINR is divided by before the smallest is taken: a node of weight 2 is "
        "given twice the SINR; or how often it counts in a sum of rates or a mean. Left out: 1.",
        2.0,
    )
    min_sinr_db: RatioDecibels | None = optional(
        "The SINR that the node requires, in dB. Where the smallest counts, what counts is how far it is "
        "exceeded, and the node has no weight; under a sum of rates or a mean every pose must reach it.",
        3.0,
    )
    jamming_w: Watts | None = optional(
        "Jamming power that the node's own receiver gets, in watts; where the drone transmits. "
        "Either this or jamming_dbm. Left out: worked out from the jammers, in line of sight.",
        1e-3,
    )
    jamming_dbm: DecibelMilliwatts | None = optional(
        "Jamming power that the node's own receiver gets, in dBm; where the drone transmits. "
        "Either this or jamming_w.",
        -90.0,
    )

    @property
    def required_sinr(self) -> float:
        """What its SINR is divided by to give its margin: weight, required SINR (linear) or 1."""
        if self.min_sinr_db is not None:
            return ratio_from_db(self.min_sinr_db)
        return 1.0 if self.weight is None else self.weight


if TYPE_CHECKING:

    class _Listener(Section):
        """The key ``from`` of a node."""

else:  # the key is a word of Python's own
    _Listener = create_model(
        "_Listener",
        __base__=Section,
        __module__=__name__,
        **{
            "from": (
                Label | None,
                optional(
                    "Name of the source that the node listens to, where the drone jams eavesdroppers. Left "
                    "out: the only source.",
                    "A1",
                ),
            )
        },
    )


class Node(
    Terminal,
    Powered,
    _Listener,
    GroundPoint,
    header="a node, in a table of its own headed [[nodes]]",
    letter="S",
    # A node need not transmit where the drone does; a scenario judges whether it has to.
    ways=(at_most_one("power_w", "power_dbm"),),
):
    """A legitimate node, whose signal the vehicle is to receive or which is to receive the vehicle's.

    Args beside those of a ground point and of a terminal:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm; both may be left out where the drone transmits.
        from: name of the source that it listens to; None for the only one.
    """

    @property
    def source_name(self) -> str | None:
        """Name of the source that it listens to, as stated."""
        name: str | None = getattr(self, "from")
        return name


class Destination(Terminal, GroundPoint):
    """The point to which the drone sends what it receives from the nodes.

    Its keys are those of a ground point and of a terminal.
    """

    name: Label = Field(
        default="destination",
        description="Name, unique among all points on the ground. Left out: destination.",
        examples=["headquarters"],
    )


class Jammer(
    Uncertain,
    Powered,
    GroundPoint,
    header="a jammer, in a table of its own headed [[jammers]]",
    letter="M",
):
    """A jammer whose signal drowns the nodes: a ground point that transmits and may be uncertain."""


class Eavesdropper(
    Noisy,
    Uncertain,
    GroundPoint,
    header="an eavesdropper, in a table of its own headed [[eavesdroppers]]",
    letter="E",
):
    """A receiver that is not to hear what the drone sends; it may be uncertain.

    Args beside those of a ground point:
        noise_w: noise of its receiver [W]; or else
        noise_dbm: the same in dBm; or else
        bandwidth_hz: of the receiver, with
        noise_figure_db: from which the noise follows; that of [receiver] when all are left out.
    """


class Source(Powered, GroundPoint, header="a source, in a table of its own headed [[sources]]", letter="A"):
    """A transmitter on the ground that a node listens to, while the drone jams those who listen in.

    Args beside those of a ground point:
        power_w: transmit power [W]; or else
        power_dbm: the same in dBm.
        channel: of its links with nodes and eavesdroppers, of which the distance alone counts.
    """

    is_interferer: ClassVar[bool] = False
