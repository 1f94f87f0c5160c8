"""Run with ``python -m benchmarks.mutations``: thousands of changed certificates of each kind, seeded."""

from __future__ import annotations

import argparse
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context

from rich.console import Console
from rich.progress import track

from benchmarks.mutations.bases import KINDS
from benchmarks.mutations.run import OUTCOMES, Tally, tally_of

_CHUNK = 100


def main(arguments: list[str] | None = None) -> int:
    """Change certificates, print what became of them by kind; return 1 if a false one was accepted."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=10_000, help="mutations of each kind")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument(
        "--kind", choices=list(KINDS), action="append", help="only this kind; may be repeated"
    )
    parser.add_argument("--workers", type=int, default=min(2, os.cpu_count() or 1), help="processes")
    parser.add_argument("--by-change", action="store_true", help="a table by the class of the change too")
    options = parser.parse_args(arguments)
    kinds = options.kind or list(KINDS)
    began = time.perf_counter()
    last = options.first + options.count
    parts = [
        (kind, first, min(_CHUNK, last - first))
        for first in range(options.first, last, _CHUNK)
        for kind in kinds
    ]
    tallies = {kind: Tally() for kind in kinds}
    with ExitStack() as stack:
        done = map(tally_of, parts)
        if options.workers > 1:
            pool = ProcessPoolExecutor(options.workers, mp_context=get_context("spawn"))
            done = stack.enter_context(pool).map(tally_of, parts)
        bar = track(done, "mutations", total=len(parts), console=Console(stderr=True))
        for (kind, _, _), tally in zip(parts, bar, strict=True):
            tallies[kind].add(tally)
    print(table(tallies))
    if options.by_change:
        print("\n" + table(by_change(tallies)))
    falsehoods = [words for tally in tallies.values() for words in tally.falsehoods]
    print(f"\n{time.perf_counter() - began:.0f} s in {options.workers} processes")
    print("\n".join(falsehoods[:50]))
    return int(bool(falsehoods))


def by_change(tallies: dict[str, Tally]) -> dict[str, Tally]:
    """Return tallies by the class of the change instead of by kind."""
    found: dict[str, Tally] = {}
    for tally in tallies.values():
        for (change, outcome), count in tally.counts.items():
            found.setdefault(change, Tally()).counts[change, outcome] += count
    return found


def table(tallies: dict[str, Tally]) -> str:
    """Return what became of mutations as a Markdown table."""
    lines = ["| | mutations | " + " | ".join(OUTCOMES) + " |", "|:--|--:" + "|--:" * len(OUTCOMES) + "|"]
    everything = Tally()
    for tally in tallies.values():
        everything.add(Tally(tally.counts.copy()))
    for name, tally in [*tallies.items(), ("all", everything)]:
        counts = {one: sum(n for (_, o), n in tally.counts.items() if o == one) for one in OUTCOMES}
        cells = [sum(counts.values()), *counts.values()]
        lines.append(f"| {name} | " + " | ".join(f"{n:,}" for n in cells) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
