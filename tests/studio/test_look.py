"""Colours of light and dark pages, by the contrast that WCAG asks for; scales."""

import re

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose.report.figures.style import CURVES
from nullpose.studio import plot
from nullpose.studio.look import DARK, LIGHT, Look, css, linear_colours, lit, scale_colours, scale_range

SCENES = {LIGHT.dark: "#ffffff", DARK.dark: "#141414"}
PANELS = ("#ffffff", "#242424")
LOOKS = pytest.mark.parametrize("look", [LIGHT, DARK], ids=["light", "dark"])


def _contrast(one: str, other: str) -> float:
    """Returns WCAG's contrast of two colours."""
    bright, faint = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (bright + 0.05) / (faint + 0.05)


def _luminance(colour: str) -> float:
    digits = colour.lstrip("#")
    full = digits if len(digits) == 6 else "".join(2 * digit for digit in digits)
    share = np.array([int(full[i : i + 2], 16) for i in (0, 2, 4)]) / 255.0
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


def _pair(colour: str) -> list[str]:
    """Returns the two colours of a ``light-dark()``."""
    found = re.fullmatch(r"light-dark\((#\w+),(#\w+)\)", colour)
    assert found is not None
    return list(found.groups())


@LOOKS
def test_what_is_drawn_stands_out(look: Look) -> None:
    """Points, drones, airspace, zones, curves and ring have a contrast of 3 to 1, and letters 4.5."""
    drawn = look.colours.keys() - {
        "grid",
        "contour",
        "null",
    }  # these guide the eye, lie on a map, or have an outline
    for name in drawn:
        assert _contrast(css(look.colours[name]), SCENES[look.dark]) >= 3.0, name
    assert len({look.colours[kind] for kind in ("nodes", "jammers", "eavesdroppers")}) == 3
    for colour in (plot.RING, *(lit(curve.colour) for curve in CURVES.values())):
        assert _contrast(_pair(colour)[look.dark], PANELS[look.dark]) >= 3.0, colour
    for colour in (css(look.colours[name]) for name in ("drone", "compared")):
        assert _contrast(colour, PANELS[look.dark]) >= 4.5, colour


@seed(0)
@given(values=st.lists(st.floats(-80.0, 80.0), min_size=1, max_size=30), is_rate=st.booleans())
def test_a_scale_spans_a_readable_range(values: list[float], is_rate: bool) -> None:
    """Whole decibels 6 to 30 apart, or tenths of a bit/s/Hz half or more apart, with the largest inside."""
    per_unit, least, most = (10.0, 0.5, 30.0) if is_rate else (1.0, 6.0, 30.0)
    low, high = scale_range([*values, np.nan, -np.inf], is_rate=is_rate)
    assert [per_unit * low, per_unit * high] == pytest.approx(np.round([per_unit * low, per_unit * high]))
    assert least - 1e-9 <= high - low <= min(most, max(least, np.ptp(values) + 2.0 / per_unit)) + 1e-9
    assert low - 1e-9 <= max(values) <= high + 1e-9


def test_a_larger_value_is_never_darker() -> None:
    """So that the scale reads without colour vision too; what is beyond an end has that end's colour."""
    colours = scale_colours(np.linspace(-5.0, 5.0, 200), -4.0, 4.0).astype(float)
    brightness = colours @ np.array([0.2126, 0.7152, 0.0722])
    assert np.all(np.diff(brightness) >= -1.5)
    assert brightness[-1] > brightness[0] + 100.0
    beyond, ends = scale_colours([-np.inf, np.inf, 1e300], 0.0, 1.0), scale_colours([0, 1, 1], 0, 1)
    assert beyond.tolist() == ends.tolist()
    assert scale_colours(0.5, 0.0, 1.0).shape == (3,)
    assert scale_range([np.nan])[0] < scale_range([np.nan])[1]


def test_a_link_has_the_colour_of_the_scale() -> None:
    """A colour in linear light, shown as a screen shows light, is that of the scale but for rounding."""
    scale = scale_colours(np.linspace(0.0, 1.0, 50), 0.0, 1.0)
    light = linear_colours(scale) / 255.0
    shown = 255.0 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1.0 / 2.4) - 0.055)
    assert np.max(np.abs(shown - scale)) <= 7.0  # dark parts have few steps of linear light
    bright = scale >= 60
    assert np.max(np.abs(shown - scale)[bright]) <= 2.0
    assert linear_colours([0, 255, 128]).tolist() == [0, 255, 55]
