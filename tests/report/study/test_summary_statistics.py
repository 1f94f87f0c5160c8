"""Quantiles, intervals and the bootstrap: definitions, and how often intervals hold what they should."""

import math

import numpy as np
import pytest

from nullpose.report.study.summary import (
    MEDIAN,
    WORST_TENTH,
    band_half_width,
    bootstrap,
    difference,
    quantile,
    quantile_interval,
    share_interval,
)


def test_quantiles_are_numbers_that_occur() -> None:
    """As NumPy has it by the inverted distribution function."""
    numbers = np.random.default_rng(1).normal(size=101)
    for share in (0.1, 0.5, 0.9, 1.0):
        assert quantile(numbers, share) == np.quantile(numbers, share, method="inverted_cdf")
    assert quantile(np.array([3.0, math.nan, 1.0]), 0.5) == 1.0
    assert math.isnan(quantile(np.array([math.nan]), 0.5))


def test_no_signal_is_the_least_number() -> None:
    """Minus infinity is sorted like any number, and does not turn a quantile into NaN."""
    numbers = np.array([-math.inf, -math.inf, 0.0, 1.0])
    assert quantile(numbers, 0.5) == -math.inf
    assert quantile(numbers, 0.75) == 0.0
    assert list(difference(numbers[:3], np.array([-math.inf, 1.0, 1.0]))) == [0.0, -math.inf, -1.0]


@pytest.mark.parametrize("share", [WORST_TENTH, MEDIAN])
def test_intervals_hold_the_quantile(share: float) -> None:
    """In at least 95 of 100 samples, whatever the distribution; not in all of them either."""
    generator = np.random.default_rng(2)
    truth = -math.log(1.0 - share)
    held = 0
    for _ in range(400):
        low, high = quantile_interval(generator.exponential(size=120), share)
        held += low <= truth <= high
    assert 0.93 * 400 <= held < 400


def test_an_end_without_numbers_is_not_known() -> None:
    """The 10th percentile has no lower end with 35 numbers, and one with 36; the median none with 5."""
    numbers = np.arange(36.0)
    assert math.isnan(quantile_interval(numbers[:35], WORST_TENTH)[0])
    assert quantile_interval(numbers, WORST_TENTH)[0] == 0.0
    assert np.isnan(quantile_interval(numbers[:5], MEDIAN)).all()
    assert np.isnan(quantile_interval(numbers[:0], MEDIAN)).all()


def test_band_and_share() -> None:
    """The constants of Massart and the interval of Clopper and Pearson, at known points."""
    assert band_half_width(2000) == pytest.approx(0.030368, abs=1e-6)
    assert share_interval(0, 100) == pytest.approx((0.0, 0.036217), abs=1e-6)
    assert np.isnan(share_interval(0, 0)).all()


def test_the_bootstrap_holds_the_mean() -> None:
    """It is seeded, passes over columns that are mostly without a number, and leaves few scenes alone."""
    generator = np.random.default_rng(3)
    columns = generator.normal(size=(400, 3))
    columns[:, 1] = math.nan
    ends = bootstrap(lambda drawn: drawn.mean(axis=0), columns)
    np.testing.assert_array_equal(ends, bootstrap(lambda drawn: drawn.mean(axis=0), columns))
    half = 1.96 * columns.std(axis=0) / math.sqrt(400)
    np.testing.assert_allclose(ends[1] - ends[0], 2.0 * half, rtol=0.1)
    assert np.isnan(ends[:, 1]).all()
    assert np.isnan(bootstrap(lambda drawn: drawn.mean(axis=0), columns[:35])).all()
