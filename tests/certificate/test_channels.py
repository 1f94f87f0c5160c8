"""Channels in interval arithmetic: amplitudes and excess gains over boxes enclose those of the models."""

from fractions import Fraction
from functools import partial

import numpy as np
import pytest
from tests.certificate.plain import boxes_at, excess_over, random_family, value_at
from tests.reference.whip import whip_rows

from nullpose.certificate.boxes import Boxes
from nullpose.certificate.channels import _profiles, amplitude, excess, excess_at, most_excess
from nullpose.certificate.forms import COLUMN, ROW
from nullpose.certificate.interval import Interval
from nullpose.certificate.pose_value import exact
from nullpose.certificate.taylor import coordinates
from nullpose.channel import ENVIRONMENTS, LinkChannel
from nullpose.channel.elevation import elevation_channel
from nullpose.channel.model import BY_ELEVATION, KNOTS
from nullpose.channel.power_law import constant_channel, power_law
from nullpose.channel.profile import knots_of, log_gain
from nullpose.problem.family import Family

BOXES, SAMPLES = 300, 200  # 60,000 samples for each channel and side
SLACK = 1e-12  # of the models, in double precision


def over_one_point(
    channel: LinkChannel | None, at_m: tuple[float, float, float] = (17.0, 15.0, 4.0)
) -> Family:
    """Return a family whose first point is at a place and has a channel."""
    family = random_family(np.random.default_rng(1), 1, 1, channel=channel)
    return family.changed(points_m=np.vstack([at_m, family.ratios.points_m[1:]]))


