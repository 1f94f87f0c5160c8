"""The page on the paper's claims, in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from claims.claim import Claim
from claims.claims import CLAIMS
from claims.study import JammingStudy
from nullpose.paper import Reproduction
from nullpose.report.answer import certainty_lines
from nullpose.report.document import Row

_BEYOND = (
    "A bound is on a value at one power: where the best pose lies, a level found by bisection, and powers "
    "between those looked at are proved only where a claim says so."
)
_HEAD = """# The paper's claims, checked

Written by `make figures` from the data of `nullpose reproduce` (`figure2.csv` and solves between its
points), for the scenario of section 4. P_M/P is the jamming-to-transmission power ratio; values are the
smallest SINR over the nodes."""


def check_claims(reproduction: Reproduction) -> tuple[Claim, ...]:
    """Return the paper's claims with their verdicts.

    Args:
        reproduction: the data of Figure 2.
    """
    study = JammingStudy(reproduction)
    return tuple(claim.checked(study) for claim in CLAIMS)


def claims_page(reproduction: Reproduction, claims: tuple[Claim, ...]) -> str:
    """Return a page with a table of verdicts, and a section on each claim.

    Args:
        reproduction: the data of Figure 2.
        claims: checked on it.
    """
    verdicts = [
        {"claim": each.claim, "verdict": f"**{each.verdict}**", "where": _where(each)} for each in claims
    ]
    searched = "Maximum gain, as printed: best found by search, no upper bound."
    lines = [*(f"{line}." for line in certainty_lines(reproduction.table)), searched, _BEYOND]
    blocks = [_HEAD, "\n".join(f"- {line}" for line in lines), _table(verdicts)]
    blocks += [block for claim in claims for block in _section(claim)]
    return "\n\n".join(filter(None, blocks)) + "\n"


def _section(claim: Claim) -> Iterator[str]:
    yield f"## {claim.claim}"
    yield f"*{claim.verdict.capitalize()}* ({claim.source}). {claim.finding}"
    yield (
        f"- How it was decided: {claim.method}\n"
        f"- Proved, from {claim.certainty['certified']} certified values: {claim.proved_words}\n"
        f"- Not proved: {claim.unproved}"
    )
    levels = [{_words(name): _cell(value) for name, value in row.items()} for row in claim.levels]
    yield _table(levels) if levels else ""


def _where(claim: Claim) -> str:
    limits = {"fails from": claim.fails_from, "up to": claim.holds_up_to, "from": claim.holds_from}
    found = [f"{words} P_M/P = {level:.3g}" for words, level in limits.items() if level is not None]
    return found[0] if found else "everywhere"


def _words(name: str) -> str:
    """Return the name of a number in words, its unit in brackets."""
    name = name.replace("jamming_to_transmission_ratio", "P_M/P").replace("_db", "_dB")
    return re.sub(r"_(dB|m|deg)$", r" (\1)", name).replace("_", " ").replace("P M/P", "P_M/P")


def _cell(value: object) -> str:
    if isinstance(value, list):
        return f"({', '.join(map(_cell, value))})"
    if isinstance(value, float):
        return "0" if abs(value) < 1e-12 else f"{value:.5g}"
    return str(value)


def _table(rows: Sequence[Row]) -> str:
    """Write rows as a table in Markdown; the first heading names the row."""
    rule = ["---", *("---:" for _ in list(rows[0])[1:])]
    lines = [list(rows[0]), rule, *(list(row.values()) for row in rows)]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
