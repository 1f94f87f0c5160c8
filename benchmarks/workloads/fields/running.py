"""The clock: nullpose, the peers and an untimed reference search on one scene."""

from __future__ import annotations

import time
from collections.abc import Iterator

from benchmarks.peers import Budget, FivePose, Peer
from benchmarks.workloads.fields.record import Record
from benchmarks.workloads.fields.scenes import Scene
from nullpose.physics import Pose, min_sinr
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.solver import Status, solve
from nullpose.solver.multistart import SearchSettings, multistart

__all__ = [
    "FULL",
    "NULLPOSE",
    "PROVED",
    "QUICK",
    "REFERENCE",
    "UNBOXED",
    "run_nullpose",
    "run_peer",
    "run_proved",
    "run_reference",
    "run_unboxed",
]

NULLPOSE = "nullpose"
PROVED = "nullpose-certified"
REFERENCE = "reference"
UNBOXED = "nullpose-unboxed"

FULL = Budget(evaluations=50_000, starts=128, samples=512)
QUICK = Budget(evaluations=5_000, starts=32, samples=128)

_SEED = 0
_REFERENCE_SETTINGS = SearchSettings(coarse=1920, polished=480, rounds=12, patience=4)


def run_nullpose(scene: Scene) -> Iterator[Record]:
    """Yield what the search of `solve` finds, without a proof, timed as its caller sees it."""
    yield _solved(scene, NULLPOSE, certify=False)


def run_proved(scene: Scene) -> Iterator[Record]:
    """Yield what `solve` finds with its proof, every setting as it comes."""
    yield _solved(scene, PROVED, certify=True)


def run_peer(peer: Peer, scene: Scene, budget: Budget) -> Iterator[Record]:
    """Yield what a peer finds at each of its stopping points; the clock stands still between them."""
    problem = FivePose.of(scene.scenario())
    seconds = 0.0
    began = time.perf_counter()
    try:
        for answer in peer.answers(problem, budget, _SEED):
            seconds += time.perf_counter() - began
            pose = problem.pose(answer.x)
            yield Record(
                scene=scene,
                method=peer.name,
                stage=answer.stage,
                value=min_sinr(problem.scenario, pose),
                seconds=seconds,
                evaluations=problem.evaluations,
                pose=_numbers(pose),
            )
            began = time.perf_counter()
    except Exception as error:  # whatever stops a peer is its result here, and the others go on
        yield Record(scene=scene, method=peer.name, stage="failed", status=f"{type(error).__name__}: {error}")


def run_reference(scene: Scene) -> Iterator[Record]:
    """Yield the best of a search some twenty times as long as that of `solve`, with another seed."""
    scenario = scene.scenario()
    family = build_family(scenario)
    began = time.perf_counter()
    found = multistart(family, AxisField.free(), seed=_SEED + 1, settings=_REFERENCE_SETTINGS)
    pose = Pose.from_axis(found.position_m, found.axis)
    yield Record(
        scene=scene,
        method=REFERENCE,
        stage="search",
        value=min_sinr(scenario, pose),
        seconds=time.perf_counter() - began,
        evaluations=found.evaluations,
        pose=_numbers(pose),
    )


def run_unboxed(scene: Scene) -> Iterator[Record]:
    """Yield what the search finds with x and y unbounded, which is how it would be asked without peers."""
    yield _solved(scene, UNBOXED, certify=False, boxed=False)


def _solved(scene: Scene, method: str, *, certify: bool, boxed: bool = True) -> Record:
    scenario = scene.scenario(boxed=boxed)
    began = time.perf_counter()
    solution = solve(scenario, certify=certify, seed=_SEED)
    seconds = time.perf_counter() - began
    return Record(
        scene=scene,
        method=method,
        stage="solve",
        value=min_sinr(scenario, solution.pose),
        seconds=seconds,
        evaluations=solution.stats.evaluations,
        pose=_numbers(solution.pose),
        certified=solution.status is Status.CERTIFIED,
    )


def _numbers(pose: Pose) -> tuple[float, ...]:
    return (*(float(x) for x in pose.position_m), pose.roll_rad, pose.pitch_rad)
