"""The map's best place is the drone's, with the value that is certified there."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

from nullpose.physics import objective_value, to_db
from nullpose.scenario import Airframe, Scenario, apply_overrides
from nullpose.solver import best_axis, solve
from nullpose.study import value_map


@pytest.mark.parametrize("ratio", [1.0, 100.0])
@pytest.mark.parametrize("scheme", ["vertical", "maximum-gain", "zero-interference", "optimum"])
def test_the_maps_best_is_the_certified_value(paper: Scenario, scheme: str, ratio: float) -> None:
    """On the paper's scene, within 1e-3 dB, and at the drone's position; no cell exceeds the bound."""
    result = solve(apply_overrides(paper, [f"jammers.M.power_w={ratio}"]), scheme)
    field = value_map(result)
    value, position_m = field.best
    assert value == pytest.approx(result.objective.value_db, abs=1e-3)
    assert value <= 10.0 * math.log10(result.objective.upper_bound)
    np.testing.assert_allclose(position_m, result.pose.position_m, atol=1e-9)


def test_a_vehicles_map_has_its_value(paper: Scenario) -> None:
    """So it is for a vehicle whose axes are sampled, since the drone's own axis is one of the samples."""
    scene = paper.model_copy(update={"airframe": Airframe(tilt_max_deg=30.0, mount_deg=90.0)})
    result = solve(scene, gap=1e-3)
    assert value_map(result).best[0] == pytest.approx(result.objective.value_db, abs=1e-3)


def test_another_altitude_is_worse_by_what_the_best_axes_say(paper: Scenario) -> None:
    """A plane above the drone has the value of the best axis at each of its points, all below the best."""
    result = solve(paper)
    field = value_map(result, altitude_m=20.0, cells=15)
    assert field.altitude_m == 20.0
    assert field.best[0] < result.objective.value_db
    place = np.array([field.east_m[3], field.north_m[5], 20.0])
    there = objective_value(paper, place, best_axis(paper, place).antenna_axis)
    assert field.values[5, 3] == pytest.approx(float(to_db(there)), abs=1e-9)


def test_the_table_has_a_line_for_each_point(paper: Scenario, tmp_path: Path) -> None:
    """With metres and decibels in the names of its columns; a place that is not allowed has an empty cell."""
    zone = "airspace.no_fly=[{centre_m = [10, 40], radius_m = 8}]"
    field = value_map(solve(apply_overrides(paper, [zone])), cells=12)
    rows = list(
        csv.DictReader(field.write_csv(tmp_path / "map.csv").read_text(encoding="utf-8").splitlines())
    )
    assert list(rows[0]) == ["x_m", "y_m", "z_m", "min_sinr_db"]
    assert len(rows) == field.values.size
    numbers = [math.nan if row["min_sinr_db"] == "" else float(row["min_sinr_db"]) for row in rows]
    np.testing.assert_array_equal(np.reshape(numbers, field.values.shape), field.values)
    assert 0 < sum(map(math.isnan, numbers)) < len(numbers)
    assert field.to_dict()["best"]["value"] == max(filter(math.isfinite, numbers))
