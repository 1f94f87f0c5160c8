"""The paper's figures: written as PNG and SVG, not blank, every curve on them, every panel to scale."""

import itertools
import re
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from nullpose.paper.printed import paper_scenario
from nullpose.paper.reproduce import Reproduction, draw_figure2
from nullpose.report.figures.poses import draw_poses
from nullpose.report.figures.style import CURVES
from nullpose.study import ResultTable

PRINTED_COLOUR = "#9a6060"


def share_near(picture: np.ndarray, colour: str) -> float:
    """Returns the share of pixels that are of a colour, but for the smoothing of edges."""
    return float(np.mean(np.all(np.abs(picture[..., :3] - to_rgb(colour)) < 0.08, axis=-1)))


def test_figure2_shows_every_curve_in_its_colour(reproduction: Reproduction) -> None:
    """Every case has its colour on the picture, and the printed form a picture of its own."""
    picture = imread(reproduction.files[0].with_name("figure2.png"))
    assert picture.shape[1] >= 1200
    assert picture[..., :3].std() > 0.05
    for curve in CURVES.values():
        assert share_near(picture, curve.colour) > 2e-4, curve.label
    assert share_near(picture, PRINTED_COLOUR) < 1e-5
    apart = imread(reproduction.files[0].with_name("figure2-printed.png"))
    for colour in (PRINTED_COLOUR, CURVES["maximum-gain"].colour):
        assert share_near(apart, colour) > 2e-4, colour


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


def test_figure2_says_what_is_certified(reproduction: Reproduction) -> None:
    """Small text says that every point is certified, or how many are not."""
    figure = draw_figure2(reproduction.table)
    assert "certified optimal within 1e-6" in figure.get_supxlabel()
    first, *others = reproduction.table.rows
    doubtful = replace(first, status="gap-not-reached")
    figure = draw_figure2(ResultTable(reproduction.table.path, (doubtful, *others)))
    assert "not reached at 1 of 19 points" in figure.get_supxlabel()


def test_poses_are_drawn_to_scale(reproduction: Reproduction) -> None:
    """A metre is as long both ways, and the plans' titles tell level, value and angle."""
    rows = [row for row in reproduction.table.of("optimum") if row.value in (1.0, 100.0)]
    figure = draw_poses(paper_scenario(), rows)
    assert [axes.name for axes in figure.axes] == ["rectilinear"] * 2
    for axes in figure.axes:
        assert axes.get_aspect() == pytest.approx(1.0)
        assert re.search(r"= \d+\nsmallest SINR -?\d+\.\d\d dB, null \d+\.\d° off M", axes.get_title())
