"""The multipliers of ratios, box by box, and what they come to for each denominator."""

from __future__ import annotations

import numpy as np

from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.interval import Interval, where
from nullpose.family import Family

__all__ = ["group_shares", "mix_slots"]


def mix_slots(leaves: Leaves) -> tuple[IntArray, FloatArray]:
    """Return ratios and their weights for each leaf, (slots, l) each; unused slots have weight zero.

    Args:
        leaves: with their mixes.
    """
    used, which = np.unique(leaves.mix, return_inverse=True)
    mixes = [leaves.mixes[m] if m >= 0 else {} for m in used]
    ratio = np.zeros((max(map(len, mixes), default=0), len(mixes)), dtype=np.int64)
    weight = np.zeros(ratio.shape)
    for i, mix in enumerate(mixes):
        ratio[: len(mix), i] = list(mix)
        weight[: len(mix), i] = list(mix.values())
    return ratio[:, which], weight[:, which]


def group_shares(family: Family, ratio: IntArray, weight: FloatArray) -> list[Interval]:
    """Return the sum of the weights of each denominator's ratios, (b,) each; exactly zero without any.

    Args:
        family: with the denominator of each ratio.
        ratio: (slots, b) as :func:`mix_slots` returns them.
        weight: (slots, b).
    """
    shares = []
    for g in range(len(family.denominator_isotropic)):
        share = Interval(np.zeros(weight.shape[1]))
        for k, w in zip(ratio, weight, strict=True):
            share = where((family.denominator_of[k] == g) & (w > 0.0), share + w, share)
        shares.append(share)
    return shares
