"""Leaves as boxes of floating-point numbers that contain the exact ones, and whether they cover the root."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nullpose.certificate.certificate import PROFILE, Leaves
from nullpose.certificate.interval import Interval
from nullpose.certificate.taylor import Taylor, coordinates
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Boxes:
    """Boxes of positions; several may belong to one leaf.

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
        """Select boxes by a mask, indices or a slice."""
        return Boxes(leaf=self.leaf[mask], centre=self.centre[mask], half=self.half[mask])

    @property
    def hull(self) -> Interval:
        """All positions of each, (3, b)."""
        return (Interval(self.centre) + Interval(-self.half, self.half)).T

    @property
    def position(self) -> Taylor:
        """The position itself, (3, b), as a Taylor number."""
        return coordinates(Interval(self.centre.T), self.hull)

    def distance2(self, points: FloatArray) -> Interval:
        """Enclose the squared distances from points, (b, 3) or (1, 3), to all positions of the boxes."""
        return (Interval(points.T) - self.hull).squared().total()

    def nearest(self, points: FloatArray) -> Interval:
        """Bound from below the distance from points, (b, 3), to the boxes, as exact numbers."""
        return Interval(self.distance2(points).sqrt().low)

    @property
    def half2(self) -> Interval:
        """The squared half diagonals, (b,)."""
        return Interval(self.half.T).squared().total()


def boxes_of(root_m: FloatArray, leaves: Leaves) -> Boxes:
    """Enclose each leaf in a box.

    Args:
        root_m: (2, 3) the root's corners.
        leaves: dyadic parts of it.
    """
    depth, index = leaves.depths[:, :3], leaves.indices[:, :3]
    side = Interval(root_m[1]) - root_m[0]
    # the share of the side is exact: an index has at most 50 bits
    low, high = (side * np.ldexp(i.astype(float), -depth) + root_m[0] for i in (index, index + 1))
    centre = 0.5 * low.low + 0.5 * high.high
    half = np.maximum((Interval(high.high) - centre).high, (Interval(centre) - low.low).high)
    return Boxes(leaf=np.arange(len(leaves)), centre=centre, half=np.maximum(half, 0.0))


def parts(boxes: Boxes) -> Boxes:
    """Cut into the eight parts of each box, a hair larger than an eighth."""
    for side in range(3):
        boxes = halved(boxes, np.full(len(boxes), side))
    return boxes


def halved(boxes: Boxes, side: IntArray) -> Boxes:
    """Cut into the lower and then the upper half of each box, a hair larger than half of it.

    Args:
        boxes: b of them.
        side: (b,) the axis of each to cut across; others than x, y and z change nothing.
    """
    across = np.arange(3) == side[:, None]
    slack = 4e-16 * (np.abs(boxes.centre) + boxes.half)
    # the step upwards counts where the slack is too small to be a number
    half = np.where(across, np.nextafter(0.5 * boxes.half + slack, np.inf), boxes.half)
    step = np.where(across, 0.5 * boxes.half, 0.0)
    return Boxes(
        leaf=np.tile(boxes.leaf, 2),
        centre=np.concatenate([boxes.centre - step, boxes.centre + step]),
        half=np.tile(half, (2, 1)),
    )


def uncovered(leaves: Leaves) -> str:
    """Find a region of the root that the leaves do not cover; an empty string if there is none.

    Coverage in whole numbers: a region is covered if one leaf holds it, or if it can be halved across a
    direction in which every leaf in it is finer, and both halves are covered. The regions of as many cuts
    are looked at together.

    Rows are leaves, sorted by region. In every direction a leaf is at least as deep as its region, for a
    region is halved only where all its leaves are deeper. So each leaf lies in one half, and a leaf that
    holds its region equals it.

    Args:
        leaves: to be checked; depths and indices in range. Those for an antenna that is the same all round
            hold all axes by any one anchor and chart; those of a dipole on three faces.
    """
    faces, depths, indices = leaves.face, leaves.depths, leaves.indices
    depths[faces < 0, 3:] = 0  # without a cell it is whole
    if is_profile := bool(np.all(leaves.test == PROFILE)):
        faces = leaves.face + 3 * (leaves.point + 1)
    # of each row: its leaf and its region, and that one's depths and face, -1 for all of them
    leaf, region, depth = np.arange(len(leaves)), np.zeros(len(leaves), dtype=np.int64), np.zeros_like(depths)
    on_face = np.full(len(leaves), -1)
    if not len(leaves):
        return "the leaves do not cover the root: there are none"
    while len(leaf):
        is_first = np.diff(region, prepend=-1) > 0
        first_row, region_of = np.flatnonzero(is_first), np.cumsum(is_first) - 1
        shallowest = np.minimum.reduceat(depths[leaf], first_row)
        lowest, highest = (end.reduceat(faces[leaf], first_row) for end in (np.minimum, np.maximum))
        splits_by_face = (on_face[first_row] < 0) & (lowest >= 0) & ((lowest == highest) | (not is_profile))
        # only a region on a face has the sides of cells
        can_halve = (shallowest > depth[first_row]) & (
            (np.arange(5) < 3) | (on_face[first_row] >= 0)[:, None]
        )
        is_split = splits_by_face | np.any(can_halve, axis=1)
        equals_region = np.all(depths[leaf] == depth, axis=1) & ((faces[leaf] < 0) | (on_face >= 0))
        by_face, side = splits_by_face[region_of], np.argmax(can_halve, axis=1)[region_of]
        at_side = np.arange(len(leaf)), side
        # the leaf's next bit: which half of its region it is in
        half = indices[leaf, side] >> np.maximum(depths[leaf, side] - depth[at_side] - 1, 0) & 1
        child = 3 * region_of + np.where(by_face, faces[leaf] % 3, half)
        parts_found = np.bincount(np.unique(child) // 3, minlength=len(first_row))
        # a profile's leaves have one anchor and chart: any will do
        all_there = parts_found >= np.where(splits_by_face, 1 if is_profile else 3, 2)
        # a region that is not split is covered by a leaf that equals it; of one that is, no part may be empty
        covered = np.where(is_split, all_there, np.logical_or.reduceat(equals_region, first_row))
        if not np.all(covered):
            row = first_row[np.argmin(covered)]
            found = set((child[region_of == region_of[row]] % 3).tolist())
            missing = min({0, 1, 2} - found) if by_face[row] else on_face[row]
            ahead = depths[leaf[row]] - depth[row]
            return _gap_words(indices[leaf[row]] >> ahead, 1 << depth[row], missing, is_profile)
        depth[at_side] += ~by_face
        on_face = np.where(by_face, faces[leaf], on_face)
        kept = (order := np.argsort(child, kind="stable"))[is_split[region_of[order]]]
        leaf, region, depth, on_face = leaf[kept], child[kept], depth[kept], on_face[kept]
    return ""


def _gap_words(index: IntArray, count: IntArray, face: int, is_profile: bool) -> str:
    """Name a region that leaves leave out.

    Args:
        index: (5,) its index among equal parts of each side.
        count: (5,) how many these are.
        face: its face, or -1; of a profile anchor and chart in one number.
        is_profile: whether it is one.
    """
    names = [f"{x} {i + 1} of {n}" for x, i, n in zip("xyzab", index, count, strict=True) if n > 1]
    on_face = f"point {face // 3 - 1}, chart {face % 3}" if is_profile else f"face{face}"
    gap = ", ".join([*names, *[on_face] * int(face >= 0)]) or "all of it"
    return f"the leaves do not cover the root: they leave out, at least in part, {gap}"
