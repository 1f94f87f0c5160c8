"""The page on the report of a study: its numbers are those beside it, and all columns are explained."""

import csv
import re
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "study-report.md").read_text(encoding="utf-8")
ANSWER = (DOCS / "figures" / "study-report-answer.txt").read_text(encoding="utf-8")
TABLE = (DOCS / "figures" / "study-report-table.txt").read_text(encoding="utf-8").splitlines()

with (DOCS / "figures" / "study-report.csv").open(encoding="utf-8", newline="") as _file:
    ROWS = list(csv.DictReader(_file))

LAST = {row["case"]: row for row in ROWS if row["point"] == ROWS[-1]["point"]}


def test_the_sentence_is_in_the_data() -> None:
    """Both gains are those of the summary's last combination."""
    whole = LAST["omnidirectional"]
    assert f"Over {int(whole['scenes']):,} scenes at jammers.M.power_w = 100 W an omnidirectional" in ANSWER
    gains = re.findall(r"([\d.]+) \([\d.]+ to [\d.]+\) dB in the (?:median|worst tenth)", ANSWER)
    assert gains == [f"{float(whole[name]):.2f}" for name in ("gain_median_db", "shift_worst_tenth_db")]


def test_the_table_is_the_data() -> None:
    """Each median gain of the page's table is that of the summary."""
    column = [heading.strip() for heading in TABLE[0].split("|")].index("median gain, dB")
    assert len(TABLE) == 2 + len(LAST)
    for line in TABLE[2:]:
        cells = [cell.strip() for cell in line.split("|")]
        shown = cells[column].split()[0].replace("\N{MINUS SIGN}", "-")
        assert shown == f"{float(LAST[cells[1]]['gain_median_db']):.2f}"


def test_every_column_is_explained() -> None:
    """The page's table names each column of the summary, less units and the ends of intervals."""
    table = PAGE.split("## The summary's columns")[1]
    names = {re.sub(r"(_db)?$", "", name).removesuffix("_low").removesuffix("_high") for name in ROWS[0]}
    swept = {name for name in names if "." in name}
    assert set(re.findall(r"`([a-z0-9_]+)`", table.split("|---|---|")[1])) == names - swept
