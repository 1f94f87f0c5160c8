"""Random scenes for each thing that a scenario can ask for beyond the paper, made from their number alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.soundness.scenes import Scene
from nullpose.scenario import Scenario

__all__ = ["FEATURES", "make_feature_scene"]

FloatArray = NDArray[np.float64]
Table = dict[str, Any]

_NOISE_W = 1e-3


def _plain(rng: np.random.Generator) -> Table:
    """A field of 60 m with two to five nodes and up to two jammers."""
    nodes = rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(2, 6)), 3))
    jammers = rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(0, 3)), 3))
    ratio = 10.0 ** rng.uniform(-2.0, 3.0) / max(1, len(jammers))
    return {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": _NOISE_W, "reference_gain_db": 0.0},
        "nodes": [
            {"position_m": p, "power_w": float(10.0 ** rng.uniform(-0.5, 0.5))} for p in nodes.tolist()
        ],
        "jammers": [{"position_m": p, "power_w": float(ratio)} for p in jammers.tolist()],
    }


def _airframe(rng: np.random.Generator) -> Table:
    """Tilts from none to much, dipoles mounted upright, flat or in between."""
    tilt = float(rng.choice([0.0, 0.0, 2.0, 10.0, 30.0, rng.uniform(0.0, 60.0)]))
    mount = float(rng.choice([0.0, 90.0, 90.0, 45.0, rng.uniform(0.0, 90.0)]))
    return _plain(rng) | {"airframe": {"tilt_max_deg": tilt, "mount_deg": mount}}


def _secrecy(rng: np.random.Generator) -> Table:
    """One to three eavesdroppers, some with better receivers than the nodes."""
    plain = _plain(rng)
    eavesdroppers = rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(1, 4)), 3))
    return {
        "objective": "secrecy-rate",
        "transmitter": {"power_w": float(10.0 ** rng.uniform(-1.0, 1.0))},
        "airspace": plain["airspace"],
        "receiver": plain["receiver"],
        "nodes": [{"position_m": node["position_m"]} for node in plain["nodes"]],
        "jammers": plain["jammers"] if rng.uniform() < 0.3 else [],
        "eavesdroppers": [
            {"position_m": p, "noise_w": _NOISE_W * float(10.0 ** rng.uniform(-0.5, 0.5))}
            for p in eavesdroppers.tolist()
        ],
    }


def _margins(rng: np.random.Generator) -> Table:
    """Nodes that ask for more than others, as a weight or as a requirement."""
    plain = _plain(rng)
    for node in plain["nodes"]:
        wish = rng.integers(3)
        if wish == 1:
            node["weight"] = float(10.0 ** rng.uniform(-0.7, 0.7))
        elif wish == 2:
            node["min_sinr_db"] = float(rng.uniform(-7.0, 7.0))
    return plain


def _star(rng: np.random.Generator, centre: FloatArray, size: float) -> list[list[float]]:
    """Return a star-shaped polygon, often not convex."""
    count = int(rng.integers(3, 8))
    angles = np.sort(rng.uniform(0.0, 1.0, count) + np.arange(count)) * 2.0 * np.pi / (count + 1.0)
    radii = size * rng.uniform(0.4, 1.3, count)
    corners = centre + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    return [[float(x), float(y)] for x, y in corners]


def _no_fly(rng: np.random.Generator) -> Table:
    """One to three zones of every shape about the middle of the field, some of limited height."""
    zones = []
    for _ in range(int(rng.integers(1, 4))):
        centre, size = rng.uniform(10.0, 50.0, size=2), float(rng.uniform(4.0, 15.0))
        shape = rng.integers(3)
        zone: Table = {"polygon_m": _star(rng, centre, size)}
        if shape == 0:
            zone = {
                "x_m": [centre[0] - size, centre[0] + 0.5 * size],
                "y_m": [centre[1] - size, centre[1] + size],
            }
        elif shape == 1:
            zone = {"centre_m": centre.tolist(), "radius_m": size}
        if rng.uniform() < 0.4:
            zone["altitude_m"] = [0.0, float(rng.uniform(9.0, 25.0))]
        zones.append(zone)
    plain = _plain(rng)
    plain["airspace"]["no_fly"] = zones
    return plain


def _fence(rng: np.random.Generator) -> Table:
    """A fence that often leaves out where it would be best to be."""
    plain = _plain(rng)
    plain["airspace"]["geofence_m"] = _star(
        rng, rng.uniform(10.0, 50.0, size=2), float(rng.uniform(10.0, 30.0))
    )
    return plain


def _together(rng: np.random.Generator) -> Table:
    """An airframe, requirements and a zone at once."""
    together = _margins(rng) | {"airframe": _airframe(rng)["airframe"]}
    together["airspace"] = _no_fly(rng)["airspace"]
    return together


FEATURES: dict[str, Callable[[np.random.Generator], Table]] = {
    "airframe": _airframe,
    "secrecy": _secrecy,
    "margins": _margins,
    "no-fly": _no_fly,
    "fence": _fence,
    "together": _together,
}


def make_feature_scene(feature: str, number: int) -> Scene:
    """Return the scene of a number with something that scenarios can ask for.

    Args:
        feature: one of ``FEATURES``.
        number: seeds everything about it.
    """
    rng = np.random.default_rng([20261, list(FEATURES).index(feature), number])
    return Scene(
        number=number,
        kind=feature,
        scheme="optimum",
        scenario=Scenario.from_dict(FEATURES[feature](rng) | {"name": f"{feature} {number}"}),
    )
