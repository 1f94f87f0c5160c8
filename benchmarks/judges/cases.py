"""Scenes in the open and poses that the ray tracer is asked about."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from nullpose import Pose, Scenario, solve
from nullpose.antenna.files import read_pattern
from nullpose.antenna.pattern import table_harmonics

_TABLE = Path(__file__).parents[2] / "tests" / "antenna" / "data" / "hex35_above_10_half_off20mm_5deg.out.gz"
_SCENES = 10  # of each kind, with four random poses each
_POSES = 4
_SOLVED = 2  # of each kind


def table_of(
    rng: np.random.Generator, places_m: np.ndarray, antenna: Callable[[], dict[str, Any]]
) -> list[dict[str, Any]]:
    """Draw the powers and antennas of ground points."""
    powers_w = 10.0 ** rng.uniform(-1.0, 1.0, len(places_m))
    return [
        {"position_m": place_m.tolist(), "power_w": float(power_w)} | antenna()
        for place_m, power_w in zip(places_m, powers_w, strict=True)
    ]


def _places_m(rng: np.random.Generator, fewest: int, most: int) -> np.ndarray:
    count = int(rng.integers(fewest, most + 1))
    return rng.uniform([-40.0, -40.0, 0.0], [40.0, 40.0, 3.0], (count, 3))


def kinds(rng: np.random.Generator) -> dict[str, tuple[dict[str, Any] | None, Any, Any]]:
    """Return the drone's antenna, and what makes a node's and a jammer's, by what is compared."""
    rows = table_harmonics(read_pattern(_TABLE)).rows()

    def whip() -> dict[str, Any]:
        tilted = {"antenna_axis": rng.normal(size=3).tolist()} if rng.integers(2) else {}
        return {"antenna": "dipole"} | tilted

    isotropic, circular = dict[str, Any], lambda: {"antenna": "circular"}
    return {
        "SINR, isotropic ground": (None, isotropic, isotropic),
        "SINR, circular ground": (None, circular, circular),
        "SINR, upright and tilted dipoles on the ground": (None, whip, whip),
        "SINR, half-wave dipole": ({"kind": "half-wave"}, isotropic, circular),
        "SINR, a table of nec2c": ({"kind": "pattern", "harmonics": rows}, isotropic, isotropic),
    }


def cases(seed: int = 1) -> Iterator[tuple[str, Scenario, list[Pose]]]:
    """Yield what is compared, a scene and poses in it: random ones, and certified optima."""
    rng = np.random.default_rng(seed)
    for name, (antenna, node, jammer) in kinds(rng).items():
        for scene in range(_SCENES):
            data: dict[str, Any] = {
                "nodes": table_of(rng, _places_m(rng, 2, 6), node),
                "jammers": table_of(rng, _places_m(rng, 1, 3), jammer),
                "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
                "airspace": {"altitude_m": [8.0, 30.0]},
            }
            scenario = Scenario.from_dict(data | ({} if antenna is None else {"antenna": antenna}))
            poses = [
                Pose(rng.uniform([-30.0, -30.0, 8.0], [30.0, 30.0, 30.0]), *rng.uniform(-np.pi, np.pi, 3))
                for _ in range(_POSES)
            ]
            if scene < _SOLVED:
                poses.append(solve(scenario, gap=0.1, time_limit_s=20.0).pose)
            yield name, scenario, poses
