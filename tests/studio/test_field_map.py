"""The maps agree with the physics, point by point."""

import numpy as np
import pytest
import shapely

from nullpose import load
from nullpose.physics import evaluate, objective_value, to_db
from nullpose.scenario import Node, NoFlyZone, Scenario
from nullpose.solver import best_axis, solve
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM, PoseCase, case_named, cases_of
from nullpose.studio.field_map import field_map
from nullpose.studio.look import scale_range
from scenes import EXAMPLES


def _map(scenario: Scenario, case: PoseCase):  # type: ignore[no-untyped-def]
    answer = answer_of(1, case, solve(case.on(scenario), case.scheme, certify=False))
    return answer, field_map(answer)


def test_the_best_value_is_the_best_axis(paper: Scenario) -> None:
    """At points all over the map the value is that of the solver's best axis there."""
    answer, maps = _map(paper, case_named("Optimum pose"))
    best = maps.best
    assert best.altitude_m == pytest.approx(answer.result.pose.position_m[2])
    assert np.all(np.isfinite(best.values))
    for row, column in ((0, 0), (5, 20), (20, 10), (30, 24), (44, 3)):
        place = np.array([best.east_m[column], best.north_m[row], best.altitude_m])
        pose = best_axis(paper, place)
        expected = to_db(objective_value(paper, place, pose.antenna_axis))
        assert best.values[row, column] == pytest.approx(float(expected), abs=1e-9)


@pytest.mark.parametrize("name", ["paper", "eavesdropper", "field", "no-fly", "requirements"])
def test_the_drone_is_at_the_best_place_of_its_map(name: str) -> None:
    """The largest value of the map is the answer's, for every case of the paper, and on the map's scale."""
    scenario = load(EXAMPLES / f"{name}.toml")
    for case in cases_of(scenario) if name == "paper" else (OPTIMUM,):
        answer, maps = _map(scenario, case)
        low, high = scale_range(maps.best.values, is_rate=maps.best.unit != "dB")
        most = np.nanmax(maps.best.values)
        assert most == pytest.approx(answer.shown_value, abs=1e-6 if name == "paper" else 0.01)
        assert low <= answer.shown_value <= high


def test_forbidden_places_have_no_value(paper: Scenario) -> None:
    """In a no-fly zone there is nothing to show."""
    zone = NoFlyZone(centre_m=(10.0, 25.0), radius_m=6.0)
    closed = paper.model_copy(update={"airspace": paper.airspace.model_copy(update={"no_fly": (zone,)})})
    _, maps = _map(closed, case_named("Optimum pose"))
    east, north = np.meshgrid(maps.best.east_m, maps.best.north_m)
    inside = np.hypot(east - 10.0, north - 25.0) < 5.9
    assert inside.any()
    assert np.all(np.isnan(maps.best.values[inside]))
    assert np.all(np.isfinite(maps.best.values[np.hypot(east - 10.0, north - 25.0) > 6.1]))


@pytest.mark.parametrize("name", ["town", "urban"])
def test_the_best_value_is_what_evaluate_says(name: str) -> None:
    """In a channel and among buildings, with the drone at the place and the best axis there."""
    scenario = load(EXAMPLES / f"{name}.toml")
    best = _map(scenario, OPTIMUM)[1].best
    for row, column in np.argwhere(np.isfinite(best.values))[::41]:
        place_m = [best.east_m[column], best.north_m[row], best.altitude_m]
        links = evaluate(scenario, best_axis(scenario, place_m))
        assert best.values[row, column] == pytest.approx(min(link.sinr_db for link in links))


@pytest.mark.parametrize("name", ["town", "urban", "paper"])
def test_the_footprint_is_what_evaluate_says_of_nodes_there(name: str) -> None:
    """In any channel and behind buildings: but for a constant, noise and reference gain, it is their SNR."""
    scenario = load(EXAMPLES / f"{name}.toml")
    answer, maps = _map(scenario, OPTIMUM)
    ground = maps.footprint
    roofs = shapely.union_all([shapely.Polygon(building.outline_m) for building in scenario.buildings])
    nodes, drawn_db = [], []
    for row, column in np.argwhere(ground.values > -59.0)[:: ground.values.size // 90]:  # the floor is -60
        place_m = (ground.east_m[column], ground.north_m[row], 0.0)
        if not roofs.intersects(shapely.Point(place_m)):
            nodes.append(Node(name=f"{row} {column}", position_m=place_m, power_w=1.0))
            drawn_db.append(ground.values[row, column])
    heard = evaluate(scenario.model_copy(update={"nodes": tuple(nodes), "jammers": ()}), answer.result.pose)
    assert len(nodes) > 50
    assert np.ptp(np.subtract(drawn_db, [link.sinr_db for link in heard])) < 1e-9


def test_the_footprint_is_dark_where_the_null_falls(paper: Scenario) -> None:
    """On the ground the pattern is weakest near where the null's line meets it."""
    loud = paper.model_copy(update={"jammers": (paper.jammers[0].model_copy(update={"power_w": 100.0}),)})
    answer, maps = _map(loud, case_named("Zero interference"))
    axis, here = answer.result.pose.antenna_axis, answer.result.pose.position_m
    hit = here - axis * here[2] / axis[2]
    east, north = np.meshgrid(maps.footprint.east_m, maps.footprint.north_m)
    near = np.hypot(east - hit[0], north - hit[1])
    if near.min() < 2.0:
        assert maps.footprint.values.flat[np.argmin(near)] < np.median(maps.footprint.values)
    assert maps.footprint.altitude_m == 0.0
