"""Names in pictures of scenes: each is legible, whatever stands around it."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

from nullpose import Scenario, load, solve
from nullpose.report.figures.labels import Label, place_labels
from nullpose.report.figures.poses import draw_pose

EXAMPLES = Path(__file__).parents[2] / "examples"


def _overlaps(figure: Figure) -> list[tuple[str, str]]:
    """Return the pairs of texts in the first axes that share more than their rims."""
    figure.canvas.draw()
    texts = [(text.get_text(), text.get_window_extent()) for text in figure.axes[0].texts]
    pairs = [(one, other) for i, one in enumerate(texts) for other in texts[i + 1 :]]
    return [
        (one[0], other[0])
        for one, other in pairs
        if one[1].shrunk(0.8, 0.6).overlaps(other[1].shrunk(0.8, 0.6))
    ]


@pytest.mark.parametrize("name", ["field", "geodetic", "no-fly"])
def test_names_do_not_run_into_each_other(name: str) -> None:
    """In the crowded examples no name is written over another."""
    assert _overlaps(draw_pose(solve(load(EXAMPLES / f"{name}.toml"), certify=False))) == []


def test_names_stand_off_the_markers(field: Scenario) -> None:
    """No name lies over another point's marker, as the jammer's once did over a node."""
    figure = draw_pose(solve(field, certify=False))
    figure.canvas.draw()
    axes = figure.axes[0]
    names = (*field.node_names, *field.jammer_names)
    points = dict(zip(names, np.vstack([field.node_positions_m, field.jammer_positions_m]), strict=True))
    anchors = {text.get_text(): axes.transData.transform(text.xy) for text in axes.texts}
    assert set(anchors) == set(points)
    for text in axes.texts:
        box = text.get_window_extent()
        covered = [name for name, at in anchors.items() if box.contains(*at)]
        assert covered == [], text.get_text()


def test_of_equal_places_the_usual_one_is_taken() -> None:
    """Alone, a node's name stands above it and a jammer's to its right; a zone's on it."""
    figure = Figure(figsize=(4.0, 4.0))
    axes = figure.add_subplot(projection="3d")
    axes.set(xlim=(0, 10), ylim=(0, 10), zlim=(0, 10))
    labels = [
        Label("S", np.array([2.0, 2.0, 0.0]), "k"),
        Label("M", np.array([8.0, 2.0, 0.0]), "k", beside=True),
        Label("zone", np.array([2.0, 8.0, 5.0]), "k", on=True),
    ]
    place_labels(axes, labels, np.array([8.0, 8.0, 8.0]), 0.1)
    held = {text.get_text(): (text.get_ha(), text.get_va()) for text in axes.texts}
    assert held == {"S": ("center", "bottom"), "M": ("left", "center"), "zone": ("center", "center")}
