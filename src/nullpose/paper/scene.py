"""The scenario of the paper's section 4, and the jamming levels at which it is studied."""

from __future__ import annotations

from nullpose.scenario import Scenario
from nullpose.study import spaced

JAMMER_POWER = "jammers.M.power_w"
"""The swept setting: with nodes of 1 W it equals the paper's ratio P_M/P."""

JAMMING_LEVELS = spaced(1e-3, 1e6, 109, log=True)
"""P_M/P of Figure 2, twelve to a decade."""

PRINTED_LEVELS = (*JAMMING_LEVELS[:48:3], *JAMMING_LEVELS[48::12])
"""P_M/P at which eq. 3.5 as printed is solved, for comparison: four to a decade up to 10, then one."""

POSE_LEVELS = (1e-2, 1.0, 1e2)
"""P_M/P of the pose figure: weak, medium and strong jamming."""


def paper_scenario() -> Scenario:
    """Return the paper's scenario: two nodes 50 m apart, one jammer, altitudes from 8 m to 30 m.

    Source: paper section 4, with unit transmission power, so that sigma^2 = 1 mW.
    """
    return Scenario.from_dict(
        {
            "name": "Bonilla Licea et al., ICASSP 2024, section 4",
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [
                {"name": "S1", "position_m": [0.0, 0.0, 0.0], "power_w": 1.0},
                {"name": "S2", "position_m": [0.0, 50.0, 0.0], "power_w": 1.0},
            ],
            "jammers": [{"name": "M", "position_m": [17.0, 15.0, 4.0], "power_w": 1.0}],
        }
    )
