"""What is the same in all scenes of a study: a scenario file, several, or the tables of one."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from typing import Annotated

import numpy as np
from pydantic import Field, SerializeAsAny

from nullpose.files import PlainTable
from nullpose.objectives import RECORDS, USUAL
from nullpose.scenario import (
    Airspace,
    Antenna,
    Array,
    Building,
    Channel,
    Destination,
    Eavesdropper,
    GroundPoint,
    Jammer,
    Node,
    Origin,
    Receiver,
    Scenario,
    Source,
    Time,
    Transmitter,
)
from nullpose.scenario.airframe import NamedAirframe
from nullpose.scenario.faults import Place, key_faults
from nullpose.scenario.motion import places_m
from nullpose.scenario.origin import POINT_LISTS, located
from nullpose.scenario.rules import MOST_MEMBERS, Choice, ListOf, list_of_tables
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import Label, Seconds
from nullpose.scenario.ways import at_most_one
from nullpose.study.monte_carlo.distribution import DrawnChannel, FixedOrDrawn


class SceneBase(
    Section,
    header="a table headed [scene]",
    ways=(at_most_one("file", "files"),),
    unstated=("objective", "scenarios", "nodes", "jammers", "eavesdroppers", "sources", "buildings"),
):
    """The part of every scene that is not drawn, except for values of the channel that are.

    Args:
        file: a scenario file.
        files: several, which are the scenes in turn.
        scenarios: what the files hold; read together with the spec.
        at_s: the one instant that counts, where they are in motion; None for all.
        time: the instants of tables in motion.
        objective, origin, airspace, airframe, antenna, array, channel, receiver, transmitter, destination: as
            in a scenario file, like buildings.
        nodes, jammers, eavesdroppers, sources: points that are not drawn, as in a scenario file.
    """

    file: Label | None = optional(
        "A scenario file, relative to this file's folder; what is drawn replaces its own.", "paper.toml"
    )
    files: (
        Annotated[tuple[Label, ...], ListOf("a list of names of scenario files", 1, MOST_MEMBERS)] | None
    ) = optional(
        "Several scenario files: scene 0 is the first, and so on, begun anew after the last.",
        ["north.toml", "south.toml"],
    )
    scenarios: Annotated[tuple[Scenario, ...], list_of_tables("scene.scenarios")] = Field(
        default=(), description="What file or files hold. Filled in when the spec is read."
    )
    at_s: Seconds | None = optional(
        "Where what a file holds is in motion: everything stands where it is at this instant, in seconds. "
        "Left out: it moves, for cases with a flight, and others are of the instant 0.",
        30.0,
    )
    time: Time | None = optional("A table headed [scene.time], where points move.")
    objective: Annotated[str, Choice("an objective", RECORDS)] = Field(
        default=USUAL, description="As in a scenario file.", examples=list(RECORDS)
    )
    origin: Origin | None = optional("A table headed [scene.origin].")
    airspace: Airspace | None = optional("A table headed [scene.airspace].")
    airframe: NamedAirframe | None = optional("A table headed [scene.airframe], or the name of a preset.")
    antenna: Antenna | None = optional("A table headed [scene.antenna].")
    array: Array | None = optional("A table headed [scene.array].")
    channel: Annotated[Channel | SerializeAsAny[DrawnChannel], FixedOrDrawn()] | None = optional(
        "A table headed [scene.channel], values of which may be drawn."
    )
    receiver: Receiver | None = optional("A table headed [scene.receiver].")
    transmitter: Transmitter | None = optional("A table headed [scene.transmitter].")
    destination: Destination | None = optional("A table headed [scene.destination].")
    nodes: Annotated[tuple[Node, ...], list_of_tables("scene.nodes")] = Field(
        default=(), description="Tables headed [[scene.nodes]], where they are not drawn."
    )
    jammers: Annotated[tuple[Jammer, ...], list_of_tables("scene.jammers")] = Field(
        default=(), description="Tables headed [[scene.jammers]], where they are not drawn."
    )
    eavesdroppers: Annotated[tuple[Eavesdropper, ...], list_of_tables("scene.eavesdroppers")] = Field(
        default=(), description="Tables headed [[scene.eavesdroppers]], where they are not drawn."
    )
    sources: Annotated[tuple[Source, ...], list_of_tables("scene.sources")] = Field(
        default=(), description="Tables headed [[scene.sources]]."
    )
    buildings: Annotated[tuple[Building, ...], list_of_tables("scene.buildings")] = Field(
        default=(), description="Tables headed [[scene.buildings]]."
    )

    @classmethod
    def completed(cls, data: Mapping[str, object]) -> Mapping[str, object]:
        """Fill in the positions of points that are stated by latitude and longitude."""
        return located(data)

    def faults(self, raw: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Yield tables that are missing, or stated twice."""
        keys = (key for key in _TABLES if key != "at_s" and not isinstance(getattr(self, key), DrawnChannel))
        tables = [key for key in keys if raw.get(key)]
        if self.file or self.files or self.scenarios:
            message = "given together with a file, which states it; remove one, or state it in the file"
            yield from (((key,), message) for key in tables)
        else:
            yield from key_faults(raw, ("at_s",), "is of a file in motion, and none is named; remove it")
            yield from (
                ((key,), f"missing; add a table headed [scene.{key}], or name a scenario file (file)")
                for key in ("airspace", "receiver")
                if key not in tables
            )

    @property
    def size(self) -> int:
        """How many scenarios take turns."""
        return max(1, len(self.scenarios))

    def whole(self, index: int) -> Scenario | SceneBase:
        """Choose the source of a scene: one of the files, or this table.

        Args:
            index: the scene.
        """
        return self.scenarios[index % self.size] if self.scenarios else self

    def kept(self, index: int, drawn: Collection[str]) -> PlainTable:
        """Collect the values that a scene keeps when points are drawn, validated already.

        Points that stay are stated in metres alone: all points of a scenario are stated in one way.

        Args:
            index: the scene.
            drawn: the kinds of points that are drawn.
        """
        values = {key: getattr(self.whole(index), key) for key in _TABLES if key not in drawn}
        if drawn:
            origin, kinds = values["origin"], [kind for kind in POINT_LISTS if kind in values]
            values |= {kind: tuple(_in_metres(each, origin) for each in values[kind]) for kind in kinds}
            values["destination"] = values["destination"] and _in_metres(values["destination"], origin)
        return {key: value for key, value in values.items() if value is not None}


def _in_metres(point: GroundPoint, origin: Origin | None) -> GroundPoint:
    update: PlainTable = {"position_m": point.position_m}
    if point.track is not None:
        times_s = [row[0] for row in point.track]
        update["track"] = np.column_stack([times_s, places_m(point, origin, times_s)]).tolist()
    return point if point.lat_deg is None else point.model_copy(update=update)


_TABLES = tuple(key for key in Scenario.model_fields if key not in ("name", "nodes_from"))
