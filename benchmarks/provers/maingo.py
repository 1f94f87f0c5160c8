"""MAiNGO, from the package maingopy, with two formulations in its reduced space."""

from __future__ import annotations

import importlib
from typing import Any

from benchmarks.provers.claim import FINISHED, NOT_CLOSED, Claim
from benchmarks.provers.maingo_charts import AimChart, AxisChart, Chart
from benchmarks.provers.maingo_model import build
from benchmarks.provers.problem import Problem, Scaled

__all__ = ["MaingoAim", "MaingoAxis"]

_OPTIONS = (
    "hybrid of reduced and full space (`LBP_addAuxiliaryVars`), relaxations refined in a simplex of points "
    "(`LBP_linPoints=3`), CLP; other options as they come"
)


class MaingoAxis:
    """Position, unit axis and level."""

    name = "maingo-axis"
    label = "MAiNGO, axis"
    package = "maingopy"
    chart: type[Chart] = AxisChart
    settings = (
        "seven variables: position, level, and the axis as a unit vector of the upper half space; each "
        "node's signal twice, as $1/d^2 - (u \\cdot a)^2 / d^4$ and as $(u \\times a)^2 / d^4$, of which "
        f"each has the tighter relaxation somewhere; {_OPTIONS}"
    )

    def load(self) -> None:
        """Import MAiNGO."""
        importlib.import_module("maingopy")

    def prove(self, problem: Problem) -> Claim:
        """Return what MAiNGO claims."""
        mp = importlib.import_module("maingopy")
        scaled = Scaled(problem=problem)
        chart = self.chart(scaled)
        model = build(mp, scaled, chart)  # MAiNGO keeps no reference of its own
        solver = mp.MAiNGO(model)
        _set_options(mp, solver, problem)
        status = solver.solve()
        closed = status == mp.GLOBALLY_OPTIMAL
        said = FINISHED if closed else NOT_CLOSED if status == mp.FEASIBLE_POINT else str(status)
        nodes, bound = int(solver.get_iterations()), -solver.get_final_LBD()
        if said not in (FINISHED, NOT_CLOSED):
            return Claim(status=said, bound=bound, nodes=nodes)
        x = list(solver.get_solution_point())
        return Claim(
            status=said,
            value=-solver.get_objective_value(),
            bound=bound,
            position_m=tuple(float(v) * scaled.unit_m for v in x[:3]),
            axis=tuple(float(v) for v in chart.axis(x[3:-1], x[:3])),
            nodes=nodes,
        )


class MaingoAim(MaingoAxis):
    """Position, the point that the axis aims at, and level."""

    name = "maingo-aim"
    label = "MAiNGO, aim"
    chart = AimChart
    settings = (
        "six variables: position, level, and two coordinates of the point where the axis meets a plane "
        "through the jammer, in units of $1/\\sqrt{J}$ and bounded by the interference that the start's "
        f"value leaves room for; {_OPTIONS}"
    )


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
