"""The page on the paper's claims: each checked on a coarse sweep, and the page says what was found."""

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest
from claims.claim import Claim
from claims.claims import CLAIMS
from claims.page import check_claims, claims_page
from claims.study import JammingStudy, at_least
from hypothesis import given, strategies as st

from nullpose import Scenario
from nullpose.paper.reproduce import Reproduction
from nullpose.paper.scene import JAMMER_POWER, paper_scenario
from nullpose.physics import maximum_gain_sinr
from nullpose.report.certainty import Certainty
from nullpose.scenario import Override, apply_overrides
from nullpose.solver import Objective
from nullpose.study import SweepTable

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


def levels_of(claim: Claim) -> dict[float, dict[str, object]]:
    """Returns a claim's evidence by P_M/P."""
    return {row["jamming_to_transmission_ratio"]: row for row in claim.evidence["levels"]}


def test_verdicts(claims: dict[str, Claim]) -> None:
    """Every claim is there, and equidistance alone fails."""
    assert {name: claim.verdict for name, claim in claims.items()} == VERDICTS


def test_every_claim_says_how_and_with_what_numbers(claims: dict[str, Claim]) -> None:
    """Each has a method, a finding with a number, and evidence."""
    for claim in claims.values():
        assert claim.method
        assert any(character.isdigit() for character in claim.finding)
        assert claim.evidence


def test_weak_jamming(claims: dict[str, Claim]) -> None:
    """Maximum gain is the optimum to 1e-4 dB at 1e-3, and drifts off by 0.08 dB at 0.1."""
    claim = claims["weak-jamming-maximum-gain"]
    assert levels_of(claim)[1e-3]["shortfall_db"] < 1e-4
    assert levels_of(claim)[0.1]["shortfall_db"] == pytest.approx(1.4002125 - 1.3216, abs=1e-4)
    assert claim.holds_up_to == pytest.approx(0.0307, abs=1e-4)


def test_strong_jamming(claims: dict[str, Claim]) -> None:
    """Zero interference is within 0.01 dB of the optimum from about 21 on."""
    claim = claims["strong-jamming-zero-interference"]
    assert levels_of(claim)[1000.0]["shortfall_db"] == pytest.approx(0.8125706 - 0.8123549, abs=2e-7)
    assert claim.holds_from == pytest.approx(21.3, abs=0.1)


def test_equidistance_fails(claims: dict[str, Claim]) -> None:
    """It fails from P_M/P = 1.14; at 3 the numbers are those of the errata."""
    claim = claims["maximum-gain-equidistant"]
    assert claim.fails_from == pytest.approx(1.141, abs=5e-4)
    three = levels_of(claim)[3.0]
    assert three["best_db"] == pytest.approx(-1.057, abs=5e-4)
    assert three["best_equidistant_db"] == pytest.approx(-3.317, abs=5e-4)
    assert three["distances_m"] == pytest.approx([17.6, 35.5], abs=0.05)
    assert claim.evidence["as_printed"]["largest_distance_difference_m"] < 1e-3


@pytest.mark.parametrize(("level", "equidistant_is_best"), [(1.13, True), (1.15, False)])
def test_the_level_where_equidistance_fails_by_a_plain_grid(level: float, equidistant_is_best: bool) -> None:
    """Below the level a grid at the lowest altitude is best at y = 25 m, above it near y = 16.5 m."""
    east, north = np.meshgrid(np.linspace(-4.0, 6.0, 201), np.linspace(0.0, 50.0, 501), indexing="ij")
    positions = np.stack([east, north, np.full_like(east, 8.0)], axis=-1)
    smallest = maximum_gain_sinr(with_jamming(level), positions).min(axis=-1)
    best_north = north.flat[int(np.argmax(smallest))]
    assert best_north == pytest.approx(25.0 if equidistant_is_best else 16.55, abs=0.15)


def test_vertical_ends_above_the_jammer(claims: dict[str, Claim]) -> None:
    """It jumps there at about 0.8, and stays."""
    claim = claims["vertical-above-jammer"]
    assert claim.holds_from == pytest.approx(0.797, abs=0.005)
    assert levels_of(claim)[1e6]["horizontal_distance_m"] < 1e-6


def test_maximum_gain_points_its_null(claims: dict[str, Claim]) -> None:
    """The angle falls as the jamming grows, below a degree from about 5.7 on."""
    claim = claims["maximum-gain-null-at-jammer"]
    angles = [row["angle_between_null_and_jammer_deg"] for row in levels_of(claim).values()]
    assert angles[-1] < 1e-4
    assert claim.holds_from == pytest.approx(5.74, abs=0.02)


def test_pose_optimisation_wins(claims: dict[str, Claim]) -> None:
    """The lead is 0.43 dB under weak and 2.97 dB under strong jamming."""
    evidence = claims["pose-optimisation-wins"].evidence
    assert evidence["lead_at_weakest_db"] == pytest.approx(1.6147507 - 1.1842, abs=1e-4)
    assert evidence["lead_at_strongest_db"] == pytest.approx(0.81236 + 2.1609, abs=1e-3)
    assert evidence["zero_interference_ahead_from"] == pytest.approx(0.0427, abs=2e-4)


def test_saturation(claims: dict[str, Claim]) -> None:
    """The four curves are flat at the end; eq. 3.5 as printed falls by 10 dB a decade."""
    evidence = claims["saturation-of-all-solutions"].evidence
    for scheme in ("optimum", "zero-interference", "maximum-gain", "vertical"):
        assert abs(evidence[scheme]["change_over_last_decade_db"]) < 1e-4
    assert evidence["as_printed"]["change_over_last_decade_db"] == pytest.approx(-10.0, abs=1e-3)


