"""The signed sum of links that a leaf's multipliers make, ``sum_k lambda_k (N_k - t D_g(k))``.

Of a mean of R ratios the numbers from R on are requirements: with them ``sum_k nu_k (N_k - r_k D)`` comes on
top, which is not negative where every ratio is its ``r_k`` or more.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullpose.certificate.certificate import Leaves
from nullpose.certificate.elementary import exp, log
from nullpose.certificate.interval import Interval, where
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.family import Family


class Term(NamedTuple):
    """A multiple of the forms of points.

    Args:
        point: (l,) the ground point of each leaf.
        scale: (l,) by what its form is multiplied, not negative: exactly zero where it does not count.
        sign: 1 where the form is added, and so is to be bounded from above, -1 where it is subtracted.
    """

    point: IntArray
    scale: Interval
    sign: float


def mix_slots(leaves: Leaves) -> tuple[IntArray, FloatArray]:
    """Return ratios and their weights for each leaf, (slots, l) each; unused slots have weight zero.

    Args:
        leaves: with their mixes.
    """
    used, which = np.unique(leaves.mix, return_inverse=True)
    mixes = [leaves.mixes[m] if m >= 0 else {} for m in used]
    ratio = np.zeros((max([1, *map(len, mixes)]), len(mixes)), dtype=np.int64)
    weight = np.zeros(ratio.shape)
    for i, mix in enumerate(mixes):
        ratio[: len(mix), i], weight[: len(mix), i] = list(mix), list(mix.values())
    return ratio[:, which], weight[:, which]


def mean_level(family: Family, ratio: IntArray, weight: FloatArray, level: FloatArray) -> Interval:
    """Return by what the denominator is multiplied in the sum of a mean.

    With ``X_k = a + N_k / D`` that is ``prod_k X_k^p_k``. Where it is at least t,
    ``sum_k q_k X_k >= t prod_k (q_k / p_k)^p_k`` for any positive q, as the arithmetic mean of the
    ``q_k X_k / p_k`` is no less than the geometric one. What is returned is the right side less
    ``a sum_k q_k``, or not a number where that may be below zero; zero where there is no q.

    Args:
        family: the ratios.
        ratio: (slots, l) which.
        weight: (slots, l) q.
        level: (l,) t.
    """
    whole = Interval(family.shares).total()  # one, but for rounding: the mean's logarithm over it is a mean
    power, total = log(Interval(level)) / whole, Interval(np.zeros(len(level)))
    for k, share in enumerate(family.shares):
        q, p = np.sum(np.where(ratio == k, weight, 0.0), axis=0), Interval(share) / whole
        power = power + (log(Interval(q)) - log(p)) * p
        total = total + q
    result = exp(power) - total * family.offset
    stands = np.any((ratio < len(family.shares)) & (weight > 0.0), axis=0)
    return where(stands, where(result.low >= 0.0, result, np.nan), 0.0)


def weighted_sum(family: Family, leaves: Leaves) -> tuple[Family, Interval, list[Term]]:
    """Return a sum's multiple of the identity, and its terms.

    A dipole of leak f is two points at one place: ``1 - f`` times the dipole, and f times an isotropic one.
    The family that is returned first has both.

    Args:
        family: the ratios.
        leaves: with multipliers and level.
    """
    ratios = len(family.numerator_point)
    leaks = np.zeros(len(family.points_m))
    leaks[: len(family.ground_leaks)] = family.ground_leaks * (family.ground_leaks < 1.0)
    leaky, twin = np.flatnonzero(leaks), np.cumsum(leaks > 0.0) + len(leaks) - 1

    def parts(point: IntArray, scale: Interval, sign: float) -> list[Term]:
        leak = leaks[point]
        if not np.any(split := (leak > 0.0) & (scale.high > 0.0)):
            return [Term(point, scale, sign)]
        dipole = Term(point, where(split, scale * (1.0 - Interval(leak)), scale), sign)
        leaking = where(split, scale * leak, 0.0)
        return [dipole, Term(np.where(split, twin[point], point), leaking, sign)]

    number, weight = mix_slots(leaves)
    ratio, is_required = number % ratios, number >= ratios
    identity = Interval(np.zeros(len(leaves)))
    terms: list[Term] = []
    for k, w in zip(ratio, weight, strict=True):
        identity = identity + Interval(w) * family.numerator_isotropic[k]
        scale = Interval(w) * family.numerator_weight[k]
        terms += parts(family.numerator_point[k], where(w > 0.0, scale, 0.0), 1.0)
    for g, isotropic in enumerate(family.denominator_isotropic):
        mine = np.where(family.denominator_of[ratio] == g, weight, 0.0)
        counts = np.any(mine > 0.0, axis=0)
        level = Interval(mine).total() * leaves.level
        if len(family.shares):
            least = np.append(family.requirements, 0.0)[np.where(is_required, ratio, -1)]
            level = mean_level(family, number, weight, leaves.level) + (Interval(weight) * least).total()
        identity = where(counts, identity - level * isotropic, identity)
        for e in range(*family.denominator_start[g : g + 2]) if np.any(counts) else ():
            point = np.full(len(leaves), family.denominator_point[e])
            terms += parts(point, where(counts, level * family.denominator_weight[e], 0.0), -1.0)
    rows = family.channels
    if len(leaky):
        family = family.changed(
            points_m=np.vstack([family.points_m, family.points_m[leaky]]),
            ground_axes=np.vstack([family.ground_axes, np.zeros((len(leaky), 3))]),
            ground_leaks=np.zeros(0),
            channels=np.vstack([rows, rows[leaky]]) if len(rows) else rows,
        )
    return family, identity, terms
