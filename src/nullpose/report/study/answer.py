"""What a study answers, in sentences that are written from its numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from nullpose.report.numbers import begun, count_of, less_or_more, listed, number, percent, span, with_unit
from nullpose.report.study.cases import LEVEL, ReportCase
from nullpose.report.study.statistics import CONFIDENCE, FEW_SCENES
from nullpose.report.study.summary import Summary, three_of

NEAR_DB, NEAR_BPS_HZ = 0.5, 0.1  # so much less than an omnidirectional vehicle gains is near it

_MOST_TOLD = 5  # cases, and combinations of swept values, that are told one by one
_GAINS = (("gain_median", "in the median"), ("shift_worst_tenth", "in the worst tenth"))


def answer_of(summary: Summary) -> str:
    """Return the first paragraph: what each case gains, and the smallest tilt near the omnidirectional one.

    Args:
        summary: of a study.
    """
    counts, rows = summary.values.counts(), summary.values.status.size
    if not rows:
        return "No scene is solved yet."
    if counts["failed"] == rows:
        return "Every row of this study failed. The reasons are below."
    groups = ([case for case in summary.cases if case.robust is robust] for robust in (False, True))
    return " ".join(_of_group(summary, group) for group in groups if group)


def _of_group(summary: Summary, group: Sequence[ReportCase]) -> str:
    """Return the sentences on cases that may be set against each other."""
    point, reference = len(summary.spec.points) - 1, summary.cases[group[0].reference]
    row, verb = summary.row(point, reference), "guarantees" if reference.robust else "reaches"
    levels = [with_unit(float(row[name]), summary.quantity) for name in ("median", "worst_tenth")]
    sentences = [
        f"{_opening(summary, point)} {reference.phrase} {verb} a {summary.quantity.smallest} of {levels[0]} "
        f"in the median and {levels[1]} in the worst tenth."
    ]
    others = sorted(
        (case for case in group if case is not reference and summary.row(point, case)["pairs"]),
        key=lambda case: (case.place != case.whole, -float(summary.row(point, case)["gain_median"])),
    )
    if others:
        parts = [_gain_words(summary, point, case) for case in others[:_MOST_TOLD]]
        sentences += [
            f"Against it, on the same scenes, {'; '.join(parts)}.",
            _least_tilt_words(summary, point, [reference, *others]),
        ]
        sentences += [_missing_words(reference), _sweep_words(summary, point, others[0])]
    return " ".join(filter(None, sentences))


def _opening(summary: Summary, point: int) -> str:
    words = summary.points.words(point)
    scenes = f"Over {count_of(summary.values.scenes, 'scene')}"
    if not summary.is_complete:
        scenes = f"{scenes} done so far, of {summary.spec.n_scenes:,},"
    return f"{scenes} at {words}" if words else scenes


def _gain_words(summary: Summary, point: int, case: ReportCase) -> str:
    """Return the two gains of a case, and how far they are from the omnidirectional vehicle's."""
    row, told = summary.row(point, case), []
    for name, words in _GAINS:
        value, low, high = three_of(row, name)
        sure = f" ({percent(CONFIDENCE)} confidence: {span(low, high, summary.quantity)})"
        unknown = math.isnan(low) and math.isnan(high)
        told.append(f"{with_unit(value, summary.quantity)} {words}{'' if unknown else sure}")
    words = f"{case.phrase} gains {' and '.join(told)}"
    differences = _differences(row)
    if any(map(math.isnan, differences)) or case.place == case.whole:
        return words
    apart = " and ".join(less_or_more(each, summary.quantity) for each in differences)
    return f"{words}, which is {apart} than the omnidirectional one gains"


def _differences(row: Any) -> tuple[float, float]:
    return float(row["difference_median"]), float(row["difference_worst_tenth"])


def _least_tilt_words(summary: Summary, point: int, cases: Sequence[ReportCase]) -> str:
    """Return which of the tilts that were tried is the smallest that is near the omnidirectional vehicle."""
    tilts = [case for case in cases if case.tilt_deg is not None and case.place != case.whole]
    lowest = {case: min(_differences(summary.row(point, case))) for case in tilts}
    if not lowest or any(map(math.isnan, lowest.values())):
        return ""
    near = NEAR_BPS_HZ if summary.quantity.is_rate else NEAR_DB
    enough = [case for case in tilts if lowest[case] >= -near]
    least = min(enough, key=lambda case: (case.tilt_deg, case.place), default=None)
    which = "no other tilt is" if least is None else f"{least.phrase} is the smallest tilt"
    return (
        f"Of these cases {which} within {near:g} {summary.quantity.unit} of the omnidirectional vehicle, in "
        "the median and in the worst tenth."
    )


