"""Lemmas of docs/proofs.md name their places in code, which name the lemmas; what is trusted is counted."""

import ast
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

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
