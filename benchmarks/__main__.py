"""Measure how good nullpose is, beside what: ``python -m benchmarks [WORKLOAD ...] [--quick] [--page]``."""

from __future__ import annotations

import argparse
import importlib
import json
import sys

from rich.console import Console
from rich.progress import track

from benchmarks.machine import ROOT, describe_machine, pin_threads

WORKLOADS = ("fields", "certified", "proofs", "processes", "tracker", "studio")


def main(arguments: list[str] | None = None) -> int:
    """Run workloads, print their tables and leave their rows in out/benchmarks; 1 if a promise is broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("workloads", nargs="*", metavar="WORKLOAD", help=f"of {', '.join(WORKLOADS)}")
    parser.add_argument("--quick", action="store_true", help="a small sample, whose figures are no evidence")
    parser.add_argument("--page", action="store_true", help="store the tables and write docs/benchmarks.md")
    options = parser.parse_args(arguments)
    unknown = set(options.workloads) - set(WORKLOADS)
    if unknown:
        parser.error(f"no workload {', '.join(sorted(unknown))}; allowed: {', '.join(WORKLOADS)}")
    if options.quick and options.page:
        parser.error("--page needs a full run: the figures of --quick are no evidence")
    pin_threads()
    broken = [_run(name, options) for name in options.workloads or WORKLOADS]  # all of them run
    return int(any(broken))


def _run(name: str, options: argparse.Namespace) -> bool:
    from benchmarks.page import markdown, store, write_page

    workload = importlib.import_module(f"benchmarks.{name}")
    machine, console = describe_machine(), Console(stderr=True)
    rows = workload.measure(options.quick, lambda items: track(list(items), name, console=console))
    folder = ROOT / "out" / "benchmarks"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.json").write_text(json.dumps({"machine": machine, "rows": rows}), encoding="utf-8")
    tables, faults = workload.tables(rows), workload.faults(rows)
    for heading, frame in tables.items():
        print(f"\n{workload.TITLE}: {heading}\n\n{markdown(frame)}")
    for fault in faults:
        print(f"BROKEN: {fault}")
    if options.page:
        store(name, workload.TITLE, workload.ABOUT, tables, machine)
        write_page()
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main())
