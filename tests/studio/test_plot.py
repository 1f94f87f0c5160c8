"""The drawing of the power curve."""

from dataclasses import replace
from html import unescape
from xml.etree import ElementTree

import numpy as np
import pytest

from nullpose.scenario import Scenario
from nullpose.studio.answer import PowerCurve
from nullpose.studio.plot import power_plot_svg
from nullpose.studio.state import POWER_DB, State
from nullpose.studio.worker import power_curves


def _drawn(text: str) -> ElementTree.Element:
    return ElementTree.fromstring(unescape(text))


def test_every_scheme_has_a_line_of_its_own_look(paper: Scenario) -> None:
    """Four curves, told apart by colour and by dashes; a ring at the present power meets the optimum's."""
    curve = list(power_curves(State(scenario=paper, version=2)))[-1]
    row = curve.table.of("optimum")[4]
    text = power_plot_svg(curve, version=2, power_db=row.value, value=row.objective.value_db, unit="dB")
    drawn = _drawn(text)
    lines = list(drawn.iter("polyline"))
    assert len({(line.get("stroke"), line.get("stroke-dasharray")) for line in lines}) == 4
    assert drawn.get("data-state") == "current"
    points = np.array([pair.split(",") for pair in lines[0].get("points", "").split()], dtype=float)
    (ring,) = drawn.iter("circle")
    at = np.array([ring.get("cx"), ring.get("cy")], dtype=float)
    assert at[0] == pytest.approx(42 + 290 * (row.value + 30) / 70, abs=0.1)
    assert np.min(np.linalg.norm(points - at, axis=1)) < 0.2


def test_a_curve_is_drawn_where_its_values_are(paper: Scenario) -> None:
    """Values far below the top are cut off by the view and never drawn as a plateau at its edge."""
    wide = [(POWER_DB[0], 1e3), (POWER_DB[0] + 7.0, 10.0), (23.0, 1e-2), (POWER_DB[1], 1e-4)]
    table = next(iter(power_curves(State(scenario=paper)))).table
    row = table.of("optimum")[0]
    rows = tuple(replace(row, value=x, objective=replace(row.objective, value=y)) for x, y in wide)
    curve = PowerCurve(version=1, table=replace(table, rows=rows), complete=True)
    drawn = _drawn(power_plot_svg(curve, version=1, power_db=23.0, value=-20.0, unit="dB"))
    (line,) = drawn.iter("polyline")
    _, down = np.array([pair.split(",") for pair in line.get("points", "").split()], dtype=float).T
    assert np.diff(down) / 20.0 == pytest.approx(
        (down[1] - down[0]) / 20.0 * np.array([1.0, 1.5, 1.0]), abs=0.01
    )
    assert down[-1] > 180.0  # below the lower edge, where it is not seen
    (ring,) = drawn.iter("circle")
    assert float(ring.get("cy", "nan")) == pytest.approx(down[2], abs=0.1)
    assert down[2] < 180.0  # the present value is always in view


@pytest.mark.parametrize(
    ("version", "power_db", "value", "state"), [(1, -99.0, 1.0, "growing"), (2, 0.0, None, "outdated")]
)
def test_no_ring_is_where_nothing_holds(
    paper: Scenario, version: int, power_db: float, value: float | None, state: str
) -> None:
    """Neither for jammers weaker than the plot reaches, nor of another version; without any it is words."""
    curve = next(iter(power_curves(State(scenario=paper))))
    drawn = _drawn(power_plot_svg(curve, version=version, power_db=power_db, value=value, unit="dB"))
    assert drawn.get("data-state") == state
    assert not list(drawn.iter("circle"))
    assert "No jammer" in power_plot_svg(None, version=1, power_db=None, value=1.0, unit="dB")
