"""From a scenario to its family: where names and units end."""

from __future__ import annotations

from typing import Any

import numpy as np

from nullpose.errors import Fault, ScenarioError
from nullpose.family.airspace import airspace_zones
from nullpose.family.family import Family
from nullpose.objectives import FloatArray
from nullpose.scenario import Scenario

LOUDEST = 1e16
"""The largest ratio of an interferer's power to the noise, without a null, that is solved."""


def build_family(scenario: Scenario) -> Family:
    """Return the family whose smallest ratio is what the scenario asks to be maximised.

    The objective's record says which ratios these are (:mod:`nullpose.objectives`).

    Args:
        scenario: what is stated.

    Raises:
        ScenarioError: a jammer or an eavesdropper's signal is too strong for floating-point numbers.
    """
    ratios = scenario.objective_record.ratios(scenario)
    ratios = ratios._replace(leak=scenario.antenna_record.leak)
    family = Family(**ratios._asdict(), **domain_of(scenario, ratios.points_m))
    _refuse_the_loudest(scenario, family)
    return family


def _refuse_the_loudest(scenario: Scenario, family: Family) -> None:
    """Raise a ScenarioError if doubles cannot tell an interferer's null from the noise."""
    points = family.points_m[family.denominator_point]
    away = np.linalg.norm(points - np.clip(points, family.low_m, family.high_m), axis=1)
    over_noise = family.denominator_weight / np.maximum(away, family.keep_out_m) ** 2
    if not np.any(over_noise > LOUDEST):
        return
    index = int(family.denominator_point[np.argmax(over_noise)]) - len(scenario.nodes)
    record = scenario.objective_record
    path = f"{record.interferers}[{index}]"
    if not record.transmits:
        key = "power_w" if scenario.jammers[index].power_w is not None else "power_dbm"
        path = f"{path}.{key}"
    message = (
        f"got a signal {10.0 * np.log10(over_noise[index]):.0f} dB over the noise at the closest allowed "
        f"position, must be at most {10.0 * np.log10(LOUDEST):.0f} dB: beyond that rounding fills the null; "
        "make the transmit power smaller, the noise greater or the distance longer"
    )
    raise ScenarioError([Fault(path, message)])


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
    return {
        "low_m": low_m,
        "high_m": high_m,
        "keep_out_points_m": reachable_points(points_m, low_m, high_m, airspace.keep_out_m),
        "keep_out_m": float(airspace.keep_out_m),
        **airspace_zones(airspace),
    }


def reachable_points(
    points_m: FloatArray, low_m: FloatArray, high_m: FloatArray, radius_m: float
) -> FloatArray:
    """Return the points, shape (q, 3), whose keep-out ball reaches into the airspace."""
    nearest = np.clip(points_m, low_m, high_m)
    return np.asarray(points_m[np.linalg.norm(points_m - nearest, axis=1) < radius_m])
