from collections.abc import Callable

import numpy as np
import pytest
from tests.certificate.plain import carried, link_matrix

from nullpose.certificate.forms import matrices
from nullpose.objectives import Ratios
from nullpose.solver.kernels.bounds.expansion import expand_point, frame_at
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD

POINTS = np.array([[0.0, 0.0, 0.0], [40.0, 10.0, 2.0], [17.0, 15.0, 4.0], [-20.0, 30.0, 1.0]])
FRAMES = [(WORLD, -1), (TOWARDS_POINT, 2)]


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
        frame = carried(kind == TOWARDS_POINT, POINTS[anchor], centre, p) @ basis
        for j in range(len(POINTS)):
            form, slopes = np.empty(6), np.empty((3, 6))
            up, down = expand_point(ratios, j, turning, centre, half, form, slopes)
            exact = frame.T @ link_matrix(POINTS[j] - p, leak) @ frame
            linear = matrices((form + (p - centre) @ slopes)[:, None])[0]
            error = np.linalg.eigvalsh(exact - linear)
            reach = 0.5 * np.sum((p - centre) ** 2)
            slack = 1e-11 * np.abs(form).max()
            assert error[0] >= down * reach - slack
            assert error[-1] <= up * reach + slack
            if j == turning.anchor:  # along the null all is multiplied by the leak
                along = (exact - linear)[2, 2]
                assert leak * down * reach - slack <= along <= leak * up * reach + slack
