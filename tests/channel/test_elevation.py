"""Line of sight by elevation: published numbers, and the recommendation that it was fitted to."""

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.channel import ENVIRONMENTS, LinkChannel, PointChannels, excess_gain
from nullpose.channel.elevation import elevation_channel, sight_probability
from nullpose.channel.power_law import power_law

FREE_SPACE_2_GHZ_DB = 20.0 * math.log10(4.0 * math.pi * 2e9 / 299_792_458.0)

# Probability of line of sight, loss of the mean dB and of the mean power [dB] at 2 GHz, 100 m up, 300 m away:
# worked out apart from nullpose from the numbers of Al-Hourani et al. 2014.
LOSSES = {
    "suburban": (0.985846, 88.8642, 88.6298),
    "urban": (0.299262, 102.7824, 94.5817),
    "dense-urban": (0.142766, 108.4132, 98.3372),
    "high-rise": (0.017847, 121.9026, 108.0941),
}

# Recommendation ITU-R P.1410: share of built-up land, buildings per square km, scale of their heights [m].
BUILDINGS = {
    "suburban": (0.1, 750.0, 8.0),
    "urban": (0.3, 500.0, 15.0),
    "dense-urban": (0.5, 300.0, 20.0),
    "high-rise": (0.5, 300.0, 50.0),
}
LOW_M = 1.5


def loss_db(environment: str, average: str, up_m: float, away_m: float, is_interferer: bool = False) -> float:
    """Return the loss of a link at 2 GHz from a ground point to a drone so far up and away."""
    channel = elevation_channel(*ENVIRONMENTS[environment], average=average, is_interferer=is_interferer)
    gain = float(excess_gain(PointChannels.of([channel]), np.array([[away_m, 0.0, -up_m]]))[0])
    return FREE_SPACE_2_GHZ_DB + 20.0 * math.log10(math.hypot(up_m, away_m)) - 10.0 * math.log10(gain)


def probability(environment: str, up_m: float, away_m: float) -> float:
    """Return the probability of line of sight of a drone so far up and away."""
    row = np.array(elevation_channel(*ENVIRONMENTS[environment], average="power").row)
    return float(sight_probability(row, math.atan2(up_m, away_m)))


def recommended(built: tuple[float, float, float], up_m: float, away_m: float, low_m: float = LOW_M) -> float:
    """Return the probability that no building on the way is too high (P.1410, equation for roofs)."""
    alpha, beta, gamma_m = built
    count = max(0, math.floor(away_m / 1e3 * math.sqrt(alpha * beta) - 1.0) + 1)
    n = np.arange(count)
    ways_m = up_m - (n + 0.5) * (up_m - low_m) / max(1, count)
    return float(np.prod(1.0 - np.exp(-(ways_m**2) / (2.0 * gamma_m**2))))


@pytest.mark.parametrize("environment", LOSSES)
def test_losses_of_the_source(environment: str) -> None:
    """Each environment has the probability and both mean losses of its published numbers."""
    seen, of_db, of_power = LOSSES[environment]
    assert probability(environment, 100.0, 300.0) == pytest.approx(seen, abs=5e-7)
    assert loss_db(environment, "db", 100.0, 300.0) == pytest.approx(of_db, abs=5e-5)
    assert loss_db(environment, "power", 100.0, 300.0) == pytest.approx(of_power, abs=5e-5)


def test_a_drone_that_is_close() -> None:
    """A drone 30 m up and 20 m away is nearly always in sight: the angle counts in degrees."""
    assert probability("urban", 30.0, 20.0) == pytest.approx(0.994564, abs=5e-7)
    assert loss_db("urban", "db", 30.0, 20.0) == pytest.approx(70.7111, abs=5e-5)


@pytest.mark.parametrize("environment", ENVIRONMENTS)
def test_guaranteed_is_the_worst_of_both(environment: str) -> None:
    """A node is never in sight and an interferer always is; every mean lies between."""
    for up_m, away_m in ((5.0, 900.0), (100.0, 300.0), (300.0, 1.0)):
        worst = loss_db(environment, "guaranteed", up_m, away_m)
        best = loss_db(environment, "guaranteed", up_m, away_m, is_interferer=True)
        assert best <= loss_db(environment, "power", up_m, away_m) <= loss_db(environment, "db", up_m, away_m)
        assert loss_db(environment, "db", up_m, away_m) <= worst
        assert worst - best == pytest.approx(
            ENVIRONMENTS[environment].nlos_loss_db - ENVIRONMENTS[environment].los_loss_db
        )


