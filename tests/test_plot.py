"""Figures for notebooks: axes come back, those that are given are drawn on, the kinds are not mixed up."""

import subprocess
import sys

import pytest
from matplotlib import pyplot

import nullpose
from nullpose import plot

SCENE = nullpose.Scenario.from_arrays(
    [[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30), name="scene"
)
RESULT = nullpose.solve(SCENE, certify=False)
TABLE = nullpose.sweep(SCENE, "jammers.M1.power_w", [0.5, 1.0, 2.0], certify=False)
DRAWN = {
    "plan": lambda ax: plot.plan(RESULT, ax=ax),
    "heat map": lambda ax: plot.heat_map(RESULT, ax=ax),
    "sweep": lambda ax: plot.sweep(TABLE, ax=ax, log=True),
    "cases": lambda ax: plot.comparison(nullpose.compare(SCENE, certify=False), ax=ax),
    "vehicles": lambda ax: plot.comparison(nullpose.compare_airframes(SCENE, certify=False), ax=ax),
}


@pytest.mark.parametrize("name", DRAWN)
def test_axes_come_back(name: str) -> None:
    """New ones without any given; with some given, these, and their figure gets no other main axes."""
    assert DRAWN[name](None).get_xlabel()
    _, axes = pyplot.subplots()
    assert DRAWN[name](axes) is axes
    assert axes.get_xlabel()
    solid = pyplot.figure().add_subplot(projection="3d")
    with pytest.raises(nullpose.NullposeError, match="without a projection"):
        DRAWN[name](solid)
    pyplot.close("all")


def test_a_pose_in_three_dimensions() -> None:
    """Wants axes in 3-D, and has a line towards every point."""
    axes = plot.pose(RESULT)
    assert sorted(line.get_label() for line in axes.lines if line.get_label() in ("node", "jammer")) == [
        "jammer",
        "node",
        "node",
    ]
    given = pyplot.figure().add_subplot(projection="3d")
    assert plot.pose(RESULT, ax=given) is given
    with pytest.raises(nullpose.NullposeError, match="projection='3d'"):
        plot.pose(RESULT, ax=pyplot.figure().add_subplot())
    pyplot.close("all")


def test_the_module_is_there_at_first_use() -> None:
    """After `import nullpose` alone, which does not load Matplotlib."""
    code = "import sys, nullpose; before = 'matplotlib' in sys.modules; print(before, nullpose.plot.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False nullpose.plot"
