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

import numpy as np

from nullpose.solve.kernels.forms import bilinear, fill_forms, form_value
from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel, inner_kernel
from nullpose.solve.kernels.links import min_log_ratio
from nullpose.solve.kernels.polynomial import real_roots
from nullpose.solve.kernels.scratch import scratch, zeroed
from nullpose.solve.kernels.symmetric import eigen3

__all__ = ["best_axis", "best_axis_of_forms"]

_SPREAD = 24
_MAX_CANDIDATES = 4000
_FLAT = 1e-10


@inner_kernel
def quartic(a, curve, out):
    """Fill the coefficients of ``v(s)^T A v(s)`` for ``v(s) = c0 + c1 s + c2 s^2``."""
    out[0] = bilinear(a, curve[0], curve[0])
    out[1] = 2.0 * bilinear(a, curve[0], curve[1])
    out[2] = 2.0 * bilinear(a, curve[0], curve[2]) + bilinear(a, curve[1], curve[1])
    out[3] = 2.0 * bilinear(a, curve[1], curve[2])
    out[4] = bilinear(a, curve[2], curve[2])


@inner_kernel
def equal_cone(difference, curves):
    """Fill the curves, each (3, 3), whose traces over s in [-1, 1] cover ``v^T B v = 0``; return how many."""
    matrix = scratch(3, 3)
    matrix[0, 0], matrix[1, 1], matrix[2, 2] = difference[0], difference[1], difference[2]
    matrix[0, 1] = matrix[1, 0] = difference[3]
    matrix[0, 2] = matrix[2, 0] = difference[4]
    matrix[1, 2] = matrix[2, 1] = difference[5]
    values = scratch(3)
    vectors = scratch(3, 3)
    eigen3(matrix, values, vectors)
    high, middle, low = values[0], values[1], values[2]
    if middle >= 0.0:
        wide, narrow, lone = 0, 1, 2
    else:  # turn B into -B, which has the same cone
        high, middle, low = -values[2], -values[1], -values[0]
        wide, narrow, lone = 2, 1, 0
    if not (high > 0.0 and low < 0.0):
        return 0
    curves[:, :, :] = 0.0
    if middle <= _FLAT * min(high, -low):  # two planes through the middle eigenvector
        ratio = math.sqrt(-low / high)
        for plane in range(2):
            sign = 1.0 if plane == 0 else -1.0
            for i in range(3):
                across = vectors[i, lone] + sign * ratio * vectors[i, wide]
                along = vectors[i, narrow]
                curves[2 * plane, 0, i] = across
                curves[2 * plane, 1, i] = along
                curves[2 * plane + 1, 0, i] = along
                curves[2 * plane + 1, 1, i] = across
        return 4
    x = math.sqrt(middle / high)
    z = math.sqrt(middle / -low)
    largest = max(1.0, max(x, z))
    x, y, z = x / largest, 1.0 / largest, z / largest
    for half in range(2):
        sign = 1.0 if half == 0 else -1.0
        for i in range(3):
            curves[half, 0, i] = sign * x * vectors[i, wide] + z * vectors[i, lone]
            curves[half, 1, i] = 2.0 * y * vectors[i, narrow]
            curves[half, 2, i] = -sign * x * vectors[i, wide] + z * vectors[i, lone]
    return 2


@inner_kernel
def add_candidate(v, forms, working, members, candidates, values, count, floor):
    """Append a direction whose smallest form over the working set exceeds ``floor``; return the new count."""
    norm = math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    if not norm > 0.0:
        return count
    for i in range(3):
        v[i] /= norm
    smallest = math.inf
    for m in range(members):
        smallest = min(smallest, form_value(forms, working[m], v))
    if smallest < floor or count >= _MAX_CANDIDATES:
        return count
    for i in range(3):
        candidates[count, i] = v[i]
    values[count] = smallest
    return count + 1


