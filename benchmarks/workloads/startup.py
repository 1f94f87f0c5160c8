"""The workload "startup": whole processes, as someone at a terminal waits for them."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from benchmarks.environment import ROOT
from benchmarks.markdown import table
from benchmarks.metric import TIMING, Direction, Metric
from benchmarks.summaries import median
from benchmarks.workload import Progress, Row, Section

__all__ = ["Startup"]

EXAMPLE = "examples/paper.toml"
RUNS = 5
_TIMEOUT_S = 300.0

# command, what is measured, the time promised (s)
CASES = {
    "help": ("nullpose --help", 0.4),
    "solve": (f"nullpose solve {EXAMPLE}, kernels cached", 2.0),
    "first_run": (f"nullpose solve {EXAMPLE}, empty kernel cache", 2.0),
}


class Startup:
    """Three commands, each a process of its own."""

    name = "startup"
    title = "Whole processes"

    def measure(self, *, quick: bool, progress: Progress) -> list[Row]:
        """Return a row per run. A quick run has no empty cache: what that starts takes longer than it may."""
        runs = 1 if quick else RUNS
        progress.begin(2 * runs + (0 if quick else 1))
        with tempfile.TemporaryDirectory(prefix="nullpose-bench-") as folder:
            rows = []
            if not quick:
                rows.append(_timed("first_run", ["solve", EXAMPLE], {"NUMBA_CACHE_DIR": folder}))
                progress.step(CASES["first_run"][0])
                _wait_for_kernels(Path(folder))
            elsewhere = {} if quick else {"NUMBA_CACHE_DIR": folder}
            for case, arguments in (("help", ["--help"]), ("solve", ["solve", EXAMPLE])):
                for _ in range(runs):
                    rows.append(_timed(case, arguments, elsewhere))
                    progress.step(CASES[case][0])
        return rows

    def metrics(self, rows: Sequence[Row]) -> tuple[Metric, ...]:
        """Return the median time of each command; NaN where a run failed."""
        return tuple(
            Metric(
                key=f"startup.{case}_s",
                value=_median_s(rows, case),
                unit="s",
                direction=Direction.LOWER,
                tolerance=TIMING,
                limit=limit,
                about=f"`{what}`, whole process",
            )
            for case, (what, limit) in CASES.items()
            if any(row["case"] == case for row in rows)
        )

    def section(self, rows: Sequence[Row], images: Path) -> Section:
        """Return the table of times."""
        cells = []
        for case, (what, limit) in CASES.items():
            runs = [row for row in rows if row["case"] == case]
            seconds = [row["seconds"] for row in runs]
            failed = [row["status"] for row in runs if row["status"] != "ok"]
            if runs:
                spread = f"{min(seconds):.2f} to {max(seconds):.2f} s"
                answer = f"failed: {failed[0]}" if failed else f"{_median_s(rows, case):.2f} s"
                cells.append((f"`{what}`", str(len(runs)), answer, spread, f"{limit:g} s"))
            else:
                cells.append((f"`{what}`", "0", "left out of a quick run", "", f"{limit:g} s"))
        return Section(
            text="From the start of the process to its end.\n\n"
            + table(("command", "runs", "median", "from, to", "promised"), cells),
            limitations=(
                "The operating system has the files of the commands in its cache; the very first start after "
                "booting is slower.",
            ),
        )


def _timed(case: str, arguments: Sequence[str], environment: dict[str, str]) -> Row:
    began = time.perf_counter()
    try:
        done = subprocess.run(
            [_command(), *arguments],
            cwd=ROOT,
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            timeout=_TIMEOUT_S,
        )
        status = "ok" if done.returncode == 0 else f"exit code {done.returncode}: {_last_line(done.stderr)}"
    except (OSError, subprocess.TimeoutExpired) as error:
        status = f"{type(error).__name__}: {error}"
    return {"case": case, "seconds": time.perf_counter() - began, "status": status}


def _wait_for_kernels(folder: Path) -> None:
    """Wait until the processes that compile them have given up the folder's lock."""
    import fcntl

    for path in folder.rglob("compiling.lock"):
        with path.open("r+") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)


def _command() -> str:
    beside = Path(sys.executable).with_name("nullpose")
    return str(beside) if beside.exists() else shutil.which("nullpose") or "nullpose"


def _last_line(text: str) -> str:
    lines = text.strip().splitlines()
    return lines[-1] if lines else "no message"


def _median_s(rows: Sequence[Row], case: str) -> float:
    runs = [row for row in rows if row["case"] == case]
    if any(row["status"] != "ok" for row in runs):
        return float("nan")
    return median(row["seconds"] for row in runs)
