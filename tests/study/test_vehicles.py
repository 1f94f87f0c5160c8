"""Airframes compared: known values, the order among vehicles, guarantees, and what suffices."""

import csv
import itertools
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from sizes import and_slow

from nullpose import ResultTable, Scenario, Status, compare_airframes, load, min_sinr, solve
from nullpose.files import json_text
from nullpose.scenario import apply_overrides
from nullpose.study import AIRFRAME_CASES
from nullpose.study.vehicles import (
    Sufficiency,
    least_sufficient,
    verdict_on,
    verdicts,
)

ROOT = Path(__file__).parents[2]
KNOWN = ROOT / "tests" / "reference" / "airframes" / "known_answers.csv"
TILTS = ("level-horizontal", "tilt-10-horizontal", "tilt-30-horizontal", "omnidirectional")


def known() -> list[dict[str, float]]:
    """Returns the known values, a row for each jamming power."""
    with KNOWN.open(encoding="utf-8", newline="") as file:
        _, *rows = csv.DictReader(file)  # below the names stand the units
    return [{name: float(text) for name, text in row.items()} for row in rows]


@pytest.fixture(scope="module")
def robust() -> ResultTable:
    """The example with errors, dipoles only."""
    return compare_airframes(load(ROOT / "examples" / "robust.toml"), cases=AIRFRAME_CASES)


@pytest.mark.parametrize("row", known(), ids=lambda row: f"{row['jamming_ratio']:g}")
def test_known_answers(paper: Scenario, row: dict[str, float]) -> None:
    """Each vehicle reaches what independent searches found, certified to 1e-6."""
    level = row["jamming_ratio"]
    varied = apply_overrides(paper, [f"jammers.M.power_w={level}"])
    found = compare_airframes(varied, cases=AIRFRAME_CASES, gap=1e-6)
    for result in found.rows:
        assert result.status is Status.CERTIFIED
        assert result.objective.value <= result.objective.upper_bound <= result.objective.value * (1.0 + 1e-6)
        if result.name in row:
            assert result.objective.value == pytest.approx(row[result.name], abs=1e-4)


def test_more_tilt_is_never_worse(paper: Scenario) -> None:
    """A vehicle that reaches more axes gives at least as much, and its pose keeps to its limit."""
    found = compare_airframes(paper, cases=AIRFRAME_CASES)
    for less, more in itertools.pairwise(TILTS):
        assert found.of(less)[0].objective.value <= found.of(more)[0].objective.upper_bound
    for result in found.rows:
        assert result.pose.tilt_rad <= result.case.airframe.tilt_max_rad + 1e-9
        assert min_sinr(paper, result.pose) == pytest.approx(result.objective.value, rel=1e-12)


def test_solve_and_compare_report_the_same_attitude(paper: Scenario) -> None:
    """The omnidirectional vehicle compared has the pose of a solve without an airframe, digit by digit."""
    (whole,) = compare_airframes(paper, cases=AIRFRAME_CASES[-1:]).rows
    assert whole.pose == solve(paper).pose


def test_the_least_vehicle_that_suffices(paper: Scenario) -> None:
    """Ten degrees are enough at a ratio of 1, level is enough where jamming is weak."""
    found = compare_airframes(paper, cases=AIRFRAME_CASES)
    assert least_sufficient(found).name == "tilt-10-horizontal"
    weak = compare_airframes(apply_overrides(paper, ["jammers.M.power_w=0.01"]), cases=AIRFRAME_CASES)
    assert least_sufficient(weak).name == "level-horizontal"
    assert verdict_on(found, found.of("omnidirectional")[0]) is Sufficiency.SUFFICES
    (level,) = found.of("level-vertical")
    assert verdict_on(found, level) is Sufficiency.FALLS_SHORT
    assert verdict_on(found, level, tolerance=0.6) is Sufficiency.SUFFICES


