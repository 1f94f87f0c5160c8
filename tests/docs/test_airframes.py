"""The page on airframes: its tables, and what its sentences rest on, are in the numbers kept beside it."""

import csv
from pathlib import Path

import numpy as np
import pytest
from sizes import and_slow

import nullpose
from nullpose.study.monte_carlo import draw_scene, load_spec

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "airframes.md").read_text(encoding="utf-8")
README = (DOCS.parent / "README.md").read_text(encoding="utf-8")
DIPOLES = (
    "level-vertical",
    "level-horizontal",
    "tilt-10-horizontal",
    "tilt-30-horizontal",
    "omnidirectional",
)

SPEC = (DOCS.parent / "examples" / "study-whips.toml").read_text(encoding="utf-8")

Table = dict[str, np.ndarray]


def _table(name: str) -> Table:
    with (DOCS / "figures" / f"airframes-{name}.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([row[key] for row in rows]) for key in rows[0]} | {
        key: np.array([float(row[key]) for row in rows]) for key in rows[0] if key != "case"
    }


def _printed(header: str) -> list[list[str]]:
    """Return the cells of the page's table with a header line that begins so."""
    after = PAGE[PAGE.index(f"\n| {header}") + 1 :].split("\n\n", 1)[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in after]


def test_the_papers_scene() -> None:
    """Each vehicle at each jamming power, to the last digit."""
    table = _table("paper")
    for level, *cells in _printed("$P_M / P$ | level, vertical"):
        (row,) = np.flatnonzero(table["jamming_ratio"] == float(level))
        assert cells == [f"{table[name][row]:.4f}" for name in DIPOLES]
    share = table["tilt-10-horizontal"] / table["omnidirectional"]
    assert f"at least {np.floor(1000 * share.min()) / 10:.1f} %" in PAGE


def test_the_fields() -> None:
    """How many lose no more than 1 % and 1 dB, median and worst."""
    table = _table("fields")
    rows = _printed("vehicle, dipole | within 1 %")
    for name, (_, *cells) in zip(DIPOLES, rows, strict=False):
        share = table[name] / table["omnidirectional"]
        loss_db = 10.0 * np.log10(share)
        counts = [str(np.sum(share >= 0.99)), str(np.sum(loss_db >= -1.0))]
        assert cells[:2] == counts
        assert [float(cell.split()[0]) for cell in cells[2:]] == pytest.approx(
            [np.median(loss_db), loss_db.min()], abs=6e-3
        )


def test_what_any_attitude_gains_in_the_papers_scene() -> None:
    """The median over the jamming powers and the most, which is between two of them, here and there."""
    table = _table("paper")
    gain_db = 10.0 * np.log10(table["omnidirectional"] / table["level-vertical"])
    scene = nullpose.apply_overrides(nullpose.load("examples/paper.toml"), ["jammers.M.power_w=0.801"])
    best, level = (nullpose.solve(scene, scheme).objective.value_db for scheme in ("optimum", "vertical"))
    assert best - level > gain_db.max()
    assert f"{np.median(gain_db):.2f} dB | {best - level:.2f} dB" in PAGE
    assert f"up to {best - level:.2f} dB in the paper's scene" in README


@pytest.mark.parametrize("antenna", and_slow(["isotropic"], ["dipole"]))
def test_what_any_attitude_gains_on_farms(antenna: str, tmp_path: Path) -> None:
    """The median and the most of the example study, with whips and without, are those printed."""
    file = tmp_path / "spec.toml"
    file.write_text(SPEC.replace('"dipole"', f'"{antenna}"'), encoding="utf-8")
    spec = load_spec(file)
    scenes = [draw_scene(spec, number) for number in range(spec.n_scenes)]
    many = nullpose.solve_many(
        scenes, airframes=[case.airframe for case in spec.cases], gap=spec.gap, node_limit=spec.node_limit
    )
    level, free = many.value.T
    gain_db = 10.0 * np.log10(free / level)
    assert set(many.status.flat) == {nullpose.Status.CERTIFIED}
    most = f"{gain_db.max():.{0 if gain_db.max() > 10.0 else 1}f}"
    assert f"{np.median(gain_db):.2f} dB | {most} dB" in PAGE


def test_the_least_tilts_of_random_fields() -> None:
    """The sentence below the table says what is in it."""
    with (DOCS / "figures" / "least-tilt-table.csv").open(encoding="utf-8", newline="") as file:
        rows = {
            (row["ground antennas"], row["mount (deg)"]): row
            for row in csv.DictReader(file)
            if row["channel"] == "free space"
        }
    isotropic, whips = (
        [f"{float(rows[key][tilt].split(' / ')[0]):.0f} %" for tilt in ("10°", "30°")]
        for key in (("isotropic", "90"), ("whips", "45"))
    )
    words = " ".join(PAGE.split())
    assert f"10 degrees suffice in {isotropic[0]} of the fields and 30 degrees in {isotropic[1]}" in words
    assert f"With whips and a mount of 45 degrees it is {whips[0]} and {whips[1]}" in words
    readme = " ".join(README.split())
    assert f"in {isotropic[0]} of 500 random fields, with 30 degrees in {isotropic[1]}" in readme
    assert f"With whips and a mount of 45 degrees: {whips[0]} and {whips[1]}." in readme
