"""From a proof to a certificate: the kernels' rows as the verifier's leaves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from nullpose.certificate import Certificate, Tree, claimed_axes, verify
from nullpose.certificate.pose_value import antenna_axis, exact, smallest_ratio
from nullpose.certificate.profile import profiles_of
from nullpose.errors import UsageError
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario
from nullpose.solver.branch_and_bound import MOST_LEAVES
from nullpose.solver.leaves_from_proof import leaves_of
from nullpose.solver.proof import MOST_HALVINGS
from nullpose.solver.result import Result
from nullpose.solver.rigour import Rigour, bound_above


def require_certificate(scenario: Scenario, scheme: str, null_jammer: str | None) -> Mapping[str, AxisField]:
    """Name the axis fields that a certificate of a scheme needs a tree for.

    Args:
        scenario: what is solved.
        scheme: the case.
        null_jammer: zero interference only: the jammer to be nulled, or None for any.

    Raises:
        UsageError: the scheme has no certificate for this scenario.
    """
    antenna = scenario.antenna_record
    if not antenna.is_axisymmetric:
        raise UsageError(
            f"certificate: a {antenna.label} has none: its gain changes round its axis, and its bound is "
            "proved in floating point; leave out --certificate and --verify"
        )
    fields = claimed_axes(scenario, scheme, null_jammer)
    if fields is None:
        raise UsageError(
            f"certificate: scheme {scheme} has none in this scenario: its bound is not a proof about its own "
            "axes; solve another scheme, or leave out --certificate and --verify"
        )
    return fields


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
    fields = require_certificate(solution.scenario, solution.scheme, solution.null_jammer)
    if solution.objective.upper_bound is None:
        raise UsageError("certificate: nothing was proved; leave out --fast (certify=False)")
    if not solution.proofs:
        few = solution.stats.boxes <= MOST_LEAVES  # then it is not for their number that there are no leaves
        what = f"halves boxes more than {MOST_HALVINGS} times" if few else "has too many leaves for one"
        raise UsageError(
            f"certificate: the proof {what}; ask for a wider --gap, or leave out --certificate and --verify"
        )
    pose = solution.pose
    value, bound = _ratios(solution, fields)
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
            Tree(axis=axis, root_m=proof.root, leaves=leaves_of(proof, axis))
            for axis, proof in zip(fields, solution.proofs, strict=True)
        ),
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
    rigour = Rigour.VERIFIED if verdict.proved else Rigour.FLOATING_POINT
    return replace(
        solution,
        objective=replace(solution.objective, rigour=rigour),
        reason=solution.reason if verdict.proved else f"its certificate is {verdict.message}",
    )


def _ratios(solution: Result, fields: Mapping[str, AxisField]) -> tuple[float, float]:
    """Evaluate the smallest ratio of a result's family at its pose, and the bound on it."""
    objective = solution.objective
    if not objective.quantity.is_rate:
        assert objective.upper_bound is not None
        return objective.value, objective.upper_bound
    pose = solution.pose
    axis = antenna_axis((pose.roll_rad, pose.pitch_rad, pose.yaw_rad), pose.mount_rad)
    family = build_family(solution.scenario, any_antenna=True)
    value = float(smallest_ratio(family, exact(pose.position_m), axis, *profiles_of(fields)))
    return value, float(bound_above(value, max(proof.upper_bound for proof in solution.proofs)))
