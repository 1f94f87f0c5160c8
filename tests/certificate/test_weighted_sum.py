"""What a leaf's multipliers make of a mean of ratios."""

from decimal import Decimal, localcontext

import numpy as np
from hypothesis import given, strategies as st

from nullpose import load
from nullpose.certificate.weighted_sum import mean_level
from nullpose.problem.build import build_family

PLAIN = build_family(load("examples/paper.toml"))


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
    found = mean_level(family, slots, q[:, None], np.array([level]))
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
