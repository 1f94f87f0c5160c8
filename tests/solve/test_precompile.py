"""The first compilation, shared between two processes."""

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from nullpose.family import AxisField, build_family
from nullpose.solve.kernels.branch import branch
from nullpose.solve.kernels.polish import polish
from nullpose.solve.kernels.search import likely_axis, search
from nullpose.solve.multistart import multistart
from nullpose.solve.precompile import compile_branch, compile_other_half, compile_search, precompile, ready


def test_both_halves_are_what_a_solve_calls(paper: Callable) -> None:
    """Compiled by hand, each half serves a search that compiles after it; from a cache this holds anyway."""
    family = build_family(paper(1.0))
    compile_search(family, AxisField.free())
    compile_other_half()
    kernels = (polish, likely_axis, search, branch)
    before = [len(kernel.signatures) for kernel in kernels]
    multistart(family, AxisField.free(), seed=0)
    compile_branch(family, AxisField.vertical())
    assert [len(kernel.signatures) for kernel in kernels] == before


def test_no_process_is_started_twice(paper: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once the search is compiled, warming does nothing."""
    family = build_family(paper(1.0))
    ready(family, AxisField.free())
    assert search.signatures
    assert branch.signatures

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("a process was started")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    precompile(family, AxisField.free())
    ready(family, AxisField.free())


def test_compiling_changes_nothing(paper: Callable) -> None:
    """What the kernels are compiled with leaves no trace in the family."""
    family = build_family(paper(1.0))
    arrays = [array.copy() for array in family.arrays]
    compile_search(family, AxisField.free())
    compile_branch(family, AxisField.free())
    for array, copy in zip(family.arrays, arrays, strict=True):
        np.testing.assert_array_equal(array, copy)


def test_the_other_half_fills_the_cache_for_real_families(paper: Callable, tmp_path: Path) -> None:
    """With what the two processes compile of it, branching a real family compiles nothing more, nor twice."""
    program = """
from nullpose.scenario import load
from nullpose.family import AxisField, build_family
from nullpose.solve.kernels.branch import branch, examine_affine
from nullpose.solve.precompile import compile_affine, compile_branch, compile_other_half
family = build_family(load("examples/paper.toml"))
compile_affine(family, AxisField.free())
compile_other_half()
print(len(branch.signatures), len(examine_affine.signatures))
compile_branch(family, AxisField.vertical())
print(len(branch.signatures), len(examine_affine.signatures))
"""
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[2],
        env=os.environ.copy(),
    )
    first, again = done.stdout.splitlines()
    assert first == again == "1 1"