def test_an_upright_dipole_can_need_the_least_tilt() -> None:
    """With whips on the ground the dipole has to stand: with it flat no tilt compared suffices."""
    found = compare_airframes(load(ROOT / "examples" / "whips.toml"), cases=AIRFRAME_CASES)
    assert least_sufficient(found).name == "tilt-30-vertical"
    assert verdict_on(found, found.of("tilt-30-horizontal")[0]) is Sufficiency.FALLS_SHORT


@pytest.mark.parametrize("name", and_slow(["whips"], ["paper", "eavesdropper"]))
def test_the_best_mount_leaves_nothing_to_tilt_for(name: str) -> None:
    """At each tilt it reaches what the omnidirectional vehicle does; its poses keep to mount and tilt."""
    found = compare_airframes(load(ROOT / "examples" / f"{name}.toml"))
    (whole,) = found.of("omnidirectional")
    for level in ("level", "tilt-10", "tilt-20", "tilt-30"):
        (row,) = found.of(f"{level}-best")
        assert verdict_on(found, row) is Sufficiency.SUFFICES
        assert row.label == f"{level.replace('-', ' ')}, best ({row.case.airframe.mount_deg:.4g}°)"
        assert row.pose.tilt_rad <= row.case.airframe.tilt_max_rad + 1e-9
        assert row.pose.mount_rad == row.case.airframe.mount_rad
    assert row.objective.value == pytest.approx(whole.objective.value, rel=1e-9)


def test_proofs_are_as_near_as_the_verdict_needs(paper: Scenario) -> None:
    """Every bound holds for the vehicle, none exceeds the omnidirectional one, and few boxes tell."""
    near, quick = (
        compare_airframes(paper, cases=AIRFRAME_CASES, **options)
        for options in ({"gap": 1e-6}, dict[str, float]())
    )
    for row in near.rows:
        (wide,) = quick.of(row.name)
        assert wide.objective.value == pytest.approx(row.objective.value, rel=1e-5)
        assert row.objective.value <= wide.objective.upper_bound
        assert wide.objective.upper_bound <= quick.of("omnidirectional")[0].objective.upper_bound
        assert verdict_on(near, row) is verdict_on(quick, wide) is not Sufficiency.NOT_PROVED
    boxes = [sum(row.stats.boxes for row in table.rows) for table in (near, quick)]
    assert boxes[1] < 0.5 * boxes[0]


def test_a_verdict_is_proved_or_left_open(paper: Scenario) -> None:
    """A vehicle suffices by its value against the other's bound, falls short by its bound, or neither."""
    found = compare_airframes(paper, cases=AIRFRAME_CASES)
    (row,), (whole,) = found.of("tilt-10-horizontal"), found.of("omnidirectional")

    def verdict(value: float, bound: float | None, ceiling: float | None) -> Sufficiency:
        bounded = replace(whole, objective=replace(whole.objective, value=1.0, upper_bound=ceiling))
        table = replace(found, rows=(row, bounded))
        return verdict_on(
            table, replace(row, objective=replace(row.objective, value=value, upper_bound=bound))
        )

    assert verdict(0.995, 0.996, 1.001) is Sufficiency.SUFFICES
    assert verdict(0.985, 0.988, 1.001) is Sufficiency.FALLS_SHORT
    for value, bound, ceiling in [
        (0.985, 0.995, 1.001),
        (0.995, 0.996, 1.2),
        (0.5, None, None),
        (1.0, 1.0, None),
    ]:
        assert verdict(value, bound, ceiling) is Sufficiency.NOT_PROVED


def test_arrays_are_tried_on_a_level_vehicle(paper: Scenario) -> None:
    """More elements give more, and none exceeds its bound."""
    found = compare_airframes(paper, gap=0.1)
    sizes = [found.of(f"array-{size}-digital")[0] for size in (2, 4, 8)]
    assert [row for row in found.rows if row.case.array] == sizes
    assert [one.objective.value for one in sizes] == sorted(one.objective.value for one in sizes)
    assert all(one.objective.value <= one.objective.upper_bound for one in sizes)
    assert all(one.pose.tilt_rad == 0.0 for one in sizes)
    assert least_sufficient(found).case.array is None


