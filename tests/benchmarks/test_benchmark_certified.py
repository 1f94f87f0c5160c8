"""The workload "certified": claims judged as they should be, and nothing cut away that may be an optimum."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.provers import FINISHED, NOT_CLOSED, PROVERS, Problem
from benchmarks.provers.maingo_charts import AimChart
from benchmarks.provers.problem import Scaled
from benchmarks.workloads.certified import Certified
from benchmarks.workloads.certified.judging import faults, is_true, rival, times_faster, with_best_known
from benchmarks.workloads.certified.labels import LABELS, LOOKS
from benchmarks.workloads.certified.record import Record
from benchmarks.workloads.certified.running import GAP, NULLPOSE, missing, paper_scene

from nullpose.physics import Pose, min_sinr

TRUE = Record(
    method="scip",
    jamming_ratio=1.0,
    status=FINISHED,
    claimed_value=2.0,
    claimed_bound=2.0 * (1.0 + GAP),
    value=2.0,
    seconds=3.0,
    known=2.0,
    gap=GAP,
    cap_s=100.0,
)
OURS = replace(TRUE, method=NULLPOSE, seconds=0.01)


def problem(jamming_w: float, start_value: float) -> Problem:
    """Return the paper's scene with a start of a given value; its pose does not matter here."""
    return Problem(
        nodes_m=((0.0, 0.0, 0.0), (0.0, 50.0, 0.0)),
        powers_w=(1.0, 1.0),
        jammer_m=(17.0, 15.0, 4.0),
        jamming_w=jamming_w,
        noise_w=1e-3,
        altitude_m=(8.0, 30.0),
        gap=GAP,
        cap_s=1.0,
        start_value=start_value,
        start_position_m=(-2.24, 23.82, 8.0),
        start_axis=(-0.9380, 0.2954, 0.1811),
    )


@pytest.mark.parametrize(
    ("changed", "expected"),
    [
        ({}, ()),
        ({"claimed_value": 2.0 * (1.0 + 0.09 * GAP)}, ()),
        ({"status": NOT_CLOSED, "claimed_bound": 3.0}, ("not closed",)),
        ({"status": "failed: abort"}, ("failed: abort",)),
        (
            {"claimed_value": 2.0 * (1.0 + 2.0 * GAP), "claimed_bound": 2.0 * (1.0 + 3.0 * GAP)},
            (
                "value above the optimum",
                "pose does not reach the value",
                "pose farther from the bound than the gap",
            ),
        ),
        ({"claimed_bound": 1.9999}, ("bound below a pose's value",)),
        ({"value": 1.9, "claimed_value": 1.9}, ("pose farther from the bound than the gap",)),
        (
            {"value": math.nan},
            ("pose does not reach the value", "pose farther from the bound than the gap"),
        ),
    ],
)
def test_claims_are_judged(changed: dict[str, object], expected: tuple[str, ...]) -> None:
    """A claim is true if it is closed, its pose reaches its value, and no pose is above its bound."""
    assert faults(replace(TRUE, **changed)) == expected


def test_better_pose_of_another_is_known_to_all() -> None:
    """A bound is false if the pose of any method is above it, nullpose's bound included."""
    better = replace(TRUE, value=2.1, claimed_value=2.1, claimed_bound=2.1 * (1.0 + GAP))
    judged = with_best_known([OURS, better])
    assert [is_true(record) for record in judged] == [False, True]


def test_lead_counts_true_claims_only() -> None:
    """The rival is the fastest with a true claim; nullpose's lead is infinite without one."""
    false = replace(TRUE, method="scip-plain", seconds=0.5, claimed_value=2.1)
    assert rival([OURS, false, TRUE], 1.0) is TRUE
    assert times_faster([OURS, false, TRUE], 1.0) == pytest.approx(300.0)
    assert math.isinf(times_faster([OURS, false], 1.0))
    assert math.isnan(times_faster([replace(OURS, status=NOT_CLOSED), TRUE], 1.0))


