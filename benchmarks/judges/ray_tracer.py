"""Sionna RT as a judge: SINRs in the open, and lines of sight and SINRs among buildings."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.judges.cases import cases
from benchmarks.judges.engine import Engine
from benchmarks.judges.towns import towns
from benchmarks.judges.verdict import Verdict
from nullpose import Pose, Scenario, evaluate

_ALLOWED = 1e-4
_DEEP = 1e-4  # of an un-nulled link: beyond single precision
_NEAR_M = 1e-3  # likewise


def verdicts() -> Iterator[Verdict]:
    """Yield what Sionna RT says of every kind of antennas, and of buildings."""
    try:
        engine = Engine()
    except Exception as error:  # it cannot be installed everywhere: LLVM, the processor, the platform
        yield Verdict("Sionna RT", "SINR", 0, None, _ALLOWED, reason=str(error).splitlines()[0][:200])
        return
    found: dict[str, list[float]] = {}
    for name, scenario, poses in cases():
        found.setdefault(name, []).extend(deviations(scenario, poses, engine.gains(scenario, poses)))
    for name, values in found.items():
        yield Verdict(engine.name, name, len(values), max(values), _ALLOWED)
    for name, scenario, poses in towns():
        yield from _among_buildings(engine, name, scenario, poses)


def _among_buildings(engine: Engine, name: str, scenario: Scenario, poses: list[Pose]) -> Iterator[Verdict]:
    """Yield how many lines of sight differ, and how much the SINR does."""
    gains = engine.gains(scenario, poses)
    is_clear, is_near = lines_of_sight(scenario, np.array([pose.position_m for pose in poses]))
    differ = (is_clear != (gains > 0.0)) & ~is_near
    what = f"line of sight in {name}, {is_clear.mean():.0%} clear; {is_near.sum()} near an edge left out"
    yield Verdict(engine.name, what, int(np.sum(~is_near)), float(differ.sum()), 0.0, "links")
    kept = np.flatnonzero(~is_near.any(axis=1))
    values = deviations(scenario, [poses[place] for place in kept], gains[kept])
    yield Verdict(engine.name, f"SINR in {name}", len(values), max(values), _ALLOWED)


def deviations(scenario: Scenario, poses: list[Pose], gains: np.ndarray) -> list[float]:
    """Return how every node's SINR at every pose differs from that of the gains of its links."""
    received_w, count = gains * scenario.source_powers_w, len(scenario.nodes)
    noise_w = np.sum(received_w[:, count:], axis=1, keepdims=True) + scenario.receiver.noise_power_w
    theirs = received_w[:, :count] / noise_w
    ours = np.array([[link.sinr for link in evaluate(scenario, pose)] for pose in poses])
    to_nodes_m = scenario.node_positions_m - np.array([pose.position_m for pose in poses])[:, None]
    unnulled = scenario.node_powers_w / np.sum(to_nodes_m**2, axis=-1) / scenario.receiver.noise_power_w
    return list(np.ravel(np.abs(ours - theirs) / np.maximum(ours, _DEEP * unnulled)))


def lines_of_sight(scenario: Scenario, positions_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which links are clear, and which are not if buildings grow or shrink by a millimetre."""
    channels, prisms = scenario.source_channels, scenario.prisms
    clear = []
    for by_m in (-_NEAR_M, 0.0, _NEAR_M):
        grown = prisms._replace(
            sides=prisms.sides + np.array([0.0, 0.0, by_m]),
            base_m=prisms.base_m - by_m,
            least_height_m=prisms.least_height_m + by_m,
            most_height_m=prisms.most_height_m + by_m,
        )
        gain = channels._replace(prisms=grown).blocked_gain(positions_m, scenario.source_positions_m)
        clear.append(gain == 1.0)
    smaller, same, larger = clear
    return same, smaller != larger
