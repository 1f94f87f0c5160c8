"""The marks of points and the null are told apart by anyone, and in print without colour."""

import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb

from nullpose.report.figures.style import DRONE, EAVESDROPPER, JAMMER, MARKS, NODE, NULL

sys.path.append(str(Path(__file__).parents[2] / "docs" / "figures"))

from twins import deuteranope, grey, inverted

COLOURS = {"node": NODE, "jammer": JAMMER, "eavesdropper": EAVESDROPPER, "null": NULL, "drone": DRONE}
PAIRS = list(combinations(COLOURS, 2))
LEAST = 0.15  # of the way from black to white


def _distance(pair: tuple[str, str], seen: object = lambda colours: colours) -> float:
    one, other = (seen(np.array(to_rgb(COLOURS[name]))) for name in pair)
    return float(np.linalg.norm(one - other) / np.sqrt(3.0))


@pytest.mark.parametrize("pair", PAIRS)
def test_colours_are_told_apart(pair: tuple[str, str]) -> None:
    """By all who see colours, on white and on black, and by a deuteranope by more than a shade."""
    assert _distance(pair) > LEAST
    assert _distance(pair, inverted) > 0.7 * LEAST
    assert _distance(pair, deuteranope) > 0.5 * LEAST


def test_shapes_are_told_apart_without_colour() -> None:
    """Each kind of point has a marker of its own; the null is lighter than all, the drone darker."""
    assert len({marker for _, marker in MARKS.values()}) == len(MARKS)
    light = {name: float(grey(np.array(to_rgb(colour)))[0]) for name, colour in COLOURS.items()}
    assert max(light, key=light.__getitem__) == "null"
    assert min(light, key=light.__getitem__) == "drone"


def test_a_dark_twin_keeps_hues() -> None:
    """White becomes nearly black and the reverse, and blue stays blue."""
    white, black, blue = inverted(np.array([[1.0, 1.0, 1.0], [0.0, 0.0, 0.0], to_rgb(NODE)]))
    assert white.max() < 0.1
    assert black.min() > 0.9
    assert blue[2] == blue.max() > blue[0] + 0.3
