"""The colours of a page, light or dark: contrast is 3 to 1 for what is drawn, 4.5 for text."""

from __future__ import annotations

import colorsys
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from nullpose.studio.colours import css

Rgb = tuple[int, int, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """The colours of a scene.

    Args:
        dark: whether they are for a dark background.
        kinds: of the points, by the scenario's lists; Okabe and Ito's, and the shapes differ too.
        slots: of the chosen case's drone and of the compared one's, also in the panel.
        hulls: of the same two drones' bodies.
        airspace: of its edges.
        zone: of no-fly zones.
        wire: of what surrounds a point.
        drop: of the line from the drone down to the ground.
        outline: of the links, whose colours are the scale's.
        grid: of the ground's lines, which only guide the eye.
        contour: of the map's contours, which lie on its colours.
        map_alpha: how opaque the map is, 0 to 255.
    """

    dark: bool
    kinds: Mapping[str, Rgb]
    slots: tuple[Rgb, Rgb]
    hulls: tuple[Rgb, Rgb]
    airspace: Rgb
    zone: Rgb
    wire: Rgb
    drop: Rgb
    outline: Rgb
    grid: Rgb
    contour: Rgb
    map_alpha: int

    @property
    def null(self) -> Rgb:
        """The colour of the null, which is that of the jammers that it is for."""
        return self.kinds["jammers"]


LIGHT = Look(
    dark=False,
    kinds=MappingProxyType(
        {"nodes": (0, 114, 178), "jammers": (213, 94, 0), "eavesdroppers": (204, 121, 167)}
    ),
    slots=((30, 60, 200), (0, 0, 0)),
    hulls=((60, 64, 72), (120, 124, 130)),
    airspace=(74, 138, 178),
    zone=(160, 60, 60),
    wire=(140, 140, 140),
    drop=(120, 120, 120),
    outline=(20, 20, 20),
    grid=(190, 190, 190),
    contour=(250, 250, 250),
    map_alpha=105,
)
"""For viser's white background."""

DARK = Look(
    dark=True,
    kinds=MappingProxyType(
        {"nodes": (86, 180, 233), "jammers": (240, 110, 30), "eavesdroppers": (222, 145, 190)}
    ),
    slots=((140, 170, 255), (235, 235, 235)),
    hulls=((235, 235, 240), (150, 154, 162)),
    airspace=(70, 120, 155),
    zone=(235, 105, 105),
    wire=(120, 124, 130),
    drop=(150, 150, 150),
    outline=(245, 245, 245),
    grid=(52, 64, 82),
    contour=(205, 215, 225),
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
