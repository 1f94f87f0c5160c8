"""The largest value over a ball of a form, of its ratio to another, and of its ratio to a power.

Lemma 3 of docs/robust.md, parts 2 and 3.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.symmetric import eigen3
from nullpose.solver.kernels.linear_algebra.vectors import along, cross, dot, norm, scaled, store
from nullpose.solver.kernels.search.set_links import ORIGIN, ROUNDING

_ITERATIONS = 40
_QUICK = 12
_QUICK_TRIALS = 3


class Form(NamedTuple):
    """A form ``both (y x q).(a x q) + across |y x q|^2 + beside |a x q|^2 + length |q|^2``."""

    y: tuple[float, float, float]
    axis: tuple[float, float, float]  # a
    both: float
    across: float
    beside: float
    length: float


@inner_kernel
def form_times(form, v):
    """Return the product of a form's matrix and a vector, its digits kept beside the nulls."""
    y, axis = form.y, form.axis
    of_y, of_axis = cross(y, v), cross(axis, v)
    product = scaled(-0.5 * form.both, along(cross(y, of_axis), 1.0, cross(axis, of_y)))
    product = along(along(product, -form.across, cross(y, of_y)), -form.beside, cross(axis, of_axis))
    return along(product, form.length, v)


@inner_kernel
def lengthened(form, length):
    """Return a form with another multiple of ``|q|^2``."""
    return Form(form.y, form.axis, form.both, form.across, form.beside, length)


@inner_kernel
def largest_form(form, q, radius):
    """Return (an upper bound on a form over the ball ``q + radius x``, where it is about attained).

    The dual of a quadratic function over the unit ball, which has no gap: the least ``k + m + sum_i b_i^2 /
    (m - e_i)`` over m above the eigenvalues e, b being the linear part along the eigenvectors.
    """
    matrix, values, vectors, pull, x = scratch(3, 3), scratch(3), scratch(3, 3), scratch(3), scratch(3)
    for i in range(3):
        unit_vector = (1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0, 1.0 if i == 2 else 0.0)
        store(scaled(radius * radius, form_times(form, unit_vector)), matrix[i])
    eigen3(matrix, values, vectors)
    image = form_times(form, q)
    slope, bound, m = scaled(radius, image), dot(q, image), 0.0
    size = abs(bound)
    for i in range(3):
        pull[i] = slope[0] * vectors[0, i] + slope[1] * vectors[1, i] + slope[2] * vectors[2, i]
        m = max(m, values[i] + abs(pull[i]))
        size += abs(values[i]) + abs(pull[i])
    for _ in range(_ITERATIONS):
        square = change = 0.0
        for i in range(3):
            x[i] = pull[i] / (m - values[i]) if m > values[i] else 0.0
            square += x[i] * x[i]
            change += x[i] * x[i] / (m - values[i]) if m > values[i] else 0.0
        step = square * (math.sqrt(square) - 1.0) / change if square > 1.0 + 1e-15 else 0.0
        if not step > 1e-16 * m:
            break
        m += step
    x[0] = math.copysign(math.sqrt(max(0.0, 1.0 - square) + x[0] * x[0]), x[0])  # along the largest
    total = ORIGIN
    for i in range(3):
        bound += pull[i] * pull[i] / (m - values[i]) if m > values[i] else 0.0
        total = along(total, x[i], (vectors[0, i], vectors[1, i], vectors[2, i]))
    place = along(q, radius / max(1.0, norm(total)), total)
    return bound + m + ROUNDING * (size + m), place


@inner_kernel
def largest_ratio(form, q, radius, slope, constant, nearest, place, close):
    """Return (an upper bound on a form's ratio to ``slope |q'|^2 + constant``, where it is about attained).

    By Dinkelbach's method from a place, until the bound is relatively close to what is attained. The
    denominator is positive from the squared distance ``nearest`` on.
    """
    upper, at = math.inf, place
    ratio = dot(at, form_times(form, at)) / (slope * dot(at, at) + constant)
    for _ in range(_QUICK):
        most, at = largest_form(lengthened(form, form.length - ratio * slope), q, radius)
        upper = min(upper, ratio + max(0.0, most - ratio * constant) / (slope * nearest + constant))
        new = dot(at, form_times(form, at)) / (slope * dot(at, at) + constant)
        if new > ratio:
            ratio, place = new, at
        if upper - ratio <= close * abs(ratio):
            break
    return upper, place


@inner_kernel
def bound_of_part(form, power, trials, q, radius, near, far, nearest, tolerance, best, place):
    """Return (lemma 3 (2)'s bound where ``near <= |q'|^2 <= far``, where its form is about the largest).

    The form is over the power of ``|q'|^2``. The slope of the line under that is sought by bisection, until
    the bound is close to the best link.
    """
    bound, low, high = math.inf, 0.0, math.inf
    slope, at = min(max(dot(place, place), near), far), place
    for trial in range(trials):
        touch, square, steep = min(max(slope, near), far), 0.0, power * slope ** (power - 1.0)
        constant = touch**power - steep * touch
        if steep * nearest + constant > 0.0:
            upper, at = largest_ratio(form, q, radius, steep, constant, nearest, place, 0.2 * tolerance)
            bound = min(bound, upper)
            if bound <= best * (1.0 + tolerance):
                break
            square = dot(at, at)
        low, high = (slope, high) if square > touch else (low, slope)
        if not high - low > 1e-3 * slope:
            break
        inside = trial < _QUICK_TRIALS and low < square < high
        slope = square if inside else 0.5 * (low + min(high, 2.0 * slope))
    return bound, at
