"""Numbers that may be drawn, each fixed or by one of a few distributions, and a channel of such numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, GetCoreSchemaHandler, create_model
from pydantic_core import CoreSchema, core_schema

from nullpose.channel import ENVIRONMENTS
from nullpose.errors import ScenarioError
from nullpose.files import PlainTable
from nullpose.physics.types import FloatArray
from nullpose.scenario import Channel
from nullpose.scenario.channel import EnvironmentName
from nullpose.scenario.faults import Place, collected, plain
from nullpose.scenario.rules import MOST_MEMBERS, ByName, Limits, ListOf, Rule
from nullpose.scenario.section import Section, optional
from nullpose.scenario.ways import exactly_one

_Number = Annotated[float, Limits("a number", -1e30, 1e30, "in the unit that the key ends in")]
_Two = tuple[_Number, _Number]
_Ends = Annotated[_Two, ListOf("a list of two numbers, the lower first", 2, 2)]


class Distribution(
    Section,
    header="a number, or a table such as { uniform = [0.5, 2.0] }",
    ways=(exactly_one("fixed", "uniform", "log_uniform", "normal", "choice"),),
):
    """How a number is drawn for each point of each scene.

    Args:
        fixed: the same for all; or else
        uniform: evenly between two numbers; or else
        log_uniform: its logarithm evenly between those of two numbers; or else
        normal: mean and standard deviation; or else
        choice: one of several numbers, each as likely.
    """

    fixed: _Number | None = optional("The same for all; a number in place of the table means this.", 1)
    uniform: _Ends | None = optional("Evenly between two numbers.", [0.5, 2.0])
    log_uniform: _Ends | None = optional(
        "The logarithm evenly between those of two positive numbers.", [0.01, 100.0]
    )
    normal: Annotated[_Two, ListOf("a list of two numbers: mean and standard deviation", 2, 2)] | None = (
        optional("Mean and standard deviation; of a power in dBm, not in W.", [20.0, 6.0])
    )
    choice: (
        Annotated[tuple[_Number, ...], ListOf("a list of at least one number", 1, MOST_MEMBERS)] | None
    ) = optional("One of these numbers, each as likely.", [0.1, 1.0, 10.0])

    def draw(self, generator: np.random.Generator, count: int) -> FloatArray:
        """Return numbers drawn one after the other: the first few are the same for any count.

        Args:
            generator: where chance comes from.
            count: how many.
        """
        ((kind, numbers),) = self.to_dict().items()
        if kind == "normal":
            return np.asarray(numbers[0] + numbers[1] * generator.standard_normal(count))
        shares = generator.random(count)
        if kind in ("fixed", "choice"):
            return np.asarray(np.ravel(numbers)[(shares * np.size(numbers)).astype(int)], dtype=np.float64)
        low, high = numbers if kind == "uniform" else np.log(numbers)
        drawn = np.asarray(low + (high - low) * shares)
        return drawn if kind == "uniform" else np.clip(np.exp(drawn), *numbers)


@dataclass(frozen=True, slots=True)
class Drawn(Rule):
    """A quantity that is fixed or drawn, as the metadata of an annotated Distribution.

    Args:
        quantity: its unit and limits.
    """

    quantity: Limits

    @classmethod
    def of(cls, kind: object) -> Self:
        """Make the rule from the type of a fixed quantity.

        Args:
            kind: an annotated float, or that or None.
        """
        inner = [*get_args(kind), *(each for part in get_args(kind) for each in get_args(part))]
        return cls(next(each for each in inner if isinstance(each, Limits)))

    def read(self, value: object) -> object:
        """Make the distribution of a number; leave the raw table of one."""
        if isinstance(value := plain(value), Mapping | Distribution):
            return value
        return Distribution(fixed=self.quantity.read(value))

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_after_validator_function(
            self._sound, Rule.__get_pydantic_core_schema__(self, source, handler)
        )

    def _sound(self, value: Distribution) -> Distribution:
        """Refuse a distribution that draws a number which is not allowed."""
        ((key, numbers),) = value.to_dict().items()
        message = (
            self._normal_fault(numbers[1]) if key == "normal" else self._fault(key, np.atleast_1d(numbers))
        )
        if message:
            raise collected("", [((key,), message)])
        return value

    def _fault(self, key: str, numbers: FloatArray) -> str:
        """Describe the fault of the numbers that bound all drawn ones; empty without a fault."""
        wrong = [each for each in numbers.tolist() if not self.quantity.low <= each <= self.quantity.high]
        if key in ("uniform", "log_uniform") and not numbers[0] < numbers[1]:
            return f"got {numbers.tolist()}, must be two numbers, the lower first"
        if key == "log_uniform" and numbers[0] <= 0.0:
            return f"got a lower end of {float(numbers[0])!r}, must be above 0, as its logarithm is taken"
        return f"got {wrong[0]!r}, must be {self.quantity.allowed} ({self.quantity.hint})" if wrong else ""

    def _normal_fault(self, deviation: float) -> str:
        if self.quantity.low >= 0.0:
            return (
                f"a normal distribution falls below what is allowed, {self.quantity.allowed}; use uniform or "
                "log_uniform, or for a power the key that ends in _dbm"
            )
        return "the standard deviation is below 0; it must be 0 or more" if deviation < 0.0 else ""


class Environments(Section, header='an environment, or a table such as { choice = ["suburban", "urban"] }'):
    """Built-up areas of which each scene has one.

    Args:
        choice: their names, each as likely.
    """

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


class DrawnChannel(Section, ways=Channel.ways):
    """The table ``[scene.channel]`` with a distribution where a number stands, or several environments.

    It has the keys of :class:`nullpose.scenario.Channel`; those of numbers are added below.
    """

    model: str = Channel.model_fields["model"].default
    average: str | None = None
    environment: Annotated[Environments, _OR_NAME] | None = None

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


_NUMBERS: dict[str, Any] = {
    key: (Annotated[Distribution, Drawn.of(field.annotation)] | None, None)
    for key, field in Channel.model_fields.items()
    if key not in DrawnChannel.model_fields
}
_WithNumbers = create_model("DrawnChannel", __base__=DrawnChannel, **_NUMBERS)


class FixedOrDrawn(Rule):
    """A channel that is the same in all scenes, or one with a table in place of a value."""

    def read(self, value: object) -> Channel | DrawnChannel:
        """Choose between both by the values, and read it."""
        values = value.values() if isinstance(value, Mapping) else (value,)
        is_drawn = any(
            isinstance(each, Mapping | Distribution | Environments | DrawnChannel) for each in values
        )
        return (_WithNumbers if is_drawn else Channel).model_validate(value)
