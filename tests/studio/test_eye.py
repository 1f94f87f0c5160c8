"""What a camera sees."""

import numpy as np
import pytest
from hypothesis import given, seed, strategies as st

from nullpose.studio.eye import Eye

CANVASES = st.sampled_from([(1280.0, 800.0), (890.0, 800.0), (390.0, 844.0), (1920.0, 1080.0)])
POINTS = st.lists(st.tuples(*3 * [st.floats(-500.0, 500.0)]), min_size=2, max_size=12, unique=True)


def test_the_middle_and_the_edge_are_where_they_should_be() -> None:
    """The point looked at is in the middle; half the angle up is the upper edge."""
    eye = Eye([10.0, 0.0, 0.0], [0.0, 0.0, 0.0], np.pi / 2, 640.0, 480.0)
    middle, above, right = eye.pixels([[0.0, 0.0, 0.0], [0.0, 0.0, 10.0], [0.0, 5.0, 0.0]])
    assert middle == pytest.approx([320.0, 240.0, 10.0])
    assert above == pytest.approx([320.0, 0.0, 10.0])
    assert right == pytest.approx([440.0, 240.0, 10.0])


def test_a_camera_that_was_moved_is_left_alone() -> None:
    """A canvas of another size asks for a new fit, but not when the camera is elsewhere."""
    fit = Eye([0.8, -0.5, 0.5], np.zeros(3), 1.3, 1280.0, 800.0).fitted(np.eye(3))
    assert not fit.is_resized(fit)
    assert fit._replace(width_px=890.0).is_resized(fit)
    assert not fit._replace(width_px=890.0, position_m=np.add(fit.position_m, 0.5)).is_resized(fit)


@seed(0)
@given(points=POINTS, canvas=CANVASES)
def test_all_points_are_on_the_canvas(points: list[tuple[float, ...]], canvas: tuple[float, float]) -> None:
    """At any aspect all points are seen with some room, and two of them touch that room's edges."""
    eye = Eye([0.8, -0.5, 0.5], np.zeros(3), 1.3, *canvas).fitted(points)
    pixels = eye.pixels(points)
    assert np.all(pixels[:, 2] > -1e-6)
    seen = pixels[pixels[:, 2] > 1e-3, :2]
    share = (seen / canvas - 0.5) / 0.5
    assert np.all(np.abs(share) <= 0.9 + 1e-6)
