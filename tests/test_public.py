"""The package's public face: every name is there, and importing it costs nothing."""

import subprocess
import sys

import pytest

import nullpose

HEAVY = ("numpy", "numba", "pydantic", "scipy", "matplotlib", "rich", "typer")


def _python(code: str) -> str:
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_every_public_name_is_there() -> None:
    """Each name of __all__ can be reached, and is listed by dir()."""
    assert all(getattr(nullpose, name) is not None for name in nullpose.__all__)
    assert set(nullpose.__all__) <= {*dir(nullpose), "__version__"}


def test_importing_the_package_imports_nothing_heavy() -> None:
    """`import nullpose` leaves numerical and terminal libraries alone."""
    code = f"import sys, nullpose; print([name for name in {HEAVY!r} if name in sys.modules])"
    assert _python(code) == "[]"


@pytest.mark.parametrize(
    "before",
    ["", "import nullpose.solver.api;", "from nullpose.solver import Scheme;", "import nullpose.study;"],
)
def test_solve_is_the_function_whatever_was_imported_before(before: str) -> None:
    """No module hides the function of its name."""
    code = (
        f"import nullpose; {before} nullpose.solve; print(nullpose.solve.__name__, callable(nullpose.solve))"
    )
    assert _python(code) == "solve True"
