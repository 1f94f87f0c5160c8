"""The known answers in tests/reference, and nullpose's own beside them.

Shared by the validation page and by tests/docs/test_validation.py, which need nothing of each other's tools.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import nullpose

ROOT = Path(__file__).parents[2]
KNOWN_ANSWERS = ROOT / "tests" / "reference" / "paper_scenario" / "known_answers.csv"
SCENARIO = ROOT / "examples" / "paper.toml"

POSITION_TOLERANCE_M = 0.01


@dataclass(frozen=True, slots=True)
class Known:
    """A published or agreed answer.

    Args:
        jamming_ratio: the jammer's power over the nodes' power.
        scheme: the case, as ``--scheme`` names it.
        min_sinr_db: the smallest SINR in dB, as text: its digits tell how well it is known.
        given_db: the same as first given, if it had to be corrected; else empty.
        position_m: where it was found, or nothing if that is not known.
    """

    jamming_ratio: float
    scheme: str
    min_sinr_db: str
    given_db: str
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
    certified: bool
    upper_bound_db: float

    @property
    def error_db(self) -> float:
        """Ours less theirs."""
        return self.min_sinr_db - float(self.known.min_sinr_db)

    @property
    def agrees(self) -> bool:
        """Whether value and position are within their tolerances, and the value is certified."""
        pairs = zip(self.position_m, self.known.position_m, strict=False)
        apart_m = max((abs(ours - theirs) for ours, theirs in pairs), default=0.0)
        close = abs(self.error_db) <= self.known.tolerance_db and apart_m <= POSITION_TOLERANCE_M
        return close and self.certified


def known_answers() -> list[Known]:
    """Return the known answers, one that holds for every jamming power repeated for each."""
    with KNOWN_ANSWERS.open(encoding="utf-8", newline="") as file:
        _units, *records = list(csv.DictReader(file))
    ratios = sorted({float(record["jamming_ratio"]) for record in records if record["jamming_ratio"]})
    return [
        Known(
            jamming_ratio=ratio,
            scheme=record["scheme"],
            min_sinr_db=record["corrected_db"] or record["min_sinr_db"],
            given_db=record["min_sinr_db"] if record["corrected_db"] else "",
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
    upper_bound = solution.objective.upper_bound
    return Row(
        known,
        min_sinr_db=solution.objective.value_db,
        position_m=position_m,
        certified=solution.status is nullpose.Status.CERTIFIED,
        upper_bound_db=math.inf if upper_bound is None else 10.0 * math.log10(upper_bound),
    )
