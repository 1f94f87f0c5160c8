"""The verifier: whether a certificate proves its claim."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nullpose.certificate.affine_test import affine_holds
from nullpose.certificate.axis_cells import off_band_holds
from nullpose.certificate.boxes import Boxes, boxes_of, parts
from nullpose.certificate.certificate import (
    AFFINE,
    FAR,
    KEPT_OUT,
    OFF_BAND,
    TOWARDS,
    WORLD,
    Certificate,
    FloatArray,
    Leaves,
    Tree,
    claimed_axes,
)
from nullpose.certificate.claim import claim_fault, pose_fault
from nullpose.certificate.coverage import uncovered
from nullpose.certificate.distance_tests import far_holds, kept_out_holds, root_holds
from nullpose.certificate.free_test import free_holds
from nullpose.certificate.sentence import sentence
from nullpose.family import AxisField, Family, build_family

__all__ = ["Verdict", "verify"]

_CHUNK = 4096
_ROUNDS = 3  # boxes whose test fails by a hair are cut into eight, so many times

_NAMES = {
    WORLD: "free axis",
    TOWARDS: "free axis, turning frame",
    AFFINE: "given axis",
    FAR: "distance",
    KEPT_OUT: "keep-out",
    OFF_BAND: "axes out of reach",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What became of a certificate.

    Args:
        proved: whether the claim is proved.
        message: the claim that was proved, or the first reason why it was not.
        leaves: leaves checked.
    """

    proved: bool
    message: str
    leaves: int


def verify(certificate: Certificate, on_progress: Callable[[int, int], None] | None = None) -> Verdict:
    """Return whether a certificate proves its claim, by code that imports nothing from the solver.

    The pose must be allowed and have the value that is stated (exact arithmetic); the leaves must cover
    every position and axis that could exceed the bound, and each leaf's test must hold (outward-rounded
    interval arithmetic). The scenario's units are converted to a family of ratios in double precision
    before, by the function that the solver uses too: the claim is about those numbers.

    Args:
        certificate: what to check.
        on_progress: called with the leaves checked and how many there are.
    """
    total = sum(len(tree.leaves) for tree in certificate.trees)
    family = build_family(certificate.scenario)
    fields = claimed_axes(certificate.scenario, certificate.scheme, certificate.null_jammer)
    reason = claim_fault(certificate, family, fields) or pose_fault(certificate, family, fields or {})
    done = 0
    for tree in certificate.trees:
        if reason:
            break
        assert fields is not None
        with np.errstate(all="ignore"):  # infinities and undefined numbers fail their comparisons
            reason = _tree_fault(certificate, family, fields[tree.axis], tree, done, total, on_progress)
        done += len(tree.leaves)
    if reason:
        return Verdict(proved=False, message=f"rejected: {reason}", leaves=done)
    return Verdict(proved=True, message=sentence(certificate, total), leaves=total)


def _tree_fault(
    certificate: Certificate,
    family: Family,
    field: AxisField,
    tree: Tree,
    before: int,
    total: int,
    on_progress: Callable[[int, int], None] | None,
) -> str:
    leaves = tree.leaves
    fault = _range_fault(family, field, tree, certificate.upper_bound) or root_holds(
        family, tree.root_m, certificate.upper_bound
    )
    if not fault and (missing := uncovered(leaves)):
        fault = f"the leaves do not cover the root: {missing}"
    if fault:
        return f"tree {tree.axis!r}: {fault}"
    boxes = boxes_of(tree.root_m, leaves)
    for start in range(0, len(leaves), _CHUNK):
        failed = _failing(family, field, leaves, boxes.chosen(slice(start, start + _CHUNK)))
        if len(failed):
            low, high = boxes.corners
            one = int(failed[0])
            where = ", ".join(f"{low.low[one, i]:.6g} to {high.high[one, i]:.6g}" for i in range(3))
            test = _NAMES[int(leaves.test[one])]
            return (
                f"tree {tree.axis!r}: leaf {one} (x, y, z: {where} m) is not excluded at "
                f"{leaves.level[one]:.12g} by its test ({test})"
            )
        if on_progress is not None:
            on_progress(before + min(start + _CHUNK, len(leaves)), total)
    return ""


