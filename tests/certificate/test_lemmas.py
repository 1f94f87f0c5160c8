"""Every lemma of docs/proofs.md names its place in the code, and that place names the lemma."""

import importlib
import re
from pathlib import Path

import pytest

ROWS = re.findall(r"^\| (\[.*\)) \| `(\w+)\.(\w+)` \|$", Path("docs/proofs.md").read_text(), re.MULTILINE)


def test_every_lemma_has_a_place() -> None:
    """All seven, and no heading of a lemma is missing in the table."""
    named = {title.casefold() for cell, _, _ in ROWS for title in re.findall(r"\[(.*?)\]", cell)}
    headings = re.findall(r"^#+ (Lemma \d)", Path("docs/proofs.md").read_text(), re.MULTILINE)
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
