"""The two maps: what each position could give at its best axis, and where the drone's pattern falls."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna import PatternAntenna
from nullpose.family import build_family
from nullpose.physics import antenna_gain, link_gain, objective_value, to_db
from nullpose.scenario import Scenario
from nullpose.studio.answer import Answer

FloatArray = NDArray[np.float64]

MAPS = ("best value at each place", "pattern's footprint")
"""What the two maps are called, the first being that of the best values."""

_CELLS = 45  # points along the longer side
_CHUNK = 64  # positions tried together against all sampled axes
_AXES = 400
_MARGIN = 0.35  # free ground around the points, of their extent
_LEAST_M = 20.0
_FLOOR_DB = -60.0  # the null itself is minus infinity
_GOLDEN_RAD = 2.399963229728653  # golden angle


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Field:
    """A number at every point of a horizontal grid.

    Args:
        east_m: (nx,) metres.
        north_m: (ny,) metres.
        altitude_m: of the plane, metres.
        values: (ny, nx), not a number where there is none.
        unit: as in "dB".
        title: what it shows.
    """

    east_m: FloatArray
    north_m: FloatArray
    altitude_m: float
    values: FloatArray
    unit: str
    title: str


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FieldMap:
    """The two maps of a version of the scene.

    Args:
        version: the version of the scene.
        best: the objective at the best axis of each position, on a plane at the drone's altitude.
        footprint: the drone's gain over the path loss, on the ground.
    """

    version: int
    best: Field
    footprint: Field

    def named(self, name: str) -> Field | None:
        """Return the map of a name, or None.

        Args:
            name: one of ``MAPS``, or any other.
        """
        return dict(zip(MAPS, (self.best, self.footprint), strict=True)).get(name)


def map_extent_m(scenario: Scenario, position_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the low and high corner, each (2,) in metres, of the ground that is drawn.

    The points and the drone with a margin around them.

    Args:
        scenario: the scene.
        position_m: (3,) where the drone is, metres.
    """
    places = np.vstack([_points_m(scenario), position_m])[:, :2]
    low, high = places.min(axis=0), places.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half = np.maximum(half + _MARGIN * max(float(half.max()), 0.5 * _LEAST_M), 0.5 * _LEAST_M)
    half = np.maximum(half, 0.6 * half.max())
    return middle - half, middle + half


def field_map(answer: Answer, go_on: Callable[[], None] = lambda: None) -> FieldMap:
    """Return the two maps of an answer.

    The map of the best axes is exact, by enumeration, where every axis is allowed and a SINR or margin is
    asked for; the axis of a case that fixes it is its formula; an antenna with a pattern keeps its attitude;
    otherwise the best of 400 axes spread evenly
    over those that the vehicle reaches is taken, slightly below the true best.

    Args:
        answer: whose case, altitude and pose they are of.
        go_on: called now and then; what it raises ends the work.
    """
    scenario, pose, quantity = answer.result.scenario, answer.result.pose, answer.result.objective.quantity
    low_m, high_m = map_extent_m(scenario, pose.position_m)
    step_m = float(np.max(high_m - low_m)) / (_CELLS - 1)
    east, north = (np.arange(lo, hi + 0.5 * step_m, step_m) for lo, hi in zip(low_m, high_m, strict=True))
    altitude_m = float(pose.position_m[2])
    grid, ground = (
        np.stack(np.broadcast_arrays(*np.meshgrid(east, north), up), -1) for up in (altitude_m, 0.0)
    )
    nearest_m = np.linalg.norm(grid[..., None, :] - _points_m(scenario), axis=-1).min(axis=-1)
    usable = scenario.airspace.allows(grid) & (nearest_m >= scenario.airspace.keep_out_m)
    values = np.full(usable.shape, np.nan)
    values[usable] = _best_values(answer, grid[usable], go_on)
    loss = np.sum((ground - pose.position_m) ** 2, axis=-1) / max(1.0, altitude_m**2)
    at = (pose.position_m, pose.orientation(scenario.antenna_record), ground.reshape(-1, 3))
    gain = antenna_gain(*at, scenario.antenna_record).reshape(loss.shape)
    is_pattern = isinstance(scenario.antenna_record, PatternAntenna)
    what = "value in this attitude" if is_pattern else "best value"
    best = Field(
        east_m=east,
        north_m=north,
        altitude_m=altitude_m,
        values=values if quantity.is_rate else _db(values),
        unit=quantity.unit,
        title=f"{what} at each place, {altitude_m:.1f} m up; lines to nodes",
    )
    footprint = Field(
        east_m=east,
        north_m=north,
        altitude_m=0.0,
        values=_db(gain / np.maximum(loss, 1e-12)),
        unit="dB",
        title="gain over path loss on the ground, 0 straight below at full gain",
    )
    return FieldMap(version=answer.version, best=best, footprint=footprint)


