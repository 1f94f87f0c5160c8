"""All the claims, in the order of the paper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from nullpose.report.certainty import Certainty
from nullpose.report.claims.claim import Claim
from nullpose.report.claims.limits import (
    strong_jamming,
    weak_jamming,
    zero_interference_constant,
)
from nullpose.report.claims.maximum_gain import equidistant, null_at_jammer
from nullpose.report.claims.saturation import saturation
from nullpose.report.claims.study import JammingStudy
from nullpose.report.claims.vertical import above_jammer, pose_optimisation_wins
from nullpose.schemes import Scheme

__all__ = ["CLAIM_COUNT", "check_claims"]

_CHECKS: tuple[Callable[[JammingStudy], Claim], ...] = (
    weak_jamming,
    strong_jamming,
    zero_interference_constant,
    null_at_jammer,
    above_jammer,
    equidistant,
    pose_optimisation_wins,
    saturation,
)

_PRINTED = Scheme.MAXIMUM_GAIN_PRINTED  # nothing is ever proved of it, which the claims that use it say

CLAIM_COUNT = len(_CHECKS)
"""How many claims there are to check."""


def check_claims(
    study: JammingStudy, on_progress: Callable[[int, int], None] | None = None
) -> tuple[Claim, ...]:
    """Return every claim of the paper with its verdict, and what it rests on.

    Args:
        study: the data.
        on_progress: called after each claim with how many are checked and how many there are.
    """
    claims: list[Claim] = []
    for check in _CHECKS:
        study.forget_uses()
        claim = check(study)
        rows = [row for row in study.used if row.scheme != _PRINTED]
        claims.append(replace(claim, certainty=Certainty.of(rows)))
        if on_progress is not None:
            on_progress(len(claims), len(_CHECKS))
    return tuple(claims)
