"""The verb `sweep`: a table and a figure of every case."""

import csv
import json
from pathlib import Path

import pytest

from nullpose import apply_overrides, load, solve
from scenes import Run


def test_files_of_a_sweep(run: Run, paper: str, tmp_path: Path) -> None:
    """CSV, PNG, SVG and PDF are written into a folder made with its parents; the table is printed."""
    out = tmp_path / "deep" / "out"
    arguments = ("--from", "1e-2", "--to", "1e2", "--points", 5, "--log", "--out", out)
    result = run("sweep", paper, "--set", "jammers.M.power_w", *arguments)
    assert (result.exit_code, result.stderr) == (0, "")
    assert sorted(path.name for path in out.iterdir()) == [
        f"sweep.{end}" for end in ("csv", "pdf", "png", "svg")
    ]
    with (out / "sweep.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [float(row["jammers.M.power_w"]) for row in rows[::4]] == [0.01, 0.1, 1.0, 10.0, 100.0]
    assert {row["scheme"] for row in rows} == {"optimum", "zero-interference", "maximum-gain", "vertical"}
    optimum = [row for row in rows if row["scheme"] == "optimum"]
    assert float(optimum[2]["min_sinr_db"]) == pytest.approx(0.9836997, abs=1e-6)
    for row in rows:
        assert row["status"] == "certified"
        assert 0.0 <= float(row["relative_gap"]) <= 1e-6
        assert float(row["upper_bound_db"]) > float(row["min_sinr_db"])
    assert "0.9837" in result.stdout
    assert "Each point is certified optimal within 1e-6" in result.stdout
    assert str(out / "sweep.png") in result.stdout


def test_json_of_a_sweep(run: Run, paper: str, tmp_path: Path) -> None:
    """One object with the rows and the files; values evenly spaced unless asked otherwise."""
    arguments = ("--from", 1, "--to", 3, "--points", 3, "--scheme", "vertical", "--json", "--out", tmp_path)
    result = run("sweep", paper, "--set", "jammers.M.power_w", "--set", "receiver.noise_dbm=3", *arguments)
    answer = json.loads(result.stdout)
    assert answer["set"] == "jammers.M.power_w"
    assert [(row["value"], row["scheme"]) for row in answer["rows"]] == [
        (1.0, "vertical"),
        (2.0, "vertical"),
        (3.0, "vertical"),
    ]
    assert [Path(path).exists() for path in answer["files"]] == [True] * 4
    assert answer["rows"][0]["stats"]["boxes"] > 0


def test_a_time_limit_holds_for_each_row(run: Run, paper: str, tmp_path: Path) -> None:
    """Every row tells that its proof was stopped, and has a bound."""
    field = paper.replace("paper.toml", "field.toml")
    limits = ("--scheme", "optimum", "--time-limit", "1e-9", "--json", "--out", tmp_path)
    arguments = ("--set", "jammers.van.power_w", "--from", 1, "--to", 2, "--points", 2, *limits)
    rows = json.loads(run("sweep", field, *arguments).stdout)["rows"]
    assert [row["reason"] for row in rows] == ["the time limit of 1e-09 s"] * 2
    assert all(row["upper_bound"] >= row["min_sinr"] for row in rows)


def test_least_tilts_of_a_sweep(run: Run, paper: str, tmp_path: Path) -> None:
    """Both sides stand in the table, the file and the JSON object."""
    arguments = ("--from", 1, "--to", 100, "--points", 2, "--mount", "0,90", "--out", tmp_path)
    result = run("sweep", paper, "--set", "jammers.M.power_w", *arguments)
    assert result.exit_code == 0, result.output
    words = " ".join(result.stdout.split())
    assert "Least tilt (deg)" in words
    assert "75.4 6.1 too little: 75.3 too little: 6.0" in words
    assert "proved to 0.1 degrees at 4 of 4 points" in words
    with (tmp_path / "sweep.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [(row["mount_deg"], row["least_tilt_deg"]) for row in rows[:2]] == [
        ("0.0", "75.4"),
        ("90.0", "6.1"),
    ]
    answer = json.loads(run("sweep", paper, "--set", "jammers.M.power_w", *arguments, "--json").stdout)
    assert [row["too_little_deg"] for row in answer["rows"][:2]] == [75.3, 6.0]


LAW = ["channel.model=power-law", "channel.exponent=2.5"]
BY_HAND = ["channel.a=9.61", "channel.b=0.16", "channel.los_loss_db=1", "channel.nlos_loss_db=20"]


@pytest.mark.parametrize(
    ("file", "fixed", "path", "ends"),
    [
        pytest.param("paper.toml", LAW[:1], "channel.exponent", (2.0, 3.5), marks=pytest.mark.grid),
        ("paper.toml", LAW, "channel.reference_distance_m", (0.5, 1.0)),
        pytest.param(
            "town.toml", ["channel={}", *LAW], "channel.blocked_loss_db", (10.0, 30.0), marks=pytest.mark.slow
        ),
        pytest.param("urban.toml", BY_HAND[1:], "channel.a", (5.0, 12.0), marks=pytest.mark.grid),
        ("urban.toml", BY_HAND, "channel.b", (0.1, 0.4)),
        pytest.param("urban.toml", BY_HAND, "channel.los_loss_db", (0.0, 3.0), marks=pytest.mark.grid),
        pytest.param("urban.toml", BY_HAND[:3], "channel.nlos_loss_db", (10.0, 30.0), marks=pytest.mark.grid),
        pytest.param("town.toml", [], "buildings[0].height_m", (20.0, 60.0), marks=pytest.mark.slow),
        ("town.toml", [], "buildings.church.height_m", (20.0, 60.0)),
    ],
)
def test_every_number_of_a_channel_or_a_building_can_be_varied(
    run: Run, paper: str, tmp_path: Path, file: str, fixed: list[str], path: str, ends: tuple[float, float]
) -> None:
    """A row is what a solve with that number gives; the file need not state the number itself."""
    file = paper.replace("paper.toml", file)
    settings = [text for setting in [*fixed, path] for text in ("--set", setting)]
    limits = ("--points", 2, "--scheme", "vertical", "--gap", 0.1, "--json", "--out", tmp_path)
    result = run("sweep", file, *settings, "--from", ends[0], "--to", ends[1], *limits)
    assert result.exit_code == 0, result.output
    for row, value in zip(json.loads(result.stdout)["rows"], ends, strict=True):
        alone = solve(apply_overrides(load(file), [*fixed, f"{path}={value}"]), "vertical", gap=0.1)
        assert (row["value"], row["status"]) == (value, "certified")
        assert row["min_sinr"] == pytest.approx(alone.objective.value, rel=1e-12)
