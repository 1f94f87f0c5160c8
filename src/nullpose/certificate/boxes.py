"""Leaves as boxes of floating-point centres and half sides that contain the exact ones."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.interval import Interval
from nullpose.family import Family

__all__ = ["Boxes", "boxes_of", "group_shares", "mix_slots", "parts"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Boxes:
    """Boxes and what is needed to test them; several may belong to one leaf.

    Args:
        leaf: (b,) index of the leaf that each belongs to.
        centre: (b, 3) exact numbers.
        half: (b, 3) exact half sides; centre and half side enclose the box.
    """

    leaf: IntArray
    centre: FloatArray
    half: FloatArray

    def __len__(self) -> int:
        return len(self.leaf)

    def chosen(self, mask: IntArray | np.ndarray | slice) -> Boxes:
        """Return some of the boxes.

        Args:
            mask: a mask, indices or a slice.
        """
        return Boxes(leaf=self.leaf[mask], centre=self.centre[mask], half=self.half[mask])

    @property
    def corners(self) -> tuple[Interval, Interval]:
        """Their lowest and highest corners, (b, 3)."""
        return Interval(self.centre) - self.half, Interval(self.centre) + self.half

    def nearest2(self, points: FloatArray) -> FloatArray:
        """Return lower bounds on the squared distance from points, (b, 3) or (3,), to the boxes."""
        away = (Interval(points) - self.centre).low, (Interval(points) - self.centre).high
        gap = np.maximum(np.maximum(away[0], -away[1]) - self.half, 0.0)
        return Interval(np.maximum(np.nextafter(gap, -np.inf), 0.0)).squared().total().low

    def farthest2(self, points: FloatArray) -> FloatArray:
        """Return upper bounds on the squared distance from points, (b, 3) or (3,), to all of the boxes."""
        reach = Interval((Interval(points) - self.centre).magnitude()) + self.half
        return reach.squared().total().high

    @property
    def half2(self) -> Interval:
        """The squared half diagonals, (b,)."""
        return Interval(self.half).squared().total()


def boxes_of(root_m: FloatArray, leaves: Leaves) -> Boxes:
    """Return one box for each leaf.

    Args:
        root_m: (2, 3) the root's corners.
        leaves: dyadic parts of it.
    """
    depth, index = leaves.box[:, 0::2], leaves.box[:, 1::2]
    side = Interval(root_m[1]) - root_m[0]
    # powers of two are exact; an index of more than 53 bits is not, and is enclosed
    share = np.ldexp(1.0, -depth)
    low_index, high_index = index.astype(float), (index + 1).astype(float)
    start = Interval(np.nextafter(low_index, -np.inf), np.nextafter(low_index, np.inf)) * share
    end = Interval(np.nextafter(high_index, -np.inf), np.nextafter(high_index, np.inf)) * share
    low, high = (side * start + root_m[0]).low, (side * end + root_m[0]).high
    centre = 0.5 * low + 0.5 * high
    half = np.maximum((Interval(high) - centre).high, (Interval(centre) - low).high)
    return Boxes(leaf=np.arange(len(leaves)), centre=centre, half=np.maximum(half, 0.0))


def parts(boxes: Boxes) -> Boxes:
    """Return the eight parts of each box, a hair larger than an eighth."""
    signs = np.array([[1.0 if c >> i & 1 else -1.0 for i in range(3)] for c in range(8)])
    centre = (boxes.centre[:, None, :] + 0.5 * signs * boxes.half[:, None, :]).reshape(-1, 3)
    slack = 4e-16 * (np.abs(boxes.centre) + boxes.half)
    # the step upwards counts where the slack is too small to be a number
    half = np.repeat(np.nextafter(0.5 * boxes.half + slack, np.inf), 8, axis=0)
    return Boxes(leaf=np.repeat(boxes.leaf, 8), centre=centre, half=half)


def mix_slots(leaves: Leaves, boxes: Boxes) -> tuple[IntArray, FloatArray]:
    """Return ratios and their weights for each box, (slots, b) each; unused slots have weight zero.

    Args:
        leaves: with their mixes.
        boxes: which leaves.
    """
    slots = max((len(mix) for mix in leaves.mixes), default=0)
    ratio = np.zeros((len(leaves.mixes) + 1, slots), dtype=np.int64)
    weight = np.zeros((len(leaves.mixes) + 1, slots))
    for row, mix in enumerate(leaves.mixes):
        ratio[row, : len(mix)] = list(mix)
        weight[row, : len(mix)] = list(mix.values())
    chosen = leaves.mix[boxes.leaf]  # -1, without a mix, is the last row: all zero
    return ratio[chosen].T, weight[chosen].T


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
            more, mine = share + w, (family.denominator_of[k] == g) & (w > 0.0)
            share = Interval(np.where(mine, more.low, share.low), np.where(mine, more.high, share.high))
        shares.append(share)
    return shares
