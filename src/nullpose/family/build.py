"""From a scenario to its family: where names and units end."""

from __future__ import annotations

import numpy as np

from nullpose.family.ratios import Family, FloatArray
from nullpose.scenario import Scenario

__all__ = ["build_family"]


def build_family(scenario: Scenario) -> Family:
    """Return the family whose ratios are the SINRs of the scenario's nodes.

    ``N_k = (g0 P_k / sigma^2) T(s_k - p)`` and, shared by all, ``D = I + sum_j (g0 J_j / sigma^2) T(m_j -
    p)``: paper eq. 2.1 divided through by the noise.

    Args:
        scenario: nodes, jammers, receiver and airspace.
    """
    n_nodes = len(scenario.nodes)
    n_jammers = len(scenario.jammers)
    scale = scenario.receiver.reference_gain / scenario.receiver.noise_power_w  # 1/W, per m^-2
    points_m = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
    airspace = scenario.airspace
    unbounded = (-np.inf, np.inf)
    ranges = np.array(
        [airspace.x_m or unbounded, airspace.y_m or unbounded, airspace.altitude_m], dtype=float
    )
    low_m, high_m = ranges[:, 0], ranges[:, 1]
    return Family(
        points_m=points_m,
        numerator_isotropic=np.zeros(n_nodes),
        numerator_weight=scale * scenario.node_powers_w,
        numerator_point=np.arange(n_nodes, dtype=np.int64),
        denominator_of=np.zeros(n_nodes, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.array([0, n_jammers], dtype=np.int64),
        denominator_point=np.arange(n_nodes, n_nodes + n_jammers, dtype=np.int64),
        denominator_weight=scale * scenario.jammer_powers_w,
        low_m=low_m,
        high_m=high_m,
        keep_out_points_m=reachable_points(points_m, low_m, high_m, airspace.keep_out_m),
        keep_out_m=float(airspace.keep_out_m),
    )


def reachable_points(
    points_m: FloatArray, low_m: FloatArray, high_m: FloatArray, radius_m: float
) -> FloatArray:
    """Return the points, shape (q, 3), whose keep-out ball reaches into the airspace."""
    nearest = np.clip(points_m, low_m, high_m)
    return np.asarray(points_m[np.linalg.norm(points_m - nearest, axis=1) < radius_m])
