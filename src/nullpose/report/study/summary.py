"""The summary of a study: a row for each combination of swept values and case, with all its statistics."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.study.cases import ReportCase
from nullpose.report.study.points import SweptPoints
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
from nullpose.report.study.values import STATUSES, StudyValues
from nullpose.study.monte_carlo import StudySpec, StudyTable

if TYPE_CHECKING:
    import pandas as pd

Columns = dict[str, Any]  # numbers by case, or one for all
Counts = NDArray[np.int64]

NULL_GAIN = math.sin(math.radians(1.0)) ** 2
"""Gain of a short dipole towards a point one degree from its axis."""

_RESAMPLED = ("shift_worst_tenth", "difference_median", "difference_worst_tenth")


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A study's values with what a report says of them.

    Args:
        spec: the study.
        values: of all rows that are done.
        quantity: the maximised quantity.
        cases: in the spec's order.
        points: the combinations of swept values.
        requirement: the smallest number that will do, in the quantity's unit; None if none is set.
        frame: the statistics, a row for each combination and case.
    """

    spec: StudySpec
    values: StudyValues
    quantity: Quantity
    cases: tuple[ReportCase, ...]
    points: SweptPoints
    requirement: float | None
    frame: pd.DataFrame

    @property
    def is_complete(self) -> bool:
        """Whether all scenes are done."""
        return self.values.scenes == self.spec.n_scenes

    @property
    def has_robust(self) -> bool:
        """Whether some cases state what is guaranteed."""
        return any(case.robust for case in self.cases)

    @property
    def compared(self) -> list[ReportCase]:
        """The cases that are measured against another."""
        return [case for case in self.cases if case.reference != case.place]

    @property
    def paired(self) -> list[ReportCase]:
        """The robust cases of which there is a nominal one."""
        return [case for case in self.cases if case.nominal is not None]

    def row(self, point: int, case: ReportCase) -> Any:
        """Return the statistics of a case at a combination of swept values, by name.

        Args:
            point: the combination's number.
            case: one of the cases.
        """
        return self.frame.iloc[point * len(self.cases) + case.place]

    def table(self) -> pd.DataFrame:
        """Return the statistics with the unit in the names of columns, for a file."""
        unit = "bps_hz" if self.quantity.is_rate else "db"
        heads = ("median", "worst_tenth", "best_tenth", "gain_", "shift_", "difference_", "cost_")
        return self.frame.rename(columns=lambda name: f"{name}_{unit}" if name.startswith(heads) else name)


def three_of(row: Any, name: str) -> tuple[float, float, float]:
    """Return a statistic and the ends of its interval; NaN for what is not known.

    Args:
        row: of a summary.
        name: of the statistic.
    """
    return float(row[name]), float(row[f"{name}_low"]), float(row[f"{name}_high"])


def summarise(
    table: StudyTable,
    values: StudyValues,
    cases: tuple[ReportCase, ...],
    requirement: float | None = None,
) -> Summary:
    """Return the statistics of a study.

    Args:
        table: the study.
        values: its values.
        cases: of the study.
        requirement: what the smallest SINR, margin or rate has to reach, in its unit.
    """
    import pandas as pd

    frames = []
    for point, swept in enumerate(table.spec.points):
        at = values.at(point)
        columns = {"point": point, **swept, "case": [case.name for case in cases]}
        columns |= _reached(at) | _gained(cases, at) | _bootstrapped(cases, at.value) | _best(cases, at)
        columns |= {} if requirement is None else _outage(at, requirement)
        columns |= _cost(cases, at) if any(case.robust for case in cases) else {}
        frames.append(pd.DataFrame(columns | _proofs(at)))
    return Summary(
        spec=table.spec,
        values=values,
        quantity=table.quantity,
        cases=cases,
        points=SweptPoints.of(table.spec),
        requirement=requirement,
        frame=pd.concat(frames, ignore_index=True),
    )


def _with_ends(name: str, found: ArrayLike, ends: Iterable[tuple[float, float]]) -> Columns:
    low, high = zip(*ends, strict=True)
    return {name: found, f"{name}_low": low, f"{name}_high": high}


def _quantile(numbers: FloatArray, share: float) -> list[float]:
    return [quantile(column, share) for column in numbers.T]


def _quantiles(name: str, numbers: FloatArray, share: float) -> Columns:
    ends = (quantile_interval(column, share) for column in numbers.T)
    return _with_ends(name, _quantile(numbers, share), ends)


def _shares(name: str, hits: Counts, counts: Counts) -> Columns:
    return _with_ends(name, _divided(hits, counts), map(share_interval, hits, counts))


def _divided(part: Counts, whole: Counts) -> FloatArray:
    """Return shares of what was counted; NaN where nothing was."""
    return np.asarray(np.divide(part, whole, out=np.full(part.shape, math.nan), where=whole > 0))


