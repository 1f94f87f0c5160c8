"""What a study answers, in sentences that are written from its numbers."""

from __future__ import annotations

import math
from typing import Any

from nullpose.objectives import Quantity
from nullpose.report.numbers import begun, count_of, listed, number, percent, span, with_unit
from nullpose.report.study.cases import ReportCase, whole_of
from nullpose.report.study.statistics import CONFIDENCE
from nullpose.report.study.summary import Summary, three_of

__all__ = ["MOST_OF_IT", "answer_of"]

MOST_OF_IT = 0.9
"""A vehicle that has this share of what an omnidirectional one gains, or more, has most of it."""

_ALL_OF_IT = 0.995  # as a whole per cent, 100
_MOST_TOLD = 5  # combinations of swept values that are told one by one


def answer_of(summary: Summary) -> str:
    """Return the first paragraph: what the best vehicle gains, and which tilt buys most of that.

    Args:
        summary: of a study.
    """
    last = len(summary.spec.points) - 1
    if not summary.values.scenes:
        return "No scene is done yet, so there is nothing to say."
    if not summary.values.counts()["failed"] < summary.values.status.size:
        return "Every row of this study is a failure, so there is nothing to compare; the reasons are below."
    groups = ([case for case in summary.cases if case.robust is robust] for robust in (False, True))
    return " ".join(_of_group(summary, group, last) for group in groups if group)


def _of_group(summary: Summary, group: list[ReportCase], point: int) -> str:
    """Return the sentences on cases that may be set against each other."""
    reference = summary.reference(group[0])
    assert reference is not None, "the group is not empty"
    whole = whole_of(group, robust=group[0].robust)
    others = [case for case in group if case is not reference]
    second = group[0].robust and len(group) < len(summary.cases)
    opening = "In what is guaranteed under the errors stated" if second else _opening(summary, point)
    if not others:
        return f"{opening} {_level_words(summary, point, reference)}."
    best = max(others, key=lambda case: _number(summary.row(point, case)["gain_median"], -math.inf))
    if whole in others:
        best = whole
    if not summary.row(point, best)["pairs"]:
        return f"{opening} no scene has a value of both {best.phrase} and {reference.phrase}."
    rest = [case for case in others if case is not best]
    sentences = [f"{opening} {_gain_words(summary, point, best, reference)}."]
    if best is whole:
        sentences.append(_shares_words(summary, point, rest))
        sentences.append(_least_tilt_words(summary, point, rest))
    else:
        sentences.append(_others_words(summary, point, rest))
    if reference.role != "level-vertical" and summary.against is None:
        sentences.append(_missing_words(reference, whole))
    sentences.append(_sweep_words(summary, point, best))
    return " ".join(sentence for sentence in sentences if sentence)


def _number(value: Any, unknown: float) -> float:
    return unknown if math.isnan(value) else float(value)


def _opening(summary: Summary, point: int) -> str:
    count = summary.values.scenes
    words = summary.points.words(point)
    scenes = "In the one scene" if count == 1 else f"Over {count_of(count, 'scene')}"
    if not summary.is_complete:
        scenes = f"{scenes} done so far, of {summary.spec.n_scenes:,},"
    return f"{scenes} at {words}" if words else scenes


def _level_words(summary: Summary, point: int, case: ReportCase) -> str:
    row, quantity = summary.row(point, case), summary.quantity
    kind = "guaranteed" if case.robust else "reached"
    return (
        f"the {quantity.smallest} {kind} by {case.phrase} is "
        f"{with_unit(row['median'], quantity)} in the median and {with_unit(row['worst_tenth'], quantity)} "
        "in the worst tenth; there is no other case to set it against"
    )


def _gain_words(summary: Summary, point: int, case: ReportCase, reference: ReportCase) -> str:
    row, quantity = summary.row(point, case), summary.quantity
    median, tenth = float(row["gain_median"]), float(row["shift_worst_tenth"])
    verb, sign = ("beats", 1.0) if median >= 0.0 else ("falls behind", -1.0)
    if summary.values.scenes == 1:
        return f"{case.phrase} {verb} {reference.phrase} by {with_unit(abs(median), quantity)}"
    if not _tells(median, quantity) and not _tells(tenth, quantity):
        return f"{case.phrase} gains nothing over {reference.phrase}, in the median or in the worst tenth"
    turned = sign * tenth < 0.0 and _tells(tenth, quantity)
    joined = "and" if not turned else "but loses" if sign > 0.0 else "but gains"
    other = -sign if turned else sign
    return (
        f"{case.phrase} {verb} {reference.phrase} by {with_unit(sign * median, quantity)} in the median "
        f"{_interval(summary, row, 'gain_median', sign)}{joined} {with_unit(other * tenth, quantity)} in the "
        f"worst tenth {_interval(summary, row, 'shift_worst_tenth', other)}".rstrip()
    )


