"""The tables of a scenario, and arrays of their numbers, each made once and read-only."""

# Its arrays are made by descriptors and are no fields; pydantic, which refuses what is neither, knows them.
# mypy: disable-error-code="pydantic-field"

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Annotated, Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, PlainSerializer

from nullpose.antenna import GroundAntennas, unit_axis
from nullpose.channel import Custom as CustomLaw, LinkChannel, PointChannels
from nullpose.channel.buildings import Prisms, prisms_of
from nullpose.channel.elevation import with_profile
from nullpose.channel.model import CONSTANT
from nullpose.channel.power_law import power_law
from nullpose.errors import require_usage
from nullpose.objectives import RECORDS, USUAL, Custom, ObjectiveRecord
from nullpose.scenario.airframe import NamedAirframe
from nullpose.scenario.airspace import Airspace
from nullpose.scenario.antenna import Antenna, Array
from nullpose.scenario.buildings import MOST_BUILDINGS, Building
from nullpose.scenario.channel import BLOCKED_DB, SHADOW_MARGIN_M, Channel, CustomChannel, NamedChannel
from nullpose.scenario.ground_points import (
    Destination,
    Eavesdropper,
    GroundPoint,
    Jammer,
    Node,
    Source,
    Terminal,
)
from nullpose.scenario.motion import Time
from nullpose.scenario.origin import Origin
from nullpose.scenario.radio import Receiver, Transmitter
from nullpose.scenario.rules import Choice, list_of_tables
from nullpose.scenario.section import Floats, Section, optional, read_only
from nullpose.scenario.units import Label, Seconds, Title, power_w, ratio_from_db
from nullpose.scenario.ways import Ways

_Made = TypeVar("_Made")
_IN_MOTION = (
    "scenario: given a scene in motion; allowed: a still one; call .at(t) with a time in seconds, as in "
    "scenario.at(0.0), or .instants_s for all times; solve(scenario, hover=True) holds one pose for all"
)


def _of(kinds: str, make: Callable[[ScenarioTables, list[Any]], _Made]) -> cached_property[_Made]:
    """Make an attribute of a scenario, once, from it and its points of some kinds."""
    return cached_property(
        lambda table: make(table, [point for kind in kinds.split() for point in getattr(table, kind)])
    )


def _positions_m(table: ScenarioTables, points: Sequence[GroundPoint]) -> Floats:
    """Make the positions of points, of which a scene in motion has none."""
    require_usage(table.time is None, _IN_MOTION)
    return read_only([point.position_m for point in points], (-1, 3))


def _each(key: str) -> Callable[[ScenarioTables, Sequence[GroundPoint]], Floats]:
    """Make the function that makes the array of a number of each point."""
    return lambda _, points: read_only([getattr(point, key) for point in points], (-1,))


def _names(_: ScenarioTables, points: Sequence[GroundPoint]) -> tuple[str, ...]:
    return tuple(point.name for point in points)


def _antennas(_: ScenarioTables, points: Sequence[GroundPoint]) -> GroundAntennas | None:
    """Make the antennas of points; None where all are isotropic."""
    if all(point.antenna == "isotropic" and point.gain_dbi == 0.0 for point in points):
        return None
    axes = [unit_axis(point.antenna_axis) if point.leak < 1.0 else np.zeros(3) for point in points]
    return GroundAntennas(
        read_only(axes, (-1, 3)),
        *read_only([(point.largest_gain, point.leak) for point in points], (-1, 2)).T,
    )


def _channels(table: ScenarioTables, points: Sequence[GroundPoint]) -> PointChannels | None:
    """Make the channels of points; None where all are in free space with line of sight."""
    links = [table.channel_of(point) for point in points]
    if all(link.strength == 1.0 and link.row[0] == CONSTANT for link in links) and table.prisms is None:
        return None
    kept = PointChannels.of(links, table.prisms, [*map(table.is_unwanted, points)])
    rows, strengths = read_only(kept.rows, kept.rows.shape), read_only(kept.strengths, (-1,))
    return kept._replace(strengths=strengths, rows=rows)


