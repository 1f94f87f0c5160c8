"""Whole processes, as a user at a terminal waits for them: help, a cached solve, the first solve ever."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import pandas as pd

from benchmarks.machine import ROOT, Progress

TITLE = "Whole processes"
ABOUT = """From the start of the process to its end, the files of the commands in the system's cache. The
first solve begins with an empty kernel cache; it answers before the kernels are compiled, and a process
of its own compiles them."""

_SOLVE = ["solve", "examples/paper.toml"]
_LIMITS_S = {"help": 0.4, "solve, kernels cached": 2.0, "solve, empty cache": 2.0}


def measure(quick: bool, progress: Progress) -> list[dict[str, Any]]:
    """Time each command: the first solve once, the others five times."""
    with tempfile.TemporaryDirectory(prefix="nullpose-bench-") as folder:
        runs = [("solve, empty cache", _SOLVE)]
        runs += [("help", ["--help"]), ("solve, kernels cached", _SOLVE)] * 5
        rows = []
        for name, arguments in progress(runs[:3] if quick else runs):
            rows.append(_timed(name, arguments, folder))
            wait_for_kernels(Path(folder))
        return rows


def _timed(name: str, arguments: list[str], cache: str) -> dict[str, Any]:
    command = [str(Path(sys.executable).with_name("nullpose")), *arguments]
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    start = time.perf_counter()
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300.0)
    return {"command": name, "seconds": time.perf_counter() - start, "exit_code": done.returncode}


def wait_for_kernels(folder: Path) -> None:
    """Wait until the processes that compile kernels have given up the folder's lock."""
    import fcntl

    for path in folder.rglob("compiling.lock"):
        with path.open("r+") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)


def tables(rows: list[dict[str, Any]]) -> dict[str, pd.DataFrame]:
    """Summarise the times of each command, seconds."""
    groups = pd.DataFrame(rows).groupby("command", sort=False)["seconds"]
    return {"Seconds": groups.agg(["size", "median", "min", "max"]).reset_index()}


def faults(rows: list[dict[str, Any]]) -> list[str]:
    """Name commands that fail, or take longer than is promised."""
    frame = pd.DataFrame(rows)
    failed = [f"{row['command']}: exit code {row['exit_code']}" for row in rows if row["exit_code"]]
    medians = frame.groupby("command")["seconds"].median()
    return failed + [
        f"{name}: {seconds:.2f} s, promised {_LIMITS_S[name]:g} s"
        for name, seconds in medians.items()
        if seconds > _LIMITS_S[name]
    ]
