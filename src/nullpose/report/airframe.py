"""An airframe in words."""

from __future__ import annotations

import math

from nullpose.scenario import Airframe, Array

__all__ = ["airframe_words", "array_words", "reach_words"]

_MOUNTS = {0.0: "upright", 90.0: "flat"}


def airframe_words(airframe: Airframe, tilt_rad: float | None = None) -> str:
    """Return what an airframe can do, as in ``tilts by at most 10 deg; dipole flat on the body``.

    Args:
        airframe: how far it tilts and how the dipole is mounted.
        tilt_rad: how far it is tilted, radians, if that is to be told.
    """
    limit = (
        "without limit" if airframe.tilt_max_rad >= math.pi else f"at most {_degrees(airframe.tilt_max_rad)}"
    )
    if tilt_rad is None:
        tilt = f"tilts {limit}" if airframe.tilt_max_rad >= math.pi else f"tilts by {limit}"
    else:
        tilt = f"tilted by {abs(math.degrees(tilt_rad)):.3f} deg, {limit}"
    mount = _MOUNTS.get(airframe.mount_deg, f"mounted {airframe.mount_deg:g} deg from upright")
    named = f"{airframe.preset}: " if airframe.preset else ""
    return f"{named}{tilt}; dipole {mount} on the body"


def reach_words(airframe: Airframe | None) -> str:
    """Return which antenna axes an airframe reaches, as angles from the vertical.

    Args:
        airframe: how far it tilts and how the dipole is mounted; None for one that reaches every axis.
    """
    low, high = (0.0, 1.0) if airframe is None else airframe.axis_band
    if (low, high) == (0.0, 1.0):
        return "every axis"
    least, greatest = (_degrees(math.acos(math.sqrt(cosine_squared))) for cosine_squared in (high, low))
    if least == greatest:
        return f"axes at {least} from the vertical"
    return f"axes {least.removesuffix(' deg')} to {greatest} from the vertical"


def array_words(array: Array) -> str:
    """Return an array in words, as in ``4 upright dipoles, linear, 0.5 wavelengths apart``.

    Args:
        array: the dipoles.
    """
    dipoles = "1 upright dipole" if array.elements == 1 else f"{array.elements} upright dipoles"
    return f"{dipoles}, {array.layout}, {array.spacing_wavelengths:g} wavelengths apart"


def _degrees(angle_rad: float) -> str:
    return f"{round(math.degrees(angle_rad), 6):g} deg"
