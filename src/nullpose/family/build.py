"""From a scenario to its family: where names and units end."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.family.airspace import airspace_zones
from nullpose.family.ratios import Family, FloatArray
from nullpose.scenario import Scenario

__all__ = ["LOUDEST", "build_family", "domain_of"]

LOUDEST = 1e16
"""The largest ratio of an interferer's power to the noise, without a null, that is solved."""


def build_family(scenario: Scenario) -> Family:
    """Return the family whose smallest ratio is what the scenario asks to be maximised.

    SINR: ``N_k = (g0 P_k / (sigma^2 Gamma_k)) T(s_k - p)`` and, shared by all, ``D = I + sum_j (g0 J_j /
    sigma^2) T(m_j - p)``: paper eq. 2.1 divided through by the noise and by the node's weight or required
    SINR. Secrecy: one ratio for each node and eavesdropper, ``N = I + (g0 P / sigma_k^2) T(s_k - p)`` over
    ``D = I + (g0 P / sigma_e^2) T(e_e - p)``, which is two to the power of the rate.

    Args:
        scenario: what is stated.

    Raises:
        ScenarioError: a jammer or an eavesdropper's signal is too strong for floating-point numbers.
    """
    ratios = _secrecy_ratios(scenario) if scenario.objective == "secrecy-rate" else _sinr_ratios(scenario)
    family = Family(**ratios, **domain_of(scenario, ratios["points_m"]))
    _refuse_the_loudest(scenario, family)
    return family


def _refuse_the_loudest(scenario: Scenario, family: Family) -> None:
    """Raise a ScenarioError if doubles cannot tell an interferer's null from the noise."""
    points = family.points_m[family.denominator_point]
    away = np.linalg.norm(points - np.clip(points, family.low_m, family.high_m), axis=1)
    over_noise = family.denominator_weight / np.maximum(away, family.keep_out_m) ** 2
    if not np.any(over_noise > LOUDEST):
        return
    index = int(np.argmax(over_noise))
    path = f"eavesdroppers[{index}]"
    if scenario.objective != "secrecy-rate":
        key = "power_w" if scenario.jammers[index].power_w is not None else "power_dbm"
        path = f"jammers[{index}].{key}"
    message = (
        f"got a signal {10.0 * np.log10(over_noise[index]):.0f} dB over the noise at the closest allowed "
        f"position, must be at most {10.0 * np.log10(LOUDEST):.0f} dB: beyond that rounding fills the null; "
        "make the transmit power smaller, the noise greater or the distance longer"
    )
    raise ScenarioError([Fault(path, message)])


def _sinr_ratios(scenario: Scenario) -> dict[str, Any]:
    n_nodes, n_jammers = len(scenario.nodes), len(scenario.jammers)
    scale = scenario.receiver.reference_gain / scenario.receiver.noise_power_w  # 1/W, per m^-2
    return {
        "points_m": np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)]),
        "numerator_isotropic": np.zeros(n_nodes),
        "numerator_weight": scale * scenario.node_powers_w / scenario.node_required_sinr,
        "numerator_point": np.arange(n_nodes, dtype=np.int64),
        "denominator_of": np.zeros(n_nodes, dtype=np.int64),
        "denominator_isotropic": np.ones(1),
        "denominator_start": np.array([0, n_jammers], dtype=np.int64),
        "denominator_point": np.arange(n_nodes, n_nodes + n_jammers, dtype=np.int64),
        "denominator_weight": scale * scenario.jammer_powers_w,
    }


def _secrecy_ratios(scenario: Scenario) -> dict[str, Any]:
    assert scenario.transmitter is not None, "validation lets no secrecy rate through without it"
    n_nodes, n_ears = len(scenario.nodes), len(scenario.eavesdroppers)
    sent = scenario.receiver.reference_gain * scenario.transmitter.transmit_power_w
    node, ear = np.divmod(np.arange(n_nodes * n_ears), n_ears)
    positions = (
        scenario.node_positions_m,
        scenario.eavesdropper_positions_m,
        scenario.jammer_positions_m.reshape(-1, 3),  # in no ratio, but to be kept clear of
    )
    return {
        "points_m": np.vstack(positions),
        "numerator_isotropic": np.ones(len(node)),
        "numerator_weight": (sent / scenario.node_noise_w)[node],
        "numerator_point": node.astype(np.int64),
        "denominator_of": ear.astype(np.int64),
        "denominator_isotropic": np.ones(n_ears),
        "denominator_start": np.arange(n_ears + 1, dtype=np.int64),
        "denominator_point": np.arange(n_nodes, n_nodes + n_ears, dtype=np.int64),
        "denominator_weight": sent / scenario.eavesdropper_noise_w,
    }


def domain_of(scenario: Scenario, points_m: FloatArray) -> dict[str, Any]:
    """Return the fields of a family that say where its positions may be.

    Args:
        scenario: with its airspace.
        points_m: the points that are to be kept clear of, (m, 3), metres.
    """
    airspace = scenario.airspace
    low_m, high_m = np.array(airspace.lower_m), np.array(airspace.upper_m)
    outline = airspace.geofence_outline_m
    if len(outline):
        low_m[:2] = np.maximum(low_m[:2], outline.min(axis=0))
        high_m[:2] = np.minimum(high_m[:2], outline.max(axis=0))
    zones = airspace_zones(airspace)
    return {
        "low_m": low_m,
        "high_m": high_m,
        "keep_out_points_m": reachable_points(points_m, low_m, high_m, airspace.keep_out_m),
        "keep_out_m": float(airspace.keep_out_m),
        **{name: getattr(zones, name) for name in zones.__slots__},
    }


def reachable_points(
    points_m: FloatArray, low_m: FloatArray, high_m: FloatArray, radius_m: float
) -> FloatArray:
    """Return the points, shape (q, 3), whose keep-out ball reaches into the airspace."""
    nearest = np.clip(points_m, low_m, high_m)
    return np.asarray(points_m[np.linalg.norm(points_m - nearest, axis=1) < radius_m])
