"""A search that shares nothing with the solver: many random walks at once, judged by the physics alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from nullpose.physics import allowed_value
from nullpose.problem.family import still_scenes
from nullpose.scenario import Scenario

FloatArray = NDArray[np.float64]

_STEPS = 400
_FAR_M = 80.0
_FIRST_STEP = 0.125  # over how far around the points walks begin


def axes_of(
    scenario: Scenario, scheme: str, null_jammer: str | None = None
) -> list[Callable[[FloatArray, FloatArray], FloatArray]]:
    """Return how a scheme makes an axis of a position and a free direction, one function for each variant."""
    if scheme == "vertical":
        return [lambda p, u: np.broadcast_to([0.0, 0.0, 1.0], p.shape)]
    if scheme == "zero-interference":
        named = zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True)
        return [lambda p, u, m=m: m - p for name, m in named if null_jammer in (None, name)]
    if scheme == "maximum-gain" and len(scenario.terminals) == 2:
        first, second = scenario.terminal_positions_m
        return [lambda p, u: np.cross(first - p, second - p)]
    if not scenario.antenna_record.is_quadratic:
        return [lambda p, u: nearest_in_tilt(scenario, u)]
    band = scenario.axis_band
    return [(lambda p, u: u) if band == (0.0, 1.0) else (lambda p, u: nearest_in_band(u, *band))]


def nearest_in_band(axes: FloatArray, least: float, greatest: float) -> FloatArray:
    """Return unit axes, (n, 3), brought to the nearest elevation with ``least <= u_z^2 <= greatest``."""
    unit = axes / np.linalg.norm(axes, axis=1, keepdims=True)
    height = np.sqrt(np.clip(unit[:, 2] ** 2, least, greatest))
    across = unit[:, :2] / np.maximum(np.linalg.norm(unit[:, :2], axis=1, keepdims=True), 1e-300)
    level = np.sqrt(1.0 - height**2)[:, None] * across
    return np.column_stack([level, np.copysign(height, unit[:, 2])])


def nearest_in_tilt(scenario: Scenario, quaternions: FloatArray) -> FloatArray:
    """Return attitudes of the antenna, (n, 4), turned about a level axis until the airframe reaches them."""
    airframe = scenario.airframe
    if airframe is None:
        return quaternions
    antenna = Rotation.from_quat(quaternions)
    up = (antenna * Rotation.from_euler("y", -airframe.mount_rad)).apply([0.0, 0.0, 1.0])
    across = np.hypot(up[:, 0], up[:, 1])
    excess = np.maximum(np.arctan2(across, up[:, 2]) - airframe.tilt_max_rad, 0.0)
    about = np.column_stack([up[:, 1], -up[:, 0], np.zeros(len(up))]) / np.maximum(across, 1e-300)[:, None]
    return np.asarray((Rotation.from_rotvec(excess[:, None] * about) * antenna).as_quat())


def ground_of(scenario: Scenario) -> FloatArray:
    """Return the places of all points on the ground, (n, 3), metres."""
    return np.array([point.position_m for point in scenario.points])


def feasible(scenario: Scenario, positions_m: FloatArray) -> NDArray[np.bool_]:
    """Return which positions, (n, 3), the airspace allows."""
    distance = np.linalg.norm(positions_m[:, None, :] - ground_of(scenario), axis=-1).min(axis=1)
    airspace = scenario.airspace
    return np.asarray(airspace.allows(positions_m) & (distance >= airspace.keep_out_m))


def best_value(
    scenario: Scenario,
    scheme: str,
    *,
    starts: int,
    seed: int,
    near: tuple[FloatArray, FloatArray],
    null_jammer: str | None = None,
) -> float:
    """Return the best that many random walks make of what the scenario asks for.

    Half of the walks begin anywhere, half near a given pose: a bound that is too low by little would be
    exceeded there first. In a scene in motion the smallest over all instants counts. Each walk tries a
    random change and keeps it if it is better; changes shrink.
    """
    rng, scenes = np.random.default_rng(seed), still_scenes(scenario)
    ground = np.vstack([ground_of(scene) for scene in scenes])
    far_m = max(_FAR_M, 2.0 * abs(scenario.airspace.lower_m[2]))
    low = np.maximum(scenario.airspace.lower_m, ground.min(axis=0) - far_m)
    high = np.minimum(scenario.airspace.upper_m, ground.max(axis=0) + far_m)
    return max(
        _walks(scenes, axis, rng, starts, np.array([low, high]), near, far_m * _FIRST_STEP)
        for axis in axes_of(scenes[0], scheme, null_jammer)
    )


def _walks(
    scenes: list[Scenario],
    axis: Callable[[FloatArray, FloatArray], FloatArray],
    rng: np.random.Generator,
    starts: int,
    bounds_m: FloatArray,
    near: tuple[FloatArray, FloatArray],
    step_m: float,
) -> float:
    def values(p: FloatArray, u: FloatArray) -> FloatArray:
        directions = axis(p, u)
        length = np.linalg.norm(directions, axis=1, keepdims=True)
        allowed = (length[:, 0] > 1e-9) & np.logical_and.reduce([feasible(scene, p) for scene in scenes])
        out = np.full(len(p), -np.inf)
        if np.any(allowed):
            unit = directions[allowed] / length[allowed]
            turned = _orientations(unit)
            out[allowed] = np.min([allowed_value(scene, p[allowed], turned) for scene in scenes], axis=0)
        return out

    p = rng.uniform(bounds_m[0], bounds_m[1], size=(starts, 3))
    p[: starts // 4, 2] = bounds_m[0, 2]
    u = rng.normal(size=(starts, len(near[1])))
    p[starts // 2 :], u[starts // 2 :] = near
    value = values(p, u)
    scale = np.full(starts, step_m)
    scale[starts // 2 :] = 10.0 ** rng.uniform(-6.0, 1.0, size=starts - starts // 2)
    for _ in range(_STEPS):
        step = scale * 10.0 ** rng.uniform(-1.5, 0.3, size=starts)
        sparse = rng.uniform(size=(starts, 3)) < 0.7
        new_p = np.clip(p + step[:, None] * rng.normal(size=(starts, 3)) * sparse, bounds_m[0], bounds_m[1])
        new_u = u + 0.05 * step[:, None] * rng.normal(size=u.shape) * np.linalg.norm(u, axis=1)[:, None]
        new_value = values(new_p, new_u)
        better = new_value > value
        p[better], u[better], value[better] = new_p[better], new_u[better], new_value[better]
        scale *= np.where(better, 1.5, 0.96)
        scale = np.clip(scale, 1e-9, 20.0)
    return float(np.max(value))


def _orientations(unit: FloatArray) -> FloatArray:
    """Return axes as they are, (n, 3), and quaternions, (n, 4), as rotations."""
    return unit if unit.shape[1] == 3 else np.asarray(Rotation.from_quat(unit).as_matrix())