def test_guarantees_hold_what_they_say(robust: ResultTable) -> None:
    """The robust pose guarantees no less than the nominal one, and no more than the bound or the value."""
    for result in robust.rows:
        one = result.guaranteed
        assert 0.0 <= one.nominal_pose <= one.robust_pose <= one.upper_bound
        assert one.robust_pose <= result.objective.upper_bound
        assert one.upper_bound <= one.robust_pose * 1.0101


def test_a_guarantee_is_below_random_errors(robust: ResultTable) -> None:
    """With axis and jammer moved at random within the stated errors, no value falls below the guarantee."""
    rng = np.random.default_rng(4)
    result = robust.of("tilt-10-horizontal")[0]
    scenario, pose = robust.scenario, result.pose
    place, axis = np.array(scenario.jammer_positions_m[0]), pose.antenna_axis
    worst = np.inf
    for _ in range(200):
        away = rng.normal(size=3)
        moved = place + 3.0 * away / np.linalg.norm(away)
        across = np.cross(axis, rng.normal(size=3))
        leaning = axis + np.tan(np.radians(2.0)) * across / np.linalg.norm(across)
        data = scenario.to_dict()
        data["jammers"][0] |= {"position_m": moved.tolist(), "uncertainty_m": 0.0}
        off = type(pose).from_axis(pose.position_m, leaning)
        worst = min(worst, min_sinr(Scenario.from_dict(data), off))
    assert worst >= result.guaranteed.nominal_pose
    assert worst < result.objective.value


def test_no_errors_nothing_guaranteed(paper: Scenario) -> None:
    """Without errors in the file there is no guaranteed value; each vehicle is one step."""
    ticks: list[tuple[int, int]] = []
    found = compare_airframes(
        paper, cases=AIRFRAME_CASES, certify=False, on_progress=lambda *tick: ticks.append(tick)
    )
    assert ticks == [(done, len(AIRFRAME_CASES)) for done in range(1, len(AIRFRAME_CASES) + 1)]
    assert least_sufficient(found) is None
    assert {result.guaranteed for result in found.rows} == {None}
    assert {result.status for result in found.rows} == {Status.BEST_FOUND}
    assert {result.objective.upper_bound for result in found.rows} == {None}


def test_rates_are_compared_as_rates() -> None:
    """With an eavesdropper rates are compared, and more tilt is never worse."""
    found = compare_airframes(load(ROOT / "examples" / "eavesdropper.toml"))
    assert not any(row.case.array for row in found.rows)
    assert {result.objective.name for result in found.rows} == {"min_secrecy_rate"}
    rates = [found.of(name)[0].objective.value for name in TILTS]
    assert all(less <= more + 1e-6 for less, more in itertools.pairwise(rates))


def test_plain_data(robust: ResultTable) -> None:
    """The table as plain data is JSON, and says what the objects say."""
    data = json.loads(json_text(robust.to_dict() | verdicts(robust)))
    assert [row["case"] for row in data["rows"]] == [case.name for case in AIRFRAME_CASES]
    assert data["least_sufficient"] == least_sufficient(robust).name
    (row,) = (row for row in data["rows"] if row["case"] == "tilt-10-horizontal")
    assert row["airframe"] == {"tilt_max_deg": 10.0, "mount_deg": 90.0}
    assert row["guaranteed"]["robust_pose"] == robust.of("tilt-10-horizontal")[0].guaranteed.robust_pose
    assert data["difference_from_omnidirectional"]["tilt-10-horizontal"] == pytest.approx(-0.032, abs=1e-3)
    assert data["suffices"]["level-vertical"] == "no"
    assert data["suffices"]["tilt-10-horizontal"] == "yes"
