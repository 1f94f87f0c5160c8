"""The figure of a robust solution: two poses in one space, with the sets that jammers may be in."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from nullpose import Scenario, load
from nullpose.report.figures.poses import draw_robust
from nullpose.report.figures.scene import draw_set
from nullpose.report.figures.stage import set_box_m
from nullpose.solver import Result, solve

EXAMPLE = Path(__file__).parents[2] / "examples" / "robust.toml"


def _turned() -> Scenario:
    data = load(EXAMPLE).to_dict()
    data["jammers"][0] |= {"uncertainty_m": [3.0, 2.0, 1.0], "uncertainty_attitude_deg": [10.0, 20.0, 30.0]}
    return Scenario.from_dict(data)


@pytest.fixture(scope="module")
def solution() -> Result:
    """The example, searched alone."""
    return solve(load(EXAMPLE), robust=True, certify=False)


def test_both_poses_with_what_they_guarantee(solution: Result) -> None:
    """A panel for each, with its values in dB; the errors above them."""
    figure = draw_robust(solution)
    for axes, one, name in zip(
        figure.axes,
        (solution.details.robust, solution.details.nominal),
        ("robust pose", "best pose without errors"),
        strict=True,
    ):
        title = axes.get_title().replace("\N{MINUS SIGN}", "-")
        assert title.startswith(name)
        assert f"{10 * np.log10(one.guaranteed):.2f} dB guaranteed" in title
        assert f"{10 * np.log10(one.nominal):.2f} dB without errors" in title
        drones = [line.get_data_3d() for line in axes.lines if line.get_label() == "antenna axis (null)"]
        assert np.mean(drones[0], axis=1) == pytest.approx(one.pose.position_m)
    assert "smallest SINR; errors: axis 2 deg, position 0.5 m, M up to 3 m" in figure.get_suptitle()


def test_both_panels_show_the_same_space(solution: Result) -> None:
    """Places can be compared: limits are the same, and both drones are inside."""
    first, second = draw_robust(solution).axes
    for name in ("get_xlim3d", "get_ylim3d", "get_zlim3d"):
        assert getattr(first, name)() == getattr(second, name)()
    low, high = first.get_ylim3d()
    for one in (solution.details.robust, solution.details.nominal):
        assert low < one.pose.position_m[1] < high


def test_the_set_is_drawn_around_its_jammer(solution: Result) -> None:
    """Every wire is as far from the jammer as it may be off, in its colour, and in the legend once."""
    figure = draw_robust(solution)
    for axes in figure.axes:
        (wires,) = [one for one in axes.collections if one.get_label() == "where the jammer may be"]
        assert len(wires._segments3d) > 3
        points = np.vstack(wires._segments3d) - [17.0, 15.0, 4.0]
        assert np.linalg.norm(points, axis=1) == pytest.approx(3.0)
        assert to_hex(wires.get_edgecolor()[0]) == "#d55e00"
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts.count("where the jammer may be") == 1


def test_wires_lie_on_the_ellipsoid() -> None:
    """A turned ellipsoid's wires are on its surface and within its box, which they touch nearly."""
    (jammer,) = _turned().jammers
    axes = Figure().add_subplot(projection="3d")
    draw_set(axes, jammer, "k", "set")
    wires = np.vstack(axes.collections[0]._segments3d)
    inverse = np.linalg.inv(jammer.uncertainty_matrix_m)
    assert np.linalg.norm((wires - jammer.position_m) @ inverse.T, axis=1) == pytest.approx(1.0)
    low, high = set_box_m(jammer)
    assert np.all(wires >= low - 1e-9)
    assert np.all(wires <= high + 1e-9)
    assert np.ptp(wires, axis=0) == pytest.approx(high - low, rel=0.1)