def _reached(at: StudyValues) -> Columns:
    """Return how many rows have which status, and the quantiles of what is reached."""
    counts = {name.replace("-", "_"): np.sum(at.status == code, axis=0) for code, name in enumerate(STATUSES)}
    return {
        "scenes": at.scenes,
        **counts,
        **_quantiles("worst_tenth", at.value, WORST_TENTH),
        **_quantiles("median", at.value, MEDIAN),
        "best_tenth": _quantile(at.value, 1.0 - WORST_TENTH),
        **_shares("null_share", np.sum(at.null_gain <= NULL_GAIN, 0), np.sum(at.null_gain >= 0.0, 0)),
    }


def _gained(cases: Sequence[ReportCase], at: StudyValues) -> Columns:
    """Return the statistics of the differences from the reference on the same scenes."""
    references = [case.reference for case in cases]
    gains = difference(at.value, at.value[:, references])
    return {
        "against": [cases[reference].name for reference in references],
        "pairs": np.sum(~np.isnan(gains), axis=0),
        **_quantiles("gain_worst_tenth", gains, WORST_TENTH),
        **_quantiles("gain_median", gains, MEDIAN),
        "gain_best_tenth": _quantile(gains, 1.0 - WORST_TENTH),
    }


def _bootstrapped(cases: Sequence[ReportCase], value: FloatArray) -> Columns:
    """Return for each case what the worst tenth gains, and both gains less those of the omnidirectional."""
    references = [case.reference for case in cases]
    wholes = [case.place if case.whole is None else case.whole for case in cases]
    lacking = np.array([case.whole is None for case in cases])
    tenths = resampled(value, WORST_TENTH)
    medians = resampled(difference(value, value[:, references]), MEDIAN)

    def statistics(times: Counts) -> FloatArray:
        tenth, median = tenths(times), medians(times)
        shift = difference(tenth, tenth[references])
        apart = [difference(gain, gain[wholes]) for gain in (median, shift)]
        return np.stack([shift, *np.where(lacking, math.nan, apart)])

    count = len(value)
    found = statistics(np.ones(count, dtype=np.int64))
    drawn = draws(count) if count >= FEW_SCENES else ()
    many = np.array([statistics(times) for times in drawn]).reshape(-1, 3, len(cases))
    columns: Columns = {}
    for kind, name in enumerate(_RESAMPLED):
        columns |= _with_ends(name, found[kind], map(interval_of, many[:, kind].T))
    return columns


def _best(cases: Sequence[ReportCase], at: StudyValues) -> Columns:
    """Return in how many scenes a case is as good as the best, as far as its proof tells."""
    robust = np.array([case.robust for case in cases])
    best = np.stack([np.fmax.reduce(at.value[:, robust == own], axis=1) for own in robust], axis=1)
    reach = np.where(at.status == STATUSES.index("certified"), np.fmax(at.bound, at.value), at.value)
    hits = np.sum(reach >= best, axis=0)
    return {"best_in": hits, **_shares("best_share", hits, np.sum(~np.isnan(best), axis=0))}


def _outage(at: StudyValues, requirement: float) -> Columns:
    """Return in what share of scenes a requirement is missed, and is proved to be missed by any pose."""
    counts = np.sum(~np.isnan(at.value), axis=0)
    missed, proved = (np.sum(numbers < requirement, axis=0) for numbers in (at.value, at.bound))
    return {**_shares("outage", missed, counts), "outage_proved": _divided(proved, counts)}


def _cost(cases: Sequence[ReportCase], at: StudyValues) -> Columns:
    """Return what a robust case gives up of what the same vehicle reaches if everything is as stated."""
    nominal = np.full_like(at.value, math.nan)
    for case in cases:
        if case.nominal is not None:
            nominal[:, case.place] = at.value[:, case.nominal]
    costs = difference(nominal, at.value)
    return {
        "nominal": ["" if case.nominal is None else cases[case.nominal].name for case in cases],
        **_quantiles("cost_median", costs, MEDIAN),
        "cost_worst_tenth": _quantile(costs, 1.0 - WORST_TENTH),
    }


def _proofs(at: StudyValues) -> Columns:
    """Return the gaps that were reached and the seconds that were needed, failures left out."""
    gap, seconds = at.gap.astype(float), at.seconds.astype(float)
    columns: Columns = {"proved": np.sum(~np.isnan(gap), axis=0)}
    for name, numbers in (("gap", gap), ("seconds", seconds)):
        for suffix, share in (("median", 0.5), ("p95", 0.95), ("worst", 1.0)):
            columns[f"{name}_{suffix}"] = _quantile(numbers, share)
    return {**columns, "seconds_total": np.nansum(seconds, axis=0)}
