"""What a study answers, in sentences that are written from its numbers."""

from __future__ import annotations

import math
from typing import Any

from nullpose.report.numbers import listed, number, percent, span, with_unit
from nullpose.report.study.cases import ReportCase, whole_of
from nullpose.report.study.statistics import CONFIDENCE
from nullpose.report.study.summary import Summary
from nullpose.report.study.wording import count_of

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
    told = []
    for robust in (False, True):
        group = [case for case in summary.cases if case.robust is robust]
        if group:
            told.append(_of_group(summary, group, last))
    return " ".join(sentence for sentence in told if sentence)


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
    best = whole if whole is not None and whole is not reference else _most_gaining(summary, point, others)
    row = summary.row(point, best)
    if not row["pairs"]:
        return f"{opening} no scene has a value of both {best.phrase} and {reference.phrase}."
    lead = f"{opening} {_gain_words(summary, point, best, reference)}."
    sentences = [lead]
    if best is whole:
        sentences.append(_shares_words(summary, point, [case for case in others if case is not whole]))
        sentences.append(_least_tilt_words(summary, point, others, whole))
    else:
        sentences.append(_others_words(summary, point, [case for case in others if case is not best]))
    if reference.role != "level-vertical" and summary.against is None:
        sentences.append(_missing_words(group, reference, whole))
    sentences.append(_sweep_words(summary, point, best))
    return " ".join(sentence for sentence in sentences if sentence)


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


def _most_gaining(summary: Summary, point: int, cases: list[ReportCase]) -> ReportCase:
    def gain(case: ReportCase) -> float:
        median = float(summary.row(point, case)["gain_median"])
        return -math.inf if math.isnan(median) else median

    return max(cases, key=gain)


def _gain_words(summary: Summary, point: int, case: ReportCase, reference: ReportCase) -> str:
    row, quantity = summary.row(point, case), summary.quantity
    median, tenth = float(row["gain_median"]), float(row["shift_worst_tenth"])
    names = (case.phrase, reference.phrase)
    if summary.values.scenes == 1:
        return f"{names[0]} {_beats(median, quantity.is_rate)} {names[1]} by {_size(summary, median)}"
    verb, sign = ("beats", 1.0) if median >= 0.0 else ("falls behind", -1.0)
    if not _tells(median, quantity.is_rate) and not _tells(tenth, quantity.is_rate):
        return f"{names[0]} gains nothing over {names[1]}, in the median or in the worst tenth"
    turned = sign * tenth < 0.0 and _tells(tenth, quantity.is_rate)
    joined = "and" if not turned else "but loses" if sign > 0.0 else "but gains"
    other = -sign if turned else sign
    return (
        f"{names[0]} {verb} {names[1]} by {with_unit(sign * median, quantity)} in the median "
        f"{_interval(summary, row, 'gain_median', sign)}{joined} {with_unit(other * tenth, quantity)} in the "
        f"worst tenth {_interval(summary, row, 'shift_worst_tenth', other)}".rstrip()
    )


def _interval(summary: Summary, row: Any, name: str, sign: float) -> str:
    ends = sorted((sign * float(row[f"{name}_{end}"]) for end in ("low", "high")), key=_nan_last)
    if any(math.isnan(end) for end in ends):
        return ""
    return f"({percent(CONFIDENCE)} confidence: {span(ends[0], ends[1], summary.quantity)}) "


def _nan_last(value: float) -> tuple[bool, float]:
    return math.isnan(value), value


def _tells(value: float, is_rate: bool) -> bool:
    return abs(value) >= (5e-4 if is_rate else 5e-3)


def _beats(median: float, is_rate: bool) -> str:
    return "beats" if median >= 0.0 else "falls behind"


def _size(summary: Summary, value: float) -> str:
    return with_unit(abs(value), summary.quantity)


