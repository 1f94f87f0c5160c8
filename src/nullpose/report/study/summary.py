"""The summary of a study: a row for each combination of swept values and case, with all its statistics."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import Quantity
from nullpose.physics import to_db
from nullpose.physics.types import FloatArray
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.statistics import (
    FEW_SCENES,
    MEDIAN,
    WORST_TENTH,
    difference,
    draws,
    interval_of,
    quantile,
    quantile_interval,
    resampled,
    share_interval,
)
from nullpose.study.monte_carlo import StudySpec, StudyTable

if TYPE_CHECKING:
    import pandas as pd

Columns: TypeAlias = dict[str, object]  # numbers by case, or one for all
Counts: TypeAlias = NDArray[np.int64]
Values: TypeAlias = dict[str, NDArray[np.generic]]

STATUSES = ("certified", "gap-not-reached", "best-found", "given", "failed")

NULL_GAIN = math.sin(math.radians(1.0)) ** 2
"""Gain of a short dipole towards a point one degree from its axis."""

# The values of rows that are kept; a status is its place in STATUSES.
_KINDS = {"value": "f8", "bound": "f8", "gap": "f4", "status": "u1", "seconds": "f4", "null_gain": "f4"}

_RESAMPLED = ("shift_worst_tenth", "difference_median", "difference_worst_tenth")


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A study's values and their statistics.

    Args:
        spec: the study.
        value: maximum of each row, in dB or bits/s/Hz, by scene, combination and case; NaN of a failure.
        quantity: the maximised quantity.
        cases: in the spec's order.
        requirement: the smallest number that will do, in the quantity's unit; None without one.
        frame: the statistics, a row for each combination and case.
    """

    spec: StudySpec
    value: FloatArray
    quantity: Quantity
    cases: tuple[ReportCase, ...]
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
    def compared(self) -> list[ReportCase]:
        """The cases that are compared with another."""
        return [case for case in self.cases if case.reference != case.place]

    def row(self, point: int, case: ReportCase) -> pd.Series:
        """Look up the statistics of a case at a combination of swept values."""
        return self.frame.iloc[point * len(self.cases) + case.place]

    def table(self) -> pd.DataFrame:
        """Put units into the names of the columns, for a file."""
        unit = "bps_hz" if self.quantity.is_rate else "db"
        heads = ("median", "worst_tenth", "best_tenth", "gain_", "shift_", "difference_")
        return self.frame.rename(columns=lambda name: f"{name}_{unit}" if name.startswith(heads) else name)


def gather(table: StudyTable, on_batch: Callable[[pd.DataFrame], object] = lambda batch: None) -> Values:
    """Read all rows once, part by part, into arrays by scene, combination and case: 29 bytes for each row.

    Args:
        table: the study's rows.
        on_batch: called with each part's rows, ratios in dB beside them.

    Raises:
        UsageError: a part is damaged.
    """
    inner = (len(table.spec.points), len(table.spec.cases))
    arrays = {name: np.zeros((table.scenes_done, *inner), kind) for name, kind in _KINDS.items()}
    done = 0
    for batch in table.batches():
        end = done + len(batch) // table.spec.rows_per_scene
        columns = batch.assign(
            status=batch["status"].map(STATUSES.index),
            seconds=batch["seconds"].mask(batch["status"] == "failed"),
        )
        for name in () if table.quantity.is_rate else ("bound", "value"):
            columns[name] = to_db(batch[name].to_numpy(float, na_value=np.nan))
            batch.insert(batch.columns.get_loc("gap"), f"{name}_db", columns[name])
        for name, kind in _KINDS.items():
            arrays[name][done:end] = columns[name].to_numpy(kind).reshape(-1, *inner)
        on_batch(batch)
        done = end
    return arrays


def summarise(
    table: StudyTable, values: Values, cases: tuple[ReportCase, ...], requirement: float | None = None
) -> Summary:
    """Compute the statistics of a study.

    Args:
        table: the study.
        values: its values.
        cases: of the study.
        requirement: the smallest number that will do, in the quantity's unit.
    """
    import pandas as pd

    frames = []
    for point, swept in enumerate(table.spec.points):
        at = {name: numbers[:, point] for name, numbers in values.items()}
        value, bound = np.asarray(at["value"], float), np.asarray(at["bound"], float)
        columns: Columns = {"point": point, **swept, "case": [case.name for case in cases]}
        columns |= _reached(at, value) | _gained(cases, value)
        columns |= {} if requirement is None else _outage(value, bound, requirement)
        frames.append(pd.DataFrame(columns | _proofs(at)))
    return Summary(
        spec=table.spec,
        value=np.asarray(values["value"], float),
        quantity=table.quantity,
        cases=cases,
        requirement=requirement,
        frame=pd.concat(frames, ignore_index=True),
    )


