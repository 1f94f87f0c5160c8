"""The power gain of a link: the drone's antenna (paper eqs. 1.2 to 1.4) and the one on the ground."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from nullpose.antenna import SHORT_DIPOLE, AnyAntenna, GroundAntennas, QuadraticAntenna
from nullpose.physics.types import FloatArray
from nullpose.scenario import GroundPoint, Scenario, Terminal


def antenna_gain(
    position_m: ArrayLike, axis: ArrayLike, points_m: ArrayLike, antenna: AnyAntenna = SHORT_DIPOLE
) -> FloatArray:
    """Evaluate the antenna's power gain towards each point, 1 broadside; of a short dipole, 0 along its axis.

    A short dipole has ``G(gamma_i) = sin^2(gamma_i) = 1 - <(p_i - p) / |p_i - p|, u>^2``, evaluated as the
    squared norm of the cross product ``(p_i - p) x u`` over ``|p_i - p|^2``: the same number, which keeps its
    digits beside the null, where the printed difference loses all of them. Other antennas say what becomes of
    that sine.

    Source: paper eqs. 1.2 and 1.4; the maximum is 1, not the 1.5 of a short dipole's directivity.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``; for an antenna with a pattern its attitude, the rotation
            to the world from its own axes, shape ``(..., 3, 3)``, as :meth:`Pose.orientation` has them.
        points_m: ground points, shape ``(m, 3)``, metres, none of them at the drone's position.
        antenna: which antenna the drone has.

    Returns:
        Array of shape ``(..., m)``: between 0 and 1 for a dipole.
    """
    to_points = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
    if not antenna.is_quadratic:
        directions = to_points / np.linalg.norm(to_points, axis=-1, keepdims=True)
        return antenna.gain(np.matmul(directions, np.asarray(axis, dtype=float)))
    u = np.asarray(axis, dtype=float)
    x, y, z = to_points[..., 0], to_points[..., 1], to_points[..., 2]
    ux, uy, uz = u[..., 0, None], u[..., 1, None], u[..., 2, None]
    across_sq = (y * uz - z * uy) ** 2 + (z * ux - x * uz) ** 2 + (x * uy - y * ux) ** 2  # m^2
    return np.asarray(antenna.gain(across_sq / (x * x + y * y + z * z)))


def dipole_gain(
    position_m: ArrayLike,
    axis: ArrayLike,
    points_m: ArrayLike,
    ground_axes: ArrayLike,
    antenna: QuadraticAntenna = SHORT_DIPOLE,
) -> FloatArray:
    """Evaluate the power gain between the drone's antenna and a short dipole at each point.

    With unit vectors u of the drone's axis, v of the ground dipole's and d of the way between them, ``P = I -
    d d^T`` and the drone's leak e along its axis, it is ``(1 - e) (u^T P v)^2 + e |P v|^2``: both patterns
    and the angle between both fields; what leaks has no known polarisation. The product is evaluated as
    ``(r x u).(r x v) / |r|^2``, which keeps its digits beside the nulls.

    Source: paper eqs. 1.2 to 1.4 for each dipole; the effective heights of both for the product.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: ground points, shape ``(m, 3)``, metres, none of them at the drone's position.
        ground_axes: unit axes of the dipoles there, shape ``(m, 3)``.
        antenna: which antenna the drone has.

    Returns:
        Array of shape ``(..., m)``, between 0 and 1.
    """
    r = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
    square = np.sum(r * r, axis=-1)
    across = np.cross(r, np.asarray(ground_axes, dtype=float))
    product = np.sum(np.cross(r, np.asarray(axis, dtype=float)[..., None, :]) * across, axis=-1) / square
    leaking = antenna.leak * np.sum(across * across, axis=-1) / square
    return np.asarray((1.0 - antenna.leak) * product**2 + leaking)


def link_gain(
    position_m: ArrayLike,
    axis: ArrayLike,
    points_m: ArrayLike,
    antenna: AnyAntenna = SHORT_DIPOLE,
    ground: GroundAntennas | None = None,
) -> FloatArray:
    """Evaluate the power gain between the drone's antenna and that at each point, polarisation included.

    The drone's gain alone for an isotropic antenna (paper eq. 2.1), half of it for a circular one, and
    :func:`dipole_gain` for a dipole, or where f leaks through its null the weighted mean ``(1 - f)
    dipole_gain + f antenna_gain``, each times the largest gain of the antenna on the ground. The largest
    gain of a dipole on the drone counts as 1.

    Args:
        position_m: the drone's position, shape ``(..., 3)``, metres.
        axis: unit antenna axis, shape ``(..., 3)``.
        points_m: ground points, shape ``(m, 3)``, metres, none of them at the drone's position.
        antenna: which antenna the drone has.
        ground: the antennas at the points; None where all are isotropic.

    Returns:
        Array of shape ``(..., m)``, between 0 and the largest gain of each antenna on the ground.
    """
    gain = antenna_gain(position_m, axis, points_m, antenna)
    if ground is None:
        return gain
    if not antenna.is_quadratic:
        return np.asarray(ground.shares * gain)  # of a dipole on the ground it says nothing: there is none
    of_dipoles = dipole_gain(position_m, axis, points_m, ground.axes, antenna)
    return np.asarray(ground.shares * ((1.0 - ground.leaks) * of_dipoles + ground.leaks * gain))


def interferer_gains(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Evaluate the gain of the link with each jammer, or eavesdropper, over the largest of both antennas.

    Args:
        scenario: its objective says whether jammers or eavesdroppers interfere.
        position_m: the drone's position, shape ``(3,)``, metres.
        axis: unit antenna axis, shape ``(3,)``; the attitude of an antenna with a pattern.

    Returns:
        Array of shape ``(m,)``, between 0 and 1.
    """
    antenna, ground = scenario.antenna_record, scenario.of_interferers("antennas")
    gains = link_gain(position_m, axis, scenario.of_interferers("positions_m"), antenna, ground)
    return np.asarray(gains / (antenna.peak if ground is None else antenna.peak * ground.shares))


def worst_polarised(scenario: Scenario) -> Scenario:
    """Make a scenario without dipoles on the ground whose null has a depth, itself if nothing is changed.

    An isotropic antenna is the worst that a jammer or an eavesdropper could have: no dipole lets more
    through, at any pose. Nodes keep their dipoles, but nothing of what leaks through a null.

    Args:
        scenario: any.
    """
    changed: dict[str, object] = {
        kind: tuple(map(_worst, getattr(scenario, kind))) for kind in ("nodes", "jammers", "eavesdroppers")
    } | {"destination": scenario.destination and _worst(scenario.destination)}
    changed = {kind: points for kind, points in changed.items() if points != getattr(scenario, kind)}
    return scenario.model_copy(update=changed) if changed else scenario


def _worst(point: GroundPoint) -> GroundPoint:
    if not 0.0 < point.leak < 1.0:
        return point
    if not isinstance(point, Terminal):
        return point.isotropic
    kept_db = 10.0 * math.log10(1.0 - point.leak)
    return point.model_copy(update={"null_depth_db": None, "gain_dbi": point.gain_dbi + kept_db})
