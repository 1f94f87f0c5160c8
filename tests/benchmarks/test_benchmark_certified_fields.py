"""The workload "certified-fields": what closes, grows and holds is counted as it should be."""

import json
import math
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from benchmarks.environment import ROOT
from benchmarks.workloads.certified_fields import CertifiedFields
from benchmarks.workloads.certified_fields.judging import cell, false_bounds, growth
from benchmarks.workloads.certified_fields.record import Memory, Purpose, Record, from_rows, to_row
from benchmarks.workloads.certified_fields.running import FULL, QUICK, Plan, run, run_all
from benchmarks.workloads.fields.scenes import Scene

SCENE = Scene(nodes=2, jammers=1, jamming_ratio=10.0, seed=0)
CLOSED = Record(
    purpose=Purpose.FIELD,
    scene=SCENE,
    gap=1e-3,
    time_limit_s=10.0,
    seconds=0.1,
    boxes=100,
    status="certified",
    value=2.0,
    bound=2.0 * (1.0 + 1e-3),
)
OPEN = replace(CLOSED, status="gap-not-reached", seconds=10.2, boxes=9_000, bound=2.5)


def sized(nodes: int, seconds: float, jammers: int = 1) -> Record:
    """Return a proof in a scene of a size."""
    scene = Scene(nodes=nodes, jammers=jammers, jamming_ratio=10.0, seed=0)
    return replace(CLOSED, scene=scene, seconds=seconds)


def rows_of_a_run() -> list[dict[str, object]]:
    """Return the rows of a run whose times grow as the square of the nodes, one scene being open."""
    fields = [sized(n, 1e-3 * n**2, k) for n in (2, 10, 100) for k in (1, 3)]
    fields.append(replace(OPEN, scene=Scene(nodes=100, jammers=3, jamming_ratio=100.0, seed=3)))
    tight = [replace(sized(10, 0.3), purpose=Purpose.TIGHT, gap=1e-4, bound=2.0001)]
    hurried = [replace(OPEN, purpose=Purpose.HURRIED, time_limit_s=0.05, seconds=0.2)]
    memory = Memory(loaded_mb=200.0, peak_mb=300.0)
    return [dict(to_row(found)) for found in (*fields, *tight, *hurried, memory)]


def test_full_plan_is_the_one_asked_for() -> None:
    """360 fields, 20 closer proofs, 20 hurried solves of the largest scenes; the small one is small."""
    purposes = [purpose for purpose, *_ in FULL.solves()]
    assert [purposes.count(p) for p in Purpose] == [360, 20, 20]
    hurried = {scene for purpose, scene, _, _ in FULL.solves() if purpose is Purpose.HURRIED}
    assert {(s.nodes, s.jammers) for s in hurried} == {(100, 10)}
    assert {scene for purpose, scene, *_ in FULL.solves() if purpose is Purpose.FIELD} >= hurried
    assert max(scene.nodes for _, scene, *_ in QUICK.solves()) == 10


@pytest.mark.parametrize(
    ("changed", "closed"),
    [
        ({}, True),
        ({"status": "gap-not-reached"}, False),
        ({"status": "SolveError: no pose"}, False),
        ({"bound": 1.999}, False),
        ({"bound": 2.1}, False),
        ({"bound": math.inf}, False),
    ],
)
def test_closed_is_checked_by_the_numbers(changed: dict[str, object], closed: bool) -> None:
    """A proof counts only if its own value and bound are as close as was asked."""
    assert replace(CLOSED, **changed).closed is closed


def test_cap_is_a_failure() -> None:
    """What runs into its cap counts among all and among the times, not among the closed."""
    short = cell([CLOSED, OPEN])
    assert (short.total, short.closed, short.worst_s, short.worst_boxes) == (2, 1, 10.2, 9_000)


def test_growth_is_the_slope_of_the_medians() -> None:
    """The exponent is that of a power law, whatever outliers do; two sizes are needed."""
    records = [sized(n, 1e-3 * n**1.5) for n in (2, 3, 5, 10, 30, 100) for _ in range(3)]
    assert growth([*records, sized(2, 9.0)]) == pytest.approx(1.5)
    assert growth(records, least_nodes=10) == pytest.approx(1.5)
    assert math.isnan(growth(records[:3]))


def test_bound_below_a_pose_is_false() -> None:
    """A bound is false if any other solve of the same scene found a better pose."""
    hurried = replace(OPEN, purpose=Purpose.HURRIED, value=1.0, bound=1.9)
    assert false_bounds([CLOSED, hurried]) == [hurried]
    elsewhere = replace(hurried, scene=replace(SCENE, seed=1))
    assert false_bounds([CLOSED, elsewhere]) == []


def test_records_come_back_from_rows() -> None:
    """Rows survive JSON, the memory among them."""
    memory = Memory(loaded_mb=1.0, peak_mb=2.0)
    rows = json.loads(json.dumps([to_row(CLOSED), to_row(memory)]))
    assert from_rows(rows) == ([CLOSED], memory)
    assert math.isnan(from_rows(rows[:1])[1].peak_mb)


def test_solves_are_recorded() -> None:
    """A small plan gives a row per solve with a true bound, then the memory; an error is a row."""
    plan = Plan(nodes=(2,), jammers=(1,), jamming_ratios=(1.0,), seeds=1, tight_nodes=2)
    records, memory = from_rows(list(run_all(plan)))
    assert [record.purpose for record in records] == list(Purpose)
    assert records[0].closed
    assert records[1].closed
    assert records[0].boxes > 0
    assert false_bounds(records) == []
    assert math.isnan(memory.peak_mb) or memory.peak_mb >= memory.loaded_mb > 0.0
    assert "UsageError" in run(Purpose.FIELD, SCENE, -1.0, 10.0).status


def test_memory_is_that_of_this_process_alone() -> None:
    """The peak of a process does not begin with that of the process which started it."""
    if not Path("/proc/self/status").exists():
        pytest.skip("the system does not tell")
    ballast = bytearray(b"x" * 400_000_000)
    module = "benchmarks.workloads.certified_fields.running"
    program = f"from {module} import peak_memory_mb; print(peak_memory_mb())"
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert float(done.stdout) < 1e-6 * len(ballast)


def test_section_and_metrics_tell_failures_and_promises(tmp_path: Path) -> None:
    """What did not close is listed; promises are judged from the rows alone, and missed where they are."""
    rows = rows_of_a_run()
    text = CertifiedFields().section(rows, tmp_path).text
    assert "**6 of 7 close" in text
    assert "| N=100 K=3 P_M/P=100 seed=3 | 0.001 | gap-not-reached | 0.25 | 9,000 | 10.20 s |" in text
    assert "at most 300 MB" in text
    assert (tmp_path / "benchmark-proof-growth.png").stat().st_size > 10_000
    metrics = {metric.key: metric for metric in CertifiedFields().metrics(rows)}
    assert all(key.split(".")[0] == CertifiedFields.name for key in metrics)
    assert metrics["certified-fields.growth.k1"].value == pytest.approx(2.0)
    missed = {key for key, metric in metrics.items() if not metric.meets_limit}
    assert missed == {f"certified-fields.growth.{which}" for which in ("all", "k1", "k3")}
    assert metrics["certified-fields.hurried.worst_s"].value == pytest.approx(0.2)
