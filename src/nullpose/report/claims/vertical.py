"""Claims on the vehicle that cannot tilt: where it ends up, and what tilting gains."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from nullpose.report.claims.claim import Claim, Verdict
from nullpose.report.claims.study import JammingStudy, lead_range_db
from nullpose.report.numbers import at_least, at_most
from nullpose.schemes import Scheme

__all__ = ["above_jammer", "pose_optimisation_wins"]

_ABOVE_M = 0.1
_SIGNIFICANT_DB = 1.0
_WEAK, _STRONG = 0.01, 1.0  # P_M/P at most, at least


def above_jammer(study: JammingStudy) -> Claim:
    """Return the check that the vertical antenna ends up straight above the jammer.

    Args:
        study: the data.
    """
    limit = study.holds_from(lambda level: _offset_m(study, level) <= _ABOVE_M)
    weakest, strongest = study.levels[0], study.levels[-1]
    before = [level for level in study.levels if limit is None or level < limit] or [weakest]
    levels = sorted({weakest, 0.01, 0.1, before[-1], 1.0, 10.0, 1000.0, strongest})
    start = f"from P_M/P = {limit:.3g} on" if limit is not None else "at no swept level"
    first_m, last_m = _offset_m(study, weakest), _offset_m(study, before[-1])
    way = "backs away from it" if last_m > first_m else "comes nearer"
    return Claim(
        id="vertical-above-jammer",
        claim="The vertical solution moves until it is directly above the jammer.",
        source="section 4",
        verdict=Verdict.of(limit is not None),
        method=f"Horizontal distance from the jammer, at most {_ABOVE_M} m at every swept level from some "
        "level on, bisected.",
        finding=f"Within {_ABOVE_M} m of the vertical above the jammer {start}, and "
        f"{_offset_m(study, strongest):.1g} m from it at P_M/P = {strongest:g}. It does not glide there: "
        f"as the jamming grows it first {way}, from {first_m:.1f} m at P_M/P = {weakest:g} to "
        f"{last_m:.1f} m at {before[-1]:.3g}, and then jumps.",
        evidence={
            "levels": [
                {
                    "jamming_to_transmission_ratio": level,
                    "horizontal_distance_m": _offset_m(study, level),
                    "position_m": [float(x) for x in study.at(Scheme.VERTICAL, level).pose.position_m],
                    "value_db": study.at(Scheme.VERTICAL, level).min_sinr_db,
                }
                for level in levels
            ]
        },
        proved="At every level looked at, no upright pose is better, by more than the gap, than the one "
        "whose distance is measured.",
        unproved="The distances themselves, as a bound is on the value and not on the place. The level of "
        "the jump, a bisection between two swept ones; and the powers between those looked at.",
        holds_from=limit,
    )


def _offset_m(study: JammingStudy, level: float) -> float:
    away = study.at(Scheme.VERTICAL, level).pose.position_m - study.scenario.jammer_positions_m[0]
    return math.hypot(float(away[0]), float(away[1]))


def pose_optimisation_wins(study: JammingStudy) -> Claim:
    """Return the check that the best pose beats the best vertical one, most under strong jamming.

    Args:
        study: the data.
    """
    leads_db = np.array([study.lead_db(Scheme.OPTIMUM, Scheme.VERTICAL, level) for level in study.levels])
    levels = np.array(study.levels)
    weak_db, strong_db = leads_db[levels <= _WEAK], leads_db[levels >= _STRONG]
    peak = int(np.argmax(leads_db))
    limit = study.holds_from(
        lambda level: study.lead_db(Scheme.OPTIMUM, Scheme.VERTICAL, level) >= _SIGNIFICANT_DB
    )
    zero_from = study.holds_from(
        lambda level: study.lead_db(Scheme.ZERO_INTERFERENCE, Scheme.VERTICAL, level) >= 0.0
    )
    gain_from = study.holds_from(
        lambda level: study.lead_db(Scheme.MAXIMUM_GAIN, Scheme.VERTICAL, level) >= 0.0
    )
    start = f"from P_M/P = {limit:.3g} on" if limit is not None else "at no swept level"
    return Claim(
        id="pose-optimisation-wins",
        claim="Optimising the full pose beats the under-actuated vehicle significantly, most under "
        "strong jamming.",
        source="section 4",
        verdict=Verdict.of(
            bool(np.all(leads_db > 0.0)),
            bool(np.min(strong_db) >= _SIGNIFICANT_DB),
            bool(np.min(strong_db) > np.max(weak_db)),
        ),
        method=f"Optimum less vertical in dB: above 0 everywhere, at least {_SIGNIFICANT_DB:g} dB wherever "
        f"P_M/P >= {_STRONG:g}, and there everywhere more than anywhere below P_M/P = {_WEAK:g}.",
        finding=f"{leads_db[0]:.2f} dB at P_M/P = {levels[0]:g}, at least {_SIGNIFICANT_DB:g} dB {start}, "
        f"{leads_db[-1]:.2f} dB at P_M/P = {levels[-1]:g}; the most, {leads_db[peak]:.2f} dB, is at P_M/P "
        f"= {levels[peak]:.2g}. Of the two simple schemes, "
        f"{_ahead('zero interference', zero_from, levels[0])} and "
        f"{_ahead('maximum gain', gain_from, levels[0])}.",
        evidence={
            "lead_at_weakest_db": float(leads_db[0]),
            "lead_at_strongest_db": float(leads_db[-1]),
            "largest_lead_db": float(leads_db[peak]),
            "largest_lead_at": float(levels[peak]),
            "smallest_lead_db": float(np.min(leads_db)),
            "smallest_lead_under_strong_jamming_db": float(np.min(strong_db)),
            "largest_lead_under_weak_jamming_db": float(np.max(weak_db)),
            "at_least_1_db_from": limit,
            "zero_interference_ahead_from": zero_from,
            "maximum_gain_ahead_from": gain_from,
        },
        proved=_lead_proved(study, zero_from),
        unproved="The levels from which something holds, each a bisection between two swept ones; that the "
        f"lead of {_SIGNIFICANT_DB:g} dB, and maximum gain's over vertical, are kept at the powers between "
        "those looked at.",
    )


def _lead_proved(study: JammingStudy, zero_from: float | None) -> str:
    """Return what the bounds show of the lead over the vertical case, at the swept powers and between."""
    leads_db = {
        level: study.lead_range_db(Scheme.OPTIMUM, Scheme.VERTICAL, level)[0] for level in study.levels
    }
    strong_db = min(lead_db for level, lead_db in leads_db.items() if level >= _STRONG)
    words = (
        f"The true lead is at least {at_least(min(leads_db.values()))} dB at every swept level, and at least "
        f"{at_least(strong_db, 3)} dB at each from P_M/P = {_STRONG:g} on."
    )
    # between two levels the optimum is at least as good as at the upper, the vertical at most as at the lower
    between_db = min(
        lead_range_db(study.at(Scheme.OPTIMUM, upper), study.at(Scheme.VERTICAL, lower))[0]
        for lower, upper in pairwise(study.levels)
    )
    if between_db > 0.0:
        words += (
            " More jamming never raises either case, so between the levels it is at least "
            f"{at_least(between_db)} dB."
        )
    if zero_from is not None:
        least_db, _ = study.lead_range_db(Scheme.ZERO_INTERFERENCE, Scheme.VERTICAL, zero_from)
        behind = "" if least_db >= 0.0 else f", or behind by at most {at_most(-least_db)} dB"
        words += (
            f" From P_M/P = {zero_from:.3g} on, between the levels too, zero interference is ahead of the "
            f"vertical case{behind}: the one does not change, the other does not rise."
        )
    return words


def _ahead(name: str, start: float | None, weakest: float) -> str:
    if start is None:
        return f"{name} is not ahead of vertical at the strongest jamming"
    if start <= weakest:
        return f"{name} is ahead of vertical throughout"
    return f"{name} is ahead of vertical only from P_M/P = {start:.3g} on"
