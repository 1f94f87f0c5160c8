"""The figure of one pose: whatever the scene has is on it."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread
from sizes import chosen

from nullpose import Pose, Scenario, load, solve, sweep
from nullpose.errors import UsageError
from nullpose.report.figures.dots import draw_comparison
from nullpose.report.figures.plan import draw_value_map
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.poses import draw_result
from nullpose.report.figures.style import prepare_figure_file, write_figure
from nullpose.report.figures.sweep import draw_sweep
from nullpose.report.geometry import outline_m
from nullpose.scenario import apply_overrides
from nullpose.study.value_map import value_map
from nullpose.study.vehicles import compare_schemes
from scenes import EXAMPLES, best_found


@pytest.mark.parametrize(
    "name", chosen(["airframe", "eavesdropper", "no-fly", "requirements", "geodetic", "town"], range(5))
)
def test_every_example_can_be_drawn(name: str, tmp_path: Path) -> None:
    """The file is written, is not blank, names every point, and tells the value in its unit."""
    solution = best_found(name)
    figure = draw_result(solution)
    axes = figure.axes[0]
    scenario = solution.scenario
    names = {*scenario.node_names, *scenario.jammer_names, *scenario.eavesdropper_names}
    written = [" ".join(text.get_text().split()) for text in axes.texts]
    assert all(any(text.startswith(name) for text in written) for name in names)
    assert solution.objective.quantity.smallest in figure.get_suptitle()
    assert ("bits/s/Hz" in figure.get_suptitle()) == (name == "eavesdropper")
    picture = imread(*write_figure(figure, tmp_path / f"{name}.png"))
    assert picture[..., :3].std() > 0.03


def test_buildings_are_drawn_with_their_shadows() -> None:
    """From above, courtyards open; on a map, which has its own colours, as outlines only."""
    scenario = load(EXAMPLES / "town.toml")
    yard = {
        "polygon_m": [[-4, 30], [4, 30], [4, 38], [-4, 38]],
        "courtyards_m": [[[-2, 32], [2, 32], [0, 36]]],
    }
    data = scenario.to_dict()
    scenario = Scenario.from_dict(data | {"buildings": [*data["buildings"], yard | {"height_m": 9.0}]})
    solution = solve(scenario, certify=False)
    plan = draw_result(solution).axes[0]
    labels = plan.get_legend_handles_labels()[1]
    assert {"building", "node blocked", "jammer blocked"} <= set(labels)
    (buildings,) = (patch for patch in plan.patches if patch.get_label() == "building")
    rings = buildings.get_path().to_polygons(closed_only=True)
    outlines_m = [building.outline_m for building in scenario.buildings]
    yard_m = scenario.buildings[-1].courtyard_outlines_m[0]
    for ring, corners_m in zip(rings, [*outlines_m, yard_m[::-1]], strict=True):  # clockwise: a hole
        np.testing.assert_array_equal(ring[:-1], corners_m)
    seen = draw_value_map(solution, value_map(solution, cells=12)).axes[0]
    (outlines,) = (patch for patch in seen.patches if patch.get_label() == "building")
    assert not outlines.get_fill()


def test_zones_far_away_are_left_out() -> None:
    """A zone or a fence that reaches far beyond the scene is not drawn; a cylinder encloses its circle."""
    scenario = load(EXAMPLES / "no-fly.toml")
    stage = PlanScene(scenario=scenario, poses=(Pose(np.array([0.0, 25.0, 8.0]), 0.0, 0.0),))
    assert [zone and zone.name for zone, _ in stage.zones] == ["school", "mast", "road", None]
    nodes = tuple(
        node.model_copy(update={"position_m": (0.2 * node.position_m[0], 0.2 * node.position_m[1], 0.0)})
        for node in scenario.nodes
    )
    small = scenario.model_copy(update={"nodes": nodes, "jammers": ()})
    stage = PlanScene(scenario=small, poses=(Pose(np.array([0.0, 5.0, 8.0]), 0.0, 0.0),))
    assert [zone and zone.name for zone, _ in stage.zones] == ["mast"]
    radii = np.linalg.norm(outline_m(scenario.airspace.no_fly[0]) - [-2.0, 24.0], axis=1)
    assert np.all(radii >= 12.0)
    assert radii == pytest.approx(12.0, rel=1e-3)


def test_a_figure_is_named_by_its_kind(tmp_path: Path) -> None:
    """Other kinds of file are refused before any work; a folder is made."""
    with pytest.raises(UsageError, match=r"allowed: a name that ends in \.png, \.svg or \.pdf"):
        prepare_figure_file(tmp_path / "figure.jpg")
    prepare_figure_file(tmp_path / "new" / "figure.SVG")
    assert (tmp_path / "new").is_dir()


@pytest.mark.parametrize("width", [None, "column"])
def test_long_names_stay_within_every_figure(paper: Scenario, width: str | None) -> None:
    """Titles are broken into lines, and so are long names in a key; at far places every number is whole."""
    points = paper.to_dict()
    for each in (*points["nodes"], *points["jammers"]):
        each["name"] = f"{each['name']}, the one with a name that no other has, beside the motorway bridge"
        each["position_m"] = [each["position_m"][0] + 14500.0, each["position_m"][1] - 14500.0, 0.0]
    scenario = Scenario.from_dict(points | {"name": " ".join(["A name as long as a sentence"] * 8)})
    solution = solve(scenario, certify=False)
    figures = [
        draw_result(solution, width),
        draw_sweep(sweep(scenario, "jammers[0].power_w", [1e-9, 2e-9], certify=False), width=width),
        draw_comparison(compare_schemes(scenario, certify=False), width),
    ]
    for figure in figures:
        figure.draw_without_rendering()
        titles = [
            figure._suptitle,
            *(each for axes in figure.axes for each in (axes.title, axes._left_title)),
        ]
        texts = [*titles, *(text for legend in figure.legends for text in legend.get_texts())]
        for text in [text for text in texts if text is not None and text.get_text()]:
            box = text.get_window_extent()
            assert figure.bbox.x0 <= box.x0
            assert box.x1 <= figure.bbox.x1
        for axes in figure.axes:
            assert axes.xaxis.get_offset_text().get_text() == axes.yaxis.get_offset_text().get_text() == ""


def test_a_hover_is_drawn_over_time() -> None:
    """Beside the plan of the worst instant stand the value at each instant, and the bound."""
    scenario = apply_overrides(
        load(EXAMPLES / "moving_jammer.toml"), ["airframe.tilt_max_deg=0", "time.step_s=10"]
    )
    found = solve(scenario, hover=True, gap=1e-2)
    plan, over_time = draw_result(found).axes
    curve, worst, bound = (line.get_xydata() for line in over_time.lines)
    np.testing.assert_allclose(10.0 ** (0.1 * curve[:, 1]), found.details.values)
    np.testing.assert_array_equal(curve[:, 0], scenario.instants_s)
    assert worst.tolist() == [[found.scenario.at_s, found.objective.value_db]]
    assert 10.0 ** (0.1 * bound[0, 1]) == pytest.approx(found.objective.upper_bound)
    assert any(text.get_text().startswith("M") for text in plan.texts)
