"""The record of a scheme, for everything that solves, checks, prints or draws it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from nullpose.problem.axis_field import AxisField
    from nullpose.scenario import Scenario


@dataclass(frozen=True, slots=True, kw_only=True)
class SchemeRecord:
    """One way to choose the pose.

    A scheme names the axis fields that it allows, and is proved over each of them. Where it names none, the
    axis serves the nodes best, the jammers ignored; it is searched by values, under the bound of a free axis.

    Args:
        name: as in a file or an option.
        label: for tables.
        short: for the narrowest legends.
        sentence: from a scenario and the jammer to be nulled: which axes a certificate speaks of, in words.
        fields: from a scenario and the jammer to be nulled: the axis fields by the names that they have in a
            certificate; None where the scheme names none.
        note: from a scenario, the names of the fields and the index of the best: a sentence for the solution.
        reason_against: from a scenario: why the scheme has no meaning there, or None.
        any_objective: whether it has a meaning for a drone that transmits.
        any_airframe: whether it has a meaning for a vehicle that does not reach every axis.
        any_antenna: whether it has a meaning for an antenna that is no dipole.
        nulls_a_jammer: whether the jammer to be nulled may be named.
        unproved: why it is not certified where it has no fields.
    """

    name: str
    label: str
    short: str
    sentence: Callable[[Scenario, str | None], str]
    fields: Callable[[Scenario, str | None], Mapping[str, AxisField] | None]
    note: Callable[[Scenario, tuple[str, ...], int], str] = field(default=lambda *_: "")
    reason_against: Callable[[Scenario], str | None] = field(default=lambda _: None)
    any_objective: bool = False
    any_airframe: bool = False
    any_antenna: bool = False
    nulls_a_jammer: bool = False
    unproved: str = ""

    def not_applicable(self, scenario: Scenario) -> str | None:
        """Say why the scheme has no meaning for a scenario; None if it has."""
        if scenario.objective_record.transmits and not self.any_objective:
            return "the paper states it for a drone that receives, and here it transmits"
        if scenario.axis_band != (0.0, 1.0) and not self.any_airframe:
            return "it may ask for any antenna axis, and the airframe does not reach every one"
        if not self.any_antenna and not scenario.antenna_record.is_quadratic:
            return "it is stated for a dipole, and the drone's antenna has another pattern"
        return self.reason_against(scenario)
