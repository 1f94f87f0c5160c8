"""The prose of the workload's section: what was run, how to read it, what it does not show."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from benchmarks.peers import GENERAL_PURPOSE, PEERS, TAILORED
from benchmarks.workloads.fields.labels import LABELS
from benchmarks.workloads.fields.record import Record
from benchmarks.workloads.fields.running import FULL, PROVED, QUICK
from benchmarks.workloads.fields.scenes import MARGIN_M, SIDE_M
from benchmarks.workloads.fields.standing import HIT, SHIFT_S, Standing, nearest_rival, nullpose_standing

__all__ = ["LIMITATIONS", "READING", "SETTINGS", "duration", "opening", "proof", "verdict"]

LIMITATIONS = (
    "In the comparison of searches the best value known of a scene is the best that any method found there.",
    "One run per scene and method, with one seed: how much a stochastic peer varies from seed to seed shows "
    "only through the number of scenes.",
    "The searches that see values only are held to roll and pitch within 90 degrees, as the paper states the "
    "problem; with the axis as a unit vector some of them do better.",
    "Every peer ends with a local search that uses nullpose's compiled slopes and knows that the problem "
    "is a max-min. A plain SciPy program has neither: the rows *search* show its results.",
    "The scenes are of one kind: nodes of equal power, on flat ground, all jammers of a scene equally "
    "strong.",
)

READING = (
    "A peer's last stage is its answer; *search* is its answer before the polish, and the numbers of "
    "starts are points at which the multistart could have been stopped. *Mean* is the shifted geometric "
    f"mean, with a shift of {1e3 * SHIFT_S:g} ms; *worst shortfall* is the largest `1 - value / best "
    "known`; *ratio* is the median time over nullpose's."
)

SETTINGS = (
    (
        "nullpose, search alone",
        "`solve(scenario, certify=False, seed=0)`, the search that the peers are compared with, the whole "
        "Python call timed",
    ),
    (
        "nullpose, certified",
        "`solve(scenario, seed=0)`, every setting as it comes: a lighter search, then a proof to a relative "
        "gap of 1e-6 up to 3 nodes and of 1e-4 beyond, on every core if it takes long",
    ),
    (
        "budget of a peer",
        f"{FULL.evaluations:,} evaluations a scene, or {FULL.starts} starts, or {FULL.samples} sample "
        f"points; in a quick run {QUICK.evaluations:,}, {QUICK.starts} and {QUICK.samples}",
    ),
    *((peer.label, peer.settings) for peer in PEERS),
    ("reference search", "nullpose's multistart with 20 times the work and another seed; not ranked"),
)


def opening(records: Sequence[Record]) -> str:
    """Return what was run."""
    scenes = {record.scene for record in records}
    nodes, jammers = _listed(scene.nodes for scene in scenes), _listed(scene.jammers for scene in scenes)
    powers, seeds = _listed(scene.jamming_ratio for scene in scenes), _listed(scene.seed for scene in scenes)
    return (
        f"{len(scenes)} scenes: {nodes} nodes; {jammers} jammers; total jamming power over one node's power, "
        f"$P_M / P$, of {powers}; seeds {seeds}. Nodes and jammers lie at random on the ground in a square "
        f"of {SIDE_M:g} m; noise over power is 1e-3 and the altitude 8 to 30 m, as in the paper. General "
        f"solvers need a box: x and y are held to the square and {MARGIN_M:g} m around it for every method, "
        "nullpose included.\n\n"
        "The peers minimise, over (x, y, z, roll, pitch) scaled to the unit cube, the compiled function that "
        "nullpose maximises, on one thread, after a warm-up, and each may end with the same polish: a local "
        "search on the epigraph form, which kinks do not stop. Times are wall times; nullpose's is that of "
        f"the whole Python call. A *hit* is a pose whose smallest SINR is within {_power(HIT)}, relative, of "
        "the best that any method found in that scene, evaluated for all by the same plain code."
    )


def verdict(found: Sequence[Standing]) -> str:
    """Return how nullpose compares with the fastest peers that hit as often, general and tailored."""
    ours = nullpose_standing(found)
    return (
        f"**nullpose's search hits in {ours.hits} of {ours.scenes} scenes, median "
        f"{duration(ours.median_s)}.** "
        f"{_against('general-purpose solver', nearest_rival(found, GENERAL_PURPOSE), ours)} "
        f"{_against('solver made for this problem', nearest_rival(found, TAILORED), ours)}"
    )


def proof(records: Sequence[Record], found: Sequence[Standing]) -> str:
    """Return what a proof adds: how often it closes, and what it takes."""
    proved = [record for record in records if record.method == PROVED]
    if not proved:
        return ""
    closed = sum(record.certified for record in proved)
    ours, theirs = nullpose_standing(found), next(s for s in found if s.method == PROVED)
    return (
        f"With its proof, which is how `solve` runs unless told otherwise, nullpose certifies {closed} of "
        f"{len(proved)} scenes to its default gap, in {duration(theirs.median_s)} in the median against "
        f"{duration(ours.median_s)} for the search alone. The proof asks for the gap and not for the last "
        "digit, so that a pose within the gap may be no hit."
    )


def _against(kind: str, rival: Standing, ours: Standing) -> str:
    theirs = (
        f"{LABELS[rival.method]} ({rival.stage}): {rival.hits} hits, median {duration(rival.median_s)}, "
        f"{rival.median_s / ours.median_s:.1f} times nullpose's."
    )
    if rival.hit_rate >= ours.hit_rate:
        return f"The fastest {kind} that hits as often is {theirs}"
    return f"No {kind} hits as often; of those that hit most often the fastest is {theirs}"


def duration(seconds: float) -> str:
    """Return a time with its unit, milliseconds up to a second."""
    if seconds >= 1.0:
        return f"{seconds:.2f} s"
    return f"{1e3 * seconds:.1f} ms" if seconds < 0.1 else f"{1e3 * seconds:.0f} ms"


def _power(value: float) -> str:
    return f"{value:g}".replace("e-0", "e-")


def _listed(values: Iterable[float]) -> str:
    return ", ".join(f"{value:g}" for value in sorted(set(values)))
