"""A channel of which some values are drawn anew for each scene."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from nullpose.channel import ENVIRONMENTS
from nullpose.errors import ScenarioError
from nullpose.files import PlainTable
from nullpose.scenario import Channel
from nullpose.scenario.channel import EnvironmentName
from nullpose.scenario.faults import Place
from nullpose.scenario.rules import MOST_MEMBERS, ByName, ListOf, Rule
from nullpose.scenario.section import Section
from nullpose.scenario.ways import Ways
from nullpose.study.monte_carlo.distribution import Distribution, Drawn


class Environments(Section):
    """Built-up areas of which each scene has one.

    Args:
        choice: their names, each as likely.
    """

    header: ClassVar[str] = 'an environment, or a table such as { choice = ["suburban", "urban"] }'

    choice: Annotated[
        tuple[EnvironmentName, ...], ListOf("a list of at least one environment", 1, MOST_MEMBERS)
    ] = Field(description="One of these, each as likely.", examples=[["suburban", "urban"]])

    def draw(self, generator: np.random.Generator, count: int) -> NDArray[np.str_]:
        """Draw names one after the other: the first few are the same for any count.

        Args:
            generator: where chance comes from.
            count: how many.
        """
        return np.asarray(np.array(self.choice)[(generator.random(count) * len(self.choice)).astype(int)])


_OR_NAME = ByName("an environment", {name: {"choice": [name]} for name in ENVIRONMENTS})


def _number(key: str) -> Drawn:
    return Drawn.of(Channel.model_fields[key].annotation)


def _key(key: str) -> Any:
    """Make the field of a key from that of a channel."""
    field = Channel.model_fields[key]
    return Field(default=field.default, description=field.description)


class DrawnChannel(Section):
    """The table ``[scene.channel]`` with a distribution where a number stands, or several environments.

    Args:
        model: as of :class:`nullpose.scenario.Channel`, like all other keys.
        exponent, reference_distance_m: numbers, or how they are drawn.
        environment: a name, or a choice of several.
        a, b, los_loss_db, nlos_loss_db: numbers, or how they are drawn.
        average: power, db or guaranteed.
        blocked_loss_db, shadow_margin_m: numbers, or how they are drawn.
    """

    ways: ClassVar[tuple[Ways, ...]] = Channel.ways

    model: str = _key("model")
    exponent: Annotated[Distribution, _number("exponent")] | None = _key("exponent")
    reference_distance_m: Annotated[Distribution, _number("reference_distance_m")] | None = _key(
        "reference_distance_m"
    )
    environment: Annotated[Environments, _OR_NAME] | None = _key("environment")
    a: Annotated[Distribution, _number("a")] | None = _key("a")
    b: Annotated[Distribution, _number("b")] | None = _key("b")
    los_loss_db: Annotated[Distribution, _number("los_loss_db")] | None = _key("los_loss_db")
    nlos_loss_db: Annotated[Distribution, _number("nlos_loss_db")] | None = _key("nlos_loss_db")
    average: str | None = _key("average")
    blocked_loss_db: Annotated[Distribution, _number("blocked_loss_db")] | None = _key("blocked_loss_db")
    shadow_margin_m: Annotated[Distribution, _number("shadow_margin_m")] | None = _key("shadow_margin_m")

    def faults(self, raw: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Yield the faults of a channel with the first number and name of each key."""
        firsts = {
            key: np.ravel(next(iter(each.to_dict().values()))).tolist()[0]
            for key, each in self._distributions
        }
        try:
            Channel.from_dict({"model": self.model, "average": self.average} | firsts)
        except ScenarioError as error:  # keys that exclude each other are told already
            yield from (((fault.path,), fault.message) for fault in error.faults if fault.path)

    def draw(self, chance: Callable[[str], np.random.Generator]) -> PlainTable:
        """Draw the channel of a scene, as plain data.

        Args:
            chance: gives the stream of each key.
        """
        return {"model": self.model, "average": self.average} | {
            key: each.draw(chance(key), 1).tolist()[0] for key, each in self._distributions
        }

    @property
    def _distributions(self) -> Iterable[tuple[str, Distribution | Environments]]:
        return ((key, each) for key, each in self if isinstance(each, Distribution | Environments))


class FixedOrDrawn(Rule):
    """A channel that is the same in all scenes, or one with a table in place of a value."""

    def read(self, value: object) -> Channel | DrawnChannel:
        """Choose between both by the values, and read it."""
        values = value.values() if isinstance(value, Mapping) else (value,)
        is_drawn = any(
            isinstance(each, Mapping | Distribution | Environments | DrawnChannel) for each in values
        )
        return (DrawnChannel if is_drawn else Channel).model_validate(value)
