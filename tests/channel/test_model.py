"""Channels of several points."""

from collections.abc import Iterator
from decimal import Decimal, localcontext
from itertools import product

import numpy as np
import pytest
from tests.certificate.plain import random_family

from nullpose.certificate.channels import excess_at
from nullpose.certificate.pose_value import exact
from nullpose.channel import CHANNELS, ENVIRONMENTS, LinkChannel, PointChannels, excess_gain
from nullpose.channel.elevation import DB_AVERAGE, elevation_channel
from nullpose.channel.model import BLOCKED, BY_ELEVATION, CONSTANT
from nullpose.channel.power_law import power_law
from nullpose.scenario.channel import Channel
from nullpose.solver.kernels.compiler.interpreted import python_of
from nullpose.solver.kernels.linear_algebra import channel as kernels

CASES = [
    CHANNELS["free-space"].make(is_interferer=False),
    CHANNELS["power-law"].make(exponent=3.0, reference_distance_m=2.0, is_interferer=False),
    *(
        CHANNELS["elevation"].make(**ENVIRONMENTS["urban"]._asdict(), average=average, is_interferer=False)
        for average in ("power", "db", "guaranteed")
    ),
    CHANNELS["elevation"].make(
        **ENVIRONMENTS["suburban"]._asdict(),
        average="power",
        exponent=2.7,
        reference_distance_m=3.0,
        is_interferer=False,
    ),
]


@pytest.mark.parametrize("shape", [(), (4,), (2, 3)])
def test_points_of_any_channel_together(shape: tuple[int, ...]) -> None:
    """Each point has the gain of its own channel, whatever stands beside it."""
    rng = np.random.default_rng(5)
    links = [CASES[place] for place in (3, 0, 1, 2, 5, 4, 1, 3)]
    away_m = rng.uniform([-90.0, -90.0, -80.0], [90.0, 90.0, -10.0], (*shape, len(links), 3))
    together = excess_gain(PointChannels.of(links), away_m)
    assert together.shape == (*shape, len(links))
    for place, link in enumerate(links):
        alone = excess_gain(PointChannels.of([link]), away_m[..., place, None, :])
        np.testing.assert_allclose(together[..., place, None], alone, rtol=1e-14)


@pytest.mark.parametrize("channel", CASES[2:5])
def test_strength_is_the_largest_gain(channel: object) -> None:
    """The excess gain by elevation is never above 1, and grows with the elevation."""
    away_m = np.array([[[100.0, 0.0, -up_m]] for up_m in (0.0, 1.0, 30.0, 100.0, 1e3, 1e7)])
    gain = excess_gain(PointChannels.of([channel]), away_m)[:, 0]
    assert np.all(np.diff(gain) >= 0.0)
    assert gain[-1] <= channel.strength


RTOL, UNIT = 1e-14, 2.0**-53
DIGITS = 60
_SCHEMA = Channel.model_json_schema()["properties"]

excess_in_sight, excess_jet = (
    python_of(getattr(kernel, "py_func", kernel)) for kernel in (kernels.excess_in_sight, kernels.excess_jet)
)


def allowed(key: str) -> tuple[float, float]:
    """Return the least and the largest number that a scenario may state for a key."""
    limits = next(part for part in _SCHEMA[key]["anyOf"] if "minimum" in part)
    return limits["minimum"], limits["maximum"]


def channels() -> Iterator[LinkChannel]:
    """Return channels with the numbers at the ends of what is allowed, and some between."""
    los, nlos = (0.0, 3.0), (0.0, 3.0, 21.0, 60.0, 120.0, 155.0, 165.0, allowed("nlos_loss_db")[1])
    for a, b, seen, hidden, average in product(
        (*allowed("a"), 9.61, 70.0), (*allowed("b"), 0.16, 1.0), los, nlos, ("power", "db")
    ):
        if hidden >= seen:
            yield elevation_channel(a, b, seen, hidden, average)
    for exponent, unit in product((*allowed("exponent"), 2.0001, 2.7), allowed("reference_distance_m")):
        yield power_law(exponent, unit)
        for environment, average in product(ENVIRONMENTS.values(), ("power", "db")):
            yield elevation_channel(*environment, average, exponent, unit)


def places() -> np.ndarray:
    """Return vectors from a ground point to the drone, from right below it to right above it."""
    rng = np.random.default_rng(4)
    angle = np.array([-90.0, -89.9, -45.0, -1e-6, 0.0, 1e-9, 0.5, 9.6, 30.0, 54.0, 69.9, 70.1, 89.0, 90.0])
    angle, turn = np.radians(angle), rng.uniform(0.0, 6.0, len(angle))
    way = np.column_stack([np.cos(angle) * np.cos(turn), np.cos(angle) * np.sin(turn), np.sin(angle)])
    return np.round(way * 10.0 ** rng.uniform(0.0, 4.0, (len(angle), 1)), 6)


