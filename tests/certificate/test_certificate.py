"""Certificates: which axes a scheme claims, and that no code of the solver is used to check them."""

import math
import subprocess
import sys
from collections.abc import Callable

import numpy as np
import pytest

from nullpose.certificate import claimed_axes
from nullpose.problem.axis_field import AxisField
from nullpose.scenario import Airframe


def test_the_axes_are_the_schemes(random_scene: Callable) -> None:
    """Each field is the paper's."""
    scenario = random_scene(1, 2, 2)
    expected = {
        ("optimum", "free"): AxisField.free(),
        ("vertical", "vertical"): AxisField.vertical(),
        ("zero-interference", "null M2"): AxisField.towards(scenario.jammer_positions_m[1]),
        ("maximum-gain", "broadside"): AxisField.broadside(*scenario.node_positions_m),
    }
    for (scheme, name), field in expected.items():
        claimed = claimed_axes(scenario, scheme, None)[name]
        for one, other in zip(claimed.arrays, field.arrays, strict=True):
            assert np.array_equal(one, other)


def test_the_optimum_keeps_to_the_airframe(random_scene: Callable) -> None:
    """Any axis, a band of them, or the vertical: what the airframe reaches."""
    cases = [
        ({"preset": "omnidirectional"}, "free", AxisField.free()),
        ({"tilt_max_deg": 50.0, "mount_deg": 40.0}, "free", AxisField.free()),
        ({"preset": "level"}, "vertical", AxisField.vertical()),
        ({"preset": "level", "mount_deg": 90.0}, "band", AxisField.within(0.0, 0.0)),
        ({"tilt_max_deg": 60.0}, "band", AxisField.within(math.cos(math.radians(60.0)) ** 2, 1.0)),
    ]
    for airframe, name, field in cases:
        scenario = random_scene(1, 2, 1).model_copy(update={"airframe": Airframe(**airframe)})
        claimed = claimed_axes(scenario, "optimum", None)
        assert list(claimed) == [name]
        assert claimed[name].band == field.band
        for one, other in zip(claimed[name].arrays, field.arrays, strict=True):
            assert np.array_equal(one, other)


@pytest.mark.parametrize(
    ("scheme", "null_jammer"),
    [
        ("", None),
        ("Optimum", None),
        ("zero-interference", "M9"),
        ("zero-interference", ""),
        ("optimum", "M1"),
        ("vertical", "M1"),
        ("maximum-gain", "M1"),
    ],
)
def test_others_have_none(scheme: str, null_jammer: str | None, random_scene: Callable) -> None:
    """Unknown schemes and jammers, and a jammer to null where no null is pointed, claim nothing."""
    assert claimed_axes(random_scene(1, 2, 2), scheme, null_jammer) is None


def test_the_verifier_needs_no_solver() -> None:
    """Importing the verifier loads neither the solver nor its compiler."""
    program = (
        "import sys, nullpose.certificate\n"
        "others = ('nullpose.solver', 'nullpose.report', 'numba', 'scipy')\n"
        "print([name for name in sys.modules if name.startswith(others)])\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
