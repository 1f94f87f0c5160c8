"""Claims on the maximum-gain solution: where its null points, and how far it is from the nodes."""

from __future__ import annotations

import math
from typing import Any

from nullpose.physics import received_power_w, to_db
from nullpose.report.claims.claim import Claim, Verdict
from nullpose.report.claims.equidistant import best_equidistant
from nullpose.report.claims.study import JammingStudy, bound_db, lead_range_db
from nullpose.report.geometry import distance_m, null_angle_rad
from nullpose.report.numbers import at_least, at_most
from nullpose.report.paper import with_jamming
from nullpose.schemes import Scheme

__all__ = ["equidistant", "null_at_jammer"]

_SCHEME = Scheme.MAXIMUM_GAIN
_POINTED_DEG = 1.0
_BETTER_DB = 1e-4
_NOISE_M = 1e-6  # what is smaller is told as at most this


def null_at_jammer(study: JammingStudy) -> Claim:
    """Return the check that under strong jamming maximum gain points its null at the jammer.

    Args:
        study: the data.
    """
    strongest = study.levels[-1]
    limit = study.holds_from(lambda level: _null_angle_deg(study, level) <= _POINTED_DEG)
    levels = (0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, strongest)
    last = _null_angle_deg(study, strongest)
    position_m = [float(x) for x in study.at(_SCHEME, strongest).pose.position_m]
    start = f"from P_M/P = {limit:.3g} on" if limit is not None else "at no swept level"
    return Claim(
        id="maximum-gain-null-at-jammer",
        claim="Under strong jamming the maximum-gain solution moves so that its null points at the jammer.",
        source="section 4",
        verdict=Verdict.of(limit is not None, last <= _POINTED_DEG),
        method="Angle between the antenna's axis and the direction to the jammer at the best "
        f"maximum-gain position (axis normalised), at most {_POINTED_DEG:g} degree at every swept level "
        "from some level on, bisected.",
        finding=f"The null is within {_POINTED_DEG:g} degree of the jammer {start}, and {last:.2g} "
        f"degrees off it at P_M/P = {strongest:g}, where the drone is at ({position_m[0]:.2f}, "
        f"{position_m[1]:.2f}, {position_m[2]:.2f}) m; along the line of the nodes the jammer is at y = "
        f"{study.scenario.jammer_positions_m[0][1]:g} m.",
        evidence={
            "levels": [
                {
                    "jamming_to_transmission_ratio": level,
                    "angle_between_null_and_jammer_deg": _null_angle_deg(study, level),
                    "jamming_to_noise_db": _jamming_to_noise_db(study, level),
                    "position_m": [float(x) for x in study.at(_SCHEME, level).pose.position_m],
                }
                for level in levels
            ]
        },
        proved="At every level looked at, no pose of the case is better, by more than the gap, than the one "
        "whose angle is measured.",
        unproved="The angles themselves, as a bound is on the value and not on the place: a pose elsewhere "
        "could come as near to it. The level from which they are so small, a bisection between two swept "
        "ones; and the powers between those looked at.",
        holds_from=limit,
    )


def _null_angle_deg(study: JammingStudy, level: float) -> float:
    return math.degrees(null_angle_rad(study.at(_SCHEME, level).pose, study.scenario.jammer_positions_m[0]))


def _jamming_to_noise_db(study: JammingStudy, level: float) -> float:
    scenario, pose = with_jamming(study.scenario, level), study.at(_SCHEME, level).pose
    received_w = received_power_w(
        pose.position_m,
        pose.antenna_axis,
        scenario.jammer_positions_m,
        scenario.jammer_powers_w,
        scenario.receiver.reference_gain,
    )
    return float(to_db(received_w.sum() / scenario.receiver.noise_power_w))


