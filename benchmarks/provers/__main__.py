"""One prover on one problem, in a process of its own: a solver that aborts takes no run with it.

Called as ``python -m benchmarks.provers NAME FILE REPEATS``; the problem comes as JSON on standard input and
the claim goes to the file, since solvers write to standard output what they like.
"""

from __future__ import annotations

import json
import sys
import time
from dataclasses import asdict, replace
from pathlib import Path

from benchmarks.provers import PROVERS, Claim, Problem, Prover

WORTH_REPEATING_S = 10.0


def repeated(prover: Prover, problem: Problem, repeats: int) -> Claim:
    """Return a prover's claim with the median of its times; a slow one runs once."""
    times: list[float] = []
    while True:
        began = time.perf_counter()
        claim = prover.prove(problem)
        times.append(time.perf_counter() - began)
        if len(times) == repeats or times[-1] > WORTH_REPEATING_S:
            return replace(claim, seconds=sorted(times)[len(times) // 2])


def main(name: str, file: str, repeats: str) -> None:
    """Write the claim of the prover of a name."""
    prover = next(prover for prover in PROVERS if prover.name == name)
    problem = Problem(**json.load(sys.stdin))
    prover.load()
    claim = repeated(prover, problem, int(repeats))
    Path(file).write_text(json.dumps(asdict(claim)), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