def _with_ends(name: str, numbers: object, ends: Iterable[tuple[float, float]]) -> Columns:
    low, high = zip(*ends, strict=True)
    return {name: numbers, f"{name}_low": low, f"{name}_high": high}


def _quantile(numbers: FloatArray, share: float) -> list[float]:
    return [quantile(column, share) for column in numbers.T]


def _quantiles(name: str, numbers: FloatArray, share: float) -> Columns:
    ends = (quantile_interval(column, share) for column in numbers.T)
    return _with_ends(name, _quantile(numbers, share), ends)


def _shares(name: str, hits: Counts, counts: Counts) -> Columns:
    return _with_ends(name, _divided(hits, counts), map(share_interval, hits, counts))


def _divided(part: Counts, whole: Counts) -> FloatArray:
    """Divide counts; NaN where nothing was counted."""
    return np.asarray(np.divide(part, whole, out=np.full(part.shape, math.nan), where=whole > 0))


def _reached(at: Values, value: FloatArray) -> Columns:
    """Count rows by status, and compute the quantiles of their values."""
    status, null_gain = at["status"], np.asarray(at["null_gain"], float)
    counts = {name.replace("-", "_"): np.sum(status == code, axis=0) for code, name in enumerate(STATUSES)}
    return {
        "scenes": len(value),
        **counts,
        **_quantiles("worst_tenth", value, WORST_TENTH),
        **_quantiles("median", value, MEDIAN),
        "best_tenth": _quantile(value, 1.0 - WORST_TENTH),
        **_shares("null_share", np.sum(null_gain <= NULL_GAIN, axis=0), np.sum(null_gain >= 0.0, axis=0)),
    }


def _gained(cases: tuple[ReportCase, ...], value: FloatArray) -> Columns:
    """Compute the statistics of the differences from the reference on the same scenes.

    A shift is the difference of the 10th percentiles; differences are those of both gains from the
    omnidirectional vehicle's.
    """
    references = [case.reference for case in cases]
    wholes = [case.place if case.whole is None else case.whole for case in cases]
    is_lacking = np.array([case.whole is None for case in cases])
    gains = difference(value, value[:, references])
    tenths, medians = resampled(value, WORST_TENTH), resampled(gains, MEDIAN)

    def statistics(times: Counts) -> FloatArray:
        tenth, median = tenths(times), medians(times)
        shift = difference(tenth, tenth[references])
        apart = [difference(gain, gain[wholes]) for gain in (median, shift)]
        return np.stack([shift, *np.where(is_lacking, math.nan, apart)])

    count = len(value)
    drawn = draws(count) if count >= FEW_SCENES else ()
    replicates = np.array([statistics(times) for times in drawn]).reshape(-1, 3, len(cases))
    columns: Columns = {
        "against": [cases[reference].name for reference in references],
        "pairs": np.sum(~np.isnan(gains), axis=0),
        **_quantiles("gain_worst_tenth", gains, WORST_TENTH),
        **_quantiles("gain_median", gains, MEDIAN),
        "gain_best_tenth": _quantile(gains, 1.0 - WORST_TENTH),
    }
    for kind, name in enumerate(_RESAMPLED):
        numbers = statistics(np.ones(count, dtype=np.int64))[kind]
        columns |= _with_ends(name, numbers, map(interval_of, replicates[:, kind].T))
    return columns


def _outage(value: FloatArray, bound: FloatArray, requirement: float) -> Columns:
    """Compute the share of scenes that miss a requirement, and that are proved to miss it with any pose."""
    counts = np.sum(~np.isnan(value), axis=0)
    missed, proved = (np.sum(numbers < requirement, axis=0) for numbers in (value, bound))
    return {**_shares("outage", missed, counts), "outage_proved": _divided(proved, counts)}


def _proofs(at: Values) -> Columns:
    """Compute the quantiles of gaps and seconds, failures left out."""
    columns: Columns = {"proved": np.sum(~np.isnan(np.asarray(at["gap"], float)), axis=0)}
    for name in ("gap", "seconds"):
        for suffix, share in (("median", 0.5), ("p95", 0.95), ("worst", 1.0)):
            columns[f"{name}_{suffix}"] = _quantile(np.asarray(at[name], float), share)
    return {**columns, "seconds_total": np.nansum(np.asarray(at["seconds"], float), axis=0)}
