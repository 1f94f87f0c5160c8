"""Figures for print: as wide as a column or a page, with embedded letters that do not touch."""

from collections.abc import Callable
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st
from matplotlib.figure import Figure
from sizes import chosen, diagonal, few_examples

from nullpose import Pose, Scenario, compare_airframes, load, solve, sweep
from nullpose.report.figures.dots import draw_comparison
from nullpose.report.figures.names import place_names
from nullpose.report.figures.plan import draw_plan, draw_value_map
from nullpose.report.figures.plan_scene import PlanScene
from nullpose.report.figures.poses import draw_result
from nullpose.report.figures.style import WIDTHS_MM, house_style, write_figure
from nullpose.report.figures.sweep import draw_sweep
from nullpose.study import compare_schemes, value_map
from scenes import EXAMPLES, best_found

WIDTHS = pytest.mark.parametrize("width", list(WIDTHS_MM))


@pytest.fixture(scope="module")
def drawings(paper: Scenario) -> list[Callable[[str], Figure]]:
    """Return what draws each kind of figure in a width."""
    result, table = best_found("paper"), sweep(paper, "jammers.M.power_w", [0.5, 2.0], certify=False)
    values = value_map(result, cells=15)
    tables = compare_schemes(paper, certify=False), compare_airframes(paper, certify=False)
    return [
        lambda width: draw_result(result, width),
        lambda width: draw_sweep(table, width=width),
        lambda width: draw_value_map(result, values, width),
        *(lambda width, table=table: draw_comparison(table, width) for table in tables),
    ]


@WIDTHS
def test_every_figure_has_the_width(drawings: list[Callable[[str], Figure]], width: str) -> None:
    """To the hundredth of a millimetre, and none is higher than a page."""
    for draw in drawings:
        figure = draw(width)
        wide, high = figure.get_size_inches() * 25.4
        assert wide == pytest.approx(WIDTHS_MM[width], abs=0.01)
        assert high < 235.0
        assert figure.get_suptitle() == ""


@pytest.mark.parametrize(
    ("name", "width"), diagonal(["paper", "no-fly", "field", "array", "robust"], [*WIDTHS_MM])
)
def test_letters_stay_on_the_paper_and_apart(name: str, width: str) -> None:
    """Names of points, names of axes and the legend are on the paper; names of points do not run together."""
    figure = draw_result(best_found(name, robust=name == "robust"), width)
    figure.draw_without_rendering()
    legend = figure.legends[0].get_window_extent()
    assert legend.x0 >= 0.0
    assert legend.x1 <= figure.bbox.x1
    for axes in figure.axes:
        whole = axes.get_tightbbox()
        assert min(whole.x0, whole.y0) >= 0.0
        assert whole.x1 <= figure.bbox.x1
        assert not axes.get_title() or axes.title.get_window_extent().y1 <= figure.bbox.y1
        assert not whole.overlaps(legend)
        names = [text.get_window_extent().shrunk(0.8, 0.6) for text in axes.texts]
        touching = [(i, j) for i, one in enumerate(names) for j in range(i) if one.overlaps(names[j])]
        assert touching == []


def test_the_plan_is_to_scale_and_has_every_name() -> None:
    """A metre is as long to the east as to the north; every point and the drone are named."""
    (plan,) = draw_result(best_found("paper")).axes
    assert {text.get_text() for text in plan.texts} == {"S1 0.98 dB", "S2 0.98 dB", "M", "drone 8 m up"}
    across, along = plan.transData.transform([[1.0, 0.0], [0.0, 1.0]]) - plan.transData.transform([0.0, 0.0])
    assert across[0] == pytest.approx(along[1], rel=1e-6)


@pytest.mark.parametrize("kind", ["pdf", "svg", "png"])
def test_the_same_figure_gives_the_same_file(tmp_path: Path, kind: str) -> None:
    """To the byte; the fonts of a PDF are in it, as TrueType."""
    first, again = (
        write_figure(draw_result(best_found("paper"), "column"), tmp_path / f"{name}.{kind}")[0].read_bytes()
        for name in "ab"
    )
    assert first == again
    assert kind != "pdf" or (b"/FontFile2" in first and b"/Type3" not in first)


@pytest.mark.parametrize("name", chosen(["paper", "town", "whips", "requirements"], [0, 3]))
def test_a_name_stands_nearest_its_own_point(name: str) -> None:
    """In a column, where names are close to each other, none stands at the mark of another point."""
    figure = draw_result(best_found(name), "column")
    figure.draw_without_rendering()
    plan = figure.axes[0]
    names = [text for text in plan.texts if text.get_fontstyle() != "italic"]
    marks = plan.transData.transform([place for each in plan.collections for place in each.get_offsets()])
    for text in names:
        box, own = text.get_window_extent(), plan.transData.transform(text.xy)
        away = [np.hypot(*np.fmax(np.fmax(box.min - at, at - box.max), 0.0)) for at in (own, *marks)]
        assert away[0] <= min(away) + 6.0 * figure.dpi / 72.0, text.get_text()


