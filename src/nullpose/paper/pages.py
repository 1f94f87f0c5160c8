"""The claims as a JSON object, as a page to read, and as a table for a terminal."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from nullpose.paper.claim import Claim
from nullpose.report.certainty import Certainty, certainty_lines
from nullpose.report.document import document, markdown_table, table
from nullpose.study import SweepTable

if TYPE_CHECKING:
    from rich.console import RenderableType

_BEYOND = (
    "A bound is on a value at one power: where the best pose lies, a level found by bisection, and powers "
    "between those looked at are proved only where a claim says so."
)
_HEAD = """# The paper's claims, checked

Written by `nullpose reproduce` from its own data (`figure2.csv` and solves between its points), for the
scenario of section 4. P_M/P is the jamming-to-transmission power ratio; values are the smallest SINR over
the nodes."""


@dataclass(frozen=True, slots=True)
class Reproduction:
    """What a reproduction found and wrote.

    Args:
        table: the data of Figure 2.
        claims: the paper's claims with their verdicts.
        provenance: what produced them: versions and seed.
        files: what was written.
    """

    table: SweepTable
    claims: tuple[Claim, ...]
    provenance: Mapping[str, object]
    files: tuple[Path, ...] = ()

    def claims_dict(self) -> dict[str, object]:
        """Return the claims as plain data."""
        return {
            "scenario": "Bonilla Licea et al., ICASSP 2024, section 4",
            "levels_are": "P_M/P, the jamming-to-transmission power ratio",
            "note": " ".join(_sentences(self.table)),
            "figure2": {name: Certainty.of(self.table.of(name)).to_dict() for name in self.table.schemes},
            "claims": [claim.to_dict() for claim in self.claims],
            "provenance": dict(self.provenance),
        }

    def to_dict(self) -> dict[str, object]:
        """Return the claims and the files as plain data."""
        return self.claims_dict() | {"files": [str(path) for path in self.files]}


def claims_markdown(reproduction: Reproduction) -> str:
    """Return a page with a table of verdicts, and a section on each claim.

    Args:
        reproduction: what was found.
    """
    claims = reproduction.claims
    verdicts = [
        {"claim": each.claim, "verdict": f"**{each.verdict}**", "where": _where(each)} for each in claims
    ]
    blocks = [
        _HEAD,
        "\n".join(f"- {line}" for line in _sentences(reproduction.table)),
        markdown_table(verdicts),
    ]
    for claim in claims:
        single = {name: value for name, value in claim.evidence.items() if name != "levels"}
        blocks += [
            f"## {claim.claim}",
            f"*{claim.verdict.capitalize()}.* {claim.finding}",
            f"- Claimed in: {claim.source} (`{claim.id}`).\n"
            f"- How it was decided: {claim.method}\n"
            f"- It rests on {claim.certainty.words()}.\n"
            f"- Proved: {claim.proved_words}\n"
            f"- Not proved: {claim.unproved}",
            "\n".join(f"- {_words(name)}: {_cell(value)}" for name, value in single.items()),
        ]
        levels = [
            {_words(name): _cell(value) for name, value in row.items()}
            for row in claim.evidence.get("levels", ())
        ]
        blocks.append(markdown_table(levels) if levels else "")
    return "\n\n".join(filter(None, blocks)) + "\n"


def reproduction_view(reproduction: Reproduction) -> RenderableType:
    """Return the verdicts as a table, what is proved of Figure 2, and the list of files.

    Args:
        reproduction: what was found and written.
    """
    rows: list[dict[str, str]] = []
    for claim in reproduction.claims:
        rows += [{"verdict": claim.verdict, "claim and finding": f"{claim.claim}\n{claim.finding}"}, {}]
    lines = [f"Figure 2: {line}" for line in _sentences(reproduction.table)]
    lines += [f"Wrote {path}" for path in reproduction.files]
    return document(table("The paper's claims", rows[:-1], left=["claim and finding"]), "\n".join(lines))


def _sentences(sweep: SweepTable) -> list[str]:
    return [*(f"{line}." for line in certainty_lines(sweep)), _BEYOND]


def _where(claim: Claim) -> str:
    limits = {"fails from": claim.fails_from, "up to": claim.holds_up_to, "from": claim.holds_from}
    told = [f"{words} P_M/P = {level:.3g}" for words, level in limits.items() if level is not None]
    return told[0] if told else "everywhere"


def _words(name: str) -> str:
    """Return the name of a number in words, its unit in brackets."""
    name = name.replace("jamming_to_transmission_ratio", "P_M/P").replace("_db", "_dB")
    return re.sub(r"_(dB|m|deg)$", r" (\1)", name).replace("_", " ").replace("P M/P", "P_M/P")


def _cell(value: object) -> str:
    if value is None:
        return "never"
    if isinstance(value, Mapping):
        return ", ".join(f"{_words(name)} {_cell(item)}" for name, item in value.items())
    if isinstance(value, list):
        return f"({', '.join(map(_cell, value))})"
    if isinstance(value, float):
        return "0" if abs(value) < 1e-12 else f"{value:.5g}"
    return str(value)
