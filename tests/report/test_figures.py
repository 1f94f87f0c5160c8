"""Figures: written as PNG and SVG, not blank, every curve on them, the pattern of the right shape."""

import itertools
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.image import imread

from nullpose import Pose, Scenario
from nullpose.report.figures import draw_figure2, draw_poses, draw_sweep
from nullpose.report.figures.pattern import pattern_surface_m
from nullpose.report.figures.style import CURVES, write_figure
from nullpose.report.reproduce import Reproduction
from nullpose.solve import Objective, Scheme
from nullpose.study import SweepTable, sweep


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
    for curve in CURVES.values():
        assert share_near(picture, curve.colour) > 2e-4, curve.label


def test_curves_differ_in_more_than_colour() -> None:
    """Without colours, line and marker still tell any two schemes apart."""
    looks = {(str(curve.line), curve.marker) for curve in CURVES.values()}
    assert len(looks) == len(CURVES)
    assert set(CURVES) == {scheme.value for scheme in Scheme}


def test_figure2_has_labels_and_units(reproduction: Reproduction) -> None:
    """Axes are named with units, and each curve is labelled once."""
    figure = draw_figure2(reproduction.table)
    (axes,) = figure.axes
    assert "P_M/P" in axes.get_xlabel()
    assert "(dB)" in axes.get_ylabel()
    assert axes.get_xscale() == "log"
    texts = " ".join(text.get_text() for text in axes.texts)
    assert all(curve.label in texts for curve in CURVES.values())


def test_figure2_labels_cover_nothing(reproduction: Reproduction) -> None:
    """No label overlaps another, and no label lies on a curve other than its own."""
    figure = draw_figure2(reproduction.table)
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
    written = [write_figure(draw_figure2(reproduction.table), tmp_path, stem) for stem in ("first", "second")]
    for first, second in zip(*written, strict=True):
        assert first.read_bytes() == second.read_bytes()


@pytest.mark.parametrize("log", [False, True])
def test_any_sweep_can_be_drawn(paper: Scenario, log: bool) -> None:
    """The setting is named on its axis with its unit, and the legend has each scheme."""
    table = sweep(paper, "jammers.M.position_m[0]", [10.0, 17.0, 30.0])
    figure = draw_sweep(table, log=log)
    (axes,) = figure.axes
    assert axes.get_xlabel() == "jammers.M.position_m[0]  (m)"
    assert axes.get_xscale() == ("log" if log else "linear")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == [CURVES[s].label for s in table.schemes]


def test_a_node_in_the_null_leaves_a_gap(reproduction: Reproduction) -> None:
    """A value of minus infinity is drawn as a gap and does not spoil the axis."""
    row = reproduction.table.rows[0]
    nothing = Objective(name="min_sinr", value=0.0, value_db=-np.inf)
    silent = type(row)(2.0, row.scheme, row.status, nothing, row.pose, row.links)
    figure = draw_sweep(SweepTable("jammers.M.power_w", (row, silent)))
    assert np.all(np.isfinite(figure.axes[0].get_ylim()))


def bands_of(figure: Figure) -> list[PolyCollection]:
    """Returns the bands of a figure's first axes."""
    return [one for one in figure.axes[0].collections if isinstance(one, PolyCollection)]


def test_figure2_says_what_is_certified(reproduction: Reproduction) -> None:
    """The four curves have their bands, and small text says that every point is certified, or how many."""
    figure = draw_figure2(reproduction.table)
    assert len(bands_of(figure)) == 4
    assert "Every point of the four curves is certified" in figure.get_supxlabel()
    assert "within 1e-6" in figure.get_supxlabel()
    first, *others = reproduction.table.rows
    doubtful = replace(first, status="gap-not-reached")
    figure = draw_figure2(SweepTable(reproduction.table.path, (doubtful, *others)))
    assert figure.get_supxlabel().startswith("75 of 76 points of the four curves are certified")


