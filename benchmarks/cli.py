"""The command: measure, report, compare with the baseline."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.environment import ROOT, prepare

if TYPE_CHECKING:
    from rich.progress import Progress as Bars

    from benchmarks.run import Run
    from benchmarks.workload import Progress, Workload

__all__ = ["main"]

SCRATCH = ROOT / "out" / "benchmarks"
DOCS = ROOT / "docs"

WORKLOAD_NAMES = ("fields", "certified", "certified-fields", "startup", "kernels")


def main(arguments: Sequence[str] | None = None) -> int:
    """Return the exit code: 0, or 1 if the gate is shut, or 2 if the command makes no sense."""
    options = _parser().parse_args(arguments)
    complaint = _complaint(options)
    if complaint:
        print(f"benchmarks: {complaint}", file=sys.stderr)
        return 2
    if not options.render:
        prepare(SCRATCH)
    from benchmarks.baseline import judge, load_baseline, write_baseline
    from benchmarks.report import tell, write_report
    from benchmarks.told import load_told, write_told
    from benchmarks.workloads import WORKLOADS
    from benchmarks.workloads.certified import Certified

    asked = [Certified(options.cap) if w.name == Certified.name else w for w in WORKLOADS]
    run = _run(options, [w for w in asked if not options.only or w.name in options.only])
    told = [w for w in WORKLOADS if w.name in run.rows]
    names = [w.name for w in told]
    complete = not run.quick and not options.cap and len(told) == len(WORKLOADS)
    if options.update_baseline:
        write_baseline(run.metrics(told), run.machine, names)
    into_docs = complete or (options.into_docs and not run.quick)
    folder = options.out or (DOCS if into_docs else SCRATCH)
    folder.mkdir(parents=True, exist_ok=True)
    metrics, baseline = run.metrics(told), load_baseline()
    fresh = tell(run, told, folder)
    earlier = load_told() if into_docs else {}
    print(f"Report: {write_report(run, fresh, earlier, baseline, folder)}")
    if into_docs and not options.out:
        write_told(fresh)
    for metric in metrics:
        if metric.limit is not None and not run.quick:
            met = "met" if metric.meets_limit else "MISSED"
            print(f"  {met}: {metric.about}: {metric.value:.4g} (promised {metric.limit:g})")
    if not options.gate:
        return 0
    faults = judge(metrics, baseline, names)
    for fault in faults:
        print(f"gate: {fault}", file=sys.stderr)
    return 1 if faults else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "--quick", action="store_true", help="a small sample, under a minute once kernels are compiled"
    )
    parser.add_argument(
        "--only",
        action="append",
        choices=WORKLOAD_NAMES,
        metavar="WORKLOAD",
        help=f"one of {', '.join(WORKLOAD_NAMES)}; may be repeated",
    )
    parser.add_argument(
        "--cap",
        type=float,
        metavar="SECONDS",
        help="certified: what each solver has per jamming power; 100 s",
    )
    parser.add_argument("--gate", action="store_true", help="exit with 1 on a regression or a promise missed")
    parser.add_argument("--update-baseline", action="store_true", help="make this run the baseline to commit")
    parser.add_argument(
        "--into-docs",
        action="store_true",
        help="write into docs though not every workload ran; the others stand as measured before, and say so",
    )
    parser.add_argument(
        "--out", type=Path, help="folder of the report; docs for a full run, out/benchmarks for any other"
    )
    parser.add_argument(
        "--render", type=Path, metavar="RESULTS", help="write the report of a stored run, measuring nothing"
    )
    return parser


def _complaint(options: argparse.Namespace) -> str:
    if options.quick and options.gate:
        return "--gate judges full runs only; leave out --quick"
    if options.quick and options.update_baseline:
        return "a quick run makes no baseline; leave out --quick"
    if options.cap is not None and options.cap <= 0.0:
        return f"--cap: given {options.cap:g}; allowed: seconds above 0"
    if options.cap and (options.gate or options.update_baseline):
        return "--gate and --update-baseline go with the usual cap; leave out --cap"
    if options.into_docs and (options.quick or options.cap):
        return "--into-docs takes full measurements only; leave out --quick and --cap"
    if options.render and (options.quick or options.only or options.cap):
        return "--render tells a stored run as it is; leave out --quick, --only and --cap"
    if options.render and not options.render.is_file():
        return f"--render: no file {options.render}"
    return ""


def _run(options: argparse.Namespace, chosen: Sequence[Workload]) -> Run:
    from benchmarks.run import Run, measure

    if options.render:
        return Run.load(options.render)
    with _progress() as progress:
        return measure(chosen, quick=options.quick, progress=progress, store=SCRATCH / "results.json")


@contextmanager
def _progress() -> Iterator[Progress]:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress as Bars, TextColumn, TimeElapsedColumn

    columns = (BarColumn(), MofNCompleteColumn(), TimeElapsedColumn(), TextColumn("{task.description}"))
    with Bars(*columns, console=Console(stderr=True)) as bars:
        yield _Bar(bars)


class _Bar:
    """A bar per workload."""

    def __init__(self, bars: Bars) -> None:
        self._bars = bars
        self._task = bars.add_task("starting", total=None, visible=False)

    def begin(self, total: int) -> None:
        """Start a bar."""
        self._task = self._bars.add_task("warming up", total=total)

    def step(self, doing: str) -> None:
        """Move the bar on."""
        self._bars.update(self._task, advance=1, description=doing)
