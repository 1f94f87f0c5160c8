"""The report as Markdown: the answer first, then each part with its figure and its tables."""

from __future__ import annotations

from collections.abc import Collection

from nullpose.report.numbers import count_of, escaped, percent
from nullpose.report.study import tables
from nullpose.report.study.answer import answer_of
from nullpose.report.study.cases import reference_of
from nullpose.report.study.notes import certainty_of, outage_words, unfinished_note
from nullpose.report.study.statistics import CONFIDENCE, FEW_SCENES, replicates_of
from nullpose.report.study.summary import Summary

__all__ = ["report_text", "title_of"]

_SURE = percent(CONFIDENCE)


def title_of(summary: Summary) -> str:
    """Return the title of a report: the study's name.

    Args:
        summary: of the study.
    """
    return summary.spec.name or "A study without a name"


def report_text(summary: Summary, figures: Collection[str]) -> str:
    """Return the report as Markdown; figures are looked for in the folder ``figures`` beside it.

    Args:
        summary: of the study.
        figures: names of those that were drawn.
    """
    note = unfinished_note(summary)
    blocks = [f"# {escaped(title_of(summary))}", f"> **{note}**" if note else ""]
    blocks += map(escaped, (answer_of(summary), outage_words(summary), certainty_of(summary)))
    if summary.values.scenes:
        blocks.append(_definitions(summary))
        for part in (_levels, _gains, _sweep, _best, _outage, _robustness, _effort):
            blocks += part(summary, figures)
    return "\n\n".join(filter(None, [*blocks, *_data(summary)])) + "\n"


def _definitions(summary: Summary) -> str:
    quantity = summary.quantity
    return (
        f"*Median gain*: the median over scenes of the difference in {quantity.smallest} "
        f"({quantity.unit}) on the same scene. *Gain in the worst tenth*: the difference between the two "
        "cases' 10th percentiles, which nine scenes in ten reach or exceed, each over its own worst scenes. "
        f"Numbers in brackets are {_SURE} confidence intervals."
    )


def _figure(name: str, figures: Collection[str], caption: str) -> list[str]:
    words = escaped(caption)
    return [f"![{words}](figures/{name}.png)", f"*{words}*"] if name in figures else []


def _tabled(heading: str, table: str) -> list[str]:
    return [f"**{heading}**", table] if table else []


def _levels(summary: Summary, figures: Collection[str]) -> list[str]:
    quantity = summary.quantity
    shown, count = len(summary.points.shown), len(summary.spec.points)
    few = f"{shown} of {count:,} combinations of swept values are shown; `summary.csv` has all."
    robust = " Of robust cases it is what is guaranteed under the errors stated."
    caption = (
        f"Share of scenes whose {quantity.smallest} is no more than what is across. Each band holds a whole "
        f"true curve with {_SURE} confidence; it is drawn as far as there are numbers."
    )
    return [
        f"## {quantity.smallest.capitalize().replace('sinr', 'SINR')}",
        f"The {quantity.smallest} over the nodes at each case's pose, as it is distributed over scenes."
        f"{robust if summary.has_robust else ''}",
        *_figure("distribution", figures, caption),
        few if shown < count else "",
        *_tabled(f"Median, {quantity.unit}", tables.level_table(summary, "median")),
        *_tabled(
            f"Worst tenth (10th percentile), {quantity.unit}", tables.level_table(summary, "worst_tenth")
        ),
    ]


def _gains(summary: Summary, figures: Collection[str]) -> list[str]:
    table = tables.gain_table(summary, "gain_median")
    if not table:
        return []
    references = [
        f"{of_what} is measured against {escaped(f'{one.phrase} ({one.name})')} on the same scenes."
        for robust, of_what in ((False, "Each case"), (True, "What is guaranteed"))
        if (one := reference_of(summary.cases, robust=robust, against=summary.against)) is not None
    ]
    first = summary.reference(summary.cases[0])
    level = " over the level vehicle" if first is not None and first.tilt_deg == 0.0 else ""
    unit = summary.quantity.unit
    caption = (
        "Disc: median of the gains on the same scenes; diamond: gain of the worst tenth; lines: their "
        f"{_SURE} confidence intervals; bar: from what nine scenes in ten gain to what one in ten does."
    )
    return [
        f"## Gain{level}",
        " ".join(references),
        *_figure("gain", figures, caption),
        *_tabled(f"Median of the gains, {unit}", table),
        *_tabled(
            f"Gain of the worst tenth (difference of the 10th percentiles), {unit}",
            tables.gain_table(summary, "shift_worst_tenth"),
        ),
        *_tabled(
            f"10th percentile of the gains (nine scenes in ten gain this or more), {unit}",
            tables.gain_table(summary, "gain_worst_tenth"),
        ),
        *_tabled(
            "Share of the omnidirectional vehicle's median gain, %",
            tables.share_table(summary, "share_of_median"),
        ),
        *_tabled(
            "Share of its gain in the worst tenth, %", tables.share_table(summary, "share_of_worst_tenth")
        ),
    ]


