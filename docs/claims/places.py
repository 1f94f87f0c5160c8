"""Claims on places: where the null points, where the vertical antenna ends up, how far the nodes are."""

from __future__ import annotations

import math
from typing import Any

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
from nullpose.physics import received_power_w, to_db
from nullpose.problem.schemes import Scheme
from nullpose.report.geometry import axis_angle_rad, distance_m
from nullpose.report.numbers import rounded_up

POINTED_DEG = 1.0
ABOVE_M = 0.1
BETTER_DB = 1e-4

_ANGLE, _AWAY = "angle_between_null_and_jammer_deg", "horizontal_distance_m"

_GAIN, _VERTICAL = Scheme.MAXIMUM_GAIN, Scheme.VERTICAL


def null_at_jammer(study: JammingStudy) -> Measured:
    """Measure how far maximum gain's null is off the jammer as the jamming grows.

    Args:
        study: the data.
    """
    strongest = study.levels[-1]
    limit = study.holds_from(lambda level: _row(study, _GAIN, level)[_ANGLE] <= POINTED_DEG)
    rows = [_row(study, _GAIN, level) for level in (0.01, 0.1, 1.0, 10.0, 100.0, 1e3, 1e4, strongest)]
    place = ", ".join(f"{x:.2f}" for x in rows[-1]["position_m"])
    return {
        "holds": limit is not None,
        "finding": f"The null is within {POINTED_DEG:g} degree of the jammer from {level_words(limit)} on, "
        f"and {rows[-1][_ANGLE]:.2g} degrees off it at P_M/P = {strongest:g}, where the drone is at "
        f"({place}) m; along the line of the nodes the jammer is at y = "
        f"{study.scenario.jammer_positions_m[0, 1]:g} m.",
        "levels": rows,
        "proved": "At every level looked at, no pose of the case is better, by more than the gap, than the "
        "one whose angle is measured.",
        "holds_from": limit,
    }


def above_jammer(study: JammingStudy) -> Measured:
    """Measure how far, seen from above, the vertical antenna is from the jammer as the jamming grows.

    Args:
        study: the data.
    """
    limit = study.holds_from(lambda level: _row(study, _VERTICAL, level)[_AWAY] <= ABOVE_M)
    weakest, strongest = study.levels[0], study.levels[-1]
    before = max((level for level in study.levels if limit is None or level < limit), default=weakest)
    levels = sorted({weakest, 0.01, 0.1, before, 1.0, 10.0, 1000.0, strongest})
    rows = {level: _row(study, _VERTICAL, level) for level in levels}
    return {
        "holds": limit is not None,
        "finding": f"Within {ABOVE_M} m of the vertical above the jammer from {level_words(limit)} on, and "
        f"{rows[strongest][_AWAY]:.1g} m from it at P_M/P = {strongest:g}. It does not glide there: it is "
        f"{rows[weakest][_AWAY]:.1f} m from it at P_M/P = {weakest:g}, {rows[before][_AWAY]:.1f} m at "
        f"{before:.3g}, and then jumps.",
        "levels": list(rows.values()),
        "proved": "At every level looked at, no upright pose is better, by more than the gap, than the one "
        "whose distance is measured.",
        "holds_from": limit,
    }


def _row(study: JammingStudy, scheme: Scheme, level: float) -> dict[str, Any]:
    """Describe where a scheme's pose is at a level, seen from the jammer, and what it receives of it."""
    row = study.at(scheme, level)
    scenario, position_m = row.scenario, row.pose.position_m
    places_m, gain = scenario.jammer_positions_m, scenario.reference_gain
    received_w = received_power_w(
        position_m,
        row.pose.orientation(scenario.antenna_record),
        places_m,
        scenario.jammer_powers_w,
        gain,
        scenario.antenna_record,
        scenario.jammer_antennas,
    )
    return {
        RATIO: level,
        _ANGLE: math.degrees(axis_angle_rad(row.pose, places_m[0])),
        _AWAY: math.hypot(*(position_m - places_m[0])[:2]),
        "jamming_to_noise_db": float(to_db(received_w.sum() / scenario.receiver.noise_power_w)),
        "position_m": position_m.tolist(),
        "value_db": row.min_sinr_db,
    }


def equidistant(study: JammingStudy) -> Measured:
    """Measure how far the best maximum-gain position is ahead of the best equidistant one.

    Args:
        study: the data.
    """

    def ahead_db(level: float) -> float:
        return lead_of(study.at(_GAIN, level), study.equidistant_at(_GAIN, level)).found_db

    limit = study.holds_up_to(lambda level: ahead_db(level) <= BETTER_DB)
    failing = [level for level in study.levels if limit is None or level > limit]
    leads = [lead_of(study.at(_GAIN, x), study.equidistant_at(_GAIN, x)) for x in failing]
    proved_db = min((lead.least_db for lead in leads), default=0.0)
    levels = [
        _equidistant_row(study, level) for level in (0.1, 1.0, 1.4, 1.6, 3.0, 10.0, 1e3, study.levels[-1])
    ]
    three = levels[4]
    first_m, second_m = three["distances_m"]
    return {
        "holds": not failing,
        "finding": f"Equidistant up to {level_words(limit)} only. At P_M/P = 3 the best position is "
        f"{first_m:.1f} m and {second_m:.1f} m from the nodes and reaches {three['best_db']:.3f} dB; the "
        f"best equidistant one reaches {three['best_equidistant_db']:.3f} dB. With the axis of eq. 3.4 as "
        "printed, not normalised, the distances never differ by more than "
        f"{max(printed_apart_m(study), NOISE):.1g} m.",
        "levels": levels,
        "proved": "At P_M/P = 3 no equidistant position reaches more than "
        f"{rounded_up(bound_db(study.equidistant_at(_GAIN, 3.0)), 5)} dB, and the position found reaches "
        f"{at_least(three['best_db'], 5)} dB. At each of the {len(failing)} swept levels above "
        f"{limit or 0.0:.3g} the best position is ahead of every equidistant one by at least "
        f"{at_least(proved_db)} dB.",
        "holds_up_to": limit,
        "fails_from": (limit or failing[0]) if failing else None,
    }


def _equidistant_row(study: JammingStudy, level: float) -> dict[str, Any]:
    row, equal = study.at(_GAIN, level), study.equidistant_at(_GAIN, level)
    return {
        RATIO: level,
        "best_db": row.min_sinr_db,
        "position_m": row.pose.position_m.tolist(),
        "distances_m": [distance_m(row.pose, node_m) for node_m in study.scenario.node_positions_m],
        "best_equidistant_db": equal.min_sinr_db,
        "best_equidistant_position_m": equal.pose.position_m.tolist(),
    }
