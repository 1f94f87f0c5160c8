"""The schemes: the paper's four cases, what each states of itself, and how they are named.

Nothing heavy is imported here: the command line reads the names for its help.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TYPE_CHECKING

from nullpose.errors import UsageError, require_usage

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


def _axis_field() -> type[AxisField]:
    from nullpose.problem.axis_field import AxisField

    return AxisField


def _reached_fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField]:
    if not (reached := _axis_field().within(*scenario.axis_band)).is_free:
        return {"vertical": reached}
    return {"free" if reached.band == (0.0, 1.0) else "band": reached}


def _reached_sentence(scenario: Scenario, null_jammer: str | None) -> str:
    if (airframe := scenario.airframe) is None or airframe.is_omnidirectional:
        return "and no antenna axis"
    tilt, mount = math.degrees(airframe.tilt_max_rad), airframe.mount_deg
    return (
        f"and no antenna axis within the airframe's reach (tilt at most {tilt:.10g} degrees, dipole mounted "
        f"at {mount:.10g} degrees)"
    )


# Paper eq. 2.2: position and axis both free, the latter as far as the airframe reaches.
OPTIMUM = SchemeRecord(
    name="optimum",
    label="Optimum",
    short="optimum",
    sentence=_reached_sentence,
    fields=_reached_fields,
    any_objective=True,
    any_airframe=True,
    any_antenna=True,
)

_NULL = "null "  # before the jammer's name


def _null_fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField] | None:
    jammers = dict(zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True))
    names = jammers if null_jammer is None else [name for name in jammers if name == null_jammer]
    return {f"{_NULL}{name}": _axis_field().towards(jammers[name]) for name in names} or None


def _null_note(scenario: Scenario, fields: tuple[str, ...], chosen: int) -> str:
    best_of = f", the best of {len(fields)}" if len(fields) > 1 else ""
    return f"null on jammer {fields[chosen].removeprefix(_NULL)}{best_of}"


# Paper eqs. 3.1 and 3.2: the null always on a jammer.
ZERO_INTERFERENCE = SchemeRecord(
    name="zero-interference",
    label="Zero interference",
    short="zero interf.",
    sentence=lambda scenario, null_jammer: (
        f"with an antenna whose null is on {'a jammer' if null_jammer is None else f'jammer {null_jammer}'}"
    ),
    fields=_null_fields,
    note=_null_note,
    reason_against=lambda scenario: (
        None
        if scenario.jammers
        else "zero interference needs a jammer to point its null at; the scenario has none"
    ),
    nulls_a_jammer=True,
)


# Paper eqs. 3.4 and 3.5: the dipole serves the nodes, the position the SINR. For two nodes the axis is
# broadside to both. For another number it maximises the smallest received node power, the jammers ignored;
# among several such axes, the one that receives least jamming is taken.
MAXIMUM_GAIN = SchemeRecord(
    name="maximum-gain",
    label="Maximum gain",
    short="max. gain",
    sentence=lambda scenario, null_jammer: "with an antenna broadside to both nodes",
    fields=lambda scenario, null_jammer: (
        {"broadside": _axis_field().broadside(*scenario.terminal_positions_m)}
        if len(scenario.terminals) == 2
        else None
    ),
    note=lambda scenario, fields, chosen: (
        ""
        if fields
        else f"{len(scenario.terminals)} node(s){' with the destination' * len(scenario.destinations)}, "
        "where eq. 3.4 is for two: the axis maximises the smallest received node power, the jammers ignored"
    ),
    reason_against=lambda scenario: (
        None
        if scenario.objective_record.of_nodes is None or len(scenario.nodes) == 2
        else "with an objective that is a function in Python it is for two nodes"
    ),
    unproved="no proof of its own for other than two nodes: the bound is that of the optimum",
)


# Paper section 4, case 4: an under-actuated vehicle hovering level.
VERTICAL = SchemeRecord(
    name="vertical",
    label="Vertical",
    short="vertical",
    sentence=lambda scenario, null_jammer: "with a vertical antenna",
    fields=lambda scenario, null_jammer: {"vertical": _axis_field().vertical()},
    reason_against=lambda scenario: (
        "the airframe does not reach a vertical antenna" if scenario.axis_band[1] < 1.0 else None
    ),
    any_objective=True,
    any_airframe=True,
)

RECORDS = {record.name: record for record in (OPTIMUM, ZERO_INTERFERENCE, MAXIMUM_GAIN, VERTICAL)}


class Scheme(StrEnum):
    """How the pose is chosen (paper section 4). A new scheme is a record and a line here."""

    OPTIMUM = OPTIMUM.name
    ZERO_INTERFERENCE = ZERO_INTERFERENCE.name
    MAXIMUM_GAIN = MAXIMUM_GAIN.name
    VERTICAL = VERTICAL.name

    @property
    def record(self) -> SchemeRecord:
        """The record of the scheme."""
        return RECORDS[self.value]

    @property
    def label(self) -> str:
        """The scheme's name for tables and figures."""
        return self.record.label

    def not_applicable(self, scenario: Scenario) -> str | None:
        """Say why the scheme has no meaning for a scenario; None if it has."""
        return self.record.not_applicable(scenario)

    def require_applicable(self, scenario: Scenario) -> None:
        """Raise a UsageError if the scheme has no meaning for a scenario."""
        reason = self.not_applicable(scenario)
        require_usage(reason is None, f"scheme {self.value}: {reason}; try another scheme")


def as_scheme(name: str) -> Scheme:
    """Find the scheme of a name.

    Args:
        name: as in ``maximum-gain``.

    Raises:
        UsageError: there is no such scheme.
    """
    try:
        return Scheme(name)
    except ValueError:
        from nullpose.scenario.faults import suggestion  # here, for it loads numpy

        raise UsageError(
            f"scheme: given {name!r}; allowed: {', '.join(Scheme)}{suggestion(name, list(Scheme))}"
        ) from None
