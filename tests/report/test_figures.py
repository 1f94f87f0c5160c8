"""Figures of sweeps: every curve and bound on them; and the pattern, of the right shape."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from nullpose import Scenario, solve
from nullpose.report.figures.style import CURVES
from nullpose.report.figures.sweep import draw_least_tilt, draw_sweep
from nullpose.solver import Scheme
from nullpose.study import ResultTable, sweep
from nullpose.study.least_tilt import LeastTilt, MountTilt

SIDES = ("least_tilt_deg", "too_little_deg")


def test_curves_differ_in_more_than_colour() -> None:
    """Without colours, line and marker still tell any two schemes apart."""
    looks = {(str(curve.line), curve.marker) for curve in CURVES.values()}
    assert len(looks) == len(CURVES)
    assert set(CURVES) == {scheme.value for scheme in Scheme}


@pytest.mark.parametrize("log", [False, True])
def test_any_sweep_can_be_drawn(paper: Scenario, log: bool) -> None:
    """The setting is named on its axis with its unit, and the legend has each scheme."""
    table = sweep(paper, "jammers.M.position_m[0]", [10.0, 17.0, 30.0])
    figure = draw_sweep(table, log=log)
    (axes,) = figure.axes
    assert axes.get_xlabel() == "Position of jammer M, east (m)"
    assert axes.get_xscale() == ("log" if log else "linear")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [CURVES[s].label for s in table.names]


def bands_of(figure: Figure) -> list[PolyCollection]:
    """Returns the bands of a figure's first axes."""
    return [one for one in figure.axes[0].collections if isinstance(one, PolyCollection)]


def test_bounds_are_drawn_if_asked_for(paper: Scenario) -> None:
    """A mark at each bound that can be seen and a band up to it; else the curve and what is proved."""
    far = sweep(paper, "jammers.M.power_w", [0.5, 1.0, 2.0], schemes=["optimum"], gap=0.5)
    assert all(row.objective.relative_gap > 0.1 for row in far.rows)
    plain = draw_sweep(far)
    assert [len(plain.axes[0].lines), len(bands_of(plain))] == [1, 0]
    assert plain.get_supxlabel().startswith("Each point is certified optimal within")
    figure = draw_sweep(far, bounds=True)
    _, marks = figure.axes[0].lines
    assert len(bands_of(figure)) == 1
    assert list(marks.get_ydata()) == pytest.approx([row.upper_bound_db for row in far.rows])
    assert figure.axes[0].get_ylim()[1] > max(row.upper_bound_db for row in far.rows)
    assert "Each band ends" in figure.get_supxlabel()
    (legend,) = figure.legends
    assert len(legend.get_texts()) == 1


def test_least_tilts_are_drawn_with_both_sides(paper: Scenario) -> None:
    """A curve for each mount and a mark at each tilt that is too little; nothing where none is enough."""
    table = sweep(paper, "jammers.M.power_w", [1.0, 10.0], mounts_deg=[0.0, 90.0])
    (axes,) = draw_sweep(table).axes
    assert axes.get_ylabel() == "Least tilt (deg)"
    heights = [line.get_ydata().tolist() for line in axes.lines]
    sides = [[row.tilts[key] for row in table.of(name)] for name in table.names for key in SIDES]
    assert heights == sides
    none = replace(table.rows[0], tilt=replace(table.rows[0].tilt, suffices_deg=None))
    (axes,) = draw_sweep(ResultTable(table.path, (none, *table.rows[1:]))).axes
    assert [np.isnan(line.get_ydata()).tolist() for line in axes.lines[:2]] == [[True, False]] * 2


def test_hopeless_bounds_leave_the_curves_readable(paper: Scenario) -> None:
    """A bound tens of decibels above does not squeeze the curves into a line at the bottom."""
    table = sweep(paper, "jammers.M.power_w", [0.01, 1.0, 100.0], schemes=["vertical"])
    rows = [
        replace(row, objective=replace(row.objective, upper_bound=1e6, relative_gap=1e6))
        for row in table.rows
    ]
    low, high = draw_sweep(ResultTable(table.path, tuple(rows)), bounds=True).axes[0].get_ylim()
    values = [row.min_sinr_db for row in rows]
    assert low < min(values)
    assert max(values) < high < max(values) + 10.0


@pytest.mark.parametrize("loss", [0.0, 0.3, 0.9])
def test_a_vehicle_that_loses_little_can_be_drawn(paper: Scenario, loss: float) -> None:
    """Of the losses that have a line, only those that occur are drawn: none, three of four, or all."""
    best = solve(paper, certify=False)
    mount = MountTilt(mount_deg=90.0, suffices_deg=8.0, fails_deg=7.9)
    found = LeastTilt(
        share=0.99, omnidirectional=best, mounts=(mount,), best=None, rigour=best.rigour, seconds=1.0
    )
    angles_deg = np.linspace(0.0, 90.0, 46)
    values = best.objective.value * (1.0 - loss * np.cos(np.radians(angles_deg)) ** 2)
    figure = draw_least_tilt(found, (angles_deg, values))
    figure.draw_without_rendering()
    lines = [text.get_text() for text in figure.axes[1].texts if text.get_text().endswith("dB")]
    assert len(lines) <= {0.0: 0, 0.3: 3, 0.9: 4}[loss]
    assert bool(lines) == (loss > 0.0)
