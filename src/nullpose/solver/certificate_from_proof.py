"""From a proof to a certificate: the kernels' rows as the verifier's leaves."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from nullpose.certificate import Certificate, Leaves, Tree, claimed_axes, verify
from nullpose.certificate.certificate import AFFINE, OFF_BAND, PROFILE, TOWARDS, WORLD
from nullpose.certificate.channels import excess_at
from nullpose.certificate.pose_value import antenna_axis, exact, ratios_at, value_of
from nullpose.certificate.profile import ProfileField, profiles_of
from nullpose.errors import UsageError, checked, require_usage
from nullpose.objectives.ratios import IntArray
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family, join_instants, still_scenes
from nullpose.problem.schemes import Scheme
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import MOST_LEAVES
from nullpose.solver.hover import HoverDetails
from nullpose.solver.proof import MOST_HALVINGS, Proof
from nullpose.solver.result import Result
from nullpose.solver.rigour import Rigour, bound_above


def leaves_of(proof: Proof, field: AxisField, family: Family) -> Leaves:
    """Convert a proof's leaves, their boxes as dyadic parts of the root.

    Args:
        proof: with its root and leaves.
        field: its axes.
        family: the ratios.
    """
    return _of_profile(proof, field) if isinstance(field, ProfileField) else _of_dipole(proof, family)


def _of_dipole(proof: Proof, family: Family) -> Leaves:
    from nullpose.solver.kernels.bounds import node
    from nullpose.solver.kernels.bounds.signed_sum import fill_tangents, fill_touched

    rows = proof.leaves
    test = rows[:, node.KIND].astype(np.int64)
    ratios, weights = rows[:, node.INDEX : node.WEIGHT].astype(np.int64), rows[:, node.WEIGHT : node.TOUCH]
    has_mix, count = np.isin(test, (WORLD, TOWARDS, AFFINE)), rows[:, node.COUNT].astype(np.int64)
    if size := len(family.ratios.shares) or len(family.ratios.pairs):
        tangents, listed = np.zeros((2, len(rows), size))
        (fill_tangents if len(family.ratios.shares) else fill_touched)(family.ratios, rows, tangents)
        used = np.arange(node.SUPPORT) < count[:, None]
        listed[np.nonzero(used)[0], ratios[used]] = weights[used]
        # the numbers of requirements follow those of the ratios, those of tangents follow the pairs'
        both = [tangents, listed] if len(family.ratios.shares) else [listed, tangents * (listed > 0.0)]
        ratios, weights, count = _order_multipliers(np.hstack(both))
    mix, mixes = _mixes(ratios, weights, np.where(has_mix, count, 0))
    point = np.where(np.isin(test, (WORLD, AFFINE, OFF_BAND)), -1, rows[:, node.ANCHOR])
    uses_ball = rows[:, node.NU] > 0.0
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
        band=np.where(np.isin(test, (WORLD, TOWARDS)), rows[:, node.BAND], 0.0),
        ball=np.where(uses_ball, rows[:, node.BALL], -1).astype(np.int64),
        ball_multiplier=np.where(uses_ball, rows[:, node.NU], 0.0),
    )


def _of_profile(proof: Proof, field: ProfileField) -> Leaves:
    """Convert leaves of an antenna that is the same all round; they all hold at the bound."""
    from nullpose.solver.kernels.bounds.attitude import ANCHOR, BAND, CHART, HALF, WARM

    rows = proof.leaves
    low, high = math.pi * field.spans[(rows[:, ANCHOR] < 0.0).astype(np.int64)].transpose(2, 0, 1)
    turned = _parts(low, high, rows[:, [3, 5]], rows[:, [HALF + 3, HALF + 5]])
    mix, mixes = _mixes(*_order_multipliers(rows[:, WARM:]))
    return Leaves(
        box=_parts(proof.root[0], proof.root[1], rows[:, :3], rows[:, HALF : HALF + 3]),
        cell=np.concatenate([rows[:, [CHART]].astype(np.int64), turned], axis=1),
        test=np.full(len(rows), PROFILE),
        point=rows[:, ANCHOR].astype(np.int64),
        level=np.full(len(rows), proof.upper_bound),
        mix=mix,
        mixes=mixes,
        sides=np.zeros((len(rows), 2)),
        band=rows[:, BAND].copy(),
        ball=np.full(len(rows), -1),
        ball_multiplier=np.zeros(len(rows)),
    )


def _order_multipliers(weights: FloatArray) -> tuple[IntArray, FloatArray, IntArray]:
    """Order multipliers, (l, n), so that those that count come first; return which they are and how many."""
    order = np.argsort(weights <= 0.0, axis=1, kind="stable")
    return order, np.take_along_axis(weights, order, axis=1), np.maximum(1, np.sum(weights > 0.0, axis=1))


def _parts(low: FloatArray, high: FloatArray, centre: FloatArray, half: FloatArray) -> IntArray:
    """Locate boxes by depth and index along each coordinate in turn, (l, 2 n)."""
    flat = (high <= low) | (half == 0.0)
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
    table: dict[tuple[tuple[int, float], ...], int] = {}
    mix = np.full(len(used), -1, dtype=np.int64)
    for i in np.flatnonzero(used):
        of, by = ratios[i, : used[i]].tolist(), weights[i, : used[i]].tolist()
        mix[i] = table.setdefault(tuple(zip(of, by, strict=True)), len(table))
    return mix, tuple(map(dict, table))


def _cells(rows: FloatArray, face: int, cell: int) -> IntArray:
    """Locate cells of axes by their face, and depth and index along each side; the whole cube is face -1."""
    on_face = rows[:, [face]] >= 0.0
    low = np.where(on_face, rows[:, [cell, cell + 2]], -1.0)
    high = np.where(on_face, rows[:, [cell + 1, cell + 3]], 1.0)
    sides = _parts(-np.ones(2), np.ones(2), 0.5 * (low + high), 0.5 * (high - low))
    return np.concatenate([rows[:, [face]].astype(np.int64), sides], axis=1)


def require_certificate(scenario: Scenario, scheme: str, null_jammer: str | None) -> Mapping[str, AxisField]:
    """Name the axis fields that a certificate of a scheme needs a tree for.

    Args:
        scenario: what is solved.
        scheme: the case.
        null_jammer: zero interference only: the jammer to be nulled, or None for any.

    Raises:
        UsageError: the scheme has no certificate for this scenario.
    """
    require_usage(
        scenario.prisms is None
        and not scenario.has_custom_channels
        and scenario.objective_record.of_nodes is None,
        "certificate: buildings, and channels and objectives that are a function in Python, have none: they "
        "are proved in floating point or not at all; leave out --certificate and --verify",
    )
    antenna = scenario.antenna_record
    require_usage(
        antenna.is_quadratic or not scenario.has_channels,
        f"certificate: a {antenna.label} has one in free space only: in other channels its bound is "
        "proved in floating point; leave out --certificate and --verify",
    )
    require_usage(
        antenna.is_axisymmetric,
        f"certificate: a {antenna.label} has none: its gain changes round its axis, and its bound is "
        "proved in floating point; leave out --certificate and --verify",
    )
    if (fields := claimed_axes(scenario, scheme, null_jammer)) is None:
        raise UsageError(
            f"certificate: scheme {scheme} has none in this scenario: its bound is not a proof about its own "
            "axes; solve another scheme, or leave out --certificate and --verify"
        )
    return fields


@checked
def certificate_of(solution: Result) -> Certificate:
    """Write the certificate of a result: everything that a verifier needs to check its bound.

    Args:
        solution: one with a proof.

    Raises:
        UsageError: nothing was proved, or the scheme has no certificate for this scenario.

    Example:
        >>> import nullpose
        >>> result = nullpose.solve(nullpose.load("examples/paper.toml"))
        >>> nullpose.verify(nullpose.certificate_of(result)).proved
        True
    """
    details, scenario, scheme = solution.details, solution.scenario, str(solution.scheme)
    instants: tuple[int, ...] = ()
    if isinstance(details, HoverDetails):  # the optimum of a scene in motion
        scenario, scheme, instants = details.scene, Scheme.OPTIMUM.value, details.instants
    fields = require_certificate(scenario, scheme, solution.null_jammer)
    require_usage(
        solution.objective.upper_bound is not None,
        "certificate: nothing was proved; leave out --fast (certify=False)",
    )
    if not solution.proofs:
        few = solution.stats.boxes <= MOST_LEAVES  # then it is not for their number that there are no leaves
        what = f"halves boxes more than {MOST_HALVINGS} times" if few else "has too many leaves for one"
        raise UsageError(
            f"certificate: the proof {what}; ask for a wider --gap, or leave out --certificate and --verify"
        )
    pose = solution.pose
    families = [
        build_family(scene, any_antenna=True, any_channel=True, any_objective=True)
        for scene in still_scenes(scenario)
    ]
    value, bound = _ratios(solution, families, fields)
    family = join_instants(families, instants) if instants else families[0]
    return Certificate(
        scenario=scenario,
        scheme=scheme,
        null_jammer=solution.null_jammer,
        value=value,
        upper_bound=bound,
        position_m=np.array(pose.position_m, dtype=float),
        roll_rad=pose.roll_rad,
        pitch_rad=pose.pitch_rad,
        yaw_rad=pose.yaw_rad,
        trees=tuple(
            Tree(axis=axis, root_m=proof.root, leaves=leaves_of(proof, field, family))
            for (axis, field), proof in zip(fields.items(), solution.proofs, strict=True)
        ),
        instants=instants,
        provenance=dict(solution.provenance),
    )


def verified(solution: Result, on_progress: Callable[[int, int], None] | None = None) -> Result:
    """Check a result's certificate by the verifier: its rigour is the verdict.

    It is ``verified``; or, should the verifier reject what the solver proved in floating point,
    ``floating-point`` with the verifier's reason.

    Args:
        solution: one with a proof.
        on_progress: called with the leaves checked and how many there are.

    Raises:
        UsageError: nothing was proved, or the scheme has no certificate for this scenario.
    """
    verdict = verify(certificate_of(solution), on_progress)
    return replace(
        solution,
        objective=replace(
            solution.objective, rigour=Rigour.VERIFIED if verdict.proved else Rigour.FLOATING_POINT
        ),
        reason=solution.reason if verdict.proved else f"its certificate is {verdict.message}",
    )


def _ratios(
    solution: Result, families: Sequence[Family], fields: Mapping[str, AxisField]
) -> tuple[float, float]:
    """Evaluate the smallest ratio of a result's families at its pose, and the bound on it."""
    if not (objective := solution.objective).quantity.is_rate:
        assert objective.upper_bound is not None
        return objective.value, objective.upper_bound
    pose = solution.pose
    axis = antenna_axis((pose.roll_rad, pose.pitch_rad, pose.yaw_rad), pose.mount_rad)
    place = exact(pose.position_m)
    value, profiles = math.inf, profiles_of(fields)
    for ratios in (family.ratios for family in families):
        reached = ratios_at(ratios, place, axis, *profiles, gains=excess_at(ratios, place))
        value = min(value, float(value_of(ratios, reached)))
    return value, float(bound_above(value, max(proof.upper_bound for proof in solution.proofs)))
