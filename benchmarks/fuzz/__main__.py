"""Run with ``python -m benchmarks.fuzz``: damaged files of every kind, seeded, given to the real command."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.progress import track

from benchmarks.fuzz.check import Outcome, check_file
from benchmarks.fuzz.targets import Target, targets

__all__ = ["main"]


def main(arguments: list[str] | None = None) -> int:
    """Try damaged files, print a table by kind; return 1 if one of them was not refused as it should be.

    Args:
        arguments: of the command line.
    """
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--files", type=int, default=500, help="how many")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--fresh", type=int, default=20, help="one in so many runs in a process of its own")
    parser.add_argument("--keep", type=Path, help="folder for the files that were not refused as they should")
    options = parser.parse_args(arguments)
    console = Console(stderr=True)
    with TemporaryDirectory() as folder:
        kinds = targets(Path(folder))
        start_s = min(_start_s(kinds[0]) for _ in range(3))
        numbers = range(options.first, options.first + options.files)
        outcomes = [
            check_file(
                kinds[number % len(kinds)],
                number,
                fresh=number % options.fresh == 0,
                start_s=start_s if number % options.fresh == 0 else 0.0,
            )
            for number in track(numbers, description="fuzz", console=console)
        ]
    print(table(outcomes))
    for outcome in outcomes:
        for fault in outcome.faults:
            print(f"file {outcome.number} ({outcome.kind}): {fault}")
        if outcome.faults and options.keep is not None:
            options.keep.mkdir(exist_ok=True)
            (options.keep / f"{outcome.number}-{outcome.kind}").write_bytes(outcome.content)
    return int(any(outcome.faults for outcome in outcomes))


def _start_s(target: Target) -> float:
    """Return the processor time that a process takes which reads a small file."""
    return check_file(Target(target.kind, target.name, b"", target.arguments, {}), 0, fresh=True).seconds


def table(outcomes: list[Outcome]) -> str:
    """Return the outcomes by kind as a Markdown table.

    Args:
        outcomes: of all files.
    """
    lines = [
        "| kind | files | accepted | refused | rejected | longest, s | most memory, MB | faults |",
        "|:--|--:|--:|--:|--:|--:|--:|--:|",
    ]
    for kind in (*dict.fromkeys(outcome.kind for outcome in outcomes), "all"):
        some = [outcome for outcome in outcomes if kind in ("all", outcome.kind)]
        codes = [sum(outcome.code == code for outcome in some) for code in (0, 2, 1)]
        longest = max(outcome.seconds for outcome in some)
        most = max(outcome.megabytes for outcome in some)
        wrong = sum(bool(outcome.faults) for outcome in some)
        lines.append(
            f"| {kind} | {len(some)} | {' | '.join(map(str, codes))} | {longest:.2f} | {most:.0f} | {wrong} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
