"""The numbers of docs/antennas.md are those that the solver certifies."""

import re
from pathlib import Path
from typing import Any

import pytest

from nullpose import Scenario, load
from nullpose.physics import min_sinr, to_db
from nullpose.solver import Result, solve

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "antennas.md").read_text(encoding="utf-8")
SCHEMES = ("optimum", "zero-interference", "maximum-gain", "vertical")
ANTENNAS: dict[str, tuple[str, str]] = {
    "the paper's": ("isotropic", "isotropic"),
    "all circular": ("circular", "circular"),
    "whips, jammer isotropic": ("dipole", "isotropic"),
    "all whips": ("dipole", "dipole"),
}


def scene(
    ratio: float, nodes: str = "isotropic", jammer: str = "isotropic", depth_db: float | None = None
) -> Scenario:
    """Returns the paper's scene with other antennas."""
    data: dict[str, Any] = load(ROOT / "examples" / "paper.toml").to_dict()
    data["nodes"] = [node | {"antenna": nodes} for node in data["nodes"]]
    data["jammers"] = [data["jammers"][0] | {"power_w": ratio, "antenna": jammer}]
    return Scenario.from_dict(data if depth_db is None else data | {"antenna": {"null_depth_db": depth_db}})


def certified(scenario: Scenario, scheme: str = "optimum", gap: float = 1e-4) -> Result:
    """Returns a solution, which must be certified."""
    solution = solve(scenario, scheme, gap=gap)
    assert solution.status == "certified"
    return solution


def rows(after: str) -> list[list[str]]:
    """Returns the cells of the first table after some words, its heading left out."""
    lines = re.findall(r"^\|(.*)\|$", PAGE.split(after)[1].split("\n\n- ")[0], flags=re.MULTILINE)
    table = [[cell.strip() for cell in line.split("|")] for line in lines]
    return [row for row in table if re.match(r"[\d.]+$|perfect", row[0])]


@pytest.mark.parametrize("row", rows("## The paper's scene with other antennas"), ids=" ".join)
def test_the_cases_have_these_values(row: list[str]) -> None:
    """Every case with every antenna, and the paper's best pose flown with it."""
    ratio = float(row[0])
    scenario = scene(ratio, *ANTENNAS[row[1]])
    flown = min_sinr(scenario, certified(scene(ratio), gap=1e-6).pose)
    assert float(row[2]) == pytest.approx(float(to_db(flown)), abs=0.0051)
    for cell, scheme in zip(row[3:], SCHEMES, strict=True):
        assert float(cell) == pytest.approx(certified(scenario, scheme).objective.value_db, abs=0.00051)


@pytest.mark.parametrize("row", rows("## How deep does a null have to be?")[:11], ids=" ".join)
def test_the_null_has_these_values(row: list[str]) -> None:
    """The optimum by depth and jamming, then by how much it is above zero interference."""
    depth_db = None if row[0] == "perfect" else float(row[0])
    of_values = any(float(cell) < -0.1 or float(cell) > 0.1 for cell in row[1:])
    for cell, ratio in zip(row[1:], (10.0, 100.0, 1000.0), strict=True):
        scenario = scene(ratio, depth_db=depth_db)
        number = certified(scenario, gap=1e-6).objective.value_db
        if not of_values:
            number -= certified(scenario, "zero-interference", gap=1e-6).objective.value_db
        assert float(cell) == pytest.approx(number, abs=0.00052)