def equidistant(study: JammingStudy) -> Claim:
    """Return the check that the best maximum-gain position is equally far from both nodes.

    Args:
        study: the data.
    """
    limit = study.holds_up_to(lambda level: _advantage_db(study, level) <= _BETTER_DB)
    fails = limit is None or limit < study.levels[-1]
    levels = [_row(study, level) for level in (0.1, 1.0, 1.4, 1.6, 3.0, 10.0, 1e3, study.levels[-1])]
    three = _row(study, 3.0)
    printed = _printed_evidence(study)
    return Claim(
        id="maximum-gain-equidistant",
        claim="The best maximum-gain position is equally far from both nodes.",
        source="section 3.2",
        verdict=Verdict.of(not fails),
        method="The best maximum-gain value (axis normalised) against the best one on the plane halfway "
        "between the nodes, each solved with a proof: the claim fails where the former is higher by more "
        f"than {_BETTER_DB:g} dB. The level from which it is, is bisected.",
        finding=_equidistant_finding(limit, three, printed),
        evidence={"levels": levels, "as_printed": printed},
        proved=_equidistant_proved(study, limit),
        unproved="The level from which it fails, a bisection between two swept ones, and the powers between "
        "those looked at; and what is said of eq. 3.5 as printed, which is searched and not bounded.",
        holds_up_to=limit,
        fails_from=(study.levels[0] if limit is None else limit) if fails else None,
    )


def _equidistant_proved(study: JammingStudy, limit: float | None) -> str:
    best, equal = study.at(_SCHEME, 3.0), study.equidistant_at(3.0)
    words = (
        f"At P_M/P = 3 no equidistant position reaches more than {at_most(bound_db(equal), 5)} dB, and the "
        f"position found reaches {at_least(best.min_sinr_db, 5)} dB."
    )
    above = [level for level in study.levels if level > (limit or 0.0)]
    if not above:
        return words
    leads_db = [lead_range_db(study.at(_SCHEME, x), study.equidistant_at(x))[0] for x in above]
    return (
        f"{words} At each of the {len(above)} swept levels from {above[0]:.3g} on the best position is "
        f"ahead of every equidistant one by at least {at_least(min(leads_db))} dB."
    )


def _equidistant_finding(limit: float | None, three: dict[str, Any], printed: dict[str, float]) -> str:
    if limit is None:
        return "At no swept level is the best maximum-gain position equidistant."
    apart_m = printed["largest_distance_difference_m"]
    first, second = three["distances_m"]
    return (
        f"Equidistant up to P_M/P = {limit:.3f} only. At P_M/P = 3 the best position is {first:.1f} m and "
        f"{second:.1f} m from the nodes and reaches {three['best_db']:.3f} dB; the best equidistant one "
        f"reaches {three['best_equidistant_db']:.3f} dB. With the axis of eq. 3.4 as printed, not "
        f"normalised, the distances never differ by more than {max(apart_m, _NOISE_M):.1g} m."
    )


def _advantage_db(study: JammingStudy, level: float) -> float:
    return study.at(_SCHEME, level).min_sinr_db - study.equidistant_at(level).min_sinr_db


def _row(study: JammingStudy, level: float) -> dict[str, Any]:
    row, equal = study.at(_SCHEME, level), study.equidistant_at(level)
    return {
        "jamming_to_transmission_ratio": level,
        "best_db": row.min_sinr_db,
        "position_m": [float(x) for x in row.pose.position_m],
        "distances_m": [distance_m(row.pose, node) for node in study.scenario.node_positions_m],
        "best_equidistant_db": equal.min_sinr_db,
        "best_equidistant_position_m": [float(x) for x in equal.pose.position_m],
    }


def _printed_evidence(study: JammingStudy) -> dict[str, float]:
    """Return how far from equidistant, and from the best equidistant value, eq. 3.5 as printed ever is."""
    nodes = study.scenario.node_positions_m
    rows = study.curve(Scheme.MAXIMUM_GAIN_PRINTED)
    differences = [abs(distance_m(row.pose, nodes[0]) - distance_m(row.pose, nodes[1])) for row in rows]
    scenarios = [with_jamming(study.scenario, row.value) for row in rows]
    equal_db = [float(to_db(best_equidistant(each, as_printed=True)[1])) for each in scenarios]
    leads_db = [row.min_sinr_db - level_db for row, level_db in zip(rows, equal_db, strict=True)]
    return {
        "largest_distance_difference_m": max(differences),
        "largest_lead_over_equidistant_db": max(leads_db),
    }
