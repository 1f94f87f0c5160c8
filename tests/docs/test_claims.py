"""The page on the paper's claims: each checked on a coarse sweep, and the page says what was found."""

import re
from pathlib import Path

import numpy as np
import pytest
from claims.claim import Claim
from claims.page import check_claims, claims_page
from paper_schemes import maximum_gain_sinr

from nullpose import Scenario
from nullpose.paper import JAMMER_POWER, Reproduction, paper_scenario
from nullpose.scenario import Override, apply_overrides

PAGE = (Path(__file__).parents[2] / "docs" / "claims.md").read_text(encoding="utf-8")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")

VERDICTS = {
    "weak-jamming-maximum-gain": "holds",
    "strong-jamming-zero-interference": "holds",
    "zero-interference-constant": "holds",
    "maximum-gain-null-at-jammer": "holds",
    "vertical-above-jammer": "holds",
    "maximum-gain-equidistant": "fails",
    "pose-optimisation-wins": "holds",
    "saturation-of-all-solutions": "holds",
}


def with_jamming(level: float) -> Scenario:
    """Returns the paper's scenario with its jammer's power set."""
    return apply_overrides(paper_scenario(), [Override(JAMMER_POWER, level)])


@pytest.fixture(scope="module")
def claims(reproduction: Reproduction) -> dict[str, Claim]:
    """The claims by id."""
    return {claim.id: claim for claim in check_claims(reproduction)}


def test_verdicts(claims: dict[str, Claim]) -> None:
    """Every claim is there, and equidistance alone fails."""
    assert {name: claim.verdict for name, claim in claims.items()} == VERDICTS


@pytest.mark.parametrize(("level", "equidistant_is_best"), [(1.13, True), (1.15, False)])
def test_the_level_where_equidistance_fails_by_a_plain_grid(level: float, equidistant_is_best: bool) -> None:
    """Below the level a grid at the lowest altitude is best at y = 25 m, above it near y = 16.5 m."""
    east, north = np.meshgrid(np.linspace(-4.0, 6.0, 201), np.linspace(0.0, 50.0, 501), indexing="ij")
    positions = np.stack([east, north, np.full_like(east, 8.0)], axis=-1)
    smallest = maximum_gain_sinr(with_jamming(level), positions).min(axis=-1)
    best_north = north.flat[int(np.argmax(smallest))]
    assert best_north == pytest.approx(25.0 if equidistant_is_best else 16.55, abs=0.15)


def test_the_page_is_what_the_script_writes(reproduction: Reproduction, claims: dict[str, Claim]) -> None:
    """The page has the words that are written now, and, where the levels are the same, the numbers."""
    page = claims_page(reproduction, tuple(claims.values()))
    assert NUMBER.sub("#", PAGE) == NUMBER.sub("#", page)
    compared = 0
    for line, now in zip(PAGE.splitlines(), page.splitlines(), strict=True):
        numbers, numbers_now = ([float(number) for number in NUMBER.findall(text)] for text in (line, now))
        if line.startswith("| ") and (not line[2].isdigit() or numbers[0] == numbers_now[0]):
            assert numbers == pytest.approx(numbers_now, rel=0.05, abs=1e-6)
            compared += len(numbers)
    assert compared > 200
