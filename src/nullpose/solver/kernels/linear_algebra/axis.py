"""The exact best axis at a fixed position: ``max over |v| = 1 of min_k v^T A_k v``.

At the maximum one, two or three forms are equal and smallest:

- one: its top eigenvector;
- two: a stationary point of one of them on the cone ``v^T (A_i - A_j) v = 0``, a conic of the projective
  plane, which a parameter s traces by quadratic polynomials; stationarity is a polynomial of degree six in s;
- three: the meeting points of two such conics, a polynomial of degree four.

All of these are enumerated, but only over a working set that grows by the form most violated: the maximum
over a working set is an upper bound, so once its best point satisfies all forms it is the maximum over all.
With different denominators (several groups) Dinkelbach's iteration brings the ratios to this case.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch, zeroed
from nullpose.solver.kernels.linear_algebra.forms import (
    bilinear,
    congruence,
    fill_forms,
    form_value,
    inverse_factor,
    smallest_form,
)
from nullpose.solver.kernels.linear_algebra.links import log_objective
from nullpose.solver.kernels.linear_algebra.polynomial import real_roots
from nullpose.solver.kernels.linear_algebra.symmetric import (
    copy_into,
    eigen3,
    largest_eigenvalue,
    matrix_of,
    normalise,
)
from nullpose.solver.kernels.linear_algebra.vectors import dot, store, unit

_MAX_CANDIDATES = 4000
_FLAT = 1e-10
_IDENTITY = (1.0, 1.0, 1.0, 0.0, 0.0, 0.0)
_DINKELBACH_STEPS = 60


class Candidates(NamedTuple):
    """Directions at which the working set's maximum may lie, and what they reach.

    Args:
        forms: (m, 6), the working set's first.
        directions: (c, 3) unit vectors.
        values: (c,) the smallest form of the working set there.
    """

    forms: NDArray[np.float64]
    directions: NDArray[np.float64]
    values: NDArray[np.float64]


@inner_kernel
def quartic(a, curve, out):
    """Fill the coefficients of ``v(s)^T A v(s)`` for ``v(s) = c0 + c1 s + c2 s^2``."""
    out[0] = bilinear(a, curve[0], curve[0])
    out[1] = 2.0 * bilinear(a, curve[0], curve[1])
    out[2] = 2.0 * bilinear(a, curve[0], curve[2]) + bilinear(a, curve[1], curve[1])
    out[3] = 2.0 * bilinear(a, curve[1], curve[2])
    out[4] = bilinear(a, curve[2], curve[2])


@inner_kernel
def combine(vectors, wide, x, y, z, out):
    """Fill ``x`` times the wide eigenvector, ``y`` times the middle one and ``z`` times the one left."""
    for i in range(3):
        out[i] = x * vectors[i, wide] + y * vectors[i, 1] + z * vectors[i, 2 - wide]


@inner_kernel
def equal_cone(difference, curves):
    """Fill the curves, each (3, 3), whose traces over s in [-1, 1] cover ``v^T B v = 0``; return how many."""
    matrix, values, vectors = scratch(3, 3), scratch(3), scratch(3, 3)
    matrix_of(difference, matrix)
    eigen3(matrix, values, vectors)
    wide = 0 if values[1] >= 0.0 else 2  # -B has the same cone
    high, middle, low = abs(values[wide]), abs(values[1]), -abs(values[2 - wide])
    if not (values[0] > 0.0 and values[2] < 0.0):
        return 0
    curves[:, :, :] = 0.0
    if middle <= _FLAT * min(high, -low):  # two planes through the middle eigenvector
        ratio = math.sqrt(-low / high)
        for c in range(4):
            combine(vectors, wide, ratio if c < 2 else -ratio, 0.0, 1.0, curves[c, c % 2])
            combine(vectors, wide, 0.0, 1.0, 0.0, curves[c, 1 - c % 2])
        return 4
    x, z = math.sqrt(middle / high), math.sqrt(middle / -low)
    largest = max(1.0, max(x, z))
    x, y, z = x / largest, 1.0 / largest, z / largest
    for c in range(2):
        x = -x
        combine(vectors, wide, x, 0.0, z, curves[c, 0])
        combine(vectors, wide, 0.0, 2.0 * y, 0.0, curves[c, 1])
        combine(vectors, wide, -x, 0.0, z, curves[c, 2])
    return 2


@inner_kernel
def add_candidate(found, members, v, count, floor):
    """Append a direction at which the working set's smallest form reaches ``floor``; return the count."""
    normalise(v)
    _, smallest = smallest_form(found.forms[:members], v)
    if not smallest >= floor or count >= _MAX_CANDIDATES:
        return count
    copy_into(v, found.directions[count])
    found.values[count] = smallest
    return count + 1


