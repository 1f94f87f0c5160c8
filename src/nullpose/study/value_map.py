"""A map: what each position of a plane gives with the best axis that its case allows there."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from nullpose.errors import checked, require_usage
from nullpose.physics import allowed_value, destination_snr, to_db
from nullpose.physics.sinr import received_from_sources_w
from nullpose.physics.types import FloatArray
from nullpose.problem.build import build_family
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.scenario.airspace import BORDER_M
from nullpose.solver import Result
from nullpose.study.evaluation import require_one_antenna
from nullpose.study.field import Field

CELLS = 45
"""Points along the longer side of a map, unless told otherwise."""

_MOST_CELLS = 2000
_CHUNK = 64  # positions tried together against all sampled axes
_AXES = 400
_MARGIN = 0.35  # free ground around the points, of their extent
_LEAST_M = 20.0
_FLOOR_DB = -60.0  # the null itself is minus infinity
_GOLDEN_RAD = 2.399963229728653  # golden angle


def map_extent_m(scenario: Scenario, position_m: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the low and high corner, each (2,) in metres, of the ground that is drawn.

    The points and the drone with a margin around them.

    Args:
        scenario: the scene.
        position_m: (3,) where the drone is, metres.
    """
    places = np.vstack([scenario.point_positions_m, position_m])[:, :2]
    low, high = places.min(axis=0), places.max(axis=0)
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    half = np.maximum(half + _MARGIN * max(float(half.max()), 0.5 * _LEAST_M), 0.5 * _LEAST_M)
    half = np.maximum(half, 0.6 * half.max())
    return middle - half, middle + half


@checked
def value_map(
    result: Result,
    *,
    altitude_m: float | None = None,
    cells: int = CELLS,
    go_on: Callable[[], None] = lambda: None,
) -> Field:
    """Map the value at each position of a plane with the best axis of a result's case there.

    The points of the grid are evenly apart, and the drone is at one of them: where the plane is at its
    altitude, the map has the result's value there. Of a case that fixes the axis that axis is taken; with
    every axis allowed, the best one by enumeration, which is exact for a SINR or margin; an antenna with a
    pattern keeps the result's attitude. Otherwise the best of the result's axis and of 400 axes spread evenly
    over those that the vehicle reaches is taken, slightly below the true best.

    Args:
        result: of a solve, whose scenario and case the map is of.
        altitude_m: of the plane, metres; that of the result's pose if left out.
        cells: points along the longer side.
        go_on: called now and then; what it raises ends the work.

    Raises:
        UsageError: the altitude is outside the airspace, there are too few or too many cells, or the result
            is of an array.

    Example:
        >>> import nullpose
        >>> field = nullpose.value_map(nullpose.solve(nullpose.load("examples/paper.toml")), cells=21)
        >>> field.values.shape == (len(field.north_m), len(field.east_m))
        True
        >>> round(field.best[0], 4)  # dB, at the position of the best pose
        0.9837
    """
    scenario, place_m = result.scenario, result.pose.position_m
    require_map(scenario, altitude_m, cells)
    up = float(place_m[2]) if altitude_m is None else altitude_m
    east, north = map_grid_m(scenario, place_m, cells)
    grid = np.stack(np.broadcast_arrays(*np.meshgrid(east, north), up), -1)
    nearest_m = np.linalg.norm(grid[..., None, :] - scenario.point_positions_m, axis=-1).min(axis=-1)
    usable = scenario.open_airspace.allows(grid) & (nearest_m >= scenario.airspace.keep_out_m - BORDER_M)
    values = np.full(usable.shape, np.nan)
    values[usable] = _best_values(result, grid[usable], go_on)
    values[np.isneginf(values)] = np.nan  # what a node requires is met there at no axis that was tried
    quantity = result.objective.quantity
    is_pattern = not scenario.antenna_record.is_quadratic
    return Field(
        east_m=east,
        north_m=north,
        altitude_m=up,
        values=values if quantity.is_rate else in_decibels(values),
        unit=quantity.unit,
        title=f"{'value in this attitude' if is_pattern else 'best value'} at each place, {up:.1f} m up",
        name=f"{quantity.name}_{quantity.ending}",
    )


def require_map(scenario: Scenario, altitude_m: float | None, cells: int) -> None:
    """Raise a UsageError if a scenario has no such map.

    Args:
        scenario: any.
        altitude_m: of the plane, metres, or None.
        cells: points along the longer side.

    Raises:
        UsageError: the altitude is outside the airspace, there are too few or too many cells, or the drone
            has an array.
    """
    low, high = scenario.airspace.altitude_m
    level_m = low if altitude_m is None else altitude_m
    require_usage(
        low <= level_m <= high,
        f"altitude: given {level_m:g} m; allowed: {low:g} to {high:g} m, as in airspace.altitude_m",
    )
    require_usage(
        2 <= cells <= _MOST_CELLS,
        f"cells: given {cells}; allowed: 2 to {_MOST_CELLS} along the longer side",
    )
    require_one_antenna(scenario, "map")


