"""The model that MAiNGO solves: maximise a level that every node's ratio reaches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.provers.maingo_charts import Chart
from benchmarks.provers.problem import Scaled
from benchmarks.provers.scip_model import cross, dot

__all__ = ["build"]

_ROOM = 1e-9  # MAiNGO raises if a bounded expression leaves its bounds by rounding


def build(mp: Any, scaled: Scaled, chart: Chart) -> Any:
    """Return the model: a class of the package's own, hence made only when the package is there.

    Args:
        mp: the package.
        scaled: the problem.
        chart: how the axis is written.
    """

    class Model(mp.MAiNGOmodel):
        """Position, axis and level."""

        def get_variables(self) -> list[Any]:
            """Return the variables, boxed."""
            low, high = scaled.box
            level = (scaled.level_low, scaled.level_high)
            bounds = [*zip(low, high, strict=True), *chart.bounds, level]
            names = ("x", "y", "z", *chart.names, "level")
            return [
                mp.OptimizationVariable(mp.Bounds(float(a), float(b)), mp.VT_CONTINUOUS, name)
                for (a, b), name in zip(bounds, names, strict=True)
            ]

        def get_initial_point(self) -> list[float]:
            """Return the start, its level a little lower so that it is feasible despite rounding."""
            return [*map(float, scaled.start[0]), *chart.start, scaled.problem.start_value * (1.0 - 1e-7)]

        def evaluate(self, variables: Sequence[Any]) -> Any:
            """Return minus the level, and what holds it down."""
            return _evaluate(mp, scaled, chart, variables)

    return Model()


def _evaluate(mp: Any, scaled: Scaled, chart: Chart, variables: Sequence[Any]) -> Any:
    position, own, level = variables[:3], variables[3:-1], variables[-1]
    u = chart.axis(own, position)
    norm2: Any = 1.0 if chart.normed else _square(mp, u)
    disturbance = _interference(mp, scaled, chart, own, position) + scaled.noise * norm2
    result = mp.EvaluationContainer()
    result.obj = -level
    limits = []
    for node, power, reach in zip(scaled.nodes, scaled.powers, scaled.reaches, strict=True):
        a = _towards(node, position)
        distance2 = _distance2(mp, scaled, node, a)
        signal = norm2 / distance2 - mp.sqr(dot(u, a) / distance2)
        limits += [level * disturbance - float(power) * signal, distance2 - float(reach)]
        if chart.normed:
            # the same signal again: each form's relaxation is the tighter one somewhere
            again = _square(mp, cross(u, a)) / mp.sqr(distance2)
            limits.append(level * disturbance - float(power) * again)
    result.ineq = limits
    if chart.normed:
        result.eq = [_square(mp, u) - 1.0]
    return result


def _interference(mp: Any, scaled: Scaled, chart: Chart, own: Sequence[Any], position: Sequence[Any]) -> Any:
    b = _towards(scaled.jammer, position)
    swing, left_out = chart.swing(own, b)
    factor = scaled.jamming / left_out**2
    return factor * _square(mp, cross(swing, b)) / mp.sqr(_distance2(mp, scaled, scaled.jammer, b))


def _towards(point: NDArray[np.float64], position: Sequence[Any]) -> list[Any]:
    return [float(m) - x for m, x in zip(point, position, strict=True)]


def _distance2(mp: Any, scaled: Scaled, point: NDArray[np.float64], towards: Sequence[Any]) -> Any:
    near, far = scaled.squared_distances(point)
    return mp.bounding_func(_square(mp, towards), near - _ROOM, far + _ROOM)


def _square(mp: Any, vector: Sequence[Any]) -> Any:
    return mp.sqr(vector[0]) + mp.sqr(vector[1]) + mp.sqr(vector[2])
