"""The page on certificates, against the file that is written and the words of the verifier."""

import json
from pathlib import Path

from nullpose.certificate import certificate_text
from nullpose.certificate.subject import claim_numbers, claim_words
from nullpose.report.numbers import capitalised
from nullpose.scenario import load
from nullpose.solver import solve
from nullpose.solver.certificate_from_proof import certificate_of

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "certificate.md").read_text(encoding="utf-8")


def keys_of(data: object) -> set[str]:
    """Return every key of nested tables, the scenario's own left out."""
    if isinstance(data, list):
        return set().union(*(keys_of(item) for item in data[:3])) if data else set()
    if not isinstance(data, dict):
        return set()
    inner = (keys_of(value) for key, value in data.items() if key not in ("scenario", "provenance"))
    return set(data).union(*inner)


def test_every_key_is_explained() -> None:
    """Whoever writes another verifier finds each key of the file on the page."""
    certificate = certificate_of(solve(load(ROOT / "examples" / "paper.toml"), gap=1e-2))
    for key in keys_of(json.loads(certificate_text(certificate))):
        assert f"`{key}`" in PAGE, key


def test_what_is_shown_is_what_is_printed() -> None:
    """The bound and the value on the page are those of today, whatever the number of leaves."""
    certificate = certificate_of(solve(load(ROOT / "examples" / "paper.toml")))
    bound, value, gap = claim_numbers(certificate)
    for shown in (f"upper bound    {bound}", f"pose's value   {value}", f"gap            {gap}"):
        assert shown in PAGE
    words = " ".join(PAGE.split())
    assert f"{capitalised(claim_words(certificate))} above the bound." in words
