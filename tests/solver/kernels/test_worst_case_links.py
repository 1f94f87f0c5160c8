"""The strongest link over a ball or an ellipsoid."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from tests.reference.plain_kernels import plain

from nullpose.antenna import QuadraticAntenna
from nullpose.channel.model import WIDTH
from nullpose.physics.gain import dipole_gain
from nullpose.solver.kernels.search import worst_case_links
from nullpose.solver.kernels.search.set_links import Sets

clearance, strongest_link = plain(worst_case_links.clearance), plain(worst_case_links.strongest_link)
SEEDS = st.integers(0, 2**32 - 1)
LOOSE, ROUNDING = 1e-3, 1e-12


def ball(radius: float) -> Sets:
    """Returns the set of one ball."""
    radii = np.array([radius])
    return Sets(radii, np.zeros((1, 3, 3)), np.zeros((1, 3)), np.zeros((1, 3)), radii, np.zeros((0, WIDTH)))


def ellipsoid(axes: np.ndarray, semi: np.ndarray) -> Sets:
    """Returns the set of one ellipsoid, its axes being columns."""
    return Sets(
        np.array([-1.0]),
        np.ascontiguousarray(axes.T[None]),
        np.array([semi]),
        np.zeros((1, 3)),
        np.ones(1),
        np.zeros((0, WIDTH)),
    )


def strongest(sets: Sets, y: np.ndarray, q: np.ndarray, tolerance: float) -> tuple[float, float, np.ndarray]:
    """Returns what is attained, the upper bound, and the place."""
    attained, upper, place = strongest_link(sets, 0, tuple(y), tuple(q), 0.0, tolerance)
    return attained, upper, np.array(place)


def unit(rng: np.random.Generator, *shape: int) -> np.ndarray:
    """Returns unit vectors."""
    vectors = rng.normal(size=(*shape, 3))
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def root_link(y: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Returns the square root of a link, ``|y x q| / |q|^2``."""
    return np.asarray(np.linalg.norm(np.cross(y, q), axis=-1) / np.sum(q**2, axis=-1))


