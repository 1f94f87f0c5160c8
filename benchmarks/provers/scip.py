"""SCIP, from the package pyscipopt."""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np

from benchmarks.provers.problem import FINISHED, NOT_CLOSED, Claim, Problem, Scaled
from benchmarks.provers.scip_model import Draft, cross, dot

_CLOSED = ("gaplimit", "optimal")
_TIME_UP = "timelimit"


class Scip:
    """The interference as the square of ``sqrt(J) (u x b) / r^2``, b being the jammer as the drone sees it.

    Strong jamming then leaves every variable of order one. The axis is a unit vector of the upper half space,
    a node's signal ``1/d^2 - (u.a)^2 / d^4``. Heuristics, separators and obbt are off and the best bound
    comes first, which is faster than SCIP's own choice.
    """

    name = "scip"
    label = "SCIP"
    package = "pyscipopt"

    def load(self) -> None:
        """Import SCIP."""
        importlib.import_module("pyscipopt")

    def prove(self, problem: Problem) -> Claim:
        """Return what SCIP claims."""
        draft = Draft(Scaled(problem=problem))
        self._interference(draft)
        self._signals(draft)
        self._options(draft.model)
        return _claim(draft, problem)

    def _interference(self, draft: Draft) -> None:
        scaled, u, b = draft.scaled, draft.axis, draft.to_jammer
        grown = math.sqrt(scaled.jamming)
        most = math.sqrt(scaled.budget - scaled.noise)
        at = grown * np.cross(u.at, b.at) / draft.jammer_distance2.at
        v = [draft.variable(-most, most, float(x)) for x in at]
        for own, turned in zip(v, cross(u.terms, b.terms), strict=True):
            draft.model.addCons(own.term * draft.jammer_distance2.term == grown * turned)
        total = scaled.noise + float(at @ at)
        draft.disturbance = draft.variable(scaled.noise, scaled.budget, total)
        squares = dot([own.term for own in v], [own.term for own in v])
        draft.model.addCons(draft.disturbance.term >= scaled.noise + squares)

    def _signals(self, draft: Draft) -> None:
        level, disturbance, scaled = draft.level, draft.disturbance, draft.scaled
        signals = draft.signals()
        most = scaled.level_low * scaled.budget
        weakest = draft.variable(scaled.level_low * scaled.noise, most, level.at * disturbance.at)
        draft.model.addCons(weakest.term >= level.term * disturbance.term)
        for signal in signals:
            draft.model.addCons(signal >= weakest.term)

    def _options(self, model: Any) -> None:
        off = importlib.import_module("pyscipopt").SCIP_PARAMSETTING.OFF
        model.setHeuristics(off)
        model.setSeparating(off)
        model.setParam("propagating/obbt/freq", -1)
        model.setParam("nodeselection/bfs/stdpriority", 1_000_000)


def _claim(draft: Draft, problem: Problem) -> Claim:
    """Return what SCIP claims after the search."""
    model = draft.model
    model.setObjective(draft.level.term, "maximize")
    model.hideOutput()
    model.setParam("limits/gap", problem.gap)
    model.setParam("limits/time", problem.cap_s)
    draft.offer_start()
    model.optimize()
    status = model.getStatus()
    said = FINISHED if status in _CLOSED else NOT_CLOSED if status == _TIME_UP else status
    if not model.getNSols():
        return Claim(status=said, bound=model.getDualbound(), nodes=model.getNTotalNodes())
    position = [model.getVal(x) * draft.scaled.unit_m for x in draft.position.terms]
    return Claim(
        status=said,
        value=model.getObjVal(),
        bound=model.getDualbound(),
        position_m=tuple(position),
        axis=tuple(model.getVal(x) for x in draft.axis.terms),
        nodes=model.getNTotalNodes(),
    )
