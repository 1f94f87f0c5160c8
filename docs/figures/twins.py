"""Writes a figure of the pages twice: on white, and as its dark twin ``NAME-dark.png``."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imread, imsave
from numpy.typing import NDArray

from nullpose.report.figures.style import house_style

IMAGES = Path(__file__).parents[1] / "images"
_GROUND, _INK = 0.075, 0.93  # lightness of what is white and black on a light page


def write(figure: Figure, name: str, dpi: float = 200.0) -> Path:
    """Write a figure as PNG and its dark twin; return the path of the light one."""
    path = IMAGES / f"{name}.png"
    with house_style():
        for _ in range(2):  # the layout needs to know how large names are, which depends on it
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


def grey(colours: NDArray[np.floating]) -> NDArray[np.floating]:
    """Print colours, (..., 3) in sRGB, without colour: by their luminance."""
    luminance = _linear(colours) @ np.array([0.2126, 0.7152, 0.0722])
    return _coded(np.repeat(luminance[..., None], 3, axis=-1))


def deuteranope(colours: NDArray[np.floating]) -> NDArray[np.floating]:
    """Show colours, (..., 3) in sRGB, as without green cones.

    Source: Machado, Oliveira and Fernandes, IEEE TVCG 15 (2009), severity 1.
    """
    matrix = [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.01182, 0.04294, 0.968881]]
    return _coded(np.clip(_linear(colours) @ np.array(matrix).T, 0.0, 1.0))


def _linear(colours: NDArray[np.floating]) -> NDArray[np.floating]:
    return np.where(colours <= 0.04045, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)


def _coded(light: NDArray[np.floating]) -> NDArray[np.floating]:
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)
