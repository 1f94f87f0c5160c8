"""The page that a run is told by. Nothing in it is written by hand."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from benchmarks.baseline import Verdict
from benchmarks.markdown import table
from benchmarks.metric import Direction, Metric
from benchmarks.run import Run
from benchmarks.told import Told
from benchmarks.workload import Section, Workload

__all__ = ["tell", "write_report"]

_EARLIER = " (measured earlier)"


def tell(run: Run, workloads: Sequence[Workload], folder: Path) -> dict[str, Told]:
    """Return what there is to tell of each workload that ran, its figures written to ``images``.

    Args:
        run: what was measured.
        workloads: those that may be in it.
        folder: existing folder of the page.
    """
    images = folder / "images"
    images.mkdir(exist_ok=True)
    return {
        w.name: Told(
            title=w.title,
            machine=run.machine,
            metrics=tuple(w.metrics(run.rows[w.name])),
            section=w.section(run.rows[w.name], images),
        )
        for w in workloads
        if w.name in run.rows
    }


def write_report(
    run: Run,
    fresh: Mapping[str, Told],
    earlier: Mapping[str, Told],
    baseline: Mapping[str, float],
    folder: Path,
) -> Path:
    """Return the page, ``benchmarks.md``, after writing it.

    Args:
        run: what was measured.
        fresh: what there is to tell of it, by workload, in the order of the page.
        earlier: what was told before of workloads that did not run; they come last.
        baseline: committed values, to set the measured ones beside.
        folder: existing folder.
    """
    old = {name: told for name, told in earlier.items() if name not in fresh}
    every = [*fresh.values(), *old.values()]
    sections = [told.section for told in every]
    metrics = [metric for told in every for metric in told.metrics]
    old_keys = {metric.key for told in old.values() for metric in told.metrics}
    parts = [
        "# Benchmarks",
        _written(fresh, old),
        _warning(run),
        "" if run.quick else _opening(metrics, sections, old_keys),
        "## What was promised",
        _promises(metrics, old_keys, quick=run.quick),
        *(part for told in fresh.values() for part in (f"## {told.title}", told.section.text)),
        *(part for told in old.values() for part in (f"## {told.title}", told.note, told.section.text)),
        "## What was run on what",
        table(("", ""), run.machine.items(), text_columns=2),
        _settings(fresh.values(), old.values()),
        "## Known limitations",
        _limitations(sections),
        "## Every metric",
        _metrics(metrics, old_keys, baseline),
    ]
    page = folder / "benchmarks.md"
    page.write_text("\n\n".join(part for part in parts if part) + "\n", encoding="utf-8")
    return page


def _written(fresh: Mapping[str, Told], old: Mapping[str, Told]) -> str:
    if not old:
        return "Written by `make bench` (`python -m benchmarks`); not to be edited by hand."
    options = " ".join(f"--only {name}" for name in fresh)
    return (
        f"Written by `python -m benchmarks {options} --into-docs`; not to be edited by hand. "
        f"What was measured earlier says so: {', '.join(f'*{told.title}*' for told in old.values())}. "
        "`make bench` measures everything anew."
    )


def _warning(run: Run) -> str:
    return "**A quick run: it shows that everything runs; its figures are no evidence.**" if run.quick else ""


def _opening(metrics: Sequence[Metric], sections: Sequence[Section], earlier: Collection[str]) -> str:
    """Return which promises are met and which are missed, in sentences."""
    promised = [metric for metric in metrics if metric.limit is not None]
    missed = [metric for metric in promised if not metric.meets_limit]
    met = [metric for metric in promised if metric.meets_limit]
    parts = [
        f"**Of {len(promised)} promises {len(met)} are met and {len(missed)} missed.**" if promised else "",
        "Missed:\n\n" + _measured(missed, earlier) if missed else "",
        *(section.headline for section in sections),
        "Met:\n\n" + _measured(met, earlier) if met else "",
    ]
    return "\n\n".join(part for part in parts if part)


def _measured(metrics: Sequence[Metric], earlier: Collection[str]) -> str:
    return "\n".join(
        f"- {_about(metric, earlier)}: {_number(metric.value, metric.unit)}, promised {_bar(metric)}"
        for metric in metrics
    )


def _promises(metrics: Sequence[Metric], earlier: Collection[str], *, quick: bool) -> str:
    if quick:
        return "A quick run is too small to judge a promise by."
    promised = [metric for metric in metrics if metric.limit is not None]
    if not promised:
        return "Nothing that ran has a promise."
    return table(
        ("promise", "measured", "promised", "met"),
        [
            (
                _about(metric, earlier),
                _number(metric.value, metric.unit),
                _bar(metric),
                "yes" if metric.meets_limit else "**no**",
            )
            for metric in promised
        ],
    )


def _about(metric: Metric, earlier: Collection[str]) -> str:
    return metric.about + (_EARLIER if metric.key in earlier else "")


def _settings(fresh: Collection[Told], old: Collection[Told]) -> str:
    settings = [pair for told in fresh for pair in told.section.settings]
    settings += [(f"{name}{_EARLIER}", text) for told in old for name, text in told.section.settings]
    return table(("method", "settings"), settings, text_columns=2) if settings else ""


def _limitations(sections: Sequence[Section]) -> str:
    every = [sentence for section in sections for sentence in section.limitations]
    every.append("All times are from the machine above. Ratios of times depend less on the machine.")
    return "\n".join(f"- {sentence}" for sentence in every)


def _metrics(metrics: Sequence[Metric], earlier: Collection[str], baseline: Mapping[str, float]) -> str:
    verdicts = [Verdict(metric=metric, baseline=baseline.get(metric.key)) for metric in metrics]
    return table(
        ("key", "value", "baseline", "better", "may worsen by"),
        [
            (
                f"`{v.metric.key}`{_EARLIER if v.metric.key in earlier else ''}",
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
