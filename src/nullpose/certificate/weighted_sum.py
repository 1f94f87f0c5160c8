"""The weighted sum of a leaf's ratios, ``sum_k lambda_k (N_k - t D_g(k))``, as multiples of points' forms."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.interval import Interval, where
from nullpose.family import Family

# A ground point for each box, and by what its form is multiplied: exactly zero where it does not count.
Multiple: TypeAlias = tuple[IntArray, Interval]


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


def weighted_sum(family: Family, leaves: Leaves) -> tuple[Interval, list[Multiple], list[Multiple]]:
    """Return a sum's multiple of the identity, and those of numerators and (positive) of denominators.

    Args:
        family: the ratios.
        leaves: with multipliers and level.
    """
    ratio, weight = mix_slots(leaves)
    identity = Interval(np.zeros(len(leaves)))
    above: list[Multiple] = []
    below: list[Multiple] = []
    for k, w in zip(ratio, weight, strict=True):
        identity = identity + Interval(w) * family.numerator_isotropic[k]
        scale = Interval(w) * family.numerator_weight[k]
        above.append((family.numerator_point[k], where(w > 0.0, scale, 0.0)))
    for g, isotropic in enumerate(family.denominator_isotropic):
        mine = np.where(family.denominator_of[ratio] == g, weight, 0.0)
        counts = np.any(mine > 0.0, axis=0)
        level = Interval(mine).total() * leaves.level
        identity = where(counts, identity - level * isotropic, identity)
        for e in range(*family.denominator_start[g : g + 2]) if np.any(counts) else ():
            point = np.full(len(leaves), family.denominator_point[e])
            below.append((point, where(counts, level * family.denominator_weight[e], 0.0)))
    return identity, above, below
