"""Arrays of a scenario's numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.errors import UsageError

Floats = NDArray[np.float64]


def read_only(values: ArrayLike, shape: Sequence[int]) -> NDArray[np.float64]:
    """Return the values as a float64 array of the given shape that refuses to be written to."""
    array = np.array(values, dtype=np.float64).reshape(shape)
    array.flags.writeable = False
    return array


def rows_of_points(kind: str, points_m: ArrayLike, power_w: ArrayLike) -> list[dict[str, object]]:
    """Return the tables of points that are given as arrays.

    Args:
        kind: ``"node"`` or ``"jammer"``, for messages.
        points_m: positions east, north, up [m], shape (n, 3), or an empty list.
        power_w: transmit powers [W], shape (n,) or one for all.

    Raises:
        UsageError: shapes that do not go together.
    """
    places, powers = _numbers(f"{kind}s_m", points_m), _numbers(f"{kind}_power_w", power_w)
    if places.size and (places.ndim != 2 or places.shape[1] != 3):
        wanted = "(n, 3), a row of east, north and up in metres for each"
        advice = "try its transpose, .T" if places.ndim == 2 and len(places) == 3 else ""
        if places.shape[-1:] == (2,):
            advice = "add a column of heights, such as zeros"
        if places.shape == (3,):
            advice = "for one point write [[east, north, up]]"
        message = f"{kind}s_m: given shape {places.shape}; allowed: {wanted}"
        raise UsageError(f"{message}; {advice}" if advice else message)
    places = places.reshape(-1, 3)
    if powers.shape not in ((), (len(places),)):
        raise UsageError(
            f"{kind}_power_w: given shape {powers.shape} with {len(places)} {kind}s; "
            f"allowed: one number in watts, or shape ({len(places)},)"
        )
    rows = zip(places.tolist(), np.broadcast_to(powers, len(places)).tolist(), strict=True)
    return [{"position_m": place, "power_w": power} for place, power in rows]


def _numbers(name: str, values: ArrayLike) -> Floats:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise UsageError(
            f"{name}: given values that make no array of numbers; allowed: numbers in rows of equal length"
        ) from None