@pytest.mark.parametrize("seed", chosen([1, 2, 3], [0]))
def test_a_key_has_every_name_in_a_crowded_column(seed: int) -> None:
    """Each node with its number, each jammer and zone, and the sign of each in the plan."""
    places_m = (
        np.random.default_rng(seed).permutation(np.mgrid[0:400:100, 0:400:100].reshape(2, -1).T).tolist()
    )
    nodes = [{"name": f"pumping station {i}", "position_m": [*at, 0.0]} for i, at in enumerate(places_m[:10])]
    jammers = [{"name": f"van {i}", "position_m": [*at, 0.0]} for i, at in enumerate(places_m[10:12])]
    zone = {"name": "mast", "centre_m": places_m[12], "radius_m": 20.0}
    points = {"nodes": nodes, "jammers": jammers}
    scene = {kind: [each | {"power_w": 1.0} for each in rows] for kind, rows in points.items()}
    scene |= {"airspace": {"altitude_m": [30.0, 90.0], "no_fly": [zone]}}
    result = solve(
        Scenario.from_dict(scene | {"receiver": {"noise_w": 1e-9, "reference_gain_db": 0.0}}), certify=False
    )
    figure = draw_result(result, "column")
    assert figure.get_figheight() * 25.4 <= 75.01
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    for sign, link in enumerate(result.links, start=1):
        number = f"{link.sinr_db:.2f}".replace("-", "\N{MINUS SIGN}")
        assert f"{sign}  {link.node}  {number}" in words
    assert {"A  van 0", "B  van 1", "a  mast"} <= set(words)
    plan = figure.axes[0]
    signs = {text.get_text() for text in plan.texts if text.get_visible()}
    assert {"A", "B", *map(str, range(1, 11))} <= signs


@pytest.mark.parametrize("name", ["array", "no-fly"])
def test_a_key_leaves_out_what_is_not_drawn(name: str) -> None:
    """An array has no dot for the drone, and a zone that reaches far away is in no figure."""
    scene = load(EXAMPLES / f"{name}.toml").to_dict()
    scene["nodes"] = [node | {"name": f"pumping station {node['name']}"} for node in scene["nodes"]]
    far = {"name": "firing range", "polygon_m": [[900.0, 0.0], [9e3, 0.0], [9e3, 9e3]]}
    scene["airspace"]["no_fly"] = [*scene["airspace"].get("no_fly", []), far]
    figure = draw_result(solve(Scenario.from_dict(scene), certify=False), "column")
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert any("pumping station S1" in each for each in words)
    assert not any("firing range" in each for each in words)


@given(seed=st.integers(0, 10_000), nodes=st.integers(1, 14), zones=st.integers(0, 6))
@few_examples(4)
def test_names_keep_apart_in_crowds(seed: int, nodes: int, zones: int) -> None:
    """Seen from above in a column, every name drawn is in the frame and touches no other name and no mark."""
    generator = np.random.default_rng(seed)
    at = generator.uniform(0.0, 300.0, size=(nodes + zones + 2, 2)).round(1).tolist()
    jammers = [{"name": f"J{i}", "position_m": [*at[i], 2.0], "power_w": 1.0} for i in range(2)]
    sensors = [{"name": f"sensor {i}", "position_m": [*at[2 + i], 0.0], "power_w": 1.0} for i in range(nodes)]
    closed = [{"name": f"zone R-{i}", "centre_m": at[2 + nodes + i], "radius_m": 20.0} for i in range(zones)]
    scene = {"airspace": {"altitude_m": [30.0, 90.0], "no_fly": closed}, "nodes": sensors, "jammers": jammers}
    scenario = Scenario.from_dict(scene | {"receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0}})
    pose = Pose.from_axis([*generator.uniform(0.0, 300.0, size=2), 50.0], [1.0, 0.0, 0.0])
    axes = Figure(figsize=(1.8, 2.0)).add_axes((0.2, 0.2, 0.78, 0.78))
    with house_style("column"):
        draw_plan(axes, PlanScene(scenario=scenario, poses=(pose,)), pose)
        place_names(axes)
    boxes = [text.get_window_extent() for text in axes.texts if text.get_visible()]
    assert len(boxes) >= 1
    assert not any(one.overlaps(other) for one, other in combinations(boxes, 2))
    marks = axes.transData.transform(np.vstack([each.get_offsets() for each in axes.collections]))
    assert not any(box.contains(*mark) for box in boxes for mark in marks)
    assert all(axes.bbox.contains(*corner) for box in boxes for corner in (box.min, box.max))


@WIDTHS
def test_a_drone_straight_above_its_only_node(width: str) -> None:
    """From above both are one point, whose names have no other to keep clear of."""
    scene = {"airspace": {"altitude_m": [8.0, 30.0]}, "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0}}
    node = {"position_m": [0.0, 0.0, 0.0], "power_w": 1.0}
    result = solve(Scenario.from_dict(scene | {"nodes": [node]}), certify=False)
    assert draw_result(result, width).axes
