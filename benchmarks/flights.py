"""Scenes in motion with known trajectories, and what planning is worth in each.

``python -m benchmarks.flights`` solves all of them for two aims and prints a table.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable

import numpy as np

from nullpose import Scenario, Trajectory, solve_trajectory

_TIMES_S = np.arange(61.0)
_STANDING = np.zeros(61)


def _track(x, y, z: float) -> list[list[float]]:
    x, y = np.broadcast_to(x, 61), np.broadcast_to(y, 61)
    return np.column_stack([_TIMES_S, x, y, np.full(61, z)]).tolist()


def _along(stops: list[tuple[float, float]], speed_m_s: float) -> list[list[float]]:
    """Drive along a road of straight parts."""
    places = np.array(stops)
    metres = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))])
    driven = np.minimum(speed_m_s * _TIMES_S, metres[-1])
    return _track(np.interp(driven, metres, places[:, 0]), np.interp(driven, metres, places[:, 1]), 0.0)


def _circle() -> tuple[list, list]:
    a = 0.25 * _TIMES_S + 0.3
    return [_track(0, 0, 0), _track(0, 50, 0)], [_track(20 * np.cos(a), 25 + 20 * np.sin(a), 4)]


def _cross() -> tuple[list, list]:
    along, slope = 8 * (_TIMES_S - 30), np.radians(15)
    return [_track(0, 0, 0), _track(0, 50, 0)], [_track(along * np.cos(slope), 20 + along * np.sin(slope), 4)]


def _convoy() -> tuple[list, list]:
    places = [(0, 0), (12, 8), (-10, 16), (9, 28), (-4, 38)]
    nodes = [_track(x, y + 3 * _TIMES_S, 0) for x, y in places]
    return nodes, [_track(20, 110, 4), _track(90 - 3.5 * _TIMES_S, 40 + 1.5 * _TIMES_S, 4)]


def _five() -> tuple[list, list]:
    nodes = [_track(x, y, 0) for x, y in [(0, 0), (30, 5), (38, 30), (12, 44), (-14, 25)]]
    circling = _track(15 + 30 * np.cos(0.15 * _TIMES_S), 20 + 30 * np.sin(0.15 * _TIMES_S), 2)
    return nodes, [_track(-25 + 1.4 * _TIMES_S, 20, 2), circling]


def _roads() -> tuple[list, list]:
    nodes = [
        _along([(-80, 0), (0, 0), (0, 90)], 3),
        _along([(60, 4), (-100, 4)], 2.5),
        _along([(4, -70), (4, 10), (80, 10)], 2),
    ]
    return nodes, [_track(12, -9, 3)]


def _flypast() -> tuple[list, list]:
    nodes = [_track(x, y, 0) for x, y in [(0, 0), (40, 10), (15, 45)]]
    return nodes, [_track(-600 + 25 * _TIMES_S, 60 - 1.5 * _TIMES_S, 40)]


def _slow() -> tuple[list, list]:
    nodes = [_track(x, y, 0) for x, y in [(0, 0), (30, 0), (15, 26)]]
    return nodes, [_track(15 + 20 * np.cos(0.4 * _TIMES_S), 9 + 20 * np.sin(0.4 * _TIMES_S), 1)]


_MOTIONS: dict[str, Callable[[], tuple[list, list]]] = {
    "circle": _circle, "cross": _cross, "convoy": _convoy, "five": _five, "roads": _roads,
    "flypast": _flypast, "slow": _slow,
}  # fmt: skip
_FIRST = "circle", "cross", "convoy"
EIGHTEEN = [(name, ratio, speed) for name in _FIRST for ratio in (1, 100) for speed in (2, 5, 10)]
CASES = [*EIGHTEEN, ("five", 10, 4), ("roads", 10, 5), ("flypast", 100, 5), ("slow", 10, 3)]
"""(motion, P_M / P, largest speed in m/s)."""


def scene(name: str, ratio: float, speed_m_s: float) -> Scenario:
    """Build a scene of 61 instants, free in start and attitude.

    Args:
        name: of the motion.
        ratio: power of each jammer over that of a node.
        speed_m_s: the vehicle's.
    """
    nodes, jammers = _MOTIONS[name]()
    return Scenario.from_dict(
        {
            "name": f"{name} / {ratio:g} / {speed_m_s:g}",
            "time": {"duration_s": 60.0, "step_s": 1.0},
            "airspace": {"altitude_m": [8.0, 30.0]},
            "airframe": {"preset": "omnidirectional", "speed_max_m_s": speed_m_s},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [_point(track, 1.0) for track in nodes],
            "jammers": [_point(track, ratio) for track in jammers],
        }
    )


def _point(track: list[list[float]], power_w: float) -> dict[str, object]:
    return {"position_m": track[0][1:], "track": track, "power_w": power_w}


AIMS = "worst", "mean-db"
COLUMNS = "hover", "greedy", "flight", "bound"


def row(case: tuple[str, float, float], found: dict[str, Trajectory]) -> str:
    """Write a row of the table: for each aim two simpler flights, the flight found and its bound, dB."""
    numbers = []
    for each in found.values():
        values = {**each.baselines, "flight": each.value, "bound": each.upper_bound}
        numbers += ["-" if values[name] is None else f"{values[name]:.2f}" for name in COLUMNS]
    return f"| {' / '.join(map(str, case))} | {' | '.join(numbers)} |"


def main() -> None:
    """Print a row for each scene."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--time-limit", type=float, default=15.0, metavar="S")
    limit_s = parser.parse_args().time_limit
    heads = [f"{aim}: {name}" for aim in AIMS for name in COLUMNS]
    print(f"| scene | {' | '.join(heads)} |\n|---{'|--:' * len(heads)}|")
    for case in CASES:
        found = {aim: solve_trajectory(scene(*case), aim, time_limit_s=limit_s) for aim in AIMS}
        print(row(case, found), flush=True)


if __name__ == "__main__":
    main()
