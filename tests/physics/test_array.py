"""Arrays of vertical dipoles: steering, digital combining."""

import math
from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from array_beams import beam_sinr
from hypothesis import given, strategies as st
from scipy.linalg import eigh

from nullpose.physics import sinr
from nullpose.physics.array import (
    array_channels,
    digital_sinr,
    digital_weights,
    element_positions,
    steering_vectors,
)
from nullpose.scenario import Scenario

VERTICAL = np.array([0.0, 0.0, 1.0])
SEEDS = st.integers(0, 2**32 - 1)
NODES = st.integers(1, 4)
JAMMERS = st.integers(0, 3)
ELEMENTS = st.integers(1, 9)
LAYOUTS = st.sampled_from(["linear", "circular"])


def _channels(scene: Scenario, position_m: np.ndarray, elements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The channels of nodes and of jammers, one a row."""
    g0 = scene.receiver.reference_gain
    return (
        array_channels(position_m, elements, scene.node_positions_m, scene.node_powers_w, g0),
        array_channels(position_m, elements, scene.jammer_positions_m, scene.jammer_powers_w, g0),
    )


def _place(rng: np.random.Generator) -> np.ndarray:
    return rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0])


def _exact_sinr(channel: np.ndarray, jammers: np.ndarray, noise_w: float) -> float:
    """``h^H R^-1 h`` by Gaussian elimination in rational numbers, free of rounding.

    Of real numbers: a complex system of size k is a real one of size 2 k.
    """

    def real(matrix: np.ndarray) -> np.ndarray:
        parts = np.block([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]])
        return np.array([[Fraction(x) for x in row] for row in parts.tolist()], dtype=object)

    g, h = real(jammers.T), real(channel[:, None])[:, 0]
    rows, total = g @ g.T + Fraction(noise_w) * np.eye(2 * len(channel), dtype=int), Fraction(0)
    while len(h):  # R = L D L^T, so that h^T R^-1 h is the sum of (L^-1 h)^2 / D
        share = rows[1:, 0] / rows[0, 0]
        total += h[0] ** 2 / rows[0, 0]
        rows, h = rows[1:, 1:] - np.outer(share, rows[0, 1:]), h[1:] - share * h[0]
    return float(total)


@given(elements=st.integers(2, 16), layout=LAYOUTS, spacing=st.floats(0.05, 3.0), yaw=st.floats(-4.0, 4.0))
def test_neighbours_are_the_spacing_apart(elements: int, layout: str, spacing: float, yaw: float) -> None:
    """Neighbours stand the spacing apart, level, about the centre; yaw turns them as it turns the body."""
    places = element_positions(elements, layout, spacing, yaw)
    np.testing.assert_allclose(np.linalg.norm(np.diff(places, axis=0), axis=1), spacing, rtol=1e-12)
    if layout == "circular":
        assert np.linalg.norm(places[0] - places[-1]) == pytest.approx(spacing, rel=1e-12)
    np.testing.assert_allclose(places.mean(axis=0), 0.0, atol=1e-12)
    assert np.all(places[:, 2] == 0.0)
    turned = element_positions(elements, layout, spacing) @ np.array(
        [[math.cos(yaw), math.sin(yaw), 0.0], [-math.sin(yaw), math.cos(yaw), 0.0], [0.0, 0.0, 1.0]]
    )
    np.testing.assert_allclose(places, turned, atol=1e-12)


@given(seed=SEEDS, layout=LAYOUTS)
def test_phases_are_those_of_the_distances(seed: int, layout: str) -> None:
    """Far off, the phases are those of the distances from each element, counted in wavelengths."""
    rng = np.random.default_rng(seed)
    position, points = _place(rng), rng.uniform(0.0, 5.0, (3, 3))
    elements = element_positions(5, layout, 0.5, rng.uniform(0.0, 6.0))
    wavelength_m = 1e-5
    distances = np.linalg.norm(points[:, None] - (position + wavelength_m * elements), axis=-1)
    nearer = (np.linalg.norm(points - position, axis=-1)[:, None] - distances) / wavelength_m
    np.testing.assert_allclose(
        steering_vectors(position, elements, points), np.exp(2j * np.pi * nearer), atol=1e-4
    )


@pytest.mark.parametrize("case", ["apart", "two jammers as one", "a jammer at a node"])
@pytest.mark.parametrize("jamming_w", [1.0, 1e3, 1e5, 1e7, 1e9])
def test_digital_combining_keeps_its_digits(
    case: str, jamming_w: float, scene: Callable, random_scene: Callable
) -> None:
    """Close to singular it agrees with rational arithmetic, and with an eigenvalue solver while that can.

    The eigenvalue solver factorises R, and loses the digits that the strength of the jamming takes there; so
    it is compared to 1e-10 as far as it keeps them.
    """
    rng = np.random.default_rng(int(jamming_w) % 1009)
    for _ in range(8):
        nodes_m, jammers_m = rng.uniform(0.0, [60.0, 60.0, 4.0], (2, 3)), rng.uniform(0.0, 60.0, (3, 3))
        jammers_m[:, 2] /= 15.0
        if case == "two jammers as one":
            jammers_m[1] = jammers_m[0] + 1e-6
        elif case == "a jammer at a node":
            jammers_m[0] = nodes_m[0] + 1e-5
        field = scene(nodes_m, jammers_m, jammer_powers_w=jamming_w)
        position = rng.uniform([0.0, 0.0, 10.0], [60.0, 60.0, 30.0])
        places = element_positions(int(rng.integers(2, 5)), "circular", 0.5, rng.uniform(0.0, 6.0))
        heard, jamming = _channels(field, position, places)
        values = digital_sinr(field, position, places)
        expected = [_exact_sinr(h, jamming, field.receiver.noise_power_w) for h in heard]
        np.testing.assert_allclose(values, expected, rtol=1e-11)
        reached = beam_sinr(field, position, places, digital_weights(field, position, places))
        np.testing.assert_allclose(reached, expected, rtol=1e-11)
        if jamming_w <= 1e3:
            covariance = field.receiver.noise_power_w * np.eye(len(places)) + jamming.T @ jamming.conj()
            largest = [eigh(np.outer(h, h.conj()), covariance, eigvals_only=True)[-1] for h in heard]
            np.testing.assert_allclose(values, largest, rtol=1e-10)


@given(seed=SEEDS, nodes=NODES, jammers=JAMMERS, elements=ELEMENTS, layout=LAYOUTS)
def test_no_weights_beat_the_best(
    seed: int, nodes: int, jammers: int, elements: int, layout: str, random_scene: Callable
) -> None:
    """The digital weights have length 1 and reach the digital SINR, which no other weights exceed."""
    rng = np.random.default_rng(seed)
    scene, position = random_scene(rng, nodes, jammers), _place(rng)
    places = element_positions(elements, layout, 0.5, rng.uniform(0.0, 6.0))
    best = digital_sinr(scene, position, places)
    weights = digital_weights(scene, position, places)
    np.testing.assert_allclose(np.linalg.norm(weights, axis=-1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(beam_sinr(scene, position, places, weights), best, rtol=1e-9)
    others = rng.normal(size=(50, nodes, elements)) + 1j * rng.normal(size=(50, nodes, elements))
    near = weights + 0.01 * others
    for tried in (others, near):
        assert np.all(beam_sinr(scene, position, places, tried) <= best * (1.0 + 1e-9))


@given(seed=SEEDS, nodes=NODES, elements=ELEMENTS, layout=LAYOUTS)
def test_without_jammers_the_elements_add_up(
    seed: int, nodes: int, elements: int, layout: str, random_scene: Callable
) -> None:
    """K elements and no jammer give K times what one vertical dipole receives, and with one never more."""
    rng = np.random.default_rng(seed)
    scene, position = random_scene(rng, nodes, 2), _place(rng)
    silent = scene.model_copy(update={"jammers": ()})
    places = element_positions(elements, layout, 0.5, rng.uniform(0.0, 6.0))
    most = elements * sinr(silent, position, VERTICAL)
    np.testing.assert_allclose(digital_sinr(silent, position, places), most, rtol=1e-12)
    assert np.all(digital_sinr(scene, position, places) <= most * (1.0 + 1e-12))


@given(seed=SEEDS, jammers=JAMMERS)
def test_many_poses_at_once(seed: int, jammers: int, random_scene: Callable) -> None:
    """Positions and yaws of any leading shape give what each gives alone."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, 3, jammers)
    positions = rng.uniform([0.0, 0.0, 10.0], [90.0, 90.0, 40.0], (2, 5, 3))
    places = element_positions(4, "circular", 0.5, rng.uniform(0.0, 6.0, (2, 5)))
    digital = digital_sinr(scene, positions, places)
    weights = digital_weights(scene, positions, places)
    assert (digital.shape, weights.shape) == ((2, 5, 3), (2, 5, 3, 4))
    for at in np.ndindex(2, 5):
        one = (scene, positions[at], places[at])
        np.testing.assert_allclose(digital[at], digital_sinr(*one), rtol=1e-12)
        np.testing.assert_allclose(weights[at], digital_weights(*one), rtol=1e-9, atol=1e-12)


def test_a_node_that_is_not_heard_has_no_weights(scene: Callable) -> None:
    """Straight below the vehicle, in every dipole's null, a node has SINR 0 and weights 0."""
    below = scene([(0, 0, 0), (9, 0, 0)], [(5, 5, 0)])
    places = element_positions(3, "linear", 0.5)
    assert digital_sinr(below, [0.0, 0.0, 10.0], places)[0] == 0.0
    weights = digital_weights(below, [0.0, 0.0, 10.0], places)
    assert np.all(weights[0] == 0.0)
    assert np.linalg.norm(weights[1]) == pytest.approx(1.0)
