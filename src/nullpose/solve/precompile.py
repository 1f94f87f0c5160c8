"""The first compilation, shared between two processes.

A second process fills the cache with the choice of a starting axis and the branch and bound, while this one
compiles a part of that which stands by itself, and then the polish and the search around it.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from types import FunctionType

from nullpose.family import AxisField, Family

__all__ = ["precompile", "ready"]

_WAIT_S = 300.0  # it is ended then, and all that it compiled is compiled again


def precompile(family: Family, axis_field: AxisField) -> None:
    """Compile the kernels of the search in two processes if the cache has none.

    Without a second process, or without a cache, the search compiles everything by itself: nothing depends
    on this but time.

    Args:
        family: any family: its arrays give the kernels their types.
        axis_field: any axis field.
    """
    from nullpose.solve.kernels.search import search

    if isinstance(search, FunctionType) or search.signatures:  # not to be compiled, or compiled already
        return
    cache_path = search.stats.cache_path
    if cache_path is None or any(Path(cache_path).glob("search.search-*.nbi")):
        return
    program = "from nullpose.solve.precompile import compile_other_half as c; c()"
    try:
        other = subprocess.Popen(
            [sys.executable, "-c", program], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
    except OSError:
        return
    try:
        compile_affine(family, axis_field)
        compile_search(family, axis_field)
        other.wait(_WAIT_S)
    except subprocess.TimeoutExpired:
        pass
    finally:
        other.kill()
        other.wait()


def ready(family: Family, axis_field: AxisField) -> None:
    """Compile search and branch and bound, or load them from the cache, unless this process has them.

    Args:
        family: any family.
        axis_field: any axis field.
    """
    from nullpose.solve.kernels.branch import branch

    if isinstance(branch, FunctionType) or branch.signatures:
        return
    precompile(family, axis_field)
    compile_search(family, axis_field)
    compile_branch(family, axis_field)


def compile_branch(family: Family, axis_field: AxisField) -> None:
    """Compile the branch and bound by giving it no node to work off."""
    import numpy as np

    from nullpose.solve.kernels import branch, node

    row, rows = np.zeros(node.COLUMNS), np.zeros((1, node.COLUMNS))
    node.keep_largest(np.ones(1), 1, row)
    none = (0, rows.copy(), 0, 1, np.empty(3), np.empty(3))
    branch.branch(family.arrays, family.domain, axis_field.arrays, 1.0, 1.0, row, 1.0, rows, *none)


def compile_affine(family: Family, axis_field: AxisField) -> None:
    """Compile the part of the branch and bound for axes that positions give, which needs none of the rest."""
    import numpy as np
    from numba import typeof

    from nullpose.solve.kernels import branch, node

    row = np.zeros(node.COLUMNS)
    scenery = (family.arrays, family.domain, axis_field.arrays, (1.0, row, 1.0))
    arguments = (*scenery, row, branch.make_room.py_func(family.arrays), np.empty(3))
    types = tuple(typeof(argument) for argument in arguments)  # type: ignore[no-untyped-call]
    branch.examine_affine.compile(types)


def compile_search(family: Family, axis_field: AxisField) -> None:
    """Compile the polish, by running no step of it, and the search, by running no round of it."""
    import numpy as np

    from nullpose.solve.kernels.polish import polish
    from nullpose.solve.kernels.search import cut_box, search
    from nullpose.solve.multistart import SearchSettings

    ratios = len(family.numerator_point)
    p, u, z = np.full(3, 1e3), np.array([0.0, 0.0, 1.0]), np.empty(ratios)
    polish(family.arrays, family.domain, axis_field.arrays, p, u, 0.1, 0, z)
    cut_box(family.arrays, family.low_m, family.high_m, 0.0, np.empty(3), np.empty(3))
    none = np.empty((0, 3))
    nothing = SearchSettings(1, 0, 0, 0)
    search(family.arrays, family.domain, axis_field.arrays, none, np.zeros(3), nothing, p, u, z)


def compile_other_half() -> None:
    """Compile the choice of a starting axis and the branch and bound; run by the second process."""
    import numpy as np

    from nullpose.solve.kernels.search import likely_axis

    family = Family(
        points_m=np.zeros((1, 3)),
        numerator_isotropic=np.zeros(1),
        numerator_weight=np.ones(1),
        numerator_point=np.zeros(1, dtype=np.int64),
        denominator_of=np.zeros(1, dtype=np.int64),
        denominator_isotropic=np.ones(1),
        denominator_start=np.zeros(2, dtype=np.int64),
        denominator_point=np.zeros(0, dtype=np.int64),
        denominator_weight=np.zeros(0),
        low_m=np.zeros(3),
        high_m=np.ones(3),
        keep_out_points_m=np.zeros((0, 3)),
        keep_out_m=1.0,
    )
    likely_axis(family.arrays, np.array([0.0, 0.0, 10.0]), np.empty(3))
    compile_branch(family, AxisField.free())
