"""Maximum gain as printed (paper eq. 3.5 with its unnormalised cross product), for comparison only."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nullpose.schemes.record import Curve, SchemeRecord

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from nullpose.scenario import Scenario

    FloatArray = NDArray[np.float64]


def _ratios_at(scenario: Scenario, position_m: FloatArray) -> FloatArray:
    from nullpose.physics import maximum_gain_sinr_as_printed

    return maximum_gain_sinr_as_printed(scenario, position_m)


def _axis_at(scenario: Scenario, position_m: FloatArray) -> FloatArray:
    import numpy as np

    first_m, second_m = scenario.node_positions_m - position_m
    axis = np.cross(first_m, second_m)
    if np.linalg.norm(axis) > 1e-9 * np.linalg.norm(first_m) * np.linalg.norm(second_m):
        return axis
    # in line with both nodes eq. 3.4 names no axis: any across the line is broadside to both
    return np.cross(first_m, np.eye(3)[np.argmin(np.abs(first_m))])


def _reason_against(scenario: Scenario) -> str | None:
    if scenario.has_margins:
        return "eq. 3.5 as printed knows no weights or requirements"
    if scenario.states_antennas or scenario.source_antennas is not None:
        return "eq. 3.5 as printed knows the paper's antennas only"
    if len(scenario.nodes) != 2:
        return f"eq. 3.5 as printed is for two nodes; the scenario has {len(scenario.nodes)}"
    return None


MAXIMUM_GAIN_PRINTED = SchemeRecord(
    name="maximum-gain-printed",
    label="Maximum gain, as printed",
    short="as printed",
    curve=Curve("maximum gain, eq. 3.5 as printed", "#9a6060", (0, (1.2, 1.8)), "", 1.6, 2.0),
    sentence=lambda scenario, null_jammer: "",
    fields=lambda scenario, null_jammer: None,
    note=lambda scenario, fields, chosen: (
        "the value is that of eq. 3.5 as printed, whose axis is not a unit vector: no antenna receives it"
    ),
    reason_against=_reason_against,
    axis_at=_axis_at,
    ratios_at=_ratios_at,
    unproved="eq. 3.5 as printed is no antenna's, and nothing is proved of it",
)
