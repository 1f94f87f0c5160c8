"""How fast a study goes: ``python -m benchmarks.study``.

The rate of one process, of a pool of two, and of one and two workers
that are started by hand, on the same scenes. The first fifth of each run, in which kernels are loaded, does
not count. Beside scenes per second there are scenes per second of processor time, of client, scheduler and
workers together, which other work on the machine disturbs less.

With ``--million``: 10^6 scenes with a pose that is given, and how much memory the client takes.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil

from nullpose.study.monte_carlo import StudyProgress, StudySpec, load_spec, run_study
from nullpose.study.monte_carlo.chunk import rows_of

EXAMPLE = Path(__file__).parents[1] / "examples" / "study.toml"
WARM = 0.2  # share of the scenes that is not measured
POSE = {"name": "hover", "pose": {"position_m": [0.0, 25.0, 10.0], "roll_deg": 90.0}}


@dataclass(slots=True)
class Meter:
    """Marks of a run: when how many scenes were done, and the processor time until then.

    Args:
        others: processes that work on it beside this one and those it started.
    """

    others: list[psutil.Process] = field(default_factory=list)
    marks: list[tuple[int, float, float]] = field(default_factory=list)

    def __call__(self, at: StudyProgress) -> None:
        """Take a mark."""
        self.marks.append((at.done, time.perf_counter(), self._processor_s()))

    def rates(self) -> tuple[float, float]:
        """Return scenes per second, and per second of processor time."""
        last = self.marks[-1]
        first = next(mark for mark in self.marks if mark[0] >= WARM * last[0])
        scenes = last[0] - first[0]
        return scenes / (last[1] - first[1]), scenes / (last[2] - first[2])

    def _processor_s(self) -> float:
        mine = psutil.Process()
        return sum(_processor_s(each) for each in {mine, *mine.children(recursive=True), *self.others})


def _processor_s(process: psutil.Process) -> float:
    try:
        times = process.cpu_times()
    except psutil.NoSuchProcess:
        return 0.0
    return float(times.user + times.system)


@contextmanager
def by_hand(workers: int) -> Iterator[tuple[str, list[psutil.Process]]]:
    """Yield the address of a scheduler with some workers, and their processes."""
    started: list[subprocess.Popen[bytes]] = []

    def start(*arguments: str) -> None:
        command = [sys.executable, "-m", "dask", *arguments, "--no-dashboard"]
        started.append(subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL))

    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scheduler.json"
        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--scheduler-file", str(file))
        while not (file.exists() and file.read_text(encoding="utf-8").strip().endswith("}")):
            time.sleep(0.05)
        address = json.loads(file.read_text(encoding="utf-8"))["address"]
        for _ in range(workers):
            start("worker", address, "--nthreads", "1", "--no-nanny", "--local-directory", folder)
        try:
            from distributed import Client

            with Client(address) as client:
                client.wait_for_workers(workers, timeout=60)
            yield address, [psutil.Process(process.pid) for process in started]
        finally:
            for process in reversed(started):
                process.kill()
                process.wait()


def measured(spec: StudySpec, chunk: int, others: list[psutil.Process], **where: Any) -> tuple[float, float]:
    """Return the rates of a run in a folder of its own."""
    meter = Meter(others)
    with tempfile.TemporaryDirectory() as folder:
        run_study(spec, folder, chunk=chunk, on_progress=meter, **where)
    return meter.rates()


def alone(spec: StudySpec, first: int, last: int) -> None:
    """Solve some scenes, and keep nothing: what a process does that shares nothing with another."""
    for _ in rows_of(spec, first, last):
        pass


def apart(spec: StudySpec, processes: int) -> tuple[float, float]:
    """Return the rates of processes that know nothing of each other: what the machine has to give."""
    context = multiprocessing.get_context("spawn")
    with context.Pool(processes) as pool:
        pool.starmap(alone, [(spec, 0, 0)] * processes, chunksize=1)  # kernels are loaded
        share = spec.n_scenes // processes
        began = time.perf_counter()
        pool.starmap(alone, [(spec, i * share, (i + 1) * share - 1) for i in range(processes)], chunksize=1)
        spent = time.perf_counter() - began
    return processes * share / spent, share / spent


def compare(scenes: int, chunk: int) -> None:
    """Print the rates of all ways to run the example."""
    spec = load_spec(EXAMPLE).model_copy(update={"scenes": scenes})
    print(f"{spec.name}: {scenes} scenes of {spec.rows_per_scene} proofs, {chunk} in a part")
    print(f"load of the machine before: {os.getloadavg()[0]:.1f} on {psutil.cpu_count()} processors")
    rows: list[tuple[str, int, float, float]] = []
    print(f"{'':<22}{'workers':>8}{'scenes/s':>10}{'of one':>8}{'per CPU s':>11}{'of one':>8}")

    def add(name: str, workers: int, run: Callable[[], tuple[float, float]]) -> None:
        rate, efficient = run()
        rows.append((name, workers, rate, efficient))
        print(
            f"{name:<22}{workers:>8}{rate:>10.2f}{rate / rows[0][2]:>8.2f}"
            f"{efficient:>11.2f}{efficient / rows[0][3]:>8.2f}",
            flush=True,
        )

    add("one process", 1, lambda: measured(spec, chunk, [], workers=0))
    add("pool of processes", 2, lambda: measured(spec, chunk, [], workers=2))
    for workers in (1, 2):
        with by_hand(workers) as (address, others):
            add("by hand", workers, lambda a=address, o=others: measured(spec, chunk, o, scheduler=a))
    one, two = apart(spec, 1)[0], apart(spec, 2)[0]
    print(f"two workers by hand against one: {rows[3][2] / rows[2][2]:.2f} times the rate")
    print(
        f"two processes that share nothing against one: {two / one:.2f} times ({one:.2f}, {two:.2f} scenes/s)"
    )


def million(scenes: int) -> None:
    """Print how much memory the client takes for many quick scenes."""
    spec = load_spec(EXAMPLE).model_copy(update={"scenes": scenes, "cases": [POSE], "sweep": {}})
    client, peak, began = psutil.Process(), [0], time.perf_counter()

    def watch(at: StudyProgress) -> None:
        peak[0] = max(peak[0], client.memory_info().rss)
        if sys.stderr.isatty():
            print(
                f"\r{at.done} of {at.scenes}, {at.rate:.0f}/s, {peak[0] / 1e6:.0f} MB",
                end="",
                file=sys.stderr,
            )

    with tempfile.TemporaryDirectory() as folder:
        found = run_study(spec, folder, on_progress=watch)
    spent = time.perf_counter() - began
    print(
        f"{found.done} scenes in {found.parts} parts of {found.size / 1e6:.0f} MB, {found.failed} failed, "
        f"{spent:.0f} s, {found.done / spent:.0f} scenes/s, client at most {peak[0] / 1e6:.0f} MB"
    )


def main() -> None:
    """Run what the command line asks for."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.study", description=__doc__)
    parser.add_argument("--scenes", type=int, default=400, help="scenes of each run")
    parser.add_argument("--chunk", type=int, default=30, help="scenes of a part")
    parser.add_argument("--million", action="store_true", help="10^6 quick scenes, and the client's memory")
    options = parser.parse_args()
    if options.million:
        million(10**6)
    else:
        compare(options.scenes, options.chunk)


if __name__ == "__main__":
    main()
