"""Trajectories against random and optimised flights, and against what is in their way.

Run with ``python -m benchmarks.soundness.trajectories``: in 50 scenes no flight may exceed a bound, and in
300 scenes with zones no flight that is reported may break what it is to keep to.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from rich.console import Console
from rich.progress import track

from benchmarks.soundness.airways import Airways
from benchmarks.soundness.flights import Attack, scores
from benchmarks.soundness.motion import make_motion_scene, make_zoned_scene, with_mast
from nullpose.errors import ScenarioError, SolveError
from nullpose.objectives import Quantity
from nullpose.physics import allowed_value
from nullpose.problem.family import still_scenes
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.solver.trajectory import Aim, Trajectory, solve_trajectory
from nullpose.solver.trajectory.course import Course
from nullpose.solver.trajectory.lattice import INSIDE

_WALKS, _CLIMBS, _BETTERED = 50, 6, 60  # flights against the bounds of a scene
_LIMIT_S = 0.6  # of a bound, and half of it where ways are checked
_NO_BOUND = 100.0  # a gap that asks for none
_FASTEST_M_S = 1000.0
_ROUNDING = 1e-9  # of values, in their unit
_SOLVED = 1e-3  # relative: the gap of poses
_AS_GOOD = 0.01  # likewise: where two searches end


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What became of a scene: how many flights were compared or segments checked, and what is wrong."""

    name: str
    flights: int
    segments: int
    seconds: float
    faults: tuple[str, ...]


def check_bounds(number: int, limit_s: float = _LIMIT_S) -> Verdict:
    """Let flights through the scene of a number try to exceed its bounds, and compare it with its like."""
    began, scenario = time.process_time(), make_motion_scene(number)
    rates = (Aim.MEAN_RATE,) * Quantity.of(scenario.at(0.0)).is_rate
    aims = [aim for aim in Aim if aim not in rates]
    try:
        found = {aim: solve_trajectory(scenario, aim, time_limit_s=limit_s) for aim in aims}
    except SolveError:  # nothing is stated
        return _verdict(scenario, began, 0, 0, [])
    airways = Airways(scenario)
    faults = [fault for each in found.values() for fault in _broken(each, airways)]
    compared = _attacked(scenario, found, airways, np.random.default_rng([20265, number]), faults)
    faults += _beside_its_like(scenario, found[aims[number % len(aims)]], limit_s)
    return _verdict(scenario, began, compared, len(aims) * len(airways.reach_m), faults)


def check_ways(number: int, limit_s: float = _LIMIT_S) -> Verdict:
    """Check what the flight through the scene of a number keeps to, with a mast in its way in some."""
    began, scenario = time.process_time(), make_zoned_scene(number)
    aim = (Aim.WORST, Aim.MEAN_DB)[number % 2]
    options = {"time_limit_s": 0.5 * limit_s} | ({"gap_db": _NO_BOUND} if number % 3 else {})
    options |= {"window_s": 2.0} if number % 10 == 0 else {}
    try:
        found = solve_trajectory(scenario, aim, **options)
        if number % 3 == 1:
            scenario = with_mast(scenario, found.positions_m)
            found = solve_trajectory(scenario, aim, **options)
    except (ScenarioError, SolveError):  # none was found, or it would start in the mast
        return _verdict(scenario, began, 0, 0, [])
    airways = Airways(scenario)
    return _verdict(scenario, began, 1, len(airways.reach_m), list(_broken(found, airways)))


def _verdict(scenario: Scenario, began: float, flights: int, segments: int, faults: list[str]) -> Verdict:
    seconds = time.process_time() - began
    return Verdict(
        name=scenario.name, flights=flights, segments=segments, seconds=seconds, faults=tuple(faults)
    )


def _broken(found: Trajectory, airways: Airways) -> Iterator[str]:
    """Yield where a flight does not keep to its limits, or its values to their order."""
    aim, value, bound = found.maximise, found.value, found.upper_bound
    broken = airways.faults(found.positions_m[None])
    yield from (f"{aim}: the flight {words}" for words, is_so in broken.items() if is_so)
    axes = np.array([pose.antenna_axis for pose in found.poses])
    places = zip(airways.scenes, found.positions_m, axes, strict=True)
    values = np.array([[allowed_value(scene, place_m, axis) for scene, place_m, axis in places]])
    again = float(scores(airways.scenes[0], values)[aim][0])
    if not abs(again - value) <= _ROUNDING:
        yield f"{aim}: the poses give {again!r}, not {value!r}"
    chain = {name: found.baselines[name] for name in ("hover", "greedy", "window")}
    yield from (
        f"{aim}: {name} has {less!r}, more than the flight, {value!r}"
        for name, less in chain.items()
        if less is not None and less > value + _ROUNDING
    )
    top = found.baselines["clairvoyant"]
    if not value <= bound + _ROUNDING <= top + 2.0 * _ROUNDING:
        yield f"{aim}: not value {value!r} <= bound {bound!r} <= clairvoyant {top!r}"


