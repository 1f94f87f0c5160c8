"""Whether a table is the pattern of an antenna, and whether its rows fit each other."""

from __future__ import annotations

import numpy as np

from nullpose.antenna.files.block import refuse, require
from nullpose.antenna.harmonics import (
    HIGHEST_DEGREE,
    MOST_MISSED,
    FloatArray,
    Harmonics,
    fit,
    missed_share,
    supported_degree,
)
from nullpose.antenna.table import PatternTable, mean_gain, solid_angles

_OVER_FED = 10.0**0.05
_OVER_FED_ESTIMATE = 10.0**0.2  # sums of losses are no measurement
_FLOOR, _MOST_FLOOR = 1e-8, 0.01  # of the peak, and of the sphere
_STRONG = 1e-2  # of the peak: 20 dB below
_APART_DB, _MEDIANS, _ALONE = 0.08, 20.0, 1.5  # how far off a lone row is: at least, of others, of neighbours
_HIGH = 2.0  # of both neighbours: a beam that the steps follow is no higher


def require_antenna(table: PatternTable) -> None:
    """Refuse gains that no antenna has.

    Args:
        table: any.

    Raises:
        ScenarioError: it radiates more than it is fed, or many directions have no gain.
    """
    mean = mean_gain(table)
    floor = float(np.sum(solid_angles(table)[table.gain <= _FLOOR * np.max(table.gain)]))
    require(
        floor <= _MOST_FLOOR,
        f"{100.0 * floor:.0f} % of all directions have no gain (a floor, such as -999.99 dB), and would "
        "be taken for nulls; state what the antenna does there",
    )
    require(
        mean <= (_OVER_FED_ESTIMATE if table.caveat else _OVER_FED),
        f"the average gain over the sphere is {10.0 * np.log10(mean):.1f} dB: it radiates more than "
        "it is fed; must be 0 dB at most. Is the unit right: dBi, dBd, linear?",
    )


def require_fit(table: PatternTable) -> None:
    """Refuse a table that its harmonics do not follow, or of which a row does not fit those around it.

    Args:
        table: any.

    Raises:
        ScenarioError: its steps are too coarse, or its beam is too narrow; or with the row that fits least.
    """
    found = fit(table, supported_degree(table))
    part, step_deg = missed_share(table, found), 180.0 / (len(table.theta_deg) - 1)
    require(
        part <= MOST_MISSED,
        f"steps of {step_deg:g} degrees do not follow the pattern: smoothed to the degree that they allow, "
        f"{found.degree}, it is off by {100.0 * part:.0f} % of the peak, must be 1 % at most; export finer "
        f"steps, or fields with their phases; no degree above {HIGHEST_DEGREE} is taken",
    )
    if not table.caveat:  # which an estimate has
        _require_rows(table, found)


def _require_rows(table: PatternTable, found: Harmonics) -> None:
    """Refuse the row within 20 dB of the peak that fits those around it least, if it does not fit."""
    smooth = found.on_grid(np.radians(table.theta_deg), np.radians(table.phi_deg))
    gain, smooth = (np.maximum(values, _STRONG * np.max(table.gain)) for values in (table.gain, smooth))
    apart_db = np.abs(10.0 * np.log10(gain / smooth))
    typical_db = np.median(apart_db[gain == table.gain])
    alone = apart_db > np.maximum(max(_APART_DB, _MEDIANS * typical_db), _ALONE * _beside(apart_db))
    high = gain > _HIGH * _beside(gain)
    high[[0, -1]] = False  # a beam along the axis is one direction wide
    if np.any(bad := alone | high):
        where = np.arange(bad.size).reshape(bad.shape) if table.lines is None else table.lines
        step_deg, several = 180.0 / (len(gain) - 1), len(np.unique(where[bad])) > 1
        why = "is it written right?"
        if several:
            why = f"nor do others: steps of {step_deg:g} degrees are too coarse, or these are written wrong"
        row, column = np.unravel_index(np.argmax(np.where(bad, apart_db, 0.0)), bad.shape)
        refuse(
            f"theta = {table.theta_deg[row]:g}, phi = {table.phi_deg[column]:g} degrees has a gain of "
            f"{10.0 * np.log10(table.gain[row, column] + 1e-30):.2f} dBi, which does not fit those around "
            f"it; {why}",
            0 if table.lines is None else int(table.lines[row, column]),
        )


def _beside(values: FloatArray) -> FloatArray:
    """Return the larger of both neighbours along theta, (t, p), at the poles the one that there is."""
    inside = np.pad(values, ((1, 1), (0, 0)), mode="reflect")
    return np.asarray(np.maximum(inside[:-2], inside[2:]))
