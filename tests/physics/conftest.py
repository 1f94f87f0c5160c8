"""Scenes that the tests of the physics share."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Scenario


@pytest.fixture(scope="session")
def paper(paper: Callable[..., Scenario]) -> Scenario:
    """Returns the paper's scene at a jamming-to-transmission power ratio of 1."""
    return paper()


@pytest.fixture(scope="session")
def random_poses() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Returns a maker of positions 10 to 40 m above the field and of unit axes, of any leading shape."""

    def draw(rng: np.random.Generator, *shape: int) -> tuple[np.ndarray, np.ndarray]:
        axes = rng.normal(size=(*shape, 3))
        axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
        return rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0], (*shape, 3)), axes

    return draw
