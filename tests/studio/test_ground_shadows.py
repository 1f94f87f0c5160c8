"""Shadows as they are drawn are where the physics blocks a link."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from nullpose import apply_overrides, load, solve
from nullpose.channel.buildings import is_blocked
from nullpose.scenario import Scenario
from nullpose.studio.answer import answer_of
from nullpose.studio.case import OPTIMUM
from nullpose.studio.drawing import Shapes
from nullpose.studio.field_map import MAPS, field_map
from nullpose.studio.ground import shadow_shapes
from nullpose.studio.look import LIGHT
from nullpose.studio.readout import card_html
from nullpose.studio.state import State

TOWN = load("examples/town.toml")


def _solved(scenario: Scenario) -> State:
    state = State(scenario=scenario)
    return state.with_event(answer_of(state.version, OPTIMUM, solve(scenario, certify=False)))


def _drawn(state: State) -> Shapes:
    return shadow_shapes(state, 200.0, LIGHT)


@pytest.mark.parametrize("overrides", [[], ["nodes.west.position_m[1]=8", "airspace.altitude_m[0]=60"]])
def test_what_is_filled_or_hatched_is_blocked(overrides: list[str]) -> None:
    """All over the plane at the drone's altitude, for every point; and nothing else is."""
    state = _solved(apply_overrides(TOWN, overrides))
    scenario, shapes, answer = state.scenario, _drawn(state), state.answer(OPTIMUM)
    assert scenario.prisms is not None
    assert answer is not None
    altitude_m = answer.result.pose.position_m[2]
    assert shapes["/shadows"].values["position"] == pytest.approx([0.0, 0.0, altitude_m])
    places = np.random.default_rng(0).uniform(-100.0, 100.0, (4000, 2))
    for index, node in enumerate(scenario.nodes):
        values = shapes[f"/shadows/nodes-{index}"].values
        triangles = np.asarray(values["vertices"])[np.asarray(values["faces"]), :2]
        area = shapely.union_all(shapely.buffer(shapely.polygons(triangles), 1e-4))
        sure = shapely.distance(area.boundary, shapely.points(places)) > 1e-3
        blocked = is_blocked(
            scenario.prisms,
            np.insert(places, 2, altitude_m, axis=1),
            np.array([node.position_m]),
            is_interferer=False,
        )[:, 0]
        assert sure.mean() > 0.9
        assert np.array_equal(shapely.contains_xy(area, places)[sure], blocked[sure])
    middles = np.asarray(shapes["/shadows/jammers-0"].values["points"]).mean(axis=1)
    behind = np.insert(middles[:, :2], 2, altitude_m, axis=1)
    place_m = np.array([scenario.jammers[0].position_m])
    assert len(middles) > 10
    assert np.all(is_blocked(scenario.prisms, behind, place_m, is_interferer=True))


def test_they_are_shown_where_they_say_something(paper: Scenario) -> None:
    """Among buildings, until they are switched off, and not on the map that has them in its values."""
    state = _solved(TOWN)
    assert len(_drawn(state)) == 1 + len(TOWN.nodes) + len(TOWN.jammers)
    assert "jammer blocked (good)" in card_html(state)
    answer = state.answer(OPTIMUM)
    assert answer is not None
    mapped = replace(state.with_event(field_map(answer)), map_name=MAPS[0])
    for bare in (_solved(paper), replace(state, has_shadows=False), mapped):
        assert _drawn(bare) == {}
        assert "blocked" not in card_html(bare)
