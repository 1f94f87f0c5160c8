"""Proofs of level vehicles: a promised certificate verifies, however thin its cells of axes are."""

import sys
from pathlib import Path

import pytest

import nullpose
from nullpose.certificate import verify

sys.path.insert(0, str(Path(__file__).parents[2]))

from benchmarks.soundness.features import make_feature_scene


@pytest.mark.parametrize("number", [1098, 1194])
def test_a_promised_certificate_of_a_level_vehicle_verifies(number: int) -> None:
    """Scene 1098 has leaves out of the airframe's reach, 1194 cells of axes that no certificate can state."""
    scene = make_feature_scene("level", number)
    result = nullpose.solve(scene.scenario, gap=scene.gap, node_limit=60_000)
    assert result.status == "certified"
    assert not result.proofs or verify(nullpose.certificate_of(result)).proved
