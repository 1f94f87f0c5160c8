"""The signed sum of links that a leaf's multipliers make, ``sum_k lambda_k (N_k - t D_g(k))``.

Of a mean of R ratios the numbers from R on are requirements: with them ``sum_k nu_k (N_k - r_k D)`` comes on
top, which is not negative where every ratio is its ``r_k`` or more. Of P pairs the numbers are those of the
pairs, and from P on what each one's tangent touches at (:func:`pair_factors`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nullpose.certificate.certificate import Leaves
from nullpose.certificate.elementary import exp, log
from nullpose.certificate.interval import Interval, where
from nullpose.objectives.ratios import IntArray, Ratios
from nullpose.physics.types import FloatArray


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


def mean_level(ratios: Ratios, ratio: IntArray, weight: FloatArray, level: FloatArray) -> Interval:
    """Bound the denominator's factor in the sum of a mean: lemma 6.

    Where the mean of ``X_k = a + N_k / D`` is at least t, ``sum_k q_k X_k >= t prod_k (q_k / p_k)^p_k`` for
    any positive q. What is returned is the right side less ``a sum_k q_k``, or not a number where that may be
    below zero; zero where there is no q.

    Args:
        ratios: over the points.
        ratio: (slots, l) which.
        weight: (slots, l) q.
        level: (l,) t.
    """
    whole = Interval(ratios.shares).total()  # one, but for rounding: the mean's logarithm over it is a mean
    power, total = log(Interval(level)) / whole, Interval(np.zeros(len(level)))
    for k, share in enumerate(ratios.shares):
        q, p = np.sum(np.where(ratio == k, weight, 0.0), axis=0), Interval(share) / whole
        power = power + (log(Interval(q)) - log(p)) * p
        total = total + q
    result = exp(power) - total * ratios.offset
    stands = np.any((ratio < len(ratios.shares)) & (weight != 0.0), axis=0)
    return where(stands, where(result.low >= 0.0, result, np.nan), 0.0)


def pairs_fit(ratios: Ratios) -> bool:
    """Check what lemma 7 asks of pairs: ``N = D + S I`` with S of 0 or more, and two kinds of denominators.

    Args:
        ratios: with their pairs.
    """
    of = ratios.denominator_of
    return bool(
        np.array_equal(ratios.denominator_start, np.arange(len(ratios.denominator_isotropic) + 1))
        and np.array_equal(ratios.denominator_point[of], ratios.numerator_point)
        and np.array_equal(ratios.denominator_weight[of], ratios.numerator_weight)
        and np.all(ratios.numerator_isotropic >= ratios.denominator_isotropic[of])
        and not np.any(np.isin(*of[ratios.pairs.T]))
    )


def pair_factors(
    ratios: Ratios, leaves: Leaves, number: IntArray, weight: FloatArray
) -> tuple[Interval, list[Interval]]:
    """Bound the identity's multiple in a sum of pairs, and each denominator's factor: lemma 7.

    The pair's quotient is t or more where ``b <= phi(e) = S_B e / ((t - 1) e + t S_E)``, and phi is no more
    than its tangent at any ``e0 >= 0``, for t of 1 or more and :func:`pairs_fit`. ``lambda (tangent(e) - b)``
    is added: that of an eavesdropper's denominator is added, that of a node's is subtracted. Both are whole
    denominators, so that their isotropic parts go to the identity. Below 1 what is returned is not a number.

    Args:
        ratios: with its pairs.
        leaves: with level.
        number: (slots, l) which pair, or from their number on which one's e0.
        weight: (slots, l) lambda, or e0.
    """
    pairs, of, isotropic = ratios.pairs, ratios.denominator_of, ratios.denominator_isotropic
    beyond = Interval(ratios.numerator_isotropic) - isotropic[of]
    level = Interval(np.where(leaves.level >= 1.0, leaves.level, np.nan))
    identity = Interval(np.zeros(len(leaves)))
    factors = [identity] * len(isotropic)
    for q, (node, eavesdropper) in enumerate(pairs):
        multiplier, e0 = (np.sum(np.where(number == n, weight, 0.0), axis=0) for n in (q, q + len(pairs)))
        counts, rise, s_e = multiplier != 0.0, (level - 1.0) * e0, level * beyond[eavesdropper]
        scale = beyond[node] / (rise + s_e).squared() * multiplier
        steep = scale * s_e  # lambda phi'(e0); lambda (phi(e0) - e0 phi'(e0)) is scale rise e0
        of_identity = (
            scale * rise * e0
            + steep * isotropic[of[eavesdropper]]
            - Interval(multiplier) * isotropic[of[node]]
        )
        identity = where(counts, identity + of_identity, identity)
        for g, part in ((of[node], Interval(multiplier)), (of[eavesdropper], steep)):
            factors[g] = where(counts, factors[g] + part, factors[g])
    return identity, factors


def level_factor(
    ratios: Ratios, leaves: Leaves, number: IntArray, weight: FloatArray, denominator: int
) -> Interval:
    """Bound a denominator's factor, ``sum_k lambda_k t``, or that of a mean: lemma 6. 0 where it is not used.

    Numbers from that of the ratios on are requirements; -1 finds the zero that is put at their end.
    """
    count = len(ratios.numerator_point)
    mine = np.where(ratios.denominator_of[number % count] == denominator, weight, 0.0)
    level = Interval(mine).total() * leaves.level
    if len(ratios.shares):
        least = np.append(ratios.requirements, 0.0)[np.where(number >= count, number % count, -1)]
        level = mean_level(ratios, number, weight, leaves.level) + (Interval(weight) * least).total()
    return where(np.any(mine != 0.0, axis=0), level, 0.0)


def weighted_sum(ratios: Ratios, leaves: Leaves) -> tuple[Interval, list[Term]]:
    """State a sum's multiple of the identity, and its terms: weak duality.

    Args:
        ratios: over the points.
        leaves: with multipliers and level.
    """
    number, weight = mix_slots(leaves)
    identity, terms = Interval(np.zeros(len(leaves))), list[Term]()
    if len(ratios.pairs):
        identity, factors = pair_factors(ratios, leaves, number, weight)
    else:
        for k, w in zip(number % len(ratios.numerator_point), weight, strict=True):
            identity = identity + Interval(w) * ratios.numerator_isotropic[k]
            scale = where(w != 0.0, Interval(w) * ratios.numerator_weight[k], 0.0)
            terms.append(Term(ratios.numerator_point[k], scale, 1.0))
        below = ratios.denominator_isotropic
        factors = [level_factor(ratios, leaves, number, weight, g) for g in range(len(below))]
        for factor, isotropic in zip(factors, below, strict=True):
            identity = where(factor.high != 0.0, identity - factor * isotropic, identity)
    for g, factor in enumerate(factors):
        sign = 1.0 if len(ratios.pairs) and g in ratios.denominator_of[ratios.pairs[:, 1]] else -1.0
        counts = factor.high != 0.0  # exactly zero where it does not count
        for e in range(*ratios.denominator_start[g : g + 2]) if np.any(counts) else ():
            scale = where(counts, factor * ratios.denominator_weight[e], 0.0)
            terms.append(Term(np.full(len(leaves), ratios.denominator_point[e]), scale, sign))
    return identity, terms
