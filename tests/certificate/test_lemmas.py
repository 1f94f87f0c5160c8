"""Lemmas of docs/proofs.md name their places in code, which name the lemmas; what is trusted is counted."""

import ast
import importlib
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from numpy.polynomial import Polynomial

PAGE = Path("docs/proofs.md").read_text()
ROWS = re.findall(r"^\| (\[.*\)) \| `(\w+)\.(\w+)` \|$", PAGE, re.MULTILINE)


def test_every_lemma_has_a_place() -> None:
    """All seven, and no heading of a lemma is missing in the table."""
    named = {title.casefold() for cell, _, _ in ROWS for title in re.findall(r"\[(.*?)\]", cell)}
    headings = re.findall(r"^#+ (Lemma \d)", PAGE, re.MULTILINE)
    assert len(headings) == 7
    assert {heading.casefold() for heading in headings} <= named


@pytest.mark.parametrize(("cell", "module", "name"), ROWS)
def test_the_place_names_the_lemma(cell: str, module: str, name: str) -> None:
    """In its own docstring or in the one of its file."""
    room = importlib.import_module(f"nullpose.certificate.{module}")
    words = " ".join(f"{room.__doc__} {getattr(room, name).__doc__}".split()).casefold()
    for title in re.findall(r"\[(.*?)\]", cell):
        last = title.casefold().removeprefix("lemma ")
        assert title.casefold() in words or re.search(rf"lemmas? .*\b{last}\b", words), title


def test_the_third_derivative_of_a_link_vector_is_below_its_bound() -> None:
    """Lemma 5: 4 P S < (L^2 - P - S)^2 for 0 <= x <= 1, by Taylor's formula from 2,000 places."""
    rows = ((0.0, 20.25, -67.5, 56.25), (81.0, -60.75, 67.5, -78.75))
    p, s = (Polynomial([Fraction(number) for number in row]) for row in rows)
    rest = Fraction(989, 100) ** 2 - p - s
    assert all(c >= 0 for c in rest.coef)  # nowhere negative
    values, slopes, bends = ((rest * rest - 4 * p * s).deriv(order).coef.tolist() for order in range(3))
    steps, most = 2000, sum(map(abs, bends))
    for i in range(steps):
        x, half = Fraction(2 * i + 1, 2 * steps), Fraction(1, 2 * steps)
        value, slope = (sum(c * x**n for n, c in enumerate(each)) for each in (values, slopes))
        assert value > half * abs(slope) + half**2 * most / 2


def statements(path: Path) -> int:
    """Return how many statements a file has, without imports and docstrings."""
    nodes = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.stmt)]
    words = [n for n in nodes if isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant)]
    return len(nodes) - len(words) - sum(isinstance(n, ast.Import | ast.ImportFrom) for n in nodes)


def test_the_page_counts_what_must_be_believed() -> None:
    """Every file of the verifier is in one row, with the statements that it has."""
    rows = re.findall(r"^\| .* \| (`\w+`(?:, `\w+`)*) \| ([\d,]+) \|$", PAGE, re.MULTILINE)
    *own, shared = [(re.findall(r"`(\w+)`", cell), int(number.replace(",", ""))) for cell, number in rows]
    room = Path("src/nullpose/certificate")
    assert sorted(f"{name}.py" for names, _ in own for name in names) == sorted(
        path.name for path in room.glob("*.py")
    )
    for names, number in own:
        assert number == sum(statements(room / f"{name}.py") for name in names), names
    loaded = "import sys, nullpose.certificate; print(*(m for m in sys.modules if m.startswith('nullpose.')))"
    shown = subprocess.run([sys.executable, "-c", loaded], capture_output=True, text=True, check=True).stdout
    names = [name for name in shown.split() if name.split(".")[1] != "certificate"]
    assert {name.split(".")[1] for name in names} == {*shared[0], "version"}
    files = [Path(importlib.import_module(name).__file__ or "") for name in names]
    assert sum(map(statements, files)) == pytest.approx(shared[1], rel=0.1)
