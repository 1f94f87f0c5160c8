"""The claims as a JSON object and as a page to read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from nullpose.report.certainty import certainty_by_scheme, certainty_lines
from nullpose.report.claims.claim import Claim
from nullpose.study import SweepTable

__all__ = ["claims_json", "claims_markdown"]

_BEYOND = (
    "A bound is on a value at one power: where the best pose lies, a level found by bisection, and powers "
    "between those looked at are proved only where a claim says so."
)


def claims_json(
    claims: Sequence[Claim], table: SweepTable, provenance: Mapping[str, object]
) -> dict[str, object]:
    """Return the claims as plain data.

    Args:
        claims: what was checked.
        table: the data of Figure 2.
        provenance: what produced the data.
    """
    return {
        "scenario": "Bonilla Licea et al., ICASSP 2024, section 4",
        "levels_are": "P_M/P, the jamming-to-transmission power ratio",
        "note": " ".join([*_sentences(table), _BEYOND]),
        "figure2": {name: found.to_dict() for name, found in certainty_by_scheme(table).items()},
        "claims": [claim.to_dict() for claim in claims],
        "provenance": dict(provenance),
    }


def _sentences(table: SweepTable) -> list[str]:
    return [f"{line}." for line in certainty_lines(table)]


def claims_markdown(claims: Sequence[Claim], table: SweepTable) -> str:
    """Return a page with a table of verdicts, and a section on each claim.

    Args:
        claims: what was checked.
        table: the data of Figure 2.
    """
    lines = [
        "# The paper's claims, checked",
        "",
        "Written by `nullpose reproduce` from its own data (`figure2.csv` and solves between its "
        "points), for the",
        "scenario of section 4. P_M/P is the jamming-to-transmission power ratio; values are the "
        "smallest SINR over",
        "the nodes.",
        "",
        *(f"- {sentence}" for sentence in _sentences(table)),
        f"- {_BEYOND}",
        "",
        "| claim | verdict | where |",
        "|---|---|---|",
        *(f"| {claim.claim} | **{claim.verdict}** | {_where(claim)} |" for claim in claims),
        "",
    ]
    for claim in claims:
        lines += [f"## {claim.claim}", "", f"*{claim.verdict.capitalize()}.* {claim.finding}", ""]
        lines += [
            f"- Claimed in: {claim.source} (`{claim.id}`).",
            f"- How it was decided: {claim.method}",
            *([f"- It rests on {claim.certainty.words()}."] if claim.certainty is not None else []),
            f"- Proved: {claim.proved_words}",
            f"- Not proved: {claim.unproved}",
            "",
        ]
        lines += _evidence_table(claim.evidence)
    return "\n".join(lines).rstrip() + "\n"


def _where(claim: Claim) -> str:
    if claim.fails_from is not None:
        return f"fails from P_M/P = {claim.fails_from:.3g}"
    if claim.holds_up_to is not None:
        return f"up to P_M/P = {claim.holds_up_to:.3g}"
    if claim.holds_from is not None:
        return f"from P_M/P = {claim.holds_from:.3g}"
    return "everywhere"


def _evidence_table(evidence: Mapping[str, object]) -> list[str]:
    """Return the rows of the evidence that has levels, as a table; single numbers as a list before it."""
    lines: list[str] = []
    for name, value in evidence.items():
        if isinstance(value, int | float | str | Mapping):
            lines.append(f"- {_words(name)}: {_cell(value)}")
    rows = evidence.get("levels")
    if isinstance(rows, list) and rows:
        heads = ["P_M/P" if name == "jamming_to_transmission_ratio" else _words(name) for name in rows[0]]
        lines += [""] if lines else []
        lines += ["| " + " | ".join(heads) + " |", "|" + "---|" * len(heads)]
        lines += ["| " + " | ".join(_cell(value) for value in row.values()) + " |" for row in rows]
    return [*lines, ""]


def _words(name: str) -> str:
    for suffix, unit in (("_db", " (dB)"), ("_m", " (m)"), ("_deg", " (deg)")):
        if name.endswith(suffix):
            name = name.removesuffix(suffix) + unit
            break
    return name.replace("_", " ").replace(" db", " dB")


def _cell(value: object) -> str:
    if value is None:
        return "never"
    if isinstance(value, Mapping):
        return ", ".join(f"{_words(name)} {_cell(item)}" for name, item in value.items())
    if isinstance(value, list):
        return "(" + ", ".join(_cell(item) for item in value) + ")"
    if isinstance(value, float):
        return "0" if abs(value) < 1e-12 else f"{value:.5g}"
    return str(value)
