"""Maximum gain for any number of nodes: the axis is chosen for the nodes alone, the position for the SINR.

The axis maximises the smallest numerator; where a whole arc of axes does (one far node decides, and hears
the drone
broadside along a circle), the one that receives least jamming is taken. The paper defines the case for two
nodes.
"""

from __future__ import annotations

import math

import numpy as np

from nullpose.solve.kernels.axis import best_axis_of_forms
from nullpose.solve.kernels.forms import bilinear, fill_forms, form_value
from nullpose.solve.kernels.jit import heap_kernel, inner_heap_kernel
from nullpose.solve.kernels.links import min_log_ratio
from nullpose.solve.kernels.scratch import scratch
from nullpose.solve.kernels.symmetric import tangents

__all__ = ["maximum_gain_value"]

_TIE = 1e-11


@inner_heap_kernel
def quietest_on_circle(numerators, worst, level, denominator, normal, axis):
    """Fill the quietest axis across ``normal`` among those whose forms all reach ``level``."""
    a, b, v = scratch(3), scratch(3), scratch(3)
    tangents(normal, a, b)
    ratios = numerators.shape[0]
    angles = np.empty(2 * ratios + 2)
    d_aa, d_ab, d_bb = (
        bilinear(denominator, a, a),
        bilinear(denominator, a, b),
        bilinear(denominator, b, b),
    )
    angles[0] = 0.5 * math.atan2(2.0 * d_ab, d_aa - d_bb) + 0.5 * math.pi
    angles[1] = angles[0] + 0.5 * math.pi
    count = 2
    for k in range(ratios):
        if k == worst:
            continue
        mean = 0.5 * (bilinear(numerators[k], a, a) + bilinear(numerators[k], b, b)) - level
        x = 0.5 * (bilinear(numerators[k], a, a) - bilinear(numerators[k], b, b))
        y = bilinear(numerators[k], a, b)
        swing = math.hypot(x, y)
        if swing > abs(mean):
            turn = math.acos(-mean / swing)
            angles[count] = 0.5 * (math.atan2(y, x) + turn)
            angles[count + 1] = 0.5 * (math.atan2(y, x) - turn)
            count += 2
    quietest = math.inf
    for m in range(count):
        c, s = math.cos(angles[m]), math.sin(angles[m])
        for i in range(3):
            v[i] = c * a[i] + s * b[i]
        allowed = True
        for k in range(ratios):
            allowed = allowed and form_value(numerators, k, v) >= level * (1.0 - _TIE)
        if allowed:
            jamming = bilinear(denominator, v, v)
            if jamming < quietest:
                quietest = jamming
                for i in range(3):
                    axis[i] = v[i]


@heap_kernel
def maximum_gain_value(family, p, axis):
    """Fill the maximum-gain axis at a position; return the smallest log ratio (shared denominator)."""
    ratios = family.numerator_isotropic.shape[0]
    numerators = np.empty((ratios, 6))
    denominators = np.empty((family.denominator_isotropic.shape[0], 6))
    fill_forms(family, p, numerators, denominators)
    level = best_axis_of_forms(numerators, axis)
    worst = -1
    for k in range(ratios):
        r = family.points_m[family.numerator_point[k]] - p
        reach = family.numerator_weight[k] / (r[0] ** 2 + r[1] ** 2 + r[2] ** 2)
        if level >= reach * (1.0 - _TIE):
            worst = k
    if worst >= 0:
        r = family.points_m[family.numerator_point[worst]] - p
        r /= math.sqrt(r[0] ** 2 + r[1] ** 2 + r[2] ** 2)
        quietest_on_circle(numerators, worst, level, denominators[0], r, axis)
    logs = np.empty(family.denominator_isotropic.shape[0])
    f = np.empty(ratios)
    return min_log_ratio(family, p, axis, logs, f)
