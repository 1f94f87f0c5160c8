"""The verifier: whether a certificate proves its claim."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from nullpose.certificate.affine_test import affine_holds
from nullpose.certificate.boxes import Boxes, boxes_of, parts, uncovered
from nullpose.certificate.certificate import (
    AFFINE,
    DEEPEST,
    FAR,
    KEPT_OUT,
    OFF_BAND,
    PROFILE,
    TOWARDS,
    WORLD,
    Certificate,
    Leaves,
    Tree,
    claimed_axes,
)
from nullpose.certificate.claim import claim_fault, pose_fault
from nullpose.certificate.free_test import free_holds
from nullpose.certificate.plain_tests import borders, far_holds, kept_out, off_band_holds, root_holds
from nullpose.certificate.profile import ProfileField, loudest
from nullpose.certificate.profile_test import profile_holds
from nullpose.certificate.subject import sentence
from nullpose.errors import checked
from nullpose.objectives.ratios import IntArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family, join_instants, still_scenes

_CHUNK = 4096
_CUT_AT_ONCE = 128
_CUTS = 2  # boxes whose test fails by a hair are cut into eight, so many times
_MORE_CUTS = 6  # or as often as that, while few of the pieces fail


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


@dataclass(frozen=True, slots=True)
class _Test:
    """How leaves of a kind are tested.

    Args:
        name: for messages.
        holds: which boxes, each with its leaf, are excluded under an axis field.
        has_mix: whether the leaf has multipliers of ratios.
        points: how many things of a family the leaf's point counts over, None if it has no point.
    """

    name: str
    holds: Callable[[Family, AxisField, Leaves, Boxes], np.ndarray]
    has_mix: bool = False
    points: Callable[[Family], int] | None = None


_TESTS = {
    WORLD: _Test("free axis", free_holds, has_mix=True),
    TOWARDS: _Test(
        "free axis, turning frame", free_holds, has_mix=True, points=lambda f: len(f.ratios.points_m)
    ),
    AFFINE: _Test("given axis", affine_holds, has_mix=True),
    FAR: _Test("distance", far_holds, points=lambda f: len(f.ratios.pairs) or len(f.ratios.numerator_point)),
    KEPT_OUT: _Test(
        "keep-out",
        lambda family, field, leaves, boxes: kept_out(family, leaves.point, boxes),
        points=borders,
    ),
    OFF_BAND: _Test("axes out of reach", off_band_holds),
    PROFILE: _Test(
        "any axis of a profile", profile_holds, has_mix=True, points=lambda f: len(f.ratios.points_m) + 1
    ),
}


@checked
def verify(certificate: Certificate, on_progress: Callable[[int, int], None] | None = None) -> Verdict:
    """Check whether a certificate proves its claim, by code that imports nothing from the solver.

    The pose must be allowed and have the value that is stated (exact arithmetic); the leaves must cover
    every position and axis that could exceed the bound, and each leaf's test must hold (outward-rounded
    interval arithmetic). In a scene in motion the value is the smallest over all instants, and the leaves
    are about some of them: no pose has more at all. The scenario's units are converted to a family of ratios
    in double precision before, by the function that the solver uses too: the claim is about those numbers.

    Args:
        certificate: what to check.
        on_progress: called with the leaves checked and how many there are.

    Example:
        >>> import nullpose
        >>> result = nullpose.solve(nullpose.load("examples/paper.toml"))
        >>> nullpose.verify(nullpose.certificate_of(result)).proved
        True
    """
    total = sum(len(tree.leaves) for tree in certificate.trees)
    scenes = still_scenes(certificate.scenario)
    families = [
        build_family(scene, any_antenna=True, any_channel=True, any_objective=True) for scene in scenes
    ]
    fields = claimed_axes(certificate.scenario, certificate.scheme, certificate.null_jammer)
    reason = claim_fault(certificate, families[0], fields)
    reason = reason or pose_fault(certificate, scenes, families, fields or {})
    in_motion = certificate.instants and not reason  # what some instants exclude, all do
    family, done = join_instants(families, certificate.instants) if in_motion else families[0], 0

    def report(leaves: int) -> None:
        if on_progress is not None:
            on_progress(done + leaves, total)

    for tree in certificate.trees:
        if reason:
            break
        assert fields is not None
        with np.errstate(all="ignore"):  # infinities and undefined numbers fail their comparisons
            reason = _tree_fault(family, fields[tree.axis], tree, certificate.upper_bound, report)
        done += len(tree.leaves)
    return Verdict(
        proved=not reason,
        message=f"rejected: {reason}" if reason else sentence(certificate, total),
        leaves=done,
    )


def _tree_fault(
    family: Family, field: AxisField, tree: Tree, upper_bound: float, report: Callable[[int], None]
) -> str:
    fault = (
        _range_fault(family, field, tree, upper_bound)
        or root_holds(loudest(family, field), tree.root_m, upper_bound)
        or uncovered(tree.leaves)
        or _leaf_fault(family, field, tree, report)
    )
    return f"tree {tree.axis!r}: {fault}" if fault else ""


def _leaf_fault(family: Family, field: AxisField, tree: Tree, report: Callable[[int], None]) -> str:
    """Find the first leaf that its test does not exclude, or an empty string."""
    leaves, boxes = tree.leaves, boxes_of(tree.root_m, tree.leaves)
    for start in range(0, len(leaves), _CHUNK):
        if (leaf := _failing(family, field, leaves, boxes.chosen(slice(start, start + _CHUNK)))) is not None:
            hull = boxes.hull[:, leaf]
            where = ", ".join(
                f"{low:.6g} to {high:.6g}" for low, high in zip(hull.low, hull.high, strict=True)
            )
            return (
                f"leaf {leaf} (x, y, z: {where} m) is not excluded at {leaves.level[leaf]:.12g} "
                f"by its test ({_TESTS[int(leaves.test[leaf])].name})"
            )
        report(min(start + _CHUNK, len(leaves)))
    return ""


def _range_fault(family: Family, field: AxisField, tree: Tree, upper_bound: float) -> str:
    """Find the first leaf whose numbers are out of range or whose claim is another, or an empty string."""
    leaves = tree.leaves
    numbers = 2 * len(family.ratios.pairs) or len(family.ratios.numerator_point) + len(
        family.ratios.requirements
    )
    points = {kind: test.points(family) for kind, test in _TESTS.items() if test.points}
    has_mix = np.isin(leaves.test, [kind for kind, test in _TESTS.items() if test.has_mix])
    faults = {
        "its level is above the bound": ~(leaves.level <= upper_bound),
        "its level is not positive": ~(leaves.level > 0.0),
        "its test is unknown": ~np.isin(leaves.test, list(_TESTS)),
        "its test is for a given axis, and the tree's is free": (leaves.test == AFFINE) & field.is_free,
        "its test is for another antenna": (leaves.test == PROFILE) != isinstance(field, ProfileField),
        "it has no chart": (leaves.test == PROFILE) & (leaves.face < 0),
        "its angles are from the zenith, which has chart 0 alone": (
            (leaves.test == PROFILE) & (leaves.point < 0) & (leaves.face != 0)
        ),
        "its point does not exist": np.any(
            [
                (leaves.test == kind) & _outside(leaves.point + (kind == PROFILE), count)
                for kind, count in points.items()
            ],
            axis=0,
        ),
        "its multipliers do not exist": has_mix & _outside(leaves.mix, len(leaves.mixes)),
        "its keep-out ball or zone does not exist": leaves.ball >= borders(family),
        "a multiplier is negative": ~((leaves.ball_multiplier >= 0.0) & np.all(leaves.sides >= 0.0, axis=1)),
        "the band's multiplier is not a number": ~np.isfinite(leaves.band),
        "its cell does not exist": _outside(leaves.face + 1, 4),
        "its depth is out of range": np.any(_outside(leaves.depths, DEEPEST + 1), axis=1),
        "its index is out of range": np.any(
            _outside(leaves.indices, 1 << np.clip(leaves.depths, 0, DEEPEST)), axis=1
        ),
    }
    for words, mask in faults.items():
        if np.any(mask):
            return f"leaf {int(np.argmax(mask))}: {words}"
    for number, mix in enumerate(leaves.mixes):
        if not mix or any(not (0 <= k < numbers and w >= 0.0) for k, w in mix.items()):
            return f"multipliers {number}: a ratio that does not exist, or a negative weight"
    of_root = {
        # squares of distances would overflow
        "the root box is too large: its numbers must be below 1e150 m": ~(np.abs(tree.root_m) < 1e150),
        "the root box is empty": ~(tree.root_m[0] <= tree.root_m[1]),
    }
    return next((words for words, mask in of_root.items() if np.any(mask)), "")


def _outside(index: IntArray, count: int | IntArray) -> np.ndarray:
    return (index < 0) | (index >= count)


def _failing(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> int | None:
    """Find the first leaf of the boxes that is not excluded, cutting boxes that fail narrowly, or None."""
    failed = boxes.chosen(~_holds(family, field, leaves, boxes))
    if isinstance(field, ProfileField) and len(failed):  # whose test cuts cells by itself
        return int(failed.leaf.min())
    for start in range(0, len(failed), _CUT_AT_ONCE):
        left = failed.chosen(slice(start, start + _CUT_AT_ONCE))
        for cut in range(_MORE_CUTS):
            if not len(left) or (cut >= _CUTS and len(left) > _CUT_AT_ONCE):
                break
            pieces = parts(left)
            left = pieces.chosen(~_holds(family, field, leaves, pieces))
        if len(left):
            return int(left.leaf.min())
    return None


def _holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Check which boxes their leaves exclude."""
    holds, kinds = np.zeros(len(boxes), dtype=bool), leaves.test[boxes.leaf]
    for kind, test in _TESTS.items():
        if np.any(mask := kinds == kind):
            tested = boxes.chosen(mask)
            holds[mask] = test.holds(family, field, leaves.chosen(tested.leaf), tested)
    return holds
