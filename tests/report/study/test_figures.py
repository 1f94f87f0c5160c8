"""What the figures show is what the statistics say, with units on every axis."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from nullpose.report.study.figures import figures_of
from nullpose.report.study.figures.curves import (
    draw_along,
    draw_distributions,
    draw_effort,
    draw_outage,
    step_curve,
)
from nullpose.report.study.figures.intervals import draw_costs, draw_gains, draw_shares
from nullpose.report.study.figures.panels import looks_of
from nullpose.report.study.statistics import band_half_width
from nullpose.report.study.summary import Summary

Summed = Callable[..., Summary]
Ladder = Callable[..., Any]
SWEEP = {"jammers.M.power_w": [0.2, 200.0]}


def test_distribution_functions(summed: Summed, ladder: Ladder) -> None:
    """A curve for each case with its band, a panel for each combination, the worst tenth marked."""
    figure = draw_distributions(summed(ladder(40, 1.0, 2.0, points=2), sweep=SWEEP))
    assert figure is not None
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["$P_M / P$ = 0.1", "$P_M / P$ = 100"]
    assert figure.get_supxlabel() == "smallest SINR over the nodes  (dB)\n"
    for axes in figure.axes:
        curves = [line for line in axes.lines if len(line.get_xdata()) > 2]
        assert len(curves) == len(axes.collections) == 3
        across, shares = curves[0].get_data()
        assert float(np.interp(-20.5, across, shares)) == pytest.approx(0.5, abs=0.03)
        tops = axes.collections[0].get_paths()[0].vertices[:, 1]
        assert float(tops.max()) <= 1.0
        assert float(tops[np.nonzero(tops)].min()) == pytest.approx(1.0 / 40.0 + band_half_width(40), abs=0.3)


def test_outage_marks_the_requirement(summed: Summed, ladder: Ladder) -> None:
    """It stands upright in every panel, within the axis even if no scene comes near it."""
    figure = draw_outage(summed(ladder(10, 1.0, 2.0), requirement=30.0))
    assert figure is not None
    (axes,) = figure.axes
    assert any(list(line.get_xdata()) == [30.0, 30.0] for line in axes.lines)
    assert axes.get_xlim()[1] > 30.0
    assert axes.get_yscale() == "log"


def test_gains_stand_at_their_medians(summed: Summed, ladder: Ladder) -> None:
    """A row for each case but the one measured against."""
    figure = draw_gains(summed(ladder(40, 1.0, 2.5)))
    assert figure is not None
    (axes,) = figure.axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["tilt-10", "omnidirectional"]
    discs = [float(line.get_xdata()[0]) for line in axes.lines if line.get_marker() == "o"]
    assert discs == pytest.approx([1.0, 2.5])
    assert "over level-vertical  (dB)" in figure.get_supxlabel()


def test_shares_and_costs(summed: Summed) -> None:
    """Bars as long as the shares; costs within the axis."""
    cases = [{"name": "free"}, {"name": "sure", "robust": True}, {"name": "up", "airframe": "level-vertical"}]
    cells = [[[3.0, 1.0 - scene, 0.0 if scene else 4.0]] for scene in range(10)]
    summary = summed(cells, cases=cases)
    shares, costs = draw_shares(summary), draw_costs(summary)
    assert shares is not None
    assert costs is not None
    assert [bar.get_width() for bar in shares.axes[0].patches] == pytest.approx([0.9, 1.0, 0.1])
    (axes,) = costs.axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["sure"]
    assert axes.get_xlim()[0] <= 0.0
    assert axes.get_xlim()[1] >= 2.0 + 8.0


def test_along_a_sweep(summed: Summed, ladder: Ladder) -> None:
    """Medians and worst tenths over a logarithmic axis where values lie far apart."""
    figure = draw_along(summed(ladder(10, 1.0, 2.0, points=2), sweep=SWEEP))
    assert figure is not None
    assert [axes.get_xscale() for axes in figure.axes] == ["log", "log"]
    lines = [axes.lines[0] for axes in figure.axes]
    assert list(lines[0].get_xdata()) == pytest.approx([0.1, 100.0])
    assert [list(line.get_ydata()) for line in lines] == [
        pytest.approx([-6.0] * 2),
        pytest.approx([-10.0] * 2),
    ]


def test_nothing_swept_is_no_curve(summed: Summed, ladder: Ladder) -> None:
    """Nor is one value of a sweep."""
    assert draw_along(summed(ladder(4, 1.0, 2.0), sweep={"jammers.M.power_w": [3.0]})) is None


def test_no_proofs_are_no_gaps(summed: Summed) -> None:
    """Time alone is drawn where nothing is proved."""
    figure = draw_effort(summed([[[(float(case), "best-found") for case in range(3)]]] * 3))
    assert figure is not None
    assert [axes.get_xlabel() for axes in figure.axes] == ["time of a solve  (s)"]


def test_all_figures_in_order(summed: Summed, ladder: Ladder) -> None:
    """Those that there is something for, each once."""
    names = [name for name, _ in figures_of(summed(ladder(4, 1.0, 2.0)))]
    assert names == ["distribution", "gain", "best", "outage", "effort"]


def test_cases_are_told_apart(summed: Summed) -> None:
    """No two have colour and line in common, robust twins and cases without a vehicle included."""
    cases = [
        {"name": "a"},
        {"name": "b", "certify": False},
        {"name": "c", "robust": True},
        {"name": "d", "scheme": "zero-interference"},
        {"name": "e", "airframe": {"tilt_max_deg": 20.0, "mount_deg": 90.0}},
        {"name": "f", "airframe": "tilt-10"},
    ]
    looks = looks_of(summed([[[0.0] * 6]], cases=cases).cases)
    assert [look.label for look in looks.values()] == list("abcdef")
    assert len({(look.colour, str(look.line)) for look in looks.values()}) == 6


def test_curves_of_very_many_scenes_are_thin() -> None:
    """Their ends, their shape and their rare low values stay."""
    numbers = np.random.default_rng(1).normal(size=50_000)
    across, shares = step_curve(numbers)
    assert len(across) <= 1000
    assert (across[0], across[-1], shares[0], shares[-1]) == (numbers.min(), numbers.max(), 0.0, 1.0)
    assert list(across[1:6]) == list(np.sort(numbers)[:5])
    assert math.isclose(float(np.interp(0.0, across, shares)), 0.5, abs_tol=0.01)


def test_an_odd_number_of_panels(summed: Summed, ladder: Ladder) -> None:
    """Three combinations have a panel each, and the fourth place is empty."""
    sweep = {"jammers.M.power_w": [0.2, 2.0, 200.0]}
    figure = draw_distributions(summed(ladder(40, 1.0, 2.0, points=3), sweep=sweep))
    assert figure is not None
    assert len(figure.axes) == 3
