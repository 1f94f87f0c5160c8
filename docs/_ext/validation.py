"""The validation page's tables: nullpose's answers beside the known ones in tests/reference.

The same rows are checked by tests/docs/test_validation.py.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

import nullpose

ROOT = Path(__file__).parents[2]
KNOWN_ANSWERS = ROOT / "tests" / "reference" / "paper_scenario" / "known_answers.csv"
SCENARIO = ROOT / "examples" / "paper.toml"
PAGE = ROOT / "docs" / "_build" / "generated" / "validation.md"

POSITION_TOLERANCE_M = 0.01


@dataclass(frozen=True, slots=True)
class Known:
    """A published or agreed answer.

    Args:
        jamming_ratio: the jammer's power over the nodes' power.
        scheme: the case, as ``--scheme`` names it.
        min_sinr_db: the smallest SINR in dB, as printed: its digits tell how well it is known.
        position_m: where it was found, or nothing if that is not known.
    """

    jamming_ratio: float
    scheme: str
    min_sinr_db: str
    position_m: tuple[float, ...]

    @property
    def tolerance_db(self) -> float:
        """The largest deviation in agreement with the digits."""
        digits = len(self.min_sinr_db.partition(".")[2])
        half_a_unit = 0.5 * 10.0**-digits
        return max(half_a_unit, 1e-6 * abs(float(self.min_sinr_db))) if digits >= 7 else half_a_unit


@dataclass(frozen=True, slots=True)
class Row:
    """A known answer and nullpose's own."""

    known: Known
    min_sinr_db: float
    position_m: tuple[float, ...]

    @property
    def error_db(self) -> float:
        """Ours less theirs."""
        return self.min_sinr_db - float(self.known.min_sinr_db)

    @property
    def agrees(self) -> bool:
        """Whether value and position are within their tolerances."""
        pairs = zip(self.position_m, self.known.position_m, strict=False)
        apart_m = max((abs(ours - theirs) for ours, theirs in pairs), default=0.0)
        return abs(self.error_db) <= self.known.tolerance_db and apart_m <= POSITION_TOLERANCE_M


def known_answers() -> list[Known]:
    """Return the known answers, one that holds for every jamming power repeated for each."""
    with KNOWN_ANSWERS.open(encoding="utf-8", newline="") as file:
        _units, *records = list(csv.DictReader(file))
    ratios = sorted({float(record["jamming_ratio"]) for record in records if record["jamming_ratio"]})
    return [
        Known(
            jamming_ratio=ratio,
            scheme=record["scheme"],
            min_sinr_db=record["min_sinr_db"],
            position_m=tuple(float(record[key]) for key in ("x_m", "y_m", "z_m") if record[key]),
        )
        for record in records
        for ratio in ([float(record["jamming_ratio"])] if record["jamming_ratio"] else ratios)
    ]


def solve(known: Known) -> Row:
    """Return nullpose's answer beside a known one."""
    scenario = nullpose.load(SCENARIO)
    scenario = nullpose.apply_overrides(scenario, [f"jammers.M.power_w={known.jamming_ratio!r}"])
    solution = nullpose.solve(scenario, scheme=known.scheme)
    position_m = tuple(float(x) for x in solution.pose.position_m)
    return Row(known, min_sinr_db=solution.objective.value_db, position_m=position_m)


def table(rows: list[Row]) -> Iterator[str]:
    """Yield the lines of a table in Markdown."""
    yield "| $P_M / P$ | ours (dB) | theirs (dB) | ours - theirs (dB) | our position (m) | theirs (m) |"
    yield "|---|---|---|---|---|---|"
    for row in rows:
        ours = ", ".join(f"{x:.3f}" for x in row.position_m)
        theirs = ", ".join(f"{x:g}" for x in row.known.position_m) or "not known"
        yield (
            f"| {row.known.jamming_ratio:g} | {row.min_sinr_db:.7f} | {row.known.min_sinr_db} "
            f"| {row.error_db:+.1e} | ({ours}) | {theirs} |"
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
        raise ExtensionError(f"an answer differs from the known one beyond its tolerance; see {PAGE}")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write the tables before any page is read."""
    app.connect("builder-inited", write_page)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
