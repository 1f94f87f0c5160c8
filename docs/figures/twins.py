"""Writes a figure of the pages twice: on white, and as its dark twin ``NAME-dark.png``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread, imsave
from numpy.typing import NDArray

IMAGES = Path(__file__).parents[1] / "images"
_GROUND, _INK = 0.075, 0.93  # lightness of what is white and black on a light page


def write(figure: Figure, name: str, dpi: float = 200.0) -> Path:
    """Write a figure as PNG and its dark twin; return the path of the light one."""
    path = IMAGES / f"{name}.png"
    for _ in range(2):  # names are placed by where the layout has put the axes
        figure.draw_without_rendering()
    figure.savefig(path, dpi=dpi, facecolor="white", metadata={"Software": None})
    darken(path)
    return path


def darken(path: Path) -> None:
    """Write the dark twin of a PNG beside it."""
    imsave(path.with_name(f"{path.stem}-dark.png"), inverted(imread(path)[..., :3]))


def inverted(colours: NDArray[np.floating]) -> NDArray[np.floating]:
    """Turn light into dark and dark into light, (..., 3) in sRGB, and keep hues and saturations."""
    light = 0.5 * (colours.max(axis=-1, keepdims=True) + colours.min(axis=-1, keepdims=True))
    turned = _INK + (_GROUND - _INK) * light
    room = np.maximum(1.0 - np.abs(2.0 * light - 1.0), 1e-3)
    return np.clip(turned + (colours - light) * (1.0 - np.abs(2.0 * turned - 1.0)) / room, 0.0, 1.0)