def arctan(x: Decimal) -> Decimal:
    """Return an angle from its tangent: halved until its series converges fast."""
    for _ in range(10):
        x /= 1 + (1 + x * x).sqrt()
    return 1024 * sum(((-1) ** i * x ** (2 * i + 1) / (2 * i + 1) for i in range(12)), Decimal(0))


def gain_and_slack(row: tuple[float, ...], to_drone_m: np.ndarray) -> tuple[Decimal, float]:
    """Return an excess gain to 60 digits, and how far the rounding of an angle may move it, relatively.

    The exponent ``c - k theta`` is as uncertain as its two parts, and passes that on as steeply as the gain
    grows with it.
    """
    x, y, z = (Decimal(float(e)) for e in to_drone_m)
    _, exponent, unit, c, k, n, average = (Decimal(number) for number in row[:BLOCKED])
    level = (x * x + y * y).sqrt()
    law = ((level * level + z * z).sqrt() / unit) ** exponent
    if row[0] != BY_ELEVATION:
        return law, 0.0
    up = arctan(z / level) if level else 2 * arctan(Decimal(1)).copy_sign(z)
    e = (c - k * up).exp()
    p = 1 / (1 + e)
    gain = n ** (1 - p) if average == Decimal(DB_AVERAGE) else n + (1 - n) * p
    steep = -n.ln() if average == Decimal(DB_AVERAGE) else (1 - n) / gain
    return law * gain, float(steep * p * (1 - p)) * 4.0 * UNIT * float(1 + abs(c) + abs(k * up))


@pytest.fixture(scope="module")
def expected() -> list[tuple[LinkChannel, np.ndarray, Decimal, float]]:
    """Every channel at every place, with its gain and what rounding may do to it."""
    with localcontext(prec=DIGITS):
        return [(each, at, *gain_and_slack(each.row, at)) for each in channels() for at in places()]


def test_excess_gains_of_physics_and_kernels(
    expected: list[tuple[LinkChannel, np.ndarray, Decimal, float]],
) -> None:
    """Both are within 1e-14 of the gain, relatively, as far as an angle's last digit leaves it."""
    slopes, bends = np.zeros(3), np.zeros((3, 3))
    for channel, at, exact_gain, slack in expected:
        gain = float(exact_gain)
        tolerance = (RTOL + slack) * gain
        evaluated = float(excess_gain(PointChannels.of([channel]), -at[None])[0]) / channel.strength
        assert abs(evaluated - gain) <= tolerance, (channel, at)
        assert abs(excess_in_sight(np.array(channel.row), -at) - gain) <= tolerance, (channel, at)
        assert abs(excess_jet(np.array(channel.row), -at, slopes, bends) - gain) <= tolerance, (channel, at)


def test_the_verifier_encloses_excess_gains(
    expected: list[tuple[LinkChannel, np.ndarray, Decimal, float]],
) -> None:
    """Its interval contains the gain, and is wide by the rounding of its own steps alone."""
    channels, at, gains, slack = zip(*expected, strict=True)
    family = random_family(np.random.default_rng(1), len(at), 1)
    rows = np.array([*(channel.row for channel in channels), channels[0].row])
    points_m = np.vstack([-np.array(at), np.ones(3)])
    over = excess_at(family.changed(points_m=points_m, channels=rows).ratios, exact(np.zeros(3)))
    assert over is not None
    low, high = over.low[:-1], over.high[:-1]
    enclosed = zip(low.tolist(), gains, high.tolist(), strict=True)
    assert all(least <= gain <= most for least, gain, most in enclosed)
    assert np.all(high - low <= (20.0 * RTOL + 10.0 * np.array(slack)) * high)


@pytest.mark.parametrize("exponent", [1.6, 2.0, 2.7, 6.0])
def test_gain_at_the_reference_distance(exponent: float) -> None:
    """It is 1 there whatever the exponent, and falls by 10 times the exponent in dB for each decade."""
    links = PointChannels.of([power_law(exponent, 5.0)])
    for decades in (0, 1, 2):
        away = np.array([[3.0, 0.0, -4.0]]) * 10.0**decades
        gain = float(excess_gain(links, away)[0]) / float(np.sum(away**2))
        assert gain == pytest.approx(10.0 ** (-exponent * decades), rel=1e-12)


def test_free_space_is_a_power_law() -> None:
    """An exponent of 2 asks for nothing of the position, so that nothing is lost to rounding."""
    channel = power_law(2.0, 3.0)
    assert (channel.row[0], channel.strength) == (CONSTANT, 9.0)
