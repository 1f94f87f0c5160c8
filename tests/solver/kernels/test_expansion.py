from collections.abc import Callable

import numpy as np
import pytest
from tests.certificate.plain import carried, link_matrix
from tests.reference.plain_kernels import plain

from nullpose.certificate.forms import matrices
from nullpose.channel import LinkChannel, PointChannels, excess_gain
from nullpose.objectives import Ratios
from nullpose.solver.kernels.bounds import expansion
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD

expand_point, frame_at = plain(expansion.expand_point), plain(expansion.frame_at)
POINTS = np.array([[0.0, 0.0, 0.0], [40.0, 10.0, 2.0], [17.0, 15.0, 4.0], [-20.0, 30.0, 1.0]])
FIRST = np.zeros(1, dtype=np.int64)


@pytest.mark.parametrize(
    ("kind", "anchor", "leak"), [(WORLD, -1, 0.01), (TOWARDS_POINT, 2, 0.0), (TOWARDS_POINT, 2, 0.5)]
)
def test_expansion_encloses_the_forms(
    kind: int, anchor: int, leak: float, channel: LinkChannel | None, ratios_over: Callable[..., Ratios]
) -> None:
    """Value, slopes and remainder at the centre enclose the turned form of every point all over the box."""
    rng = np.random.default_rng(kind)
    ratios = ratios_over(POINTS, leak, channel=channel)
    for _ in range(12):
        centre = rng.uniform([-30.0, -30.0, 10.0], [50.0, 50.0, 25.0])
        half = rng.uniform(0.05, 1.5, size=3)
        basis = np.empty((3, 3))
        turning = frame_at(ratios, kind, anchor, centre, half, basis)
        assert basis.T @ basis == pytest.approx(np.eye(3), abs=1e-12)
        p = centre + rng.uniform(-1.0, 1.0, size=3) * half
        frame = carried(kind == TOWARDS_POINT, POINTS[anchor], centre, p) @ basis
        for j in range(len(POINTS)):
            exact = frame.T @ link_matrix(POINTS[j] - p, leak) @ frame
            if channel is not None:
                gains = PointChannels(np.ones(1), np.array([channel.row]), ((channel.excess, FIRST),))
                exact *= excess_gain(gains, POINTS[j] - p[None])[0]
            for is_above, sign in ((True, 1.0), (False, -1.0)):
                form, slopes = np.empty(6), np.empty((3, 6))
                bend, _ = expand_point(ratios, j, is_above, turning, centre, half, form, slopes)
                error = sign * (exact - matrices((form + (p - centre) @ slopes)[:, None])[0])
                rest = 0.5 * np.sum((p - centre) ** 2) * bend + 1e-11 * np.abs(form).max()
                assert np.linalg.eigvalsh(error)[-1] <= rest
                if j == turning.anchor:  # along the null all is multiplied by the leak
                    assert error[2, 2] <= leak * rest + 1e-11 * np.abs(form).max()
