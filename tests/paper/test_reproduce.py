"""The reproduction as a whole: its files agree with each other and with what it returns."""

import csv
import io
import json

from rich.console import Console

from nullpose.paper.pages import Reproduction, reproduction_view

KEYS = [
    "id",
    "claim",
    "source",
    "verdict",
    "finding",
    "evidence",
    "holds_up_to",
    "holds_from",
    "fails_from",
    "method",
    "certainty",
    "proved",
    "unproved",
]


def test_files(reproduction: Reproduction) -> None:
    """All are there, none is empty, and nothing else was left in the folder."""
    folder = reproduction.files[0].parent
    assert set(folder.iterdir()) == set(reproduction.files)
    assert all(path.stat().st_size > 1000 for path in reproduction.files)


def test_claims_json(reproduction: Reproduction) -> None:
    """The file is strict JSON with the documented keys."""

    def refuse(name: str) -> float:
        raise AssertionError(name)

    (path,) = [path for path in reproduction.files if path.name == "claims.json"]
    data = json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse)
    assert [list(claim) for claim in data["claims"]] == [KEYS] * 8
    assert data["provenance"]["seed"] == 0
    for claim in data["claims"]:
        assert claim["certainty"]["certified"] == claim["certainty"]["values"] > 0
        assert claim["certainty"]["largest_relative_gap"] <= 1e-6
    printed = data["figure2"].pop("maximum-gain-printed")
    assert (printed["best_found"], printed["largest_relative_gap"]) == (printed["values"], None)
    assert {name: found["certified"] for name, found in data["figure2"].items()} == dict.fromkeys(
        ("optimum", "zero-interference", "maximum-gain", "vertical"), 19
    )
    assert "certified optimal within 1e-6" in data["note"]
    assert "proved only where a claim says so" in data["note"]


def test_figure2_csv_is_the_table(reproduction: Reproduction) -> None:
    """The data file has a row for each point of the figure."""
    (path,) = [path for path in reproduction.files if path.name == "figure2.csv"]
    with path.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(float(row["jammers.M.power_w"]), row["scheme"]) for row in rows] == [
        (row.value, row.scheme) for row in reproduction.table.rows
    ]
    assert [float(row["min_sinr_db"]) for row in rows] == [r.min_sinr_db for r in reproduction.table.rows]
    for row in rows:
        if row["scheme"] == "maximum-gain-printed":
            assert (row["status"], row["upper_bound_db"], row["relative_gap"]) == ("best-found", "", "")
        else:
            assert row["status"] == "certified"
            assert 0.0 <= float(row["relative_gap"]) <= 1e-6
            assert float(row["upper_bound_db"]) >= float(row["min_sinr_db"])


def test_view(reproduction: Reproduction) -> None:
    """The verdicts and the files are printed."""
    console = Console(width=200, file=io.StringIO())
    console.print(reproduction_view(reproduction))
    text = console.file.getvalue()
    assert text.count("holds ") == 7
    assert text.count("fails ") == 1
    assert "Vertical: each point is certified optimal within 1e-6 (relative)" in text
    assert "as printed: best found by search, no upper bound" in text
    assert all(str(path) in text for path in reproduction.files)
