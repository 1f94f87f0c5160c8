"""Stacked families: what they must share, and what one vehicle's answer says of another's."""

import numpy as np
import pytest

from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.batch import Batch, BatchOutcome, same_shape
from nullpose.solve.options import SolveOptions


def family_of(jammer_m: tuple[float, float, float], *, nodes: int = 2, ceiling_m: float = 30.0):
    """Returns the family of a scene with one jammer."""
    return build_family(
        Scenario.from_dict(
            {
                "airspace": {"altitude_m": [8.0, ceiling_m]},
                "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
                "nodes": [{"position_m": [0.0, 40.0 * k, 0.0], "power_w": 1.0} for k in range(nodes)],
                "jammers": [{"position_m": list(jammer_m), "power_w": 10.0}],
            }
        )
    )


def test_shapes_tell_what_can_be_stacked() -> None:
    """Places and powers may differ; counts, the airspace and the keep-out balls that reach it may not."""
    first = same_shape(family_of((17.0, 15.0, 4.0)))
    assert same_shape(family_of((3.0, -9.0, 2.0))) == first
    assert same_shape(family_of((17.0, 15.0, 4.0), nodes=3)) != first
    assert same_shape(family_of((17.0, 15.0, 4.0), ceiling_m=31.0)) != first
    assert same_shape(family_of((17.0, 15.0, 7.5))) != first  # its ball reaches into the airspace


def test_a_larger_field_teaches_a_smaller_one() -> None:
    """Its bound holds, and its pose counts where the axis is in the band."""
    larger = BatchOutcome.blank(2, 2)
    larger.axis[:] = [[1.0, 0.0, 0.1], [0.0, 0.2, 1.0]]
    larger.bound[:] = 2.0, 3.0
    larger.log_value[:] = 0.5, 0.7
    smaller = BatchOutcome.blank(2, 2)
    smaller.learn_from(larger, (0.0, 0.03))
    np.testing.assert_array_equal(smaller.bound, [2.0, 3.0])
    np.testing.assert_array_equal(smaller.log_value, [0.5, -np.inf])
    np.testing.assert_array_equal(smaller.axis[0], larger.axis[0])


@pytest.mark.parametrize("certify", [True, False])
def test_settling_fills_what_is_known(certify: bool) -> None:
    """Poses with a finite value; bounds only if a proof was asked for."""
    batch = Batch([family_of((17.0, 15.0, 4.0)), family_of((-5.0, 20.0, 2.0))])
    known = BatchOutcome.blank(2, 2)
    batch.solve_and_prove(AxisField.free(), SolveOptions(gap=1e-3, certify=certify), known)
    assert np.all(np.isfinite(known.log_value))
    assert np.all(known.placed)
    assert np.all(known.certified == certify)
    assert np.all(np.isfinite(known.bound) == certify)
    if certify:
        assert np.all(known.bound <= np.exp(known.log_value) * 1.001)
        assert np.all(known.bound >= np.exp(known.log_value))
