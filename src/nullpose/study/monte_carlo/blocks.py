"""Blocks of buildings on a square grid, with random heights: the built-up area of ITU-R P.1410."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Annotated, NamedTuple

import numpy as np

from nullpose.files import PlainTable
from nullpose.physics.types import FloatArray
from nullpose.scenario.buildings import MOST_BUILDINGS
from nullpose.scenario.channel import EnvironmentName
from nullpose.scenario.faults import require
from nullpose.scenario.rules import Limits
from nullpose.scenario.section import Section, optional
from nullpose.scenario.units import Range
from nullpose.scenario.ways import Ways

# alpha, beta per km^2 and gamma in m of ITU-R P.1410, as Al-Hourani et al. 2014 state them
_BUILT_UP = {
    "suburban": (0.1, 750.0, 8.0),
    "urban": (0.3, 500.0, 15.0),
    "dense-urban": (0.5, 300.0, 20.0),
    "high-rise": (0.5, 300.0, 50.0),
}

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


class Town(NamedTuple):
    """The blocks of a scene, before any is left out.

    Args:
        centres_m: east and north of each, (n, 2) [m].
        heights_m: of the roofs, (n,) [m].
        walls_m: from a centre to the middles of two walls, (2, 2) [m]: one row each, perpendicular.
    """

    centres_m: FloatArray
    heights_m: FloatArray
    walls_m: FloatArray

    def around(self, points_m: FloatArray) -> list[PlainTable]:
        """List the buildings as plain data, without those on whose ground a point stands.

        Args:
            points_m: positions of the ground points, (m, 3) [m].
        """
        reach_m2 = np.sum(self.walls_m[0] ** 2) * (1.0 + 1e-9)  # a point at a wall counts as inside
        is_free = np.ones(len(self.centres_m), dtype=np.bool_)
        for point_m in points_m[:, :2]:
            is_free &= np.any(np.abs((point_m - self.centres_m) @ self.walls_m.T) > reach_m2, axis=1)
        corners_m = self.centres_m[is_free, None] + _CORNERS @ self.walls_m
        return [
            {"polygon_m": corners, "height_m": height_m}
            for corners, height_m in zip(corners_m.tolist(), self.heights_m[is_free].tolist(), strict=True)
        ]


class Blocks(
    Section,
    header="a table headed [buildings]",
    ways=(Ways((("environment",), ("alpha", "beta_per_km2", "gamma_m"))),),
):
    """How the buildings of each scene are drawn: squares on a grid of random offset and direction.

    Args:
        environment: a key of ``ENVIRONMENTS``, which has published numbers; or else
        alpha: the share of the ground that is built up;
        beta_per_km2: buildings per square kilometre;
        gamma_m: scale of the Rayleigh distribution of their heights [m].
        x_m, y_m: where their centres are [m]; None for around the areas in which points are drawn.
    """

    environment: EnvironmentName | None = optional(
        "The published alpha, beta_per_km2 and gamma_m of suburban (0.1, 750, 8), urban (0.3, 500, 15), "
        "dense-urban (0.5, 300, 20) and high-rise (0.5, 300, 50). Either this, or the three numbers.",
        "urban",
    )
    alpha: (
        Annotated[float, Limits("a share of the ground", 1e-3, 0.99, "0.3 is urban: streets remain")] | None
    ) = optional("The share of the ground that is built up.", 0.3)
    beta_per_km2: (
        Annotated[float, Limits("a number of buildings per km^2", 1e-3, 1e6, "500 is urban")] | None
    ) = optional("The mean number of buildings per square kilometre.", 500.0)
    gamma_m: Annotated[float, Limits("a height in m", 0.1, 100.0, "15 m is urban, 50 m high-rise")] | None = (
        optional(
            "Scale of the Rayleigh distribution of the heights, in metres; their mean is 1.25 times it.", 15.0
        )
    )
    x_m: Range | None = optional(
        "Western and eastern end of the area in which centres of buildings are. Left out: the smallest "
        "rectangle around the areas in which points are drawn.",
        [-200.0, 200.0],
    )
    y_m: Range | None = optional("Southern and northern end, likewise.", [-200.0, 200.0])

    def draw(self, chance: Callable[[str], np.random.Generator], areas_m: Sequence[FloatArray]) -> Town:
        """Draw the blocks of a scene.

        Args:
            chance: gives the streams of the grid and of the heights.
            areas_m: ends of the areas in which points are drawn, (2, 2) each [m].

        Raises:
            ScenarioError: there would be too many.
        """
        numbers = (self.alpha or 0.0, self.beta_per_km2 or 0.0, self.gamma_m or 0.0)
        alpha, per_km2, gamma_m = numbers if self.environment is None else _BUILT_UP[self.environment]
        pitch_m = 1e3 / math.sqrt(per_km2)
        pairs = zip((self.x_m, self.y_m), np.hstack([np.empty((2, 0)), *areas_m]), strict=True)
        ends_m = np.array([range_m or (area_m.min(), area_m.max()) for range_m, area_m in pairs])
        sides = np.diff(ends_m, axis=1).ravel() / pitch_m
        count = np.prod(np.maximum(sides, 1.0))  # a strip narrower than the grid counts as a row of it
        require(
            count <= MOST_BUILDINGS,
            "buildings",
            f"a mean of {count:.4g} buildings, at most {MOST_BUILDINGS} are allowed; state a smaller area "
            "by x_m and y_m",
        )
        east, north, turn = chance("place").random(3)
        cosine, sine = math.cos(turn * math.pi / 2.0), math.sin(turn * math.pi / 2.0)
        axes_m = pitch_m * np.array([[cosine, sine], [-sine, cosine]])
        farthest = math.ceil(np.hypot(*sides) / 2.0) + 1
        steps = np.arange(-farthest, farthest + 1)
        cells = np.stack(np.meshgrid(steps + east, steps + north), axis=-1).reshape(-1, 2)
        centres_m = ends_m.mean(axis=1) + cells @ axes_m
        centres_m = centres_m[np.all((ends_m[:, 0] <= centres_m) & (centres_m < ends_m[:, 1]), axis=1)]
        heights_m = gamma_m * chance("height_m").rayleigh(size=len(centres_m))
        return Town(centres_m, heights_m, axes_m * math.sqrt(alpha) / 2.0)
