"""The page on airframes: its tables, and what its sentences rest on, are in the numbers kept beside it."""

import csv
import re
from pathlib import Path

import numpy as np
import pytest

DOCS = Path(__file__).parents[2] / "docs"
PAGE = (DOCS / "airframes.md").read_text(encoding="utf-8")
DIPOLES = ("level-vertical", "level-horizontal", "tilt-10", "tilt-30", "omnidirectional")

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


def _joined() -> tuple[Table, Table]:
    """Return the fields with arrays, and the same fields with dipoles."""
    arrays, dipoles = _table("field-arrays"), _table("fields")
    rows = {key: index for index, key in enumerate(_names(dipoles))}
    order = [rows[key] for key in _names(arrays)]
    return arrays, {key: column[order] for key, column in dipoles.items()}


def _names(table: Table) -> list[tuple[float, ...]]:
    return list(zip(table["nodes"], table["jammers"], table["index"], strict=True))


def test_the_papers_scene() -> None:
    """Each vehicle at each jamming power, to the last digit."""
    table = _table("paper")
    for level, *cells in _printed("$P_M / P$ | level, vertical"):
        (row,) = np.flatnonzero(table["jamming_ratio"] == float(level))
        assert cells == [f"{table[name][row]:.4f}" for name in DIPOLES]
    share = table["tilt-10"] / table["omnidirectional"]
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


def test_errors() -> None:
    """What nominal and robust poses guarantee."""
    table = _table("errors")
    for error, vehicle, *cells in _printed("error | vehicle"):
        number = float(re.sub(r"[^\d.]", "", error) or 0.0)
        degrees, radius_m = (number, 0.0) if "°" in error else (0.0, number)
        (row,) = np.flatnonzero(
            (table["case"] == ("omnidirectional" if vehicle == "omnidirectional" else "tilt-10"))
            & (np.abs(table["attitude_error_deg"] - degrees) < 1e-9)
            & (np.abs(table["jammer_radius_m"] - radius_m) < 1e-9)
        )
        assert cells == [f"{table[name][row]:.4f}" for name in ("nominal_pose", "robust_pose")]


def test_arrays_in_the_papers_scene() -> None:
    """Multiples of what the omnidirectional dipole gives."""
    table = _table("arrays")
    for level, *cells in _printed("$P_M / P$ | 1 element |"):
        found = []
        for size in (1, 2, 4, 8):
            (row,) = np.flatnonzero((table["jamming_ratio"] == float(level)) & (table["elements"] == size))
            found.append(f"{table['digital'][row] / table['omnidirectional'][row]:.2f}")
        assert cells == found


def test_arrays_in_fields() -> None:
    """Gains in dB, and how many fields of each kind there are."""
    arrays, dipoles = _joined()
    kinds = list(zip(arrays["nodes"], arrays["jammers"], strict=True))
    assert {kinds.count(kind) for kind in kinds} == {len(kinds) // 6}
    assert f"{len(kinds)} random fields, {len(kinds) // 6} of each kind" in " ".join(PAGE.split())
    for jammers, size, *cells in _printed("jammers | elements"):
        chosen = arrays["jammers"] == float(jammers)
        gain_db = 10.0 * np.log10(arrays[f"array-{size}"][chosen] / dipoles["omnidirectional"][chosen])
        assert cells == [f"{value:.1f}" for value in (gain_db.min(), np.median(gain_db), gain_db.max())]


def test_two_elements_do_better_everywhere() -> None:
    """They are above the omnidirectional dipole's bound in each field, and in the paper's scene."""
    arrays, dipoles = _joined()
    assert np.all(arrays["array-2"] > dipoles["omnidirectional-bound"])
    table = _table("arrays")
    two = table["elements"] == 2
    assert np.all(table["digital"][two] > table["omnidirectional"][two])
