"""What stands beside the answer: how far the study is, how often a requirement is missed, what is proved."""

from __future__ import annotations

import math

from nullpose.report.numbers import begun, count_of, listed, percent
from nullpose.report.study.statistics import FEW_SCENES
from nullpose.report.study.summary import Summary

__all__ = ["certainty_of", "outage_words", "unfinished_note"]


def unfinished_note(summary: Summary) -> str:
    """Return that the study is not finished, in a sentence; empty if it is.

    Args:
        summary: of a study.
    """
    if summary.is_complete:
        return ""
    done, whole = summary.values.scenes, summary.spec.n_scenes
    return (
        f"This study is not finished: {done:,} of {count_of(whole, 'scene')} "
        f"({percent(done / whole)}) are done, and everything below is of these."
    )


def outage_words(summary: Summary) -> str:
    """Return how often the requirement is missed, in a sentence; empty if there is none.

    Args:
        summary: of a study.
    """
    if summary.requirement is None or not summary.values.scenes:
        return ""
    point = len(summary.spec.points) - 1
    shares = [(case, float(summary.row(point, case)["outage"])) for case in summary.cases]
    parts = [f"{percent(share, 1)} of scenes by {c.phrase}" for c, share in shares if not math.isnan(share)]
    if not parts:
        return ""
    words = summary.points.words(point)
    return (
        f"{f'At {words} a' if words else 'A'} {summary.quantity.smallest} of "
        f"{summary.requirement:g} {summary.quantity.unit} is missed in {listed(parts)}."
    )


def certainty_of(summary: Summary) -> str:
    """Return what is proved of the numbers, and what is left out of them.

    Args:
        summary: of a study.
    """
    counts = summary.values.counts()
    rows = sum(counts.values())
    if not rows:
        return ""
    sentences = [f"Of {count_of(rows, 'row')}, {counts['certified']:,} are certified."]
    if counts["certified"] == rows:
        sentences = [f"All {rows:,} poses are certified: proved to be the best within the gap asked for."]
    kinds = {
        "gap-not-reached": "with a proof that stopped before its gap",
        "best-found": "of which nothing is proved",
    }
    unproved = [f"{counts[name]:,} {words}" for name, words in kinds.items() if counts[name]]
    if unproved:
        reach = "enter by what their pose reaches, which is a lower bound of the best."
        sentences.append(f"{begun(listed(unproved))} {reach}")
    if counts["failed"]:
        are = "is" if counts["failed"] == 1 else "are"
        sentences.append(f"{count_of(counts['failed'], 'row')} failed, without a pose, and {are} left out.")
    if 0 < summary.values.scenes < FEW_SCENES:
        count = summary.values.scenes
        sentences.append(
            f"With {count_of(count, 'scene')} the worst tenth is {count_of(max(1, count // 10), 'scene')}: "
            "take it as an indication only."
        )
    return " ".join(sentences)
