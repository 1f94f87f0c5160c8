"""The page on objectives: its tables and sentences are in the numbers kept beside it."""

import csv
import sys
from pathlib import Path

import numpy as np
import pytest

import nullpose

sys.path.append(str(Path(__file__).parents[2] / "docs" / "figures"))

from objectives_data import FIELDS, OBJECTIVES, axis_of, field, under, values_at

import objectives as page

DOCS = Path(__file__).parents[2] / "docs"
WORDS = " ".join((DOCS / "objectives.md").read_text(encoding="utf-8").split())
PAPER, OF_FIELDS = page.read("paper"), page.read("fields")
GAINS = {name: page.column(OF_FIELDS, "power_db", objective=name) for name in OBJECTIVES}
JAMMERS, NOISE_W = (page.column(OF_FIELDS, key, objective="min-sinr") for key in ("jammers", "noise_w"))
PLACES_M = {
    name: np.stack([page.column(OF_FIELDS, f"{axis}_m", objective=name) for axis in "xyz"], axis=-1)
    for name in OBJECTIVES
}
WORST, FAIR, RATE = OBJECTIVES


def apart_m(first: str, second: str, chosen: np.ndarray) -> float:
    """Measure the median distance of the best poses for two objectives."""
    return float(np.median(np.linalg.norm(PLACES_M[first] - PLACES_M[second], axis=1)[chosen]))


def test_the_tables_are_those_of_the_numbers() -> None:
    """Each cell."""
    tables = {
        "losses": page.loss_table(OF_FIELDS),
        "attitude": page.attitude_table(OF_FIELDS),
        "positions": page.position_table(PAPER),
        "claims": page.claim_table(PAPER),
    }
    for name, table in tables.items():
        with (DOCS / "figures" / f"objectives-{name}-table.csv").open(encoding="utf-8", newline="") as file:
            assert list(csv.reader(file)) == table


def test_everything_is_certified() -> None:
    """To the gaps that the page states."""
    states = [row[key] for row in OF_FIELDS for key in ("status", "upright_status")]
    assert set(states) == {row["status"] for row in PAPER} == {"certified"}
    assert (
        f"the {len(states):,} of the fields to $10^{{-3}}$, the {len(PAPER)} of the paper's scene to "
        "$10^{-6}$" in WORDS
    )
    for rows, gap in ((OF_FIELDS, 1e-3), (PAPER, 1e-6)):
        value, bound = page.column(rows, "value"), page.column(rows, "upper_bound")
        assert np.max(bound / value) <= 1.0 + 1.01 * gap


def test_where_the_drone_is() -> None:
    """Distances of the best poses, and what is lost at them."""
    every, quiet, paper = JAMMERS >= 0, NOISE_W < 1e-4, NOISE_W > 1e-4
    assert f"it is {apart_m(WORST, RATE, every):.1f} m (median)" in WORDS
    assert f"and the sum rate are {apart_m(FAIR, RATE, every):.1f} m apart" in WORDS
    assert f"the same pose, to {apart_m(FAIR, RATE, quiet):.1f} m" in WORDS
    assert f"they are {apart_m(FAIR, RATE, paper):.1f} m apart" in WORDS
    rate, worst = page.losses(OF_FIELDS, RATE, WORST), page.losses(OF_FIELDS, WORST, RATE)
    assert (
        f"{np.median(rate):.0f} % of the sum rate is lost (median; {rate.max():.0f} % in one field)" in WORDS
    )
    recipes = " ".join((DOCS / "recipes.md").read_text(encoding="utf-8").split())
    assert f"for the worst node loses {np.median(rate):.0f} % of the sum rate (median)" in recipes
    assert f"has {np.median(worst):.1f} dB less ({worst.max():.0f} dB in one field)" in WORDS
    fair = page.losses(OF_FIELDS, RATE, FAIR)
    assert f"within {np.median(fair):.1f} % of the largest sum rate" in WORDS
    assert f"costs the worst node {np.median(page.losses(OF_FIELDS, WORST, FAIR)):.1f} dB" in WORDS
    assert f"fairness costs {np.median(fair[paper]):.1f} % of the rate" in WORDS
    nodes_m = [field(index).node_positions_m for index in range(FIELDS)]
    near = {
        name: np.median(
            [
                np.min(np.linalg.norm((n - p)[:, :2], axis=1))
                for n, p in zip(nodes_m, PLACES_M[name], strict=True)
            ]
        )
        for name in OBJECTIVES
    }
    assert (
        f"is {near[WORST]:.1f} m away (median, from above) at its best pose, {near[RATE]:.1f} m at" in WORDS
    )


def test_what_attitude_is_worth() -> None:
    """In the fields with jammers and without, and in the paper's scene."""
    jammed = JAMMERS > 0
    worst, fair, rate = (f"{np.median(GAINS[name][jammed]):.2f} dB" for name in OBJECTIVES)
    assert f"In the {jammed.sum()} fields with jammers any attitude gains {worst} over" in WORDS
    assert f"{fair} under proportional fairness and {rate} for the sum rate (medians)" in WORDS
    more = np.mean(GAINS[RATE][jammed] > GAINS[WORST][jammed])
    assert f"than for the worst node in {100.0 * more:.0f} % of these fields" in WORDS
    close = [f"{100.0 * np.mean(GAINS[name][~jammed] < 0.1):.0f} %" for name in OBJECTIVES]
    assert f"in {close[0]} of the {np.sum(~jammed)} fields without jammers, in {close[1]} under" in WORDS
    assert f"in {close[2]} for the sum rate" in WORDS
    for name, words in zip(OBJECTIVES, ("for the worst node", "under", "for the sum rate"), strict=True):
        gains = page.gains_db(PAPER, name)
        assert f"{gains.min():.2f} to {gains.max():.2f} dB {words}" in WORDS


def test_the_papers_scene() -> None:
    """What the other node loses, and that seven claims hold under all objectives at some powers."""
    rows = page.position_table(PAPER)[1:]
    best = {row[0]: float(row[3]) for row in rows if row[1] == "worst node"}
    less = [best[row[0]] - float(row[3]) for row in rows if row[1] != "worst node"]
    assert f"has {min(less):.1f} to {max(less):.1f} dB less" in WORDS
    none = [row[0] for row in page.claim_table(PAPER)[1:] if "at none" in row]
    assert none == ["Maximum gain is equally far from both nodes"]


@pytest.mark.parametrize("name", OBJECTIVES)
def test_a_solve_finds_the_numbers_again(name: str) -> None:
    """Of a field drawn anew: the value to the gaps, and what the pose is worth."""
    index = 14
    (row,) = (each for each in OF_FIELDS if each["objective"] == name and each["index"] == str(index))
    found = nullpose.solve(under(field(index), name), gap=1e-3)
    assert found.objective.value == pytest.approx(float(row["value"]), rel=1e-3)
    here = [float(row[f"{each}-here"]) for each in OBJECTIVES]
    assert values_at(found.scenario, found.pose) == pytest.approx(here, abs=5e-3)
    assert axis_of(found.pose)[0] == pytest.approx(float(row["tilt_deg"]), abs=0.1)
