"""Scenes and dense algebra that the tests of the family share."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.problem.family import Family
from nullpose.scenario import Airspace, Jammer, Node, Receiver, Scenario


@pytest.fixture(scope="session")
def random_problem() -> Callable[..., Scenario]:
    """Returns a builder: so many nodes and jammers on a field of 100 m, powers over two decades, a gain."""

    def build(rng: np.random.Generator, nodes: int, jammers: int, **airspace: object) -> Scenario:
        return Scenario(
            airspace=Airspace(**{"altitude_m": (10.0, 40.0), **airspace}),
            receiver=Receiver(noise_dbm=-60.0, reference_gain_db=-40.0),
            nodes=tuple(
                Node(
                    position_m=tuple(rng.uniform(0.0, [100.0, 100.0, 5.0])), power_w=10 ** rng.uniform(-1, 1)
                )
                for _ in range(nodes)
            ),
            jammers=tuple(
                Jammer(
                    position_m=tuple(rng.uniform(0.0, [100.0, 100.0, 5.0])), power_w=10 ** rng.uniform(-1, 1)
                )
                for _ in range(jammers)
            ),
        )

    return build


@pytest.fixture(scope="session")
def dense_ratios() -> Callable[[Family, np.ndarray, np.ndarray], np.ndarray]:
    """Returns a function: the ratios of a family at a pose, by dense 3x3 matrices and nothing else."""

    def link_matrix(r: np.ndarray, leak: float) -> np.ndarray:
        square = r @ r
        return (square * np.eye(3) - (1.0 - leak) * np.outer(r, r)) / square**2

    def ratios(family: Family, position_m: np.ndarray, axis: np.ndarray) -> np.ndarray:
        links = [link_matrix(point - position_m, family.leak) for point in family.points_m]
        denominators = []
        for group, isotropic in enumerate(family.denominator_isotropic):
            matrix = isotropic * np.eye(3)
            for entry in range(family.denominator_start[group], family.denominator_start[group + 1]):
                matrix += family.denominator_weight[entry] * links[family.denominator_point[entry]]
            denominators.append(axis @ matrix @ axis)
        values = []
        for k, point in enumerate(family.numerator_point):
            matrix = family.numerator_isotropic[k] * np.eye(3) + family.numerator_weight[k] * links[point]
            values.append(axis @ matrix @ axis / denominators[family.denominator_of[k]])
        return np.array(values)

    return ratios
