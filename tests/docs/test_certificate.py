"""The page on certificates, against the file that is written and the words of the verifier."""

import json
import re
from pathlib import Path

from nullpose.certificate import certificate_text, verify
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


def test_the_sentence_shown_is_the_verifier_s() -> None:
    """The output on the page is that of today, whatever the number of leaves."""
    certificate = certificate_of(solve(load(ROOT / "examples" / "paper.toml")))
    shown = re.search(r"^proved: .*?final boxes checked", PAGE, re.DOTALL | re.MULTILINE)
    assert shown is not None
    counted = r"\d+ leaves"
    expected = re.sub(counted, "leaves", verify(certificate).message)
    assert re.sub(counted, "leaves", " ".join(shown.group().split())) == expected
