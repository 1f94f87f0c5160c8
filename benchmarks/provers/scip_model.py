"""What both formulations for SCIP share: position, axis, distances, signals, each with its start.

SCIP takes a start only as a value for every variable, so each variable is made together with its own.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.provers.problem import Scaled

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A variable or an expression of SCIP, and its value at the start."""

    term: Any
    at: float


@dataclass(frozen=True, slots=True)
class Vector:
    """Three of them."""

    terms: Sequence[Any]
    at: FloatArray


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Return the inner product of two vectors of expressions."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Sequence[Any], b: Sequence[Any]) -> list[Any]:
    """Return the outer product of two vectors of expressions."""
    return [a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1))]


class Draft:
    """A model with position, axis, level and distances, for a formulation to complete."""

    disturbance: Quantity

    def __init__(self, scaled: Scaled) -> None:
        self.scaled = scaled
        self.model = importlib.import_module("pyscipopt").Model()
        self._made: list[tuple[Any, float]] = []
        position, axis = scaled.start
        low, high = scaled.box
        self.position = self._vector(low, high, position)
        self.axis = self._vector(np.array([-1.0, -1.0, 0.0]), np.ones(3), axis)
        self.model.addCons(dot(self.axis.terms, self.axis.terms) == 1.0)
        self.level = self.variable(scaled.level_low, scaled.level_high, scaled.problem.start_value)
        self.to_jammer = self._towards(scaled.jammer)
        self.jammer_distance2 = self._squared(self.to_jammer, *scaled.squared_distances(scaled.jammer))

    def variable(self, low: float, high: float, at: float) -> Quantity:
        """Return a new variable between bounds, with its value at the start."""
        term = self.model.addVar(lb=low, ub=high)
        self._made.append((term, at))
        return Quantity(term, at)

    def signals(self) -> list[Any]:
        """Return each node's received power over its noise-free one at the unit distance, as expressions.

        ``P sin^2 / d^2 = P (1/d^2 - (u.a / d^2)^2)``, with a variable for each of the two inner quotients.
        """
        found, distances = [], []
        for node, power, reach in zip(
            self.scaled.nodes, self.scaled.powers, self.scaled.reaches, strict=True
        ):
            near, far = self.scaled.squared_distances(node)
            a = self._towards(node)
            distance2 = self._squared(a, near, min(far, reach))
            inverse = self.variable(1.0 / min(far, reach), 1.0 / near, 1.0 / distance2.at)
            self.model.addCons(inverse.term * distance2.term == 1.0)
            most = 1.0 / math.sqrt(near)
            cosine = self.variable(-most, most, float(self.axis.at @ a.at) / distance2.at)
            self.model.addCons(cosine.term * distance2.term == dot(self.axis.terms, a.terms))
            found.append(float(power) * (inverse.term - cosine.term * cosine.term))
            distances.append(distance2.term)
        self._relate(distances)
        return found

    def offer_start(self) -> None:
        """Hand the start over as a solution, which SCIP takes if it finds it feasible."""
        solution = self.model.createSol()
        for term, at in self._made:
            self.model.setSolVal(solution, term, at)
        self.model.addSol(solution)

    def _relate(self, distances: Sequence[Any]) -> None:
        # squared distances differ by something linear in the position, which relaxations do not see
        first = self.scaled.nodes[0]
        for node, distance2 in zip(self.scaled.nodes[1:], distances[1:], strict=True):
            slope = 2.0 * (node - first)
            moved = sum(float(s) * x for s, x in zip(slope, self.position.terms, strict=True))
            self.model.addCons(distances[0] - distance2 == float(first @ first - node @ node) + moved)

    def _vector(self, low: FloatArray, high: FloatArray, at: FloatArray) -> Vector:
        return Vector(
            [self.variable(*map(float, three)).term for three in zip(low, high, at, strict=True)], at
        )

    def _towards(self, point: FloatArray) -> Vector:
        terms = [float(x) - own for x, own in zip(point, self.position.terms, strict=True)]
        return Vector(terms, point - self.position.at)

    def _squared(self, vector: Vector, low: float, high: float) -> Quantity:
        found = self.variable(low, high, float(vector.at @ vector.at))
        self.model.addCons(found.term == dot(vector.terms, vector.terms))
        return found
