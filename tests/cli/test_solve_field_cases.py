"""Inputs as they come from the field give the right value, or are refused by name (see their README)."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scenes import Run

CASES = Path(__file__).parents[1] / "reference" / "field_cases"
SQUARE_M = 85.0  # half the side of the square of inclusive.geojson, with the margin


@pytest.fixture
def solution(run: Run) -> Callable[..., dict[str, Any]]:
    """Solves a file; returns what ``--json`` prints, with all notes and warnings under ``words``."""

    def solve(name: str, *options: str) -> dict[str, Any]:
        result = run("solve", CASES / name, *options, "--json")
        assert result.exit_code == 0, result.output
        return json.loads(result.stdout) | {"words": f"{result.stderr} {result.stdout}"}

    return solve


Solve = Callable[..., dict[str, Any]]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("crs-3857.toml", ["got urn:ogc:def:crs:EPSG::3857"]),
        ("ed269-list.toml", ["ED-269"]),
        ("no-zone.toml", ["no_fly_from"]),
        ("shp-dbf.toml", ["shp-dbf", "records"]),
        ("shp-truncated.toml", ["shp-truncated", "shp"]),
        ("omni-8dbi.toml", ["nodes[0].gain_dbi", "1.76", "profile"]),
        ("keys.toml", ["0.3048", "log10", "power_dbm"]),
    ],
)
def test_files_that_are_refused(run: Run, name: str, words: list[str]) -> None:
    """By the path of the fault and with the way out, as a mistake of the user's."""
    result = run("check", CASES / name)
    assert result.exit_code == 2
    assert [word for word in words if word not in result.stderr] == []


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("coarse-helix.out", ["too coarse", "20"]),
        ("elevation.csv", ["elevations", "-90", "90 less"]),
    ],
)
def test_antenna_files_that_are_refused(run: Run, name: str, words: list[str]) -> None:
    """With what the file is, and what to do."""
    result = run("antenna", CASES / name)
    assert result.exit_code == 2
    assert [word for word in words if word not in result.stderr] == []


@pytest.mark.parametrize("name", ["underground.toml", "underground-overture.toml"])
def test_buildings_below_ground_hide_nobody(solution: Solve, name: str) -> None:
    """The value is that without buildings, and the account counts what is left out."""
    free, found = solution("no-building.toml", "--gap", "1e-2"), solution(name, "--gap", "1e-2")
    assert found["objective"]["value_db"] == pytest.approx(free["objective"]["value_db"], abs=0.05)
    assert found["objective"]["value_db"] == pytest.approx(3.06, abs=0.05)


def test_heights_that_state_none(run: Run) -> None:
    """-1 and 0 are no heights; the two buildings get the heights of missing_height_m and are counted."""
    result = run("check", CASES / "height-minus-one.toml")
    assert result.exit_code == 0, result.output
    assert "2 assumed" in result.output


@pytest.mark.parametrize("name", ["inclusive.toml", "no-restriction.toml"])
def test_permissions_are_no_bans(run: Run, name: str) -> None:
    """An area where flying is allowed is refused by name, or left out so that the drone may be in it."""
    result = run("solve", CASES / name, "--fast", "--json")
    if result.exit_code == 0:
        assert abs(json.loads(result.stdout)["pose"]["position_m"][0]) < SQUARE_M
    else:
        assert result.exit_code == 2
        assert "no_fly_from" in result.stderr


@pytest.mark.parametrize(
    ("name", "ceiling_m"), [("fence-ceiling.toml", 40.0), ("fence-flight-level.toml", 119.8)]
)
def test_a_fence_has_its_ceiling(run: Run, name: str, ceiling_m: float) -> None:
    """The drone keeps below it, or the fence is refused with the word that is not read."""
    result = run("solve", CASES / name, "--fast", "--json")
    if result.exit_code == 0:
        assert json.loads(result.stdout)["pose"]["position_m"][2] <= ceiling_m
    else:
        assert result.exit_code == 2
        assert "geofence_from" in result.stderr


def test_a_round_fence(run: Run) -> None:
    """The drone keeps within its circle of 100 m, or the message says that round fences are not read."""
    result = run("solve", CASES / "circle-fence.toml", "--fast", "--json")
    if result.exit_code == 0:
        assert math.hypot(*json.loads(result.stdout)["pose"]["position_m"][:2]) <= 100.0
    else:
        assert result.exit_code == 2
        assert "round" in result.stderr


