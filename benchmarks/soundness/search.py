"""A search that shares nothing with the solver: many random walks at once, judged by the physics alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from nullpose.physics import sinr
from nullpose.scenario import Scenario

__all__ = ["best_value", "feasible"]

FloatArray = NDArray[np.float64]

_STEPS = 400
_FAR_M = 80.0


def axes_of(scenario: Scenario, scheme: str) -> list[Callable[[FloatArray, FloatArray], FloatArray]]:
    """Return how a scheme makes an axis of a position and a free direction, one function for each variant."""
    if scheme == "vertical":
        return [lambda p, u: np.broadcast_to([0.0, 0.0, 1.0], p.shape)]
    if scheme == "zero-interference":
        return [lambda p, u, m=m: m - p for m in scenario.jammer_positions_m]
    if scheme == "maximum-gain" and len(scenario.nodes) == 2:
        first, second = scenario.node_positions_m
        return [lambda p, u: np.cross(first - p, second - p)]
    return [lambda p, u: u]


def feasible(scenario: Scenario, positions_m: FloatArray) -> NDArray[np.bool_]:
    """Return which positions, (n, 3), the airspace allows."""
    ground = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
    distance = np.linalg.norm(positions_m[:, None, :] - ground, axis=-1).min(axis=1)
    airspace = scenario.airspace
    inside = np.all((positions_m >= airspace.lower_m) & (positions_m <= airspace.upper_m), axis=1)
    return np.asarray(inside & (distance >= airspace.keep_out_m))


def best_value(
    scenario: Scenario, scheme: str, *, starts: int, seed: int, near: tuple[FloatArray, FloatArray]
) -> float:
    """Return the best smallest SINR over many random walks.

    Half of the walks begin anywhere, half near a given pose: a bound that is too low by little would be
    exceeded there first. Each walk tries a random change and keeps it if it is better; changes shrink.

    Args:
        scenario: what to search.
        scheme: which axes are allowed.
        starts: how many walks.
        seed: of the walks.
        near: position, metres, and axis to begin half of them around.
    """
    rng = np.random.default_rng(seed)
    ground = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
    low = np.maximum(scenario.airspace.lower_m, ground.min(axis=0) - _FAR_M)
    high = np.minimum(scenario.airspace.upper_m, ground.max(axis=0) + _FAR_M)
    return max(
        _walks(scenario, axis, rng, starts, np.array([low, high]), near) for axis in axes_of(scenario, scheme)
    )


def _walks(
    scenario: Scenario,
    axis: Callable[[FloatArray, FloatArray], FloatArray],
    rng: np.random.Generator,
    starts: int,
    room_m: FloatArray,
    near: tuple[FloatArray, FloatArray],
) -> float:
    def values(p: FloatArray, u: FloatArray) -> FloatArray:
        directions = axis(p, u)
        length = np.linalg.norm(directions, axis=1, keepdims=True)
        allowed = feasible(scenario, p) & (length[:, 0] > 1e-9)
        out = np.full(len(p), -np.inf)
        if np.any(allowed):
            unit = directions[allowed] / length[allowed]
            out[allowed] = np.min(sinr(scenario, p[allowed], unit), axis=-1)
        return out

    p = rng.uniform(room_m[0], room_m[1], size=(starts, 3))
    p[: starts // 4, 2] = room_m[0, 2]
    u = rng.normal(size=(starts, 3))
    p[starts // 2 :], u[starts // 2 :] = near
    value = values(p, u)
    scale = np.full(starts, 10.0)
    scale[starts // 2 :] = 10.0 ** rng.uniform(-6.0, 1.0, size=starts - starts // 2)
    for _ in range(_STEPS):
        step = scale * 10.0 ** rng.uniform(-1.5, 0.3, size=starts)
        sparse = rng.uniform(size=(starts, 3)) < 0.7
        new_p = np.clip(p + step[:, None] * rng.normal(size=(starts, 3)) * sparse, room_m[0], room_m[1])
        new_u = u + 0.05 * step[:, None] * rng.normal(size=(starts, 3)) * np.linalg.norm(u, axis=1)[:, None]
        new_value = values(new_p, new_u)
        better = new_value > value
        p[better], u[better], value[better] = new_p[better], new_u[better], new_value[better]
        scale *= np.where(better, 1.5, 0.96)
        scale = np.clip(scale, 1e-9, 20.0)
    return float(np.max(value))
