"""The scenario: everything that the user states about one problem."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.json_schema import JsonSchemaValue
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.airspace import Airspace
from nullpose.scenario.arrays import read_only
from nullpose.scenario.crosscheck import cross_faults
from nullpose.scenario.faults import Place, rejection
from nullpose.scenario.ground_points import Jammer, Node
from nullpose.scenario.names import Title, named
from nullpose.scenario.receiver import Receiver
from nullpose.scenario.section import Section
from nullpose.scenario.toml_text import toml_text
from nullpose.scenario.wording import described

__all__ = ["Scenario"]


@dataclass(frozen=True, slots=True)
class _Members:
    """A list of nodes or jammers, as metadata of an annotated tuple."""

    key: str
    letter: str
    at_least: int

    def read(self, value: object) -> list[object]:
        """Returns the members, each with a name, or raises the fault that says what is wrong."""
        if isinstance(value, Mapping):
            raise rejection(f"got a table, must be a list: head each table with [[{self.key}]]")
        if not isinstance(value, list | tuple):
            raise rejection(f"got {described(value)}, must be a list of tables, each headed [[{self.key}]]")
        if len(value) < self.at_least:
            raise rejection(f"got an empty list, must have at least one; add a table headed [[{self.key}]]")
        return named(value, self.letter)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(self.read, handler(source))

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> JsonSchemaValue:
        members = handler(schema)
        return members | {"minItems": self.at_least} if self.at_least else members


class Scenario(Section):
    """Nodes, jammers, a receiver and an airspace, in one world frame: east, north, up (ENU), in metres.

    Args:
        name: a title for tables and figures; may be empty.
        airspace: where the vehicle may be.
        receiver: its noise, and the path gain at 1 m.
        nodes: the legitimate nodes, one or more.
        jammers: the jammers, none or more.

    Raises:
        ScenarioError: with every fault of the values together.
    """

    header: ClassVar[str] = "a table with the keys of a scenario file"

    name: Title = Field(
        default="",
        description="Title of the scenario, for tables and figures.",
        examples=["Harbour, north quay"],
    )
    airspace: Airspace = Field(description="A table headed [airspace]: where the vehicle may be, in metres.")
    receiver: Receiver = Field(
        description="A table headed [receiver]: noise power (W or dBm) and path gain at 1 m (dB, or from a "
        "frequency in Hz)."
    )
    nodes: Annotated[tuple[Node, ...], _Members("nodes", Node.letter, at_least=1)] = Field(
        description="Tables headed [[nodes]], one for each legitimate node; at least one."
    )
    jammers: Annotated[tuple[Jammer, ...], _Members("jammers", Jammer.letter, at_least=0)] = Field(
        default=(), description="Tables headed [[jammers]], one for each jammer; none if left out."
    )

    @classmethod
    def cross_faults(cls, data: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Returns the faults between several values of the raw scenario, as far as they can be judged."""
        return cross_faults(data)

    def to_toml(self) -> str:
        """Returns the text of a scenario file that loads as an equal scenario."""
        return toml_text(self.to_dict())

    @property
    def node_names(self) -> tuple[str, ...]:
        """Names of the nodes, in order."""
        return tuple(node.name for node in self.nodes)

    @property
    def jammer_names(self) -> tuple[str, ...]:
        """Names of the jammers, in order."""
        return tuple(jammer.name for jammer in self.jammers)

    @cached_property
    def node_positions_m(self) -> NDArray[np.float64]:
        """Positions of the nodes [m], (n_nodes, 3), read-only."""
        return read_only([node.position_m for node in self.nodes], (-1, 3))

    @cached_property
    def node_powers_w(self) -> NDArray[np.float64]:
        """Transmit powers of the nodes [W], (n_nodes,), read-only."""
        return read_only([node.transmit_power_w for node in self.nodes], (-1,))

    @cached_property
    def jammer_positions_m(self) -> NDArray[np.float64]:
        """Positions of the jammers [m], (n_jammers, 3), read-only."""
        return read_only([jammer.position_m for jammer in self.jammers], (-1, 3))

    @cached_property
    def jammer_powers_w(self) -> NDArray[np.float64]:
        """Transmit powers of the jammers [W], (n_jammers,), read-only."""
        return read_only([jammer.transmit_power_w for jammer in self.jammers], (-1,))
