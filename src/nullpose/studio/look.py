"""The colours of a page, light or dark: contrast is 3 to 1 for marks, 4.5 for text; and the dB scale."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_hex, to_rgb
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike, NDArray

from nullpose.report.figures.style import DRONE, EAVESDROPPER, GREY, JAMMER, NODE, NULL

Rgb = tuple[int, int, int]

_LEAST_SPAN = 6.0
_LEAST_RATE_SPAN = 0.5
_MOST_SPAN = 30.0


def _rgb(colour: str) -> Rgb:
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


COLOURS: Mapping[str, tuple[Rgb, Rgb]] = MappingProxyType(
    {
        "nodes": (_rgb(NODE), (86, 180, 233)),
        "jammers": (_rgb(JAMMER), (240, 110, 30)),
        "eavesdroppers": (_rgb(EAVESDROPPER), (222, 145, 190)),
        "destinations": (_rgb(NODE), (86, 180, 233)),
        "sources": (_rgb(NODE), (86, 180, 233)),
        "drone": (_rgb(DRONE), (241, 243, 245)),  # of the chosen case
        "compared": (_rgb(GREY), (160, 165, 172)),  # of the second one
        "null": (_rgb(NULL), (240, 178, 40)),
        "airspace": ((74, 138, 178), (70, 120, 155)),
        "zone": ((160, 60, 60), (235, 105, 105)),
        "building": ((128, 128, 128), (136, 140, 148)),
        "wire": ((120, 120, 120), (150, 150, 150)),  # around a point, and from the drone to the ground
        "outline": ((20, 20, 20), (245, 245, 245)),  # of links, whose colours are the scale's
        "grid": ((190, 190, 190), (52, 64, 82)),  # only guides the eye
        "contour": ((22, 25, 29), (205, 215, 225)),  # on the map's colours
        "sketch": ((170, 30, 110), (255, 120, 200)),  # what is fenced in or measured
    }
)
"""The colours of marks on viser's white background and on its dark one; points, drone, null as in figures."""


class Look(NamedTuple):
    """The colours of a scene.

    Args:
        dark: whether they are for a dark background.
        map_alpha: how opaque the map is, 0 to 255; it glows on a dark background.
        colours: of marks, as in :data:`COLOURS`.
    """

    dark: bool
    map_alpha: int
    colours: Mapping[str, Rgb]


LIGHT, DARK = (
    Look(bool(i), alpha, {name: pair[i] for name, pair in COLOURS.items()})
    for i, alpha in enumerate((200, 215))
)
"""For viser's two backgrounds."""


def either(light: str, dark: str) -> str:
    """Return a colour for style sheets that is one in a light page and another in a dark one.

    Args:
        light: as style sheets write it.
        dark: as style sheets write it.
    """
    return f"light-dark({light},{dark})"


def lit(colour: str) -> str:
    """Return the colour of a line on white, and in a dark page one of its hue that is light where it is dark.

    Args:
        colour: as in "#d40000".
    """
    hue, light, full = colorsys.rgb_to_hls(*to_rgb(colour))
    return either(colour, to_hex(colorsys.hls_to_rgb(hue, 1.0 - 0.8 * light, full)))


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
    if (finite := finite[np.isfinite(finite)]).size == 0:
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
