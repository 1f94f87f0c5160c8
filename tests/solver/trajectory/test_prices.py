"""The bound by prices: a box of positions is excluded only if no position in it is worth its price."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples

from nullpose import Scenario
from nullpose.solver.kernels.bounds import branch, node
from nullpose.solver.kernels.bounds.records import Goal
from nullpose.solver.kernels.compiler.jit import entry_of
from nullpose.solver.trajectory.course import Aim, Course, likely_poses


def instant(aim: Aim, airframe: dict[str, object]) -> Course:
    """Build a course of two instants, of which the first is looked at."""
    return Course.of(
        Scenario.from_dict(
            {
                "time": {"duration_s": 1.0, "step_s": 1.0},
                "airspace": {"altitude_m": [8.0, 60.0]},
                "airframe": {"speed_max_m_s": 4.0, **airframe},
                "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
                "nodes": [
                    {"position_m": [x, y, 0.0], "power_w": 1.0} for x, y in [(0, 0), (0, 50), (30, 20)]
                ],
                "jammers": [
                    {"position_m": [20.0, 15.0, 4.0], "power_w": 3.0, "velocity_m_s": [8.0, 1.0, 0.0]},
                    {"position_m": [-40.0, 90.0, 4.0], "power_w": 20.0},
                ],
            }
        ),
        aim,
    )


COURSES = {
    (aim, name): instant(aim, airframe)
    for aim in (Aim.MEAN_DB, Aim.MEAN_RATE)
    for name, airframe in {
        "free": {"preset": "omnidirectional"},
        "band": {"mount_deg": 20.0, "tilt_max_deg": 30.0},
    }.items()
}


def is_excluded(course: Course, tilt: np.ndarray, low_m: np.ndarray, high_m: np.ndarray, most: float) -> bool:
    """Ask whether one look at a box shows that no gain there plus ``tilt . p`` is this much."""
    family, offset = course.families[0], float(course.aim is Aim.MEAN_RATE)
    row = np.zeros(node.COLUMNS)
    row[node.CENTRE : node.HALF], row[node.HALF : node.LEVEL] = (low_m + high_m) / 2, (high_m - low_m) / 2
    row[node.FACE] = -1.0
    node.keep_largest(np.ones(3), 3, row, False)
    stack, leaves, none = np.zeros((64, node.COLUMNS)), np.zeros((2, node.COLUMNS)), np.zeros(3)
    stack[0] = row
    goal = Goal(math.exp(most) - offset, row, 1.0, np.concatenate([tilt, np.zeros(3), [offset]]))
    domain = family.domain._replace(low_m=low_m, high_m=high_m)
    fixed = family.ratios, domain, course.field.arrays, math.exp(most) - offset, goal
    _, top, filled, *_ = entry_of(branch.branch)(*fixed, stack, 1, leaves, 0, 1, none, none)
    return bool(filled == 1 and top == 0)


@pytest.mark.parametrize(("aim", "airframe"), list(COURSES))
@few_examples(20)
@given(seed=st.integers(0, 10**6))
def test_no_box_is_excluded_that_has_what_is_sought(aim: Aim, airframe: str, seed: int) -> None:
    """Whatever the price, the size of the box, and what is subtracted there."""
    course, random = COURSES[aim, airframe], np.random.default_rng(seed)
    half_m = 10 ** random.uniform(-2.0, 1.0) * random.uniform(0.2, 1.0, size=3)
    centre_m = random.uniform((-30, -30, 18), (60, 80, 50))
    tilt = random.normal(size=3) * 10 ** random.uniform(-3.0, 0.3)
    steps = random.choice([-1.0, 1.0], size=(60, 3)) * np.minimum(1.0, random.uniform(0.1, 3.0, size=(60, 3)))
    places_m = centre_m + steps * half_m
    gains = course.aim.gains(likely_poses(course, 0, places_m)[1]) + places_m @ tilt
    low_m, high_m = centre_m - half_m, centre_m + half_m
    assert not is_excluded(course, tilt, low_m, high_m, float(np.max(gains)) - 1e-9)


def test_a_price_does_not_blunt_the_test_of_a_box() -> None:
    """Beside the largest value at the centres of small boxes a price by metre costs next to nothing."""
    course = COURSES[Aim.MEAN_DB, "free"]
    random, excluded = np.random.default_rng(5), 0
    for _ in range(50):
        centre_m, tilt = random.uniform((-30, -30, 20), (60, 80, 50)), 0.05 * random.normal(size=3)
        half_m = np.full(3, 0.25)
        best = course.aim.gains(likely_poses(course, 0, centre_m[None])[1])[0] + centre_m @ tilt
        offered = float(np.abs(tilt) @ half_m)
        excluded += is_excluded(course, tilt, centre_m - half_m, centre_m + half_m, float(best) + 2 * offered)
    assert excluded > 40
