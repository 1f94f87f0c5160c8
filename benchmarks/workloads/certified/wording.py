"""The sentences of the section."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.provers import PROVERS
from benchmarks.workloads.certified.judging import SLACK, is_true, ratios, rival, times_faster
from benchmarks.workloads.certified.labels import LABELS
from benchmarks.workloads.certified.record import Record
from benchmarks.workloads.certified.running import GAP, NULLPOSE
from benchmarks.workloads.fields.wording import duration

__all__ = ["LIMITATIONS", "READING", "SETTINGS", "TIMES_FASTER", "headline", "opening", "verdict"]

TIMES_FASTER = 1000.0
"""The lead over the other solvers that is promised at every jamming power."""

READING = (
    "*Claimed* is the value that the method prints, *of its pose* what nullpose's physics makes of the pose "
    "that it returns, *bound* the bound that it prints, each relative to the best value of any pose. A claim "
    "counts as true if it is closed, if its pose reaches the value, or misses it by at most "
    f"{100 * SLACK:g} % of the gap, and if no pose is above the bound. A claim that is false, or not closed "
    "in time, is a failure."
)

SETTINGS = (
    (
        "nullpose, paper's scene proved",
        f"`solve(scenario, gap={GAP:g})`, kernels loaded, the whole Python call, median of 21",
    ),
    *((f"{prover.label}, certified", prover.settings) for prover in PROVERS),
)

LIMITATIONS = (
    "In the proofs, the other solvers are handed nullpose's optimum as a start, and only the part of space "
    "that its value leaves open; nullpose is timed from the scenario alone.",
    "The formulations for the other solvers are the best of about a dozen tried for each; a better one may "
    "exist.",
    "Whether a bound is true is checked against poses only: one that is too low, yet above every pose found, "
    "would pass.",
)


def opening(records: Sequence[Record]) -> str:
    """Return what was asked of whom."""
    caps = sorted({record.cap_s for record in records if record.cap_s > 0.0})
    allowed = f", in at most {caps[-1]:g} s each" if caps else ""
    missing = [prover.label for prover in PROVERS if prover.name not in {record.method for record in records}]
    absent = f" Not installed, hence left out: {', '.join(missing)}." if missing else ""
    return (
        "The optimum of `examples/paper.toml`, and a bound that no pose exceeds, to a relative gap of "
        f"{GAP:g}{allowed}, on one thread. The general solvers get lengths in units of 25 m, the optimum as "
        "a start, and, since they need a box, one that holds every pose as good as the start. Each runs in a "
        f"process of its own, whose start and imports are not timed.{absent}"
    )


def headline(records: Sequence[Record]) -> str:
    """Return how the promised lead over the other solvers fares, for the opening of the page."""
    leads = {ratio: times_faster(records, ratio) for ratio in ratios(records)}
    rivals = [found for ratio in leads if (found := rival(records, ratio)) is not None]
    ours = [record.seconds for record in records if record.method == NULLPOSE]
    finite = [lead for lead in leads.values() if lead < float("inf")]
    if not finite:
        return ""
    theirs = [found.seconds for found in rivals]
    # a lead that is not known meets nothing
    fate = "is met" if all(lead >= TIMES_FASTER for lead in leads.values()) else "is **missed**"
    return (
        f"The promise to prove the paper's scene to {GAP:g} at least {TIMES_FASTER:,.0f} times faster than "
        f"the faster of SCIP and MAiNGO {fate}: with the best formulations found for those solvers, the "
        f"faster of them closes {len(rivals)} of {len(leads)} jamming powers, in {duration(min(theirs))} to "
        f"{duration(max(theirs))}; nullpose takes {duration(min(ours))} to {duration(max(ours))}, and leads "
        f"{min(finite):.0f} to {max(finite):.0f} times. Those solvers are handed nullpose's optimum as a "
        "start and a box around every pose as good; nullpose gets the scenario alone."
    )


def verdict(records: Sequence[Record]) -> str:
    """Return who closes what, and by how much nullpose leads."""
    asked = ratios(records)
    ours = [record for record in records if record.method == NULLPOSE]
    closed = sum(map(is_true, ours))
    times = f"{duration(min(r.seconds for r in ours))} to {duration(max(r.seconds for r in ours))}"
    first = f"**nullpose certifies {closed} of {len(asked)} cases, in {times}.** "
    rivals = [found for ratio in asked if (found := rival(records, ratio)) is not None]
    if not rivals:
        return first + "No other solver makes a true claim in time."
    leads = {found.jamming_ratio: times_faster(records, found.jamming_ratio) for found in rivals}
    least, most = min(leads, key=leads.__getitem__), max(leads, key=leads.__getitem__)
    names = sorted({LABELS[found.method] for found in rivals})
    return first + (
        f"The fastest true claim of another solver ({', '.join(names)}) takes {leads[least]:.1f} times as "
        f"long at $P_M / P$ = {least:g}, where it comes closest, and {leads[most]:.1f} times at {most:g}."
    )
