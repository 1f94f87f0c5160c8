"""Random scenes with every antenna, on the drone and on the ground: level vehicles, gaps from 1e-6 to 0.5."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Table = dict[str, Any]

GAPS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5)
"""Gaps of the certificates that are checked."""
MOUNTS_DEG = (0.0, 30.0, 45.0, 89.999, 90.0)
"""Mounts of the antenna on level vehicles."""


def _short_dipole(rng: np.random.Generator) -> Table:
    return {}


def _leaky_dipole(rng: np.random.Generator) -> Table:
    return {"null_depth_db": float(rng.choice([0.0, 3.0, 20.0, 50.0]))}


def _half_wave(rng: np.random.Generator) -> Table:
    return {"kind": "half-wave"}


def _profile(rng: np.random.Generator) -> Table:
    """A gain that is the same all round, often with a lobe below zero."""
    degree = int(rng.integers(1, 7))
    rows = [[float(rng.normal() / (1.0 + n))] + [0.0] * (2 * n) for n in range(degree + 1)]
    rows[0] = [float(rng.uniform(0.5, 2.0))]
    if rng.uniform() < 0.3:  # the same upside down
        rows = [[row[0] * (1 - n % 2), *row[1:]] for n, row in enumerate(rows)]
    return {"kind": "pattern", "harmonics": rows, "normalise": str(rng.choice(["none", "peak"]))}


def _pattern(rng: np.random.Generator) -> Table:
    degree = int(rng.integers(1, 5))
    rows = [(rng.normal(size=2 * n + 1) / (1.0 + n)).tolist() for n in range(degree + 1)]
    return {"kind": "pattern", "harmonics": [[2.0], *rows[1:]]}


_ON_THE_DRONE: tuple[Callable[[np.random.Generator], Table], ...] = (
    _short_dipole,
    _leaky_dipole,
    _half_wave,
    _profile,
    _pattern,
)


def put_antennas(rng: np.random.Generator, table: Table) -> Table:
    """Return a scene with some antenna on the drone, and antennas on the ground that go with it."""
    choice = int(rng.integers(len(_ON_THE_DRONE)))
    kinds = ["isotropic", "circular", "dipole"][: 3 if choice < 2 else 2]  # whips need a dipole on the drone
    if rng.uniform() < 0.6:
        for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
            point["antenna"] = str(rng.choice(kinds))
            point["gain_dbi"] = float(rng.choice([0.0, 1.76, 2.15, -3.0]))
            if point["antenna"] == "dipole" and rng.uniform() < 0.3:
                point["antenna_axis"] = rng.normal(size=3).tolist()
            if point["antenna"] == "dipole" and rng.uniform() < 0.4:
                point["null_depth_db"] = float(rng.choice([0.0, 20.0]))
    antenna = _ON_THE_DRONE[choice](rng)
    return table | ({"antenna": antenna} if antenna else {})


def put_level_airframe(rng: np.random.Generator, table: Table) -> Table:
    """Return a scene with a vehicle that does not tilt, its antenna mounted at some angle."""
    return table | {"airframe": {"tilt_max_deg": 0.0, "mount_deg": float(rng.choice(MOUNTS_DEG))}}


def make_gap(number: int) -> float:
    """Return the gap that the scene of a number is proved to."""
    return GAPS[number % len(GAPS)]
