"""Scenes that the tests of the physics share."""

from collections.abc import Callable

import numpy as np
import pytest

from nullpose.scenario import Airspace, Jammer, Node, Receiver, Scenario


@pytest.fixture(scope="session")
def scene() -> Callable[..., Scenario]:
    """Returns a builder: positions and powers of nodes and of jammers, noise and gain; any altitude."""

    def build(
        nodes_m: np.ndarray,
        node_powers_w: np.ndarray,
        jammers_m: np.ndarray,
        jammer_powers_w: np.ndarray,
        *,
        noise_w: float = 1e-3,
        reference_gain_db: float = 0.0,
    ) -> Scenario:
        return Scenario(
            airspace=Airspace(altitude_m=(-1e4, 1e4)),
            receiver=Receiver(noise_w=noise_w, reference_gain_db=reference_gain_db),
            nodes=tuple(
                Node(position_m=tuple(at), power_w=power)
                for at, power in zip(nodes_m, node_powers_w, strict=True)
            ),
            jammers=tuple(
                Jammer(position_m=tuple(at), power_w=power)
                for at, power in zip(jammers_m, jammer_powers_w, strict=True)
            ),
        )

    return build


@pytest.fixture(scope="session")
def random_scene(scene: Callable[..., Scenario]) -> Callable[..., Scenario]:
    """Returns a builder: so many nodes and jammers on a field of 100 m, powers over two decades."""

    def build(rng: np.random.Generator, nodes: int, jammers: int) -> Scenario:
        return scene(
            rng.uniform([0.0, 0.0, 0.0], [100.0, 100.0, 5.0], (nodes, 3)),
            10.0 ** rng.uniform(-1.0, 1.0, nodes),
            rng.uniform([0.0, 0.0, 0.0], [100.0, 100.0, 5.0], (jammers, 3)),
            10.0 ** rng.uniform(-1.0, 1.0, jammers),
        )

    return build


@pytest.fixture(scope="session")
def paper(scene: Callable[..., Scenario]) -> Scenario:
    """Returns the paper's scene at a jamming-to-transmission power ratio of 1."""
    return scene(
        np.array([[0.0, 0.0, 0.0], [0.0, 50.0, 0.0]]),
        np.ones(2),
        np.array([[17.0, 15.0, 4.0]]),
        np.ones(1),
    )


@pytest.fixture(scope="session")
def random_poses() -> Callable[..., tuple[np.ndarray, np.ndarray]]:
    """Returns a maker of positions 10 to 40 m above the field and of unit axes, of any leading shape."""

    def draw(rng: np.random.Generator, *shape: int) -> tuple[np.ndarray, np.ndarray]:
        axes = rng.normal(size=(*shape, 3))
        axes /= np.linalg.norm(axes, axis=-1, keepdims=True)
        return rng.uniform([-20.0, -20.0, 10.0], [120.0, 120.0, 40.0], (*shape, 3)), axes

    return draw
