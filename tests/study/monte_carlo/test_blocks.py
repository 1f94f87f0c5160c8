"""Random blocks are those of ITU-R P.1410: so many, so large, so high, and none on a ground point."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import shapely
from hypothesis import given, strategies as st
from scipy import stats

from nullpose import ScenarioError
from nullpose.scenario import Scenario
from nullpose.study.monte_carlo import StudySpec, draw_scene, load_spec, scene_at
from nullpose.study.monte_carlo.chunk import rows_of

Spec = Callable[..., StudySpec]

FAR = {"x_m": [100.0, 400.0], "y_m": [100.0, 300.0]}  # where no point is drawn


def _shapes(scene: Scenario) -> list[Any]:
    return [shapely.Polygon(building.polygon_m) for building in scene.buildings]


@pytest.mark.parametrize(
    ("environment", "alpha", "per_km2", "gamma_m"),
    [
        ("suburban", 0.1, 750, 8.0),
        ("urban", 0.3, 500, 15.0),
        ("dense-urban", 0.5, 300, 20.0),
        ("high-rise", 0.5, 300, 50.0),
    ],
)
def test_an_environment_has_its_three_numbers(
    spec: Spec, environment: str, alpha: float, per_km2: float, gamma_m: float
) -> None:
    """The share of the ground, the number on it and the heights are those of the recommendation."""
    study = spec(scenes=10**6, buildings=FAR | {"environment": environment})
    scenes = [draw_scene(study, index) for index in range(30)]
    counts = np.array([len(scene.buildings) for scene in scenes])
    assert counts.mean() == pytest.approx(per_km2 * 0.06, rel=0.05)
    areas_m2 = np.array([shape.area for scene in scenes for shape in _shapes(scene)])
    assert areas_m2 == pytest.approx(1e6 * alpha / per_km2)
    heights_m = [building.heights_m[0] for scene in scenes for building in scene.buildings]
    assert stats.kstest(heights_m, stats.rayleigh(scale=gamma_m).cdf).pvalue > 0.01


def test_streets_have_one_width(spec: Spec) -> None:
    """From wall to wall 1000 / sqrt(beta) less the width of a block, as in P.1410."""
    keys = {"alpha": 0.25, "beta_per_km2": 400.0, "gamma_m": 10.0}
    shapes = _shapes(draw_scene(spec(buildings=FAR | keys), 0))
    nearest_m = [min(one.distance(other) for other in shapes if other is not one) for one in shapes]
    assert nearest_m == pytest.approx([50.0 - 25.0] * len(shapes))


def test_the_grid_lies_and_is_turned_at_random(spec: Spec) -> None:
    """The turn is uniform over a right angle, and no place is more often built on than another."""
    study = spec(scenes=10**6, buildings=FAR | {"environment": "urban"})
    turns, shares = [], []
    for index in range(100):
        shapes = _shapes(draw_scene(study, index))
        (x0, y0), (x1, y1) = shapes[0].exterior.coords[:2]
        turns.append(math.atan2(y1 - y0, x1 - x0) % (math.pi / 2.0) / (math.pi / 2.0))
        shares.append(any(shape.contains(shapely.Point(250.0, 200.0)) for shape in shapes))
    assert stats.kstest(turns, "uniform").pvalue > 0.01
    assert np.mean(shares) == pytest.approx(0.3, abs=0.1)


@given(index=st.integers(0, 10**6))
def test_a_block_on_which_a_point_stands_is_left_out(spec: Spec, index: int) -> None:
    """Points stay where they are without blocks, and blocks stay what they are without points."""
    keys = {"x_m": [-60.0, 60.0], "y_m": [-40.0, 90.0], "environment": "dense-urban"}
    plain, built = (
        draw_scene(spec(scenes=10**7), index),
        draw_scene(spec(scenes=10**7, buildings=keys), index),
    )
    assert (built.nodes, built.jammers) == (plain.nodes, plain.jammers)
    places = [shapely.Point(*point.position_m[:2]) for point in (*built.nodes, *built.jammers)]
    assert not any(shape.intersects(place) for shape in _shapes(built) for place in places)
    alone = spec(scenes=10**7, buildings=keys, nodes__x_m=[9e3, 9.1e3], jammers__centre_m=[9e3, 0])
    whole = {(each.polygon_m, each.height_m) for each in draw_scene(alone, index).buildings}
    kept = {(each.polygon_m, each.height_m) for each in built.buildings}
    assert kept <= whole
    assert len(whole - kept) <= len(places)


def test_blocks_stand_around_the_drawn_points_unless_stated(spec: Spec) -> None:
    """The area is the smallest rectangle around those of nodes and jammers; either side may be stated."""
    study = spec(scenes=10**6, buildings={"environment": "urban", "x_m": [-100.0, 100.0]})
    centres_m = np.array(
        [shape.centroid.coords[0] for index in range(60) for shape in _shapes(draw_scene(study, index))]
    )
    assert centres_m.min(axis=0) == pytest.approx([-100.0, -35.0], abs=3.0)
    assert centres_m.max(axis=0) == pytest.approx([100.0, 85.0], abs=3.0)


def test_known_blocks_stay_what_they_are(spec: Spec) -> None:
    """The numbers behind a seed are those of the first release."""
    scene = draw_scene(spec(buildings=FAR | {"environment": "urban"}), 5)
    assert len(scene.buildings) == 29
    assert scene.buildings[0].polygon_m[0] == pytest.approx(
        (114.43864432158483, 107.28021559102072), abs=1e-9
    )
    assert scene.buildings[0].height_m == pytest.approx(12.20501845163892, abs=1e-9)


def test_more_buildings_keep_the_channel_and_a_swept_one_is_set(spec: Spec) -> None:
    """A key of the table is swept with the blocks drawn anew, and a height of one with them as they are."""
    numbers = {"alpha": 0.3, "beta_per_km2": 500.0, "gamma_m": 15.0}
    study = spec(
        scene__channel={"model": "power-law", "exponent": {"uniform": [2.0, 3.0]}},
        buildings=FAR | numbers,
        sweep={"buildings.gamma_m": [15.0, 30.0], "buildings[0].height_m": [7.0]},
    )
    low, high = (scene_at(study, 0, point) for point in range(2))
    assert low.channel == high.channel
    assert [each.polygon_m for each in low.buildings] == [each.polygon_m for each in high.buildings]
    assert [2.0 * each.height_m for each in low.buildings[1:]] == pytest.approx(
        [each.height_m for each in high.buildings[1:]]
    )
    assert low.buildings[0].height_m == high.buildings[0].height_m == 7.0


def test_rows_of_drawn_scenes_are_those_of_the_exported_ones(spec: Spec) -> None:
    """Each is solved in its own channel and among its own blocks, alone as beside others."""
    study = spec(
        scenes=4,
        scene__channel={"model": "power-law", "exponent": {"uniform": [2.0, 3.0]}},
        buildings={"environment": "urban"},
        node_limit=100_000,
    )
    again = StudySpec.from_dict(study.to_dict())
    assert (again, again.digest) == (study, study.digest)
    alone = [row for index in range(4) for row in rows_of(again, index, index)]
    for row, other in zip(rows_of(study, 0, 3), alone, strict=True):
        assert row | {"seconds": 0.0} == other | {"seconds": 0.0}
        exported = Scenario.from_dict(draw_scene(study, row["scene"]).to_dict())
        assert exported == draw_scene(study, row["scene"])
        assert row["status"] == "certified"


NUMBERS = {"alpha": 0.3, "beta_per_km2": 500.0, "gamma_m": 15.0}


@pytest.mark.parametrize(
    ("buildings", "path", "words"),
    [
        (NUMBERS | {"alpha": 1.2}, "buildings.alpha", "from 0.001 to 0.99"),
        (NUMBERS | {"beta_per_km2": 0}, "buildings.beta_per_km2", "must be a number of buildings per km^2"),
        (NUMBERS | {"gamma_m": -1}, "buildings.gamma_m", "must be a height in m"),
        (NUMBERS | {"environment": "urban"}, "buildings", "both environment and alpha and beta_per_km2"),
        ({"environment": "urbn"}, "buildings.environment", 'did you mean "urban"'),
        ({"alpha": 0.3}, "buildings", "without beta_per_km2 and gamma_m"),
        ({}, "buildings", "neither environment nor alpha"),
        ({"environment": "urban", "x_m": [1.0, 0.0]}, "buildings.x_m", "reversed"),
    ],
)
def test_a_faulty_table_is_refused(spec: Spec, buildings: dict[str, Any], path: str, words: str) -> None:
    """With one message, by the path of what is wrong."""
    with pytest.raises(ScenarioError) as caught:
        spec(buildings=buildings)
    (fault,) = caught.value.faults
    assert fault.path == path
    assert words in fault.message


def test_an_area_is_needed(spec: Spec) -> None:
    """Where no points are drawn nothing tells where the blocks stand."""
    scene = {**spec().scene.to_dict(), "nodes": [{"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}]}
    with pytest.raises(ScenarioError) as caught:
        spec(scene=scene, nodes=None, jammers=None, buildings={"environment": "urban", "x_m": [-100, 100]})
    (fault,) = caught.value.faults
    assert fault.path == "buildings.y_m"
    assert "missing" in fault.message


@pytest.mark.parametrize("x_m", [[0.0, 1e5], [0.0, 1e7]])
def test_more_blocks_than_a_scenario_may_have(
    spec_file: Callable[..., Any], tmp_path: Any, x_m: list[float]
) -> None:
    """How many an area means is looked at before they are drawn."""
    with pytest.raises(ScenarioError, match=r"buildings: a mean of .* buildings, at most 2000 are allowed"):
        load_spec(spec_file(tmp_path, buildings={"environment": "urban", "x_m": x_m, "y_m": [0.0, 100.0]}))
