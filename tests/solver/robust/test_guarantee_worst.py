"""The inner problem: what the kernels are told, and the cases that they hand back."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from nullpose.solver.robust.guarantee import Inner

POSE = (np.array([5.0, 20.0, 12.0]), np.array([0.6, 0.0, 0.8]))


def test_one_error_at_a_time_is_the_textbook_case(paper: Callable, erring: Callable) -> None:
    """Without jammers, an attitude error takes the axis straight towards the node: sin^2(gamma - alpha)."""
    scene = erring(paper(1.0), attitude_deg=10.0, jammers=[])
    p, u = POSE
    for k, one in enumerate(Inner(scene).worst(p, u, 1e-4)):
        r = scene.node_positions_m[k] - p
        distance = float(np.linalg.norm(r))
        gamma = math.acos(abs(float(r @ u)) / distance)
        expected = math.sin(gamma - math.radians(10.0)) ** 2 / distance**2 / scene.receiver.noise_power_w
        assert one.worst == pytest.approx(expected, rel=1e-9)
        assert one.lower == pytest.approx(expected, rel=1.1e-4)
        assert one.case.rotation_rad == pytest.approx(math.radians(10.0), rel=1e-9)


def test_every_case_is_for_its_ratio(paper: Callable, erring: Callable, listened: Callable) -> None:
    """Cases move only what their ratio depends on, and name it as the family does."""
    plain = paper(1.0).to_dict()
    plain["jammers"] += [{"name": "M2", "position_m": [40.0, 30.0, 2.0], "power_w": 1.0}]
    scene = erring(listened(type(paper(1.0))(**plain)), extent_m=2.0)
    found = Inner(scene).worst(*POSE)
    pairs = [("S1", "E0"), ("S1", "E1"), ("S2", "E0"), ("S2", "E1")]
    assert [(one.node, one.eavesdropper) for one in found] == pairs
    assert [one.binding.ratio for one in found] == [0, 1, 2, 3]
    for one in found:
        moved = np.linalg.norm(one.case.eavesdropper_offsets_m, axis=1)
        own = scene.eavesdropper_names.index(one.eavesdropper)
        assert moved[own] == pytest.approx(2.0, rel=1e-9)
        assert moved[1 - own] == 0.0
        np.testing.assert_array_equal(one.case.rotation_world, np.eye(3))
        np.testing.assert_array_equal(one.case.position_offset_m, np.zeros(3))


def test_the_sign_of_the_axis_is_irrelevant(strong: object) -> None:
    """An axis and its opposite are one antenna under errors too, and the rotation is the same small one."""
    inner = Inner(strong)  # type: ignore[arg-type]
    p, u = POSE
    for one, other in zip(inner.worst(p, u, 1e-3), inner.worst(p, -u, 1e-3), strict=True):
        assert other.worst == pytest.approx(one.worst, rel=1e-9)
        for case in (one.case, other.case):
            assert Rotation.from_matrix(case.rotation_world).magnitude() <= math.radians(2.0) * (1.0 + 1e-9)
