from collections.abc import Callable

import numpy as np
import pytest

from nullpose.objectives import Ratios
from nullpose.solver.kernels.expansion import expand_point, frame_at
from nullpose.solver.kernels.records import TOWARDS_POINT, WORLD

POINTS = np.array([[0.0, 0.0, 0.0], [40.0, 10.0, 2.0], [17.0, 15.0, 4.0], [-20.0, 30.0, 1.0]])
FRAMES = [(WORLD, -1), (TOWARDS_POINT, 2)]


def matrix_of(form: np.ndarray) -> np.ndarray:
    """Return the 3x3 matrix of a form kept as six numbers."""
    xx, yy, zz, xy, xz, yz = form
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def link_matrix(r: np.ndarray, leak: float) -> np.ndarray:
    """Return a link's form, ``T(r)`` of the physics primer without a leak, densely."""
    return (np.eye(3) * (r @ r) - (1.0 - leak) * np.outer(r, r)) / (r @ r) ** 2


def carried_frame(kind: int, anchor: int, centre: np.ndarray, basis: np.ndarray, p: np.ndarray):
    """Return the frame carried from the centre to p along a straight line, by many small turns."""
    frame = basis.copy()
    steps = 2000
    for i in range(steps):
        a = centre + (p - centre) * i / steps
        b = centre + (p - centre) * (i + 1) / steps
        if kind == TOWARDS_POINT:
            d, e = POINTS[anchor] - a, POINTS[anchor] - b
        else:
            return frame
        d, e = d / np.linalg.norm(d), e / np.linalg.norm(e)
        axis = np.cross(d, e)
        cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        frame = (np.eye(3) + cross + cross @ cross / (1.0 + d @ e)) @ frame
    return frame


@pytest.mark.parametrize("leak", [0.0, 0.01, 0.5])
@pytest.mark.parametrize(("kind", "anchor"), FRAMES)
def test_expansion_encloses_the_forms(
    kind: int, anchor: int, leak: float, ratios_over: Callable[..., Ratios]
) -> None:
    """Value, slopes and remainder at the centre enclose the turned form of every point all over the box."""
    rng = np.random.default_rng(kind)
    ratios = ratios_over(POINTS, leak)
    for _ in range(12):
        centre = rng.uniform([-30.0, -30.0, 10.0], [50.0, 50.0, 25.0])
        half = rng.uniform(0.05, 1.5, size=3)
        basis = np.empty((3, 3))
        turning = frame_at(ratios, kind, anchor, centre, half, basis)
        assert basis.T @ basis == pytest.approx(np.eye(3), abs=1e-12)
        p = centre + rng.uniform(-1.0, 1.0, size=3) * half
        frame = carried_frame(kind, anchor, centre, basis, p)
        for j in range(len(POINTS)):
            form, slopes = np.empty(6), np.empty((3, 6))
            up, down = expand_point(ratios, j, turning, centre, half, form, slopes)
            exact = frame.T @ link_matrix(POINTS[j] - p, leak) @ frame
            linear = matrix_of(form + (p - centre) @ slopes)
            error = np.linalg.eigvalsh(exact - linear)
            reach = 0.5 * np.sum((p - centre) ** 2)
            slack = 1e-6 * np.abs(form).max()  # the frame is carried in small steps
            assert error[0] >= down * reach - slack
            assert error[-1] <= up * reach + slack
            if j == turning.anchor:  # along the null all is multiplied by the leak
                along = (exact - linear)[2, 2]
                assert leak * down * reach - slack <= along <= leak * up * reach + slack
