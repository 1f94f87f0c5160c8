"""The committed baseline, and what a run is worse in."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from benchmarks.metric import Metric

__all__ = ["BASELINE", "Verdict", "judge", "load_baseline", "write_baseline"]

BASELINE = Path(__file__).with_name("baseline.json")


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """A metric beside its baseline.

    Args:
        metric: as measured now.
        baseline: its committed value; None if there is none.
    """

    metric: Metric
    baseline: float | None

    @property
    def fault(self) -> str:
        """What is wrong, in words; empty if nothing is."""
        metric = self.metric
        if not metric.meets_limit:
            return f"{metric.value:.4g} {metric.unit} misses the promised {metric.limit:g}"
        if self.baseline is None:
            return "not in the baseline; add it with --update-baseline"
        if metric.regressed_from(self.baseline):
            return f"{metric.value:.4g} {metric.unit} is worse than the baseline's {self.baseline:.4g}"
        return ""


def judge(metrics: Iterable[Metric], baseline: Mapping[str, float], ran: Iterable[str]) -> list[str]:
    """Return what is wrong with a run, a line each: promises missed, regressions, metrics gone.

    Args:
        metrics: of the run.
        baseline: committed values by key.
        ran: names of the workloads that ran; the baseline's others are not asked for.
    """
    measured = list(metrics)
    verdicts = [Verdict(metric=metric, baseline=baseline.get(metric.key)) for metric in measured]
    faults = [f"{verdict.metric.key}: {verdict.fault}" for verdict in verdicts if verdict.fault]
    names = {metric.key for metric in measured}
    workloads = set(ran)
    gone = [key for key in baseline if key not in names and key.split(".")[0] in workloads]
    return faults + [f"{key}: in the baseline, but not measured" for key in gone]


def load_baseline(path: Path = BASELINE) -> dict[str, float]:
    """Return the committed values by key; nothing if there is no baseline yet."""
    if not path.exists():
        return {}
    found = json.loads(path.read_text(encoding="utf-8"))
    return {key: float(entry["value"]) for key, entry in found["metrics"].items()}


def write_baseline(
    metrics: Iterable[Metric], machine: Mapping[str, str], ran: Iterable[str], path: Path = BASELINE
) -> None:
    """Write the metrics as the new baseline, those of workloads that did not run staying as they are.

    Args:
        metrics: of the run.
        machine: what it ran on.
        ran: names of the workloads that ran.
        path: the file.
    """
    stored = json.loads(path.read_text(encoding="utf-8"))["metrics"] if path.exists() else {}
    workloads = set(ran)
    kept = {key: entry for key, entry in stored.items() if key.split(".")[0] not in workloads}
    fresh = {metric.key: {"value": metric.value, "unit": metric.unit} for metric in metrics}
    content = {"machine": dict(machine), "metrics": dict(sorted({**kept, **fresh}.items()))}
    path.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")