@pytest.mark.parametrize("jamming_w", [50.0, 1000.0])
def test_no_pose_as_good_as_the_start_is_cut_away(jamming_w: float) -> None:
    """Box, reach, budget, level and aim hold for every pose whose value is at least the start's."""
    scaled = Scaled(problem=problem(jamming_w, 0.7))
    scene = paper_scene(jamming_w)
    chart = AimChart(Scaled(problem=problem(jamming_w, 1.0)))
    draws = np.random.default_rng(0)
    good = aimed = 0
    for _ in range(5_000):
        position_m = draws.uniform((-15.0, 18.0, 8.0), (8.0, 32.0, 12.0))
        towards = np.array(scaled.problem.jammer_m) - position_m
        axis = towards / np.linalg.norm(towards) + draws.normal(scale=0.5 / math.sqrt(jamming_w), size=3)
        value = min_sinr(scene, Pose.from_axis(position_m, axis))
        if value < 0.7:
            continue
        good += 1
        p = position_m / scaled.unit_m
        low, high = scaled.box
        assert np.all(low <= p)
        assert np.all(p <= high)
        assert np.all(np.sum((scaled.nodes - p) ** 2, axis=1) <= scaled.reaches)
        assert value <= scaled.level_high
        assert _disturbance(scaled, p, axis) <= scaled.budget
        if value >= 1.0:
            aimed += 1
            assert np.all(np.abs(_aim(chart, p, axis)) <= chart.bounds[0][1])
    assert good > 200
    assert aimed > 5


def _disturbance(scaled: Scaled, p: np.ndarray, axis: np.ndarray) -> float:
    b = scaled.jammer - p
    sine2 = 1.0 - (axis @ b) ** 2 / (b @ b) / (axis @ axis)
    return scaled.noise + scaled.jamming * sine2 / float(b @ b)


def _aim(chart: AimChart, p: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Return the chart's variables of an axis, by solving ``u = s axis`` for them and the scale."""
    at_zero = np.array(chart.axis([0.0, 0.0], p))
    first = np.array(chart.axis([1.0, 0.0], p)) - at_zero
    second = np.array(chart.axis([0.0, 1.0], p)) - at_zero
    return np.linalg.solve(np.column_stack([first, second, -axis]), -at_zero)[:2]


def test_units_leave_the_ratios_alone() -> None:
    """Scaled numbers give the SINR of the physics."""
    scaled = Scaled(problem=problem(10.0, 1.0))
    position_m, axis = np.array([3.0, 20.0, 12.0]), np.array([0.6, 0.0, 0.8])
    p = position_m / scaled.unit_m
    a = scaled.nodes - p
    signals = scaled.powers * (1.0 / np.sum(a**2, axis=1) - (a @ axis) ** 2 / np.sum(a**2, axis=1) ** 2)
    expected = min_sinr(paper_scene(10.0), Pose.from_axis(position_m, axis))
    assert np.min(signals) / _disturbance(scaled, p, axis) == pytest.approx(expected, rel=1e-12)


def test_absent_package_is_named() -> None:
    """A prover whose package is not there is left out with the reason."""

    class Absent:
        name, label, package, settings = "absent", "Absent", "no_such_package", ""

    assert "no package no_such_package" in missing(Absent())  # type: ignore[arg-type]


def test_every_prover_has_a_name_of_its_own() -> None:
    """Names are unique, and tables and figures know each of them."""
    names = [prover.name for prover in PROVERS]
    assert len(set(names)) == len(names)
    assert set(LABELS) == set(LOOKS) == {NULLPOSE, *names}


def test_section_shows_caps_and_false_claims(tmp_path: Path) -> None:
    """Failures are rows: a cap and a false value are named, in the table and beside the time."""
    records = [
        OURS,
        TRUE,
        replace(TRUE, method="scip-plain", claimed_value=2.1, claimed_bound=2.1),
        replace(TRUE, method="maingo-axis", status=NOT_CLOSED, claimed_bound=2.2, seconds=100.0),
        Record(
            method="maingo-aim", jamming_ratio=1.0, status="failed: abort", known=2.0, gap=GAP, cap_s=100.0
        ),
    ]
    rows = [record.to_row() for record in records]
    section = Certified().section(rows, tmp_path)
    assert "| 1 | 10.0 ms | 3.00 s | not closed (100.00 s) | failed | **false** (3.00 s) | 300.0 |" in (
        section.text
    )
    assert "value above the optimum, pose does not reach the value" in section.text
    assert "failed: abort" in section.text
    assert (tmp_path / "benchmark-certified.png").stat().st_size > 10_000
    metrics = {metric.key: metric for metric in Certified().metrics(rows)}
    assert metrics["certified.times_faster"].value == pytest.approx(300.0)
    assert metrics["certified.scip.closed"].value == 1.0
    assert metrics["certified.maingo-axis.closed"].value == 0.0
