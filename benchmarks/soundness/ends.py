"""Random scenes with numbers at the ends of what a scenario may state, and poses that must not be better."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from nullpose.scenario import Scenario

Table = dict[str, Any]

_LOSSES_DB = (0.0, 0.5, 20.0, 60.0, 100.0, 120.0, 150.0, 165.0, 200.0)
_EXPONENTS = (1.6, 2.0 - 1e-9, 2.0 + 1e-9, 6.0)
_HAIRS_DEG = (1e-9, 1e-6, 1e-4, 1e-3)


def channel_ends(rng: np.random.Generator) -> Table:
    """Return a channel with losses up to 200 dB and the steepest and flattest curves, or the end of a law."""
    if rng.uniform() < 0.25:
        exponent = float(rng.choice(_EXPONENTS))
        return {
            "model": "power-law",
            "exponent": exponent,
            "reference_distance_m": float(rng.choice([1e-3, 0.9])),
        }
    seen = float(rng.choice(_LOSSES_DB[:4])) if rng.uniform() < 0.3 else 0.0
    return {
        "model": "elevation",
        "average": str(rng.choice(["power", "power", "power", "db"])),
        "a": float(rng.choice([0.1, 90.0, rng.uniform(0.1, 90.0), 70.0])),
        "b": float(rng.choice([1e-3, 5.0, 10.0 ** rng.uniform(-3.0, 0.7), 1.0])),
        "los_loss_db": seen,
        "nlos_loss_db": max(seen, float(rng.choice(_LOSSES_DB))),
    } | (
        {}
        if rng.uniform() < 0.7
        else {"exponent": float(rng.choice(_EXPONENTS)), "reference_distance_m": 0.9}
    )


def quiet(rng: np.random.Generator, table: Table) -> Table:
    """Return a scene whose noise is as weak as its links may be, or less so."""
    lost = [table.get("channel", {}).get("nlos_loss_db", 0.0), *[0.0] * 2]
    table["receiver"]["noise_w"] = float(
        np.clip(10.0 ** (-3.0 - 0.1 * rng.uniform(0.0, 1.0) * rng.choice(lost)), 1e-17, 1.0)
    )
    for listener in table.get("eavesdroppers", []):
        listener["noise_w"] = table["receiver"]["noise_w"] * float(10.0 ** rng.uniform(-0.5, 0.5))
    return table


def narrow_airframe(rng: np.random.Generator) -> Table:
    """Return an airframe that tilts by a hair, or whose mount is a hair off 0 or 90 degrees."""
    tilt = float(10.0 ** rng.uniform(-5.0, -1.3))
    hair = float(rng.choice(_HAIRS_DEG))
    mount = float(rng.choice([10.0, 45.0, rng.uniform(0.0, 90.0), hair, 90.0 - hair, 0.0, 90.0]))
    return {"tilt_max_deg": float(rng.choice([tilt, tilt, tilt, 0.0, 1.0])), "mount_deg": mount}


def with_depths(rng: np.random.Generator, table: Table) -> Table:
    """Return a scene with nulls of any depth on the drone and on the ground, of dipoles turned anyhow."""
    depths_db = (0.0, 1e-3, 3.0, 60.0, 120.0, 200.0)
    if rng.uniform() < 0.6:
        table["antenna"] = {"null_depth_db": float(rng.choice(depths_db))}
    for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
        if rng.uniform() < 0.6:
            point["antenna"] = "dipole"
            point["antenna_axis"] = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], rng.normal(size=3).tolist()][
                int(rng.integers(3))
            ]
            if rng.uniform() < 0.6:
                point["null_depth_db"] = float(rng.choice(depths_db))
    return table


def rescaled(rng: np.random.Generator, table: Table) -> Table:
    """Return a scene of centimetres or of hundreds of kilometres, as strong at the drone."""
    scale = float(10.0 ** rng.uniform(-1.0, 4.0))
    for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
        point["position_m"] = [scale * x for x in point["position_m"]]
    airspace = table["airspace"]
    airspace["altitude_m"] = [scale * z for z in airspace["altitude_m"]]
    airspace["keep_out_m"] = scale
    table["receiver"]["noise_w"] /= scale**2
    for listener in table.get("eavesdroppers", []):
        listener["noise_w"] /= scale**2
    return table


def subsets_of(scenario: Scenario, scheme: str) -> Iterator[tuple[str, Scenario, str]]:
    """Yield what can only be worse than a scheme's answer: its words, and a scenario and scheme to solve."""
    airframe = scenario.airframe
    if scenario.array is not None:
        if scenario.array.elements == 1:
            yield "of the vertical dipole", scenario.without_array, "vertical"
        return
    if scheme != "optimum":
        return
    for share in (0.0, 0.1):
        if airframe is not None and airframe.tilt_max_rad > 0.0:
            tilt_deg = float(share * np.degrees(airframe.tilt_max_rad))
            less = airframe.model_copy(update={"preset": None, "tilt_max_deg": tilt_deg})
            yield f"with {tilt_deg!r} degrees of tilt", scenario.model_copy(update={"airframe": less}), scheme
    if scenario.antenna_record.is_quadratic and scenario.axis_band[1] == 1.0:
        yield "of the vertical dipole", scenario, "vertical"