def test_home_and_waypoint_are_over_one_datum(solution: Solve, tmp_path: Path) -> None:
    """In a plan both altitudes are over the sea: home lies on the ground at the origin."""
    plan = tmp_path / "x.plan"
    found = solution("plan-home.toml", "--fast", "--export", str(plan))
    mission = json.loads(plan.read_text())["mission"]
    assert mission["plannedHomePosition"][2] == pytest.approx(185.0)
    assert mission["items"][-1]["Altitude"] == pytest.approx(185.0 + found["pose"]["position_m"][2], abs=0.01)


def test_a_noise_density_in_place_of_noise(run: Run) -> None:
    """Noise below that of 1 kHz is warned of."""
    result = run("check", CASES / "noise-density.toml")
    assert "-174" in result.output + result.stderr
    assert "thermal" in result.output + result.stderr


def test_sight_that_is_improbable(solution: Solve) -> None:
    """Value and bound are those of the paper's scene, and the bound is not below the value."""
    objective = solution("sight-cancels.toml")["objective"]
    assert objective["value"] == pytest.approx(1.2542092, rel=2e-6)
    assert 1.2542092 <= objective["upper_bound"] * (1.0 + 1e-8) <= 1.2542092 * (1.0 + 3e-6)


@pytest.mark.parametrize(
    ("name", "least", "tilts_deg"),
    [("narrow-2573.toml", 3.1940, [0, 1e-3]), ("narrow-20110.toml", 0.03502, [0, 1e-4, 1e-3, 1e-2])],
)
def test_more_tilt_gives_no_less(solution: Solve, name: str, least: float, tilts_deg: list[float]) -> None:
    """The poses of a narrow band hold those of a level vehicle."""
    for tilt_deg in tilts_deg:
        found = solution(name, "--fast", "--set", f"airframe.tilt_max_deg={tilt_deg}")
        assert found["objective"]["value"] >= least * (1.0 - 2e-4)


def test_an_array_of_one_element(solution: Solve) -> None:
    """It is the vertical case of the same scene."""
    vertical = solution("lost-6014-vertical.toml", "--scheme", "vertical")["objective"]["value_db"]
    assert vertical == pytest.approx(-19.0014, abs=1e-3)
    assert solution("lost-6014.toml")["objective"]["value_db"] >= vertical - 1e-3


def test_all_errors_together(solution: Solve) -> None:
    """The table has no more than what errors of its sizes leave, as found by hand."""
    found = solution("sens-9198.toml", "--fast")
    value = found["sensitivity"]["all"]["value"]
    assert value <= 3.8533e-6 * (1.0 + 1e-3)


def test_parts_of_a_kml_file_have_their_own_heights(run: Run) -> None:
    """An area without altitudes counts at all of them, also beside one that has some."""
    result = run("solve", CASES / "kml-mixed.toml", "--fast", "--json")
    plain = run("solve", CASES / "kml-plain.toml", "--fast", "--json")
    if result.exit_code == 0:
        found, expected = (json.loads(each.stdout)["objective"]["value"] for each in (result, plain))
        assert found <= expected * (1.0 + 1e-6)
    else:
        assert "no_fly_from" in result.stderr


def test_corners_on_the_ground_are_no_slab(solution: Solve) -> None:
    """An area whose corners have the terrain's heights counts at all altitudes."""
    found = solution("kml-terrain.toml", "--fast")
    (zone,) = found["scenario"]["airspace"]["no_fly"]
    assert "altitude_m" not in zone
    assert np.isfinite(found["objective"]["value"])


def test_a_whip_at_a_jammer_that_hides_the_bound(run: Run, solution: Solve) -> None:
    """Where a limit ends the proof, the answer names the cause, the key that mends it, and --robust."""
    result = run("solve", CASES / "double-null.toml", "--node-limit", "2000")
    shown = result.stdout + result.stderr
    assert [word for word in ("jammers[1]: null_depth_db", "--robust") if word not in shown] == []
    mended = solution("double-null.toml", "--set", "jammers.hut.null_depth_db=20", "--gap", "1e-2")
    assert mended["status"] == "certified"
    assert mended["objective"]["value_db"] == pytest.approx(-6.54, abs=0.05)