def _attacked(
    scenario: Scenario,
    found: dict[Aim, Trajectory],
    airways: Airways,
    rng: np.random.Generator,
    faults: list[str],
) -> int:
    """Compare flights with the bounds; return how many keep to all limits."""
    attack = Attack(airways, {aim: Course.of(scenario, aim) for aim in found}, rng)
    slow = attack.walks(4 * _CLIMBS, INSIDE)
    walks = attack.walks(2 * _WALKS + _BETTERED // 2)
    slow, walks = slow[airways.keeps(slow)], walks[airways.keeps(walks)]
    best = np.array([each.positions_m for each in found.values()])
    near = np.concatenate([np.resize(best, (_BETTERED // 2, *best.shape[1:])), walks[_WALKS:]])
    flights = np.concatenate([walks[:_WALKS], attack.climbs(slow[:_CLIMBS]), attack.bettered(near)])
    flights = flights[airways.keeps(flights)]
    for aim, reached in scores(airways.scenes[0], attack.values(flights)).items():
        bound = found[Aim(aim)].upper_bound
        if len(reached) and np.max(reached) > bound + _ROUNDING:
            faults.append(f"{aim}: a flight has {np.max(reached)!r}, above the bound {bound!r}")
    return len(flights)


def _beside_its_like(scenario: Scenario, found: Trajectory, limit_s: float) -> Iterator[str]:
    """Yield where slower, fastest or standing scenes have an answer that contradicts one."""
    aim, airframe = found.maximise, scenario.airframe
    slow = airframe.model_copy(update={"speed_max_m_s": 0.5 * airframe.speed_max_m_s})
    with suppress(ScenarioError, SolveError):  # too slow to get to its end
        slower = scenario.model_copy(update={"airframe": slow})
        value = solve_trajectory(slower, aim, gap_db=_NO_BOUND, time_limit_s=limit_s).value
        if value > found.upper_bound + _ROUNDING:
            yield f"{aim}: at half the speed {value!r}, above the bound {found.upper_bound!r}"
    fast, still = _without_limits(scenario, _FASTEST_M_S), standing(_without_limits(scenario, 1.0))
    for words, like, scenes, less in (
        (f"at {_FASTEST_M_S:g} m/s", fast, still_scenes(fast), found.gap_db),
        ("where nothing moves", still, [still.at(0.0)], _AS_GOOD),
    ):
        value = solve_trajectory(like, aim, time_limit_s=limit_s).value
        poses = [[solve(scene, gap=_SOLVED, time_limit_s=limit_s).objective.value for scene in scenes]]
        if value < (best := float(scores(scenes[0], np.array(poses))[aim][0])) - less:
            yield f"{aim}: {words} {value!r}, less than the best poses, {best!r}"


def _without_limits(scenario: Scenario, speed_m_s: float) -> Scenario:
    """Return a scene with another speed, free ends and nothing in the way."""
    free = {"start_m": None, "end_m": None, "speed_max_m_s": speed_m_s}
    update = {
        "airframe": scenario.airframe.model_copy(update=free),
        "airspace": scenario.airspace.model_copy(update={"no_fly": ()}),
        "buildings": (),
    }
    return scenario.model_copy(update=update)


def standing(scenario: Scenario) -> Scenario:
    """Return a scene in motion in which everything stays where it is at first."""
    table, first = scenario.to_dict(), scenario.at(0.0).to_dict()
    for kind in ("nodes", "jammers", "eavesdroppers", "sources", "destination"):
        if kind in first:
            table[kind] = first[kind]
    table["nodes"][0] = {**table["nodes"][0], "velocity_m_s": [0.0, 0.0, 0.0]}
    return Scenario.from_dict(table)


def main(arguments: list[str] | None = None) -> int:
    """Check scenes, print faults and counts; return 1 if there is a fault."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=50, help="how many with flights against the bounds")
    parser.add_argument("--zoned", type=int, default=300, help="how many with something in the way")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--time-limit", type=float, default=_LIMIT_S, help="seconds of a bound")
    options = parser.parse_args(arguments)
    checks = [(check_bounds, options.first + i) for i in range(options.scenes)]
    checks += [(check_ways, options.first + i) for i in range(options.zoned)]
    verdicts = []
    for check, number in track(checks, "trajectories", console=Console(stderr=True)):
        verdicts.append(verdict := check(number, options.time_limit))
        for fault in verdict.faults:
            print(f"{verdict.name}: {fault}", flush=True)
    print(summary(verdicts))
    return int(any(verdict.faults for verdict in verdicts))


def summary(verdicts: list[Verdict]) -> str:
    """Return how many scenes, flights and segments were checked, and how many faults were found."""
    flown = [verdict for verdict in verdicts if verdict.segments]
    faults = sum(len(verdict.faults) for verdict in verdicts)
    return (
        f"{len(verdicts)} scenes, {len(verdicts) - len(flown)} of them without a flight: "
        f"{sum(v.flights for v in flown):,} flights, {sum(v.segments for v in flown):,} segments, "
        f"{faults} faults; longest {max((v.seconds for v in verdicts), default=0.0):.1f} s"
    )


if __name__ == "__main__":
    sys.exit(main())
