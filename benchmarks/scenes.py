"""Random scenes, each made from its own parameters alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from nullpose.scenario import Scenario

SIDE_M = 100.0
ALTITUDE_M = (8.0, 30.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """The parameters of a random scene.

    Args:
        jamming_ratio: total jamming power over the power of one node; the jammers share it evenly.
        seed: of the positions.
    """

    nodes: int
    jammers: int
    jamming_ratio: float
    seed: int

    def scenario(self, *, boxed: bool = True) -> Scenario:
        """Build the scene: nodes and jammers uniform over the square, on the ground."""
        rng = np.random.default_rng([self.nodes, self.jammers, round(10 * self.jamming_ratio), self.seed])
        points = rng.uniform(0.0, SIDE_M, size=(self.nodes + self.jammers, 2)).tolist()
        side = (-25.0, SIDE_M + 25.0)
        power_w = self.jamming_ratio / self.jammers
        return Scenario.from_dict(
            {
                "name": f"field {self}",
                "airspace": {"altitude_m": ALTITUDE_M} | ({"x_m": side, "y_m": side} if boxed else {}),
                "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
                "nodes": [{"position_m": (x, y, 0.0), "power_w": 1.0} for x, y in points[: self.nodes]],
                "jammers": [{"position_m": (x, y, 0.0), "power_w": power_w} for x, y in points[self.nodes :]],
            }
        )

    def __str__(self) -> str:
        return f"N={self.nodes} K={self.jammers} P_M/P={self.jamming_ratio:g} seed={self.seed}"


def field_scenes(
    *,
    quick: bool,
    nodes: tuple[int, ...] = (2, 3, 5, 10, 20),
    jammers: tuple[int, ...] = (1, 3),
    seeds: int = 5,
) -> Iterator[Scene]:
    """Yield scenes of every size, jamming power and seed; if in a hurry, one of each size."""
    ratios = (10.0,) if quick else (0.1, 1.0, 10.0, 100.0)
    for n, k, ratio, seed in product(nodes, jammers, ratios, range(1 if quick else seeds)):
        yield Scene(nodes=n, jammers=k, jamming_ratio=ratio, seed=seed)
