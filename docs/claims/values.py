"""Claims on values: which simple case comes near the optimum, what a case gains, where curves level out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from claims.study import (
    NOISE,
    RATIO,
    JammingStudy,
    Measured,
    at_least,
    bound_db,
    lead_of,
    level_words,
    printed_apart_m,
)
from nullpose.physics import Pose
from nullpose.physics.types import FloatArray
from nullpose.problem.schemes import Scheme
from nullpose.report.numbers import rounded_up

COINCIDE_DB = 0.01
CONSTANT_DB = 1e-6
SIGNIFICANT_DB = 1.0
FLAT_DB, NEAR_DB = 1e-3, 0.01
WEAK, STRONG = 0.01, 1.0  # P_M/P at most, at least

_OPTIMUM, _NULL, _GAIN, _VERTICAL = Scheme


def weak_jamming(study: JammingStudy) -> Measured:
    """Measure how near maximum gain is to the optimum under weak jamming.

    Args:
        study: the data.
    """
    weakest = study.levels[0]
    next_db = study.lead(_OPTIMUM, _GAIN, 10 * weakest).least_db
    limit = study.holds_up_to(lambda level: study.lead(_OPTIMUM, _GAIN, level).found_db <= COINCIDE_DB)
    measured = _approach(study, _GAIN, weakest, [weakest * 10**i for i in range(4)])
    return measured | {
        "finding": f"{measured['finding']} It stays within {COINCIDE_DB} dB up to {level_words(limit)}.",
        "proved": f"{measured['proved']}, and at least {at_least(next_db)} dB at {10 * weakest:g}: it grows.",
        "holds_up_to": limit,
    }


def strong_jamming(study: JammingStudy) -> Measured:
    """Measure how near zero interference is to the optimum under strong jamming.

    Args:
        study: the data.
    """
    strongest = study.levels[-1]
    limit = study.holds_from(lambda level: study.lead(_OPTIMUM, _NULL, level).found_db <= COINCIDE_DB)
    measured = _approach(study, _NULL, strongest, [1.0, 10.0, 100.0, 1000.0, strongest])
    most_db = study.lead(_OPTIMUM, _NULL, limit or strongest).most_db
    return measured | {
        "finding": f"{measured['finding']} It is within {COINCIDE_DB} dB from {level_words(limit)} on.",
        "proved": f"{measured['proved']}, and at most {rounded_up(most_db, 5)} dB at every power from "
        f"{limit or strongest:.3g} on, between the swept ones too: more jamming never raises the optimum, "
        "and does not touch zero interference.",
        "holds_from": limit,
    }


def _approach(study: JammingStudy, scheme: Scheme, end: float, levels: Sequence[float]) -> Measured:
    """Measure how far a scheme is from the optimum at some levels, and the exponent between the first two.

    It has to be near at one end, and nearer the closer to that end the first two levels are.
    """
    shortfalls_db = [study.lead(_OPTIMUM, scheme, level).found_db for level in levels]
    slope = math.nan
    if min(shortfalls_db[:2]) > 0.0:
        slope = math.log(shortfalls_db[1] / shortfalls_db[0]) / math.log(levels[1] / levels[0])
    rows = []
    for level, shortfall_db in zip(levels, shortfalls_db, strict=True):
        best, other = study.at(_OPTIMUM, level), study.at(scheme, level)
        rows.append(
            {
                RATIO: level,
                "optimum_db": best.min_sinr_db,
                "scheme_db": other.min_sinr_db,
                "shortfall_db": shortfall_db,
                "positions_apart_m": float(np.linalg.norm(best.pose.position_m - other.pose.position_m)),
                "axes_apart_deg": _axes_apart_deg(best.pose, other.pose),
            }
        )
    lead = study.lead(_OPTIMUM, scheme, end)
    towards = 1.0 if end <= levels[0] else -1.0
    return {
        "holds": lead.found_db <= COINCIDE_DB and slope * towards > 0.0,
        "finding": f"At P_M/P = {end:g} {scheme.label.lower()} is {max(lead.found_db, 0.0):.2g} dB below the "
        f"optimum. Between P_M/P = {levels[0]:g} and {levels[1]:g} the shortfall goes as "
        f"(P_M/P)^{slope:.2f}, so the two coincide exactly only in the limit.",
        "levels": rows,
        "proved": f"The true shortfall is at most {rounded_up(lead.most_db)} dB at P_M/P = {end:g}",
    }


def _axes_apart_deg(first: Pose, second: Pose) -> float:
    across = float(np.linalg.norm(np.cross(first.antenna_axis, second.antenna_axis)))
    return math.degrees(math.atan2(across, abs(float(first.antenna_axis @ second.antenna_axis))))


def zero_interference_constant(study: JammingStudy) -> Measured:
    """Measure how much zero interference changes over all jamming powers.

    Args:
        study: the data.
    """
    rows = study.curve(_NULL)
    sinrs_db = [row.min_sinr_db for row in rows]
    positions_m = np.array([row.pose.position_m for row in rows])
    spread_db = max(sinrs_db) - min(sinrs_db)
    spread_m = float(np.max(np.ptp(positions_m, axis=0)))
    most_db = max(map(bound_db, rows)) - min(sinrs_db)
    return {
        "holds": spread_db <= CONSTANT_DB,
        "finding": f"{sinrs_db[0]:.7f} dB at every one of {len(rows)} levels from P_M/P = {rows[0].value:g} "
        f"to {rows[-1].value:g}, within {max(spread_db, NOISE):.1g} dB; the position moves by at most "
        f"{max(spread_m, NOISE):.1g} m.",
        "proved": f"The true values at the {len(rows)} levels differ by at most {rounded_up(most_db)} dB. "
        "That they do not differ at all, at any power, needs no solver: with the null on the only jammer its "
        "power drops out of the ratio (eq. 3.2).",
    }


def pose_optimisation_wins(study: JammingStudy) -> Measured:
    """Measure how far the best pose is ahead of the best vertical one.

    Args:
        study: the data.
    """
    leads = {level: study.lead(_OPTIMUM, _VERTICAL, level) for level in study.levels}
    found_db: FloatArray = np.array([lead.found_db for lead in leads.values()])
    levels = np.array(study.levels)
    weak_db, strong_db = found_db[levels <= WEAK], found_db[levels >= STRONG]
    peak = int(np.argmax(found_db))
    limit = study.holds_from(lambda x: study.lead(_OPTIMUM, _VERTICAL, x).found_db >= SIGNIFICANT_DB)
    null_from = study.holds_from(lambda x: study.lead(_NULL, _VERTICAL, x).found_db >= 0.0)
    gain_from = study.holds_from(lambda x: study.lead(_GAIN, _VERTICAL, x).found_db >= 0.0)
    # between two levels the optimum is at least as good as at the upper, the vertical at most as at the lower
    between_db = min(
        lead_of(study.at(_OPTIMUM, b), study.at(_VERTICAL, a)).least_db for a, b in pairwise(levels)
    )
    least_db = min(lead.least_db for lead in leads.values())
    least_strong_db = min(lead.least_db for level, lead in leads.items() if level >= STRONG)
    proved = (
        f"The true lead is at least {at_least(least_db)} dB at every swept level, at least "
        f"{at_least(least_strong_db, 3)} dB at each from P_M/P = {STRONG:g} on, and, as more jamming never "
        f"raises either case, at least {at_least(between_db)} dB between the levels."
    )
    if null_from is not None:
        behind_db = max(-study.lead(_NULL, _VERTICAL, null_from).least_db, 0.0)
        proved += (
            f" From {level_words(null_from)} on, between the levels too, zero interference is ahead of the "
            f"vertical case, or behind by at most {rounded_up(behind_db)} dB: the one does not change, the "
            "other does not rise."
        )
    return {
        "holds": bool(found_db.min() > 0.0 and strong_db.min() >= max(SIGNIFICANT_DB, weak_db.max())),
        "finding": f"{found_db[0]:.2f} dB at P_M/P = {levels[0]:g}, at least {SIGNIFICANT_DB:g} dB from "
        f"{level_words(limit)} on, {found_db[-1]:.2f} dB at P_M/P = {levels[-1]:g}; the most, "
        f"{found_db[peak]:.2f} dB, is at P_M/P = {levels[peak]:.2g}. Zero interference is ahead of vertical "
        f"from {level_words(null_from)} on, maximum gain from {level_words(gain_from)} on.",
        "proved": proved,
    }


def saturation(study: JammingStudy) -> Measured:
    """Measure how flat the four curves are under strong jamming.

    Args:
        study: the data.
    """
    strongest = study.levels[-1]
    ends = {scheme: _end(study, scheme) for scheme in Scheme}
    starts = [start for _, start in ends.values()]
    values = ", ".join(f"{scheme} {study.at(scheme, strongest).min_sinr_db:.4f} dB" for scheme in Scheme)
    printed_db = study.printed_at(strongest).min_sinr_db
    fall_db = printed_db - study.printed_at(strongest / 10.0).min_sinr_db
    unequal_m = printed_apart_m(study)
    falls_db = [
        lead_of(study.at(scheme, strongest / 10.0), study.at(scheme, strongest)).most_db for scheme in Scheme
    ]
    return {
        "holds": all(abs(change_db) <= FLAT_DB for change_db, _ in ends.values()),
        "finding": f"At P_M/P = {strongest:g}: {values}. Eq. 3.5 as printed, its axis not normalised, "
        f"comes to {printed_db:.4f} dB and changes by {fall_db:.2f} dB over the last decade, its "
        f"position staying equidistant from the nodes to {max(unequal_m, NOISE):.1g} m.",
        "proved": f"Over the last decade no curve changes by more than {rounded_up(max(falls_db))} dB, "
        "between the swept levels either, as more jamming never raises a curve. For the same reason each, "
        f"once within {NEAR_DB} dB of its last value, stays there, but for the gap of the proofs.",
        "holds_from": None if None in starts else max(starts),
    }


def _end(study: JammingStudy, scheme: Scheme) -> tuple[float, float | None]:
    """Find a curve's change over the last decade, dB, and from where it stays at its end if it does."""
    strongest = study.levels[-1]
    last_db = study.at(scheme, strongest).min_sinr_db
    change_db = last_db - study.at(scheme, strongest / 10.0).min_sinr_db
    if abs(change_db) > FLAT_DB:
        return change_db, None
    return change_db, study.holds_from(
        lambda level: abs(study.at(scheme, level).min_sinr_db - last_db) <= NEAR_DB
    )
