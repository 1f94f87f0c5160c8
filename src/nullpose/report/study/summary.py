"""The summary of a study: a row for each combination of swept values and case, with all its statistics."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.report.study.cases import ReportCase, nominal_of, reference_of, report_cases, whole_of
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
from nullpose.report.study.values import STATUSES, StudyValues, quantity_of
from nullpose.study.monte_carlo import StudySpec, StudyTable

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Summary", "summarise", "three_of"]

Cells = dict[str, Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary:
    """A study's values with what a report says of them.

    Args:
        spec: the study.
        values: of all rows that are done.
        quantity: what was made as large as it can be.
        cases: in the spec's order.
        points: the combinations of swept values.
        against: name of the case that was asked to be measured against; None for the usual one.
        requirement: the smallest number that will do, in the quantity's unit; None if none is set.
        frame: the statistics, a row for each combination and case.
    """

    spec: StudySpec
    values: StudyValues
    quantity: Quantity
    cases: tuple[ReportCase, ...]
    points: SweptPoints
    against: str | None
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
        return [case for case in self.cases if self.reference(case) is not case]

    @property
    def paired(self) -> list[ReportCase]:
        """The robust cases of which there is a nominal one."""
        return [case for case in self.cases if nominal_of(self.spec, self.cases, case) is not None]

    def reference(self, case: ReportCase) -> ReportCase | None:
        """Return what a case is measured against: what is guaranteed only against what is guaranteed.

        Args:
            case: one of the cases.
        """
        return reference_of(self.cases, robust=case.robust, against=self.against)

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

    spec, cases = table.spec, report_cases(table.spec)
    reference_of(cases, against=against)  # a wrong name is told before the work
    rows: list[Cells] = []
    for point, swept in enumerate(spec.points):
        bootstrapped = _bootstrapped(cases, values.value[:, point], against)
        for case in cases:
            cells: Cells = {"point": point, **swept, "case": case.name}
            cells |= _statuses(values, point, case) | _level(values.value[:, point, case.place])
            cells |= _gain(cases, values, point, case, against) | bootstrapped[case.place]
            cells |= _best(cases, values, point, case) | _outage(values, point, case, requirement)
            cells |= _cost(spec, cases, values, point, case) | _effort(values, point, case)
            rows.append(cells)
    return Summary(
        spec=spec,
        values=values,
        quantity=quantity_of(table),
        cases=cases,
        points=SweptPoints.of(spec),
        against=against,
        requirement=requirement,
        frame=pd.DataFrame(rows),
    )


def _statuses(values: StudyValues, point: int, case: ReportCase) -> Cells:
    status = values.status[:, point, case.place]
    counts = {name.replace("-", "_"): int(np.sum(status == code)) for code, name in enumerate(STATUSES)}
    return {"scenes": len(status), **counts}


def _quantiles(name: str, numbers: FloatArray, share: float) -> Cells:
    low, high = quantile_interval(numbers, share)
    return {name: quantile(numbers, share), f"{name}_low": low, f"{name}_high": high}


def _level(numbers: FloatArray) -> Cells:
    return {
        **_quantiles("worst_tenth", numbers, WORST_TENTH),
        **_quantiles("median", numbers, MEDIAN),
        "best_tenth": quantile(numbers, 1.0 - WORST_TENTH),
    }


def _gain(
    cases: tuple[ReportCase, ...], values: StudyValues, point: int, case: ReportCase, against: str | None
) -> Cells:
    """Return the statistics of the differences from the reference on the same scenes."""
    reference = reference_of(cases, robust=case.robust, against=against)
    assert reference is not None, "a case's own group is never empty"
    value = values.value[:, point]
    gains = difference(value[:, case.place], value[:, reference.place])
    return {
        "against": reference.name,
        "pairs": int(np.sum(~np.isnan(gains))),
        **_quantiles("gain_worst_tenth", gains, WORST_TENTH),
        **_quantiles("gain_median", gains, MEDIAN),
        "gain_best_tenth": quantile(gains, 1.0 - WORST_TENTH),
    }


def _bootstrapped(cases: tuple[ReportCase, ...], value: FloatArray, against: str | None) -> list[Cells]:
    """Return for each case what the worst tenth gains, and the shares of what is gained by all of tilt."""
    references = [_place(reference_of(cases, robust=case.robust, against=against)) for case in cases]
    wholes = [_place(whole_of(cases, robust=case.robust)) for case in cases]
    gains = np.stack([difference(value[:, at], value[:, of]) for at, of in enumerate(references)], axis=1)
    tenths, medians = resampled(value, WORST_TENTH), resampled(gains, MEDIAN)

    def statistics(times: Any) -> FloatArray:
        tenth, median = tenths(times), medians(times)
        shift = difference(tenth, tenth[references])
        whole = [-1 if at is None else at for at in wholes]
        return np.stack([shift, _ratio(median, median[whole]), _ratio(shift, shift[whole])])

    count = value.shape[0]
    found = statistics(np.ones(count, dtype=np.int64)) if count else np.full((3, len(cases)), math.nan)
    drawn = draws(count) if count >= FEW_SCENES else ()
    many = np.array([statistics(times) for times in drawn]).reshape(-1, 3, len(cases))
    cells: list[Cells] = []
    for at, whole in enumerate(wholes):
        row: Cells = {}
        for kind, name in enumerate(("shift_worst_tenth", "share_of_median", "share_of_worst_tenth")):
            known = kind == 0 or (whole is not None and whole != references[at])
            low, high = interval_of(many[:, kind, at]) if known else (math.nan, math.nan)
            row |= {name: float(found[kind, at]) if known else math.nan, f"{name}_low": low}
            row[f"{name}_high"] = high
        cells.append(row)
    return cells


def _place(case: ReportCase | None) -> Any:
    return None if case is None else case.place


def _ratio(part: FloatArray, whole: FloatArray) -> FloatArray:
    """Return shares of what is gained; NaN where nothing is."""
    sound = np.isfinite(part) & np.isfinite(whole) & (whole > 0.0)
    return np.asarray(np.divide(part, whole, out=np.full_like(part, math.nan), where=sound))


def _best(cases: tuple[ReportCase, ...], values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return in how many scenes a case is as good as the best, as far as its proof tells."""
    group = [each.place for each in cases if each.robust is case.robust]
    value = values.value[:, point]
    known = ~np.all(np.isnan(value[:, group]), axis=1)
    best = np.max(np.nan_to_num(value[:, group], nan=-np.inf, neginf=-np.inf), axis=1)
    own, bound = value[:, case.place], values.bound[:, point, case.place]
    certified = values.status[:, point, case.place] == STATUSES.index("certified")
    reach = np.where(certified & ~np.isnan(bound), np.fmax(bound, own), own)
    hits = int(np.sum(known & (reach >= best)))
    return {"best_in": hits, **_shares("best_share", hits, int(np.sum(known)))}


