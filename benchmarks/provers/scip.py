"""SCIP, from the package pyscipopt, with two formulations."""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np

from benchmarks.provers.claim import FINISHED, NOT_CLOSED, Claim
from benchmarks.provers.problem import Problem, Scaled
from benchmarks.provers.scip_model import Draft, cross, dot

__all__ = ["Scip", "ScipPlain"]

_CLOSED = ("gaplimit", "optimal")
_TIME_UP = "timelimit"


class Scip:
    """The interference as the square of a short vector of its own, grown with the jamming."""

    name = "scip"
    label = "SCIP"
    package = "pyscipopt"
    settings = (
        "the axis a unit vector of the upper half space; a node's signal as $1/d^2 - (u \\cdot a)^2 / d^4$; "
        "the interference as the square of $\\sqrt{J} (u \\times b) / r^2$, with b from the drone to the "
        "jammer and r its length, so that strong jamming leaves every variable of order one; the start as a "
        "whole solution; heuristics, separators and `obbt` off and the best bound first, which was "
        "faster than SCIP's own choice; other options as they come"
    )

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


class ScipPlain(Scip):
    """The interference as it is usually written, ``J (1/|b|^2 - (u.b)^2/|b|^4)``, with SCIP's own options."""

    name = "scip-plain"
    label = "SCIP, plain form"
    settings = (
        "as SCIP, but the interference as $J (1/r^2 - (u \\cdot b)^2 / r^4)$, and every option as it comes: "
        "near the null that is a small difference of large numbers, and SCIP's tolerance of 1e-6 is "
        "multiplied by the jamming"
    )

    def _interference(self, draft: Draft) -> None:
        scaled, distance2 = draft.scaled, draft.jammer_distance2
        near, far = scaled.squared_distances(scaled.jammer)
        inverse = draft.variable(1.0 / far, 1.0 / near, 1.0 / distance2.at)
        draft.model.addCons(inverse.term * distance2.term == 1.0)
        along = draft.axis.at @ draft.to_jammer.at / distance2.at
        cosine = draft.variable(-1.0 / math.sqrt(near), 1.0 / math.sqrt(near), float(along))
        draft.model.addCons(cosine.term * distance2.term == dot(draft.axis.terms, draft.to_jammer.terms))
        total = scaled.noise + scaled.jamming * (inverse.at - cosine.at**2)
        draft.disturbance = draft.variable(scaled.noise, scaled.noise + scaled.jamming / near, total)
        left = scaled.jamming * (inverse.term - cosine.term * cosine.term)
        draft.model.addCons(draft.disturbance.term - scaled.noise == left)

    def _signals(self, draft: Draft) -> None:
        for signal in draft.signals():
            draft.model.addCons(signal >= draft.level.term * draft.disturbance.term)

    def _options(self, model: Any) -> None:
        """Leave every option as it comes."""


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
