"""What a leaf's multipliers make of a mean of ratios, and of pairs."""

from decimal import Decimal, localcontext
from fractions import Fraction

import numpy as np
from hypothesis import given, strategies as st

from nullpose import load
from nullpose.certificate.certificate import WORLD, Leaves
from nullpose.certificate.weighted_sum import mean_level, mix_slots, pair_factors, pairs_fit
from nullpose.problem.build import build_family

PLAIN = build_family(load("examples/paper.toml"))


def leaves_of_level(level: float, mix: dict[int, float]) -> Leaves:
    """Return one leaf without a cell, of a level and multipliers."""
    none = np.zeros(1)
    return Leaves(
        box=np.zeros((1, 6), dtype=np.int64),
        cell=np.array([[-1, 0, 0, 0, 0]]),
        test=np.array([WORLD]),
        point=np.array([-1]),
        level=np.array([level]),
        mix=np.array([0]),
        mixes=(mix,),
        sides=np.zeros((1, 2)),
        band=none,
        ball=np.array([-1]),
        ball_multiplier=none,
    )


@given(seed=st.integers(0, 2**32 - 1))
def test_no_ratios_of_that_mean_have_a_smaller_sum(seed: int) -> None:
    """Whatever the shares round to, ``sum_k q_k R_k`` of ratios with the mean t is no less than is returned.

    At the touching ratios, where both means are equal, it is not more by more than rounding.
    """
    rng = np.random.default_rng(seed)
    count, offset = int(rng.integers(1, 8)), float(rng.integers(2))
    weights = rng.uniform(0.1, 3.0, count)
    shares, q = weights / np.sum(weights), 10.0 ** rng.uniform(-3.0, 3.0, count)
    level = float(1.0 + offset + 10.0 ** rng.uniform(-2.0, 2.0))
    family = PLAIN.changed(shares=shares, offset=offset)
    slots = np.arange(count)[:, None]
    found = mean_level(family.ratios, slots, q[:, None], np.array([level]))
    with localcontext(prec=60):
        p, of_ratios = [Decimal(each) for each in shares.tolist()], [Decimal(each) for each in q.tolist()]
        # where the plane touches, but for a scale
        x = [share / each for share, each in zip(p, of_ratios, strict=True)]
        mean = sum(share * each.ln() for share, each in zip(p, x, strict=True))
        scale = ((Decimal(level).ln() - mean) / sum(p)).exp()
        least = sum(each * (scale * y - Decimal(offset)) for each, y in zip(of_ratios, x, strict=True))
    if least > 0 and not np.isnan(found.low[0]):
        assert Decimal(float(found.low[0])) <= least
        assert float(least) - found.low[0] <= 1e-11 * (float(least) + offset * np.sum(q))


@given(seed=st.integers(0, 2**32 - 1))
def test_sums_of_pairs_are_not_negative_where_all_quotients_are_met(seed: int) -> None:
    """In exact arithmetic, for denominators at which every quotient is t or more, and any e0 and weights."""
    rng = np.random.default_rng(seed)
    signals = 10.0 ** rng.uniform(-2.0, 2.0, 3)
    each = np.arange(3)
    family = PLAIN.changed(
        numerator_isotropic=1.0 + signals,
        numerator_weight=np.ones(3),
        numerator_point=each,
        denominator_of=each,
        denominator_isotropic=np.ones(3),
        pairs=np.array([[0, 2], [1, 2]]),
    )
    level = float(1.0 + 10.0 ** rng.uniform(-6.0, 1.0))
    weights, touched = 10.0 ** rng.uniform(-3.0, 3.0, (2, 2))
    mix = {0: weights[0], 1: weights[1], 2: touched[0], 3: touched[1] if rng.uniform() < 0.8 else 0.0}
    leaves = leaves_of_level(level, mix)
    identity, (first, second, jammed) = pair_factors(family.ratios, leaves, *mix_slots(leaves))
    t, e = Fraction(level), Fraction(float(10.0 ** rng.uniform(0.0, 3.0)))
    beyond = [Fraction(x) - 1 for x in family.ratios.numerator_isotropic.tolist()]
    b = [s * e / ((t - 1) * e + t * beyond[2]) for s in beyond[:2]]
    # the identity's multiple has the isotropic parts, 1 each; e and b are those and what is received
    total = Fraction(float(identity.high[0])) + Fraction(float(jammed.high[0])) * (e - 1)
    total -= Fraction(float(first.low[0])) * (b[0] - 1) + Fraction(float(second.low[0])) * (b[1] - 1)
    assert total >= -Fraction(1e-12) * (Fraction(float(jammed.high[0])) * e + sum(b))


def test_a_level_below_one_excludes_nothing() -> None:
    """The bound of a pair is concave at levels of 1 and more alone: below, nothing is returned."""
    family = PLAIN.changed(
        numerator_isotropic=np.full(2, 2.0), denominator_of=np.arange(2), denominator_isotropic=np.ones(2),
        pairs=np.array([[0, 1]]),
    )  # fmt: skip
    leaves = leaves_of_level(1.0 - 1e-12, {0: 1.0, 1: 1.0})
    identity, _ = pair_factors(family.ratios, leaves, *mix_slots(leaves))
    assert np.isnan(identity.high[0])


def test_lemma_7_holds_for_certain_pairs_alone() -> None:
    """Not for numerators that are not a denominator and more, or a denominator that serves both."""
    ratios = build_family(load("examples/friendly-jamming.toml"), any_objective=True).ratios
    assert pairs_fit(ratios)
    for changes in (
        {"numerator_isotropic": 0.5 * ratios.denominator_isotropic},
        {"numerator_weight": ratios.numerator_weight * 1.01},
        {"numerator_point": ratios.numerator_point[::-1].copy()},
        {"pairs": ratios.pairs[:, ::-1][:, [0, 0]].copy()},
        {"denominator_of": ratios.denominator_of * 0},
        {"denominator_start": ratios.denominator_start * 0},
    ):
        assert not pairs_fit(ratios._replace(**changes))
