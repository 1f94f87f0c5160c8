"""Scenes with errors, and errors drawn at random, that the tests of robust solving share."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from nullpose.scenario import Scenario
from nullpose.solver import Result, solve

Draw = tuple[np.ndarray, np.ndarray, np.ndarray]


@pytest.fixture(scope="session")
def erring() -> Callable[..., Scenario]:
    """Returns a builder: a scene with errors of attitude and position, and sets for its disturbers."""

    def build(
        scene: Scenario,
        *,
        attitude_deg: float = 0.0,
        position_m: float = 0.0,
        extent_m: Any = 0.0,
        **others: Any,
    ) -> Scenario:
        plain = scene.to_dict()
        plain["receiver"] |= {"attitude_error_deg": attitude_deg, "position_error_m": position_m}
        kind = "eavesdroppers" if scene.objective == "secrecy-rate" else "jammers"
        plain[kind] = [each | {"uncertainty_m": extent_m} for each in plain.get(kind, [])]
        return Scenario(**(plain | others))

    return build


@pytest.fixture(scope="session")
def listened() -> Callable[..., Scenario]:
    """Returns a function: the scene with an eavesdropper in the place of each jammer, and a drone of 1 W."""

    def build(scene: Scenario) -> Scenario:
        plain = scene.to_dict()
        ears = [{"name": f"E{i}", "position_m": one["position_m"]} for i, one in enumerate(plain["jammers"])]
        changes = {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}, "eavesdroppers": ears}
        return Scenario(**(plain | changes | {"jammers": []}))

    return build


@pytest.fixture(scope="session")
def draw_errors() -> Callable[..., Draw]:
    """Returns a maker of random errors that a scene allows: actual axes, position errors, disturbers' errors.

    Half of each kind are as large as they may be, where the worst cases are.
    """

    def in_ball(rng: np.random.Generator, *shape: int) -> np.ndarray:
        x = rng.normal(size=(*shape, 3))
        x /= np.linalg.norm(x, axis=-1, keepdims=True)
        inside = rng.uniform(size=(*shape, 1)) ** (1.0 / 3.0)
        return np.asarray(x * np.where(rng.uniform(size=(*shape, 1)) < 0.5, 1.0, inside))

    def draw(rng: np.random.Generator, scene: Scenario, axis: np.ndarray, count: int) -> Draw:
        largest = math.radians(scene.receiver.attitude_error_deg)
        angle = largest * np.where(rng.uniform(size=count) < 0.5, 1.0, np.sqrt(rng.uniform(size=count)))
        across = np.cross(axis, rng.normal(size=(count, 3)))
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        axes = np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * across
        secret = scene.objective == "secrecy-rate"
        sets_m = scene.eavesdropper_uncertainty_m if secret else scene.jammer_uncertainty_m
        moved = sets_m[:, None] * in_ball(rng, count, len(sets_m))
        return axes, scene.receiver.position_error_m * in_ball(rng, count), moved

    return draw


@pytest.fixture(scope="session")
def ratios_at() -> Callable[..., np.ndarray]:
    """Returns a function: all ratios of a scene at a position for many errors, (errors, ratios)."""

    def links(axes: np.ndarray, r: np.ndarray) -> np.ndarray:
        return np.asarray(np.sum(np.cross(axes[:, None], r) ** 2, axis=-1) / np.sum(r**2, axis=-1) ** 2)

    def ratios(scene: Scenario, position: np.ndarray, errors: Draw) -> np.ndarray:
        axes, offsets, moved = errors
        p = (position + offsets)[:, None]
        g0 = scene.receiver.reference_gain
        if scene.objective == "secrecy-rate":
            assert scene.transmitter is not None
            sent = g0 * scene.transmitter.transmit_power_w
            heard = sent * links(axes, scene.node_positions_m - p) / scene.node_noise_w
            caught = sent * links(axes, scene.eavesdropper_positions_m + moved - p)
            caught /= scene.eavesdropper_noise_w
            return np.asarray(((1.0 + heard[:, :, None]) / (1.0 + caught[:, None])).reshape(len(axes), -1))
        signal = g0 * scene.node_powers_w * links(axes, scene.node_positions_m - p)
        jamming = g0 * scene.jammer_powers_w * links(axes, scene.jammer_positions_m + moved - p)
        noise = scene.receiver.noise_power_w + np.sum(jamming, axis=1, keepdims=True)
        return np.asarray(signal / noise / scene.node_required_sinr)

    return ratios


@pytest.fixture(scope="session")
def strong(paper: Callable[..., Scenario], erring: Callable[..., Scenario]) -> Scenario:
    """Returns the paper's scene at a power ratio of 100, errors of 2 degrees and 3 m of the jammer."""
    return erring(paper(100.0), attitude_deg=2.0, extent_m=3.0)


@pytest.fixture(scope="session")
def solved(strong: Scenario) -> Result:
    """Returns its robust solution."""
    return solve(strong, robust=True)