@inner_heap_kernel
def add_pair(forms, working, members, i, j, candidates, values, count, floor):
    """Append the candidates on which forms i and j of the working set are equal."""
    difference = forms[working[i]] - forms[working[j]]
    identity = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    curves = scratch(4, 3, 3)
    q = scratch(5)
    n = scratch(5)
    poly = scratch(9)
    roots = scratch(12)
    v = scratch(3)
    for c in range(equal_cone(difference, curves)):
        curve = curves[c]
        quartic(forms[working[i]], curve, q)
        quartic(identity, curve, n)
        for k in range(9):
            poly[k] = 0.0
        for a in range(5):
            for b in range(5):
                if a + b >= 1 and a + b - 1 < 7:
                    poly[a + b - 1] += (a - b) * q[a] * n[b]
        for root in range(real_roots(poly, np.int64(6), roots)):
            s = roots[root]
            for d in range(3):
                v[d] = curve[0, d] + s * (curve[1, d] + s * curve[2, d])
            count = add_candidate(v, forms, working, members, candidates, values, count, floor)
        for m in range(members):
            if m in (i, j):
                continue
            quartic(forms[working[m]] - forms[working[i]], curve, poly)
            for root in range(real_roots(poly, np.int64(4), roots)):
                s = roots[root]
                for d in range(3):
                    v[d] = curve[0, d] + s * (curve[1, d] + s * curve[2, d])
                count = add_candidate(v, forms, working, members, candidates, values, count, floor)
    return count


@inner_heap_kernel
def add_single(forms, working, members, i, candidates, values, count, floor):
    """Append the top eigenvector of form i of the working set."""
    a = forms[working[i]]
    matrix = np.array([[a[0], a[3], a[4]], [a[3], a[1], a[5]], [a[4], a[5], a[2]]])
    w = scratch(3)
    vectors = scratch(3, 3)
    eigen3(matrix, w, vectors)
    return add_candidate(vectors[:, 0].copy(), forms, working, members, candidates, values, count, floor)


@inner_kernel
def largest_eigenvalue(a):
    """Return the largest eigenvalue of a form kept as six numbers (closed form; a guide, not a bound)."""
    mean = (a[0] + a[1] + a[2]) / 3.0
    off = a[3] * a[3] + a[4] * a[4] + a[5] * a[5]
    x, y, z = a[0] - mean, a[1] - mean, a[2] - mean
    spread = math.sqrt((x * x + y * y + z * z + 2.0 * off) / 6.0)
    if spread == 0.0:
        return mean
    det = x * (y * z - a[5] * a[5]) - a[3] * (a[3] * z - a[5] * a[4]) + a[4] * (a[3] * a[5] - y * a[4])
    half = max(-1.0, min(1.0, det / (2.0 * spread**3)))
    return mean + 2.0 * spread * math.cos(math.acos(half) / 3.0)


@inner_kernel
def spread_axis(forms, axis):
    """Fill the best of some directions spread evenly over a hemisphere; return its smallest form."""
    best = -math.inf
    v = scratch(3)
    for i in range(_SPREAD):
        v[2] = (i + 0.5) / _SPREAD
        across = math.sqrt(1.0 - v[2] * v[2])
        turn = 2.399963229728653 * i  # golden angle, rad
        v[0], v[1] = across * math.cos(turn), across * math.sin(turn)
        smallest = math.inf
        for k in range(forms.shape[0]):
            smallest = min(smallest, form_value(forms, k, v))
            if smallest <= best:
                break
        if smallest > best:
            best = smallest
            for d in range(3):
                axis[d] = v[d]
    return best


