"""The compiled loop over families: the same incumbents and bounds as a run in Python."""

import math

import numpy as np

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.batch import Batch, BatchOutcome
from nullpose.solve.kernels.many import OPEN, PROVED
from nullpose.solve.options import SolveOptions
from nullpose.solve.solve_and_prove import solve_and_prove


def some_families(count: int):
    """Returns families of random scenes of one shape."""
    rng = np.random.default_rng(12)
    scenes = [
        {
            "airspace": {"altitude_m": [8.0, 30.0]},
            "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
            "nodes": [{"position_m": [*rng.uniform(0.0, 60.0, 2), 0.0], "power_w": 1.0} for _ in range(2)],
            "jammers": [
                {"position_m": [*rng.uniform(0.0, 60.0, 2), 3.0], "power_w": 10.0 ** rng.uniform(-1.0, 2.0)}
            ],
        }
        for _ in range(count)
    ]
    return [build_family(Scenario.from_dict(scene)) for scene in scenes]


def test_the_loop_is_the_run_for_each() -> None:
    """The same pose, value, bound and number of boxes, to the last digit."""
    families, effort = some_families(6), SolveOptions(gap=1e-4, threads=1)
    for field in (AxisField.free(), AxisField.within(0.0, 0.0), AxisField.within(0.0, 0.1)):
        known = BatchOutcome.blank(6, 2)
        Batch(families).solve_and_prove(field, effort, known)
        for place, family in enumerate(families):
            alone = solve_and_prove(family, [field], effort)
            assert known.log_value[place] == alone.incumbent.log_value
            np.testing.assert_array_equal(known.position_m[place], alone.incumbent.position_m)
            np.testing.assert_array_equal(known.axis[place], alone.incumbent.axis)
            assert known.bound[place] == alone.upper_bound
            assert known.boxes[place] == alone.nodes


def test_what_is_settled_is_left_alone() -> None:
    """Proved families are not touched, and a known bound close enough proves without a box."""
    families = some_families(3)
    effort = SolveOptions(gap=1e-3)
    known = BatchOutcome.blank(3, 2)
    known.code[0] = PROVED
    batch = Batch(families)
    batch.solve_and_prove(AxisField.free(), effort, known)
    assert known.log_value[0] == -math.inf
    again = BatchOutcome.blank(3, 2)
    again.learn_from(known, (0.0, 1.0))
    assert np.all(again.code == OPEN)
    batch.solve_and_prove(AxisField.free(), effort, again)
    np.testing.assert_array_equal(again.boxes[1:], 0)
    np.testing.assert_array_equal(again.log_value[1:], known.log_value[1:])
