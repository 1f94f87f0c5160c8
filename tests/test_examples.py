"""The examples in the docstrings are true, and every public function has one."""

import doctest
import inspect
from importlib import import_module
from pathlib import Path

import pytest
from matplotlib import pyplot

import nullpose

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src"
WITH_EXAMPLES = [
    ".".join(path.relative_to(SOURCE).with_suffix("").parts)
    for path in sorted(SOURCE.rglob("*.py"))
    if ">>>" in path.read_text(encoding="utf-8")
]
FUNCTIONS = {
    **{name: getattr(nullpose, name) for name in nullpose.__all__},
    **{f"plot.{name}": getattr(nullpose.plot, name) for name in nullpose.plot.__all__},
}


@pytest.mark.parametrize("module", WITH_EXAMPLES)
def test_examples_are_true(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Typed in the repository's folder, each example of a module prints what its docstring shows."""
    monkeypatch.chdir(ROOT)
    is_of = doctest.DocTestFinder._from_module  # of what a function is that refuses wrong arguments
    monkeypatch.setattr(
        doctest.DocTestFinder, "_from_module", lambda self, of, found: is_of(self, of, inspect.unwrap(found))
    )
    found = doctest.testmod(import_module(module), optionflags=doctest.NORMALIZE_WHITESPACE)
    pyplot.close("all")
    assert found.attempted
    assert not found.failed


@pytest.mark.parametrize("name", [name for name, found in FUNCTIONS.items() if inspect.isfunction(found)])
def test_every_public_function_has_an_example(name: str) -> None:
    """Whoever asks for help on a public function is shown it at work."""
    assert ">>>" in (inspect.getdoc(FUNCTIONS[name]) or "")
