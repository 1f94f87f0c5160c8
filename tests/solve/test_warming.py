"""The first compilation, shared between two processes."""

import subprocess
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.family import AxisField, build_family
from nullpose.solve.kernels.polish import polish
from nullpose.solve.kernels.search import likely_axis, search
from nullpose.solve.multistart import multistart
from nullpose.solve.warming import compile_polish, compile_starting_axis, warm_kernels


def test_both_halves_are_what_the_search_calls(paper: Callable) -> None:
    """Compiled by hand, each half serves a search that compiles after it; from a cache this holds anyway."""
    family = build_family(paper(1.0))
    compile_polish(family, AxisField.free())
    compile_starting_axis()
    before = (len(polish.signatures), len(likely_axis.signatures))
    multistart(family, AxisField.free(), seed=0)
    assert (len(polish.signatures), len(likely_axis.signatures)) == before


def test_no_process_is_started_twice(paper: Callable, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once the search is compiled, warming does nothing."""
    family = build_family(paper(1.0))
    multistart(family, AxisField.free(), seed=0)
    assert search.signatures

    def refuse(*arguments: object, **options: object) -> None:
        raise AssertionError("a process was started")

    monkeypatch.setattr(subprocess, "Popen", refuse)
    warm_kernels(family, AxisField.free())


def test_compiling_the_polish_takes_no_step(paper: Callable) -> None:
    """The pose that the polish is compiled with is far from anything and leaves no trace."""
    family = build_family(paper(1.0))
    arrays = [array.copy() for array in family.arrays]
    compile_polish(family, AxisField.free())
    for array, copy in zip(family.arrays, arrays, strict=True):
        np.testing.assert_array_equal(array, copy)
