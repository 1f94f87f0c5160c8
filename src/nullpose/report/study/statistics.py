"""The statistics of a study: quantiles, shares and differences, with confidence intervals."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from nullpose.physics.types import FloatArray

CONFIDENCE = 0.95  # of every band and interval
MEDIAN, WORST_TENTH = 0.5, 0.1

# With fewer scenes the 10th percentile has no lower end at this confidence, and nothing is resampled.
FEW_SCENES = 36

_SEED = 0  # of the bootstrap: the same study gives the same report
_MOST_REPLICATES, _FEWEST_REPLICATES = 1000, 200
_DRAWN = 20_000_000  # so many draws of scenes, if that leaves enough replicates


def quantile(values: FloatArray, share: float) -> float:
    """Find the smallest number that at least a share of the numbers do not exceed; NaN if there are none.

    It is one of the numbers, so that minus infinity (no signal, in dB) does no harm.

    Args:
        values: numbers, shape ``(n,)``; NaN are left out.
        share: between 0 and 1.
    """
    if not len(numbers := values[~np.isnan(values)]):
        return math.nan
    rank = min(len(numbers), max(1, math.ceil(share * len(numbers) - 1e-9))) - 1
    return float(np.partition(numbers, rank)[rank])


def quantiles(columns: FloatArray, share: float) -> FloatArray:
    """Find the quantile of each column of an array, shape ``(n, k)``."""
    return np.array([quantile(column, share) for column in columns.T])


def quantile_interval(values: FloatArray, share: float) -> tuple[float, float]:
    """Bound the true quantile with the confidence at least, for any distribution.

    Its ends are order statistics, by the binomial distribution of how many numbers lie below the quantile. An
    end for which there are too few numbers is NaN.

    Args:
        values: numbers drawn independently, shape ``(n,)``; NaN are left out.
        share: between 0 and 1.
    """
    from scipy.stats import quantile_test

    if not len(numbers := values[~np.isnan(values)]):
        return math.nan, math.nan
    found = quantile_test(numbers, p=share).confidence_interval(CONFIDENCE)
    return float(found.low), float(found.high)


def band_half_width(count: int) -> float:
    """Bound the distance of the true distribution function from the empirical one, with the confidence.

    The inequality of Dvoretzky, Kiefer and Wolfowitz with Massart's constant, for all values at once.

    Args:
        count: how many numbers there are, at least 1.
    """
    return math.sqrt(math.log(2.0 / (1.0 - CONFIDENCE)) / (2.0 * count))


def share_interval(hits: int, count: int) -> tuple[float, float]:
    """Bound a share by Clopper and Pearson; NaN if nothing was counted.

    Args:
        hits: in how many scenes it is so.
        count: of how many.
    """
    from scipy.stats import binomtest

    if not count:
        return math.nan, math.nan
    found = binomtest(hits, count).proportion_ci(CONFIDENCE, method="exact")
    return float(found.low), float(found.high)


def difference(values: FloatArray, others: FloatArray) -> FloatArray:
    """Subtract arrays; 0 where both are the same infinity, which is no signal in both."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(np.equal(values, others), 0.0, np.subtract(values, others)))


def bootstrap(statistic: Callable[[FloatArray], FloatArray], values: FloatArray) -> FloatArray:
    """Bound statistics by the percentiles of a seeded bootstrap over scenes, shape ``(2, ...)``.

    An end is NaN unless nearly all replicates have a number. Few scenes are not resampled.

    Args:
        statistic: of the values of some scenes, any shape.
        values: by scene first.
    """
    count, generator = len(values), np.random.default_rng(_SEED)
    if count < FEW_SCENES:
        return np.full((2, *np.shape(statistic(values))), math.nan)
    drawn = [
        statistic(values[generator.integers(count, size=count)])
        for _ in range(min(_MOST_REPLICATES, max(_FEWEST_REPLICATES, _DRAWN // count)))
    ]
    return np.apply_along_axis(_percentiles, 0, np.array(drawn))


def _percentiles(replicates: FloatArray) -> FloatArray:
    tail = (1.0 - CONFIDENCE) / 2.0
    if np.mean(np.isnan(replicates)) > tail * 2.0:
        return np.array([math.nan, math.nan])
    return np.array([quantile(replicates, tail), quantile(replicates, 1.0 - tail)])
