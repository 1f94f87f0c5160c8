"""The figures show the statistics, with units on every axis."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from matplotlib.collections import PathCollection

from nullpose.report.study.figures import figures_of, step_curve
from nullpose.report.study.summary import Summary, band_half_width

Summed = Callable[..., Summary]
Ladder = Callable[..., Any]


def test_distribution_functions(summed: Summed, ladder: Ladder) -> None:
    """A curve for each case with its band, a panel for each combination, the worst tenth marked."""
    sweep = {"jammers.M.power_w": [0.2, 2.0, 200.0]}
    figure = figures_of(summed(ladder(40, 1.0, 2.0, points=3), sweep=sweep))["distribution"]
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert titles == [f"jammers.M.power_w = {watts} W" for watts in ("0.2", "2", "200")]
    assert figure.get_supxlabel() == "smallest SINR over the nodes (dB)"
    for axes in figure.axes:
        curves = [line for line in axes.lines if len(line.get_xdata()) > 2]
        assert len(curves) == len(axes.collections) == 3
        across, shares = curves[0].get_data()
        assert float(np.interp(-20.5, across, shares)) == pytest.approx(0.5, abs=0.03)
        tops = axes.collections[0].get_paths()[0].vertices[:, 1]
        assert float(tops.max()) <= 1.0
        assert float(tops[np.nonzero(tops)].min()) == pytest.approx(1.0 / 40.0 + band_half_width(40), abs=0.3)


def test_gains_stand_at_their_medians(summed: Summed, ladder: Ladder) -> None:
    """A row for each case but the reference."""
    figure = figures_of(summed(ladder(40, 1.0, 2.5)))["gain"]
    (axes,) = figure.axes
    assert [label.get_text() for label in axes.get_yticklabels()] == ["tilt-10-horizontal", "omnidirectional"]
    discs, _ = (one for one in axes.collections if isinstance(one, PathCollection))
    assert discs.get_offsets()[:, 0].tolist() == pytest.approx([1.0, 2.5])
    assert "over level-vertical (dB)" in figure.get_supxlabel()


def test_cases_look_different(summed: Summed) -> None:
    """No two have colour and line in common, robust twins and cases without a vehicle included."""
    cases = [
        {"name": "a"},
        {"name": "b", "certify": False},
        {"name": "c", "robust": True},
        {"name": "d", "scheme": "zero-interference"},
        {"name": "e", "airframe": {"tilt_max_deg": 20.0, "mount_deg": 90.0}},
        {"name": "f", "airframe": "tilt-10-horizontal"},
    ]
    (legend,) = figures_of(summed([[[0.0] * 6]], cases=cases))["distribution"].legends
    lines = legend.get_lines()
    assert [text.get_text() for text in legend.get_texts()] == list("abcdef")
    assert len({(line.get_color(), str(line._dash_pattern)) for line in lines}) == 6


def test_curves_of_very_many_scenes_are_thin() -> None:
    """Their ends and their shape stay."""
    numbers = np.random.default_rng(1).normal(size=50_000)
    across, shares = step_curve(numbers)
    assert len(across) <= 1001
    assert (across[0], across[-1], shares[0], shares[-1]) == (numbers.min(), numbers.max(), 0.0, 1.0)
    assert float(np.interp(0.0, across, shares)) == pytest.approx(0.5, abs=0.01)
