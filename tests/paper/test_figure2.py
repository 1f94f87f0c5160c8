"""The paper's figures: written as PNG and SVG, not blank, every curve on them, every panel to scale."""

import itertools
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from nullpose import Scenario
from nullpose.paper.figure2 import draw_figure2
from nullpose.paper.reproduce import Reproduction
from nullpose.report.figures.poses import draw_poses
from nullpose.report.figures.style import CURVES, write_figure
from nullpose.report.figures.sweep import draw_sweep
from nullpose.solver import Objective
from nullpose.study import SweepTable

PRINTED_COLOUR = "#9a6060"


def share_near(picture: np.ndarray, colour: str) -> float:
    """Returns the share of pixels that are of a colour, but for the smoothing of edges."""
    return float(np.mean(np.all(np.abs(picture[..., :3] - to_rgb(colour)) < 0.08, axis=-1)))


@pytest.fixture(scope="module")
def folder(reproduction: Reproduction) -> Path:
    """Where the reproduction's files are."""
    return reproduction.files[0].parent


def test_figure2_shows_every_curve_in_its_colour(folder: Path) -> None:
    """Blue, black, red and magenta are on the picture, and the printed form."""
    picture = imread(folder / "figure2.png")
    assert picture.shape[1] >= 1200
    assert picture[..., :3].std() > 0.05
    for colour in (*(curve.colour for curve in CURVES.values()), PRINTED_COLOUR):
        assert share_near(picture, colour) > 2e-4, colour


def test_figure2_has_labels_and_units(reproduction: Reproduction) -> None:
    """Axes are named with units, and each curve is labelled once."""
    figure = draw_figure2(reproduction.table, reproduction.printed)
    (axes,) = figure.axes
    assert "P_M/P" in axes.get_xlabel()
    assert "(dB)" in axes.get_ylabel()
    assert axes.get_xscale() == "log"
    texts = " ".join(text.get_text() for text in axes.texts)
    assert all(curve.label in texts for curve in CURVES.values())
    assert "maximum gain, eq. 3.5 as printed" in texts


def test_figure2_labels_cover_nothing(reproduction: Reproduction) -> None:
    """No label overlaps another, and no label lies on a curve other than its own."""
    figure = draw_figure2(reproduction.table, reproduction.printed)
    figure.draw_without_rendering()
    (axes,) = figure.axes
    boxes = [text.get_window_extent() for text in axes.texts]
    for index, box in enumerate(boxes):
        assert not any(box.overlaps(other) for other in boxes[index + 1 :])
        for line in axes.lines:
            points = axes.transData.transform(line.get_xydata())
            fine = np.vstack([np.linspace(a, b, 50) for a, b in itertools.pairwise(points)])
            assert not any(box.contains(*point) for point in fine), (axes.texts[index].get_text(), line)


def test_poses_figure_is_not_blank(folder: Path) -> None:
    """Three panels with nodes, jammer and pattern."""
    picture = imread(folder / "poses.png")
    for panel in np.array_split(picture, 3, axis=1):
        assert share_near(panel, "#d40000") > 1e-4
        assert share_near(panel, "#0a6f3c") > 1e-4
        assert panel[..., :3].std() > 0.03


@pytest.mark.parametrize("name", ["figure2.svg", "poses.svg"])
def test_svg_is_whole_and_undated(folder: Path, name: str) -> None:
    """The vector files end as they should, and carry no date that would change them from run to run."""
    text = (folder / name).read_text(encoding="utf-8")
    assert text.rstrip().endswith("</svg>")
    assert "<dc:date>" not in text


def test_same_figure_same_files(reproduction: Reproduction, tmp_path: Path) -> None:
    """Drawing twice gives the same bytes."""
    written = [
        write_figure(draw_figure2(reproduction.table, reproduction.printed), tmp_path, stem)
        for stem in ("first", "second")
    ]
    for first, second in zip(*written, strict=True):
        assert first.read_bytes() == second.read_bytes()


def test_a_node_in_the_null_leaves_a_gap(reproduction: Reproduction) -> None:
    """A value of minus infinity is drawn as a gap and does not spoil the axis."""
    row = reproduction.table.rows[0]
    nothing = Objective(name="min_sinr", value=0.0, value_db=-np.inf)
    silent = replace(row, value=2.0, objective=nothing)
    figure = draw_sweep(SweepTable("jammers.M.power_w", (row, silent)))
    assert np.all(np.isfinite(figure.axes[0].get_ylim()))


def test_figure2_says_what_is_certified(reproduction: Reproduction) -> None:
    """The four curves have their bands, and small text says that every point is certified, or how many."""
    figure = draw_figure2(reproduction.table, reproduction.printed)
    assert sum(isinstance(one, PolyCollection) for one in figure.axes[0].collections) == 4
    assert "certified optimal within 1e-6" in figure.get_supxlabel()
    assert "as printed: best found by search" in figure.get_supxlabel()
    first, *others = reproduction.table.rows
    doubtful = replace(first, status="gap-not-reached")
    figure = draw_figure2(SweepTable(reproduction.table.path, (doubtful, *others)), reproduction.printed)
    assert "not reached at 1 of 19 points" in figure.get_supxlabel()


def test_poses_are_drawn_to_scale(reproduction: Reproduction, paper: Scenario) -> None:
    """One metre is as long along each axis, and the panels' titles tell level, value and angle."""
    rows = [row for row in reproduction.table.of("optimum") if row.value in (1.0, 100.0)]
    figure = draw_poses(paper, rows)
    assert len(figure.axes) == 2
    for axes in figure.axes:
        sides = np.array([np.diff(axes.get_xlim3d()), np.diff(axes.get_ylim3d()), np.diff(axes.get_zlim3d())])
        ratios = sides.ravel() / axes._box_aspect
        assert ratios == pytest.approx([ratios[0]] * 3)
        assert re.search(r"= \d+\nsmallest SINR -?\d+\.\d\d dB, null \d+\.\d° off M", axes.get_title())


def test_pyplot_is_never_used(reproduction: Reproduction) -> None:
    """Figures are made without the global state that pyplot keeps."""
    import sys

    draw_figure2(reproduction.table, reproduction.printed)
    pyplot = sys.modules.get("matplotlib.pyplot")
    assert pyplot is None or pyplot.get_fignums() == []
