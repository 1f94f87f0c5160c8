"""A number that may be drawn: fixed, or by one of a few distributions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from nullpose.scenario.faults import Place, collected, rejection
from nullpose.scenario.rules import Quantity
from nullpose.scenario.section import Section
from nullpose.scenario.ways import Ways, exactly_one
from nullpose.scenario.wording import described, plain

__all__ = ["Distribution", "Drawn"]

_NUMBER = Quantity("a number", -1e30, 1e30, "in the unit that the key ends in")


@dataclass(frozen=True, slots=True)
class _Numbers:
    """A list of numbers, as metadata of an annotated tuple.

    Args:
        size: how many; None for one or more.
        allowed: what the list is, in words.
    """

    size: int | None
    allowed: str

    def read(self, value: object) -> tuple[float, ...]:
        value = plain(value)
        fits = isinstance(value, list | tuple) and len(value) > 0
        if not isinstance(value, list | tuple) or not fits or (self.size or len(value)) != len(value):
            raise rejection(f"got {described(value)}, must be {self.allowed}")
        return tuple(_NUMBER.read(member) for member in value)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)


_Ends = Annotated[tuple[float, float], _Numbers(2, "a list of two numbers, the lower first")]
_Normal = Annotated[tuple[float, float], _Numbers(2, "a list of two numbers: mean and standard deviation")]
_Several = Annotated[tuple[float, ...], _Numbers(None, "a list of at least one number")]


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

    fixed: Annotated[float, _NUMBER] | None = Field(
        default=None, description="The same for all; a number in place of the table means this.", examples=[1]
    )
    uniform: _Ends | None = Field(
        default=None, description="Evenly between two numbers.", examples=[[0.5, 2.0]]
    )
    log_uniform: _Ends | None = Field(
        default=None,
        description="The logarithm evenly between those of two positive numbers.",
        examples=[[0.01, 100.0]],
    )
    normal: _Normal | None = Field(
        default=None,
        description="Mean and standard deviation; of a power in dBm, not in W.",
        examples=[[20.0, 6.0]],
    )
    choice: _Several | None = Field(
        default=None, description="One of these numbers, each as likely.", examples=[[0.1, 1.0, 10.0]]
    )

    def faults(self, stated: Mapping[str, object]) -> Iterable[tuple[Place, str]]:
        """Returns the fault that the two numbers of a range are none."""
        for key in ("uniform", "log_uniform"):
            ends = getattr(self, key)
            if ends is not None and not ends[0] < ends[1]:
                yield (key,), f"got {list(ends)}, must be two numbers, the lower first"
            elif ends is not None and key == "log_uniform" and ends[0] <= 0.0:
                yield (key,), f"got a lower end of {ends[0]!r}, must be above 0, as its logarithm is taken"

    @property
    def values(self) -> tuple[float, ...]:
        """The numbers that say how far it reaches: all that are drawn lie between them, but for a normal."""
        if self.fixed is not None:
            return (self.fixed,)
        return self.uniform or self.log_uniform or self.choice or ()

    def draw(self, generator: np.random.Generator, count: int) -> NDArray[np.float64]:
        """Return numbers drawn one after the other: the first few are the same for any count.

        Args:
            generator: where chance comes from.
            count: how many.
        """
        if self.fixed is not None:
            return np.full(count, self.fixed)
        if self.normal is not None:
            mean, deviation = self.normal
            return mean + deviation * generator.standard_normal(count)
        shares = generator.random(count)
        if self.choice is not None:
            return np.array([self.choice[int(share * len(self.choice))] for share in shares])
        if self.log_uniform is not None:
            low, high = np.log(self.log_uniform)
            return np.asarray(np.clip(np.exp(low + (high - low) * shares), *self.log_uniform))
        assert self.uniform is not None, "validation lets exactly one of the keys through"
        low, high = self.uniform
        return np.asarray(low + (high - low) * shares)


@dataclass(frozen=True, slots=True)
class Drawn:
    """A quantity that is fixed or drawn, as metadata of an annotated Distribution.

    Args:
        quantity: its unit and limits.
    """

    quantity: Quantity

    def read(self, value: object) -> Distribution:
        """Returns the distribution, or raises the faults that say what is wrong with it."""
        value = plain(value)
        if not isinstance(value, Mapping | Distribution):
            return Distribution(fixed=self.quantity.read(value))
        drawn = Distribution.model_validate(value)
        if drawn.normal is not None and self.quantity.low >= 0.0:
            message = (
                f"a normal distribution falls below what is allowed, {self.quantity.allowed}; use uniform or "
                "log_uniform, or for a power the key that ends in _dbm"
            )
            raise collected("", [(("normal",), message)])
        if drawn.normal is not None and drawn.normal[1] < 0.0:
            raise collected("", [(("normal",), "the standard deviation is below 0; it must be 0 or more")])
        key = next(iter(drawn.to_dict()))
        wrong = [each for each in drawn.values if not self.quantity.low <= each <= self.quantity.high]
        if wrong:
            message = f"got {wrong[0]!r}, must be {self.quantity.allowed} ({self.quantity.hint})"
            raise collected("", [((key,), message)])
        return drawn

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)
