"""The first compilation, shared between two processes."""

import subprocess
from collections.abc import Callable

import pytest

from nullpose import load, solve
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.solver.compiling import compile_proof, compile_search, precompile
from nullpose.solver.kernels.bounds.branch import branch
from nullpose.solver.kernels.bounds.node import keep_largest
from nullpose.solver.kernels.bounds.root import fill_root
from nullpose.solver.kernels.bounds.signed_sum import touch
from nullpose.solver.kernels.linear_algebra.links import log_objective
from nullpose.solver.kernels.search.search import search_and_climb
from nullpose.solver.options import SolveOptions
from nullpose.solver.solve_and_prove import solve_and_prove
from scenes import EXAMPLES

KERNELS = (branch, search_and_climb, log_objective, keep_largest, fill_root, touch)


def test_both_halves_are_what_a_solve_calls(paper: Callable) -> None:
    """Compiled by hand, the halves serve every solve, whatever the axes."""
    compile_search()
    compile_proof()
    before = [len(kernel.signatures) for kernel in KERNELS]
    family = build_family(paper(1.0))
    for field in (AxisField.free(), AxisField.vertical(), AxisField.within(0.0, 0.1)):
        solve_and_prove(family, [field], SolveOptions(gap=1e-2))
    assert [len(kernel.signatures) for kernel in KERNELS] == before


def test_every_scene_runs_the_same_kernels() -> None:
    """Dipoles on the ground, excess gains, buildings or eavesdroppers compile nothing more."""
    compile_search()
    compile_proof()
    before = [len(kernel.signatures) for kernel in KERNELS]
    for name in ("paper", "whips", "urban", "town", "eavesdropper"):
        solve(load(EXAMPLES / f"{name}.toml"), gap=1.0)
    assert [len(kernel.signatures) for kernel in KERNELS] == before


def test_no_process_is_started_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once this process has the kernels, there is nothing left to do."""
    precompile()

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("a process was started")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    precompile()
