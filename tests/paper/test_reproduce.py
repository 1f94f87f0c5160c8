"""The reproduction as a whole: its files agree with each other and with what it returns."""

import csv
from pathlib import Path

import pytest

from nullpose import load
from nullpose.paper.printed import (
    JAMMER_POWER,
    JAMMING_LEVELS,
    POSE_LEVELS,
    PRINTED_LEVELS,
    paper_scenario,
    sinr_as_printed,
)
from nullpose.paper.reproduce import Reproduction
from nullpose.physics import min_sinr, to_db
from nullpose.scenario import Override, apply_overrides


def test_what_is_proved_as_data(reproduction: Reproduction) -> None:
    """Every point of the four curves is certified within the gap, which the object says of each curve."""
    data = reproduction.to_dict()
    assert data["scenario"] == "Bonilla Licea et al., ICASSP 2024, section 4"
    assert data["provenance"]["seed"] == 0
    assert list(data["figure2"]) == ["optimum", "zero-interference", "maximum-gain", "vertical"]
    for counts in data["figure2"].values():
        assert counts["certified"] == counts["values"] == 19
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
    assert paper_scenario() == load(Path(__file__).parents[2] / "examples" / "paper.toml")
    for levels in (JAMMING_LEVELS, PRINTED_LEVELS):
        assert (levels[0], levels[-1]) == (1e-3, 1e6)
        assert list(levels) == sorted(set(levels))
    assert {*POSE_LEVELS, *PRINTED_LEVELS} <= set(JAMMING_LEVELS)