def _sweep(summary: Summary, figures: Collection[str]) -> list[str]:
    if "sweep" not in figures:
        return []
    caption = f"Median and worst tenth of the {summary.quantity.smallest} along the sweep."
    return ["## Along the sweep", *_figure("sweep", figures, caption)]


def _best(summary: Summary, figures: Collection[str]) -> list[str]:
    if len(summary.cases) < 2:
        return []
    robust = " Robust cases are compared with one another only." if summary.has_robust else ""
    return [
        "## How often each case is the best",
        "A case counts in a scene if no other reaches more than its own bound: it is the best as far as its "
        "certified gap tells. Without a certificate its value alone counts. Cases that tie count each, so "
        f"that shares add up to more than 100 %.{robust}",
        *_figure("best", figures, "Share of scenes in which no other case is better; ties count for each."),
        *_tabled("Share of scenes, %", tables.best_table(summary)),
    ]


def _outage(summary: Summary, figures: Collection[str]) -> list[str]:
    if "outage" not in figures:
        return []
    quantity = summary.quantity
    option = "--requirement-bps-hz" if quantity.is_rate else "--requirement-db"
    words = (
        f"The share of scenes whose {quantity.smallest} falls short of what is required. A requirement is "
        f"set by `nullpose study report {option}`."
    )
    return [
        "## Outage",
        words,
        *_figure("outage", figures, f"Outage probability against the required {quantity.noun}."),
        *_tabled("Share of scenes that miss the requirement, %", tables.outage_table(summary)),
    ]


def _robustness(summary: Summary, figures: Collection[str]) -> list[str]:
    table = tables.cost_table(summary)
    if not table:
        return []
    caption = "What robust cases give up of what the same vehicle reaches if everything is as stated."
    return [
        "## Cost of robustness",
        f"The {summary.quantity.smallest} of the same vehicle's best pose if everything is as stated, less "
        "what its robust pose guarantees under the errors, on the same scene.",
        *_figure("robustness", figures, caption),
        *_tabled(f"Median; what one scene in ten exceeds, {summary.quantity.unit}", table),
    ]


def _effort(summary: Summary, figures: Collection[str]) -> list[str]:
    return [
        "## Proofs, gaps and time",
        "Rows of all combinations by status. *Certified*: no pose exceeds the value by more than the gap "
        "asked for. *Gap not reached*: a limit ended the proof. *Best found*: nothing is proved. *Failed*: "
        "there is no pose, and the row is in no distribution. The rigour of all bounds is *floating-point*: "
        "a study keeps no certificates.",
        tables.status_table(summary),
        *_figure("effort", figures, "Time of a solve, and relative gap between bound and value."),
        tables.effort_table(summary),
        *_tabled("Why rows failed or were not certified", tables.reasons_table(summary)),
    ]


def _data(summary: Summary) -> list[str]:
    spec = summary.spec
    gap = "by the number of nodes" if spec.gap is None else f"{spec.gap:g}"
    return [
        "## How it is calculated, and the data",
        f"{count_of(spec.n_scenes, 'scene')} from seed {spec.seed}, gap {gap}; bands of distribution "
        "functions after Dvoretzky, Kiefer and Wolfowitz, intervals of quantiles by order statistics, of "
        "shares after Clopper and Pearson, and of differences and ratios of quantiles by a bootstrap over "
        f"scenes ({replicates_of(summary.values.scenes):,} replicates, seeded; with fewer than {FEW_SCENES} "
        "scenes none is given). Quantiles are numbers that occur: the smallest that the share of scenes does "
        "not exceed.",
        "`study.csv` has a row for each scene, combination and case; `summary.csv` one for each combination "
        "and case, with every number above. In one line each, in the study's folder:",
        '```python\nframe = nullpose.study.monte_carlo.read_study(".").frame()    # pandas\n'
        'arrays = nullpose.study.monte_carlo.read_study(".").xarray()  # by scene, swept value and case\n```',
    ]
