"""The dB scale of maps and links in colours that every kind of colour vision tells apart, round numbers."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from matplotlib import colormaps
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike, NDArray

_LEAST_SPAN = 6.0
_LEAST_RATE_SPAN = 0.5
_MOST_SPAN = 30.0


def css(colour: Iterable[int]) -> str:
    """Return a colour as style sheets write it.

    Args:
        colour: red, green, blue, 0 to 255.
    """
    return "#{:02x}{:02x}{:02x}".format(*colour)


def scale_colours(values: ArrayLike, low: float, high: float) -> NDArray[np.uint8]:
    """Return colours, shape (..., 3): viridis from a low value to a high one, ends held; NaN becomes the low.

    Args:
        values: any shape.
        low: value of the dark end.
        high: value of the bright end.
    """
    share = (np.asarray(values, dtype=float) - low) / max(high - low, 1e-12)
    held = np.nan_to_num(share, nan=0.0, posinf=1.0, neginf=0.0)
    return np.asarray(colormaps["viridis"](held, bytes=True))[..., :3]


def scale_range(values: ArrayLike, *, is_rate: bool = False) -> tuple[float, float]:
    """Return the ends of a scale for values: round numbers around most of them and all of the largest.

    Those of decibels are whole and 6 to 30 apart, those of rates tenths and half a bit/s/Hz or more apart.

    Args:
        values: any shape; what is not finite is left out.
        is_rate: whether they are rates, bits/s/Hz.
    """
    per_unit, least = (10.0, _LEAST_RATE_SPAN) if is_rate else (1.0, _LEAST_SPAN)
    finite = np.asarray(values, dtype=float).ravel()
    finite = finite[np.isfinite(finite)]
    if finite.size == 0:
        return -least, 0.0
    high = float(np.ceil(per_unit * finite.max())) / per_unit + 0.0  # no minus before a nought
    low = float(np.floor(per_unit * np.percentile(finite, 5.0))) / per_unit
    return min(high - least, max(low, high - _MOST_SPAN)) + 0.0, high


def linear_colours(colours: ArrayLike) -> NDArray[np.uint8]:
    """Return colours in linear light, 0 to 255, as viser takes those of single vertices.

    What has one colour is given in sRGB. The conversion is that of IEC 61966-2-1.

    Args:
        colours: (..., 3) red, green, blue in sRGB, 0 to 255.
    """
    share = np.asarray(colours, dtype=float) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.round(255.0 * linear).astype(np.uint8)


def round_steps(low: float, high: float, most: int) -> NDArray[np.float64]:
    """Return round numbers at even steps of 1, 2 or 5 times a power of ten, just beyond both ends too.

    Args:
        low: the lower end.
        high: the upper end.
        most: how many steps at most.
    """
    return np.asarray(MaxNLocator(most, steps=[1, 2, 5, 10]).tick_values(low, high))
