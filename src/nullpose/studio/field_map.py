"""The two maps: what each position could give at its best axis, and where the drone's pattern falls."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from nullpose.family import build_family
from nullpose.objectives import Quantity
from nullpose.physics import (
    antenna_gain,
    objective_value,
    to_db,
)
from nullpose.scenario import Scenario
from nullpose.studio.answer import Answer
from nullpose.studio.events import Field, FieldMap

__all__ = ["field_map", "map_extent_m"]

FloatArray = NDArray[np.float64]

_CELLS = 45  # points along the longer side
_CHUNK = 64  # positions tried together against all sampled axes
_AXES = 400
_MARGIN = 0.35  # free ground around the points, of their extent
_LEAST_M = 20.0
_FLOOR_DB = -60.0  # the null itself is minus infinity


def map_extent_m(scenario: Scenario, position_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the low and high corner, each (2,) in metres, of the ground that is drawn.

    The points and the drone with a margin around them.

    Args:
        scenario: the scene.
        position_m: (3,) where the drone is, metres.
    """
    points = np.vstack(
        [
            scenario.node_positions_m,
            scenario.jammer_positions_m.reshape(-1, 3),
            scenario.eavesdropper_positions_m.reshape(-1, 3),
            position_m,
        ]
    )[:, :2]
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half = np.maximum(half + _MARGIN * max(float(half.max()), 0.5 * _LEAST_M), 0.5 * _LEAST_M)
    half = np.maximum(half, 0.6 * half.max())
    return middle - half, middle + half


def field_map(answer: Answer, go_on: Callable[[], None] = lambda: None) -> FieldMap:
    """Return the two maps of an answer.

    The map of the best axes is exact, by enumeration, where every axis is allowed and a SINR or margin is
    asked for; the axis of a case that fixes it is its formula; otherwise the best of 400 axes spread evenly
    over those that the vehicle reaches is taken, slightly below the true best.

    Args:
        answer: whose case, altitude and pose they are of.
        go_on: called now and then; what it raises ends the work.
    """
    scenario, position_m = answer.scenario, answer.pose.position_m
    low_m, high_m = map_extent_m(scenario, position_m)
    step_m = float(np.max(high_m - low_m)) / (_CELLS - 1)
    east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low_m, high_m, strict=True))
    altitude_m = float(position_m[2])
    grid = np.stack(np.broadcast_arrays(*np.meshgrid(east, north), altitude_m), axis=-1)
    usable = _usable(scenario, grid)
    values = np.full(usable.shape, np.nan)
    values[usable] = _best_values(answer, grid[usable], go_on)
    quantity = Quantity.of(scenario)
    if not quantity.is_rate:
        values = _db(values)
    ground = np.stack(np.broadcast_arrays(*np.meshgrid(east, north), 0.0), axis=-1)
    return FieldMap(
        version=answer.version,
        best=Field(east_m=east, north_m=north, altitude_m=altitude_m, values=values, unit=quantity.unit),
        footprint=Field(
            east_m=east, north_m=north, altitude_m=0.0, values=_footprint_db(answer, ground), unit="dB"
        ),
    )


def _db(values: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(np.isnan(values), np.nan, np.maximum(to_db(values), _FLOOR_DB)))


def _usable(scenario: Scenario, grid: FloatArray) -> NDArray[np.bool_]:
    points = np.vstack(
        [
            scenario.node_positions_m,
            scenario.jammer_positions_m.reshape(-1, 3),
            scenario.eavesdropper_positions_m.reshape(-1, 3),
        ]
    )
    nearest_m = np.min(np.linalg.norm(grid[..., None, :] - points, axis=-1), axis=-1)
    return np.asarray(scenario.airspace.allows(grid) & (nearest_m >= scenario.airspace.keep_out_m))


def _best_values(answer: Answer, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    scenario, scheme = answer.scenario, answer.case.scheme
    fields = scheme.record.fields(scenario, None)
    if fields is None:
        return objective_value(scenario, positions_m, _gain_axes(scenario, positions_m, go_on))
    given = [field for field in fields.values() if not field.is_free]
    if given:
        each = [objective_value(scenario, positions_m, field.axis_at(positions_m)) for field in given]
        return np.asarray(np.max(each, axis=0))
    if scenario.axis_band == (0.0, 1.0) and scenario.objective == "min-sinr":
        return objective_value(scenario, positions_m, _exact_axes(scenario, positions_m, go_on))
    axes = _spread_axes(*scenario.axis_band)
    best = np.empty(len(positions_m))
    for start in range(0, len(positions_m), _CHUNK):
        go_on()
        some = positions_m[start : start + _CHUNK]
        best[start : start + _CHUNK] = np.max(objective_value(scenario, some[:, None, :], axes), axis=1)
    return best


def _exact_axes(scenario: Scenario, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    from nullpose.solve.kernels.axis import best_axis

    arrays = build_family(scenario).arrays
    axes = np.empty_like(positions_m)
    for position_m, axis in zip(np.ascontiguousarray(positions_m), axes, strict=True):
        go_on()
        best_axis(arrays, position_m, axis)
    return axes


def _gain_axes(scenario: Scenario, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    """Return the axes that serve the nodes best, the jammers ignored."""
    nodes = scenario.node_positions_m
    axes = _spread_axes(0.0, 1.0)
    chosen = np.empty_like(positions_m)
    for i, position_m in enumerate(positions_m):
        go_on()
        distance_sq = np.sum((nodes - position_m) ** 2, axis=-1)
        received = antenna_gain(position_m, axes, nodes) * scenario.node_powers_w / distance_sq
        chosen[i] = axes[np.argmax(np.min(received / scenario.node_required_sinr, axis=-1))]
    return chosen


def _spread_axes(least: float, greatest: float) -> FloatArray:
    """Return axes spread evenly over the part of the upper half sphere with u_z^2 between two ends."""
    low, high = np.sqrt(least), np.sqrt(greatest)
    up = low + (high - low) * np.linspace(0.0, 1.0, _AXES)
    across = np.sqrt(np.maximum(0.0, 1.0 - up**2))
    turn = 2.399963229728653 * np.arange(_AXES)  # golden angle, rad
    return np.stack([across * np.cos(turn), across * np.sin(turn), up], axis=-1)


def _footprint_db(answer: Answer, ground_m: FloatArray) -> FloatArray:
    pose = answer.pose
    points = ground_m.reshape(-1, 3)
    gain = antenna_gain(pose.position_m, pose.antenna_axis, points)
    loss = np.sum((points - pose.position_m) ** 2, axis=-1) / max(1.0, float(pose.position_m[2]) ** 2)
    return _db(gain / np.maximum(loss, 1e-12)).reshape(ground_m.shape[:-1])