def test_a_claim_that_the_data_refute_fails(reproduction: Reproduction) -> None:
    """Were maximum gain 0.2 dB worse everywhere, the claim on weak jamming would fail."""
    worse = [
        dataclasses.replace(
            row,
            objective=Objective(
                name="min_sinr", value=row.min_sinr / 10**0.02, value_db=row.min_sinr_db - 0.2
            ),
        )
        if row.scheme == "maximum-gain"
        else row
        for row in reproduction.table.rows
    ]
    table = SweepTable(reproduction.table.path, tuple(worse))
    study = JammingStudy(dataclasses.replace(reproduction, table=table))
    claim = CLAIMS[0].checked(study)
    assert claim.verdict == "fails"
    assert claim.holds_up_to is None


def test_thresholds_are_bisected(reproduction: Reproduction) -> None:
    """A condition that flips between two swept levels is dated to four digits, from either side."""
    study = JammingStudy(reproduction)
    assert study.holds_up_to(lambda level: level <= 2.5) == pytest.approx(2.5, rel=1e-3)
    assert study.holds_from(lambda level: level >= 2.5) == pytest.approx(2.5, rel=1e-3)
    assert study.holds_up_to(lambda level: False) is None
    assert study.holds_from(lambda level: False) is None
    assert study.holds_up_to(lambda level: True) == study.levels[-1]
    assert study.holds_from(lambda level: True) == study.levels[0]


def test_a_page_has_finite_numbers(reproduction: Reproduction, claims: dict[str, Claim]) -> None:
    """A page names every claim and verdict, and holds no number that is not finite."""
    page = claims_page(reproduction, tuple(claims.values()))
    for claim in claims.values():
        assert f"## {claim.claim}" in page
        assert f"`{claim.id}`" in page
    assert page.count("**fails**") == 1
    assert not re.search(r"\bnan\b|\binf\b", page)


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


def test_every_claim_says_what_is_proved_and_what_is_not(claims: dict[str, Claim]) -> None:
    """All values of the four cases behind each claim are certified, and what is open is named."""
    for claim in claims.values():
        assert claim.is_certified
        assert claim.certainty.largest_relative_gap <= 1e-6
        assert claim.proved_words == claim.proved
        assert claim.unproved
    for bisected in ("weak-jamming-maximum-gain", "maximum-gain-equidistant", "pose-optimisation-wins"):
        assert "bisection" in claims[bisected].unproved
    for placed in ("maximum-gain-null-at-jammer", "vertical-above-jammer"):
        assert "on the value and not on the place" in claims[placed].unproved
    for printed in ("maximum-gain-equidistant", "saturation-of-all-solutions"):
        assert "eq. 3.5 as printed, which is searched and not bounded" in claims[printed].unproved


def test_nothing_is_called_proved_if_a_value_is_not_certified(claims: dict[str, Claim]) -> None:
    """One value that is only found takes the proof away, in words and in the data."""
    claim = claims["weak-jamming-maximum-gain"]
    searched = dataclasses.replace(claim.certainty, certified=1, best_found=1)
    doubtful = dataclasses.replace(claim, certainty=searched)
    assert doubtful.proved_words.startswith("Nothing")
    assert dataclasses.replace(claim, certainty=Certainty.of(())).proved_words.startswith("Nothing")


def test_bounds_of_the_leads(claims: dict[str, Claim], reproduction: Reproduction) -> None:
    """What is proved of a lead encloses the lead found, as closely as the gaps allow."""
    study = JammingStudy(reproduction)
    for level in (1e-3, 1.0, 1e6):
        lead = study.lead("optimum", "vertical", level)
        assert lead.least_db <= lead.found_db <= lead.most_db
        assert lead.most_db - lead.least_db < 1e-5
    assert "at most 4.6e-6 dB at P_M/P = 1e+06" in claims["strong-jamming-zero-interference"].proved


def test_the_best_equidistant_position_is_proved(reproduction: Reproduction) -> None:
    """Solved in an airspace as thin as the plane it is certified, and what a fine grid finds there."""
    study = JammingStudy(reproduction)
    east, up = np.meshgrid(np.linspace(-20.0, 20.0, 801), np.linspace(8.0, 12.0, 41), indexing="ij")
    plane = np.stack([east, np.full_like(east, 25.0), up], axis=-1)
    for level in (0.1, 3.0, 1e3):
        row = study.equidistant_at("maximum-gain", level)
        values = maximum_gain_sinr(with_jamming(level), plane).min(axis=-1)
        assert row.status == "certified"
        assert values.max() <= row.objective.upper_bound
        assert row.min_sinr == pytest.approx(values.max(), rel=1e-3)
        best_m = plane.reshape(-1, 3)[np.argmax(values)]
        assert row.pose.position_m == pytest.approx(best_m, abs=0.1)


def test_a_study_notes_what_is_looked_at(reproduction: Reproduction) -> None:
    """Rows looked at are noted once, whether swept or solved for the purpose."""
    study = JammingStudy(reproduction)
    study.lead("optimum", "vertical", 1.0)
    study.at("optimum", 1.0)
    assert [row.scheme for row in study.used.values()] == ["optimum", "vertical"]
    study.used.clear()
    assert len(study.curve("vertical")) == len(study.used) == len(reproduction.table.of("vertical"))


@given(number=st.floats(-1e12, 1e12).filter(lambda x: x == 0.0 or abs(x) > 1e-12), digits=st.integers(1, 6))
def test_what_is_proved_at_least_is_rounded_down(number: float, digits: int) -> None:
    """What is at least a number is never stated as more."""
    assert float(at_least(number, digits)) <= number + 1e-8 * abs(number)
