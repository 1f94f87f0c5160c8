"""Zero interference (paper eqs. 3.1 and 3.2): the null always on a jammer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.problem.schemes.record import SchemeRecord

if TYPE_CHECKING:
    from nullpose.problem.axis_field import AxisField
    from nullpose.scenario import Scenario

_FIELD = "null "  # before the jammer's name


def _fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField] | None:
    from nullpose.problem.axis_field import AxisField

    jammers = dict(zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True))
    names = jammers if null_jammer is None else [name for name in jammers if name == null_jammer]
    return {f"{_FIELD}{name}": AxisField.towards(jammers[name]) for name in names} or None


def _sentence(scenario: Scenario, null_jammer: str | None) -> str:
    who = "a jammer" if null_jammer is None else f"jammer {null_jammer}"
    return f"with an antenna whose null is on {who}"


def _note(scenario: Scenario, fields: tuple[str, ...], chosen: int) -> str:
    best_of = f", the best of {len(fields)}" if len(fields) > 1 else ""
    return f"null on jammer {fields[chosen].removeprefix(_FIELD)}{best_of}"


ZERO_INTERFERENCE = SchemeRecord(
    name="zero-interference",
    label="Zero interference",
    short="zero interf.",
    sentence=_sentence,
    fields=_fields,
    note=_note,
    reason_against=lambda scenario: (
        None
        if scenario.jammers
        else "zero interference needs a jammer to point its null at; the scenario has none"
    ),
    nulls_a_jammer=True,
)
