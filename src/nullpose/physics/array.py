"""What an array of vertical dipoles receives: steering and digital combining.

The vehicle hovers level, so the dipoles stand upright and only the yaw is free; an error can tilt it. The
model is the narrow-band far field: plane waves, and every dipole with the gain of eq. 1.2, whatever stands
beside it (no mutual coupling). One wavelength serves for every node's channel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import GroundAntennas
from nullpose.channel import PointChannels
from nullpose.errors import require_usage
from nullpose.physics.error_case import ErrorCase
from nullpose.physics.pose import Pose
from nullpose.physics.sinr import received_power_w
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario

ComplexArray = NDArray[np.complex128]

_VERTICAL = np.array([0.0, 0.0, 1.0])


def element_positions(
    elements: int, layout: str, spacing_wavelengths: float, yaw_rad: ArrayLike = 0.0
) -> FloatArray:
    """Place the elements, seen from the array's centre, in wavelengths and world axes.

    ``d_n = R_z(yaw) b_n``, in the body's horizontal plane. Linear: ``b_n = (n - (K - 1) / 2) s e_x`` along
    the body's x axis. Circular: ``b_n = rho (cos(2 pi n / K), sin(2 pi n / K), 0)`` with
    ``rho = s / (2 sin(pi / K))``, so that neighbours are the spacing ``s`` apart; one element is at the
    centre.

    Source: H. L. Van Trees, "Optimum Array Processing" (Wiley, 2002), chapters 2 and 4.

    Args:
        elements: their number ``K``, at least 1.
        layout: ``"linear"`` or ``"circular"``.
        spacing_wavelengths: distance ``s`` between neighbours, in wavelengths.
        yaw_rad: the vehicle's yaw, shape ``(...)``, radians, counter-clockwise from above.

    Returns:
        Array of shape ``(..., K, 3)``, the centre of each dipole.

    Raises:
        UsageError: another layout, or no element.
    """
    require_usage(
        layout in ("linear", "circular") and elements >= 1,
        f"an array takes one element or more, linear or circular; given {elements!r}, {layout!r}",
    )
    n = np.arange(elements)
    if layout == "linear" or elements == 1:
        along, across = spacing_wavelengths * (n - 0.5 * (elements - 1)), np.zeros(elements)
    else:
        radius = 0.5 * spacing_wavelengths / np.sin(np.pi / elements)
        along, across = (
            radius * np.cos(2.0 * np.pi * n / elements),
            radius * np.sin(2.0 * np.pi * n / elements),
        )
    cosine, sine = (turn(np.asarray(yaw_rad, dtype=float))[..., None] for turn in (np.cos, np.sin))
    east, north = cosine * along - sine * across, sine * along + cosine * across
    return np.stack([east, north, np.zeros_like(east)], axis=-1)


def steering_vectors(
    position_m: ArrayLike, elements_wavelengths: ArrayLike, points_m: ArrayLike
) -> ComplexArray:
    """Evaluate the phases with which a plane wave from each point arrives at the elements.

    ``a_n = exp(j 2 pi <d_n, e>)`` with ``e = (q - p) / |q - p|``: an element nearer to the point receives the
    wave earlier.

    Source: Van Trees, chapter 2, with the direction pointing to the source.

    Args:
        position_m: the array's centre, shape ``(..., 3)``, metres.
        elements_wavelengths: from :func:`element_positions`, shape ``(..., K, 3)``.
        points_m: ground points, shape ``(m, 3)``, metres, none of them at the centre.

    Returns:
        Array of shape ``(..., m, K)``, all of modulus 1. Far field: valid beyond twice the square of the
        array's length over the wavelength.
    """
    to_points = np.asarray(points_m, dtype=float) - np.asarray(position_m, dtype=float)[..., None, :]
    directions = to_points / np.linalg.norm(to_points, axis=-1, keepdims=True)
    turns = directions @ np.swapaxes(np.asarray(elements_wavelengths, dtype=float), -1, -2)
    return np.asarray(np.exp(2j * np.pi * turns))


def array_channels(
    position_m: ArrayLike,
    elements_wavelengths: ArrayLike,
    points_m: ArrayLike,
    powers_w: ArrayLike,
    reference_gain: float,
    ground: GroundAntennas | None = None,
    axis: FloatArray = _VERTICAL,
    links: PointChannels | None = None,
) -> ComplexArray:
    """Evaluate the channel of every ground transmitter to the elements.

    ``sqrt(g0 P_i sin^2(gamma_i)) h_i / |r_i| a_i``, ``gamma_i`` being the angle between the dipoles and the
    direction to the transmitter: the amplitude is that of the numerator of eq. 2.1, with ``h_i^2`` the gain
    over free space; the phases are those of :func:`steering_vectors`.

    Source: paper eqs. 1.2 and 2.1 for the amplitude.

    Args:
        position_m: the array's centre, shape ``(..., 3)``, metres.
        elements_wavelengths: shape ``(..., K, 3)``.
        points_m: transmitters, shape ``(m, 3)``, metres.
        powers_w: their powers, shape ``(m,)``, watts.
        reference_gain: path gain at 1 m, a power ratio.
        ground: the transmitters' antennas; None where all are isotropic.
        axis: of the dipoles, shape ``(..., 3)``, of unit length; vertical on a level vehicle.
        links: the transmitters' channels; None where all are in free space with line of sight.

    Returns:
        Array of shape ``(..., m, K)``, in the square root of a watt.
    """
    power_w = received_power_w(
        position_m, axis, points_m, powers_w, reference_gain, ground=ground, channels=links
    )
    return np.asarray(
        np.sqrt(power_w)[..., None] * steering_vectors(position_m, elements_wavelengths, points_m)
    )


def digital_sinr(
    scenario: Scenario,
    position_m: ArrayLike,
    elements_wavelengths: ArrayLike,
    case: ErrorCase | None = None,
) -> FloatArray:
    """Evaluate every node's SINR with its own best combining of the elements.

    ``Gamma_k = h_k^H R^-1 h_k`` with ``R = sigma^2 I + sum_j h_j h_j^H`` over the jammers: the largest
    eigenvalue of ``(h_k h_k^H, R)``. The nodes have channels of their own in frequency and do not disturb
    each other. Evaluated along the jammers' principal directions, the left singular vectors ``u_i`` of their
    channels, as ``sum_i |u_i^H h_k|^2 / (sigma^2 + s_i^2)``, and ``1 / sigma^2`` times the square of what
    ``h_k`` has in no such direction: a sum of positive terms, which keeps its digits where ``R`` is close to
    singular.

    Source: Van Trees, section 6.2 (minimum variance distortionless response, maximum SINR).

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the array's centre, shape ``(..., 3)``, metres.
        elements_wavelengths: shape ``(..., K, 3)``.
        case: where vehicle and jammers actually are; the combining follows. As stated, if left out.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    nodes, directions, jamming_w, parts = _principal(scenario, position_m, elements_wavelengths, case)
    free = nodes - parts @ np.swapaxes(directions, -1, -2)  # in no jammer's direction
    noise_w = scenario.receiver.noise_power_w
    clear = np.sum(np.abs(free) ** 2, axis=-1) / noise_w
    return np.asarray(clear + np.sum(np.abs(parts) ** 2 / (noise_w + jamming_w)[..., None, :], axis=-1))


