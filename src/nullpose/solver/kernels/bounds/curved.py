"""The test that excludes a box under an affine axis field: a weighted sum that stays negative all over it.

With the axis given by the position, ``G(p) = sum_k lambda_k (N_k(p) - t D(p))`` is a number. Over a box of
half sides h, ``G <= f + g.x + x^T H x / 2`` with ``|x_i| <= 1`` and every Hessian within bounds. For any
``mu >= 0`` that makes ``A = diag(mu) - H`` positive definite, ``f + sum(mu) / 2 + g^T A^-1 g / 2`` is an
upper bound, since ``mu_i (1 - x_i^2) >= 0``: concave directions count in our favour, so that boxes do not
cluster around a smooth optimum.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.borders import borders, weigh_borders
from nullpose.solver.kernels.bounds.constants import ROUNDING
from nullpose.solver.kernels.bounds.enclosure import BEND, JET, LEAST, MOST, RADIUS, SLOPE, link_jet
from nullpose.solver.kernels.bounds.node import BALL, CENTRE, COUNT, HALF, LEVEL, NU, keep_largest
from nullpose.solver.kernels.bounds.signed_sum import fill_sum
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch, scratch_int, zeroed
from nullpose.solver.kernels.linear_algebra.symmetric import add_scaled, copy_into, eigen3, entry
from nullpose.solver.kernels.search.zones import MOST_ALTERNATIVES

_SHARES = 5  # sizes of mu that are tried along concave directions
_LESS = 0.25
_MOST_SIDES = 4  # of a box over which linear functions are mixed
_PASSES = 3  # over all of them


@inner_kernel
def add_jet(weight, jet, total):
    """Add a weighted jet to another; radii add up whatever the sign."""
    add_scaled(weight, jet[:RADIUS], total[:RADIUS])
    add_scaled(abs(weight), jet[RADIUS:LEAST], total[RADIUS:LEAST])
    total[LEAST] += weight * (jet[LEAST] if weight > 0.0 else jet[MOST])
    total[MOST] += weight * (jet[MOST] if weight > 0.0 else jet[LEAST])


@inner_kernel
def fill_jet(family, j, is_above, axis_field, row, workspace):
    """Fill the jet of link j over a row's box, unless the box's is there."""
    side = 1.0 if is_above else -1.0
    if workspace.expanded_side[j] != side:
        link_jet(family, j, is_above, axis_field, row[CENTRE:HALF], row[HALF:LEVEL], workspace.jets[j])
        workspace.expanded_side[j] = side


@inner_kernel
def scaled_bound(jet, half, gradient, hessian):
    """Fill gradient and Hessian in units of the half sides; return the value and the radii's part."""
    rest = 0.0
    for i in range(3):
        gradient[i] = jet[SLOPE + i] * half[i]
        hessian[i, i] = jet[BEND + i] * half[i] * half[i]
        rest += 0.5 * jet[RADIUS + i] * half[i] * half[i]
    for e in range(3, 6):
        i, k = entry(e)
        hessian[i, k] = hessian[k, i] = jet[BEND + e] * half[i] * half[k]
        rest += jet[RADIUS + e] * half[i] * half[k]
    return jet[0] + rest


@inner_kernel
def dual_bound(base, gradient, hessian, mu):
    """Return ``base + sum(mu) / 2 + g^T (diag(mu) - H)^-1 g / 2``, infinity if that is not definite."""
    a, b, c = mu[0] - hessian[0, 0], mu[1] - hessian[1, 1], mu[2] - hessian[2, 2]
    d, e, f = -hessian[0, 1], -hessian[0, 2], -hessian[1, 2]
    minor = a * b - d * d
    det = c * minor - a * f * f - b * e * e + 2.0 * d * e * f
    if not (a > 0.0 and minor > 1e-13 * a * b and det > 1e-13 * a * b * c):
        return math.inf
    x, y, z = gradient[0], gradient[1], gradient[2]
    form = x * x * (b * c - f * f) + y * y * (a * c - e * e) + z * z * minor
    form += 2.0 * (x * y * (e * f - d * c) + x * z * (d * f - b * e) + y * z * (d * e - a * f))
    return base + 0.5 * (mu[0] + mu[1] + mu[2]) + 0.5 * form / det


