"""Maximum gain as printed, for comparison with the paper only: eq. 3.5 to the letter, and its search."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from paper_schemes import maximum_gain_sinr
from scipy.optimize import differential_evolution

from nullpose.paper import JAMMER_POWER, paper_scenario, search_as_printed, sinr_as_printed
from nullpose.physics import to_db
from nullpose.scenario import Override, apply_overrides

SEEDS = st.integers(0, 2**32 - 1)


def positions_above(rng: np.random.Generator, count: int) -> np.ndarray:
    """Returns positions over the field, higher than every ground point."""
    return rng.uniform([-50.0, -50.0, 8.0], [150.0, 150.0, 60.0], (count, 3))


@given(seed=SEEDS, jammers=st.integers(1, 3))
def test_it_is_equation_3_5_to_the_letter(seed: int, jammers: int, random_scene: Callable) -> None:
    """It uses the cross product of the unit directions as it comes."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, 2, jammers)
    (position,) = positions_above(rng, 1)
    away = [np.array(node.position_m) - position for node in scene.nodes]
    product = np.cross(away[0] / math.hypot(*away[0]), away[1] / math.hypot(*away[1]))
    denominator = scene.receiver.noise_power_w
    for jammer in scene.jammers:
        to_jammer = np.array(jammer.position_m) - position
        distance = math.hypot(*to_jammer)
        gain = 1.0 - float(to_jammer / distance @ product) ** 2
        denominator += gain * jammer.transmit_power_w / distance**2
    expected = [
        node.transmit_power_w / float(r @ r) / denominator for node, r in zip(scene.nodes, away, strict=True)
    ]
    np.testing.assert_allclose(sinr_as_printed(scene, position), expected, rtol=1e-12)


@given(seed=SEEDS)
def test_it_hears_more_of_the_jammer(seed: int, random_scene: Callable) -> None:
    """Its gain towards a jammer is never smaller than an antenna's, so its SINR is never larger."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, 2, 2)
    positions = positions_above(rng, 50)
    printed, normalised = sinr_as_printed(scene, positions), maximum_gain_sinr(scene, positions)
    assert printed.shape == (50, 2)
    assert np.all(printed <= normalised * (1.0 + 1e-12))


def test_it_is_right_at_right_angles(scene: Callable) -> None:
    """Where the nodes are seen at right angles both forms agree."""
    square = scene([(10.0, 0.0, 0.0), (-10.0, 0.0, 0.0)], [(7.0, 20.0, 1.0)])
    position = np.array([0.0, 0.0, 10.0])
    np.testing.assert_allclose(
        sinr_as_printed(square, position), maximum_gain_sinr(square, position), rtol=1e-14
    )


@pytest.mark.parametrize("level", [0.1, 1.0, 10.0])
def test_the_search_by_differential_evolution(level: float) -> None:
    """Differential evolution on eq. 3.5 to the letter comes to the same value."""
    scene = apply_overrides(paper_scenario(), [Override(JAMMER_POWER, level)])
    searched = differential_evolution(
        lambda positions: -np.log(np.min(sinr_as_printed(scene, positions.T), axis=-1)),
        [(-40.0, 40.0), (0.0, 50.0), (8.0, 30.0)],
        seed=1,
        vectorized=True,
        updating="deferred",
        popsize=30,
        maxiter=600,
        tol=1e-12,
    )
    found = search_as_printed(paper_scenario(), level)
    assert found.min_sinr == pytest.approx(math.exp(-searched.fun), rel=1e-7)
    assert found.min_sinr == sinr_as_printed(scene, found.position_m).min()
    assert found.min_sinr_db == to_db(found.min_sinr)


def test_it_stays_equidistant_and_does_not_saturate() -> None:
    """The best position stays as far from both nodes, and its value keeps falling with the jamming power."""
    points = [search_as_printed(paper_scenario(), level) for level in (1.0, 100.0, 1e4)]
    for point in points:
        assert point.position_m[1] == pytest.approx(25.0, abs=1e-3)
    assert np.all(np.diff([point.min_sinr_db for point in points]) < -5.0)
