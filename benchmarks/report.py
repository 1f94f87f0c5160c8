"""The page that a run is told by. Nothing in it is written by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from benchmarks.baseline import Verdict
from benchmarks.markdown import table
from benchmarks.metric import Direction, Metric
from benchmarks.run import Run
from benchmarks.workload import Section, Workload

__all__ = ["write_report"]


def write_report(
    run: Run, workloads: Sequence[Workload], baseline: Mapping[str, float], folder: Path
) -> Path:
    """Return the page, ``benchmarks.md``, after writing it and its figures.

    Args:
        run: what was measured.
        workloads: those that may be in it.
        baseline: committed values, to set the measured ones beside.
        folder: existing folder; the figures go to its ``images``.
    """
    images = folder / "images"
    images.mkdir(exist_ok=True)
    told = [workload for workload in workloads if workload.name in run.rows]
    sections = {w.name: w.section(run.rows[w.name], images) for w in told}
    metrics = run.metrics(told)
    parts = [
        "# Benchmarks",
        "Written by `make bench` (`python -m benchmarks`); not to be edited by hand.",
        _warning(run),
        "## What was promised",
        _promises(metrics, quick=run.quick),
        *(part for w in told for part in (f"## {w.title}", sections[w.name].text)),
        "## What was run on what",
        table(("", ""), run.machine.items(), text_columns=2),
        _settings(sections),
        "## Known limitations",
        _limitations(sections),
        "## Every metric",
        _metrics(metrics, baseline),
    ]
    page = folder / "benchmarks.md"
    page.write_text("\n\n".join(part for part in parts if part) + "\n", encoding="utf-8")
    return page


def _warning(run: Run) -> str:
    return "**A quick run: it shows that everything runs; its figures are no evidence.**" if run.quick else ""


def _promises(metrics: Sequence[Metric], *, quick: bool) -> str:
    if quick:
        return "A quick run is too small to judge a promise by."
    promised = [metric for metric in metrics if metric.limit is not None]
    if not promised:
        return "Nothing that ran has a promise."
    return table(
        ("promise", "measured", "promised", "met"),
        [
            (
                metric.about,
                _number(metric.value, metric.unit),
                _bar(metric),
                "yes" if metric.meets_limit else "**no**",
            )
            for metric in promised
        ],
    )


def _settings(sections: Mapping[str, Section]) -> str:
    settings = [pair for section in sections.values() for pair in section.settings]
    return table(("method", "settings"), settings, text_columns=2) if settings else ""


def _limitations(sections: Mapping[str, Section]) -> str:
    every = [sentence for section in sections.values() for sentence in section.limitations]
    every.append("All times are from one machine, the one above; the ratios travel better than the times.")
    return "\n".join(f"- {sentence}" for sentence in every)


def _metrics(metrics: Sequence[Metric], baseline: Mapping[str, float]) -> str:
    verdicts = [Verdict(metric=metric, baseline=baseline.get(metric.key)) for metric in metrics]
    return table(
        ("key", "value", "baseline", "better", "may worsen by"),
        [
            (
                f"`{v.metric.key}`",
                _number(v.metric.value, v.metric.unit),
                "" if v.baseline is None else _number(v.baseline, v.metric.unit),
                v.metric.direction.value,
                _number(v.metric.tolerance.margin(v.baseline or v.metric.value), v.metric.unit),
            )
            for v in verdicts
        ],
    )


def _bar(metric: Metric) -> str:
    limit = _number(float("nan") if metric.limit is None else metric.limit, metric.unit)
    return f"at {'most' if metric.direction is Direction.LOWER else 'least'} {limit}"


def _number(value: float, unit: str) -> str:
    digits = f"{value:,.0f}" if 1e3 <= abs(value) < 1e9 else f"{value:.4g}"
    return digits if unit == "1" else f"{digits} {unit}"