def test_visible_bounds_are_drawn(paper: Scenario) -> None:
    """A bound farther off than the width of a line is a mark above its value, and the caption explains it."""
    near = draw_sweep(sweep(paper, "jammers.M.power_w", [0.5, 1.0, 2.0], schemes=["optimum"]))
    assert [len(near.axes[0].lines), len(bands_of(near))] == [1, 1]
    assert near.get_supxlabel().startswith("Certified to 1e-6")
    far = sweep(paper, "jammers.M.power_w", [0.5, 1.0, 2.0], schemes=["optimum"], gap=0.5)
    assert all(row.relative_gap > 0.1 for row in far.rows)
    figure = draw_sweep(far)
    _, marks = figure.axes[0].lines
    assert list(marks.get_ydata()) == [row.upper_bound_db for row in far.rows]
    assert figure.axes[0].get_ylim()[1] > max(row.upper_bound_db for row in far.rows)
    assert "Bands reach" in figure.get_supxlabel()
    (legend,) = figure.legends
    assert len(legend.get_texts()) == 1


def test_hopeless_bounds_leave_the_curves_readable(paper: Scenario) -> None:
    """A bound tens of decibels above does not squeeze the curves into a line at the bottom."""
    table = sweep(paper, "jammers.M.power_w", [0.01, 1.0, 100.0], schemes=["vertical"])
    rows = [
        replace(row, objective=replace(row.objective, upper_bound=1e6, relative_gap=1e6))
        for row in table.rows
    ]
    low, high = draw_sweep(SweepTable(table.path, tuple(rows))).axes[0].get_ylim()
    values = [row.min_sinr_db for row in rows]
    assert low < min(values)
    assert max(values) < high < max(values) + 10.0


def test_nothing_proved_is_said_below_the_figure(paper: Scenario) -> None:
    """Without proofs there are no bands, and the caption does not call anything certified."""
    figure = draw_sweep(sweep(paper, "jammers.M.power_w", [0.5, 1.0], certify=False))
    assert bands_of(figure) == []
    assert figure.get_supxlabel() == "Best found by searching, nothing is proved."


@pytest.mark.parametrize("axis", [(0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (-0.9, 0.4, 0.2)])
def test_pattern_is_sine_squared(axis: tuple[float, float, float]) -> None:
    """In each direction the surface is as far from the drone as the gain there, and zero along the axis."""
    pose = Pose.from_axis(np.array([1.0, -2.0, 8.0]), axis)
    points = (
        pattern_surface_m(pose, 7.5, np.linspace(0.0, 2.0 * np.pi, 13)).reshape(3, -1).T - pose.position_m
    )
    radii = np.linalg.norm(points, axis=1)
    far = radii > 1e-6
    cosines = points[far] @ pose.antenna_axis / radii[far]
    assert radii[far] == pytest.approx(7.5 * (1.0 - cosines**2), abs=1e-9)
    assert radii.max() == pytest.approx(7.5)
    assert radii.min() == pytest.approx(0.0, abs=1e-9)


def test_poses_are_drawn_to_scale(reproduction: Reproduction, paper: Scenario) -> None:
    """One metre is as long along each axis, and the panels' titles tell level, value and angle."""
    rows = [row for row in reproduction.table.of("optimum") if row.value in (1.0, 100.0)]
    figure = draw_poses(paper, rows)
    assert len(figure.axes) == 2
    for axes in figure.axes:
        sides = np.array([np.diff(axes.get_xlim3d()), np.diff(axes.get_ylim3d()), np.diff(axes.get_zlim3d())])
        ratios = sides.ravel() / axes._box_aspect
        assert ratios == pytest.approx([ratios[0]] * 3)
        assert re.search(
            r"= \d+\nsmallest SINR -?\d+\.\d\d dB, null \d+\.\d° off the jammer", axes.get_title()
        )


def test_pyplot_is_never_used(reproduction: Reproduction) -> None:
    """Figures are made without the global state that pyplot keeps."""
    import sys

    draw_figure2(reproduction.table)
    pyplot = sys.modules.get("matplotlib.pyplot")
    assert pyplot is None or pyplot.get_fignums() == []
