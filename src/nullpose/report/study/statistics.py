"""The statistics of a study: quantiles, shares and differences, with confidence intervals."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

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
    numbers = np.sort(values[~np.isnan(values)])
    return float(numbers[_rank(len(numbers), share)]) if len(numbers) else math.nan


def quantile_interval(values: FloatArray, share: float) -> tuple[float, float]:
    """Bound the true quantile with the confidence at least, for any distribution.

    Its ends are order statistics, by the binomial distribution of how many numbers lie below the quantile. An
    end for which there are too few numbers is NaN.

    Args:
        values: numbers drawn independently, shape ``(n,)``; NaN are left out.
        share: between 0 and 1.
    """
    from scipy.stats import quantile_test

    numbers = values[~np.isnan(values)]
    if not len(numbers):
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
    """Subtract; 0 where both are the same infinity, which is no signal in both.

    Args:
        values: numbers, any shape.
        others: numbers, the same shape.
    """
    with np.errstate(invalid="ignore"):
        apart = np.subtract(values, others)
    return np.asarray(np.where(np.equal(values, others), 0.0, apart))


def replicates_of(count: int) -> int:
    """Choose the number of replicates: fewer for very many scenes, which vary little.

    Args:
        count: how many scenes there are.
    """
    return min(_MOST_REPLICATES, max(_FEWEST_REPLICATES, _DRAWN // max(count, 1)))


def resampled(columns: FloatArray, share: float) -> Callable[[NDArray[np.int64]], FloatArray]:
    """Make a function of how often each scene is drawn: the quantile of each column then.

    Args:
        columns: numbers by scene and column; NaN are left out.
        share: of the quantile.
    """
    orders = [np.argsort(column, kind="stable")[: int(np.sum(~np.isnan(column)))] for column in columns.T]

    def quantiles(times: NDArray[np.int64]) -> FloatArray:
        found = np.full(len(orders), math.nan)
        for place, order in enumerate(orders):
            reached = np.cumsum(times[order])
            if len(order) and reached[-1]:
                rank = _rank(int(reached[-1]), share) + 1
                found[place] = columns[order[np.searchsorted(reached, rank)], place]
        return found

    return quantiles


def draws(count: int) -> Iterator[NDArray[np.int64]]:
    """Draw scenes for every replicate of a bootstrap, seeded: yield how often each is drawn.

    Args:
        count: how many scenes there are.
    """
    generator = np.random.default_rng(_SEED)
    for _ in range(replicates_of(count)):
        yield np.bincount(generator.integers(count, size=count), minlength=count)


def interval_of(replicates: FloatArray) -> tuple[float, float]:
    """Bound a statistic by the percentiles of a bootstrap; NaN unless nearly all replicates have a number.

    Args:
        replicates: a statistic's value in each, shape ``(n,)``.
    """
    numbers = np.sort(replicates[~np.isnan(replicates)])
    if len(numbers) < 0.95 * len(replicates) or not len(numbers):
        return math.nan, math.nan
    tail = (1.0 - CONFIDENCE) / 2.0
    return float(numbers[_rank(len(numbers), tail)]), float(numbers[_rank(len(numbers), 1.0 - tail)])


def _rank(count: int, share: float) -> int:
    """Find the place, from 0, of a quantile among sorted numbers."""
    return min(count - 1, max(0, math.ceil(share * count - 1e-9) - 1))
