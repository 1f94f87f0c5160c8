"""The summary of a study: a row for each combination of swept values and case, with all its statistics."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.study.monte_carlo import StudySpec, StudyTable

if TYPE_CHECKING:
    import pandas as pd

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


Columns = dict[str, object]  # numbers by case

STATUSES = ("certified", "gap-not-reached", "best-found", "given", "failed")

NULL_GAIN = math.sin(math.radians(1.0)) ** 2
"""Gain of a short dipole towards a point one degree from its axis."""

# The columns of all rows that are kept in memory.
_KINDS = {"value": "f8", "bound": "f8", "gap": "f4", "seconds": "f4", "null_gain": "f4"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A study's values and their statistics.

    Args:
        spec: the study.
        value: maximum of each row, in dB or bits/s/Hz, by scene, combination and case; NaN of a failure.
        quantity: the maximised quantity.
        cases: as :func:`report_cases` describes them.
        requirement: the smallest number that will do, in the quantity's unit; None without one.
        frame: the statistics, by combination and case.
    """

    spec: StudySpec
    value: FloatArray
    quantity: Quantity
    cases: pd.DataFrame
    requirement: float | None
    frame: pd.DataFrame

    @property
    def scenes(self) -> int:
        """Number of scenes that are done."""
        return len(self.value)

    @property
    def is_complete(self) -> bool:
        """Whether all scenes are done."""
        return self.scenes == self.spec.n_scenes

    @property
    def compared(self) -> list[str]:
        """The names of the cases that are compared with another."""
        return [str(name) for name, case in self.cases.iterrows() if case["against"] != name]

    def at(self, point: int) -> pd.DataFrame:
        """Look up the statistics at a combination of swept values, by case."""
        point %= len(self.spec.points)
        return self.frame[self.frame["point"] == point].set_index("case")

    def row(self, point: int, case: str) -> pd.Series:
        """Look up the statistics of a case at a combination of swept values."""
        return self.at(point).loc[case]

    def table(self) -> pd.DataFrame:
        """Put units into the names of the columns, for a file."""
        unit = self.quantity.ending
        heads = ("median", "worst_tenth", "best_tenth", "gain_", "shift_", "difference_")
        return self.frame.rename(columns=lambda name: f"{name}_{unit}" if name.startswith(heads) else name)


def summarise(
    table: StudyTable,
    cases: pd.DataFrame,
    requirement: float | None = None,
    on_batch: Callable[[pd.DataFrame], object] = lambda batch: None,
) -> Summary:
    """Compute the statistics of a study, whose rows are read once, part by part.

    Args:
        table: the study.
        cases: of the study.
        requirement: the smallest number that will do, in the quantity's unit.
        on_batch: called with each part's rows, ratios in dB beside them.

    Raises:
        UsageError: a part is damaged.
    """
    import pandas as pd

    spec = table.spec
    rows = pd.concat([_kept(table, batch, on_batch) for batch in table.batches()])
    shape = (table.scenes_done, len(spec.points), len(cases))
    arrays = {name: rows[name].to_numpy().reshape(shape) for name in rows}
    frames = []
    for point, swept in enumerate(spec.points):
        at = {name: numbers[:, point] for name, numbers in arrays.items()}
        numbers = _reached(at) | _gained(cases, at["value"]) | _outage(at, requirement) | _proofs(at)
        frames.append(pd.DataFrame({"point": point, **swept, "case": cases.index, **numbers}))
    return Summary(
        spec=spec,
        value=arrays["value"],
        quantity=table.quantity,
        cases=cases,
        requirement=requirement,
        frame=pd.concat(frames, ignore_index=True),
    )


def _kept(table: StudyTable, batch: pd.DataFrame, on_batch: Callable[[pd.DataFrame], object]) -> pd.DataFrame:
    """Hand on a part's rows with ratios in dB; keep the columns that statistics are of."""
    columns = {"status": batch["status"].map(STATUSES.index)} | {name: batch[name] for name in _KINDS}
    columns["seconds"] = batch["seconds"].mask(batch["status"] == "failed")
    for name in () if table.quantity.is_rate else ("bound", "value"):
        columns[name] = to_db(batch[name].to_numpy(float, na_value=np.nan))
        batch.insert(batch.columns.get_loc("gap"), f"{name}_db", columns[name])
    on_batch(batch)
    return batch.assign(**columns)[list(columns)].astype(_KINDS | {"status": "u1"})


