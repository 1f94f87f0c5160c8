"""The first compilation, shared between two processes."""

import subprocess
from collections.abc import Callable

import pytest

from nullpose.family import AxisField, build_family
from nullpose.solve.kernels.branch import branch
from nullpose.solve.kernels.links import min_log_ratio
from nullpose.solve.kernels.multistart import search_and_climb
from nullpose.solve.kernels.node import keep_largest
from nullpose.solve.kernels.root import fill_root
from nullpose.solve.options import SolveOptions
from nullpose.solve.precompile import compile_proof, compile_search, precompile
from nullpose.solve.solve_and_prove import solve_and_prove

KERNELS = (branch, search_and_climb, min_log_ratio, keep_largest, fill_root)


def test_both_halves_are_what_a_solve_calls(paper: Callable) -> None:
    """Compiled by hand, the halves serve every solve, whatever the axes."""
    compile_search(dipoles=False)
    compile_proof(dipoles=False)
    before = [len(kernel.signatures) for kernel in KERNELS]
    family = build_family(paper(1.0))
    for field in (AxisField.free(), AxisField.vertical(), AxisField.within(0.0, 0.1)):
        solve_and_prove(family, [field], SolveOptions(gap=1e-2))
    assert [len(kernel.signatures) for kernel in KERNELS] == before


def test_no_process_is_started_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once this process has the kernels, there is nothing left to do."""
    precompile(dipoles=False)

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("a process was started")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    precompile(dipoles=False)
