"""Given axes: the expansions enclose the links they stand for, and what they exclude is excluded."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, strategies as st
from sizes import few_examples
from tests.certificate.plain import (
    boxes_at,
    dense_ratios,
    excess_over,
    make_leaves,
    one_box,
    random_family,
    seeds,
)

from nullpose.certificate.affine_test import _quadratic_negative, affine_holds, link as link_over
from nullpose.certificate.certificate import AFFINE
from nullpose.certificate.channels import excess
from nullpose.certificate.interval import Interval
from nullpose.certificate.pose_value import Exact, exact, link
from nullpose.channel import LinkChannel
from nullpose.problem.axis_field import AxisField

SIX = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
POINTS = np.array([[0.0, 0.0, 0.0], [0.0, 50.0, 0.0], [17.0, 15.0, 4.0], [31.7, -8.3, 1.1]])
NO_DIPOLE = np.zeros((1, 3))
DIPOLES = (NO_DIPOLE, np.array([[0.0, 0.0, 1.0]]), np.array([[0.36, -0.48, 0.8]]))
FIELDS = [
    AxisField.vertical(),
    AxisField.towards(POINTS[2]),
    AxisField.broadside(POINTS[0], POINTS[1]),
    AxisField.broadside(POINTS[1], POINTS[3]),
]
FIELD = st.sampled_from(FIELDS[:3])


def exact_link(
    field: AxisField,
    point: np.ndarray,
    p: Exact,
    leak: float = 0.0,
    dipole: np.ndarray = NO_DIPOLE,
    through: float = 0.0,
) -> Fraction:
    """Return a link's gain over ``|r|^2`` at a position with the field's axis, exactly."""
    axis = exact(field.offset) + exact(field.matrix) @ p
    return link(exact(point), p, axis, Fraction(leak), exact(dipole[0]), Fraction(through))


def ends(x: Interval) -> tuple[Fraction, Fraction]:
    """Return the exact ends of an interval of one box; none must be undefined."""
    return Fraction(float(x.low[0])), Fraction(float(x.high[0]))


def times(x: Interval, factor: Fraction) -> tuple[Fraction, Fraction]:
    """Return the exact ends of a multiple."""
    low, high = (end * factor for end in ends(x))
    return min(low, high), max(low, high)


@pytest.mark.parametrize("field", FIELDS)
@given(
    leak=st.sampled_from([0.0, 0.01]),
    dipole=st.sampled_from(DIPOLES),
    through=st.sampled_from([0.0, 0.3]),
    seed=seeds,
)
def test_expansions_enclose_the_links(
    field: AxisField, leak: float, dipole: np.ndarray, through: float, seed: int
) -> None:
    """The exact link at any position of a box lies within value, slopes and second derivatives."""
    rng = np.random.default_rng(seed)
    boxes, j = one_box(rng), int(rng.integers(4))
    jet = link_over(field, boxes, POINTS[j][None], leak, dipole, np.array([through]))
    (value, slopes, _), (ranged, _, hessian) = jet.at, jet.over
    if not np.all(np.isfinite(hessian.low) & np.isfinite(hessian.high)):
        return
    centre, half = exact(boxes.centre[0]), exact(boxes.half[0])
    assert ends(value)[0] <= exact_link(field, POINTS[j], centre, leak, dipole, through) <= ends(value)[1]
    for shares in rng.integers(-8, 9, (4, 3)):
        x = [Fraction(int(s), 8) * h for s, h in zip(shares, half, strict=True)]
        there = exact_link(field, POINTS[j], centre + np.array(x), leak, dipole, through)
        terms = [ends(value)] + [times(slopes[i], d) for i, d in enumerate(x)]
        for entry, (i, k) in enumerate(SIX):
            terms.append(times(hessian[entry], x[i] * x[k] * (Fraction(1, 2) if i == k else 1)))
        assert sum(low for low, _ in terms) <= there <= sum(high for _, high in terms)
        assert ends(ranged)[0] <= there <= ends(ranged)[1]


@few_examples(10)
@given(field=FIELD, is_above=st.booleans(), seed=seeds)
def test_expansions_bound_the_links_of_channels(
    field: AxisField, is_above: bool, channel: LinkChannel | None, seed: int
) -> None:
    """A link with a channel, of any antennas, is at most what its jet says, or at least that."""
    rng = np.random.default_rng(seed)
    family, boxes, dipole = random_family(rng, 1, 1, channel=channel), one_box(rng), DIPOLES[seed % 3]
    gain = excess(family.ratios, boxes, np.zeros(1, dtype=np.int64), is_above)
    ratios = family.ratios
    jet = link_over(field, boxes, ratios.points_m[:1], ratios.leak, dipole, np.zeros(1), gain)
    bends = jet.over.bends
    assume(np.all(np.isfinite(bends.low) & np.isfinite(bends.high)))
    x = rng.uniform(-1.0, 1.0, (50, 3)) * boxes.half[0]
    there = [
        float(
            exact_link(
                field, family.ratios.points_m[0], exact(boxes.centre[0] + step), family.ratios.leak, dipole
            )
        )
        for step in x
    ] * excess_over(family, boxes.centre[0] + x)[:, 0]
    weights = np.array([x[:, i] * x[:, k] * (0.5 if i == k else 1.0) for i, k in SIX])
    taylor = jet.at.value + (jet.at.slopes * x.T).total() + (bends * weights).total()
    slack = 1e-12 * np.abs(there)
    for bound in (taylor, jet.over.value):
        assert np.all(there <= bound.high + slack if is_above else there >= bound.low - slack)


def quadratic(rng: np.random.Generator) -> tuple[float, np.ndarray, np.ndarray]:
    """Return a random quadratic on the unit cube whose largest value is near zero."""
    hessian = rng.normal(size=(3, 3)) * 10.0 ** rng.uniform(-2, 1)
    hessian = hessian + hessian.T - np.eye(3) * rng.uniform(0.0, 6.0)
    gradient = rng.normal(size=3) * 10.0 ** rng.uniform(-2, 1)
    grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 9)] * 3), -1).reshape(-1, 3)
    top = np.max(grid @ gradient + 0.5 * np.einsum("pi,ij,pj->p", grid, hessian, grid))
    size = np.abs(hessian).sum() + np.abs(gradient).sum()
    return float(-top + size * rng.uniform(-0.6, 0.1)), gradient, hessian


def test_negative_quadratics_are_negative() -> None:
    """What passes is negative at every position tried, also with the Hessian at its bounds; not in vain."""
    rng = np.random.default_rng(7)
    passed = missed = 0
    for _ in range(200):
        value, gradient, hessian = quadratic(rng)
        half = 10.0 ** rng.uniform(-2, 2, 3)
        slack = 10.0 ** rng.uniform(-8, -1) * np.abs(hessian).max()
        scaled = np.array([[hessian[i, k] / (half[i] * half[k])] for i, k in SIX])
        radius = np.array([[slack / (half[i] * half[k])] for i, k in SIX])
        slopes = Interval((gradient / half)[:, None])
        bounds = Interval(scaled - radius, scaled + radius)
        holds = _quadratic_negative(half[:, None], Interval([value]), slopes, bounds)[0]
        y = np.vstack([rng.uniform(-1, 1, (200, 3)), np.sign(rng.normal(size=(50, 3)))])
        noise = slack * np.triu(rng.choice([-1.0, 1.0], (len(y), 3, 3)))
        noise = noise + np.swapaxes(np.triu(noise, 1), 1, 2)
        tops = value + y @ gradient + 0.5 * np.einsum("pi,pij,pj->p", y, hessian + noise, y)
        if holds:
            passed += 1
            assert tops.max() < 0.0
        elif tops.max() < 0.0:
            missed += 1
    assert passed > 50
    assert missed < passed


@few_examples(2)
@given(field=FIELD, groups=st.sampled_from([1, 3]), seed=seeds)
def test_no_position_of_an_excluded_box_reaches_the_level(
    field: AxisField, groups: int, channel: LinkChannel | None, seed: int
) -> None:
    """Whatever mix or ball: allowed positions of excluded boxes stay below the level."""
    rng = np.random.default_rng(seed)
    count, ratios = 60, int(rng.integers(1, 4))
    keep_out_m = float(rng.choice([1.0, 20.0]))
    family = random_family(rng, ratios, 2, keep_out_m=keep_out_m, groups=groups, channel=channel)

    def axis(p: np.ndarray) -> np.ndarray:
        return field.offset + p @ field.matrix.T

    boxes = boxes_at(
        rng.uniform([-20.0, -20.0, 10.0], [80.0, 80.0, 30.0], (count, 3)),
        10.0 ** rng.uniform(-2.0, 0.5, (count, 3)),
    )
    at_centre = dense_ratios(family, boxes.centre, axis(boxes.centre)).min(axis=1)
    drawn = rng.dirichlet(np.ones(ratios), count)
    leaves = make_leaves(
        count,
        test=AFFINE,
        level=at_centre * 10.0 ** rng.uniform(-0.2, 0.8, count),
        mix=np.arange(count),
        mixes=tuple({int(k): float(w) for k, w in enumerate(row)} for row in drawn),
        ball=rng.integers(-1, len(family.ratios.points_m), count),
        ball_multiplier=10.0 ** rng.uniform(-4.0, 0.0, count) * rng.integers(0, 2, count),
    )
    with np.errstate(all="ignore"):
        holds = affine_holds(family, field, leaves, boxes)
    assume(np.any(holds))
    assert not np.all(holds)
    for b in np.flatnonzero(holds):
        p = boxes.centre[b] + rng.uniform(-1.0, 1.0, (20, 3)) * boxes.half[b]
        allowed = np.linalg.norm(family.ratios.points_m - p[:, None], axis=2).min(axis=1) >= keep_out_m
        assert np.all(dense_ratios(family, p, axis(p)).min(axis=1)[allowed] < leaves.level[b])


def test_a_mix_of_nothing_excludes_nothing() -> None:
    """Weights of zero prove nothing, also inside a ball."""
    family = random_family(np.random.default_rng(2), 2, 1, keep_out_m=5.0)
    boxes = boxes_at(family.ratios.points_m[:1] + np.array([3.0, 0.0, 0.0]), 0.1)
    leaves = make_leaves(1, level=1e6, mixes=({0: 0.0},), ball=0, ball_multiplier=1.0)
    with np.errstate(all="ignore"):
        assert not affine_holds(family, AxisField.vertical(), leaves, boxes)[0]
