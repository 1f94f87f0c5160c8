"""MAiNGO, from the package maingopy: position, unit axis and level in its reduced space."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.provers.problem import FINISHED, NOT_CLOSED, Claim, Problem, Scaled
from benchmarks.provers.scip_model import cross, dot

_ROUNDING = 1e-9  # MAiNGO raises if a bounded expression leaves its bounds by rounding


class Maingo:
    """Seven variables: position, the axis as a unit vector of the upper half space, and the level.

    Each node's signal stands twice, as ``1/d^2 - (u.a)^2 / d^4`` and as ``(u x a)^2 / d^4``: each has the
    tighter relaxation somewhere. Auxiliary variables, relaxations at a simplex of points, CLP.
    """

    name = "maingo"
    label = "MAiNGO"
    package = "maingopy"

    def load(self) -> None:
        """Import MAiNGO."""
        importlib.import_module("maingopy")

    def prove(self, problem: Problem) -> Claim:
        """Solve with MAiNGO, and hand on what it claims."""
        mp = importlib.import_module("maingopy")
        scaled = Scaled(problem=problem)
        model = _model(mp, scaled)  # MAiNGO keeps no reference of its own
        solver = mp.MAiNGO(model)
        _set_options(mp, solver, problem)
        status = solver.solve()
        statuses = {mp.GLOBALLY_OPTIMAL: FINISHED, mp.FEASIBLE_POINT: NOT_CLOSED}
        nodes, bound = int(solver.get_iterations()), -solver.get_final_LBD()
        if status not in statuses:
            return Claim(status=str(status), bound=bound, nodes=nodes)
        x = [float(value) for value in solver.get_solution_point()]
        return Claim(
            status=statuses[status],
            value=-solver.get_objective_value(),
            bound=bound,
            position_m=tuple(value * scaled.unit_m for value in x[:3]),
            axis=tuple(x[3:6]),
            nodes=nodes,
        )


def _model(mp: Any, scaled: Scaled) -> Any:
    """Build the model, whose class is the package's and hence made only when the package is there."""

    class Model(mp.MAiNGOmodel):
        """Maximise a level that every node's ratio reaches."""

        def get_variables(self) -> list[Any]:
            low, high = scaled.box
            axis, level = [(-1.0, 1.0), (-1.0, 1.0), (0.0, 1.0)], (scaled.level_low, scaled.level_high)
            bounds = [*zip(low, high, strict=True), *axis, level]
            names = ("x", "y", "z", "ux", "uy", "uz", "level")
            return [
                mp.OptimizationVariable(mp.Bounds(float(a), float(b)), mp.VT_CONTINUOUS, name)
                for (a, b), name in zip(bounds, names, strict=True)
            ]

        def get_initial_point(self) -> list[float]:
            position, axis = scaled.start
            level = scaled.problem.start_value * (1.0 - 1e-7)  # feasible despite rounding
            return [*map(float, position), *map(float, axis), level]

        def evaluate(self, variables: Sequence[Any]) -> Any:
            return _evaluate(mp, scaled, variables)

    return Model()


def _evaluate(mp: Any, scaled: Scaled, variables: Sequence[Any]) -> Any:
    position, u, level = variables[:3], variables[3:6], variables[6]
    b = _towards(scaled.jammer, position)
    jamming = scaled.jamming * _square(mp, cross(u, b)) / mp.sqr(_distance2(mp, scaled, scaled.jammer, b))
    disturbance = jamming + scaled.noise
    result = mp.EvaluationContainer()
    result.obj = -level
    constraints = []
    for node, power, reach in zip(scaled.nodes, scaled.powers, scaled.reaches, strict=True):
        a = _towards(node, position)
        distance2 = _distance2(mp, scaled, node, a)
        by_cosine = 1.0 / distance2 - mp.sqr(dot(u, a) / distance2)
        by_sine = _square(mp, cross(u, a)) / mp.sqr(distance2)
        constraints += [level * disturbance - float(power) * signal for signal in (by_cosine, by_sine)]
        constraints.append(distance2 - float(reach))
    result.ineq = constraints
    result.eq = [_square(mp, u) - 1.0]
    return result


def _towards(point: NDArray[np.float64], position: Sequence[Any]) -> list[Any]:
    return [float(m) - x for m, x in zip(point, position, strict=True)]


def _distance2(mp: Any, scaled: Scaled, point: NDArray[np.float64], towards: Sequence[Any]) -> Any:
    near, far = scaled.squared_distances(point)
    return mp.bounding_func(_square(mp, towards), near - _ROUNDING, far + _ROUNDING)


def _square(mp: Any, vector: Sequence[Any]) -> Any:
    return mp.sqr(vector[0]) + mp.sqr(vector[1]) + mp.sqr(vector[2])


def _set_options(mp: Any, solver: Any, problem: Problem) -> None:
    options = {
        "epsilonR": problem.gap,
        "epsilonA": 1e-12,
        "maxTime": problem.cap_s,
        "LBP_addAuxiliaryVars": True,
        "LBP_linPoints": mp.LINP_SIMPLEX,
        "loggingDestination": mp.LOGGING_NONE,
        "writeResultFile": False,
        "writeCsv": False,
        "writeJson": False,
    }
    for name, value in options.items():
        if not solver.set_option(name, value):
            raise ValueError(f"MAiNGO refused {name} = {value!r}")
