"""Maximum gain for any number of nodes: the axis is chosen for the nodes alone, the position for the SINR.

The axis maximises the smallest numerator; where a whole arc of axes does (one far node decides, and hears the
drone broadside along a circle), the one that receives least jamming is taken. The paper defines the case for
two nodes.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solver.kernels.compiler.jit import heap_kernel, inner_heap_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.axis import best_axis_of_forms
from nullpose.solver.kernels.linear_algebra.channel import excess_at
from nullpose.solver.kernels.linear_algebra.forms import bilinear, fill_forms, smallest_form
from nullpose.solver.kernels.linear_algebra.links import log_objective
from nullpose.solver.kernels.linear_algebra.symmetric import copy_into, normalise, squared_distance, tangents

_TIE = 1e-11


@inner_heap_kernel
def quietest_on_circle(numerators, worst, level, denominator, normal, axis):
    """Fill the quietest axis across ``normal`` among those whose forms all reach ``level``."""
    a, b, v = scratch(3), scratch(3), scratch(3)
    tangents(normal, a, b)
    angles = np.empty(2 * numerators.shape[0] + 2)
    count, quietest = 0, math.inf
    for k in range(-1, numerators.shape[0]):  # where jamming is least, and where a form meets the level
        form = denominator if k < 0 else numerators[k]
        aa, ab, bb = bilinear(form, a, a), bilinear(form, a, b), bilinear(form, b, b)
        mean, half = 0.5 * (aa + bb) - level, 0.5 * (aa - bb)
        swing = math.hypot(ab, half)
        if k < 0 or (k != worst and swing > abs(mean)):
            lead, apart = math.atan2(ab, half), math.pi if k < 0 else math.acos(-mean / swing)
            angles[count], angles[count + 1] = 0.5 * (lead + apart), 0.5 * (lead - apart)
            count += 2
    for angle in angles[:count]:
        for i in range(3):
            v[i] = math.cos(angle) * a[i] + math.sin(angle) * b[i]
        jamming = bilinear(denominator, v, v)
        if jamming < quietest and smallest_form(numerators, v)[1] >= level * (1.0 - _TIE):
            quietest = jamming
            copy_into(v, axis)


@heap_kernel
def maximum_gain_value(family, p, axis):
    """Fill the maximum-gain axis at a position; return the smallest log ratio (shared denominator)."""
    ratios, groups = family.numerator_isotropic.shape[0], family.denominator_isotropic.shape[0]
    numerators, denominators, normal = np.empty((ratios, 6)), np.empty((groups, 6)), scratch(3)
    fill_forms(family, p, numerators, denominators)
    level = best_axis_of_forms(numerators, axis)
    worst = -1
    for k in range(ratios):
        point = family.points_m[family.numerator_point[k]]
        excess = excess_at(family, family.numerator_point[k], p)
        if level >= excess * family.numerator_weight[k] / squared_distance(point, p) * (1.0 - _TIE):
            worst = k
    if worst >= 0:
        point = family.points_m[family.numerator_point[worst]]
        for i in range(3):
            normal[i] = point[i] - p[i]
        normalise(normal)
        quietest_on_circle(numerators, worst, level, denominators[0], normal, axis)
    return log_objective(family, p, axis, np.empty(groups), np.empty(ratios))
