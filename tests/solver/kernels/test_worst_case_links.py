"""The strongest link over a ball."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.reference.plain_kernels import plain

from nullpose.antenna import QuadraticAntenna
from nullpose.channel.model import WIDTH
from nullpose.physics.gain import dipole_gain
from nullpose.solver.kernels.search import ball_links, worst_case_links
from nullpose.solver.kernels.search.set_links import Sets

strongest_link = plain(worst_case_links.strongest_link)
strongest_by_parts = plain(ball_links.strongest_by_parts)
SEEDS = st.integers(0, 2**32 - 1)
LOOSE, ROUNDING = 1e-3, 1e-12


def ball(radius: float) -> Sets:
    """Returns the set of one ball."""
    return Sets(np.array([radius]), np.zeros((1, 3)), np.zeros((0, WIDTH)))


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


def a_ball(rng: np.random.Generator) -> tuple[float, np.ndarray]:
    """Returns a radius and a centre such that the origin is well outside."""
    radius = 10.0 ** rng.uniform(-2.0, 1.0)
    return radius, (radius + 10.0 ** rng.uniform(-0.5, 1.5)) * unit(rng)


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
    for leak in (0.0, 0.1):
        assert strongest_link(ball(1.0), 0, tuple(y), tuple(q), leak, LOOSE)[1] == math.inf


@given(seed=SEEDS, tolerance=st.sampled_from([1e-2, 1e-3, 1e-5]))
def test_the_bound_by_parts_is_about_the_closed_form(seed: int, tolerance: float) -> None:
    """Without leak, dipole and channel lemma 3 has the closed form of lemma 2 between its two values."""
    rng = np.random.default_rng(seed)
    radius, q = a_ball(rng)
    y = unit(rng) if seed % 2 else q / np.linalg.norm(q)
    sets = ball(radius)
    value, upper, place = strongest_by_parts(sets, sets.channels, 0, tuple(y), tuple(q), 0.0, tolerance)
    largest = strongest(sets, y, q, tolerance)[0]
    assert value * (1.0 - 1e-9) <= largest <= upper * (1.0 + 1e-12)
    assert root_link(y, np.array(place)) == pytest.approx(value, rel=1e-9)
    assert float(np.linalg.norm(np.array(place) - q)) <= radius * (1.0 + 1e-9)


def test_the_two_values_of_nearly_every_ball_are_as_near_as_asked_for() -> None:
    """Of those that the antenna points at, some keep a looser bound."""
    near = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        radius, q = a_ball(rng)
        y, sets = unit(rng) if seed % 2 else q / np.linalg.norm(q), ball(radius)
        value, upper, _ = strongest_by_parts(sets, sets.channels, 0, tuple(y), tuple(q), 0.0, 1e-3)
        near.append(upper <= value * (1.0 + 1.1e-3) + 1e-12)
    assert np.mean(near) > 0.95


@given(seed=SEEDS, leak=st.sampled_from([0.0, 1e-4, 0.01, 0.3]), has_dipole=st.booleans())
def test_antennas_that_leak_and_dipoles(seed: int, leak: float, has_dipole: bool) -> None:
    """No place in a ball is above the bound, which is close where the set is not huge."""
    rng = np.random.default_rng(seed)
    radius, q = a_ball(rng)
    y, axis = unit(rng) if seed % 2 else q / np.linalg.norm(q), unit(rng) if has_dipole else np.zeros(3)
    sets = ball(radius)._replace(dipoles=axis[None])
    attained, upper, place = strongest_link(sets, 0, tuple(y), tuple(q), leak, LOOSE)
    points = np.vstack([q + unit(rng, 4000) * radius, place])
    if has_dipole:
        antenna = QuadraticAntenna(name="", label="", leak=leak)
        gains = dipole_gain(np.zeros(3), y, points, np.tile(axis, (len(points), 1)), antenna)
        roots = np.sqrt(gains) / np.linalg.norm(points, axis=1)
    else:
        roots = np.hypot(root_link(y, points), np.sqrt(leak) * (points @ y) / np.sum(points**2, axis=-1))
    assert np.all(roots <= upper)
    assert roots[-1] == pytest.approx(attained, rel=1e-9)
    if radius < 0.2 * np.linalg.norm(q):
        assert upper <= attained * (1.0 + LOOSE)
