"""The page on the report of a study: its numbers are those kept beside it, and all columns are explained."""

import csv
import re
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "study-report.md").read_text(encoding="utf-8")
ANSWER = (DOCS / "figures" / "study-report-answer.txt").read_text(encoding="utf-8")
GAINS = (DOCS / "figures" / "study-report-gains.txt").read_text(encoding="utf-8")

with (DOCS / "figures" / "study-report.csv").open(encoding="utf-8", newline="") as _file:
    ROWS = list(csv.DictReader(_file))

LAST = {row["case"]: row for row in ROWS if row["point"] == ROWS[-1]["point"]}


def test_the_answer_is_in_the_data() -> None:
    """Both gains, and the differences from all of tilt, are those of the summary's last combination."""
    assert f"Over {int(LAST['omnidirectional']['scenes']):,} scenes at P_M/P = 100 " in ANSWER
    for case, phrase in (
        ("omnidirectional", "an omnidirectional vehicle"),
        ("tilt-10", "a 10 degree tilt with a horizontal dipole"),
        ("tilt-30", "a 30 degree tilt with a horizontal dipole"),
    ):
        told = ANSWER.split(f"{phrase} gains ")[1].split(";")[0]
        gains = re.findall(r"([\d.]+) dB in the (?:median|worst tenth)", told)
        numbers = [float(LAST[case][name]) for name in ("gain_median_db", "shift_worst_tenth_db")]
        assert gains == [f"{number:.2f}" for number in numbers]
        less = [float(number) for number in re.findall(r"([\d.]+) dB less", told)]
        names = ("difference_median_db", "difference_worst_tenth_db") if less else ()
        for number, name in zip(less, names, strict=True):
            assert abs(float(LAST[case][name]) + number) <= 0.0101


def test_the_tables_are_the_data() -> None:
    """Each median gain of the page's table is that of the summary."""
    table = GAINS.split("**")[2]
    for line in table.strip().splitlines()[2:]:
        name, *cells = (cell.strip() for cell in line.strip("|").split("|"))
        rows = [row for row in ROWS if row["case"] == name]
        shown = [cell.split()[0].replace("\N{MINUS SIGN}", "-") for cell in cells]
        assert shown == [f"{float(row['gain_median_db']):.2f}" for row in rows]


def test_every_column_is_explained() -> None:
    """The page's table names each column of the summary, less units and the ends of intervals."""
    table = PAGE.split("## The summary's columns")[1].split("\n## ")[0]
    names = {re.sub(r"(_db)?$", "", name).removesuffix("_low").removesuffix("_high") for name in ROWS[0]}
    robust = {"nominal", "cost_median", "cost_worst_tenth"}
    swept = {name for name in names if "." in name}
    assert set(re.findall(r"`([a-z0-9_]+)`", table.split("|---|---|")[1])) == (names - swept) | robust
