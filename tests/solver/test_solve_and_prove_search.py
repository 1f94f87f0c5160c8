"""A solve with a proof is never worse than one without: the light search before it costs no answer."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from nullpose import Scenario, solve

NULL = {"antenna": {"null_depth_db": 0.0}}
LEVEL_HALF_WAVE = {"antenna": {"kind": "half-wave"}, "airframe": {"tilt_max_deg": 0.0, "mount_deg": 45.0}}


def scene(seed: int, nodes: int, jammers: int, whips: bool, **more: Any) -> Scenario:
    """Returns random nodes and jammers on a field of 60 m, all with upright whips or none."""
    rng = np.random.default_rng(seed)

    def points(count: int, low: float, high: float) -> list[dict[str, Any]]:
        whip = {"antenna": "dipole"} if whips else {}
        places = rng.uniform(0.0, 60.0, (count, 2))
        powers_w = 10.0 ** rng.uniform(low, high, count)
        return [
            {"position_m": [x, y, 0.0], "power_w": power_w, **whip}
            for (x, y), power_w in zip(places.tolist(), powers_w.tolist(), strict=True)
        ]

    return Scenario.from_dict(
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": points(nodes, -0.5, 0.5),
            "jammers": points(jammers, -2.0, 3.0),
            **more,
        }
    )


@pytest.mark.parametrize("node_limit", [300, 6000])
@pytest.mark.parametrize("nodes", [1, 8])
def test_a_proof_costs_no_answer(nodes: int, node_limit: int) -> None:
    """Where whips have perfect nulls, a proof that stops early has a pose as good as that of `--fast`."""
    for seed in range(20):
        scenario = scene(seed, nodes, 3, whips=True, **NULL)
        fast, proved = solve(scenario, certify=False), solve(scenario, node_limit=node_limit)
        assert proved.objective.value >= fast.objective.value / (1.0 + 1e-4), seed


def test_a_proof_costs_no_answer_for_a_pattern() -> None:
    """Likewise for half-wave antennas on level vehicles, whatever the seed."""
    scenario = scene(2, 8, 2, whips=False, **LEVEL_HALF_WAVE)
    fast = solve(scenario, certify=False).objective.value
    for seed in range(3):
        proved = solve(scenario, node_limit=1000, seed=seed)
        assert proved.objective.value == pytest.approx(fast, rel=1e-4)


def test_seeds_agree() -> None:
    """Where proofs stop early, several seeds give the same value."""
    for scenario in (scene(seed, 2, 3, whips=True, **NULL) for seed in range(5)):
        values = [solve(scenario, node_limit=300, seed=seed).objective.value for seed in range(4)]
        assert min(values) >= max(values) * (1.0 - 1e-6)
