"""Parts of a scenario, and what becomes of its requirements, in words."""

from __future__ import annotations

import math

from nullpose.physics import Geodetic
from nullpose.report.numbers import count_of
from nullpose.scenario import Airframe, Array, Eavesdropper, Jammer, Origin, Scenario
from nullpose.solver import Result


def airframe_words(airframe: Airframe, tilt_rad: float | None = None) -> str:
    """Return what an airframe can do, as in ``tilts at most 10 deg; dipole 90 deg from upright on the body``.

    Args:
        airframe: how far it tilts and how the dipole is mounted.
        tilt_rad: how far it is tilted, radians, if that is to be told.
    """
    limit = "without limit"
    if airframe.tilt_max_rad < math.pi:
        limit = f"at most {_degrees(airframe.tilt_max_rad)} deg"
    used = "tilts" if tilt_rad is None else f"tilted by {abs(math.degrees(tilt_rad)):.3f} deg,"
    named = f"{airframe.preset}: " if airframe.preset else ""
    return f"{named}{used} {limit}; dipole {airframe.mount_deg:g} deg from upright on the body"


def reach_words(airframe: Airframe | None) -> str:
    """Return which antenna axes an airframe reaches, as angles from the vertical.

    Args:
        airframe: how far it tilts and how the dipole is mounted; None for one that reaches every axis.
    """
    low, high = (0.0, 1.0) if airframe is None else airframe.axis_band
    if (low, high) == (0.0, 1.0):
        return "any axis direction"
    least, greatest = (_degrees(math.acos(math.sqrt(cosine_squared))) for cosine_squared in (high, low))
    return f"axes {least} to {greatest} deg from the vertical"


def array_words(array: Array) -> str:
    """Return an array in words, as in ``4 upright dipoles, linear, 0.5 wavelengths apart``.

    Args:
        array: the dipoles.
    """
    dipoles = count_of(array.elements, "upright dipole")
    return f"{dipoles}, {array.layout}, {array.spacing_wavelengths:g} wavelengths apart"


def place_words(place: Geodetic | Origin) -> str:
    """Return a place on the Earth in words, to about a millimetre.

    Args:
        place: latitude, longitude and altitude over the ellipsoid, the sea or both.
    """
    over = {"the WGS-84 ellipsoid": place.alt_m, "the sea": place.alt_msl_m}
    told = [f"{alt_m:z.3f} m over {what}" for what, alt_m in over.items() if alt_m is not None]
    return f"lat {place.lat_deg:z.8f} deg, lon {place.lon_deg:z.8f} deg, alt {', '.join(told)}"


def error_words(scenario: Scenario) -> str:
    """Return the errors that a scenario states, in words, as in ``axis 2 deg, M up to 3 m``.

    Args:
        scenario: with its errors.
    """
    receiver = scenario.receiver
    errors = {
        f"axis {receiver.attitude_error_deg:g} deg": receiver.attitude_error_deg,
        f"position {receiver.position_error_m:g} m": receiver.position_error_m,
    }
    hidden: list[Jammer | Eavesdropper] = [*scenario.jammers, *scenario.eavesdroppers]
    for point in hidden:
        errors[f"{point.name} up to {point.uncertainty_reach_m:g} m"] = point.uncertainty_reach_m
    return ", ".join(words for words, size in errors.items() if size)


def requirement_words(solution: Result) -> str:
    """Return whether the requirements are met and by how much, or which are missed; empty if there are none.

    That no pose meets them is said where the bound proves it.

    Args:
        solution: what was found.
    """
    nodes, bound = solution.scenario.nodes, solution.objective.upper_bound
    pairs = zip(solution.links, nodes, strict=True)
    spare = sorted((link.margin_db or 0.0, link.node) for link, node in pairs if node.min_sinr_db is not None)
    missed = [each for each in spare if each[0] < 0.0]
    told = ", ".join(
        f"node {node}: {abs(db):.2f} dB {'below' if db < 0.0 else 'above'} what it requires"
        for db, node in missed or spare[:1]
    )
    if not missed:
        return f"every requirement is met; {told}" if spare else ""
    hopeless = len(spare) == len(nodes) and bound is not None and bound < 1.0
    return f"missed: {told}{'; proved: no pose of this case meets every requirement' if hopeless else ''}"


def _degrees(angle_rad: float) -> str:
    return f"{round(math.degrees(angle_rad), 6):g}"