def array_ratios_under(scenario: Scenario, pose: Pose, case: ErrorCase) -> FloatArray:
    """Return every node's margin when error cases come true and digital combining follows them.

    Args:
        scenario: nodes, jammers, receiver and array.
        pose: the commanded pose.
        case: where vehicle and jammers actually are, in one case or several.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    sinr = digital_sinr(scenario, pose.position_m, placed_elements(scenario, pose), case)
    return np.asarray(sinr / scenario.node_required_sinr)


def placed_elements(scenario: Scenario, pose: Pose) -> FloatArray:
    """Place the elements of a scenario's array at a pose, as :func:`element_positions`.

    Args:
        scenario: one with an array.
        pose: of the vehicle, whose yaw counts.
    """
    array = scenario.array
    assert array is not None, "the caller asks"
    return element_positions(array.elements, array.layout, array.spacing_wavelengths, pose.yaw_rad)


def digital_weights(
    scenario: Scenario, position_m: ArrayLike, elements_wavelengths: ArrayLike
) -> ComplexArray:
    """Find every node's best combining weights ``w_k``, of unit length, which turn ``w_k^H x`` into SINR.

    ``w_k`` is ``R^-1 h_k`` scaled to length 1; where a node is not heard at all, its weights are zero.

    Source: Van Trees, section 6.2.

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the array's centre, shape ``(..., 3)``, metres.
        elements_wavelengths: shape ``(..., K, 3)``.

    Returns:
        Array of shape ``(..., n_nodes, K)``.
    """
    nodes, directions, jamming_w, parts = _principal(scenario, position_m, elements_wavelengths)
    share = jamming_w / (scenario.receiver.noise_power_w + jamming_w)  # of each direction that is given up
    weights = nodes - (parts * share[..., None, :]) @ np.swapaxes(directions, -1, -2)
    length = np.linalg.norm(weights, axis=-1, keepdims=True)
    return np.asarray(weights / np.where(length > 0.0, length, 1.0))


def _principal(
    scenario: Scenario, position_m: ArrayLike, elements_wavelengths: ArrayLike, case: ErrorCase | None = None
) -> tuple[ComplexArray, ComplexArray, FloatArray, ComplexArray]:
    """Evaluate the nodes' channels, the principal directions of the jamming, its power and their parts there.

    Shapes ``(..., n_nodes, K)``; ``(..., K, d)``, one direction a column; ``(..., d)``, watts;
    ``(..., n_nodes, d)``.
    """
    case = ErrorCase.none(scenario) if case is None else case
    elements = np.asarray(elements_wavelengths, dtype=float) @ np.swapaxes(case.rotation_world, -1, -2)
    channels = array_channels(
        np.asarray(position_m, dtype=float) + case.position_offset_m,
        elements,
        case.sources_m(scenario),
        scenario.source_powers_w,
        scenario.reference_gain,
        scenario.source_antennas,
        case.rotation_world[..., 2],
        scenario.source_channels,
    )
    nodes, jammers = np.split(channels, [len(scenario.nodes)], axis=-2)
    directions, strengths, _ = np.linalg.svd(np.swapaxes(jammers, -1, -2), full_matrices=False)
    return nodes, directions, strengths**2, nodes @ np.conj(directions)
