"""Parts of a scenario, and what becomes of its requirements, in words."""

from __future__ import annotations

import math

from nullpose.physics import Geodetic
from nullpose.scenario import Airframe, Array, Eavesdropper, Jammer, Origin, Scenario
from nullpose.solver import Result
from nullpose.study.case import degrees_text


def airframe_words(airframe: Airframe, tilt_rad: float | None = None) -> str:
    """Describe an airframe, as in ``tilts at most 10 deg; dipole 90 deg from upright on the body``.

    Args:
        airframe: how far it tilts and how the dipole is mounted.
        tilt_rad: how far it is tilted, if it is at a pose.
    """
    is_limited = airframe.tilt_max_rad < math.pi
    limit = f"at most {degrees_text(airframe.tilt_max_rad)} deg" if is_limited else "without limit"
    used = "tilts" if tilt_rad is None else f"tilted by {abs(math.degrees(tilt_rad)):.3f} deg,"
    preset = f"{airframe.preset}: " if airframe.preset else ""
    return f"{preset}{used} {limit}; dipole {airframe.mount_deg:g} deg from upright on the body"


def reach_words(airframe: Airframe | None) -> str:
    """Describe the antenna axes that an airframe reaches, as angles from the vertical; None reaches all."""
    low, high = (0.0, 1.0) if airframe is None else airframe.axis_band
    if (low, high) == (0.0, 1.0):
        return "any axis direction"
    least, greatest = (degrees_text(math.acos(math.sqrt(cosine_squared))) for cosine_squared in (high, low))
    return f"axes {least} to {greatest} deg from the vertical"


def array_words(array: Array) -> str:
    """Describe an array, as in ``4 upright dipoles, linear, 0.5 wavelengths apart``."""
    dipoles = "1 upright dipole" if array.elements == 1 else f"{array.elements} upright dipoles"
    return f"{dipoles}, {array.layout}, {array.spacing_wavelengths:g} wavelengths apart"


def place_words(place: Geodetic | Origin, more: int = 0) -> str:
    """Write a place on the Earth, to about a millimetre, or with so many more decimals."""
    over = {"the WGS-84 ellipsoid": place.alt_m, "the sea": place.alt_msl_m}
    altitudes = [f"{alt_m:z.{3 + more}f} m over {what}" for what, alt_m in over.items() if alt_m is not None]
    lat, lon = (f"{angle_deg:z.{8 + more}f} deg" for angle_deg in (place.lat_deg, place.lon_deg))
    return f"lat {lat}, lon {lon}, alt {', '.join(altitudes)}"


def error_words(scenario: Scenario) -> str:
    """List the errors that a scenario states, as in ``axis 2 deg, M up to 3 m``."""
    receiver = scenario.receiver
    hidden: list[Jammer | Eavesdropper] = [*scenario.jammers, *scenario.eavesdroppers]
    reaches_m = {point.name: point.uncertainty_reach_m for point in hidden}
    errors = {
        f"axis {receiver.attitude_error_deg:g} deg": receiver.attitude_error_deg,
        f"position {receiver.position_error_m:g} m": receiver.position_error_m,
        **{f"{name} up to {reach_m:g} m": reach_m for name, reach_m in reaches_m.items()},
    }
    return ", ".join(words for words, size in errors.items() if size)


def requirement_words(result: Result) -> str:
    """Say whether the requirements are met and by how much, or which are missed; nothing without any.

    That no pose meets them is said where the bound proves it.
    """
    nodes, bound = result.scenario.terminals, result.objective.upper_bound
    spare = sorted(
        (link.sinr_db - node.min_sinr_db, link.node)
        for link, node in zip(result.links, nodes, strict=True)
        if node.min_sinr_db is not None
    )
    missed = [margin for margin in spare if margin[0] < 0.0]
    words = ", ".join(
        f"node {node}: {abs(db):.2f} dB {'below' if db < 0.0 else 'above'} what it requires"
        for db, node in missed or spare[:1]
    )
    if not missed:
        return f"every requirement is met; {words}" if spare else ""
    every = len(spare) == len(nodes) and not result.objective.quantity.whole
    is_impossible = every and bound is not None and bound < 1.0
    return (
        f"missed: {words}{'; proved: no pose of this case meets every requirement' if is_impossible else ''}"
    )


def channel_words(scenario: Scenario) -> str | None:
    """Describe the channel, and those of points that have their own; None where none is stated."""
    channels = {"": scenario.channel} | {f"{point.name}: ": point.channel for point in scenario.points}
    among = scenario.prisms is not None
    return (
        "; ".join(f"{name}{each.describe(among_buildings=among)}" for name, each in channels.items() if each)
        or None
    )
