"""The command: what it refuses, and a report written from a stored run."""

from pathlib import Path

import pytest
from benchmarks.cli import WORKLOAD_NAMES, main
from benchmarks.run import Run
from benchmarks.summaries import median, percentile_95, shifted_geometric_mean
from benchmarks.workloads import WORKLOADS
from benchmarks.workloads.fields.record import Record
from benchmarks.workloads.fields.running import NULLPOSE, REFERENCE, UNBOXED
from benchmarks.workloads.fields.scenes import Scene


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--quick", "--gate"], "full runs only"),
        (["--quick", "--update-baseline"], "makes no baseline"),
        (["--cap", "0"], "seconds above 0"),
        (["--cap", "5", "--gate"], "the usual cap"),
        (["--render", "nowhere.json"], "no file"),
        (["--render", "x.json", "--quick"], "leave out"),
        (["--into-docs", "--quick"], "full measurements only"),
    ],
)
def test_senseless_command_is_refused(
    arguments: list[str], reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    """Options that contradict each other end with exit code 2 and the reason, before anything runs."""
    assert main(arguments) == 2
    assert reason in capsys.readouterr().err


def test_names_are_those_of_the_workloads() -> None:
    """The command offers exactly the workloads that there are."""
    assert tuple(workload.name for workload in WORKLOADS) == WORKLOAD_NAMES


def test_summaries_of_times() -> None:
    """The summaries are the textbook's, the shift keeping small times from ruling the mean."""
    assert median([3.0, 1.0, 2.0]) == 2.0
    assert percentile_95(range(101)) == 95.0
    assert shifted_geometric_mean([0.0, 3.0], shift=1.0) == pytest.approx(1.0)


def stored_run() -> Run:
    """Return a small run in which nullpose misses half of its scenes, and a peer and a command fail."""
    methods = (
        (NULLPOSE, "solve", 0.01),
        (UNBOXED, "solve", 0.01),
        (REFERENCE, "search", 0.2),
        ("direct", "polished", 0.3),
        ("multistart-slsqp", "8 starts", 0.02),
    )
    rows = [
        Record(
            scene=Scene(nodes=nodes, jammers=1, jamming_ratio=1.0, seed=seed),
            method=method,
            stage=stage,
            value=1.0 - 1e-3 * (method == NULLPOSE and seed == 1),
            seconds=seconds,
        ).to_row()
        for nodes in (2, 3)
        for seed in (0, 1)
        for method, stage, seconds in methods
    ]
    failed = Record(
        scene=Scene(nodes=2, jammers=1, jamming_ratio=1.0, seed=0),
        method="shgo",
        stage="failed",
        status="ValueError: too hard",
    )
    runs = [
        {"case": "help", "seconds": 0.2, "status": "ok"},
        {"case": "solve", "seconds": 9.0, "status": "exit code 1: no"},
    ]
    return Run(
        quick=False,
        machine={"processor": "of a test"},
        rows={"fields": [*rows, failed.to_row()], "startup": runs},
    )


def test_stored_run_is_told_again(tmp_path: Path) -> None:
    """A stored run gives the same page each time, with its figures, its misses and its failures."""
    results = tmp_path / "results.json"
    stored_run().save(results)
    pages = []
    for name in ("first", "second"):
        assert main(["--render", str(results), "--out", str(tmp_path / name)]) == 0
        pages.append((tmp_path / name / "benchmarks.md").read_text(encoding="utf-8"))
        assert (tmp_path / name / "images" / "benchmark-profile.png").stat().st_size > 10_000
        assert (tmp_path / name / "images" / "benchmark-growth.png").stat().st_size > 10_000
    assert pages[0] == pages[1]
    assert "**nullpose's search hits in 2 of 4 scenes" in pages[0]
    assert "| N=2 K=1 P_M/P=1 seed=1 | SciPy direct" not in pages[0]
    assert "N=2 K=1 P_M/P=1 seed=1" in pages[0]
    assert "ValueError: too hard" in pages[0]
    assert "failed: exit code 1: no" in pages[0]


def test_gate_is_shut_on_a_missed_promise(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A stored run that misses a promise ends the gate with exit code 1 and says which."""
    results = tmp_path / "results.json"
    stored_run().save(results)
    assert main(["--render", str(results), "--out", str(tmp_path), "--gate"]) == 1
    assert "fields.nullpose.hit_rate: 0.5 1 misses the promised 0.995" in capsys.readouterr().err