def _range_fault(family: Family, field: AxisField, tree: Tree, upper_bound: float) -> str:
    """Return the first leaf whose numbers are out of range or whose claim is another, or an empty string."""
    leaves = tree.leaves
    points, ratios = len(family.points_m), len(family.numerator_point)
    borders = len(family.keep_out_points_m) + len(family.zone_kind)
    limit = np.select(
        [leaves.test == TOWARDS, leaves.test == FAR, leaves.test == KEPT_OUT],
        [points, ratios, borders],
        points + 1,
    )
    needs_point = np.isin(leaves.test, (TOWARDS, FAR, KEPT_OUT))
    needs_mix = np.isin(leaves.test, (WORLD, TOWARDS, AFFINE))
    faults = {
        "its level is above the bound": leaves.level > upper_bound,
        "its level is not positive": ~(leaves.level > 0.0),
        "its test is unknown": ~np.isin(leaves.test, list(_NAMES)),
        "its test is for a given axis, and the tree's is free": (leaves.test == AFFINE) & field.is_free,
        "its point does not exist": needs_point & ((leaves.point < 0) | (leaves.point >= limit)),
        "its multipliers do not exist": needs_mix & ((leaves.mix < 0) | (leaves.mix >= len(leaves.mixes))),
        "its keep-out ball or zone does not exist": leaves.ball >= borders,
        "a multiplier is negative": (leaves.ball_multiplier < 0.0) | np.any(leaves.sides < 0.0, axis=1),
        "the band's multiplier is not a number": ~np.isfinite(leaves.band),
        "its cell does not exist": (leaves.cell[:, 0] < -1) | (leaves.cell[:, 0] > 2),
    }
    depth = np.concatenate([leaves.box[:, 0::2], leaves.cell[:, 1::2]], axis=1)
    index = np.concatenate([leaves.box[:, 1::2], leaves.cell[:, 2::2]], axis=1)
    deep = (depth < 0) | (depth > 50)
    faults["its depth is out of range"] = np.any(deep, axis=1)
    faults["its index is out of range"] = np.any((index < 0) | (index >= 1 << np.clip(depth, 0, 50)), axis=1)
    for words, mask in faults.items():
        if np.any(mask):
            return f"leaf {int(np.argmax(mask))}: {words}"
    for number, mix in enumerate(leaves.mixes):
        if not mix or any(not 0 <= k < ratios for k in mix) or any(not w >= 0.0 for w in mix.values()):
            return f"multipliers {number}: a ratio that does not exist, or a negative weight"
    if not np.all(tree.root_m[0] <= tree.root_m[1]):
        return "the root box is empty"
    return ""


def _failing(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> FloatArray:
    """Return the leaves of the boxes that are not excluded, cutting boxes that fail narrowly."""
    for turn in range(_ROUNDS):
        boxes = boxes.chosen(~_holds(family, field, leaves, boxes))
        if not len(boxes) or turn == _ROUNDS - 1 or len(boxes) > _CHUNK:
            break
        boxes = parts(boxes)
    return np.unique(boxes.leaf)


def _holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    test = leaves.test[boxes.leaf]
    holds = np.zeros(len(boxes), dtype=bool)
    checks: tuple[tuple[tuple[int, ...], Callable[[Boxes], np.ndarray]], ...] = (
        ((FAR,), lambda some: far_holds(family, leaves, some)),
        ((KEPT_OUT,), lambda some: kept_out_holds(family, leaves, some)),
        ((OFF_BAND,), lambda some: off_band_holds(field, leaves, some)),
        ((WORLD, TOWARDS), lambda some: free_holds(family, field, leaves, some)),
        ((AFFINE,), lambda some: affine_holds(family, field, leaves, some)),
    )
    for tests, check in checks:
        mask = np.isin(test, tests)
        if np.any(mask):
            holds[mask] = check(boxes.chosen(mask))
    return holds
