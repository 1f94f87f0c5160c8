"""The family of a scenario under error cases, against the plain physics."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy.spatial.transform import Rotation

from nullpose.physics import ErrorCase, ratios_under
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.robust import BindingCase, build_robust_family, point_uncertainty_m
from nullpose.scenario import Scenario
from scenes import small

SEEDS = st.integers(0, 2**32 - 1)
HIGH = {"altitude_m": (10.0, 40.0)}


def a_scene(rng: np.random.Generator, *, secret: bool) -> Scenario:
    """Returns three nodes and two jammers, or with them two eavesdroppers, all known to some metres."""
    places = rng.uniform(0.0, [80.0, 80.0, 4.0], (7, 3)).tolist()
    nodes = [{"position_m": at, "power_w": rng.uniform(0.5, 2.0)} for at in places[:3]]
    jammers = [{"position_m": at, "power_w": 3.0, "uncertainty_m": 2.0} for at in places[3:5]]
    if not secret:
        nodes[2]["weight"] = 2.5
        return Scenario.from_dict(small(airspace=HIGH, nodes=nodes, jammers=jammers))
    ears = [
        {"position_m": at, "uncertainty_m": radius} for at, radius in zip(places[5:], (1, 2), strict=True)
    ]
    heard = {"objective": "secrecy-rate", "transmitter": {"power_w": 1.5}, "eavesdroppers": ears}
    return Scenario.from_dict(small(airspace=HIGH, nodes=nodes, jammers=jammers, **heard))


def some_case(rng: np.random.Generator, scene: Scenario) -> ErrorCase:
    """Returns a case in which all is off, as no set of errors would allow either."""
    return ErrorCase(
        position_offset_m=0.5 * rng.normal(size=3),
        rotation_world=Rotation.from_rotvec(0.05 * rng.normal(size=3)).as_matrix(),
        jammer_offsets_m=rng.normal(size=(len(scene.jammers), 3)),
        eavesdropper_offsets_m=rng.normal(size=(len(scene.eavesdroppers), 3)),
    )


def ratios_of(family: Family, position: np.ndarray, axis: np.ndarray) -> np.ndarray:
    """Returns the ratios of a family at a pose, by its definition, with a unit axis for every point."""
    ratios = family.ratios
    seen = np.broadcast_to(axis, ratios.points_m.shape)
    if len(ratios.turn):
        seen = ratios.turn @ axis
    r = ratios.points_m - position
    links = np.sum(np.cross(seen, r) ** 2, axis=1) / np.sum(r**2, axis=1) ** 2
    weighted = ratios.denominator_weight * links[ratios.denominator_point]
    start = ratios.denominator_start
    below = ratios.denominator_isotropic + np.array([math.fsum(weighted[a:b]) for a, b in pairwise(start)])
    above = ratios.numerator_isotropic + ratios.numerator_weight * links[ratios.numerator_point]
    return above / below[ratios.denominator_of]


@given(seed=SEEDS, secret=st.booleans())
def test_ratios_are_those_of_the_cases(seed: int, secret: bool) -> None:
    """At any pose, ratio s of the family is the nominal ratio when case s comes true, by the physics."""
    rng = np.random.default_rng(seed)
    scene = a_scene(rng, secret=secret)
    listeners = 2 if secret else 1
    cases = [BindingCase(int(rng.integers(3 * listeners)), some_case(rng, scene)) for _ in range(7)]
    cases += [BindingCase(ratio, cases[0].case) for ratio in range(3 * listeners)]
    family = build_robust_family(scene, cases)
    position = rng.uniform([0.0, 0.0, 10.0], [80.0, 80.0, 40.0])
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    expected = [ratios_under(scene, position, axis, one.case)[divmod(one.ratio, listeners)] for one in cases]
    np.testing.assert_allclose(ratios_of(family, position, axis), expected, rtol=1e-11)


@pytest.mark.parametrize("secret", [False, True])
def test_without_errors_it_is_the_nominal_family(secret: bool) -> None:
    """With no error in any case, ratios and denominators are those of the nominal family, none twice."""
    scene = a_scene(np.random.default_rng(1), secret=secret)
    nominal = build_family(scene)
    n_ratios = len(nominal.ratios.numerator_point)
    family = build_robust_family(scene, [BindingCase(r, ErrorCase.none(scene)) for r in range(n_ratios)])
    assert family.ratios.turn.shape == (0, 3, 3)
    assert len(family.ratios.denominator_isotropic) == len(nominal.ratios.denominator_isotropic)
    assert len(family.ratios.points_m) == 3 + len(nominal.ratios.denominator_point)
    rng = np.random.default_rng(2)
    position, axis = rng.uniform([0.0, 0.0, 10.0], [80.0, 80.0, 40.0]), np.array([0.6, 0.0, 0.8])
    np.testing.assert_allclose(
        ratios_of(family, position, axis), ratios_of(nominal, position, axis), rtol=1e-14
    )


def test_points_have_the_sets_of_whom_they_stand_for() -> None:
    """Nodes are known; jammers, or with secrecy rates eavesdroppers, have their own radii."""
    for secret in (False, True):
        scene = a_scene(np.random.default_rng(7), secret=secret)
        radii_m = point_uncertainty_m(scene)
        assert radii_m.shape == build_family(scene).ratios.points_m.shape[:1]
        np.testing.assert_array_equal(radii_m[:3], np.zeros(3))
        np.testing.assert_array_equal(radii_m[3:5], (1.0, 2.0) if secret else (2.0, 2.0))
        np.testing.assert_array_equal(radii_m[5:], np.zeros(len(radii_m) - 5))
