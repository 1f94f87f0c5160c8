"""The primer and the code cite the same equations."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PRIMER = (DOCS / "physics.md").read_text(encoding="utf-8")
PHYSICS = sorted((ROOT / "src" / "nullpose" / "physics").glob("*.py"))


def _cited(text: str) -> set[str]:
    """Labels such as 2.1 after "eq." or "eqs.", lists and ranges resolved to what they name."""
    lists = re.findall(r"\beqs?\.\s+((?:\d\.\d(?:,\s+|\s+and\s+|\s+to\s+)?)+)", text)
    return {label for entry in lists for label in re.findall(r"\d\.\d", entry)}


def test_every_equation_cited_in_the_code_is_in_the_primer() -> None:
    """A paper equation that a docstring of the physics names has a row in the primer's concordance."""
    concordance = PRIMER.split("## Concordance")[1]
    cited = set().union(*(_cited(path.read_text(encoding="utf-8")) for path in PHYSICS))
    assert cited
    assert {label for label in cited if f"| {label} |" not in concordance} == set()


def test_every_numbered_equation_of_the_paper_has_its_number() -> None:
    """Each label of the concordance is named in the primer's text as well, beside its equation."""
    text, concordance = PRIMER.split("## Concordance")
    labels = re.findall(r"\| (\d\.\d) \|", concordance)
    assert labels
    assert {label for label in labels if f"paper eq. {label}" not in text} == set()
