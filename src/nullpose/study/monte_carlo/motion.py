"""How drawn points move: at a constant velocity, or from one random waypoint to the next."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from nullpose.files import PlainTable
from nullpose.scenario.faults import require
from nullpose.scenario.rules import MOST_MEMBERS
from nullpose.study.monte_carlo.distribution import Distribution
from nullpose.study.monte_carlo.layout import Points


def drawn_motions(
    points: Points,
    starts_m: Sequence[Sequence[float]],
    duration_s: float,
    chance: Callable[[str], np.random.Generator],
) -> PlainTable:
    """Draw how points move, as columns of their tables by key; none where they stand.

    The waypoints are those of Johnson and Maltz (1996): a place drawn evenly in the area, a speed for the way
    there, a pause. A point keeps its waypoints with other speeds and pauses, beside more points, and for a
    longer time.

    Args:
        points: how they are drawn.
        starts_m: where they are at first, (n, 3) [m].
        duration_s: of the scene [s].
        chance: gives the stream of each quantity.

    Raises:
        ScenarioError: a track has too many rows.
    """
    if points.motion is None or points.speed_m_s is None:
        return {}
    count = len(starts_m)
    if points.motion == "constant-velocity":
        speeds_m_s = points.speed_m_s.draw(chance("speed_m_s"), count)
        degrees = (points.direction_deg or Distribution(uniform=(0.0, 360.0))).draw(
            chance("direction_deg"), count
        )
        along = np.exp(1j * np.radians(degrees))
        velocities_m_s = speeds_m_s * np.stack([along.real, along.imag, np.zeros(count)])
        return {"velocity_m_s": velocities_m_s.T.tolist()}
    streams = [chance(stream).spawn(count) for stream in ("waypoints", "speed_m_s", "pause_s")]
    return {
        "track": [
            _track(points, points.speed_m_s, start_m, duration_s, chances)
            for start_m, *chances in zip(starts_m, *streams, strict=True)
        ]
    }


def _track(
    points: Points,
    speed_m_s: Distribution,
    start_m: Sequence[float],
    duration_s: float,
    chances: Sequence[np.random.Generator],
) -> list[list[float]]:
    """Draw the rows of a track, departures and arrivals, to one that is not before the end."""
    placing, speeding, pausing = chances
    rows, pause = [[0.0, *start_m]], points.pause_s or Distribution(fixed=0.0)
    while rows[-1][0] < duration_s:
        require(
            len(rows) < MOST_MEMBERS,
            f"{type(points).__name__.lower()}.motion",
            f"a track has more than {MOST_MEMBERS} rows; make the area larger, or speeds lower",
        )
        t_s, *here_m = rows[-1]
        there_m = [*points.evenly_m(placing, 1)[0].tolist(), start_m[2]]
        t_s += math.dist(here_m, there_m) / float(speed_m_s.draw(speeding, 1)[0])
        rows.append([t_s, *there_m])
        if (pause_s := float(pause.draw(pausing, 1)[0])) > 0.0:
            rows.append([t_s + pause_s, *there_m])
    return rows
