"""Robust solves against errors and poses drawn at random: no error below a guarantee, no pose above a bound.

Run with ``python -m benchmarks.soundness.robust``.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import Counter
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track

from benchmarks.soundness.search import feasible, nearest_in_band
from nullpose.channel import PointChannels, excess_gain
from nullpose.scenario import Scenario
from nullpose.solver import solve

FloatArray = NDArray[np.float64]

_KEPT = 400  # errors that every pose of the search is judged by
_MANY = 20_000  # errors that a guarantee has to withstand
_ROUNDS, _CLOSER = 12, 500  # of a random search around the worst errors found
_WALKS, _STEPS = 12, 120
_URBAN = {"model": "elevation", "environment": "urban", "average": "power"}
CHANNELS: list[tuple[dict[str, object], dict[str, object], float]] = [
    ({}, {}, 0.0),
    ({"model": "power-law", "exponent": 3.0}, {"channel": "free-space"}, 14.0),
    ({"model": "power-law", "exponent": 2.5}, {}, 7.0),
    (_URBAN, {}, 6.0),
    (_URBAN | {"environment": "suburban", "average": "db"}, {"channel": "free-space"}, 6.0),
    (_URBAN | {"exponent": 2.6}, {}, 14.0),
]
"""The channel of every sixth scene, that of its jammers if it is another, and the reference gain [dB]."""


@dataclass(frozen=True, slots=True, eq=False)
class Errors:
    """Errors as unit vectors and shares, (n, ...): of the axis, of the position, of each jammer."""

    across: FloatArray
    turn: FloatArray
    position: FloatArray
    jammers: FloatArray

    @classmethod
    def drawn(cls, rng: np.random.Generator, count: int, n_jammers: int) -> Errors:
        """Return random errors, two thirds of each kind as large as may be."""
        inside = [rng.uniform(size=shape) ** (1.0 / 3.0) for shape in ((count, 1), (count, n_jammers, 1))]
        large = [rng.uniform(size=share.shape) < 0.67 for share in inside]
        sizes = [np.where(full, 1.0, share) for full, share in zip(large, inside, strict=True)]
        return cls(
            across=rng.normal(size=(count, 3)),
            turn=np.where(rng.uniform(size=count) < 0.67, 1.0, np.sqrt(rng.uniform(size=count))),
            position=_unit(rng.normal(size=(count, 3))) * sizes[0],
            jammers=_unit(rng.normal(size=(count, n_jammers, 3))) * sizes[1],
        )

    def around(self, rng: np.random.Generator, index: int, size: float, count: int) -> Errors:
        """Return errors close to one of them."""
        position = self.position[index] + size * rng.normal(size=(count, 3))
        jammers = self.jammers[index] + size * rng.normal(size=(count, *self.jammers.shape[1:]))
        return Errors(
            across=_unit(self.across[index][None]) + size * rng.normal(size=(count, 3)),
            turn=np.clip(self.turn[index] + size * rng.normal(size=count), 0.0, 1.0),
            position=position / np.maximum(1.0, np.linalg.norm(position, axis=-1, keepdims=True)),
            jammers=jammers / np.maximum(1.0, np.linalg.norm(jammers, axis=-1, keepdims=True)),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What became of a scene: its number, status, time, and what is unsound."""

    number: int
    status: str
    seconds: float
    faults: tuple[str, ...]


def _unit(x: FloatArray) -> FloatArray:
    return np.asarray(x / np.linalg.norm(x, axis=-1, keepdims=True))


def worst(scenario: Scenario, position_m: FloatArray, axis: FloatArray, errors: Errors) -> FloatArray:
    """Return the smallest SINR of a pose under each error, (n,): paper eq. 2.1, written down once more."""
    angle = math.radians(scenario.receiver.attitude_error_deg) * errors.turn
    across = _unit(np.cross(axis, errors.across))
    axes = np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * across
    positions = position_m + scenario.receiver.position_error_m * errors.position
    moved = scenario.jammer_uncertainty_m[:, None] * errors.jammers
    g0 = scenario.receiver.reference_gain

    def received(points: FloatArray, powers: FloatArray, channels: PointChannels | None) -> FloatArray:
        r = points - positions[:, None, :]
        distance2 = np.sum(r * r, axis=-1)
        sine2 = np.sum(np.cross(axes[:, None, :], r) ** 2, axis=-1) / distance2
        excess = 1.0 if channels is None else excess_gain(channels, r)
        return np.asarray(g0 * powers * sine2 / distance2 * excess)

    signal = received(scenario.node_positions_m[None], scenario.node_powers_w, scenario.node_channels)
    jammers_m = scenario.jammer_positions_m + moved
    jamming = received(jammers_m, scenario.jammer_powers_w, scenario.jammer_channels).sum(axis=1)
    return np.asarray((signal / (jamming + scenario.receiver.noise_power_w)[:, None]).min(axis=1))