@kernel
def box_maximum(jet, half):
    """Return an upper bound on a jet over its box."""
    gradient, hessian, mu = scratch(3), scratch(3, 3), scratch(3)
    base = scaled_bound(jet, half, gradient, hessian)
    if not base < 0.0:  # not even at the centre
        return base
    tiny = -1e-6 * base  # keeps the matrix definite where nothing bends
    # diagonally dominant: cheap, and enough for most boxes
    for i in range(3):
        lean = hessian[i, i]
        for k in range(3):
            lean += abs(hessian[i, k]) if k != i else 0.0
        mu[i] = abs(gradient[i]) + max(0.0, lean) + tiny
    bound = dual_bound(base, gradient, hessian, mu)
    if bound < 0.0:
        return bound
    # the convex part of the Hessian is paid for in full, the concave part kept
    values, vectors = scratch(3), scratch(3, 3)
    eigen3(hessian, values, vectors)
    convex = zeroed(3)
    for i in range(3):
        for k in range(3):
            part = 0.0
            for m in range(3):
                part += max(0.0, values[m]) * vectors[i, m] * vectors[k, m]
            convex[i] += abs(part)
    share = 1.0  # along concave directions a smaller mu is better, how small depends on the slope
    for _ in range(_SHARES):
        for i in range(3):
            mu[i] = share * abs(gradient[i]) + convex[i] + tiny
        bound = min(bound, dual_bound(base, gradient, hessian, mu))
        if bound < 0.0:
            break
        share *= _LESS
    return bound


@inner_kernel
def excludes_curved(family, domain, axis_field, row, workspace, total):
    """Check whether the row's multipliers exclude its box; fill its border's, and the jet of their sum."""
    if not (row[COUNT] > 0.0 or family.shares.shape[0] > 0):
        return False
    total[:], sums = 0.0, workspace.sums
    identity, size = fill_sum(family, row, sums)
    for j in range(sums.shape[0]):
        if sums[j] != 0.0:
            fill_jet(family, j, sums[j] > 0.0, axis_field, row, workspace)
            add_jet(sums[j], workspace.jets[j], total)
            size += abs(sums[j]) * workspace.jets[j, 0]  # to which rounding is relative
    identity += ROUNDING * size
    total[0], total[MOST] = total[0] + identity, total[MOST] + identity
    row[NU] = 0.0
    # plain bounds on every part are often enough, and cost nothing more
    if total[MOST] < 0.0 or box_maximum(total, row[HALF:LEVEL]) < 0.0:
        return True
    return row[BALL] >= 0.0 and excludes_allowed(domain, row, total)


@inner_kernel
def excludes_allowed(domain, row, total):
    """Check whether a jet is negative wherever a border allows positions; fill its multiplier."""
    sides, counts = scratch(MOST_ALTERNATIVES, 2, 5), scratch_int(MOST_ALTERNATIVES)
    alternatives = borders(domain, row, sides, counts)
    bent, border = scratch(JET), scratch(7)
    for a in range(alternatives):
        row[NU] = weigh_borders(sides[a], counts[a], row, total[1:4], border)
        if row[NU] < 0.0:
            return False
        copy_into(total, bent)
        for m in range(7):  # a jet begins with the same numbers
            bent[m] += border[m]
        if not box_maximum(bent, row[HALF:LEVEL]) < 0.0:
            return False
    if alternatives > 0 and int(row[BALL]) >= domain.keep_out_points_m.shape[0]:
        row[NU] = 1.0  # a zone's multipliers are found again by the verifier
    return alternatives > 0


