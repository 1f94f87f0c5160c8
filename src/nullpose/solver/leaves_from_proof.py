"""From a proof to a certificate's leaves: the kernels' rows as dyadic boxes with their multipliers."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from nullpose.certificate import Leaves
from nullpose.certificate.certificate import AFFINE, OFF_BAND, PROFILE, TOWARDS, WORLD
from nullpose.solver.proof import Proof

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def leaves_of(proof: Proof, axis: str) -> Leaves:
    """Convert a proof's leaves, their boxes as dyadic parts of the root.

    Args:
        proof: with its root and leaves.
        axis: the name of its axis field in a certificate.
    """
    return _of_profile(proof) if axis == "profile" else _of_dipole(proof)


def _of_dipole(proof: Proof) -> Leaves:
    from nullpose.solver.kernels import node

    rows = proof.leaves
    test = rows[:, node.KIND].astype(np.int64)
    ratios, weights = rows[:, node.INDEX : node.WEIGHT].astype(np.int64), rows[:, node.WEIGHT : node.BALL]
    has_mix = np.isin(test, (WORLD, TOWARDS, AFFINE))
    mix, mixes = _mixes(ratios, weights, np.where(has_mix, rows[:, node.COUNT], 0).astype(np.int64))
    point = np.where(np.isin(test, (WORLD, AFFINE, OFF_BAND)), -1, rows[:, node.ANCHOR])
    uses_ball = rows[:, node.NU] > 0.0
    is_free = np.isin(test, (WORLD, TOWARDS))
    return Leaves(
        box=_parts(
            proof.root[0], proof.root[1], rows[:, node.CENTRE : node.HALF], rows[:, node.HALF : node.LEVEL]
        ),
        cell=_cells(rows, node.FACE, node.CELL),
        test=test,
        point=point.astype(np.int64),
        level=rows[:, node.LEVEL].copy(),
        mix=mix,
        mixes=mixes,
        sides=np.where(rows[:, [node.FACE]] >= 0.0, rows[:, node.SIDE : node.SIDE + 2], 0.0),
        band=np.where(is_free, rows[:, node.BAND], 0.0),
        ball=np.where(uses_ball, rows[:, node.BALL], -1).astype(np.int64),
        ball_multiplier=np.where(uses_ball, rows[:, node.NU], 0.0),
    )


def _of_profile(proof: Proof) -> Leaves:
    """Convert leaves of an antenna that is the same all round; they all hold at the bound."""
    from nullpose.solver.kernels.attitude import ANCHOR, CHART, HALF, WARM

    rows, none = proof.leaves, np.zeros(len(proof.leaves))
    widest = math.pi / 2.0 if proof.is_even else math.pi
    turns = rows[:, [3, 5]], rows[:, [HALF + 3, HALF + 5]]
    turned = _parts(np.array([0.0, -math.pi]), np.array([widest, math.pi]), *turns)
    ratios = np.tile(np.arange(rows.shape[1] - WARM), (len(rows), 1))
    weights = rows[:, WARM:]
    # the multipliers that count come first
    order = np.argsort(weights <= 0.0, axis=1, kind="stable")
    ratios, weights = (np.take_along_axis(each, order, axis=1) for each in (ratios, weights))
    mix, mixes = _mixes(ratios, weights, np.maximum(1, np.sum(weights > 0.0, axis=1)))
    return Leaves(
        box=_parts(proof.root[0], proof.root[1], rows[:, :3], rows[:, HALF : HALF + 3]),
        cell=np.concatenate([rows[:, [CHART]].astype(np.int64), turned], axis=1),
        test=np.full(len(rows), PROFILE),
        point=rows[:, ANCHOR].astype(np.int64),
        level=np.full(len(rows), proof.upper_bound),
        mix=mix,
        mixes=mixes,
        sides=np.zeros((len(rows), 2)),
        band=none,
        ball=np.full(len(rows), -1),
        ball_multiplier=none,
    )


def _parts(low: FloatArray, high: FloatArray, centre: FloatArray, half: FloatArray) -> IntArray:
    """Locate boxes by depth and index along each coordinate in turn, (l, 2 n)."""
    flat = high <= low
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = np.where(flat, 0, np.rint(np.log2(0.5 * (high - low) / half)))
        index = np.where(flat, 0, np.rint((centre - low) / (2.0 * half) - 0.5))
    return np.stack([depth, index], axis=2).astype(np.int64).reshape(len(centre), -1)


def _mixes(
    ratios: IntArray, weights: FloatArray, used: IntArray
) -> tuple[IntArray, tuple[dict[int, float], ...]]:
    """Index each leaf's multipliers, -1 for none, into those that differ.

    Args:
        ratios: (l, n) ratios of each leaf, those that count first.
        weights: (l, n) theirs.
        used: (l,) how many count.
    """
    table: dict[tuple[float, ...], int] = {}
    mixes: list[dict[int, float]] = []
    mix = np.full(len(used), -1, dtype=np.int64)
    for i in np.flatnonzero(used):
        of, by = ratios[i, : used[i]].tolist(), weights[i, : used[i]].tolist()
        key = (*of, *by)
        if key not in table:
            table[key] = len(mixes)
            mixes.append(dict(zip(of, by, strict=True)))
        mix[i] = table[key]
    return mix, tuple(mixes)


def _cells(rows: FloatArray, face: int, cell: int) -> IntArray:
    """Locate cells of axes by their face, and depth and index along each side; the whole cube is face -1."""
    on_face = rows[:, [face]] >= 0.0
    low = np.where(on_face, rows[:, [cell, cell + 2]], -1.0)
    high = np.where(on_face, rows[:, [cell + 1, cell + 3]], 1.0)
    sides = _parts(-np.ones(2), np.ones(2), 0.5 * (low + high), 0.5 * (high - low))
    return np.concatenate([rows[:, [face]].astype(np.int64), sides], axis=1)
