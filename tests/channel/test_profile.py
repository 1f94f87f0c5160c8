"""The profile of a ground antenna: its table at the rows, and between them nothing that the table has not."""

import math
from decimal import Decimal, localcontext
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.certificate.plain import random_family
from tests.reference.whip import whip_rows

from nullpose.certificate.channels import excess_at
from nullpose.certificate.pose_value import exact
from nullpose.channel import PointChannels, excess_gain
from nullpose.channel.elevation import ENVIRONMENTS, elevation_channel, with_profile
from nullpose.channel.model import KNOTS
from nullpose.channel.power_law import constant_channel
from nullpose.channel.profile import knots_of, log_gain, mean_gain
from nullpose.solver.kernels.bounds import link_field
from nullpose.solver.kernels.compiler.interpreted import python_of
from nullpose.solver.kernels.linear_algebra import channel as kernels

excess_in_sight, gain_by_elevation, relative_range = (
    python_of(getattr(kernel, "py_func", kernel))
    for kernel in (kernels.excess_in_sight, kernels.gain_by_elevation, link_field.relative_range)
)

TABLES = st.lists(st.tuples(st.floats(0.02, 30.0), st.floats(-60.0, 10.0)), min_size=2, max_size=12).map(
    lambda parts: rows_of(parts)
)


def rows_of(parts: list[tuple[float, float]]) -> list[list[float]]:
    """Return a table from steps of any sizes, stretched to the whole range, and gains."""
    steps, gains = zip(*parts, strict=True)
    ends = np.cumsum([0.0, *steps[1:]])
    elevations = -90.0 + 180.0 * ends / ends[-1]
    elevations[-1] = 90.0
    return np.column_stack([elevations, gains]).tolist()


def row_of(rows: list[list[float]]) -> np.ndarray:
    """Return the row of a channel in free space with a profile."""
    return np.array(with_profile(constant_channel(1.0), *zip(*rows, strict=True)).row)


@given(TABLES)
def test_the_gain_meets_the_table_and_rises_where_it_does(rows: list[list[float]]) -> None:
    """At every row, to rounding; and between two rows it is monotone and within both."""
    row = row_of(rows)
    elevations, gains = np.array(rows).T
    peak = gains.max()
    found = peak + 10.0 / math.log(10.0) * log_gain(row, np.radians(elevations))
    assert np.max(np.abs(found - gains)) <= 1e-12
    for (a, low), (b, high) in pairwise(rows):
        between = log_gain(row, np.radians(np.linspace(a, b, 50)))
        steps = np.diff(between) * math.copysign(1.0, high - low)
        assert np.all(steps >= -1e-12)


@given(TABLES)
def test_parabolas_meet_with_one_slope(rows: list[list[float]]) -> None:
    """What each has at its end is what the next begins with; right above and right below the slope is 0."""
    angle, log, slope = knots_of(*zip(*rows, strict=True)).T
    assert np.max(np.abs(np.diff(log) - 0.5 * (slope[1:] + slope[:-1]) * np.diff(angle))) <= 1e-13
    assert slope[0] == slope[-1] == 0.0


@given(TABLES, st.floats(-90.0, 90.0), st.floats(0.0, 60.0), st.sampled_from(["free", "power", "db"]))
def test_ranges_enclose_dense_samples(
    rows: list[list[float]], start_deg: float, size_deg: float, average: str
) -> None:
    """Of the gain, its relative slope and second derivative, and the root's; between any two elevations."""
    link = constant_channel(1.0)
    if average != "free":
        link = elevation_channel(*ENVIRONMENTS["urban"], average=average)
    row = np.array(with_profile(link, *zip(*rows, strict=True)).row)
    low, high = (math.radians(min(max(each, -89.999), 89.999)) for each in (start_deg, start_deg + size_deg))
    bounds = relative_range(row, math.tan(low), math.tan(high))
    samples = [gain_by_elevation(row, angle) for angle in np.linspace(low, high, 25)]
    for gain, first, second in samples:
        of_root = 0.5 * second - 0.25 * first * first
        for value, (least, most) in zip((gain, first, of_root, second), bounds, strict=True):
            slack = 1e-9 * max(abs(least), abs(most), 1e-300)
            assert least - slack <= value <= most + slack
    gains = [gain for gain, _, _ in samples]
    if average == "free" and high > low:  # the ends of the gain are exact
        spread = bounds[0][1] / bounds[0][0]
        assert spread <= max(gains) / min(gains) * (1.0 + 0.2 * math.log(spread) + 1e-9)


def expected_gain(row: np.ndarray, to_drone_m: np.ndarray) -> Decimal:
    """Return the gain of a profile to 60 digits, from its knots."""
    x, y, z = (Decimal(float(e)) for e in to_drone_m)
    level = (x * x + y * y).sqrt()
    tangent = z / level
    for _ in range(12):
        tangent /= 1 + (1 + tangent * tangent).sqrt()
    angle = 4096 * sum(((-1) ** i * tangent ** (2 * i + 1) / (2 * i + 1) for i in range(12)), Decimal(0))
    knots = [[Decimal(float(e)) for e in knot] for knot in row[KNOTS + 1 :].reshape(-1, 3)]
    at = max(i for i, knot in enumerate(knots[:-1]) if knot[0] <= angle or i == 0)
    (start, log, slope), (end, _, last) = knots[at], knots[at + 1]
    step = angle - start
    return (log + step * (slope + (last - slope) / (end - start) / 2 * step)).exp()


def test_excess_gains_keep_their_digits() -> None:
    """Physics, kernels and verifier agree with 60 decimal digits to 1e-14, as far as an angle leaves it."""
    rng = np.random.default_rng(3)
    links = [with_profile(constant_channel(1.0), *zip(*whip_rows(step), strict=True)) for step in (1.0, 10.0)]
    at = np.round(rng.normal(size=(60, 3)) * 10.0 ** rng.uniform(0.0, 3.0, (60, 1)), 6)
    family = random_family(np.random.default_rng(1), len(at) - 1, 1)
    for link in links:
        row = np.array(link.row)
        rows = np.tile(row, (len(at), 1))
        over = excess_at(family.changed(points_m=-at, channels=rows).ratios, exact(np.zeros(3)))
        assert over is not None
        for i, place in enumerate(at):
            with localcontext(prec=60):
                gain = expected_gain(row, place)
            angle = math.atan2(place[2], math.hypot(place[0], place[1]))
            steep = abs(gain_by_elevation(row, angle)[1])
            tolerance = float(gain) * (1e-14 + 4.0 * 2.0**-53 * steep)
            evaluated = float(excess_gain(PointChannels.of([link]), -place[None])[0])
            for found in (evaluated, excess_in_sight(row, -place)):
                assert abs(found - float(gain)) <= tolerance
            assert over.low[i] <= gain <= over.high[i]
            assert over.high[i] - over.low[i] <= float(gain) * (6e-13 + 1e-14 * steep)


def test_the_mean_of_a_whip_is_what_it_is_fed() -> None:
    """Power that is not lost is radiated, whatever the shape."""
    assert mean_gain(*zip(*whip_rows(1.0), strict=True)) == pytest.approx(1.0, rel=1e-3)
    assert mean_gain([-90.0, 90.0], [3.0, 3.0]) == pytest.approx(10.0**0.3)
