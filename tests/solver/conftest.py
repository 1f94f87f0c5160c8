"""Scenes and dense algebra that the tests of the solver share."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.channel import LinkChannel, PointChannels
from nullpose.objectives import Ratios
from nullpose.problem.family import Family


@pytest.fixture(scope="session")
def dense_forms() -> Callable[[Family, np.ndarray], tuple[np.ndarray, np.ndarray]]:
    """Returns a function: a family's numerators (R, 3, 3) and denominators (G, 3, 3) at a position."""

    def link_matrix(r: np.ndarray, leak: float) -> np.ndarray:
        square = r @ r
        return (square * np.eye(3) - (1.0 - leak) * np.outer(r, r)) / square**2

    def forms(family: Family, position_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        ratios = family.ratios
        links = [link_matrix(point - position_m, ratios.leak) for point in ratios.points_m]
        numerators = [
            isotropic * np.eye(3) + weight * links[point]
            for isotropic, weight, point in zip(
                ratios.numerator_isotropic,
                ratios.numerator_weight,
                ratios.numerator_point,
                strict=True,
            )
        ]
        denominators = []
        for group, isotropic in enumerate(ratios.denominator_isotropic):
            matrix = isotropic * np.eye(3)
            for entry in range(ratios.denominator_start[group], ratios.denominator_start[group + 1]):
                matrix += ratios.denominator_weight[entry] * links[ratios.denominator_point[entry]]
            denominators.append(matrix)
        return np.array(numerators), np.array(denominators)

    return forms


@pytest.fixture(scope="session")
def ratios_over() -> Callable[..., Ratios]:
    """Returns a builder: one ratio over some points, for what asks for points, leak and dipoles only."""

    def build(
        points_m: np.ndarray,
        leak: float,
        axes: np.ndarray | None = None,
        through: float = 0.0,
        channel: LinkChannel | None = None,
    ) -> Ratios:
        none, first = np.zeros(0, dtype=np.int64), np.zeros(1, dtype=np.int64)
        one, start = np.ones(1), np.zeros(2, dtype=np.int64)
        numbers = (np.zeros(1), one, first, first, one, start, none, np.zeros(0))
        axes = np.zeros((0, 3)) if axes is None else axes
        leaks = np.full(len(axes), through)
        rows = PointChannels.of([channel] * len(points_m) if channel else []).rows
        return Ratios(points_m, *numbers, leak=leak, ground_axes=axes, ground_leaks=leaks, channels=rows)

    return build


@pytest.fixture(scope="session")
def random_family() -> Callable[..., Family]:
    """Returns a builder: a family with several denominators and isotropic parts, as secrecy rates have."""

    def build(rng: np.random.Generator, ratios: int, groups: int, leak: float | None = None) -> Family:
        points = ratios + 2 * groups
        points_m = rng.uniform([0.0, 0.0, 0.0], [100.0, 100.0, 5.0], (points, 3))
        return Family(
            points_m=points_m,
            numerator_isotropic=rng.uniform(0.0, 1.0, ratios),
            numerator_weight=10.0 ** rng.uniform(2.0, 4.0, ratios),
            numerator_point=np.arange(ratios),
            denominator_of=np.arange(ratios) % groups,
            denominator_isotropic=rng.uniform(0.5, 2.0, groups),
            denominator_start=2 * np.arange(groups + 1),
            denominator_point=ratios + np.arange(2 * groups),
            denominator_weight=10.0 ** rng.uniform(1.0, 5.0, 2 * groups),
            low_m=np.array([-np.inf, -np.inf, 8.0]),
            high_m=np.array([np.inf, np.inf, 30.0]),
            keep_out_points_m=np.zeros((0, 3)),
            keep_out_m=1.0,
            leak=0.01 * (points_m[0, 0] > 50.0) if leak is None else leak,
        )

    return build
