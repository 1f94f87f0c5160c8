"""Colours of light and dark pages, by the contrast that WCAG asks for."""

import re
from collections.abc import Iterable

import numpy as np
import pytest

from nullpose.report.figures.style import CURVES
from nullpose.studio import plot, readout
from nullpose.studio.colours import css
from nullpose.studio.look import DARK, LIGHT, Look, lit

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
    """Points, drones, airspace and zones have a contrast of 3 to 1 against the background."""
    drawn = [*look.kinds.values(), *look.slots, *look.hulls, look.airspace, look.zone, look.wire, look.drop]
    for colour in drawn:
        assert _contrast(css(colour), SCENES[look.dark]) >= 3.0, colour


@LOOKS
def test_kinds_differ_in_colour(look: Look) -> None:
    """Nodes, jammers and eavesdroppers have three colours."""
    assert len(set(look.kinds.values())) == 3


@LOOKS
def test_the_panels_words_are_read(look: Look) -> None:
    """What is written in the panel has a contrast of 4.5 to 1 against it."""
    texts: Iterable[str] = (plot._INK, readout._NOTE, *(tone for tone, _ in readout._TONES.values()))
    written = [_pair(text)[look.dark] for text in texts]
    for colour in [*written, *map(css, look.slots)]:
        assert _contrast(colour, PANELS[look.dark]) >= 4.5, colour


@pytest.mark.parametrize("curve", CURVES)
@LOOKS
def test_the_plots_curves_stand_out(look: Look, curve: str) -> None:
    """Every curve and the ring have a contrast of 3 to 1 against the panel."""
    for colour in (lit(CURVES[curve].colour), plot._HERE):
        assert _contrast(_pair(colour)[look.dark], PANELS[look.dark]) >= 3.0