def an_ellipsoid(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns axes, half lengths and a centre such that the origin is well outside."""
    semi = 10.0 ** rng.uniform(-2.0, 1.0, 3)
    axes = Rotation.from_quat(rng.normal(size=4)).as_matrix()
    way = unit(rng)
    reach = float(np.linalg.norm(semi * (axes.T @ way)))
    return axes, semi, (reach + 10.0 ** rng.uniform(-0.5, 1.5)) * way


@given(seed=SEEDS)
def test_ball_in_closed_form(seed: int) -> None:
    """No point of the ball is louder than the closed form, and the place it names is that loud."""
    rng = np.random.default_rng(seed)
    q, y = 20.0 * rng.normal(size=3), unit(rng)
    if seed % 3 == 0:  # the null points into the ball
        y = unit(rng) * 1e-3 + q / np.linalg.norm(q)
        y /= np.linalg.norm(y)
    radius = float(rng.uniform(0.0, 0.9)) * float(np.linalg.norm(q))
    value, upper, place = strongest(ball(radius), y, q, LOOSE)
    assert value <= upper <= value * (1.0 + ROUNDING) + ROUNDING
    assert float(np.linalg.norm(place - q)) <= radius * (1.0 + 1e-9) + 1e-12
    assert root_link(y, place) == pytest.approx(value, rel=1e-9)
    inside = q + radius * unit(rng, 2000) * rng.choice([1.0, 0.9, 0.5], (2000, 1))
    assert np.all(root_link(y, inside) <= value * (1.0 + 1e-12))


def test_a_ball_around_the_drone_has_no_bound() -> None:
    """Where the jammer may be at the drone itself its link is infinite."""
    q, y = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    for sets in (ball(1.0), ellipsoid(np.eye(3), np.array([2.0, 1.0, 1.0]))):
        assert strongest(sets, y, q, LOOSE)[1] == math.inf
        assert clearance(sets, 0, tuple(q)) <= 0.0


def test_the_two_values_of_nearly_every_ellipsoid_are_as_near_as_asked_for() -> None:
    """Of flat ones that the antenna points at, six in a thousand keep a looser bound."""
    near = []
    for seed in range(200):
        rng = np.random.default_rng(seed)
        axes, semi, q = an_ellipsoid(rng)
        y = unit(rng) if seed % 2 else q / np.linalg.norm(q)
        value, upper, _ = strongest(ellipsoid(axes, semi), y, q, 1e-3)
        near.append(upper <= value * (1.0 + 1.1e-3) + 1e-12)
    assert np.mean(near) > 0.98


@given(seed=SEEDS, tolerance=st.sampled_from([1e-2, 1e-3, 1e-5]))
def test_ellipsoid_between_its_two_values(seed: int, tolerance: float) -> None:
    """The place named is inside and as loud as told; no point of the ellipsoid is above the upper bound."""
    rng = np.random.default_rng(seed)
    axes, semi, q = an_ellipsoid(rng)
    y = unit(rng) if seed % 2 else q / np.linalg.norm(q)
    value, upper, place = strongest(ellipsoid(axes, semi), y, q, tolerance)
    assert value <= upper
    assert root_link(y, place) == pytest.approx(value, rel=1e-9)
    assert float(np.linalg.norm((axes.T @ (place - q)) / semi)) <= 1.0 + 1e-9
    x = unit(rng, 4000)
    points = q + (x * semi) @ axes.T
    assert np.all(root_link(y, points) <= upper)
    best = x[np.argmax(root_link(y, points))]
    climbed = minimize(
        lambda x: -float(root_link(y, q + axes @ (semi * x / np.linalg.norm(x)))), best, method="Nelder-Mead"
    )
    assert -climbed.fun <= upper


@given(seed=SEEDS)
def test_clearance_is_a_lower_bound(seed: int) -> None:
    """No point of the set is nearer to the drone than its clearance, which is positive outside."""
    rng = np.random.default_rng(seed)
    axes, semi, q = an_ellipsoid(rng)
    points = q + (unit(rng, 2000) * semi) @ axes.T
    least = clearance(ellipsoid(axes, semi), 0, tuple(q))
    assert 0.0 < least <= float(np.min(np.linalg.norm(points, axis=1)))
    radius = 0.5 * float(np.linalg.norm(q))
    assert clearance(ball(radius), 0, tuple(q)) == pytest.approx(radius, rel=1e-14)


@given(seed=SEEDS, leak=st.sampled_from([0.0, 1e-4, 0.01, 0.3]), has_dipole=st.booleans())
def test_antennas_that_leak_and_dipoles(seed: int, leak: float, has_dipole: bool) -> None:
    """No place in an ellipsoid is above the bound, which is close where the set is not huge."""
    rng = np.random.default_rng(seed)
    axes, semi, q = an_ellipsoid(rng)
    y, axis = unit(rng) if seed % 2 else q / np.linalg.norm(q), unit(rng) if has_dipole else np.zeros(3)
    semi = np.full(3, np.min(semi)) if seed % 3 == 0 else semi
    sets = ellipsoid(axes, semi)._replace(dipoles=axis[None])
    attained, upper, place = strongest_link(sets, 0, tuple(y), tuple(q), leak, LOOSE)
    points = np.vstack([q + (unit(rng, 4000) * semi) @ axes.T, place])
    if has_dipole:
        antenna = QuadraticAntenna(name="", label="", leak=leak)
        gains = dipole_gain(np.zeros(3), y, points, np.tile(axis, (len(points), 1)), antenna)
        roots = np.sqrt(gains) / np.linalg.norm(points, axis=1)
    else:
        roots = np.hypot(root_link(y, points), np.sqrt(leak) * (points @ y) / np.sum(points**2, axis=-1))
    assert np.all(roots <= upper)
    assert roots[-1] == pytest.approx(attained, rel=1e-9)
    if np.max(semi) < 0.2 * np.linalg.norm(q):
        assert upper <= attained * (1.0 + LOOSE)
