"""Maximum gain (paper eqs. 3.4 and 3.5): the dipole serves the nodes, the position the SINR.

For two nodes the axis is broadside to both. For another number it maximises the smallest received node
power, the jammers ignored; among several such axes, the one that receives least jamming is taken.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.problem.schemes.record import SchemeRecord

if TYPE_CHECKING:
    from nullpose.problem.axis_field import AxisField
    from nullpose.scenario import Scenario


def _fields(scenario: Scenario, null_jammer: str | None) -> dict[str, AxisField] | None:
    from nullpose.problem.axis_field import AxisField

    if len(scenario.terminals) != 2:
        return None
    return {"broadside": AxisField.broadside(*scenario.terminal_positions_m)}


def _note(scenario: Scenario, fields: tuple[str, ...], chosen: int) -> str:
    if fields:
        return ""
    return (
        f"{len(scenario.terminals)} node(s){' with the destination' * len(scenario.destinations)}, where eq. "
        "3.4 is for two: the axis maximises the smallest received node power, the jammers ignored"
    )


MAXIMUM_GAIN = SchemeRecord(
    name="maximum-gain",
    label="Maximum gain",
    short="max. gain",
    sentence=lambda scenario, null_jammer: "with an antenna broadside to both nodes",
    fields=_fields,
    note=_note,
    reason_against=lambda scenario: (
        None
        if scenario.objective_record.of_nodes is None or len(scenario.nodes) == 2
        else "with an objective that is a function in Python it is for two nodes"
    ),
    unproved="no proof of its own for other than two nodes: the bound is that of the optimum",
)
