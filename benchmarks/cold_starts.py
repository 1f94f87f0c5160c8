"""Each example solved by a command whose kernels nobody has compiled, and once more when they are there.

``python -m benchmarks.cold_starts [NAME ...]`` prints a table; the exit code is 1 if a cold start ends
with another status than a warm one. Run it on a machine that does nothing else.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import pandas as pd

from benchmarks.machine import ROOT, describe_machine
from benchmarks.processes import wait_for_kernels

_EXAMPLES = ROOT / "examples"


class _Start(NamedTuple):
    """One start: its arguments and its seconds."""

    command: str
    cold_s: float  # until the command ends
    compiled_s: float  # until the last kernel is there
    warm_s: float  # of the same command again
    kernels: int
    cold: str  # status
    warm: str


def commands(names: list[str]) -> list[list[str]]:
    """List the command of each example that is a scene, or of those that are named; a robust one has two."""
    found = []
    for path in sorted(_EXAMPLES.glob("*.toml")):
        table = tomllib.loads(path.read_text(encoding="utf-8"))
        if "scene" not in table and path.stem in (names or [path.stem]):
            arguments = ["solve", str(path.relative_to(ROOT))]
            found.append(arguments)
            if path.stem == "robust":
                found.append([*arguments, "--robust"])
    return found


def measure(arguments: list[str]) -> _Start:
    """Run a command twice with a folder of kernels that is empty at first."""
    with TemporaryDirectory() as folder:
        began = time.perf_counter()
        cold, cold_s = _run(arguments, folder)
        wait_for_kernels(Path(folder))
        compiled_s = time.perf_counter() - began
        warm, warm_s = _run(arguments, folder)
        kernels = len(list(Path(folder).rglob("*.nbc")))
    return _Start(" ".join(arguments), cold_s, compiled_s, warm_s, kernels, cold, warm)


def _run(arguments: list[str], folder: str) -> tuple[str, float]:
    began = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "nullpose", *arguments, "--json"],
        cwd=ROOT,
        env=os.environ | {"NUMBA_CACHE_DIR": folder},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(done.stdout)["status"], time.perf_counter() - began


def main() -> None:
    """Print the table."""
    print(*(f"{key}: {value}" for key, value in describe_machine().items()), sep="\n")
    starts = [measure(arguments) for arguments in commands(sys.argv[1:])]
    print(pd.DataFrame(starts).round(1).to_string(index=False))
    sys.exit(any(start.cold != start.warm for start in starts))


if __name__ == "__main__":
    main()