def _shares_words(summary: Summary, point: int, cases: list[ReportCase]) -> str:
    """Return what part of the omnidirectional vehicle's gain the others buy, by tilt."""
    parts: list[str] = []
    for case in sorted(cases, key=lambda case: math.inf if case.tilt_deg is None else case.tilt_deg):
        row = summary.row(point, case)
        median, tenth = _shares(summary, row)
        if math.isnan(median) and math.isnan(tenth):
            continue
        name = case.phrase
        if all(math.isnan(share) or share >= _ALL_OF_IT for share in (median, tenth)):
            parts.append(f"{name} all of it" if parts else f"{name} buys all of it")
            continue
        verb = "" if parts else " buys"
        gain = "the gain" if summary.values.scenes == 1 else "the median gain"
        parts.append(f"{name}{verb} {_share(median)} of {gain}{_tenth_words(summary, row, tenth)}")
    return f"{_capital('; '.join(parts))}." if parts else ""


def _shares(summary: Summary, row: Any) -> tuple[float, float]:
    """Return the shares of the two gains that a case has; of one scene there is but one."""
    tenth = math.nan if summary.values.scenes == 1 else float(row["share_of_worst_tenth"])
    return float(row["share_of_median"]), tenth


def _tenth_words(summary: Summary, row: Any, share: float) -> str:
    """Return what part of the worst tenth's gain a case has, or how far it falls behind there."""
    if math.isnan(share):
        return ""
    if share < 0.0 and _tells(float(row["shift_worst_tenth"]), summary.quantity.is_rate):
        return f", but loses {_size(summary, float(row['shift_worst_tenth']))} in the worst tenth"
    return f" and {_share(share)} of that in the worst tenth"


def _share(share: float) -> str:
    if math.isnan(share):
        return "an unknown part"
    return "none" if share <= 0.0 else "all" if share >= _ALL_OF_IT else percent(share)


def _least_tilt_words(summary: Summary, point: int, cases: list[ReportCase], whole: ReportCase | None) -> str:
    """Return which of the tilts that were tried is the least that buys most of the gain."""
    known = [case for case in cases if case.tilt_deg is not None and case is not whole]
    if not known:
        return ""

    def buys_most(case: ReportCase) -> bool:
        shares = [each for each in _shares(summary, summary.row(point, case)) if not math.isnan(each)]
        return bool(shares) and min(shares) >= MOST_OF_IT

    enough = [case for case in sorted(known, key=lambda case: case.tilt_deg or 0.0) if buys_most(case)]
    both = "" if summary.values.scenes == 1 else " of both"
    most = f"most of it ({percent(MOST_OF_IT)} or more{both})"
    if enough:
        return f"The least of these that buys {most} is {enough[0].phrase}."
    if all(math.isnan(float(summary.row(point, case)["share_of_median"])) for case in known):
        return ""
    return f"None of these buys {most}."


def _others_words(summary: Summary, point: int, cases: list[ReportCase]) -> str:
    parts = []
    for case in cases[:_MOST_TOLD]:
        row = summary.row(point, case)
        if not math.isnan(row["gain_median"]):
            words = f"{number(row['gain_median'], summary.quantity)} and "
            words += f"{number(row['shift_worst_tenth'], summary.quantity)} {summary.quantity.unit}"
            parts.append(f"{case.phrase} {words}")
    return f"The same of the others: {'; '.join(parts)}." if parts else ""


def _missing_words(group: list[ReportCase], reference: ReportCase, whole: ReportCase | None) -> str:
    """Return which of the vehicles that the question is about are not in the study."""
    missing = []
    if reference.tilt_deg != 0.0:
        missing.append("no level vehicle")
    elif reference.role != "level-vertical":
        return f"The level vehicle here is {reference.phrase}: there is none with a vertical dipole."
    if whole is None:
        missing.append("no omnidirectional one")
    return f"There is {listed(missing)} in this study." if missing else ""


def _sweep_words(summary: Summary, point: int, case: ReportCase) -> str:
    """Return how the gain runs over the other combinations of swept values."""
    others = [number_ for number_ in summary.points.shown if number_ != point]
    if not others:
        return ""
    parts = []
    for each in others[: _MOST_TOLD + 1]:
        row = summary.row(each, case)
        gains = (number(row[name], summary.quantity) for name in ("gain_median", "shift_worst_tenth"))
        parts.append(f"{' and '.join(gains)} {summary.quantity.unit} at {summary.points.words(each)}")
    few = "" if len(summary.spec.points) == len(summary.points.shown) else ", among others"
    return f"For {case.phrase} the two gains are {listed(parts)}{few}."


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