def boxes_about(rng: np.random.Generator, point_m: np.ndarray) -> Boxes:
    """Return boxes anywhere about a point: a third of them right over or under it, a third at its height."""
    way = rng.normal(size=(BOXES, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    reach = 10.0 ** rng.uniform(0.5, 2.5, (BOXES, 1))
    half = reach * 10.0 ** rng.uniform(-4.0, -0.7, (BOXES, 3))
    centre = point_m + way * reach
    over, level = slice(0, BOXES // 3), slice(BOXES // 3, 2 * BOXES // 3)
    centre[over, :2] = point_m[:2] + rng.uniform(-1.0, 1.0, (BOXES // 3, 2)) * half[over, :2]
    centre[over, 2] = point_m[2] + np.copysign(reach[over, 0], way[over, 2])
    centre[level, 2] = point_m[2] + rng.uniform(-1.0, 1.0, len(centre[level])) * half[level, 2]
    return boxes_at(centre, half)


def samples_of(rng: np.random.Generator, boxes: Boxes) -> tuple[np.ndarray, np.ndarray]:
    """Return steps from the centres of boxes, (boxes, samples, 3), and the positions there."""
    steps = rng.uniform(-1.0, 1.0, (len(boxes), SAMPLES, 3)) * boxes.half[:, None]
    steps[:, ::4] = np.sign(steps[:, ::4]) * boxes.half[:, None]  # corners
    return steps, boxes.centre[:, None] + steps


@pytest.mark.parametrize("is_above", [True, False])
def test_amplitudes_enclose_the_models(is_above: bool, channel: LinkChannel | None) -> None:
    """Value, slopes and second derivatives do, or an end of the range on the side that counts."""
    rng, family = np.random.default_rng(11), over_one_point(channel)
    boxes, first = boxes_about(rng, family.ratios.points_m[0]), np.zeros(BOXES, dtype=np.int64)
    if channel is None:
        return
    at, gradient, sizes = amplitude(family.ratios, boxes, first, is_above)
    steps, places = samples_of(rng, boxes)
    h, at_centre = (np.sqrt(excess_over(family, p)[..., 0]) for p in (places, boxes.centre))
    size = np.linalg.norm(steps, axis=2)
    value, (most, slope, bend) = at.high, (each.high for each in sizes)
    ends = (slope == 0.0) & (bend == 0.0)
    sign = 1.0 if is_above else -1.0
    bound = (value if is_above else at.low)[:, None]
    assert np.all((sign * h <= sign * bound + SLACK * h)[ends])
    assert np.all((most == value)[ends])
    inner = ~ends
    assert np.all((h <= (1.0 + SLACK) * most[:, None])[inner])
    near = SLACK * at_centre
    assert np.all(((at.low - near <= at_centre) & (at_centre <= value + near))[inner])
    slack = SLACK * most[:, None]
    change = h - at_centre[:, None]
    with np.errstate(invalid="ignore"):  # right over the point nothing is known: infinity times zero
        assert not np.any((np.abs(change) > slope[:, None] * size + slack)[inner])
        taylor = change - np.einsum("bsi,ib->bs", steps, gradient.middle())
        assert not np.any((np.abs(taylor) > 0.5 * bend[:, None] * size**2 + slack)[inner])
    assert np.count_nonzero(inner) > BOXES // 8
    # no slope is known right over a point
    assert np.all(ends[: BOXES // 3]) == (channel is not None and channel.row[0] == BY_ELEVATION)


@pytest.mark.parametrize("is_above", [True, False])
def test_excess_gains_enclose_the_models(is_above: bool, channel: LinkChannel | None) -> None:
    """Value, slopes and second derivatives do all over the box, or an end of the range."""
    rng, family = np.random.default_rng(12), over_one_point(channel)
    boxes, first = boxes_about(rng, family.ratios.points_m[0]), np.zeros(BOXES, dtype=np.int64)
    gain = excess(family.ratios, boxes, first, is_above)
    if gain is None:
        assert channel is None
        return
    steps, places = samples_of(rng, boxes)
    g = excess_over(family, places)[..., 0]
    (value, slopes, _), (over, steep, bends) = gain.at, gain.over
    ends = np.all(bends.high == 0.0, axis=0)
    low, high = over.low[:, None], over.high[:, None]
    slack = SLACK * g
    fine = g <= high + slack if is_above else g >= low - slack
    assert np.all(fine)
    inner = np.flatnonzero(~ends & np.all(np.isfinite(bends.high), axis=0))
    assert len(inner) > BOXES // 8
    steps, g, slack = steps[inner], g[inner].T, slack[inner].T
    assert np.all((low[inner].T - slack <= g) & (g <= high[inner].T + slack))
    x = np.moveaxis(steps, 2, 0).swapaxes(1, 2)  # (3, samples, boxes)
    weights = np.where((ROW == COLUMN)[:, None, None], 0.5, 1.0) * x[ROW] * x[COLUMN]
    value, slopes, steep, bends = (part[..., inner] for part in (value, slopes, steep, bends))
    first_order = (steep[:, None] * x).total() + value
    taylor = (slopes[:, None] * x).total() + (bends[:, None] * weights).total() + value
    for bound in (first_order, taylor):
        assert np.all((bound.low - slack <= g) & (g <= bound.high + slack))


def test_points_have_channels_of_their_own() -> None:
    """Each box takes the channel of its own point; the gains at a position contain those of the models."""
    rng = np.random.default_rng(13)
    rows = [
        power_law(3.0, 1.0).row,
        elevation_channel(*ENVIRONMENTS["urban"], average="db").row,
        constant_channel(1.0).row,
        elevation_channel(*ENVIRONMENTS["suburban"], average="power", exponent=2.6).row,
    ]
    family = random_family(rng, 2, 2).changed(channels=np.array(rows))
    places = np.array([[3.0, 4.0, 9.0], [50.0, 20.0, -7.0], [*family.ratios.points_m[1, :2], 12.0]])
    for place in places:
        gain = excess_at(family.ratios, exact(place))
        assert gain is not None
        expected = excess_over(family, place)
        assert np.all(gain.low <= expected * (1.0 + 1e-14))
        assert np.all(expected <= gain.high * (1.0 + 1e-14))
        assert np.all(gain.high - gain.low <= 1e-12 * gain.high)
    for is_above in (True, False):
        boxes = boxes_at(np.tile(places[0], (4, 1)), 0.3)
        together = excess(family.ratios, boxes, np.arange(4), is_above)
        assert together is not None
        for j in range(4):
            alone = excess(family.ratios, boxes.chosen([j]), np.array([j]), is_above)
            assert alone is not None
            many, one = together.over.value[j], alone.over.value[0]
            np.testing.assert_allclose([many.low, many.high], [one.low, one.high], rtol=1e-14)


def test_the_value_with_channels_is_a_lower_bound() -> None:
    """Numerators take the lower ends of the gains, denominators the upper ones."""
    family = random_family(np.random.default_rng(3), 2, 2, channel=power_law(2.7, 1.0))
    place, axis = np.array([10.0, 12.0, 15.0]), np.array([0.3, -0.8, 0.2])
    least = value_at(family, exact(place), exact(axis), gains=excess_at(family.ratios, exact(place)))
    wide = excess_at(family.ratios, exact(place) + Fraction(1, 10**17))
    other = value_at(family, exact(place), exact(axis), gains=wide)
    assert float(least) == pytest.approx(float(other), rel=1e-13)


@pytest.mark.parametrize("alpha", [1.6, 1.9, 2.5, 6.0])
def test_gains_fall_with_the_distance(alpha: float) -> None:
    """What bounds a gain beyond a distance bounds it there and farther; sight adds at most a factor of 1."""
    rng, none = np.random.default_rng(5), np.zeros(1000, dtype=np.int64)
    least = 10.0 ** rng.uniform(0.0, 4.0, len(none))
    in_city = elevation_channel(
        *ENVIRONMENTS["urban"], average="power", exponent=alpha, reference_distance_m=2.0
    )
    for channel in (power_law(alpha, 2.0), in_city):
        bound = most_excess(over_one_point(channel).ratios, none, least)
        for farther in (1.0, 1.0 + 1e-6, 7.0):
            square = least * farther
            gain = (np.sqrt(square) / 2.0) ** (2.0 - alpha) / square
            assert np.all(gain <= bound.high / least * (1.0 + 1e-14))
    city = over_one_point(elevation_channel(*ENVIRONMENTS["urban"], average="power"))
    assert np.all(most_excess(city.ratios, none, least).high == 1.0)
    assert np.all(most_excess(city.ratios._replace(channels=city.ratios.channels[:0]), none, least) == 1.0)


@pytest.mark.parametrize("jump", [0.0, 1e-3])
def test_tables_are_enclosed_though_their_parabolas_do_not_meet(jump: float) -> None:
    """Knots are rounded: however far a parabola ends from the next one's level, Taylor's ranges hold."""
    rng, knots = np.random.default_rng(6), knots_of(*np.array(whip_rows()).T)
    knots[:, 1] += jump * rng.uniform(-1.0, 1.0, len(knots))
    rows = np.array([*np.zeros(KNOTS), len(knots), *knots.ravel()])
    middle, half = rng.uniform(-1.5, 1.5, BOXES), 10.0 ** rng.uniform(-5.0, -1.0, BOXES)
    half = np.minimum(half, 0.5 * np.pi - np.abs(middle))
    angle = coordinates(Interval(middle[None]), Interval(middle - half, middle + half)[None])[0]
    gain = angle.of(partial(_profiles, np.tile(rows[:, None], BOXES)))
    x = half * rng.uniform(-1.0, 1.0, (SAMPLES, BOXES))
    exact_gain, slack = log_gain(rows, middle + x), 1e-12
    (value, slopes, _), bends = gain.at, gain.over.bends
    taylor = value + slopes[0] * x + bends[0] * (0.5 * x**2)
    for bound in (gain.over.value, taylor):
        assert np.all((bound.low - slack <= exact_gain) & (exact_gain <= bound.high + slack))
    family = over_one_point(None).changed(channels=np.tile(rows, (2, 1)))
    square, first = np.array([9.0]), np.zeros(1, dtype=np.int64)
    most = most_excess(family.ratios, first, square)
    assert np.max(exact_gain) <= np.log(most.high[0]) + 1e-15 <= 1e-12 + 4.0 * jump * len(knots)
