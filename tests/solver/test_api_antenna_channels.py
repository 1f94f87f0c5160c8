"""Arrays and antennas with a pattern in channels other than free space."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.optimize import differential_evolution
from sizes import few_examples

from nullpose import Scenario, apply_overrides, certificate_of, load, solve, verify
from nullpose.channel.elevation import AVERAGES
from nullpose.errors import UsageError
from nullpose.physics import Pose, min_sinr
from nullpose.physics.array import digital_sinr, element_positions
from nullpose.scenario import Array

PAPER = load("examples/paper.toml")
SUBURBAN = "channel={model='elevation', environment='suburban', average='power'}"
CUBE = "channel={model='power-law', exponent=3.0}"
TOWER = ["buildings=[{polygon_m=[[8,8],[12,8],[12,17],[8,17]],height_m=12.0}]", "channel.blocked_loss_db=20"]
SINE_SQUARED = [[2.0 / 3.0], [0.0, 0.0, 0.0], [-2.0 / 3.0 / np.sqrt(5.0), 0.0, 0.0, 0.0, 0.0]]


def with_antenna(scenario: Scenario, antenna: dict) -> Scenario:
    """The scenario with another antenna on the drone."""
    return Scenario.from_dict(scenario.to_dict() | {"antenna": antenna})


@pytest.mark.parametrize("overrides", [[CUBE], [SUBURBAN, *TOWER]], ids=["power law", "buildings"])
def test_a_dipole_as_a_pattern_is_a_dipole_in_any_channel(overrides: list[str]) -> None:
    """``1 - z^2`` as a pattern: a pose is worth the same, and each bound holds for the other's pose."""
    scenario = apply_overrides(PAPER, overrides)
    pattern = with_antenna(scenario, {"kind": "pattern", "harmonics": SINE_SQUARED})
    dipole, found = solve(scenario, gap=1e-3).objective, solve(pattern, gap=0.1)
    assert found.status == "certified"
    assert found.objective.value == pytest.approx(min_sinr(scenario, found.pose), rel=1e-9)
    assert found.objective.value <= dipole.upper_bound
    assert dipole.value <= found.objective.upper_bound


@pytest.mark.parametrize("overrides", [[CUBE], [SUBURBAN, *TOWER]], ids=["power law", "buildings"])
def test_array_in_a_channel_against_an_independent_search(overrides: list[str]) -> None:
    """Differential evolution over position and yaw finds nothing above the bound."""
    scenario = apply_overrides(PAPER, ["jammers.M.power_w=10", *overrides])
    array = Array(elements=3, layout="linear", spacing_wavelengths=0.5)
    found = solve(scenario.model_copy(update={"array": array}), gap=2e-2)

    def loss(state: np.ndarray) -> float:
        return -min(digital_sinr(scenario, state[:3], element_positions(3, "linear", 0.5, state[3])))

    box = [(-30.0, 30.0), (0.0, 50.0), (12.0 if "buildings" in str(overrides) else 8.0, 30.0), (0.0, np.pi)]
    best = -differential_evolution(loss, box, seed=1, maxiter=60, popsize=12, polish=False).fun
    assert best <= found.objective.upper_bound
    assert found.status == "certified"
    assert best <= found.objective.value * 1.001


def test_an_array_of_one_is_the_vertical_dipole_in_a_channel() -> None:
    """One element is the vertical case."""
    scenario = apply_overrides(PAPER, [SUBURBAN])
    array = Array(elements=1, layout="linear", spacing_wavelengths=0.5)
    alone = solve(scenario.model_copy(update={"array": array}), gap=1e-4).objective
    vertical = solve(scenario, scheme="vertical", gap=1e-4).objective
    assert alone.value == pytest.approx(vertical.value, rel=1e-4)
    assert alone.upper_bound >= vertical.value


def test_a_certificate_of_a_pattern_is_of_free_space() -> None:
    """No certificate is written in another channel, and none of free space passes for one."""
    free = with_antenna(PAPER, {"kind": "half-wave"})
    certificate = certificate_of(solve(free, gap=0.3))
    assert verify(certificate).proved
    scenario = apply_overrides(free, [CUBE])
    with pytest.raises(UsageError, match="free space only"):
        certificate_of(solve(scenario, gap=0.3))
    assert not verify(replace(certificate, scenario=scenario)).proved


def test_poses_at_random_never_exceed_the_bound_of_a_pattern() -> None:
    """Poses of a half-wave dipole among buildings in a suburb."""
    scenario = with_antenna(apply_overrides(PAPER, [SUBURBAN, *TOWER]), {"kind": "half-wave"})
    bound, rng = solve(scenario, gap=0.05, time_limit_s=10.0).objective.upper_bound, np.random.default_rng(3)
    for _ in range(2000):
        position_m = rng.uniform([-30.0, -10.0, 12.0], [30.0, 60.0, 30.0])
        assert min_sinr(scenario, Pose(position_m, *rng.uniform(-np.pi, np.pi, 3))) <= bound


LOSSES_DB = st.floats(0.0, 15.0)


@few_examples(12)
@given(
    seed=st.integers(0, 2**32 - 1),
    average=st.sampled_from(AVERAGES),
    los_loss_db=LOSSES_DB,
    more_db=LOSSES_DB,
    hidden_db=LOSSES_DB,
)
def test_more_loss_never_raises_a_value_without_jammers(
    seed: int, average: str, los_loss_db: float, more_db: float, hidden_db: float, random_scene: Callable
) -> None:
    """More loss with line of sight, that without it being the same: no link gets better at any pose."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, int(rng.integers(1, 5)), 0)
    curve = {"a": float(rng.uniform(1.0, 40.0)), "b": float(rng.uniform(0.05, 0.5))}
    table = {"model": "elevation", "average": average, "nlos_loss_db": los_loss_db + more_db + hidden_db}
    channels = (table | curve | {"los_loss_db": los_loss_db + added_db} for added_db in (0.0, more_db))
    scenes = (Scenario.from_dict(scene.to_dict() | {"channel": channel}) for channel in channels)
    less, more = (solve(each, gap=1e-3, time_limit_s=5.0) for each in scenes)
    assert more.objective.value <= less.objective.upper_bound
