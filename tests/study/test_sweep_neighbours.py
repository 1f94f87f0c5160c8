"""Points of a sweep that bound each other give what single solves give."""

import math

import pytest

from nullpose import Scenario, apply_overrides, certificate_of, load, solve, sweep, verify
from nullpose.study.sweep import freedom

FIELD = load("examples/airframe.toml")
TILT = "airframe.tilt_max_deg"


def test_tilt_limits_nest() -> None:
    """Every row is certified, has an allowed pose, and is what a solve of its own finds."""
    table = sweep(FIELD, TILT, [0.0, 20.0, 40.0, 60.0, 80.0, 90.0], schemes=["optimum"], gap=1e-4)
    values = [row.objective.value for row in table.rows]
    assert values == sorted(values)
    for row in table.rows:
        alone = solve(apply_overrides(FIELD, [f"{TILT}={row.value}"]), gap=1e-4)
        assert row.status == "certified"
        assert row.pose.tilt_rad <= math.radians(row.value) + 1e-9
        assert row.objective.relative_gap <= 1e-4
        assert row.objective.value == pytest.approx(alone.objective.value, rel=1e-4)
        assert row.objective.upper_bound >= alone.objective.value
    assert any(row.stats.boxes == 0 for row in table.rows)


@pytest.mark.parametrize(("name", "path"), [("airframe", TILT), ("paper", "jammers.M.power_w")])
def test_a_bound_taken_from_another_point_has_a_certificate(name: str, path: str) -> None:
    """The proof of the freer point holds at this one: its rigour is the same, and the verifier agrees."""
    table = sweep(load(f"examples/{name}.toml"), path, [2.0, 60.0, 90.0], gap=1e-3)
    taken = [row for row in table.rows if row.stats.boxes == 0]
    assert taken
    for row in taken:
        assert row.rigour == "verifiable"
        assert verify(certificate_of(row)).proved


@pytest.mark.parametrize(
    ("path", "name", "wanted"),
    [
        (TILT, "airframe", 1.0),
        ("jammers.M.power_w", "paper", -1.0),
        ("jammers[0].power_dbm", "paper", -1.0),
        ("receiver.noise_dbm", "paper", -1.0),
        ("jammers.M.position_m[0]", "paper", 0.0),
        ("jammers[0].power_dbm", "eavesdropper", 0.0),
        (TILT, "eavesdropper", 1.0),
        (TILT, "array", 0.0),
    ],
)
def test_where_the_direction_is_known(path: str, name: str, wanted: float) -> None:
    """Less jamming helps every pose, but an eavesdropper too; positions have no direction."""
    scenario: Scenario = load(f"examples/{name}.toml")
    assert freedom(path, scenario) == wanted