def map_grid_m(scenario: Scenario, position_m: FloatArray, cells: int) -> tuple[FloatArray, FloatArray]:
    """Return the east and north of a map's points, each (n,) in metres and evenly apart; one is the drone's.

    Args:
        scenario: the scene.
        position_m: (3,) where the drone is, metres.
        cells: points along the longer side.
    """
    low_m, high_m = map_extent_m(scenario, position_m)
    step_m = float(np.max(high_m - low_m)) / (cells - 1)
    east, north = (
        at + step_m * np.arange(-round((at - low) / step_m), round((high - at) / step_m) + 1)
        for low, high, at in zip(low_m, high_m, position_m[:2], strict=True)
    )
    return east, north


def in_decibels(values: FloatArray) -> FloatArray:
    """Return ratios in decibels, those of a null ending at a floor.

    Args:
        values: power ratios; not a number where there is none.
    """
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(np.isnan(values), np.nan, np.maximum(to_db(values), _FLOOR_DB)))


def _best_values(result: Result, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    """Return the objective at each position with the axis of the result's case, shape (n,)."""
    scenario, held = result.scenario, result.pose.orientation(result.scenario.antenna_record)
    if not scenario.antenna_record.is_quadratic:
        return allowed_value(scenario, positions_m, np.broadcast_to(held, (len(positions_m), 3, 3)))
    scheme = result.scheme if isinstance(result.scheme, Scheme) else Scheme.OPTIMUM  # of a robust pose
    fields = scheme.record.fields(scenario, result.null_jammer)
    if fixed := [field for field in (fields or {}).values() if not field.is_free]:
        each = [allowed_value(scenario, positions_m, field.axis_at(positions_m)) for field in fixed]
        return np.asarray(np.max(each, axis=0))
    is_rate = result.objective.quantity.is_rate
    is_smallest = scenario.objective_record.mean_offset is None
    if fields is not None and scenario.axis_band == (0.0, 1.0) and not is_rate and is_smallest:
        axes = _exact_axes(scenario, positions_m, go_on)
    else:
        axes = _ranked_axes(scenario, positions_m, held, _served if fields is None else allowed_value, go_on)
    return allowed_value(scenario, positions_m, axes)


def _exact_axes(scenario: Scenario, positions_m: FloatArray, go_on: Callable[[], None]) -> FloatArray:
    from nullpose.solver.kernels.linear_algebra.axis import best_axis

    arrays = build_family(scenario, any_channel=True).ratios
    axes = np.empty_like(positions_m)
    for position_m, axis in zip(np.ascontiguousarray(positions_m), axes, strict=True):
        go_on()
        best_axis(arrays, position_m, axis)
    return axes


def _served(scenario: Scenario, positions_m: FloatArray, axes: FloatArray) -> FloatArray:
    """Compute the smallest SNR over its requirement, the jammers ignored."""
    received_w = received_from_sources_w(scenario, positions_m, axes)[..., : len(scenario.nodes)]
    snr = received_w / scenario.receiver.noise_power_w
    if scenario.destinations:
        snr = np.append(snr, destination_snr(scenario, positions_m, axes), axis=-1)
    return np.asarray(np.min(snr / scenario.terminal_required_sinr, axis=-1))


def _ranked_axes(
    scenario: Scenario,
    positions_m: FloatArray,
    held: FloatArray,
    rank: Callable[[Scenario, FloatArray, FloatArray], FloatArray],
    go_on: Callable[[], None],
) -> FloatArray:
    """Return, for each position, the highest ranked of one axis and of those spread evenly."""
    low, high = np.sqrt(scenario.axis_band)
    up = low + (high - low) * np.linspace(0.0, 1.0, _AXES)
    across, azimuth_rad = np.sqrt(np.maximum(0.0, 1.0 - up**2)), _GOLDEN_RAD * np.arange(_AXES)
    axes = np.stack([across * np.cos(azimuth_rad), across * np.sin(azimuth_rad), up], axis=-1)
    axes = np.vstack([held, axes])
    chosen = np.empty_like(positions_m)
    for start in range(0, len(positions_m), _CHUNK):
        go_on()
        chunk = slice(start, start + _CHUNK)
        chosen[chunk] = axes[np.argmax(rank(scenario, positions_m[chunk, None, :], axes), axis=1)]
    return chosen
