"""Random scenes, each made from its own parameters alone, so that any one can be had again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from nullpose.scenario import Scenario

__all__ = ["Scene", "scenes"]

SIDE_M = 100.0
MARGIN_M = 25.0
ALTITUDE_M = (8.0, 30.0)
NODE_POWER_W = 1.0
NOISE_W = 1e-3

NODES = (2, 3, 5, 10, 20)
JAMMERS = (1, 3)
JAMMING_RATIOS = (0.1, 1.0, 10.0, 100.0)
SEEDS = range(5)


@dataclass(frozen=True, slots=True, kw_only=True)
class Scene:
    """The parameters of a random scene.

    Args:
        nodes: how many.
        jammers: how many; they share the jamming power evenly.
        jamming_ratio: total jamming power over the power of one node, P_M / P.
        seed: of the positions.
    """

    nodes: int
    jammers: int
    jamming_ratio: float
    seed: int

    def scenario(self, *, boxed: bool = True) -> Scenario:
        """Return the scene: nodes and jammers uniform over the square, on the ground.

        Args:
            boxed: whether x and y of the drone are bounded, as general solvers need it.
        """
        draws = np.random.default_rng([self.nodes, self.jammers, round(10 * self.jamming_ratio), self.seed])
        places = draws.uniform(0.0, SIDE_M, size=(self.nodes + self.jammers, 2)).tolist()
        airspace: dict[str, object] = {"altitude_m": ALTITUDE_M}
        if boxed:
            airspace["x_m"] = airspace["y_m"] = (-MARGIN_M, SIDE_M + MARGIN_M)
        power_w = self.jamming_ratio * NODE_POWER_W / self.jammers
        return Scenario.from_dict(
            {
                "name": f"field {self}",
                "airspace": airspace,
                "receiver": {"noise_w": NOISE_W, "reference_gain_db": 0.0},
                "nodes": [
                    {"position_m": (x, y, 0.0), "power_w": NODE_POWER_W} for x, y in places[: self.nodes]
                ],
                "jammers": [{"position_m": (x, y, 0.0), "power_w": power_w} for x, y in places[self.nodes :]],
            }
        )

    def __str__(self) -> str:
        return f"N={self.nodes} K={self.jammers} P_M/P={self.jamming_ratio:g} seed={self.seed}"


def scenes(*, quick: bool) -> Iterator[Scene]:
    """Yield the workload's scenes, or every size once if in a hurry."""
    ratios, seeds = (JAMMING_RATIOS[2:3], SEEDS[:1]) if quick else (JAMMING_RATIOS, SEEDS)
    for nodes, jammers, ratio, seed in product(NODES, JAMMERS, ratios, seeds):
        yield Scene(nodes=nodes, jammers=jammers, jamming_ratio=ratio, seed=seed)
