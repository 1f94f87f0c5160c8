"""Claims on weak and on strong jamming: which of the two simple schemes is then the optimum."""

from __future__ import annotations

import math

import numpy as np

from nullpose.physics import Pose
from nullpose.report.claims.claim import Claim, Verdict
from nullpose.report.claims.study import JammingStudy, bound_db
from nullpose.report.numbers import at_least, at_most
from nullpose.schemes import Scheme

__all__ = ["strong_jamming", "weak_jamming", "zero_interference_constant"]

_COINCIDE_DB = 0.01
_CONSTANT_DB = 1e-6
_NOISE = 1e-9  # dB and m; what is smaller is rounding, and is told as at most this


def weak_jamming(study: JammingStudy) -> Claim:
    """Return the check that maximum gain coincides with the optimum under weak jamming.

    Args:
        study: the data.
    """
    weakest = study.levels[0]
    evidence, slope = _approach(
        study, Scheme.MAXIMUM_GAIN, (weakest, 10 * weakest, 100 * weakest, 1000 * weakest)
    )
    lag_db = study.lead_db(Scheme.OPTIMUM, Scheme.MAXIMUM_GAIN, weakest)
    limit = study.holds_up_to(
        lambda level: study.lead_db(Scheme.OPTIMUM, Scheme.MAXIMUM_GAIN, level) <= _COINCIDE_DB
    )
    end = f"up to P_M/P = {limit:.3g}" if limit is not None else "at no swept level"
    _, most_db = study.lead_range_db(Scheme.OPTIMUM, Scheme.MAXIMUM_GAIN, weakest)
    least_db, _ = study.lead_range_db(Scheme.OPTIMUM, Scheme.MAXIMUM_GAIN, 10 * weakest)
    return Claim(
        id="weak-jamming-maximum-gain",
        claim="When the jamming is weak, the maximum-gain solution is the optimum.",
        source="section 4",
        verdict=Verdict.of(lag_db <= _COINCIDE_DB, slope > 0.0),
        method=f"Optimum less maximum gain (axis normalised) in dB, at most {_COINCIDE_DB} dB at the weakest "
        "jamming swept and growing with the jamming; the level where it reaches that is bisected.",
        finding=f"At P_M/P = {weakest:g} maximum gain is {lag_db:.2g} dB below the optimum. It stays within "
        f"{_COINCIDE_DB} dB {end}; next to the weak end the shortfall grows as (P_M/P)^{slope:.2f}, so the "
        "two coincide exactly only in the limit.",
        evidence=evidence,
        proved=f"The true optimum exceeds true maximum gain by at most {at_most(most_db)} dB at P_M/P = "
        f"{weakest:g}, and by at least {at_least(least_db)} dB at {10 * weakest:g}: within "
        f"{_COINCIDE_DB} dB, and growing.",
        unproved="That the shortfall stays so small at the powers between those looked at; the level where "
        "it stops, a bisection between two of them; the exponent, taken from two values found.",
        holds_up_to=limit,
    )


def strong_jamming(study: JammingStudy) -> Claim:
    """Return the check that zero interference coincides with the optimum under strong jamming.

    Args:
        study: the data.
    """
    strongest = study.levels[-1]
    evidence, slope = _approach(study, Scheme.ZERO_INTERFERENCE, (1.0, 10.0, 100.0, 1000.0, strongest))
    lag_db = study.lead_db(Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, strongest)
    limit = study.holds_from(
        lambda level: study.lead_db(Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, level) <= _COINCIDE_DB
    )
    start = f"from P_M/P = {limit:.3g} on" if limit is not None else "at no swept level"
    _, most_db = study.lead_range_db(Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, strongest)
    return Claim(
        id="strong-jamming-zero-interference",
        claim="When the jamming is strong, the zero-interference solution is the optimum.",
        source="section 4",
        verdict=Verdict.of(lag_db <= _COINCIDE_DB, slope < 0.0),
        method=f"Optimum less zero interference in dB, at most {_COINCIDE_DB} dB at the strongest jamming "
        "swept and shrinking with the jamming; the level where it reaches that is bisected.",
        finding=f"At P_M/P = {strongest:g} zero interference is {max(lag_db, 0.0):.2g} dB below the "
        f"optimum. It is within {_COINCIDE_DB} dB {start}; between P_M/P = 1 and 10 the shortfall goes as "
        f"(P_M/P)^{slope:.2f}, so the two coincide exactly only in the limit.",
        evidence=evidence,
        proved=_strong_proved(study, limit, most_db),
        unproved="The exponent, taken from two values found; and any shortfall smaller than the gap of the "
        "proofs, which is that of the poses found.",
        holds_from=limit,
    )


