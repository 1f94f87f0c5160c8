"""Optimum pose (paper eq. 2.2): position and axis both free, the latter as far as the airframe reaches."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nullpose.problem.schemes.record import SchemeRecord

if TYPE_CHECKING:
    from nullpose.problem.axis_field import AxisField
    from nullpose.scenario import Scenario


def _fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField]:
    from nullpose.problem.axis_field import AxisField

    if not (field := AxisField.within(*scenario.axis_band)).is_free:
        return {"vertical": field}
    return {"free" if field.band == (0.0, 1.0) else "band": field}


def _sentence(scenario: Scenario, null_jammer: str | None) -> str:
    if (airframe := scenario.airframe) is None or airframe.is_omnidirectional:
        return "and no antenna axis"
    tilt, mount = math.degrees(airframe.tilt_max_rad), airframe.mount_deg
    return (
        f"and no antenna axis within the airframe's reach (tilt at most {tilt:.10g} degrees, dipole mounted "
        f"at {mount:.10g} degrees)"
    )


OPTIMUM = SchemeRecord(
    name="optimum",
    label="Optimum",
    short="optimum",
    sentence=_sentence,
    fields=_fields,
    any_objective=True,
    any_airframe=True,
    any_antenna=True,
)
