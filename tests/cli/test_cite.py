"""The verb `cite`: what it prints is what README and CITATION.cff state."""

import re
from collections.abc import Callable
from pathlib import Path

from typer.testing import Result

Run = Callable[..., Result]

ROOT = Path(__file__).parents[2]


def test_it_is_what_the_readme_shows(run: Run) -> None:
    """README has the same lines."""
    result = run("cite")
    assert (result.exit_code, result.stderr) == (0, "")
    assert f"```bibtex\n{result.stdout}```" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_facts_are_those_of_the_citation_file(run: Run) -> None:
    """Titles, authors, year, number, version and licence are in CITATION.cff."""
    told, stated = run("cite").stdout, (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    families = re.findall(r'family-names: "(.*)"', stated)
    given = re.findall(r'given-names: "(.*)"', stated)
    facts = [f"{family}, {name}" for family, name in zip(families, given, strict=True)]
    facts += re.findall(r'(?:title|value|name|collection-title): "(.*)"', stated)
    facts += re.findall(r"(?m)^ *(?:year|version|license): (\S+)", stated)
    assert len(facts) >= 12
    assert [fact for fact in facts if fact not in told] == []
