"""From a scenario to its family: the ratios are the SINRs, the domain is the airspace."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.certificate.plain import dense_ratios

from nullpose.physics import sinr
from nullpose.problem.build import build_family
from nullpose.scenario import Airspace, Jammer, Node, Receiver, Scenario

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, nodes=st.integers(1, 8), jammers=st.integers(0, 4))
def test_ratios_are_the_sinrs(seed: int, nodes: int, jammers: int, random_problem: Callable) -> None:
    """Recomputed from the arrays with dense matrices, the ratios are the SINRs of the physics (eq. 2.1)."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, nodes, jammers)
    position = rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0])
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    np.testing.assert_allclose(
        dense_ratios(build_family(scene), position, axis), sinr(scene, position, axis), rtol=1e-9, atol=1e-13
    )


def test_units_end_here() -> None:
    """The same powers in watts or dBm, and the same gain in dB or from a frequency, make the same ratios."""
    wavelength_m = 299792458.0 / 2.4e9

    def build(node: dict, receiver: dict) -> Scenario:
        return Scenario(
            airspace=Airspace(altitude_m=(8.0, 30.0)),
            receiver=Receiver(**receiver),
            nodes=(Node(position_m=(0.0, 0.0, 0.0), **node),),
            jammers=(Jammer(position_m=(9.0, 0.0, 0.0), **node),),
        )

    gain_db = 20.0 * np.log10(wavelength_m / (4.0 * np.pi))
    watts = build({"power_w": 0.1}, {"noise_w": 10.0**-12.5, "reference_gain_db": gain_db})
    decibels = build({"power_dbm": 20.0}, {"noise_dbm": -95.0, "frequency_hz": 2.4e9})
    one, other = build_family(watts), build_family(decibels)
    np.testing.assert_allclose(one.numerator_weight, other.numerator_weight, rtol=1e-13)
    np.testing.assert_allclose(one.denominator_weight, other.denominator_weight, rtol=1e-13)


def test_the_domain_is_the_airspace(random_problem: Callable) -> None:
    """Bounds left out are infinite, those given are kept, and the keep-out radius goes along."""
    rng = np.random.default_rng(1)
    free = build_family(random_problem(rng, 2, 1))
    np.testing.assert_array_equal(free.low_m, [-np.inf, -np.inf, 10.0])
    np.testing.assert_array_equal(free.high_m, [np.inf, np.inf, 40.0])
    boxed = build_family(random_problem(rng, 2, 1, x_m=(-5.0, 60.0), y_m=(0.0, 0.0), keep_out_m=2.5))
    np.testing.assert_array_equal(boxed.low_m, [-5.0, 0.0, 10.0])
    np.testing.assert_array_equal(boxed.high_m, [60.0, 0.0, 40.0])
    assert boxed.keep_out_m == 2.5


@pytest.mark.parametrize(
    ("keep_out_m", "kept"), [(1.0, []), (6.5, [0]), (8.0, [0]), (8.1, [0, 1]), (25.0, [0, 1, 2])]
)
def test_keep_out_balls_out_of_reach_are_left_out(keep_out_m: float, kept: list[int]) -> None:
    """Only the points whose keep-out ball reaches into the airspace are kept, a touching one not."""
    scene = Scenario(
        airspace=Airspace(altitude_m=(8.0, 30.0), x_m=(0.0, 50.0), keep_out_m=keep_out_m),
        receiver=Receiver(noise_w=1e-3, reference_gain_db=0.0),
        nodes=(
            Node(position_m=(10.0, 0.0, 2.0), power_w=1.0),  # 6 m under the floor
            Node(position_m=(30.0, 0.0, 0.0), power_w=1.0),  # 8 m under it
        ),
        jammers=(Jammer(position_m=(-12.0, 0.0, -8.0), power_w=1.0),),  # 20 m from the nearest edge
    )
    family = build_family(scene)
    np.testing.assert_array_equal(family.keep_out_points_m, family.points_m[kept])


@given(seed=SEEDS, keep_out_m=st.floats(0.5, 45.0))
def test_no_ball_that_matters_is_left_out(seed: int, keep_out_m: float, random_problem: Callable) -> None:
    """No position of the airspace lies inside the ball of a point that was left out."""
    rng = np.random.default_rng(seed)
    scene = random_problem(rng, 3, 2, x_m=(20.0, 45.0), keep_out_m=keep_out_m)
    family = build_family(scene)
    kept = {tuple(point) for point in family.keep_out_points_m}
    left_out = np.array([point for point in family.points_m if tuple(point) not in kept]).reshape(-1, 3)
    inside = rng.uniform([20.0, -60.0, 10.0], [45.0, 160.0, 40.0], (500, 3))
    inside[::2, 2] = 10.0
    distances = np.linalg.norm(inside[:, None] - left_out, axis=-1)
    assert np.all(distances >= keep_out_m)
