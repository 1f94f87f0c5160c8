"""The reproduction as a whole: its files agree with each other and with what it returns."""

import csv
import itertools
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.image import imread

from nullpose import load
from nullpose.paper import (
    JAMMER_POWER,
    JAMMING_LEVELS,
    POSE_LEVELS,
    PRINTED_LEVELS,
    Reproduction,
    draw_figure2,
    paper_scenario,
    sinr_as_printed,
)
from nullpose.physics import min_sinr, to_db
from nullpose.report.figures.poses import draw_poses
from nullpose.report.figures.style import CURVES
from nullpose.scenario import Override, apply_overrides
from nullpose.study import ResultTable


def test_what_is_proved_as_data(reproduction: Reproduction) -> None:
    """Every point of the four curves is certified within the gap, which the object says of each curve."""
    data = reproduction.to_dict()
    assert data["scenario"] == "Bonilla Licea et al., ICASSP 2024, section 4"
    assert data["provenance"]["seed"] == 0
    assert list(data["figure2"]) == ["optimum", "zero-interference", "maximum-gain", "vertical"]
    for counts in data["figure2"].values():
        assert counts["certified"] == counts["values"] == 11
        assert counts["largest_relative_gap"] <= 1e-6


def test_figure2_csv_is_the_table(reproduction: Reproduction) -> None:
    """The data file has a row for each point of the figure."""
    (path,) = [path for path in reproduction.files if path.name == "figure2.csv"]
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(float(row["jammers.M.power_w"]), row["scheme"]) for row in rows] == [
        (row.value, row.scheme) for row in reproduction.table.rows
    ]
    assert [float(row["min_sinr_db"]) for row in rows] == [r.min_sinr_db for r in reproduction.table.rows]
    for row in rows:
        assert row["status"] == "certified"
        assert 0.0 <= float(row["relative_gap"]) <= 1e-6
        assert float(row["upper_bound_db"]) >= float(row["min_sinr_db"])


def test_the_printed_curve_has_a_file(reproduction: Reproduction) -> None:
    """Each of its points reads back to the last digit, and its value is eq. 3.5's at its position."""
    (path,) = [path for path in reproduction.files if path.name == "figure2-printed.csv"]
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(reproduction.printed) == 4
    for row, point in zip(rows, reproduction.printed, strict=True):
        assert float(row["jammers.M.power_w"]) == point.level
        assert float(row["min_sinr"]) == point.min_sinr
        assert [float(row[name]) for name in ("x_m", "y_m", "z_m")] == point.position_m.tolist()
        scene = apply_overrides(paper_scenario(), [Override(JAMMER_POWER, point.level)])
        assert point.min_sinr == sinr_as_printed(scene, point.position_m).min()


def test_rows_are_what_physics_says(reproduction: Reproduction) -> None:
    """Every value of the four curves is the equation's at the pose beside it."""
    for row in reproduction.table.rows:
        scene = apply_overrides(paper_scenario(), [Override(JAMMER_POWER, row.value)])
        assert row.min_sinr == pytest.approx(min_sinr(scene, row.pose), rel=1e-12)
        assert row.min_sinr_db == pytest.approx(float(to_db(row.min_sinr)))


def test_the_scene_is_the_example_and_levels_cover_the_figure() -> None:
    """Both curves go from 1e-3 to 1e6, and the poses are drawn at levels that the sweep has."""
    assert paper_scenario() == load(Path(__file__).parents[1] / "examples" / "paper.toml")
    for levels in (JAMMING_LEVELS, PRINTED_LEVELS):
        assert (levels[0], levels[-1]) == (1e-3, 1e6)
        assert list(levels) == sorted(set(levels))
    assert {*POSE_LEVELS, *PRINTED_LEVELS} <= set(JAMMING_LEVELS)


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
    assert "not reached at 1 of 11 points" in figure.get_supxlabel()


def test_poses_are_drawn_to_scale(reproduction: Reproduction) -> None:
    """A metre is as long both ways, and the plans' titles tell level, value and angle."""
    rows = [row for row in reproduction.table.of("optimum") if row.value in (1.0, 100.0)]
    figure = draw_poses(paper_scenario(), rows)
    assert [axes.name for axes in figure.axes] == ["rectilinear"] * 2
    for axes in figure.axes:
        assert axes.get_aspect() == pytest.approx(1.0)
        assert re.search(r"= \d+\nsmallest SINR -?\d+\.\d\d dB, null \d+\.\d° off M", axes.get_title())
