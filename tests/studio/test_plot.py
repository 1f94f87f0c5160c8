"""The drawing of the power curve."""

from html import unescape
from xml.etree import ElementTree

import numpy as np
import pytest

from nullpose.scenario import Scenario
from nullpose.studio.plot import power_plot_svg, scale_svg
from nullpose.studio.steps import power_curves
from nullpose.studio.view import View


def _drawn(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(unescape(text))


def test_every_scheme_has_a_line_of_its_own_look(paper: Scenario) -> None:
    """Four curves, told apart by colour and by dashes, and a ring at the present power."""
    curve = list(power_curves(2, View(scenario=paper)))[-1]
    drawn = _drawn(power_plot_svg(curve, version=2, power_db=0.0, value=0.98, unit="dB"))
    lines = list(drawn.iter("polyline"))
    assert len({(line.get("stroke"), line.get("stroke-dasharray")) for line in lines}) == 4
    assert drawn.get("data-state") == "current"
    (ring,) = drawn.iter("circle")
    assert float(ring.get("cx", "nan")) == pytest.approx(42 + 290 * 30 / 70, abs=0.1)


def test_the_ring_is_on_the_curve(paper: Scenario) -> None:
    """At a power that the curve has, the ring and the optimum's line meet."""
    curve = list(power_curves(1, View(scenario=paper)))[-1]
    row = curve.table.of("optimum")[4]
    drawn = _drawn(
        power_plot_svg(curve, version=1, power_db=row.value, value=row.objective.value_db, unit="dB")
    )
    line = next(iter(drawn.iter("polyline"))).get("points", "")
    points = np.array([pair.split(",") for pair in line.split()], dtype=float)
    (ring,) = drawn.iter("circle")
    at = np.array([ring.get("cx"), ring.get("cy")], dtype=float)
    assert np.min(np.linalg.norm(points - at, axis=1)) < 0.2


def test_an_old_curve_is_marked(paper: Scenario) -> None:
    """A curve of another version is drawn pale and says that it is outdated, without a ring."""
    curve = next(iter(power_curves(1, View(scenario=paper))))
    drawn = _drawn(power_plot_svg(curve, version=2, power_db=0.0, value=None, unit="dB"))
    assert drawn.get("data-state") == "outdated"
    assert not list(drawn.iter("circle"))


def test_without_a_jammer_there_is_no_plot() -> None:
    """A sentence takes the plot's place."""
    assert "No jammer" in power_plot_svg(None, version=1, power_db=None, value=1.0, unit="dB")


def test_the_scale_names_its_ends() -> None:
    """Both ends and the middle stand at the scale."""
    texts = [text.text for text in _drawn(scale_svg(-12.0, 2.0, "value", "dB")).iter("text")]
    assert texts == ["value", "\N{MINUS SIGN}12", "\N{MINUS SIGN}5", "2 dB"]
