"""The verifier: whether a certificate proves its claim."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from fractions import Fraction

import numpy as np

from nullpose.certificate.affine_test import affine_holds
from nullpose.certificate.boxes import Boxes, boxes_of, parts
from nullpose.certificate.certificate import (
    AFFINE,
    FAR,
    KEPT_OUT,
    TOWARDS,
    WORLD,
    Certificate,
    FloatArray,
    Leaves,
    Tree,
    claimed_axes,
)
from nullpose.certificate.coverage import uncovered
from nullpose.certificate.distance_tests import far_holds, kept_out_holds, root_holds
from nullpose.certificate.free_test import free_holds
from nullpose.certificate.pose_value import antenna_axis, field_offset, smallest_ratio
from nullpose.family import AxisField, Family, build_family

__all__ = ["Verdict", "verify"]

VALUE_RTOL = 1e-10
"""The stated value may differ from the pose's by so much: it was rounded."""

_EDGE_M = 1e-9  # a position on a face or a ball may be off by rounding
_AXIS_RAD = 1e-6
_MOST_RAD = 4.0
_CHUNK = 4096
_ROUNDS = 3  # boxes whose test fails by a hair are cut into eight, so many times

_NAMES = {
    WORLD: "free axis",
    TOWARDS: "free axis, turning frame",
    AFFINE: "given axis",
    FAR: "distance",
    KEPT_OUT: "keep-out",
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
    """Return whether a certificate proves its claim, by code that shares nothing with the solver.

    The pose must be allowed and have the value that is stated (exact arithmetic); the leaves must cover
    every position and axis that could exceed the bound, and each leaf's test must hold (outward-rounded
    interval arithmetic). The scenario's units are converted to a family of ratios in double precision
    before: the claim is about those numbers.

    Args:
        certificate: what to check.
        on_progress: called with the leaves checked and how many there are.
    """
    total = sum(len(tree.leaves) for tree in certificate.trees)
    family = build_family(certificate.scenario)
    fields = claimed_axes(certificate.scenario, certificate.scheme, certificate.null_jammer)
    reason = _claim_fault(certificate, fields) or _pose_fault(certificate, family, fields or {})
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
    return Verdict(proved=True, message=_sentence(certificate, total), leaves=total)


def _sentence(certificate: Certificate, leaves: int) -> str:
    axes = {
        "optimum": "no antenna axis",
        "vertical": "a vertical antenna",
        "zero-interference": "an antenna whose null is on a jammer",
        "maximum-gain": "an antenna broadside to both nodes",
    }[certificate.scheme]
    if certificate.null_jammer is not None:
        axes = f"an antenna whose null is on jammer {certificate.null_jammer}"
    who = f"with {axes}" if axes.startswith("a") else f"and {axes}"
    bound, value = certificate.upper_bound, certificate.value
    most, least = _rounded(bound, ROUND_CEILING), _rounded(value * (1.0 - VALUE_RTOL), ROUND_FLOOR)
    most_db = _rounded(10.0 * math.log10(bound) + 1e-12, ROUND_CEILING, digits=7)
    least_db = _rounded(10.0 * math.log10(value) - 1e-9, ROUND_FLOOR, digits=7)
    return (
        f"proved: in this scenario no position {who} gives every node an SINR above {most} ({most_db} dB), "
        f"and the stated pose gives every node {least} ({least_db} dB) or more, which is within "
        f"{bound / value - 1.0:.2e} of it; {leaves} leaves checked"
    )


def _rounded(number: float, direction: str, digits: int = 9) -> str:
    """Return a number with so many decimals that claims no more than it does; in full if it is small."""
    if 0.0 < number < 1e-3:
        return repr(number)
    return str(Decimal(number).quantize(Decimal(1).scaleb(-digits), rounding=direction))


def _claim_fault(certificate: Certificate, fields: dict[str, AxisField] | None) -> str:
    if fields is None:
        with_jammer = f"with null jammer {certificate.null_jammer!r} " if certificate.null_jammer else ""
        return f"scheme {certificate.scheme!r} {with_jammer}has no certificate in this scenario"
    named = [tree.axis for tree in certificate.trees]
    if sorted(named) != sorted(fields):
        return f"the scheme needs a tree for each of {sorted(fields)}; there are {sorted(named)}"
    if not (certificate.value > 0.0 and math.isfinite(certificate.upper_bound)):
        return "value and bound must be positive and finite"
    if certificate.upper_bound < certificate.value:
        return "the bound is below the value"
    return ""


def _pose_fault(certificate: Certificate, family: Family, fields: dict[str, AxisField]) -> str:
    angles = (certificate.roll_rad, certificate.pitch_rad, certificate.yaw_rad)
    if any(abs(angle) > _MOST_RAD for angle in angles):
        return f"pose: an angle beyond {_MOST_RAD:g} rad"
    p = [Fraction(float(x)) for x in certificate.position_m]
    for i, name in enumerate("xyz"):
        if not family.low_m[i] <= certificate.position_m[i] <= family.high_m[i]:
            return f"pose: {name} = {float(certificate.position_m[i])!r} m is outside the airspace"
    least = Fraction(family.keep_out_m) - Fraction(_EDGE_M)
    for point in family.points_m:
        away2 = sum(((Fraction(float(q)) - x) ** 2 for q, x in zip(point, p, strict=True)), Fraction(0))
        if least > 0 and away2 < least * least:
            return f"pose: closer than keep_out_m to the ground point {point.tolist()}"
    axis = antenna_axis(certificate)
    affine = [field for field in fields.values() if not field.is_free]
    if affine and not any(field_offset(field, p, axis) <= Fraction(_AXIS_RAD) ** 2 for field in affine):
        return "pose: the antenna's axis is not one that the scheme allows"
    value = smallest_ratio(family, p, axis)
    if abs(value - Fraction(certificate.value)) > Fraction(VALUE_RTOL) * value:
        return f"pose: its smallest SINR is {float(value):.15g}, not {certificate.value:.15g}"
    return ""


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
    points, ratios, balls = len(family.points_m), len(family.numerator_point), len(family.keep_out_points_m)
    limit = np.select(
        [leaves.test == TOWARDS, leaves.test == FAR, leaves.test == KEPT_OUT],
        [points, ratios, balls],
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
        "its keep-out ball does not exist": leaves.ball >= balls,
        "a multiplier is negative": (leaves.ball_multiplier < 0.0) | np.any(leaves.sides < 0.0, axis=1),
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
    for mask, check in (
        (test == FAR, far_holds),
        (test == KEPT_OUT, kept_out_holds),
        ((test == WORLD) | (test == TOWARDS), free_holds),
    ):
        if np.any(mask):
            holds[mask] = check(family, leaves, boxes.chosen(mask))
    mask = test == AFFINE
    if np.any(mask):
        holds[mask] = affine_holds(family, field, leaves, boxes.chosen(mask))
    return holds
