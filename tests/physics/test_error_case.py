"""Error cases: what a pose gives when not everything is where it was thought to be."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.physics import ErrorCase, Reception, objective_value, ratios_under, rotation_between, sinr
from nullpose.scenario import Eavesdropper, Scenario, Transmitter

SEEDS = st.integers(0, 2**32 - 1)


def random_case(rng: np.random.Generator, scene: Scenario) -> ErrorCase:
    """Returns a case in which all is off by about a metre or a tenth of a radian."""
    return ErrorCase(
        position_offset_m=rng.normal(size=3),
        rotation_world=Rotation.from_rotvec(0.1 * rng.normal(size=3)).as_matrix(),
        jammer_offsets_m=rng.normal(size=(len(scene.jammers), 3)),
        eavesdropper_offsets_m=rng.normal(size=(len(scene.eavesdroppers), 3)),
    )


def secrecy_scene(plain: Scenario, ears_m: np.ndarray) -> Scenario:
    """Returns the scene with objective secrecy-rate and eavesdroppers at some places."""
    kept = {"airspace": plain.airspace, "receiver": plain.receiver, "nodes": plain.nodes}
    ears = tuple(Eavesdropper(position_m=tuple(map(float, at))) for at in ears_m)
    return Scenario(
        objective="secrecy-rate", transmitter=Transmitter(power_w=2.0), eavesdroppers=ears, **kept
    )


@given(seed=SEEDS)
def test_no_error_is_the_nominal_value(seed: int, random_scene: Callable, random_poses: Callable) -> None:
    """In the case without errors, SINR and objective are the nominal ones to the last bit."""
    rng = np.random.default_rng(seed)
    scene = random_scene(rng, 3, 2)
    at = random_poses(rng, 4)
    none = ErrorCase.none(scene)
    np.testing.assert_array_equal(Reception(scene, *at, none).sinr, sinr(scene, *at))
    np.testing.assert_array_equal(objective_value(scene, *at, none), objective_value(scene, *at))


@given(seed=SEEDS)
def test_an_error_case_is_another_scene(seed: int, random_scene: Callable, random_poses: Callable) -> None:
    """What an error case gives is what the moved jammers give at the moved and turned pose."""
    rng = np.random.default_rng(seed)
    before = random_scene(rng, 3, 2)
    position, axis = random_poses(rng)
    case = random_case(rng, before)
    moved_m = before.source_positions_m + np.vstack([np.zeros((3, 3)), case.jammer_offsets_m])
    expected = sinr(before, position + case.position_offset_m, case.rotation_world @ axis, moved_m)
    np.testing.assert_allclose(Reception(before, position, axis, case).sinr, expected, rtol=1e-13)


@given(seed=SEEDS)
def test_secrecy_under_an_error_case(seed: int, random_scene: Callable, random_poses: Callable) -> None:
    """Ratios of secrecy are two to the power of the rates of a scene whose eavesdroppers have moved."""
    rng = np.random.default_rng(seed)
    plain = random_scene(rng, 3, 2)
    scene = secrecy_scene(plain, plain.jammer_positions_m)
    position, axis = random_poses(rng)
    case = random_case(rng, scene)
    after = secrecy_scene(plain, scene.eavesdropper_positions_m + case.eavesdropper_offsets_m)
    actual = (position + case.position_offset_m, case.rotation_world @ axis)
    assert ratios_under(scene, position, axis, case).shape == (3, 2)
    assert objective_value(scene, position, axis, case) == pytest.approx(
        float(objective_value(after, *actual)), rel=1e-9, abs=1e-12
    )


@given(seed=SEEDS)
def test_the_smallest_rotation_between_axes(seed: int) -> None:
    """The rotation is one, takes the first axis to the second, and turns by the angle between them."""
    rng = np.random.default_rng(seed)
    first = rng.normal(size=3)
    second = first + rng.choice([1e-6, 0.1, 1.0]) * rng.normal(size=3)
    first, second = first / np.linalg.norm(first), second / np.linalg.norm(second)
    rotation = rotation_between(first, second)
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(rotation @ first, second, atol=1e-14)
    angle = math.atan2(float(np.linalg.norm(np.cross(first, second))), float(first @ second))
    assert Rotation.from_matrix(rotation).magnitude() == pytest.approx(angle, abs=1e-9)
    none = np.zeros((0, 3))
    case = ErrorCase(
        position_offset_m=np.zeros(3),
        rotation_world=rotation,
        jammer_offsets_m=none,
        eavesdropper_offsets_m=none,
    )
    assert case.rotation_rad == pytest.approx(angle, abs=1e-12)


@pytest.mark.parametrize("name", ["position_offset_m", "rotation_world", "jammer_offsets_m"])
def test_a_case_is_its_numbers(name: str, paper: Scenario) -> None:
    """Compared to the last bit; numbers that are not finite, or too few of them, are refused by name."""
    case = random_case(np.random.default_rng(3), paper)
    parts = {each: np.array(getattr(case, each)) for each in ErrorCase.__slots__}
    assert case.is_same(ErrorCase(**parts))
    assert not case.is_same(ErrorCase(**parts | {name: np.nextafter(parts[name], np.inf)}))
    for bad in (np.full_like(parts[name], np.nan), parts[name][..., :2]):
        with pytest.raises(ValueError, match=name):
            ErrorCase(**parts | {name: bad})