class _Objective(Choice):
    """One of the objectives by name, or a function in Python, which no file can hold."""

    def read(self, value: object) -> Any:
        """Return either, or raise the fault that names the words."""
        return value if isinstance(value, Custom) else super().read(value)


class ScenarioTables(
    Section,
    header="a table with the keys of a scenario file",
    ways=(Ways((("nodes",), ("nodes_from",)), fewest=0, most=2),),
    unstated=("objective", "eavesdroppers", "sources", "buildings"),
):
    """The tables of a scenario, and arrays of its points: sources are the nodes, then the jammers."""

    name: Title = Field(
        default="",
        description="Title of the scenario, for tables and figures.",
        examples=["Harbour, north quay"],
    )
    objective: Annotated[Any, _Objective("an objective", RECORDS), PlainSerializer(str)] = Field(
        default=USUAL,
        description="The objective to maximise: "
        + ", or ".join(f"{record.name}, {record.summary}" for record in RECORDS.values())
        + ".",
        examples=list(RECORDS),
    )
    nodes_from: Label | None = optional(
        "Name of a CSV or geographic file (GeoJSON, KML, GeoPackage and others) "
        "that lists the nodes, relative to this file's folder. "
        "Either this or tables headed [[nodes]].",
        "nodes.geojson",
    )
    time: Time | None = optional(
        "A table headed [time]: how long the scene lasts, where points move. Left out: nothing moves."
    )
    at_s: Seconds | None = optional(
        "Of a still scene that a scene in motion was at one instant: the time of that, in seconds.", 30.0
    )
    origin: Origin | None = optional(
        "A table headed [origin]: the place on the Earth (WGS-84) where positions are [0, 0, 0]. "
        "Left out: nowhere in particular."
    )
    airspace: Airspace = Field(description="A table headed [airspace]: where the vehicle may be, in metres.")
    airframe: NamedAirframe | None = optional(
        "A table headed [airframe]: how far the vehicle tilts and how the dipole is mounted; or a "
        "preset's name. Left out: every axis is reached.",
        "quadrotor",
    )
    antenna: Antenna | None = optional(
        "A table headed [antenna]: which antenna the drone carries. Left out: a short dipole."
    )
    array: Array | None = optional(
        "A table headed [array]: upright dipoles on a horizontal vehicle, in place of the one."
    )
    receiver: Receiver = Field(
        description="A table headed [receiver]: noise power (W or dBm) and path gain at 1 m (dB, or from a "
        "frequency in Hz)."
    )
    channel: NamedChannel | None = optional(
        "A table headed [channel]: how the power of a link falls with distance and elevation. Left out: free "
        "space with line of sight."
    )
    transmitter: Transmitter | None = optional(
        "A table headed [transmitter]: the drone's own power (W or dBm), where it transmits."
    )
    destination: Destination | None = optional(
        "A table headed [destination]: the point that the drone sends to, where it is a relay."
    )
    nodes: Annotated[tuple[Node, ...], list_of_tables("nodes", fewest=1)] = Field(
        description="Tables headed [[nodes]], one for each legitimate node; at least one. Or nodes_from."
    )
    jammers: Annotated[tuple[Jammer, ...], list_of_tables("jammers")] = Field(
        default=(), description="Tables headed [[jammers]], one for each jammer; none if left out."
    )
    eavesdroppers: Annotated[tuple[Eavesdropper, ...], list_of_tables("eavesdroppers")] = Field(
        default=(), description="Tables headed [[eavesdroppers]], one for each; where the drone transmits."
    )
    sources: Annotated[tuple[Source, ...], list_of_tables("sources")] = Field(
        default=(),
        description="Tables headed [[sources]], one for each transmitter on the ground that nodes listen to; "
        "where the drone jams eavesdroppers.",
    )
    buildings: Annotated[tuple[Building, ...], list_of_tables("buildings", most=MOST_BUILDINGS)] = Field(
        default=(),
        description="Tables headed [[buildings]], one for each building or file of some; none if left out.",
    )

    node_positions_m = _of("nodes", _positions_m)
    """Positions of the nodes [m], (n_nodes, 3)."""
    node_powers_w = _of("nodes", _each("transmit_power_w"))
    """Transmit powers of the nodes [W], (n_nodes,)."""
    node_required_sinr = _of("nodes", _each("required_sinr"))
    """What each node's SINR is divided by to give its margin, linear, (n_nodes,)."""
    terminal_required_sinr = _of("terminals", _each("required_sinr"))
    """The same of all terminals, (n_terminals,)."""

    @property
    def node_weights(self) -> Floats:
        """The nodes' weights in a sum or a mean, (n_nodes,)."""
        return np.array([1.0 if node.weight is None else node.weight for node in self.nodes])

    @property
    def node_shares(self) -> Floats:
        """The weights over their sum, (n_nodes,)."""
        return self.node_weights / np.sum(self.node_weights)

    @property
    def node_requirements(self) -> Floats:
        """The SINR that each node requires, linear, 0 where it states none, (n_nodes,)."""
        return np.array([0.0 if each.min_sinr_db is None else each.required_sinr for each in self.nodes])

    node_antennas = _of("nodes", _antennas)
    """The nodes' antennas; None where all are isotropic."""
    node_channels = _of("nodes", _channels)
    """The nodes' channels; None where all are in free space with line of sight."""
    jammer_positions_m = _of("jammers", _positions_m)
    """Positions of the jammers [m], (n_jammers, 3)."""
    jammer_powers_w = _of("jammers", _each("transmit_power_w"))
    """Transmit powers of the jammers [W], (n_jammers,)."""
    jammer_uncertainty_m = _of("jammers", _each("uncertainty_reach_m"))
    """Radii of the balls that the jammers are in [m], (n_jammers,)."""
    jammer_antennas = _of("jammers", _antennas)
    """The jammers' antennas; None where all are isotropic."""
    jammer_channels = _of("jammers", _channels)
    """The jammers' channels; None where all are in free space with line of sight."""
    source_positions_m = _of("nodes jammers", _positions_m)
    """Positions of the sources [m], (n_nodes + n_jammers, 3)."""
    source_powers_w = _of("nodes jammers", _each("transmit_power_w"))
    """Transmit powers of the sources [W], (n_nodes + n_jammers,)."""
    source_antennas = _of("nodes jammers", _antennas)
    """The sources' antennas; None where all are isotropic."""
    source_channels = _of("nodes jammers", _channels)
    """The sources' channels; None where all are in free space with line of sight."""
    eavesdropper_positions_m = _of("eavesdroppers", _positions_m)
    """Positions of the eavesdroppers [m], (n_eavesdroppers, 3)."""
    eavesdropper_uncertainty_m = _of("eavesdroppers", _each("uncertainty_reach_m"))
    """Radii of the balls that the eavesdroppers are in [m], (n_eavesdroppers,)."""
    eavesdropper_antennas = _of("eavesdroppers", _antennas)
    """The eavesdroppers' antennas; None where all are isotropic."""
    eavesdropper_channels = _of("eavesdroppers", _channels)
    """The eavesdroppers' channels; None where all are in free space with line of sight."""

    sender_positions_m = _of("sources", _positions_m)
    """Positions of the transmitters on the ground [m], (n_senders, 3)."""
    sender_antennas = _of("sources", _antennas)
    """Their antennas; None where all are isotropic."""

    destination_positions_m = _of("destinations", _positions_m)
    """Position of the destination [m], (1, 3); (0, 3) without one."""
    destination_antennas = _of("destinations", _antennas)
    """The destination's antenna; None if it is isotropic."""
    destination_channels = _of("destinations", _channels)
    """The destination's channel; None in free space with line of sight."""
    terminal_positions_m = _of("terminals", _positions_m)
    """Positions of the terminals [m], (n_terminals, 3)."""
    terminal_antennas = _of("terminals", _antennas)
    """The terminals' antennas; None where all are isotropic."""
    terminal_channels = _of("terminals", _channels)
    """The terminals' channels; None where all are in free space with line of sight."""
    point_positions_m = _of("points", _positions_m)
    """Positions of all points [m], (n, 3)."""

    @property
    def objective_record(self) -> ObjectiveRecord:
        """What the objective states of itself."""
        return self.objective.record if isinstance(self.objective, Custom) else RECORDS[self.objective]

    @cached_property
    def prisms(self) -> Prisms | None:
        """The buildings in convex pieces; None without any that is higher than its base."""
        if all(building.heights_m[1] <= building.base_m for building in self.buildings):
            return None
        margin_m = None if self.channel is None else self.channel.shadow_margin_m
        return prisms_of(
            [building.outline_m for building in self.buildings],
            [building.courtyard_outlines_m for building in self.buildings],
            [building.floor_m for building in self.buildings],
            [building.heights_m for building in self.buildings],
            SHADOW_MARGIN_M if margin_m is None else margin_m,
        )

    @property
    def destinations(self) -> tuple[Destination, ...]:
        """The destination of a relay; none under another objective."""
        return () if self.destination is None else (self.destination,)

    @property
    def terminals(self) -> tuple[Node | Destination, ...]:
        """Those whose links count: the nodes, and after them the destination."""
        return *self.nodes, *self.destinations

    @property
    def points(self) -> tuple[Node | Jammer | Eavesdropper | Destination | Source, ...]:
        """All points: nodes, jammers, eavesdroppers, destination, sources."""
        return *self.nodes, *self.jammers, *self.eavesdroppers, *self.destinations, *self.sources

    @property
    def interferer(self) -> str:
        """What an interferer of the objective is, in a word: ``"jammer"`` or ``"eavesdropper"``."""
        return {"jammers": "jammer", "eavesdroppers": "eavesdropper"}[self.objective_record.interferers]

    @property
    def interferers(self) -> tuple[Jammer | Eavesdropper, ...]:
        """Those in the denominators of the objective's ratios, in order."""
        return tuple(getattr(self, self.objective_record.interferers))

    def of_interferers(self, key: str) -> Any:
        """Look up an array of the interferers by its key, such as ``"positions_m"``."""
        return getattr(self, f"{self.interferer}_{key}")

    def is_unwanted(self, point: GroundPoint) -> bool:
        """Check whether a link with the drone is unwanted: an interferer's, or a node's if the drone jams."""
        return point.is_interferer != (len(self.sources) > 0)

    def channel_of(self, point: GroundPoint) -> LinkChannel:
        """Return the channel of a point's link, its own or the scenario's, with its antenna's profile."""
        whole = self.channel or Channel()
        channel = point.channel or whole
        lost_db = channel.blocked_loss_db or whole.blocked_loss_db or BLOCKED_DB
        by_sight, is_unwanted = self.prisms is not None, self.is_unwanted(point)
        link = channel.in_sight(is_unwanted, lost_db) if by_sight else channel.make(is_unwanted)
        rows = point.antenna_profile
        return link if rows is None else with_profile(link, *zip(*rows, strict=True))

    @property
    def has_channels(self) -> bool:
        """Whether any link's gain over free space changes with the position."""
        channels = (self.source_channels, self.eavesdropper_channels, self.destination_channels)
        changes = (np.any(each.rows[:, 0] != CONSTANT) for each in channels if each is not None)
        return self.prisms is not None or any(changes)

    def custom_law(self, point: GroundPoint) -> CustomLaw | None:
        """Return the function in Python that the channel of a point is, if it is one."""
        channel = point.channel or self.channel
        return channel.law if isinstance(channel, CustomChannel) else None

    @property
    def has_custom_channels(self) -> bool:
        """Whether any link's channel is a function in Python."""
        return any(self.custom_law(point) is not None for point in self.points)

    node_names = _of("nodes", _names)
    """Names of the nodes, in order."""
    terminal_names = _of("terminals", _names)
    """Names of the terminals, in order."""
    jammer_names = _of("jammers", _names)
    """Names of the jammers, in order."""
    eavesdropper_names = _of("eavesdroppers", _names)
    """Names of the eavesdroppers, in order."""

    @cached_property
    def eavesdropper_noise_w(self) -> Floats:
        """Noise of the eavesdroppers' receivers [W], (n_eavesdroppers,)."""
        return read_only([self._noise_w(eavesdropper) for eavesdropper in self.eavesdroppers], (-1,))

    @cached_property
    def node_noise_w(self) -> Floats:
        """Noise and jamming at the nodes' own receivers [W], (n_nodes,); for the downlink.

        The jamming is as stated, or ``sum_j g0 J_j / |s_k - m_j|^2``, in line of sight, times the largest
        gains of both antennas whatever their directions, and the strength of the jammer's channel.
        """
        return read_only([self._noise_w(node) + self._jamming_w(node) for node in self.nodes], (-1,))

    @cached_property
    def destination_noise_w(self) -> Floats:
        """Noise and jamming at the destination's receiver [W], (1,), as of a node that receives."""
        return read_only([self._noise_w(end) + self._jamming_w(end) for end in self.destinations], (-1,))

    @cached_property
    def node_senders(self) -> NDArray[np.int64]:
        """The source that each node listens to, by its place among them, (n_nodes,)."""
        names = [source.name for source in self.sources]
        return np.array([names.index(node.source_name or names[0]) for node in self.nodes], dtype=np.int64)

    def ground_received_w(
        self, receivers: Sequence[GroundPoint], positions_m: ArrayLike | None = None
    ) -> Floats:
        """Work out the power that points receive from each source on the ground [W], (..., m, n_senders).

        ``g1 P_a G_a G_k / |s_k - q_a|^2``, with the path gain g1 at 1 m between isotropic antennas, times the
        channel's gain over free space at that distance by its exponent. Antennas count alike in all
        directions, with their largest gains G.

        Args:
            receivers: the points.
            positions_m: where they are, (..., m, 3); as stated, if left out.
        """
        stated_m = np.reshape([point.position_m for point in receivers], (-1, 3))
        places_m = stated_m if positions_m is None else np.asarray(positions_m, dtype=np.float64)
        received_w = []
        for source in self.sources:
            distance_m = np.linalg.norm(places_m - source.position_m, axis=-1)
            peaks = [ratio_from_db(point.peak_dbi + source.peak_dbi) for point in receivers]
            channel, none = source.channel or self.channel or Channel(), np.zeros(1)
            law = power_law(channel.exponent or 2.0, channel.gain_distance_m)
            gain = law.strength * law.excess(np.array(law.row), distance_m, none, none)
            power_w = self.receiver.reference_gain * source.transmit_power_w * gain
            received_w.append(power_w * np.array(peaks) / distance_m**2)
        return np.stack(received_w, axis=-1)

    @cached_property
    def node_signal_w(self) -> Floats:
        """Power that each node receives from its source [W], (n_nodes,)."""
        received_w = self.ground_received_w(self.nodes)
        return read_only(np.take_along_axis(received_w, self.node_senders[:, None], axis=1), (-1,))

    @cached_property
    def overheard_w(self) -> Floats:
        """Power that each eavesdropper receives from each source [W], (n_eavesdroppers, n_senders)."""
        return read_only(self.ground_received_w(self.eavesdroppers), (-1, len(self.sources)))

    @property
    def rate_bandwidth_hz(self) -> float | None:
        """The bandwidth of all who receive what a rate is of [Hz]; None if one states none, or another."""
        at = (*self.nodes, *self.eavesdroppers) if self.objective_record.transmits else ()
        receivers = [point if point.noise_power_w else self.receiver for point in at] or [self.receiver]
        first, *others = {receiver.bandwidth_hz for receiver in receivers}
        return None if others else first

    def _noise_w(self, point: Terminal | Eavesdropper) -> float:
        return point.noise_power_w or self.receiver.noise_power_w

    def _jamming_w(self, terminal: Node | Destination) -> float:
        if (jamming_w := power_w(terminal.jamming_w, terminal.jamming_dbm)) > 0.0:
            return jamming_w
        distance_squared = np.sum((self.jammer_positions_m - terminal.position_m) ** 2, axis=-1)
        gains = [ratio_from_db(terminal.peak_dbi + jammer.peak_dbi) for jammer in self.jammers]
        powers_w = self.receiver.reference_gain * self.jammer_powers_w * gains
        if self.jammer_channels is not None:
            powers_w = powers_w * self.jammer_channels.strengths
        return float(np.sum(powers_w / distance_squared))
