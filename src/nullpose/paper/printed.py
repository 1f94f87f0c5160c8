"""The paper's scene, and maximum gain as eq. 3.5 is printed: its cross product not normalised (Figure 2)."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics import to_db
from nullpose.physics.paper_schemes import direction_product
from nullpose.physics.types import FloatArray
from nullpose.problem.build import build_family
from nullpose.scenario import Override, Scenario, apply_overrides
from nullpose.solver.position_search import PositionSearch
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


class PrintedPoint(NamedTuple):
    """The best position found at a jamming power. Nothing is proved of it.

    Args:
        level: P_M/P, a power ratio.
        position_m: (3,) metres.
        min_sinr: the smaller of both nodes' ratios, a power ratio.
    """

    level: float
    position_m: FloatArray
    min_sinr: float

    @property
    def min_sinr_db(self) -> float:
        """The same, dB."""
        return float(to_db(self.min_sinr))


def sinr_as_printed(scenario: Scenario, position_m: ArrayLike) -> FloatArray:
    """Evaluate eq. 3.5 to the letter.

    ``Gamma_i = (P_i / d_i^2) / (sum_j (1 - <d_j, d_1 x d_2>^2) J_j / d_j^2 + sigma^2)``. The gain towards the
    jammer comes out too large unless the nodes are seen at right angles; no antenna receives this.

    Source: paper eq. 3.5, as printed.

    Args:
        scenario: a scenario with exactly two nodes, and the paper's antennas.
        position_m: the drone's position, shape ``(..., 3)``, metres.

    Returns:
        Array of shape ``(..., 2)``, ratios.

    Raises:
        ValueError: the scenario does not have two nodes.
    """
    p = np.asarray(position_m, dtype=float)
    product = direction_product(scenario, p)
    to_nodes = scenario.node_positions_m - p[..., None, :]
    to_jammers = scenario.jammer_positions_m - p[..., None, :]
    jammer_distance_sq = np.sum(to_jammers**2, axis=-1)  # m^2
    cosine_sq = np.sum(to_jammers * product[..., None, :], axis=-1) ** 2 / jammer_distance_sq
    g0 = scenario.reference_gain
    jamming_w = np.sum(g0 * (1.0 - cosine_sq) * scenario.jammer_powers_w / jammer_distance_sq, axis=-1)
    signal_w = g0 * scenario.node_powers_w / np.sum(to_nodes**2, axis=-1)
    return np.asarray(signal_w / (jamming_w[..., None] + scenario.receiver.noise_power_w))


def search_as_printed(scenario: Scenario, level: float, *, seed: int = 0) -> PrintedPoint:
    """Search the position with the largest smaller ratio by eq. 3.5 as printed, by values.

    Args:
        scenario: the paper's scenario, in any airspace.
        level: P_M/P, a power ratio.
        seed: of the coarse positions.
    """
    varied = apply_overrides(scenario, [Override(JAMMER_POWER, level)])

    def min_sinr(position_m: FloatArray) -> float:
        return float(np.min(sinr_as_printed(varied, position_m)))

    search = PositionSearch(lambda at_m: math.log(min_sinr(at_m)), build_family(varied), seed)
    search.search()
    return PrintedPoint(level, search.state, min_sinr(search.state))