@pytest.mark.parametrize(
    ("built", "up_m", "away_m", "expected"),
    [
        (BUILDINGS["suburban"], 50.0, 300.0, 0.765494),
        (BUILDINGS["urban"], 100.0, 300.0, 0.508333),
        (BUILDINGS["dense-urban"], 100.0, 100.0, 0.960023),
        (BUILDINGS["high-rise"], 100.0, 100.0, 0.402567),
        ((0.5, 400.0, 20.0), 50.0, 150.0, 0.17262622533505),
    ],
)
def test_numbers_of_the_recommendation(
    built: tuple[float, float, float], up_m: float, away_m: float, expected: float
) -> None:
    """The recommendation as it is written here has the numbers known of it; the last is public code's own."""
    assert recommended(built, up_m, away_m) == pytest.approx(expected, abs=5e-7)


@pytest.mark.parametrize(
    ("environment", "most"), [("suburban", 0.1), ("urban", 0.15), ("dense-urban", 0.25), ("high-rise", 0.55)]
)
def test_the_curve_follows_the_recommendation(environment: str, most: float) -> None:
    """The curve was fitted to it for platforms of 500 m and more; among towers it is rough."""
    for up_m in (500.0, 1000.0, 2000.0):
        for elevation_deg in range(5, 90, 5):
            away_m = (up_m - LOW_M) / math.tan(math.radians(elevation_deg))
            fitted = probability(environment, up_m - LOW_M, away_m)
            assert abs(fitted - recommended(BUILDINGS[environment], up_m, away_m)) < most


EXPONENTS = st.floats(1.6, 6.0)
LINKS_M = st.tuples(*[st.floats(-1e4, 1e4)] * 3).map(np.array).filter(lambda r: np.linalg.norm(r) > 1.0)
CURVES = st.tuples(st.floats(0.1, 90.0), st.floats(1e-3, 5.0))
AVERAGES = st.sampled_from(["power", "db", "guaranteed"])


def gain_of(channel: LinkChannel, to_point_m: np.ndarray) -> float:
    """Return the gain of a link over the reference gain."""
    excess = excess_gain(PointChannels.of([channel]), to_point_m[None])
    return float(excess[0] / np.sum(to_point_m**2))


@given(LINKS_M, st.sampled_from([*ENVIRONMENTS.values()]), AVERAGES, EXPONENTS, EXPONENTS)
def test_a_larger_exponent_leaves_less(
    link_m: np.ndarray, town: tuple[float, ...], average: str, one: float, other: float
) -> None:
    """Of every link longer than the reference distance; its share there is that of free space."""
    low, high, free = (
        elevation_channel(*town, average=average, exponent=exponent)
        for exponent in (*sorted((one, other)), 2.0)
    )
    assert gain_of(high, link_m) <= gain_of(low, link_m) * (1.0 + 1e-12)
    unit_m = link_m / np.linalg.norm(link_m)
    assert gain_of(high, unit_m) == pytest.approx(gain_of(free, unit_m), rel=1e-12)


@given(LINKS_M, CURVES, AVERAGES, st.floats(0.0, 30.0), EXPONENTS, st.floats(0.1, 10.0))
def test_losses_that_are_equal_leave_the_power_law(
    link_m: np.ndarray,
    curve: tuple[float, float],
    average: str,
    loss_db: float,
    exponent: float,
    unit_m: float,
) -> None:
    """With line of sight and without, a link loses the same then: as much less than by the law alone."""
    town = elevation_channel(*curve, loss_db, loss_db, average, exponent, unit_m)
    law = gain_of(power_law(exponent, unit_m), link_m)
    assert gain_of(town, link_m) == pytest.approx(10.0 ** (-0.1 * loss_db) * law, rel=1e-12)


@given(LINKS_M, st.sampled_from([*ENVIRONMENTS.values()]), AVERAGES, EXPONENTS, st.floats(0.1, 10.0))
def test_distance_and_elevation_are_factors(
    link_m: np.ndarray, town: tuple[float, ...], average: str, exponent: float, unit_m: float
) -> None:
    """The gain is that by elevation in free space times that of the law; 2 is free space."""
    plain = gain_of(elevation_channel(*town, average=average), link_m)
    law = gain_of(power_law(exponent, unit_m), link_m) * np.sum(link_m**2)
    both = elevation_channel(*town, average=average, exponent=exponent, reference_distance_m=unit_m)
    assert gain_of(both, link_m) == pytest.approx(plain * law, rel=1e-12)
    assert gain_of(elevation_channel(*town, average=average, exponent=2.0), link_m) == plain