def make_robust_scene(number: int) -> Scenario:
    """Return a random scene with errors."""
    rng = np.random.default_rng([20262, number])
    nodes = rng.uniform(0.0, [60.0, 60.0, 3.0], size=(int(rng.integers(1, 5)), 3))
    jammers = rng.uniform(0.0, [60.0, 60.0, 3.0], size=(int(rng.integers(1, 3)), 3))
    extent = float(rng.uniform(0.5, 3.5))
    sets = [extent, 0.5 * extent]
    receiver = {
        "noise_w": 1e-3,
        "reference_gain_db": 0.0,
        "attitude_error_deg": float(rng.choice([0.0, 1.0, 2.0, 5.0])),
        "position_error_m": float(rng.choice([0.0, 0.0, 0.3])),
    }
    frame = rng.choice([0, 1, 2])
    tilted = {"tilt_max_deg": 10.0, "mount_deg": 90.0}
    airframes = [{}, {"airframe": tilted}, {"airframe": {"preset": "level"}}]
    channel, jammer_channel, gain_db = CHANNELS[number % len(CHANNELS)]
    receiver["reference_gain_db"] = gain_db
    if channel.get("model") == "elevation":
        receiver["position_error_m"] = 0.0
    return Scenario.from_dict(
        {
            "name": f"robust {number}",
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": receiver,
            "nodes": [{"position_m": p, "power_w": 1.0} for p in nodes.tolist()],
            "jammers": [
                {"position_m": p, "power_w": float(10.0 ** rng.uniform(-1.0, 2.0))}
                | {"uncertainty_m": sets[int(rng.integers(2))]}
                | jammer_channel
                for p in jammers.tolist()
            ],
            **airframes[int(frame)],
            **({"channel": channel} if channel else {}),
        }
    )


def check_robust(number: int, *, gap: float = 0.02, time_limit_s: float = 10.0) -> Verdict:
    """Return whether guarantee and bound of a scene withstand a random search."""
    scenario = make_robust_scene(number)
    rng = np.random.default_rng([20263, number])
    began = time.perf_counter()
    solution = solve(scenario, robust=True, gap=gap, time_limit_s=time_limit_s)
    seconds = time.perf_counter() - began
    pose, guaranteed = solution.details.robust.pose, solution.details.robust.guaranteed
    faults = []
    least = _least(scenario, rng, pose.position_m, pose.antenna_axis)
    if least < guaranteed * (1.0 - 1e-12):
        faults.append(f"an error leaves {least!r}, less than the guaranteed {guaranteed!r}")
    bound = solution.objective.upper_bound
    assert bound is not None
    near = (np.array(pose.position_m), np.array(pose.antenna_axis))
    reached = _best_pose(scenario, rng, near)
    if reached > bound * (1.0 + 1e-9):
        faults.append(f"a pose seems to guarantee {reached!r}, above the bound {bound!r}")
    return Verdict(number=number, status=solution.status.value, seconds=seconds, faults=tuple(faults))


def _least(scenario: Scenario, rng: np.random.Generator, position_m: FloatArray, axis: FloatArray) -> float:
    """Return the smallest value under errors that random draws, closing in on the worst, find."""
    errors = Errors.drawn(rng, _MANY, len(scenario.jammers))
    values = worst(scenario, position_m, axis, errors)
    least, size = float(values.min()), 0.3
    index = int(values.argmin())
    for _ in range(_ROUNDS):
        closer = errors.around(rng, index, size, _CLOSER)
        values = worst(scenario, position_m, axis, closer)
        if values.min() < least:
            least, errors, index = float(values.min()), closer, int(values.argmin())
        size *= 0.6
    return least


def _best_pose(scenario: Scenario, rng: np.random.Generator, near: tuple[FloatArray, FloatArray]) -> float:
    """Return the largest least value over poses that random walks find, a third of them from a given pose."""
    kept = Errors.drawn(rng, _KEPT, len(scenario.jammers))
    nodes, band = scenario.node_positions_m, scenario.axis_band
    best = 0.0
    for walk in range(_WALKS):
        p = rng.uniform(nodes.min(axis=0) - 30.0, nodes.max(axis=0) + 30.0)
        p, u = (p * [1, 1, 0] + [0, 0, rng.uniform(8.0, 12.0)], rng.normal(size=3)) if walk % 3 else near
        u, value, size = nearest_in_band(u[None], *band)[0], 0.0, 8.0 if walk % 3 else 1.0
        for _ in range(_STEPS):
            new_p = p + size * rng.normal(size=3)
            new_p[2] = np.clip(new_p[2], 8.0, 30.0)
            new_u = nearest_in_band((u + 0.05 * size * rng.normal(size=3))[None], *band)[0]
            if not feasible(scenario, new_p[None])[0]:
                continue
            new_value = float(worst(scenario, new_p, new_u, kept).min())
            if new_value > value:
                p, u, value, size = new_p, new_u, new_value, size * 1.5
            else:
                size *= 0.93
        if value > best:
            best = max(best, _least(scenario, rng, p, u))
    return best


def main(arguments: list[str] | None = None) -> int:
    """Check scenes, print how they ended; return 1 if one of them is unsound."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=200, help="how many")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    options = parser.parse_args(arguments)
    numbers = range(options.first, options.first + options.scenes)
    verdicts = [check_robust(n) for n in track(numbers, "soundness", console=Console(stderr=True))]
    count = Counter(verdict.status for verdict in verdicts)
    seconds = sorted(verdict.seconds for verdict in verdicts)
    unsound = [verdict for verdict in verdicts if verdict.faults]
    print(
        f"{len(verdicts)} scenes: {count['certified']} certified, {count['gap-not-reached']} not, "
        f"{len(unsound)} unsound; median {seconds[len(seconds) // 2]:.2g} s, longest {seconds[-1]:.2g} s"
    )
    for verdict in unsound:
        print(f"scene {verdict.number}: {'; '.join(verdict.faults)}")
    return int(bool(unsound))


if __name__ == "__main__":
    sys.exit(main())
