"""The claim that every solution saturates as the jamming grows."""

from __future__ import annotations

import math

from nullpose.report.claims.claim import Claim, Verdict
from nullpose.report.claims.study import JammingStudy, lead_range_db
from nullpose.report.geometry import distance_m
from nullpose.report.numbers import at_most
from nullpose.schemes import Scheme

__all__ = ["saturation"]

_SCHEMES = (Scheme.OPTIMUM, Scheme.ZERO_INTERFERENCE, Scheme.MAXIMUM_GAIN, Scheme.VERTICAL)
_PRINTED = Scheme.MAXIMUM_GAIN_PRINTED
_FLAT_DB = 1e-3
_NEAR_DB = 0.01


def saturation(study: JammingStudy) -> Claim:
    """Return the check that all four curves flatten out under strong jamming.

    Args:
        study: the data.
    """
    evidence = {scheme: _end(study, scheme) for scheme in (*_SCHEMES, _PRINTED)}
    starts = [start for scheme in _SCHEMES if (start := evidence[scheme]["within_0.01_db_from"]) is not None]
    falls_db = evidence[_PRINTED]["change_over_last_decade_db"] or math.nan
    ends = ", ".join(f"{scheme} {evidence[scheme]['value_at_strongest_db']:.4f} dB" for scheme in _SCHEMES)
    nodes = study.scenario.node_positions_m
    apart_m = max(
        abs(distance_m(row.pose, nodes[0]) - distance_m(row.pose, nodes[1])) for row in study.curve(_PRINTED)
    )
    return Claim(
        id="saturation-of-all-solutions",
        claim="All solutions saturate as the jamming grows stronger.",
        source="section 4",
        verdict=Verdict.of(
            *(abs(evidence[scheme]["change_over_last_decade_db"] or 0.0) <= _FLAT_DB for scheme in _SCHEMES)
        ),
        method=f"Change of each curve over the last decade of P_M/P, at most {_FLAT_DB:g} dB; maximum "
        f"gain with the axis normalised. Saturation is dated from where the curve stays within {_NEAR_DB} "
        "dB of its last value.",
        finding=f"At P_M/P = {study.levels[-1]:g}: {ends}. Eq. 3.5 as printed, its axis not normalised, "
        f"{'saturates too' if abs(falls_db) <= _FLAT_DB else 'never saturates'}: it changes by "
        f"{falls_db:.2f} dB over the last decade, its position staying equidistant from the nodes to "
        f"{max(apart_m, 1e-9):.1g} m.",
        evidence={
            **{scheme.value: end for scheme, end in evidence.items()},
            "printed_form_largest_distance_difference_m": apart_m,
        },
        proved=_flatness_proved(study),
        unproved="What lies beyond the strongest jamming swept, but for the optimum and zero interference; "
        "what is said of eq. 3.5 as printed, which is searched and not bounded.",
        holds_from=max(starts) if len(starts) == len(_SCHEMES) else None,
    )


def _end(study: JammingStudy, scheme: str) -> dict[str, float | None]:
    strongest = study.levels[-1]
    last_db = study.at(scheme, strongest).min_sinr_db
    change_db = last_db - study.at(scheme, strongest / 10.0).min_sinr_db
    start = None
    if abs(change_db) <= _FLAT_DB:
        start = study.holds_from(lambda level: abs(study.at(scheme, level).min_sinr_db - last_db) <= _NEAR_DB)
    return {
        "value_at_strongest_db": last_db,
        "change_over_last_decade_db": change_db,
        "within_0.01_db_from": start,
    }


def _flatness_proved(study: JammingStudy) -> str:
    strongest = study.levels[-1]
    falls_db = [
        lead_range_db(study.at(scheme, strongest / 10.0), study.at(scheme, strongest))[1]
        for scheme in _SCHEMES
    ]
    return (
        f"Over the last decade no curve changes by more than {at_most(max(falls_db))} dB, between the swept "
        "levels either, as more jamming never raises a curve. For the same reason each, once within "
        f"{_NEAR_DB} dB of its last value, stays there, but for the gap of the proofs."
    )
