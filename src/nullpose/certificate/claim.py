"""Whether a certificate's claim is one that its scenario admits, and its pose one that gives the value."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from nullpose.certificate.certificate import Certificate
from nullpose.certificate.channels import excess_at
from nullpose.certificate.pose_value import (
    Exact,
    antenna_axis,
    band_excess,
    body_axes,
    exact,
    field_offset,
    ratios_at,
    sine_cosine,
    value_of,
)
from nullpose.certificate.profile import profiles_of
from nullpose.certificate.weighted_sum import pairs_fit
from nullpose.objectives import Quantity
from nullpose.physics.types import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.family import Family
from nullpose.scenario import Airframe, Scenario

# The stated value may differ from the pose's by so much: it was rounded.
VALUE_RTOL = 1e-10

_EDGE_M = 1e-9  # a position on a keep-out ball may be off by rounding
_AXIS_RAD = 1e-6
_BAND_RAD = 1e-7  # the ends of a band are squares: their angle is known no better where it is small
_TILT_RAD = 1e-9
_MOST_RAD = 4.0


def claim_fault(certificate: Certificate, family: Family, fields: Mapping[str, AxisField] | None) -> str:
    """Find a reason why a certificate states nothing that can be proved; an empty string if there is none.

    Args:
        certificate: what it states.
        family: its scenario's ratios, at any instant if there are several.
        fields: the axis fields that its scheme needs a tree for, None if there are none.
    """
    if fields is None:
        with_jammer = f"with null jammer {certificate.null_jammer!r} " if certificate.null_jammer else ""
        return f"scheme {certificate.scheme!r} {with_jammer}has no certificate in this scenario"
    needed, named = sorted(fields), sorted(tree.axis for tree in certificate.trees)
    value, bound, listed = certificate.value, certificate.upper_bound, certificate.instants
    count = 0 if (time := certificate.scenario.time) is None else len(time.instants_s)
    is_mean = len(family.ratios.pairs) + len(family.ratios.shares) > 0
    has_pattern = not certificate.scenario.antenna_record.is_quadratic
    faults = {
        f"it must list instants of its scenario, each once: there are {count}": (
            bool(listed) != (count > 0) or sorted({*listed} & {*range(count)}) != sorted(listed)
        ),
        "a scene in motion has certificates for the smallest ratio of a dipole only": (
            count > 0 and (is_mean or has_pattern)
        ),
        "there are no certificates of robust poses": len(family.ratios.turn) > 0,
        "there are no certificates of scenes with buildings yet": len(family.ratios.shadow_sides) > 0,
        "antennas with a pattern have certificates in free space only": (
            len(family.ratios.channels) > 0 and has_pattern
        ),
        f"the objective {certificate.scenario.objective} has certificates for a dipole only": (
            is_mean and has_pattern
        ),
        "antennas with a pattern have certificates without dipoles on the ground only": (
            len(family.ratios.ground_axes) > 0 and has_pattern
        ),
        "its pairs of ratios are not those that have certificates": (
            len(family.ratios.pairs) > 0 and not pairs_fit(family.ratios)
        ),
        f"the scheme needs a tree for each of {needed}; there are {named}": needed != named,
        "value and bound must be positive and finite": not (value > 0.0 and math.isfinite(bound)),
        "the bound is below the value": bound < value,
    }
    return next((words for words, is_so in faults.items() if is_so), "")


def pose_fault(
    certificate: Certificate,
    scenes: Sequence[Scenario],
    families: Sequence[Family],
    fields: Mapping[str, AxisField],
) -> str:
    """Find a reason why a pose is not allowed or its value not the stated one; an empty string if none.

    Args:
        certificate: with pose and value.
        scenes: its scenario at every instant; a still one alone.
        families: the ratios of each.
        fields: the axis fields of its scheme.
    """
    attitude_rad = (certificate.roll_rad, certificate.pitch_rad, certificate.yaw_rad)
    airframe = certificate.scenario.airframe
    if any(not abs(angle) <= _MOST_RAD for angle in attitude_rad):
        return f"pose: an angle beyond {_MOST_RAD:g} rad"
    position = exact(certificate.position_m)
    axis = antenna_axis(attitude_rad, 0.0 if airframe is None else airframe.mount_rad)
    fault = (
        next(filter(None, (_place_fault(scene, certificate.position_m) for scene in scenes)), "")
        or _axis_fault(fields, position, axis)
        or _tilt_fault(airframe, attitude_rad)
    )
    if fault:
        return f"pose: {fault}"
    values = []
    for ratios in (family.ratios for family in families):
        reached = ratios_at(ratios, position, axis, *profiles_of(fields), gains=excess_at(ratios, position))
        least = exact(ratios.requirements) * (1 - Fraction(VALUE_RTOL))
        for k in np.flatnonzero(reached[: len(least)] < least):
            return f"pose: {certificate.scenario.nodes[k].name} misses its min_sinr_db"
        values.append(value_of(ratios, reached))
    value = min(values)
    if abs(value - Fraction(certificate.value)) > Fraction(VALUE_RTOL) * value:
        quantity = Quantity.of(certificate.scenario)
        kind = "mean" if quantity.whole else "smallest"
        what = f"{kind} ratio" if quantity.is_rate else quantity.smallest
        return f"pose: its {what} is {float(value):.15g}, not {certificate.value:.15g}"
    return ""


def _place_fault(scenario: Scenario, position_m: FloatArray) -> str:
    airspace = scenario.open_airspace
    outside = ~((airspace.lower_m <= position_m) & (position_m <= airspace.upper_m))
    for i in np.flatnonzero(outside):
        return f"{'xyz'[i]} = {float(position_m[i])!r} m is outside the airspace"
    if not airspace.allows(position_m):
        return "outside the geofence or in a no-fly zone, or within their margin_m"
    least = max(Fraction(airspace.keep_out_m) - Fraction(_EDGE_M), Fraction(0))
    for point in scenario.point_positions_m:
        offset = exact(point) - exact(position_m)
        if offset @ offset < least**2:
            return f"closer than keep_out_m to the ground point {point.tolist()}"
    return ""


def _tilt_fault(airframe: Airframe | None, attitude_rad: tuple[float, float, float]) -> str:
    if airframe is None or airframe.tilt_max_rad >= math.pi:
        return ""
    _, least = sine_cosine(Fraction(airframe.tilt_max_rad) + Fraction(_TILT_RAD))
    if body_axes(attitude_rad)[1][2] >= least:
        return ""
    return f"the vehicle tilts by more than {math.degrees(airframe.tilt_max_rad):.10g} degrees"


def _axis_fault(fields: Mapping[str, AxisField], position: Exact, axis: Exact) -> str:
    off = [field_offset(field, position, axis) for field in fields.values() if not field.is_free]
    missed = [band_excess(field.band, axis) for field in fields.values() if field.is_free]
    misses = {"the scheme allows": (off, _AXIS_RAD**2), "the airframe reaches": (missed, _BAND_RAD)}
    words = (who for who, (angles, most) in misses.items() if angles and min(angles) > most)
    return next((f"the antenna's axis is not one that {who}" for who in words), "")
