"""The jet of a link under an affine axis field, against the formula itself."""

from collections.abc import Callable

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.channel import LinkChannel, PointChannels, excess_gain
from nullpose.objectives import Ratios
from nullpose.problem.axis_field import AxisField
from nullpose.solver.kernels.bounds import enclosure
from nullpose.solver.kernels.bounds.enclosure import JET

axis_clearance, link_jet = plain(enclosure.axis_clearance), plain(enclosure.link_jet)
POINT = np.array([[17.0, 15.0, 4.0]])
DIPOLES = (None, np.array([[0.0, 0.0, 1.0]]), np.array([[0.36, -0.48, 0.8]]))
FIELDS = {
    "vertical": AxisField.vertical(),
    "null on the point itself's neighbour": AxisField.towards([-5.0, 30.0, 2.0]),
    "broadside": AxisField.broadside([0.0, 0.0, 0.0], [0.0, 50.0, 3.0]),
}
PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]


def link(
    field: AxisField, p: np.ndarray, leak: float, dipole: np.ndarray | None, through: float = 0.0
) -> float:
    """Return gain over ``|r|^2`` at a position, from the definition."""
    if through > 0.0:
        both = link(field, p, leak, dipole), link(field, p, leak, None)
        return (1.0 - through) * both[0] + through * both[1]
    offset, matrix = field.arrays.offset, field.arrays.matrix
    axis, r = offset + matrix @ p, POINT[0] - p
    if dipole is not None:
        a = dipole[0] / np.linalg.norm(r) - (dipole[0] @ r) * r / np.linalg.norm(r) ** 3
        return float((1.0 - leak) * (axis @ a) ** 2 / (axis @ axis) + leak * (a @ a))
    sine = np.linalg.norm(np.cross(axis, r)) / (np.linalg.norm(axis) * np.linalg.norm(r))
    return float((leak + (1.0 - leak) * sine**2) / (r @ r))


def boxes(seed: int, count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return centres and half sides of boxes away from the point."""
    rng = np.random.default_rng(seed)
    low, high = [-30.0, -30.0, 12.0], [50.0, 60.0, 25.0]
    return [(rng.uniform(low, high), 10.0 ** rng.uniform(-2.5, 0.4, size=3)) for _ in range(count)]


@pytest.mark.parametrize(
    ("field", "leak"), list(zip(FIELDS.values(), (0.0, 0.01, 0.0), strict=True)), ids=FIELDS
)
def test_a_jet_encloses_the_link(
    field: AxisField, leak: float, channel: LinkChannel | None, ratios_over: Callable[..., Ratios]
) -> None:
    """Value and gradient at the centre; over the box, the value and every second difference in bounds."""
    rng, jet, step = np.random.default_rng(2), np.empty(JET), 1e-3
    for number, (dipole, through) in enumerate([*((each, 0.0) for each in DIPOLES), (DIPOLES[2], 0.2)]):

        def at(p: np.ndarray, dipole: np.ndarray | None = dipole, through: float = through) -> float:
            free = link(field, p, leak, dipole, through)
            if channel is None:
                return free
            return float(free * excess_gain(PointChannels.of([channel]), POINT - p)[0] / channel.strength)

        ratios = ratios_over(POINT, leak, dipole, through, channel)
        for centre, half in boxes(3 + number, 2):
            link_jet(ratios, 0, True, field.arrays, centre, half, jet)
            if channel is not None and jet[0] > at(centre) * (1.0 + 1e-9):
                assert np.max(half) > 0.3  # the end of its range, in a large box
                continue
            assert jet[0] == pytest.approx(at(centre), rel=1e-9, abs=1e-15)
            slopes = [(at(centre + 1e-4 * e) - at(centre - 1e-4 * e)) / 2e-4 for e in np.eye(3)]
            np.testing.assert_allclose(jet[1:4], slopes, rtol=1e-5, atol=1e-9)
            for p in centre + rng.uniform(-1.0, 1.0, size=(3, 3)) * half:
                assert jet[16] * (1.0 - 1e-12) <= at(p) <= jet[17] * (1.0 + 1e-12)
                for entry, (i, k) in enumerate(PAIRS):
                    a, b = step * np.eye(3)[i], step * np.eye(3)[k]
                    second = at(p + a + b) - at(p + a - b) - at(p - a + b) + at(p - a - b)
                    error = abs(second / (4.0 * step * step) - jet[4 + entry])
                    assert error <= jet[10 + entry] * (1.0 + 1e-3) + 1e-8


def test_the_enclosure_tightens_with_the_box(ratios_over: Callable[..., Ratios]) -> None:
    """Halving a small box halves the Hessian's radius: the bound is of third order."""
    jet = np.empty(JET)
    radii = []
    for scale in (1e-2, 5e-3):
        here = FIELDS["broadside"].arrays, np.array([3.0, 20.0, 9.0]), np.full(3, scale)
        link_jet(ratios_over(POINT, 0.0), 0, True, *here, jet)
        radii.append(jet[10:16].copy())
    np.testing.assert_allclose(radii[0] / radii[1], 2.0, rtol=0.05)


def test_clearance_bounds_the_axis() -> None:
    """An affine axis differs from that at the centre by no more than the change that is stated."""
    rng = np.random.default_rng(4)
    field = FIELDS["broadside"]
    for centre, half in boxes(5, 20):
        length, change = axis_clearance(field.arrays, centre, half)
        at_centre = field.offset + field.matrix @ centre
        assert length == pytest.approx(np.linalg.norm(at_centre))
        for _ in range(10):
            other = field.offset + field.matrix @ (centre + rng.uniform(-1.0, 1.0, size=3) * half)
            assert np.linalg.norm(other - at_centre) <= change * (1.0 + 1e-12)
