"""Labels that stay out of each other's way."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose.studio.eye import Eye
from nullpose.studio.labels import ANCHORS, Labels, Rank, _box_px

EYE = Eye([0.0, -100.0, 0.0], [0.0, 0.0, 0.0], 1.0, 1000.0, 800.0)
PLACES = st.lists(
    st.tuples(st.floats(-40.0, 40.0), st.floats(-30.0, 30.0), st.sampled_from(Rank)), min_size=1, max_size=25
)


class _Scene:
    """Stands for viser's; counts what is sent, which is what differs."""

    def __init__(self) -> None:
        self.handles: dict[str, Any] = {}
        self.sent = 0

    def add_label(self, name: str, text: str, **given: Any) -> Any:
        """Returns a handle that counts what is set."""
        scene = self

        class Handle(SimpleNamespace):
            def __setattr__(self, key: str, value: object) -> None:
                scene.sent += not np.array_equal(getattr(self, key), value)  # what is as it was stays
                super().__setattr__(key, value)

            def remove(self) -> None:
                del scene.handles[name]

        self.handles[name] = Handle(text=text, visible=True, **given)
        return self.handles[name]


def _shown(labels: Labels, scene: _Scene) -> list[tuple[Any, Rank]]:
    """Returns the boxes and ranks of what is to be seen."""
    boxes = []
    for name, label in labels._all.items():
        handle = scene.handles[name]
        x, y, _ = EYE.pixels(label.place_m[None])[0]
        if handle.visible:
            boxes.append((_box_px(handle, handle.anchor, x, y), label.rank))
    return boxes


@seed(0)
@given(places=PLACES)
def test_no_label_is_over_another(places: list[tuple[float, float, Rank]]) -> None:
    """Of what is seen nothing overlaps, and the one that matters most is seen."""
    scene = _Scene()
    labels = Labels(scene)  # type: ignore[arg-type]
    for i, (x, z, rank) in enumerate(places):
        labels.put(f"/{i}", f"S{i} 0.81 dB", [x, 0.0, z], rank, anchors=ANCHORS)
    labels.arrange(EYE)
    shown = _shown(labels, scene)
    for i, (one, _) in enumerate(shown):
        for other, _ in shown[i + 1 :]:
            assert np.any((one[:2] >= other[2:]) | (other[:2] >= one[2:]))
    assert min(rank for _, rank in shown) == min(rank for _, _, rank in places)


def test_the_worse_node_keeps_its_label() -> None:
    """Of two labels at one place with one anchor the worst node's stays; the other is back when it moves."""
    scene = _Scene()
    labels = Labels(scene)  # type: ignore[arg-type]
    labels.put("/a", "tick", [0.0, 0.0, 0.0], Rank.SCALE)
    labels.put("/b", "S1 0.81 dB", [0.0, 0.0, 0.0], Rank.WORST)
    labels.arrange(EYE)
    assert (scene.handles["/a"].visible, scene.handles["/b"].visible) == (False, True)
    labels.put("/b", "S1 0.81 dB", [20.0, 0.0, 0.0], Rank.WORST)
    labels.arrange(EYE)
    assert scene.handles["/a"].visible


def test_nothing_is_under_what_covers_the_canvas() -> None:
    """A label that would be under the overlay goes to another side of its place, or away."""
    scene = _Scene()
    labels = Labels(scene)  # type: ignore[arg-type]
    labels.put("/a", "0.81 dB", [0.0, 0.0, 0.0], Rank.VALUE, anchors=ANCHORS)
    labels.put("/b", "0.81 dB", [-20.0, 0.0, 0.0], Rank.VALUE, anchors=ANCHORS)
    labels.arrange(EYE, np.array([[0.0, 0.0, 490.0, 800.0]]))
    assert (scene.handles["/a"].visible, scene.handles["/a"].anchor) == (True, "center-left")
    assert not scene.handles["/b"].visible


def test_what_stays_as_it_was_is_not_sent() -> None:
    """The same labels put and arranged again send nothing."""
    scene = _Scene()
    labels = Labels(scene)  # type: ignore[arg-type]
    for _ in range(2):
        sent = scene.sent
        for i in range(6):
            labels.put(f"/{i}", "S1", [0.2 * i, 0.0, 0.0], Rank.POINT, anchors=ANCHORS)
        labels.arrange(EYE)
    assert scene.sent == sent
    labels.drop("/")
    assert scene.handles == {}


@pytest.mark.parametrize("text", ["0.98 dB, certified to 1e-6, verifiable", "S1 \u221212.34 dB, worst"])
def test_a_box_is_as_wide_as_its_text(text: str) -> None:
    """The box holds the text as Arial and its like draw it, and is not much wider."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    handle = SimpleNamespace(text=text, font_screen_scale=1.0)
    left, _, right, _ = _box_px(handle, "center-left", 0.0, 0.0)
    path = TextPath((0.0, 0.0), text, size=12.0, prop=FontProperties(family="DejaVu Sans"))
    drawn = 0.9 * path.get_extents().width  # which is a tenth wider than Arial
    assert drawn < right - left < 1.35 * drawn