@heap_kernel
def best_axis_of_forms(forms, axis):
    """Fill the unit vector that maximises the smallest of the forms; return that value.

    Args:
        forms: (m, 6), symmetric matrices as (xx, yy, zz, xy, xz, yz).
        axis: output, (3,).
    """
    total = forms.shape[0]
    working = np.empty(total, np.int64)
    candidates = np.empty((_MAX_CANDIDATES, 3))
    values = np.empty(_MAX_CANDIDATES)
    worst = 0
    lowest = math.inf
    for k in range(total):
        top = largest_eigenvalue(forms[k])
        if top < lowest:
            lowest, worst = top, k
    best = spread_axis(forms, axis)  # a first level prunes most candidates of the early working sets
    tolerance = 1e-14 * abs(lowest)
    count = np.int64(0)
    members = 0
    new = worst
    while members < total:
        working[members] = new
        members += 1
        kept = 0
        for c in range(count):
            value = min(values[c], form_value(forms, new, candidates[c]))
            if value >= best - tolerance:
                for d in range(3):
                    candidates[kept, d] = candidates[c, d]
                values[kept] = value
                kept += 1
        count = kept
        floor = best - tolerance
        count = add_single(forms, working, members, members - 1, candidates, values, count, floor)
        for i in range(members - 1):  # old pairs meet the new form on the curves traced here
            count = add_pair(forms, working, members, i, members - 1, candidates, values, count, floor)
        if count == 0:
            break
        lead = 0
        for c in range(1, count):
            if values[c] > values[lead]:
                lead = c
        smallest = math.inf
        new = -1
        for k in range(total):
            value = form_value(forms, k, candidates[lead])
            if value < smallest:
                smallest, new = value, k
        if smallest > best:
            best = smallest
            for d in range(3):
                axis[d] = candidates[lead, d]
        if smallest >= values[lead] - tolerance:
            break
        inside = False
        for m in range(members):
            inside = inside or working[m] == new
        if inside:
            break
    return best


@inner_heap_kernel
def whiten(forms, denominator, back, out):
    """Fill ``B A_k B`` with ``B = D^(-1/2)`` kept in ``back``, so that ratios become plain forms."""
    d = denominator
    matrix = np.array([[d[0], d[3], d[4]], [d[3], d[1], d[5]], [d[4], d[5], d[2]]])
    w = scratch(3)
    vectors = scratch(3, 3)
    eigen3(matrix, w, vectors)
    # the smallest eigenvalues of a denominator lie near its isotropic part, far below the largest
    back[:, :] = 0.0
    for m in range(3):
        root = 1.0 / math.sqrt(w[m])
        for i in range(3):
            for j in range(3):
                back[i, j] += root * vectors[i, m] * vectors[j, m]
    for k in range(forms.shape[0]):
        a = forms[k]
        for m in range(6):
            i = m if m < 3 else (0 if m < 5 else 1)
            j = m if m < 3 else (1 if m == 3 else 2)
            out[k, m] = bilinear(a, back[i], back[j])


@heap_kernel
def best_axis(family, p, axis):
    """Fill the unit axis that maximises the smallest ratio at position p; return the log of that ratio.

    Exact up to rounding with one denominator; with several, Dinkelbach's iteration over exact steps.
    """
    ratios = family.numerator_isotropic.shape[0]
    groups = family.denominator_isotropic.shape[0]
    numerators = np.empty((ratios, 6))
    denominators = np.empty((groups, 6))
    fill_forms(family, p, numerators, denominators)
    forms = np.empty((ratios, 6))
    v = zeroed(3)
    v[2] = 1.0
    logs = np.empty(groups)
    f = np.empty(ratios)
    if groups == 1:
        back = scratch(3, 3)
        whiten(numerators, denominators[0], back, forms)
        best_axis_of_forms(forms, v)
        for i in range(3):
            axis[i] = back[i, 0] * v[0] + back[i, 1] * v[1] + back[i, 2] * v[2]
        norm = math.sqrt(axis[0] ** 2 + axis[1] ** 2 + axis[2] ** 2)
        for i in range(3):
            axis[i] /= norm
        return min_log_ratio(family, p, axis, logs, f)
    for i in range(3):
        axis[i] = v[i]
    best = min_log_ratio(family, p, axis, logs, f)
    for _ in range(60):
        level = math.exp(best)
        for k in range(ratios):
            # without the divisor the iteration is only linear
            below = form_value(denominators, family.denominator_of[k], axis)
            for m in range(6):
                forms[k, m] = (numerators[k, m] - level * denominators[family.denominator_of[k], m]) / below
        best_axis_of_forms(forms, v)
        value = min_log_ratio(family, p, v, logs, f)
        if not value > best + 1e-15 * abs(best):
            break
        best = value
        for i in range(3):
            axis[i] = v[i]
    return best