def _shares(name: str, hits: int, count: int) -> Cells:
    low, high = share_interval(hits, count)
    return {name: hits / count if count else math.nan, f"{name}_low": low, f"{name}_high": high}


def _outage(values: StudyValues, point: int, case: ReportCase, requirement: float | None) -> Cells:
    """Return in what share of scenes a requirement is missed, and is proved to be missed by any pose."""
    if requirement is None:
        return {}
    value, bound = (each[:, point, case.place] for each in (values.value, values.bound))
    known = ~np.isnan(value)
    count, proved = int(np.sum(known)), int(np.sum(bound[known] < requirement))
    cells = _shares("outage", int(np.sum(value[known] < requirement)), count)
    return {**cells, "outage_proved": proved / count if count else math.nan}


def _cost(
    spec: StudySpec, cases: tuple[ReportCase, ...], values: StudyValues, point: int, case: ReportCase
) -> Cells:
    """Return what a robust case gives up of what the same vehicle reaches if everything is as stated."""
    nominal = nominal_of(spec, cases, case)
    if not any(each.robust for each in cases):
        return {}
    value = values.value[:, point]
    costs = np.full(len(value), math.nan)
    if nominal is not None:
        costs = difference(value[:, nominal.place], value[:, case.place])
    return {
        "nominal": "" if nominal is None else nominal.name,
        **_quantiles("cost_median", costs, MEDIAN),
        "cost_worst_tenth": quantile(costs, 1.0 - WORST_TENTH),
    }


def _effort(values: StudyValues, point: int, case: ReportCase) -> Cells:
    """Return the gaps that were reached and the seconds that were needed, failures left out."""
    gap, seconds = values.effort(case.place, point)
    cells: Cells = {"proved": int(np.sum(~np.isnan(gap)))}
    for name, numbers in (("gap", gap), ("seconds", seconds)):
        for suffix, share in (("median", 0.5), ("p95", 0.95), ("worst", 1.0)):
            cells[f"{name}_{suffix}"] = quantile(numbers, share)
    cells["seconds_total"] = float(np.nansum(seconds))
    return cells
