"""The multistart search of a family under an axis field."""

import dataclasses
import math
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.errors import SolveError
from nullpose.family import AxisField, build_family
from nullpose.physics import sinr
from nullpose.solve.multistart import SearchSettings, landmarks, multistart

VERTICAL = AxisField.affine([0.0, 0.0, 1.0], np.zeros((3, 3)))


def test_what_is_found_is_what_it_says(paper: Callable) -> None:
    """The log value is that of the position and the axis found, by the physics."""
    scene = paper(10.0)
    for field in (AxisField.free(), VERTICAL):
        found = multistart(build_family(scene), field, seed=0)
        axis = found.axis / np.linalg.norm(found.axis)
        assert found.log_value == pytest.approx(
            math.log(np.min(sinr(scene, found.position_m, axis))), abs=1e-12
        )


def test_seeds_agree_and_repeat(random_scene: Callable) -> None:
    """A seed repeats to the last bit; different seeds come to the same value."""
    rng = np.random.default_rng(61)
    for _ in range(5):
        family = build_family(random_scene(rng, 4, 2, 10.0))
        first, again, other = (multistart(family, AxisField.free(), seed=seed) for seed in (0, 0, 1))
        np.testing.assert_array_equal(first.position_m, again.position_m)
        np.testing.assert_array_equal(first.axis, again.axis)
        assert (first.log_value, first.starts, first.evaluations) == (
            again.log_value,
            again.starts,
            again.evaluations,
        )
        assert other.log_value == pytest.approx(first.log_value, abs=1e-9)


def test_settings_bound_the_work(paper: Callable) -> None:
    """One round of few positions makes few starts, and patience ends the rounds early."""
    family = build_family(paper(1.0))
    frugal = SearchSettings(coarse=16, polished=2, rounds=1, patience=1)
    few = multistart(family, AxisField.free(), seed=0, settings=frugal)
    assert few.starts <= len(landmarks(family)) + 2
    patient = dataclasses.replace(frugal, rounds=50, patience=1)
    assert multistart(family, AxisField.free(), seed=0, settings=patient).starts <= len(landmarks(family)) + 6


def test_landmarks_stand_over_what_matters(scene: Callable) -> None:
    """There is a start over the nodes' centre, over each jammer and over each node, all on the floor."""
    family = build_family(scene([(0, 0, 0), (20, 0, 1)], [(5, 5, 0), (7, -3, 2)], altitude_m=(6.0, 9.0)))
    places = {tuple(float(x) for x in place) for place in landmarks(family)}
    assert {(10.0, 0.0, 6.0), (5.0, 5.0, 6.0), (7.0, -3.0, 6.0), (0.0, 0.0, 6.0), (20.0, 0.0, 6.0)} <= places


def test_the_needle_over_the_jammer_is_found(scene: Callable) -> None:
    """The vertical optimum under strong jamming is a needle over the jammer, which every seed finds."""
    rng = np.random.default_rng(71)
    for _ in range(10):
        jammer = tuple(rng.uniform([10.0, 10.0, 0.0], [40.0, 40.0, 4.0]))
        family = build_family(scene([(0, 0, 0), (0, 50, 0), (50, 25, 0)], [jammer], jammer_powers_w=1e6))
        for seed in range(3):
            found = multistart(family, VERTICAL, seed=seed)
            np.testing.assert_allclose(found.position_m, [*jammer[:2], 8.0], atol=1e-3)


def test_a_domain_without_a_value_is_said(scene: Callable) -> None:
    """Where the only position has the node in the null, there is nothing to find, and that is said."""
    point = scene([(0, 0, 0)], x_m=(0.0, 0.0), y_m=(0.0, 0.0), altitude_m=(8.0, 8.0))
    with pytest.raises(SolveError, match="widen the airspace or reduce keep_out_m"):
        multistart(build_family(point), VERTICAL, seed=0)