def _points_m(scenario: Scenario) -> FloatArray:
    groups = (scenario.node_positions_m, scenario.jammer_positions_m, scenario.eavesdropper_positions_m)
    return np.vstack([group.reshape(-1, 3) for group in groups])


def _db(values: FloatArray) -> FloatArray:
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(np.isnan(values), np.nan, np.maximum(to_db(values), _FLOOR_DB)))


def _best_values(answer: Answer, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    """Return the objective at each position with the axis of the answer's case, shape (n,)."""
    scenario = answer.result.scenario
    if isinstance(scenario.antenna_record, PatternAntenna):
        held = answer.result.pose.orientation(scenario.antenna_record)
        return objective_value(scenario, positions_m, np.broadcast_to(held, (len(positions_m), 3, 3)))
    fields = answer.case.scheme.record.fields(scenario, None)
    given = [field for field in (fields or {}).values() if not field.is_free]
    if given:
        each = [objective_value(scenario, positions_m, field.axis_at(positions_m)) for field in given]
        return np.asarray(np.max(each, axis=0))
    is_rate = answer.result.objective.quantity.is_rate
    if fields is not None and scenario.axis_band == (0.0, 1.0) and not is_rate:
        axes = _exact_axes(scenario, positions_m, go_on)
    else:
        axes = _ranked_axes(scenario, positions_m, _served if fields is None else objective_value, go_on)
    return objective_value(scenario, positions_m, axes)


def _exact_axes(scenario: Scenario, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    from nullpose.solve.kernels.axis import best_axis

    arrays = build_family(scenario).arrays
    axes = np.empty_like(positions_m)
    for position_m, axis in zip(np.ascontiguousarray(positions_m), axes, strict=True):
        go_on()
        best_axis(arrays, position_m, axis)
    return axes


def _served(scenario: Scenario, positions_m: FloatArray, axes: FloatArray) -> FloatArray:
    """Return how well the nodes are served, the jammers ignored."""
    nodes = scenario.node_positions_m
    loss = np.sum((nodes - positions_m[..., None, :]) ** 2, axis=-1)
    gain = link_gain(positions_m, axes, nodes, scenario.antenna_record, scenario.node_antennas)
    received = gain * scenario.node_powers_w / loss
    return np.asarray(np.min(received / scenario.node_required_sinr, axis=-1))


def _ranked_axes(
    scenario: Scenario,
    positions_m: FloatArray,
    rank: Callable[[Scenario, FloatArray, FloatArray], FloatArray],
    go_on: Callable[[], None],
) -> FloatArray:
    """Return, for each position, the highest ranked of axes spread evenly over those reached."""
    low, high = np.sqrt(scenario.axis_band)
    up = low + (high - low) * np.linspace(0.0, 1.0, _AXES)
    across, azimuth_rad = np.sqrt(np.maximum(0.0, 1.0 - up**2)), _GOLDEN_RAD * np.arange(_AXES)
    axes = np.stack([across * np.cos(azimuth_rad), across * np.sin(azimuth_rad), up], axis=-1)
    chosen = np.empty_like(positions_m)
    for start in range(0, len(positions_m), _CHUNK):
        go_on()
        some = slice(start, start + _CHUNK)
        chosen[some] = axes[np.argmax(rank(scenario, positions_m[some, None, :], axes), axis=1)]
    return chosen
