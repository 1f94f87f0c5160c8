"""Telling of the first compilation, tried in processes with a cache of their own; a clock without it."""

import os
import subprocess
import sys
import time
from pathlib import Path

import numba
import pytest
from numba.core import event

import nullpose
from nullpose.solver.compiling import PREPARING, working_clock

PAPER = Path(__file__).parents[2] / "examples" / "paper.toml"

KERNELS = """
from nullpose.solver.kernels.compiler.jit import kernel


@kernel
def twice(x):
    return 2.0 * x


@kernel
def thrice(x):
    return 3.0 * x
"""

PROGRAM = """
from nullpose.solver import announce_compiling
from tiny import thrice, twice

calls = []
with announce_compiling(lambda: calls.append("inside")):
    assert (twice(1.0), thrice(1.0)) == (2.0, 3.0)
with announce_compiling(lambda: calls.append("again")):
    assert twice(2.0) == 4.0
thrice(1)  # another type: compiled outside any block
print(len(calls), *calls)
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Returns what the program prints on a first and on a second run, which share a cache."""
    folder = tmp_path_factory.mktemp("compiling")
    (folder / "tiny.py").write_text(KERNELS, encoding="utf-8")
    (folder / "program.py").write_text(PROGRAM, encoding="utf-8")
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "cache")}
    return [
        subprocess.run(
            [sys.executable, str(folder / "program.py")],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.strip()
        for _ in range(2)
    ]


def test_compiling_is_announced_once(runs: list[str]) -> None:
    """Two kernels compiled in a block are announced once; blocks that compile nothing announce nothing."""
    assert runs[0] == "1 inside"


def test_the_cache_is_not_announced(runs: list[str]) -> None:
    """A second process finds the kernels in the cache and announces nothing."""
    assert runs[1] == "0"


def test_compiling_does_not_count() -> None:
    """While a function is compiled, and while kernels are prepared, the clock gains next to nothing."""

    def total(n: int) -> float:
        found = 0.0
        for i in range(n):
            found += i**0.5
        return found

    wall_s, began = time.perf_counter(), working_clock()
    numba.njit(total)(3)
    with event.trigger_event(PREPARING):
        time.sleep(0.2)
    assert working_clock() - began < 0.5 * (time.perf_counter() - wall_s)


def test_the_time_of_a_solve_is_no_more_than_the_wall_has() -> None:
    """A solve states less time than passed around it."""
    began = time.perf_counter()
    solution = nullpose.solve(nullpose.load(PAPER))
    assert 0.0 < solution.stats.wall_s <= time.perf_counter() - began
