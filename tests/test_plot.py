"""Figures for notebooks: axes come back, those that are given are drawn on, those in 3-D are refused."""

import subprocess
import sys
from functools import cache, partial

import pytest
from matplotlib import pyplot

import nullpose
from nullpose import plot

SCENE = nullpose.Scenario.from_arrays(
    [[0, 0, 0], [0, 50, 0]], [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30), name="scene"
)
result, cases, vehicles = (
    cache(partial(made, SCENE, certify=False))
    for made in (nullpose.solve, nullpose.compare, nullpose.compare_airframes)
)
table = cache(partial(nullpose.sweep, SCENE, "jammers.M1.power_w", [0.5, 1.0, 2.0], certify=False))
DRAWN = {
    "plan": lambda ax: plot.plan(result(), ax=ax),
    "heat map": lambda ax: plot.heat_map(result(), ax=ax),
    "sweep": lambda ax: plot.sweep(table(), ax=ax, log=True),
    "cases": lambda ax: plot.comparison(cases(), ax=ax),
    "vehicles": lambda ax: plot.comparison(vehicles(), ax=ax),
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


def test_the_module_is_there_at_first_use() -> None:
    """After `import nullpose` alone, which does not load Matplotlib."""
    code = "import sys, nullpose; before = 'matplotlib' in sys.modules; print(before, nullpose.plot.__name__)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False nullpose.plot"
