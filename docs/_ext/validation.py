"""The tables of the validation page, written before the pages are read; no page is built if one disagrees."""

from __future__ import annotations

import math
from collections.abc import Iterator

from known_answers import ROOT, Row, known_answers, solve
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

PAGE = ROOT / "docs" / "_build" / "generated" / "validation.md"


def table(rows: list[Row]) -> Iterator[str]:
    """Yield the lines of a table in Markdown."""
    heads = ("$P_M / P$", "ours (dB)", "at most (dB)", "theirs (dB)", "ours - theirs (dB)")
    yield f"| {' | '.join(heads)} | our position (m) | theirs (m) |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        ours = ", ".join(f"{x:.3f}" for x in row.position_m)
        theirs = ", ".join(f"{x:g}" for x in row.known.position_m)
        correction = f" (corrected; was {row.known.given_db})" if row.known.given_db else ""
        at_most_db = math.ceil(1e7 * row.upper_bound_db) / 1e7
        yield (
            f"| {row.known.jamming_ratio:g} | {row.min_sinr_db:.7f} | {at_most_db:.7f} "
            f"| {row.known.min_sinr_db}{correction} | {row.error_db:+.1e} "
            f"| ({ours}) | {f'({theirs})' if theirs else 'not given'} |"
        )


def write_page(_app: Sphinx) -> None:
    """Write the tables, one per case.

    Raises:
        ExtensionError: an answer does not agree.
    """
    rows = [solve(known) for known in known_answers()]
    lines = []
    for scheme in dict.fromkeys(row.known.scheme for row in rows):
        lines += [f"## {scheme.replace('-', ' ').capitalize()}", ""]
        lines += [*table([row for row in rows if row.known.scheme == scheme]), ""]
    PAGE.parent.mkdir(parents=True, exist_ok=True)
    PAGE.write_text("\n".join(lines), encoding="utf-8")
    if not all(row.agrees for row in rows):
        raise ExtensionError(
            f"an answer differs from the known one beyond its tolerance, or is not certified; see {PAGE}"
        )


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the tables before any page is read."""
    app.connect("builder-inited", write_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
