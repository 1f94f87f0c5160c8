"""The statistics of studies whose rows are made up."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from nullpose import UsageError
from nullpose.report.study.summary import Summary

Summed = Callable[..., Summary]
Ladder = Callable[..., Any]


def _row(summary: Summary, name: str, point: int = 0) -> Any:
    return summary.row(point, name)


def test_levels_and_gains(summed: Summed, ladder: Ladder) -> None:
    """Median, worst tenth and gains of a ladder of values, where they can be told by hand."""
    summary = summed(ladder(100, 2.0, 4.0))
    level, whole = _row(summary, "level-vertical"), _row(summary, "omnidirectional")
    assert (level["median"], level["worst_tenth"], level["best_tenth"]) == pytest.approx((-51, -91, -11))
    assert (whole["median"], whole["worst_tenth"]) == pytest.approx((-47, -87))
    assert (whole["gain_median"], whole["gain_worst_tenth"], whole["shift_worst_tenth"]) == pytest.approx(
        (4.0, 4.0, 4.0)
    )
    assert (whole["against"], whole["pairs"]) == ("level-vertical", 100)
    tilted = _row(summary, "tilt-10-horizontal")
    assert (tilted["difference_median"], tilted["difference_worst_tenth"]) == pytest.approx((-2.0, -2.0))
    ends = tilted["difference_median_low"], tilted["difference_median_high"]
    assert ends == pytest.approx((-2.0, -2.0))


def test_gains_are_paired(summed: Summed) -> None:
    """The median gain is of differences on the same scene, not the difference of two medians."""
    cells = [[[-10.0, 0.0, 0.0]], [[0.0, 1.0, 1.0]], [[1.0, 2.0, 2.0]]]
    row = _row(summed(cells), "omnidirectional")
    assert row["gain_median"] == pytest.approx(1.0)
    assert row["shift_worst_tenth"] == pytest.approx(10.0)


def test_another_case_to_measure_against(summed: Summed, ladder: Ladder) -> None:
    """Gains turn with the reference; a name that is no case is told with those that are."""
    row = _row(summed(ladder(10, 2.0, 4.0), against="omnidirectional"), "level-vertical")
    assert (row["against"], row["gain_median"]) == ("omnidirectional", pytest.approx(-4.0))


def test_a_wrong_name_to_measure_against(summed: Summed, ladder: Ladder) -> None:
    """It is told with the names that there are."""
    with pytest.raises(
        UsageError, match=r"against: given 'level'; allowed: level-vertical, tilt-10-horizontal"
    ):
        summed(ladder(2, 0.0, 0.0), against="level")


def test_failures_are_in_no_distribution(summed: Summed) -> None:
    """They are counted apart, and a pair with one of them is none."""
    summary = summed([[[-2.0, "no room", 1.0]], [[-1.0, 0.0, "no room"]]], requirement=0.5)
    row = _row(summary, "omnidirectional")
    assert (row["certified"], row["failed"], row["pairs"]) == (1, 1, 1)
    assert (row["median"], row["outage"]) == (pytest.approx(1.0), 0.0)


def test_outage(summed: Summed, ladder: Ladder) -> None:
    """What misses a requirement by its value, and of that what is proved to miss it with any pose."""
    cells = ladder(10, 0.0, 0.0)
    cells[4][0][0] = (-5.0, "gap-not-reached")  # up to -3.2 dB are not excluded
    row = _row(summed(cells, requirement=-4.5), "level-vertical")
    assert (row["outage"], row["outage_proved"]) == (0.6, 0.5)
    assert row["outage_low"] < 0.6 < row["outage_high"]


def test_time_and_gaps(summed: Summed, ladder: Ladder) -> None:
    """Median, 95th percentile and worst of what was needed and reached."""
    row = _row(summed(ladder(20, 0.0, 0.0)), "tilt-10-horizontal")
    assert (row["seconds_median"], row["seconds_p95"], row["seconds_worst"]) == pytest.approx(
        (0.1, 0.19, 0.2)
    )
    assert (row["gap_median"], row["gap_worst"], row["proved"]) == (
        pytest.approx(1e-3),
        pytest.approx(1e-3),
        20,
    )


def test_units_stand_in_the_columns(summed: Summed, ladder: Ladder) -> None:
    """A file says what its numbers are; shares and counts have no unit."""
    names = set(summed(ladder(3, 1.0, 2.0)).table().columns)
    assert {"median_db", "worst_tenth_low_db", "gain_median_db", "shift_worst_tenth_db"} <= names
    assert {"null_share", "difference_median_db", "seconds_worst", "gap_worst"} <= names


def test_robust_cases_keep_to_themselves(summed: Summed) -> None:
    """A guaranteed value is compared with guaranteed values."""
    cases = [
        {"name": "level", "airframe": "level-vertical"},
        {"name": "free"},
        {"name": "free robust", "robust": True},
        {"name": "level robust", "airframe": "level-vertical", "robust": True},
    ]
    summary = summed([[[0.0, 3.0, 2.0, -2.0]], [[0.0, 4.0, 2.0, -1.0]]], cases=cases)
    free, level = _row(summary, "free robust"), _row(summary, "level robust")
    assert (free["against"], level["against"]) == ("level robust", "level robust")


def test_no_signal_at_all(summed: Summed) -> None:
    """An SINR of nothing is minus infinity in dB, and no gain over itself."""
    cells = [[[-math.inf, -math.inf, 0.0]], [[0.0, 0.0, 1.0]], [[-math.inf, 1.0, 2.0]]]
    summary = summed(cells)
    assert _row(summary, "level-vertical")["median"] == -math.inf
    assert _row(summary, "tilt-10-horizontal")["gain_median"] == 0.0
    assert _row(summary, "tilt-10-horizontal")["difference_median"] == -math.inf