@inner_kernel
def impact(total, half):
    """Return the side whose halving lowers the bound of a sum most."""
    side = 0
    most = -1.0
    for i in range(3):
        change = abs(total[SLOPE + i]) * half[i] + (abs(total[BEND + i]) + total[RADIUS + i]) * half[i] ** 2
        for e in range(3, 6):
            j, k = entry(e)
            if i in (j, k):
                change += (abs(total[BEND + e]) + total[RADIUS + e]) * half[j] * half[k]
        if change > most:
            side, most = i, change
    return side


@inner_kernel
def linear_bound(value, slopes, half):
    """Return the largest value of a linear function over a box of any number of sides."""
    for i in range(half.shape[0]):
        value += half[i] * abs(slopes[i])
    return value


@inner_kernel
def curved_multipliers(family, axis_field, row, workspace):
    """Fill new multipliers into the row: the least upper bound of a mix of linear functions.

    Starts from the best single ratio and mixes in one ratio at a time by an exact line search; returns the
    smallest ratio at the centre relative to the level.
    """
    ratios, half, level = family.numerator_weight.shape[0], row[HALF:LEVEL], row[LEVEL]
    weights, values, gradients = workspace.weights, workspace.values, workspace.gradients
    smallest, total = math.inf, scratch(JET)
    for k in range(ratios):
        g = family.denominator_of[k]
        total[:] = 0.0
        total[0] = -level * family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            j = family.denominator_point[e]
            fill_jet(family, j, False, axis_field, row, workspace)
            add_jet(-level * family.denominator_weight[e], workspace.jets[j], total)
        below, total[0] = -total[0] / level, total[0] + family.numerator_isotropic[k]
        j = family.numerator_point[k]
        fill_jet(family, j, True, axis_field, row, workspace)
        add_jet(family.numerator_weight[k], workspace.jets[j], total)
        values[k], smallest = total[0], min(smallest, total[0] / below / level + 1.0)
        for i in range(3):
            gradients[k, i] = total[SLOPE + i]
        for e in range(6):
            i, j = entry(e)
            radius = total[RADIUS + e]
            if i == j:  # concave along a side counts for nothing here: the mix is of linear functions
                radius = max(0.0, radius + total[BEND + e])
            values[k] += (0.5 if i == j else 1.0) * radius * half[i] * half[j]
    mix_in(values, gradients, half, weights[:ratios])
    keep_largest(weights, ratios, row, False)
    return smallest


@inner_kernel
def mix_in(values, gradients, half, weights):
    """Fill the weights of a mix of linear functions that is low over a box; return its largest value there.

    Begins with the one that is lowest, and mixes in one at a time by exact line searches.
    """
    lead, bound = 0, math.inf
    for k in range(values.shape[0]):
        weights[k] = 0.0
        candidate = linear_bound(values[k], gradients[k], half)
        if candidate < bound:
            lead, bound = k, candidate
    weights[lead] = 1.0
    value, gradient, trial = values[lead], scratch(_MOST_SIDES), scratch(_MOST_SIDES)
    sides = half.shape[0]
    copy_into(gradients[lead], gradient)
    for _ in range(_PASSES):
        before = bound
        for k in range(values.shape[0]):
            best_share = 0.0
            for i in range(sides + 1):  # the bound is piecewise linear in the share: its kinks, and the end
                share = 1.0
                if i < sides:
                    change = gradients[k, i] - gradient[i]
                    share = -gradient[i] / change if change != 0.0 else -1.0
                if not 0.0 < share <= 1.0:
                    continue
                for m in range(sides):
                    trial[m] = gradient[m] + share * (gradients[k, m] - gradient[m])
                candidate = linear_bound(value + share * (values[k] - value), trial, half)
                if candidate < bound:
                    bound, best_share = candidate, share
            if best_share > 0.0:
                for m in range(values.shape[0]):
                    weights[m] *= 1.0 - best_share
                weights[k] += best_share
                value += best_share * (values[k] - value)
                for m in range(sides):
                    gradient[m] += best_share * (gradients[k, m] - gradient[m])
        if bound < 0.0 or bound >= before:
            break
    return bound
