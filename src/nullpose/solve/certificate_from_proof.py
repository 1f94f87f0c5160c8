"""From a proof to a certificate: the kernels' rows as the verifier's leaves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna import PatternAntenna
from nullpose.certificate import Certificate, Leaves, Tree, claimed_axes, verify
from nullpose.certificate.certificate import AFFINE, OFF_BAND, TOWARDS, WORLD
from nullpose.certificate.pose_value import antenna_axis, exact, smallest_ratio
from nullpose.errors import UsageError
from nullpose.family import AxisField, build_family
from nullpose.scenario import Scenario
from nullpose.solve.proof import Proof
from nullpose.solve.result import Result
from nullpose.solve.rigour import Rigour, bound_above


def require_certificate(scenario: Scenario, scheme: str, null_jammer: str | None) -> Mapping[str, AxisField]:
    """Return the axis fields that a certificate of a scheme needs a tree for, by name.

    Args:
        scenario: what is solved.
        scheme: the case.
        null_jammer: zero interference only: the jammer to be nulled, or None for any.

    Raises:
        UsageError: the scheme has no certificate for this scenario.
    """
    if isinstance(scenario.antenna_record, PatternAntenna):
        raise UsageError(
            f"certificate: a {scenario.antenna_record.label} has none: its bound is proved in floating "
            "point; leave out --certificate and --verify"
        )
    fields = claimed_axes(scenario, scheme, null_jammer)
    if fields is None:
        raise UsageError(
            f"certificate: scheme {scheme} has none in this scenario: its bound is not a proof about its own "
            "axes; solve another scheme, or leave out --certificate and --verify"
        )
    return fields


def certificate_of(solution: Result) -> Certificate:
    """Return the certificate of a solution: everything that a verifier needs to check its bound.

    Args:
        solution: one with a proof.

    Raises:
        UsageError: nothing was proved, or the scheme has no certificate for this scenario.
    """
    fields = require_certificate(solution.scenario, solution.scheme, solution.null_jammer)
    if solution.objective.upper_bound is None:
        raise UsageError("certificate: nothing was proved; leave out --fast (certify=False)")
    pose = solution.pose
    value, bound = _ratios(solution)
    return Certificate(
        scenario=solution.scenario,
        scheme=str(solution.scheme),
        null_jammer=solution.null_jammer,
        value=value,
        upper_bound=bound,
        position_m=np.array(pose.position_m, dtype=float),
        roll_rad=pose.roll_rad,
        pitch_rad=pose.pitch_rad,
        yaw_rad=pose.yaw_rad,
        trees=tuple(
            Tree(axis=axis, root_m=proof.root, leaves=leaves_of(proof))
            for axis, proof in zip(fields, solution.proofs, strict=True)
        ),
        provenance=dict(solution.provenance),
    )


def verified(solution: Result, on_progress: Callable[[int, int], None] | None = None) -> Result:
    """Return a solution after the verifier has checked its certificate: its rigour is the verdict.

    It is ``verified``; or, should the verifier reject what the solver proved in floating point,
    ``floating-point`` with the verifier's reason.

    Args:
        solution: one with a proof.
        on_progress: called with the leaves checked and how many there are.

    Raises:
        UsageError: nothing was proved, or the scheme has no certificate for this scenario.
    """
    verdict = verify(certificate_of(solution), on_progress)
    rigour = Rigour.VERIFIED if verdict.proved else Rigour.FLOATING_POINT
    return replace(
        solution,
        objective=replace(solution.objective, rigour=rigour),
        reason=solution.reason if verdict.proved else f"its certificate is {verdict.message}",
    )


def _ratios(solution: Result) -> tuple[float, float]:
    """Return the smallest ratio of a solution's family at its pose, and the bound on it."""
    objective = solution.objective
    if not objective.quantity.is_rate:
        assert objective.upper_bound is not None
        return objective.value, objective.upper_bound
    pose = solution.pose
    axis = antenna_axis((pose.roll_rad, pose.pitch_rad, pose.yaw_rad), pose.mount_rad)
    value = float(smallest_ratio(build_family(solution.scenario), exact(pose.position_m), axis))
    return value, float(bound_above(value, max(proof.upper_bound for proof in solution.proofs)))


def leaves_of(proof: Proof) -> Leaves:
    """Return a proof's leaves with their boxes as dyadic parts of the root.

    Args:
        proof: with its root and leaves.
    """
    from nullpose.solve.kernels import node

    rows = proof.leaves
    low, high = proof.root
    half, centre = rows[:, node.HALF : node.HALF + 3], rows[:, node.CENTRE : node.CENTRE + 3]
    flat = high <= low
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = np.where(flat, 0, np.rint(np.log2(0.5 * (high - low) / half))).astype(np.int64)
        index = np.where(flat, 0, np.rint((centre - low) / (2.0 * half) - 0.5)).astype(np.int64)
    test = rows[:, node.KIND].astype(np.int64)
    ratios, weights = rows[:, node.INDEX : node.WEIGHT], rows[:, node.WEIGHT : node.BALL]
    table: dict[tuple[float, ...], int] = {}
    mixes: list[dict[int, float]] = []
    mix = np.full(len(rows), -1, dtype=np.int64)
    for i in np.flatnonzero(np.isin(test, (WORLD, TOWARDS, AFFINE))):
        used = int(rows[i, node.COUNT])
        key = (*ratios[i, :used], *weights[i, :used])
        if key not in table:
            table[key] = len(mixes)
            mixes.append({int(k): float(w) for k, w in zip(ratios[i, :used], weights[i, :used], strict=True)})
        mix[i] = table[key]
    point = np.where(np.isin(test, (WORLD, AFFINE, OFF_BAND)), -1, rows[:, node.ANCHOR])
    uses_ball = rows[:, node.NU] > 0.0
    is_free = np.isin(test, (WORLD, TOWARDS))
    return Leaves(
        box=np.stack([depth[:, 0], index[:, 0], depth[:, 1], index[:, 1], depth[:, 2], index[:, 2]], axis=1),
        cell=_cells(rows, node.FACE, node.CELL),
        test=test,
        point=point.astype(np.int64),
        level=rows[:, node.LEVEL].copy(),
        mix=mix,
        mixes=tuple(mixes),
        sides=np.where(rows[:, [node.FACE]] >= 0.0, rows[:, node.SIDE : node.SIDE + 2], 0.0),
        band=np.where(is_free, rows[:, node.BAND], 0.0),
        ball=np.where(uses_ball, rows[:, node.BALL], -1).astype(np.int64),
        ball_multiplier=np.where(uses_ball, rows[:, node.NU], 0.0),
    )


def _cells(rows: NDArray[np.float64], face: int, cell: int) -> NDArray[np.int64]:
    on_face = rows[:, face] >= 0.0
    out = np.zeros((len(rows), 5), dtype=np.int64)
    out[:, 0] = rows[:, face]
    for side in range(2):
        low, high = rows[:, cell + 2 * side], rows[:, cell + 2 * side + 1]
        width = np.where(on_face, high - low, 2.0)
        out[:, 1 + 2 * side] = np.rint(np.log2(2.0 / width))
        out[:, 2 + 2 * side] = np.where(on_face, np.rint((low + 1.0) / width), 0)
    return out
