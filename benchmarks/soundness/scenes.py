"""Awkward scenes by kind, each made from its own number alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.scenario import Scenario

FloatArray = NDArray[np.float64]

_NOISE_W = 1e-3
_SCHEMES = ("optimum", "optimum", "optimum", "vertical", "zero-interference", "maximum-gain")


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """A scene to be tried: how it is awkward, its case, and its proof's gap and cells, if limited."""

    number: int
    kind: str
    scheme: str
    scenario: Scenario
    gap: float | None = None
    cells: int | None = None


def _field(rng: np.random.Generator, nodes: int, jammers: int) -> tuple[FloatArray, FloatArray]:
    """Return nodes and jammers anywhere in a square of 60 m, up to 5 m above the ground."""
    low, high = [0.0, 0.0, 0.0], [60.0, 60.0, 5.0]
    return rng.uniform(low, high, size=(nodes, 3)), rng.uniform(low, high, size=(jammers, 3))


def _random(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    return *_field(rng, int(rng.integers(2, 7)), int(rng.integers(0, 4))), 10.0 ** rng.uniform(-2.0, 2.0), {}


def _needle(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    """One strong jammer amid the nodes: narrow nulls are worth finding."""
    nodes, jammers = _field(rng, int(rng.integers(2, 4)), 1)
    jammers[0, :2] = nodes[:, :2].mean(axis=0) + rng.normal(0.0, 2.0, size=2)
    return nodes, jammers, 10.0 ** rng.uniform(2.0, 5.0), {}


def _collinear(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    """All points within millimetres of one line."""
    nodes, jammers = _field(rng, int(rng.integers(2, 5)), int(rng.integers(1, 3)))
    start, way = rng.uniform(0.0, 10.0, size=3), np.array([1.0, rng.normal(), 0.0])
    for points in (nodes, jammers):
        points[:] = start + np.outer(rng.uniform(0.0, 50.0, size=len(points)), way / np.linalg.norm(way))
        points += rng.normal(0.0, 1e-3, size=points.shape)
    return nodes, jammers, 10.0 ** rng.uniform(-1.0, 3.0), {}


def _coincident(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    """A jammer a few millimetres to centimetres beside a node."""
    nodes, jammers = _field(rng, int(rng.integers(1, 4)), int(rng.integers(1, 3)))
    jammers[0] = nodes[0] + rng.normal(0.0, 10.0 ** rng.uniform(-3.0, -1.0), size=3)
    return nodes, jammers, 10.0 ** rng.uniform(-2.0, 3.0), {}


def _under_floor(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    """Jammer and nodes just under the floor of the airspace: keep-out balls reach into it."""
    nodes, jammers = _field(rng, int(rng.integers(1, 4)), 1)
    floor = 8.0
    jammers[0, 2] = floor - rng.uniform(0.0, 1.5)
    nodes[0, 2] = floor - rng.uniform(0.0, 1.5)
    return nodes, jammers, 10.0 ** rng.uniform(-1.0, 4.0), {"keep_out_m": float(rng.uniform(0.5, 4.0))}


def _strong(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    return *_field(rng, int(rng.integers(1, 4)), int(rng.integers(1, 3))), 10.0 ** rng.uniform(4.0, 7.0), {}


def _one_node(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    return *_field(rng, 1, int(rng.integers(0, 4))), 10.0 ** rng.uniform(-2.0, 4.0), {}


def _one_spot(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, float, dict[str, object]]:
    """All nodes within a ball much smaller than the keep-out."""
    nodes, jammers = _field(rng, int(rng.integers(2, 7)), int(rng.integers(0, 3)))
    nodes[:] = nodes[0] + rng.normal(0.0, 10.0 ** rng.uniform(-3.0, -0.5), size=nodes.shape)
    return nodes, jammers, 10.0 ** rng.uniform(-1.0, 3.0), {"keep_out_m": float(rng.uniform(1.0, 6.0))}


KINDS = {
    "random": _random,
    "needle": _needle,
    "near-collinear": _collinear,
    "near-coincident": _coincident,
    "under the floor": _under_floor,
    "strong jamming": _strong,
    "one node": _one_node,
    "one spot": _one_spot,
}


def make_scene(number: int) -> Scene:
    """Return the scene of a number; the kinds take turns."""
    rng = np.random.default_rng([20241, number])
    kind = list(KINDS)[number % len(KINDS)]
    nodes, jammers, ratio, airspace = KINDS[kind](rng)
    scheme = str(rng.choice(_SCHEMES))
    if scheme == "zero-interference" and not len(jammers):
        scheme = "vertical"
    bounded = rng.uniform() < 0.3
    walls = {"x_m": (5.0, 45.0), "y_m": (-10.0, 40.0)} if bounded else {}
    return Scene(
        number=number,
        kind=kind,
        scheme=scheme,
        scenario=Scenario.from_dict(
            {
                "name": f"{kind} {number}",
                "airspace": {"altitude_m": (8.0, 30.0), **walls, **airspace},
                "receiver": {"noise_w": _NOISE_W, "reference_gain_db": 0.0},
                "nodes": [
                    {"position_m": p, "power_w": float(10.0 ** rng.uniform(-0.5, 0.5))}
                    for p in nodes.tolist()
                ],
                "jammers": [{"position_m": p, "power_w": ratio / len(jammers)} for p in jammers.tolist()],
            }
        ),
    )
