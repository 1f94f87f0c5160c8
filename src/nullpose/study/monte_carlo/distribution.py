"""A number that may be drawn: fixed, or by one of a few distributions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Self, get_args

import numpy as np
from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from nullpose.physics.types import FloatArray
from nullpose.scenario.faults import collected
from nullpose.scenario.rules import MOST_MEMBERS, Limits, ListOf, Rule
from nullpose.scenario.section import Section, optional
from nullpose.scenario.ways import Ways, exactly_one
from nullpose.scenario.wording import plain

_Number = Annotated[float, Limits("a number", -1e30, 1e30, "in the unit that the key ends in")]
_Two = tuple[_Number, _Number]
_Ends = Annotated[_Two, ListOf("a list of two numbers, the lower first", 2, 2)]


class Distribution(Section):
    """How a number is drawn for each point of each scene.

    Args:
        fixed: the same for all; or else
        uniform: evenly between two numbers; or else
        log_uniform: its logarithm evenly between those of two numbers; or else
        normal: mean and standard deviation; or else
        choice: one of several numbers, each as likely.
    """

    header: ClassVar[str] = "a number, or a table such as { uniform = [0.5, 2.0] }"
    ways: ClassVar[tuple[Ways, ...]] = (exactly_one("fixed", "uniform", "log_uniform", "normal", "choice"),)

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
        if kind == "fixed":
            return np.full(count, numbers)
        if kind == "normal":
            mean, deviation = numbers
            return np.asarray(mean + deviation * generator.standard_normal(count))
        shares = generator.random(count)
        if kind == "choice":
            return np.asarray(np.array(numbers)[(shares * len(numbers)).astype(int)])
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
