"""Draw the mark of nullpose: a dipole's pattern, a drone, and the null turned to a jammer.

Into ``docs/_static/logo.svg`` and ``logo-dark.svg``: `make figures`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from nullpose.report.figures.style import DRONE, JAMMER, NODE, NULL

FOLDER = Path(__file__).parents[1] / "_static"
TILT_RAD, RADIUS = np.radians(-38.0), 27.0
LIGHT_INK = "#e8e8e8"


def pattern() -> str:
    """Outline a dipole's gain, sin^2 of the angle from its axis, around (32, 32)."""
    around = np.linspace(0.0, 2.0 * np.pi, 73)[:-1]
    far = RADIUS * np.sin(around) ** 2
    x, y = 32.0 + far * np.cos(around + TILT_RAD), 32.0 + far * np.sin(around + TILT_RAD)
    return "M" + "L".join(f"{a:.2f} {b:.2f}" for a, b in zip(x, y, strict=True)) + "Z"


def logo(ink: str) -> str:
    """Write the mark with its drone in a colour."""
    x, y = 26.0 * np.cos(TILT_RAD), 26.0 * np.sin(TILT_RAD)
    ax, ay, bx, by = 32.0 - x, 32.0 - y, 32.0 + x, 32.0 + y
    cross = f"M{bx - 5:.2f} {by - 5:.2f}l10 10m0 -10l-10 10"
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 64 64" role="img" aria-label="nullpose">'
        f'<path d="{pattern()}" fill="{NODE}"/>'
        f'<path d="M{ax:.2f} {ay:.2f}L{bx:.2f} {by:.2f}" stroke="{NULL}" stroke-width="4"/>'
        f'<path d="{cross}" stroke="{JAMMER}" stroke-width="4.5" stroke-linecap="round" fill="none"/>'
        f'<circle cx="32" cy="32" r="5.5" fill="{ink}"/></svg>\n'
    )


if __name__ == "__main__":
    for name, ink in (("logo", DRONE), ("logo-dark", LIGHT_INK)):
        (FOLDER / f"{name}.svg").write_text(logo(ink), encoding="utf-8")