def _with_ends(name: str, numbers: FloatArray, ends: Iterable[tuple[float, float]]) -> Columns:
    low, high = zip(*ends, strict=True)
    return {name: numbers, f"{name}_low": low, f"{name}_high": high}


def _quantiles(name: str, numbers: FloatArray, share: float) -> Columns:
    return _with_ends(
        name, quantiles(numbers, share), (quantile_interval(column, share) for column in numbers.T)
    )


def _shares(name: str, hits: FloatArray, counts: FloatArray) -> Columns:
    return _with_ends(name, _divided(hits, counts), map(share_interval, hits, counts))


def _divided(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Divide counts; NaN where nothing was counted."""
    return np.asarray(np.divide(part, whole, out=np.full(part.shape, math.nan), where=whole > 0))


def _reached(at: Mapping[str, FloatArray]) -> Columns:
    """Count rows by status, and compute the quantiles of their values."""
    value, null_gain = at["value"], at["null_gain"]
    return {
        "scenes": len(value),
        **{
            name.replace("-", "_"): np.sum(at["status"] == code, axis=0) for code, name in enumerate(STATUSES)
        },
        **_quantiles("worst_tenth", value, WORST_TENTH),
        **_quantiles("median", value, MEDIAN),
        "best_tenth": quantiles(value, 1.0 - WORST_TENTH),
        **_shares("null_share", np.sum(null_gain <= NULL_GAIN, axis=0), np.sum(null_gain >= 0.0, axis=0)),
    }


def _gained(cases: pd.DataFrame, value: FloatArray) -> Columns:
    """Compute the statistics of the differences from the reference on the same scenes.

    A shift is the difference of the 10th percentiles; differences are those of both gains from the
    omnidirectional vehicle's.
    """
    references = cases.index.get_indexer(cases["against"])
    wholes = cases.index.get_indexer(cases["whole"])  # -1 where there is none

    def statistics(values: FloatArray) -> FloatArray:
        tenth = quantiles(values, WORST_TENTH)
        median = quantiles(difference(values, values[:, references]), MEDIAN)
        shift = difference(tenth, tenth[references])
        apart = [difference(gain, gain[wholes]) for gain in (median, shift)]
        return np.stack([shift, *np.where(wholes < 0, math.nan, apart)])

    gains = difference(value, value[:, references])
    columns: Columns = {
        "against": cases["against"].to_numpy(),
        "pairs": np.sum(~np.isnan(gains), axis=0),
        **_quantiles("gain_worst_tenth", gains, WORST_TENTH),
        **_quantiles("gain_median", gains, MEDIAN),
        "gain_best_tenth": quantiles(gains, 1.0 - WORST_TENTH),
    }
    low, high = bootstrap(statistics, value)
    names = ("shift_worst_tenth", "difference_median", "difference_worst_tenth")
    for name, *numbers in zip(names, statistics(value), low, high, strict=True):
        columns |= dict(zip((name, f"{name}_low", f"{name}_high"), numbers, strict=True))
    return columns


def _outage(at: Mapping[str, FloatArray], requirement: float | None) -> Columns:
    """Compute the share of scenes that miss a requirement, and that are proved to miss it with any pose."""
    if requirement is None:
        return {}
    counts = np.sum(~np.isnan(at["value"]), axis=0)
    missed, proved = (np.sum(at[name] < requirement, axis=0) for name in ("value", "bound"))
    return {**_shares("outage", missed, counts), "outage_proved": _divided(proved, counts)}


def _proofs(at: Mapping[str, FloatArray]) -> Columns:
    """Compute the quantiles of gaps and seconds, failures left out."""
    columns: Columns = {"proved": np.sum(~np.isnan(at["gap"]), axis=0)}
    for name in ("gap", "seconds"):
        for suffix, share in (("median", 0.5), ("p95", 0.95), ("worst", 1.0)):
            columns[f"{name}_{suffix}"] = quantiles(at[name], share)
    return columns | {"seconds_total": np.nansum(at["seconds"], axis=0, dtype=float)}