def _strong_proved(study: JammingStudy, limit: float | None, most_db: float) -> str:
    end = f"The true shortfall is at most {at_most(most_db)} dB at P_M/P = {study.levels[-1]:g}"
    if limit is None:
        return end + "."
    _, at_limit_db = study.lead_range_db(Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, limit)
    return (
        f"{end}, and at most {at_most(at_limit_db, 5)} dB at every power from {limit:.3g} on, between the "
        "swept ones too: more jamming never raises the optimum, and does not touch zero interference."
    )


def _approach(study: JammingStudy, scheme: str, levels: tuple[float, ...]) -> tuple[dict[str, object], float]:
    """Return how far a scheme is from the optimum at some levels, and the exponent between the first two."""
    lags_db = [study.lead_db(Scheme.OPTIMUM, scheme, level) for level in levels]
    rows: list[dict[str, float]] = []
    for level, lag_db in zip(levels, lags_db, strict=True):
        best, other = study.at(Scheme.OPTIMUM, level), study.at(scheme, level)
        rows.append(
            {
                "jamming_to_transmission_ratio": level,
                "optimum_db": best.min_sinr_db,
                "scheme_db": other.min_sinr_db,
                "shortfall_db": lag_db,
                "positions_apart_m": float(np.linalg.norm(best.pose.position_m - other.pose.position_m)),
                "axes_apart_deg": _axes_apart_deg(best.pose, other.pose),
            }
        )
    slope = math.nan
    if lags_db[0] > 0.0 and lags_db[1] > 0.0:
        slope = math.log(lags_db[1] / lags_db[0]) / math.log(levels[1] / levels[0])
    return {"scheme": scheme, "exponent_of_the_shortfall": slope, "levels": rows}, slope


def _axes_apart_deg(first: Pose, second: Pose) -> float:
    across = float(np.linalg.norm(np.cross(first.antenna_axis, second.antenna_axis)))
    return math.degrees(math.atan2(across, abs(float(first.antenna_axis @ second.antenna_axis))))


def zero_interference_constant(study: JammingStudy) -> Claim:
    """Return the check that zero interference does not depend on the jamming power.

    Args:
        study: the data.
    """
    rows = study.curve(Scheme.ZERO_INTERFERENCE)
    sinrs_db = [row.min_sinr_db for row in rows]
    positions_m = np.array([row.pose.position_m for row in rows])
    spread_db = max(sinrs_db) - min(sinrs_db)
    spread_m = float(np.max(np.ptp(positions_m, axis=0)))
    return Claim(
        id="zero-interference-constant",
        claim="The zero-interference solution performs the same whatever the jamming power.",
        source="section 4",
        verdict=Verdict.of(spread_db <= _CONSTANT_DB),
        method="Largest less smallest value over all swept levels, each solved afresh, at most "
        f"{_CONSTANT_DB:g} dB.",
        finding=f"{sinrs_db[0]:.7f} dB at every one of {len(rows)} levels from P_M/P = {rows[0].value:g} "
        f"to {rows[-1].value:g}, within {max(spread_db, _NOISE):.1g} dB; the position moves by at most "
        f"{max(spread_m, _NOISE):.1g} m.",
        evidence={
            "min_db": min(sinrs_db),
            "max_db": max(sinrs_db),
            "spread_db": spread_db,
            "position_m": [float(x) for x in positions_m[0]],
            "position_spread_m": spread_m,
        },
        proved=f"The true values at the {len(rows)} levels differ by at most "
        f"{at_most(max(map(bound_db, rows)) - min(sinrs_db))} dB. That they do not differ at all, at any "
        "power, needs no solver: with the null on the only jammer its power drops out of the ratio "
        "(eq. 3.2).",
        unproved="That the position is the only best one: a bound is on the value, not on the place.",
    )