def _interval(summary: Summary, row: Any, name: str, sign: float) -> str:
    _, *ends = (sign * number for number in three_of(row, name))
    if any(map(math.isnan, ends)):
        return ""
    return f"({percent(CONFIDENCE)} confidence: {span(min(ends), max(ends), summary.quantity)}) "


def _tells(value: float, quantity: Quantity) -> bool:
    return abs(value) >= (5e-4 if quantity.is_rate else 5e-3)


def _shares_words(summary: Summary, point: int, cases: list[ReportCase]) -> str:
    """Return what part of the omnidirectional vehicle's gain the others buy, by tilt."""
    parts: list[str] = []
    gain = "the gain" if summary.values.scenes == 1 else "the median gain"
    for case in sorted(cases, key=lambda case: math.inf if case.tilt_deg is None else case.tilt_deg):
        row = summary.row(point, case)
        median, tenth = _shares(summary, row)
        verb = "" if parts else " buys"
        known = [share for share in (median, tenth) if not math.isnan(share)]
        if known and min(known) >= _ALL_OF_IT:
            parts.append(f"{case.phrase}{verb} all of it")
        elif known:
            words = f"{_share(median)} of {gain}{_tenth_words(summary, row, tenth)}"
            parts.append(f"{case.phrase}{verb} {words}")
    return f"{begun('; '.join(parts))}." if parts else ""


def _shares(summary: Summary, row: Any) -> tuple[float, float]:
    """Return the shares of the two gains that a case has; of one scene there is but one."""
    tenth = math.nan if summary.values.scenes == 1 else float(row["share_of_worst_tenth"])
    return float(row["share_of_median"]), tenth


def _tenth_words(summary: Summary, row: Any, share: float) -> str:
    """Return what part of the worst tenth's gain a case has, or how far it falls behind there."""
    if math.isnan(share):
        return ""
    shift = float(row["shift_worst_tenth"])
    if share < 0.0 and _tells(shift, summary.quantity):
        return f", but loses {with_unit(abs(shift), summary.quantity)} in the worst tenth"
    return f" and {_share(share)} of that in the worst tenth"


def _share(share: float) -> str:
    if math.isnan(share):
        return "an unknown part"
    return "none" if share <= 0.0 else "all" if share >= _ALL_OF_IT else percent(share)


def _least_tilt_words(summary: Summary, point: int, cases: list[ReportCase]) -> str:
    """Return which of the tilts that were tried is the least that buys most of the gain."""
    tilts = sorted((case.tilt_deg, case.place) for case in cases if case.tilt_deg is not None)
    known = [summary.cases[place] for _, place in tilts]
    shares = [_shares(summary, summary.row(point, case)) for case in known]
    both = "" if summary.values.scenes == 1 else " of both"
    most = f"most of it ({percent(MOST_OF_IT)} or more{both})"
    for case, (median, tenth) in zip(known, shares, strict=True):
        least = min(_number(median, math.inf), _number(tenth, math.inf))
        if MOST_OF_IT <= least < math.inf:
            return f"The least of these that buys {most} is {case.phrase}."
    return "" if all(math.isnan(median) for median, _ in shares) else f"None of these buys {most}."


def _others_words(summary: Summary, point: int, cases: list[ReportCase]) -> str:
    rows = [(case.phrase, summary.row(point, case)) for case in cases[:_MOST_TOLD]]
    parts = [f"{name} {_gains(summary, row)}" for name, row in rows if not math.isnan(row["gain_median"])]
    return f"The same of the others: {'; '.join(parts)}." if parts else ""


def _gains(summary: Summary, row: Any) -> str:
    """Return the gains in the median and in the worst tenth."""
    median, tenth = (number(row[name], summary.quantity) for name in ("gain_median", "shift_worst_tenth"))
    return f"{median} and {tenth} {summary.quantity.unit}"


def _missing_words(reference: ReportCase, whole: ReportCase | None) -> str:
    """Return which of the vehicles that the question is about are not in the study."""
    if reference.tilt_deg == 0.0:
        return f"The level vehicle here is {reference.phrase}: there is none with a vertical dipole."
    missing = ["no level vehicle"]
    if whole is None:
        missing.append("no omnidirectional one")
    return f"There is {listed(missing)} in this study."


def _sweep_words(summary: Summary, point: int, case: ReportCase) -> str:
    """Return how the gain runs over the other combinations of swept values."""
    others = [each for each in summary.points.shown if each != point][: _MOST_TOLD + 1]
    parts = [f"{_gains(summary, summary.row(each, case))} at {summary.points.words(each)}" for each in others]
    few = "" if len(summary.spec.points) == len(summary.points.shown) else ", among others"
    return f"For {case.phrase} the two gains are {listed(parts)}{few}." if parts else ""