@inner_kernel
def add_roots(found, members, poly, degree, curve, count, floor):
    """Append the points of a curve at which a polynomial of its parameter is zero; return the count."""
    roots, v = scratch(12), scratch(3)
    for root in range(real_roots(poly, degree, roots)):
        s = roots[root]
        for d in range(3):
            v[d] = curve[0, d] + s * (curve[1, d] + s * curve[2, d])
        count = add_candidate(found, members, v, count, floor)
    return count


@inner_kernel
def add_pair(found, members, i, j, count, floor):
    """Append the candidates on which forms i and j of the working set are equal; return the count."""
    forms = found.forms
    difference, curves, poly = scratch(6), scratch(4, 3, 3), scratch(9)
    q, n = scratch(5), scratch(5)
    for m in range(6):
        difference[m] = forms[i, m] - forms[j, m]
    for c in range(equal_cone(difference, curves)):
        curve = curves[c]
        quartic(forms[i], curve, q)
        quartic(_IDENTITY, curve, n)
        poly[:] = 0.0
        for a in range(5):  # q' n - q n', in which the seventh power cancels
            for b in range(5):
                if 0 < a + b < 8:
                    poly[a + b - 1] += (a - b) * q[a] * n[b]
        count = add_roots(found, members, poly, np.int64(6), curve, count, floor)
        for m in range(members):
            if m not in (i, j):
                for d in range(6):
                    difference[d] = forms[m, d] - forms[i, d]
                quartic(difference, curve, poly)
                count = add_roots(found, members, poly, np.int64(4), curve, count, floor)
    return count


@inner_kernel
def add_single(found, members, i, count, floor):
    """Append the top eigenvector of form i of the working set; return the count."""
    matrix, values, vectors, v = scratch(3, 3), scratch(3), scratch(3, 3), scratch(3)
    matrix_of(found.forms[i], matrix)
    eigen3(matrix, values, vectors)
    copy_into(vectors[:, 0], v)
    return add_candidate(found, members, v, count, floor)


@heap_kernel
def best_axis_of_forms(forms, axis):
    """Fill the unit vector that maximises the smallest of the forms; return that value.

    Args:
        forms: (m, 6), symmetric matrices as (xx, yy, zz, xy, xz, yz).
        axis: output, (3,).
    """
    found = Candidates(forms.copy(), np.empty((_MAX_CANDIDATES, 3)), np.empty(_MAX_CANDIDATES))
    new, lowest = 0, math.inf
    for k in range(forms.shape[0]):
        top, _ = largest_eigenvalue(forms[k])
        if top < lowest:
            new, lowest = k, top
    best, tolerance = -math.inf, 1e-14 * abs(lowest)
    count, members = np.int64(0), 0
    while new >= members:
        for m in range(6):  # the working set stands first
            found.forms[members, m], found.forms[new, m] = found.forms[new, m], found.forms[members, m]
        for c in range(count):
            found.values[c] = min(found.values[c], form_value(found.forms, members, found.directions[c]))
        members += 1
        floor = best - tolerance
        count = add_single(found, members, members - 1, count, floor)
        for i in range(members - 1):  # old pairs meet the new form on the curves traced here
            count = add_pair(found, members, i, members - 1, count, floor)
        if count == 0:
            break
        lead = np.argmax(found.values[:count])
        new, smallest = smallest_form(found.forms, found.directions[lead])
        if smallest > best:
            best = smallest
            copy_into(found.directions[lead], axis)
        if smallest >= found.values[lead] - tolerance:
            break
    return best


@heap_kernel
def best_axis(family, p, axis):
    """Fill the unit axis that maximises the smallest ratio at position p; return the log of that ratio.

    Exact up to rounding with one denominator; with several, Dinkelbach's iteration over exact steps.
    """
    ratios, groups = family.numerator_isotropic.shape[0], family.denominator_isotropic.shape[0]
    numerators, denominators, forms = np.empty((ratios, 6)), np.empty((groups, 6)), np.empty((ratios, 6))
    fill_forms(family, p, numerators, denominators)
    v, logs, f = zeroed(3), np.empty(groups), np.empty(ratios)
    v[2] = 1.0
    if groups == 1:
        back = scratch(3, 3)
        inverse_factor(denominators[0], back)
        for k in range(ratios):
            congruence(numerators[k], back, forms[k])
        best_axis_of_forms(forms, v)
        store(unit((dot(back[0], v), dot(back[1], v), dot(back[2], v))), axis)
        return log_objective(family, p, axis, logs, f)
    copy_into(v, axis)
    best = log_objective(family, p, axis, logs, f)
    for _ in range(_DINKELBACH_STEPS):
        for k in range(ratios):
            # without the divisor the iteration is only linear
            below = denominators[family.denominator_of[k]]
            for m in range(6):
                forms[k, m] = (numerators[k, m] - math.exp(best) * below[m]) / bilinear(below, axis, axis)
        best_axis_of_forms(forms, v)
        value = log_objective(family, p, v, logs, f)
        if not value > best + 1e-15 * abs(best):
            break
        best = value
        copy_into(v, axis)
    return best
