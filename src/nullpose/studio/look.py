"""The colours of a page, light or dark: contrast is 3 to 1 for marks, 4.5 for text; and the dB scale."""

from __future__ import annotations

import colorsys
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from matplotlib import colormaps
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike, NDArray

from nullpose.report.figures.style import DRONE, EAVESDROPPER, GREY, JAMMER, NODE, NULL

Rgb = tuple[int, int, int]

_LEAST_SPAN = 6.0
_LEAST_RATE_SPAN = 0.5
_MOST_SPAN = 30.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """The colours of a scene.

    Args:
        dark: whether they are for a dark background.
        kinds: of the points, by the scenario's lists, as in figures; the shapes differ too.
        slots: of the chosen case's drone and of the compared one's, also in the panel.
        null: of the line and the cone without reception.
        airspace: of its edges.
        zone: of no-fly zones.
        building: of buildings.
        wire: of what surrounds a point, and of the line from the drone down to the ground.
        outline: of the links, whose colours are the scale's.
        grid: of the ground's lines, which only guide the eye.
        contour: of the map's contours, which lie on its colours.
        sketch: of what is fenced in or measured.
        map_alpha: how opaque the map is, 0 to 255.
    """

    dark: bool
    kinds: Mapping[str, Rgb]
    slots: tuple[Rgb, Rgb]
    null: Rgb
    airspace: Rgb
    zone: Rgb
    building: Rgb
    wire: Rgb
    outline: Rgb
    grid: Rgb
    contour: Rgb
    sketch: Rgb
    map_alpha: int


def _rgb(colour: str) -> Rgb:
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


LIGHT = Look(
    dark=False,
    kinds=MappingProxyType(
        {"nodes": _rgb(NODE), "jammers": _rgb(JAMMER), "eavesdroppers": _rgb(EAVESDROPPER)}
    ),
    slots=(_rgb(DRONE), _rgb(GREY)),
    null=_rgb(NULL),
    airspace=(74, 138, 178),
    zone=(160, 60, 60),
    building=(128, 128, 128),
    wire=(120, 120, 120),
    outline=(20, 20, 20),
    grid=(190, 190, 190),
    contour=(22, 25, 29),
    sketch=(170, 30, 110),
    map_alpha=200,
)
"""For viser's white background."""

DARK = Look(
    dark=True,
    kinds=MappingProxyType(
        {"nodes": (86, 180, 233), "jammers": (240, 110, 30), "eavesdroppers": (222, 145, 190)}
    ),
    slots=((241, 243, 245), (160, 165, 172)),
    null=(240, 178, 40),
    airspace=(70, 120, 155),
    zone=(235, 105, 105),
    building=(136, 140, 148),
    wire=(150, 150, 150),
    outline=(245, 245, 245),
    grid=(52, 64, 82),
    contour=(205, 215, 225),
    sketch=(255, 120, 200),
    map_alpha=215,
)
"""For viser's dark background, on which the map glows."""


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
    hue, light, full = colorsys.rgb_to_hls(*(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)))
    red, green, blue = (round(255 * part) for part in colorsys.hls_to_rgb(hue, 1.0 - 0.8 * light, full))
    return either(colour, css((red, green, blue)))


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
