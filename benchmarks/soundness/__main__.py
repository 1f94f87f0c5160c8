"""Run with ``python -m benchmarks.soundness``: a thousand awkward scenes, seeded.

With ``--feature airframe`` (or another, or ``all``) scenes that ask for more than the paper's do.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor
from functools import partial

from rich.console import Console
from rich.progress import track

from benchmarks.soundness.check import Outcome, check_scene
from benchmarks.soundness.features import FEATURES, make_feature_scene
from benchmarks.soundness.scenes import Scene, make_scene


def main(arguments: list[str] | None = None) -> int:
    """Check scenes, print a table by kind; return 1 if one of them is unsound."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000, help="how many")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--starts", type=int, default=200, help="random walks of the independent search")
    parser.add_argument("--feature", choices=[*FEATURES, "all"], help="scenes of this kind, or of each")
    parser.add_argument("--time-limit", type=float, default=5.0, help="seconds of a proof")
    parser.add_argument("--processes", type=int, default=1, help="how many check scenes at once")
    options = parser.parse_args(arguments)
    console = Console(stderr=True)
    numbers = range(options.first, options.first + options.scenes)
    scenes = scenes_of(options.feature, numbers)
    with ProcessPoolExecutor(options.processes) as pool:
        checked = pool.map(
            partial(check_scene, starts=options.starts, time_limit_s=options.time_limit), scenes
        )
        outcomes = list(track(checked, description="soundness", total=len(scenes), console=console))
    print(table(outcomes))
    for outcome in outcomes:
        for fault in outcome.faults:
            print(f"scene {outcome.scene.number} ({outcome.scene.kind}, {outcome.scene.scheme}): {fault}")
    return int(any(outcome.faults for outcome in outcomes))


def scenes_of(feature: str | None, numbers: Iterable[int]) -> list[Scene]:
    """Return the scenes of some numbers: awkward ones, or those of a feature, or of every feature."""
    if feature is None:
        return [make_scene(number) for number in numbers]
    some = FEATURES if feature == "all" else (feature,)
    return [make_feature_scene(one, number) for one in some for number in numbers]


def table(outcomes: list[Outcome]) -> str:
    """Return the outcomes by kind as a Markdown table."""
    lines = [
        "| kind | scenes | certified | gap not reached | search within 1e-3 of the value "
        "| below `--fast` or a subset | promised | of these verified | faults |",
        "|:--|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    kinds = dict.fromkeys(outcome.scene.kind for outcome in outcomes)
    for kind in (*kinds, "all"):
        some = [o for o in outcomes if kind in ("all", o.scene.kind)]
        count = Counter(o.status for o in some)
        near = sum(o.searched >= o.value * (1.0 - 1e-3) for o in some)
        below = sum(any(" is below that " in fault for fault in o.faults) for o in some)
        promised, checked = sum(o.promised for o in some), sum(o.checked for o in some)
        refused = sum(any("certificate" in fault for fault in o.faults) for o in some)
        faults = sum(bool(o.faults) for o in some)
        lines.append(
            f"| {kind} | {len(some)} | {count['certified']} | {count['gap-not-reached']} "
            f"| {near} | {below} | {promised} | {checked - refused} of {checked} checked | {faults} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