def _missing_words(reference: ReportCase) -> str:
    """Return which of the vehicles that the question is about are not in the study."""
    kinds = {
        "level vehicle with a vertical dipole": reference.role == LEVEL.name,
        "omnidirectional vehicle": reference.whole is not None,
    }
    missing = [kind for kind, known in kinds.items() if not known]
    return f"There is no {' and no '.join(missing)} in this study." if missing else ""


def _sweep_words(summary: Summary, point: int, case: ReportCase) -> str:
    """Return how the two gains of a case run over the other combinations of swept values."""
    told = []
    for other in [each for each in summary.points.shown if each != point][:_MOST_TOLD]:
        row = summary.row(other, case)
        gains = " and ".join(number(float(row[name]), summary.quantity) for name, _ in _GAINS)
        told.append(f"{gains} {summary.quantity.unit} at {summary.points.words(other)}")
    few = "" if len(summary.spec.points) <= len(told) + 1 else ", among others"
    return f"For {case.phrase} the two gains are {listed(told)}{few}." if told else ""


def unfinished_note(summary: Summary) -> str:
    """Return that the study is not finished, in a sentence; empty if it is.

    Args:
        summary: of a study.
    """
    if summary.is_complete:
        return ""
    done, whole = summary.values.scenes, summary.spec.n_scenes
    return (
        f"This study is not finished: {done:,} of {count_of(whole, 'scene')} ({percent(done / whole)}) are "
        "done. Everything below is about these."
    )


def outage_words(summary: Summary) -> str:
    """Return how often the requirement is missed, in a sentence; empty if there is none.

    Args:
        summary: of a study.
    """
    if summary.requirement is None or not (parts := _shares_of_scenes(summary, "outage")):
        return ""
    required = f"a {summary.quantity.smallest} of {summary.requirement:g} {summary.quantity.unit}"
    words = summary.points.words(len(summary.spec.points) - 1)
    return f"{begun(f'at {words} {required}' if words else required)} is missed in {listed(parts)}."


def null_words(summary: Summary) -> str:
    """Return how often the poses stand on a null, in a sentence; empty without jammers and eavesdroppers.

    Args:
        summary: of a study.
    """
    if not (parts := _shares_of_scenes(summary, "null_share")):
        return ""
    words = summary.points.words(len(summary.spec.points) - 1)
    source = (
        f"{'an eavesdropper' if summary.quantity.is_rate else 'a jammer'}{f' at {words}' if words else ''}"
    )
    return (
        f"The pose stands on a null towards {source} (gain 35 dB or more below the largest, as within 1 "
        f"degree of a dipole's axis) in {listed(parts)}. There small errors of attitude or position may cost "
        "much; `nullpose evaluate` states how much."
    )


def _shares_of_scenes(summary: Summary, name: str) -> list[str]:
    """Return a share of scenes for each case that has one, at the last combination of swept values."""
    point = len(summary.spec.points) - 1
    shares = ((case, float(summary.row(point, case)[name])) for case in summary.cases)
    return [f"{percent(share, 1)} of scenes by {case.phrase}" for case, share in shares if share >= 0.0]


def certainty_of(summary: Summary) -> str:
    """Return how many rows are how far proved, and what the others count as.

    Args:
        summary: of a study.
    """
    counts, scenes = summary.values.counts(), summary.values.scenes
    rows = sum(counts.values())
    if not rows:
        return ""
    kinds = [f"{count:,} {name.replace('-', ' ')}" for name, count in counts.items() if count]
    sentences = [f"Of {count_of(rows, 'row')}: {listed(kinds)}."]
    if counts["certified"] < rows:
        sentences.append(
            "Rows that are not certified count with the value of their pose, a lower bound of the optimum. "
            "Rows that failed have no pose and are left out."
        )
    if scenes < FEW_SCENES:
        tenth = count_of(max(1, scenes // 10), "scene")
        few = f"With {count_of(scenes, 'scene')} the worst tenth is {tenth}, so its statistics are rough."
        sentences.append(few)
    return " ".join(sentences)
