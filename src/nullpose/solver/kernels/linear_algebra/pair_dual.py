"""Multipliers of pairs: those that make a sum of tangents as negative as they can.

``max over U psd, tr U = 1, of min_q phi_q(<E_q, U>) - <B_q, U>`` is concave in U. Its tangents at a form are
linear, so that :mod:`nullpose.solver.kernels.linear_algebra.dual` has their best form and multipliers; the
next tangents are taken on the way there. All tangents and multipliers give a valid bound.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.dual import dual_multipliers
from nullpose.solver.kernels.linear_algebra.links import pair_tangent
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into, form_product

_TOUCHES = 6
_HALVINGS = 10
_GAINED = 0.1  # of what a tangent promises, or the step is halved (Armijo)


@inner_kernel
def touch_pairs(family, level, groups, matrix, forms):
    """Fill the forms of the pairs' tangents at a matrix; return the smallest there.

    Args:
        family: with its pairs.
        level: the quotient that is of interest, 1 or more.
        groups: (groups, 6) the denominators.
        matrix: (6,) of unit trace.
        forms: output, (pairs, 6).
    """
    smallest = math.inf
    for q in range(family.pairs.shape[0]):
        heard = groups[family.denominator_of[family.pairs[q, 0]]]
        jammed = groups[family.denominator_of[family.pairs[q, 1]]]
        constant, slope = pair_tangent(family, q, level, form_product(jammed, matrix))
        for m in range(6):
            forms[q, m] = slope * jammed[m] - heard[m] + (constant if m < 3 else 0.0)
        smallest = min(smallest, form_product(forms[q], matrix))
    return smallest


@heap_kernel
def pair_multipliers(family, level, groups, forms, sides, gap, start, multipliers, matrix):
    """Fill the multipliers of pairs, which sum to one, and of the ``sides`` constraints before them.

    Args:
        family: with its pairs, of denominators with a noise of 1.
        level: the quotient that is of interest, 1 or more.
        groups: (groups, 6) the denominators.
        forms: (sides + pairs, 6), constraints ``<Q, U> >= 0``, and room.
        sides: how many those are.
        gap: accuracy, in units of the noise.
        start: (6,) positive definite matrix of unit trace that meets the constraints strictly.
        multipliers: output, (sides + pairs,).
        matrix: output, (6,): where the tangents touch.
    """
    best, mixed = scratch(6), scratch(6)
    copy_into(start, matrix)
    value = touch_pairs(family, level, groups, matrix, forms[sides:])
    for touch in range(_TOUCHES):
        most = dual_multipliers(
            forms, sides, len(forms), 1.0, math.inf, gap, start, multipliers, best, family.shares, 0.0
        )
        if touch == _TOUCHES - 1 or most - value <= gap:
            break
        share = 1.0
        for _ in range(_HALVINGS):
            for m in range(6):
                mixed[m] = matrix[m] + share * (best[m] - matrix[m])
            reached = touch_pairs(family, level, groups, mixed, forms[sides:])
            if reached >= value + _GAINED * share * (most - value):
                break
            share *= 0.5
        copy_into(mixed, matrix)
        value = reached
