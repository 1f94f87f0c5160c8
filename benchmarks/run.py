"""A run: workloads measured, stored, and read back."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.machine import describe_machine, load_average
from benchmarks.metric import Metric
from benchmarks.summaries import median
from benchmarks.workload import Progress, Row, Workload

__all__ = ["Run", "measure"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What was measured, and on what.

    Args:
        quick: whether the sample was the small one, whose figures are no evidence.
        machine: pairs of name and text.
        rows: the measurements of each workload that ran, by name.
    """

    quick: bool
    machine: Mapping[str, str]
    rows: Mapping[str, Sequence[Row]]

    def metrics(self, workloads: Sequence[Workload]) -> list[Metric]:
        """Return the metrics of every workload that ran."""
        return [
            m
            for workload in workloads
            if workload.name in self.rows
            for m in workload.metrics(self.rows[workload.name])
        ]

    def save(self, path: Path) -> None:
        """Write the run as JSON."""
        content = {"quick": self.quick, "machine": dict(self.machine), "rows": dict(self.rows)}
        path.write_text(json.dumps(content), encoding="utf-8")

    @classmethod
    def load(cls, path: Path) -> Run:
        """Return a run that was written before."""
        return cls(**json.loads(path.read_text(encoding="utf-8")))


def measure(workloads: Sequence[Workload], *, quick: bool, progress: Progress, store: Path) -> Run:
    """Return a run of some workloads, the last first, which is the shortest.

    Args:
        workloads: what to measure, in the order of the report.
        quick: the small sample.
        progress: told of every step.
        store: file that the run is written to after each workload, so that a fault loses no more than one.
    """
    machine = describe_machine()
    watched = _Watched(progress)
    rows: dict[str, Sequence[Row]] = {}
    for workload in reversed(workloads):
        rows[workload.name] = workload.measure(quick=quick, progress=watched)
        run = Run(quick=quick, machine={**machine, "processes at work": watched.account()}, rows=rows)
        run.save(store)
    return run


class _Watched:
    """Progress that notes at every step how busy the machine is: other work makes times longer."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._before = load_average()
        self._loads: list[float] = []

    def begin(self, total: int) -> None:
        """Pass on how many steps there are."""
        self._progress.begin(total)

    def step(self, doing: str) -> None:
        """Pass on a step, and note the load."""
        self._loads.append(load_average())
        self._progress.step(doing)

    def account(self) -> str:
        """Return what was noted, in words."""
        usual, most = median(self._loads), max(self._loads)
        return (
            f"{self._before:.1f} before the run; during it {usual:.1f} in the median and at most {most:.1f}, "
            "the benchmark's own included"
        )
