"""Another numba than those that the kernels' own compiler is made for."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import nullpose
from nullpose.problem.build import build_family
from nullpose.solver.kernels.compiler.jit import LINKED_BEFORE, LINKED_FROM
from nullpose.solver.kernels.compiler.notices import OTHER_NUMBA
from nullpose.solver.kernels.search.domain import walls

ROOT = Path(__file__).parents[3]
SCENES = ("paper", "eavesdropper", "no-fly")

OTHER = "import numba; numba.__version__ = '0.99.0'\n"

WALLS = """
import sys
import numpy as np
from nullpose import load
from nullpose.problem.build import build_family
from nullpose.solver.kernels.search.domain import walls
distance_m, ways = walls(build_family(load(sys.argv[1])).domain, np.array([1.0, 20.0, 9.0]))
print(*distance_m, *ways.flat)
"""

SOLVE = """
import gc
import sys
import nullpose
gc.disable()  # a fifth of the time that compiling takes
for path in sys.argv[1:]:
    result = nullpose.solve(nullpose.load(path), certify=False)
    print(repr(result.objective.value), result.status)
"""


def lines_of(program: str, folder: Path, *arguments: str) -> list[str]:
    """Returns what a program prints; standard error says once that compiling takes longer."""
    (folder / "sitecustomize.py").write_text(OTHER, encoding="utf-8")
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join([str(folder), *sys.path]),
        "NUMBA_CACHE_DIR": str(folder / "kernels"),
        "NUMBA_OPT": "1",  # with 0 the code has addresses, which numba warns of
    }
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments], env=environment, capture_output=True, text=True
    )
    assert done.stderr == OTHER_NUMBA.format("0.99.0") + "\n"
    return done.stdout.splitlines()


@pytest.mark.grid
def test_kernels_are_compiled_with_another_numba(tmp_path: Path) -> None:
    """Same distances from what the airspace excludes, and ways out."""
    path = str(ROOT / "examples" / "no-fly.toml")
    distance_m, ways = walls(build_family(nullpose.load(path)).domain, np.array([1.0, 20.0, 9.0]))
    (line,) = lines_of(WALLS, tmp_path, path)
    assert [float(word) for word in line.split()] == pytest.approx([*distance_m, *ways.flat], rel=1e-12)


@pytest.mark.slow
def test_three_scenes_are_solved_with_another_numba(tmp_path: Path) -> None:
    """Same values and statuses, without a proof, whose kernels take numba another 45 s."""
    paths = [str(ROOT / "examples" / f"{name}.toml") for name in SCENES]
    for path, line in zip(paths, lines_of(SOLVE, tmp_path, *paths), strict=True):
        value, status = line.split()
        expected = nullpose.solve(nullpose.load(path), certify=False)
        assert float(value) == pytest.approx(expected.objective.value, rel=1e-9)
        assert status == str(expected.status)


def test_the_versions_are_those_that_the_project_asks_for() -> None:
    """What pip installs beside nullpose is what its compiler is made for."""
    with (ROOT / "pyproject.toml").open("rb") as file:
        (asked,) = (one for one in tomllib.load(file)["project"]["dependencies"] if one.startswith("numba"))
    bounds = [tuple(map(int, each.split("."))) for each in re.findall(r"[\d.]+", asked)]
    assert bounds == [LINKED_FROM, LINKED_BEFORE]
    last = f"{LINKED_BEFORE[0]}.{LINKED_BEFORE[1] - 1}"
    assert "{}.{} to {}".format(*LINKED_FROM, last) in OTHER_NUMBA
