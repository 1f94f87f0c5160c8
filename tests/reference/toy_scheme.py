"""A scheme made as CONTRIBUTING.md says: a dipole that always lies level, along the north."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.problem.schemes import SchemeRecord

if TYPE_CHECKING:
    from nullpose.problem.axis_field import AxisField
    from nullpose.scenario import Scenario


def _fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField]:
    import numpy as np

    from nullpose.problem.axis_field import AxisField

    return {"north": AxisField.affine([0.0, 1.0, 0.0], np.zeros((3, 3)))}


NORTHWARD = SchemeRecord(
    name="northward",
    label="Northward",
    short="north",
    sentence=lambda scenario, null_jammer: "with an antenna along the north",
    fields=_fields,
    any_objective=True,
)
