"""Vertical orientation (paper section 4, case 4): an under-actuated vehicle hovering level."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.problem.schemes.record import SchemeRecord

if TYPE_CHECKING:
    from nullpose.problem.axis_field import AxisField
    from nullpose.scenario import Scenario


def _fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField]:
    from nullpose.problem.axis_field import AxisField

    return {"vertical": AxisField.vertical()}


VERTICAL = SchemeRecord(
    name="vertical",
    label="Vertical",
    short="vertical",
    sentence=lambda scenario, null_jammer: "with a vertical antenna",
    fields=_fields,
    reason_against=lambda scenario: (
        "the airframe does not reach a vertical antenna" if scenario.axis_band[1] < 1.0 else None
    ),
    any_objective=True,
    any_airframe=True,
)
