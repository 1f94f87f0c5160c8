"""The summary of a study: a row for each combination of swept values and case, with all its statistics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.study.cases import ReportCase, report_cases
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

__all__ = ["Summary", "summarise", "three_of"]

Cells = dict[str, Any]

_RESAMPLED = ("shift_worst_tenth", "share_of_median", "share_of_worst_tenth")


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A study's values with what a report says of them.

    Args:
        spec: the study.
        values: of all rows that are done.
        quantity: what was made as large as it can be.
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
        heads = ("median", "worst_tenth", "best_tenth", "gain_", "shift_", "cost_")
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
    *,
    requirement: float | None = None,
    against: str | None = None,
) -> Summary:
    """Return the statistics of a study.

    Args:
        table: the study.
        values: its values.
        requirement: what the smallest SINR, margin or rate has to reach, in its unit.
        against: name of the case to measure gains against.

    Raises:
        UsageError: there is no case of that name.
    """
    import pandas as pd

    spec, cases = table.spec, report_cases(table.spec, against)
    rows: list[Cells] = []
    for point, swept in enumerate(spec.points):
        bootstrapped = _bootstrapped(cases, values.value[:, point])
        rows += [
            {"point": point, **swept, "case": case.name}
            | _reached(values, point, case)
            | _gained(cases, values, point, case)
            | bootstrapped[case.place]
            | _best(cases, values, point, case)
            | ({} if requirement is None else _outage(values, point, case, requirement))
            | (_cost(cases, values, point, case) if any(each.robust for each in cases) else {})
            | _proofs(values, point, case)
            for case in cases
        ]
    return Summary(
        spec=spec,
        values=values,
        quantity=table.quantity,
        cases=cases,
        points=SweptPoints.of(spec),
        requirement=requirement,
        frame=pd.DataFrame(rows),
    )


def _with_ends(name: str, value: float, ends: tuple[float, float]) -> Cells:
    return {name: value, f"{name}_low": ends[0], f"{name}_high": ends[1]}


def _quantiles(name: str, numbers: FloatArray, share: float) -> Cells:
    return _with_ends(name, quantile(numbers, share), quantile_interval(numbers, share))


def _shares(name: str, hits: int, count: int) -> Cells:
    return _with_ends(name, hits / count if count else math.nan, share_interval(hits, count))


def _reached(values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return how many rows have which status, and the quantiles of what is reached."""
    status, numbers = values.status[:, point, case.place], values.value[:, point, case.place]
    counts = {name.replace("-", "_"): int(np.sum(status == code)) for code, name in enumerate(STATUSES)}
    return {
        "scenes": len(status),
        **counts,
        **_quantiles("worst_tenth", numbers, WORST_TENTH),
        **_quantiles("median", numbers, MEDIAN),
        "best_tenth": quantile(numbers, 1.0 - WORST_TENTH),
    }


def _gained(cases: Sequence[ReportCase], values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return the statistics of the differences from the reference on the same scenes."""
    gains = difference(values.value[:, point, case.place], values.value[:, point, case.reference])
    return {
        "against": cases[case.reference].name,
        "pairs": int(np.sum(~np.isnan(gains))),
        **_quantiles("gain_worst_tenth", gains, WORST_TENTH),
        **_quantiles("gain_median", gains, MEDIAN),
        "gain_best_tenth": quantile(gains, 1.0 - WORST_TENTH),
    }


def _bootstrapped(cases: Sequence[ReportCase], value: FloatArray) -> list[Cells]:
    """Return for each case what the worst tenth gains, and the shares of what is gained by all of tilt."""
    references = [case.reference for case in cases]
    wholes = [case.reference if case.whole is None else case.whole for case in cases]  # itself: no share
    tenths = resampled(value, WORST_TENTH)
    medians = resampled(difference(value, value[:, references]), MEDIAN)

    def statistics(times: NDArray[np.int64]) -> FloatArray:
        tenth, median = tenths(times), medians(times)
        shift = difference(tenth, tenth[references])
        return np.stack([shift, _ratio(median, median[wholes]), _ratio(shift, shift[wholes])])

    count = value.shape[0]
    found = statistics(np.ones(count, dtype=np.int64))
    drawn = draws(count) if count >= FEW_SCENES else ()
    many = np.array([statistics(times) for times in drawn]).reshape(-1, 3, len(cases))
    rows: list[Cells] = [{} for _ in cases]
    for place, row in enumerate(rows):
        for kind, name in enumerate(_RESAMPLED):
            row |= _with_ends(name, float(found[kind, place]), interval_of(many[:, kind, place]))
    return rows


def _ratio(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Return shares of what is gained; NaN where nothing is."""
    sound = np.isfinite(part) & np.isfinite(whole) & (whole > 0.0)
    return np.asarray(np.divide(part, whole, out=np.full_like(part, math.nan), where=sound))


def _best(cases: Sequence[ReportCase], values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return in how many scenes a case is as good as the best, as far as its proof tells."""
    group = values.value[:, point, [each.place for each in cases if each.robust is case.robust]]
    known = ~np.all(np.isnan(group), axis=1)
    best = np.max(np.nan_to_num(group, nan=-np.inf, neginf=-np.inf), axis=1)
    own, bound, status = (each[:, point, case.place] for each in (values.value, values.bound, values.status))
    reach = np.where(status == STATUSES.index("certified"), np.fmax(bound, own), own)
    hits = int(np.sum(known & (reach >= best)))
    return {"best_in": hits, **_shares("best_share", hits, int(np.sum(known)))}


def _outage(values: StudyValues, point: int, case: ReportCase, requirement: float) -> Cells:
    """Return in what share of scenes a requirement is missed, and is proved to be missed by any pose."""
    value, bound = (each[:, point, case.place] for each in (values.value, values.bound))
    known = ~np.isnan(value)
    count, proved = int(np.sum(known)), int(np.sum(bound[known] < requirement))
    missed = _shares("outage", int(np.sum(value[known] < requirement)), count)
    return {**missed, "outage_proved": proved / count if count else math.nan}


def _cost(cases: Sequence[ReportCase], values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return what a robust case gives up of what the same vehicle reaches if everything is as stated."""
    robust = values.value[:, point, case.place]
    unknown = np.full(len(robust), math.nan)
    nominal = unknown if case.nominal is None else values.value[:, point, case.nominal]
    costs = difference(nominal, robust)
    return {
        "nominal": "" if case.nominal is None else cases[case.nominal].name,
        **_quantiles("cost_median", costs, MEDIAN),
        "cost_worst_tenth": quantile(costs, 1.0 - WORST_TENTH),
    }


def _proofs(values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return the gaps that were reached and the seconds that were needed, failures left out."""
    gap, seconds = (each[:, point, case.place].astype(float) for each in (values.gap, values.seconds))
    cells: Cells = {"proved": int(np.sum(~np.isnan(gap)))}
    for name, numbers in (("gap", gap), ("seconds", seconds)):
        for suffix, share in (("median", 0.5), ("p95", 0.95), ("worst", 1.0)):
            cells[f"{name}_{suffix}"] = quantile(numbers, share)
    return {**cells, "seconds_total": float(np.nansum(seconds))}
