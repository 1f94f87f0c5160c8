"""Ways in which everything that is uncertain may turn out, and what a pose gives then."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.secrecy import node_snr
from nullpose.physics.sinr import received_power_w, sinr
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ErrorCase:
    """Where everything actually is, from where it was meant or thought to be; world frame.

    One case, or several with the same leading shape ``(...)``.

    Args:
        position_offset_m: shape ``(..., 3)``, the drone's actual position less the commanded one, metres.
        rotation_world: shape ``(..., 3, 3)``, the rotation that takes the commanded antenna axis to the
            actual one.
        jammer_offsets_m: shape ``(..., n_jammers, 3)``, actual less stated positions, metres.
        eavesdropper_offsets_m: shape ``(..., n_eavesdroppers, 3)``, likewise.
    """

    position_offset_m: FloatArray
    rotation_world: FloatArray
    jammer_offsets_m: FloatArray
    eavesdropper_offsets_m: FloatArray

    def __post_init__(self) -> None:
        shapes = {"position_offset_m": (3,), "rotation_world": (3, 3)}
        for field in fields(self):
            array = np.array(getattr(self, field.name), dtype=float)
            wanted = shapes.get(field.name, (*array.shape[-2:-1], 3))
            if array.shape[-len(wanted) :] != wanted or not np.all(np.isfinite(array)):
                raise ValueError(
                    f"error case {field.name} must be finite, of shape {wanted}; given {array!r}"
                )
            array.flags.writeable = False
            object.__setattr__(self, field.name, array)

    @classmethod
    def none(cls, scenario: Scenario) -> ErrorCase:
        """Return the case in which everything is as stated.

        Args:
            scenario: says how many jammers and eavesdroppers there are.
        """
        return cls(
            position_offset_m=np.zeros(3),
            rotation_world=np.eye(3),
            jammer_offsets_m=np.zeros((len(scenario.jammers), 3)),
            eavesdropper_offsets_m=np.zeros((len(scenario.eavesdroppers), 3)),
        )

    def is_same(self, other: ErrorCase) -> bool:
        """Return whether another case is the same to the last bit.

        Args:
            other: a case of the same scenario.
        """
        return all(
            np.array_equal(getattr(self, field.name), getattr(other, field.name)) for field in fields(self)
        )

    @property
    def rotation_rad(self) -> float:
        """Angle of the rotation, radians: for the smallest that turns the axis so, the error of the axis."""
        sine = 0.5 * np.linalg.norm(
            [self.rotation_world[j, i] - self.rotation_world[i, j] for i, j in ((0, 1), (1, 2), (2, 0))]
        )
        return math.atan2(float(sine), 0.5 * (float(np.trace(self.rotation_world)) - 1.0))


def rotation_between(first: ArrayLike, second: ArrayLike) -> FloatArray:
    """Return the smallest rotation that takes one unit vector to another.

    ``R = I + [v]x + [v]x^2 / (1 + c)`` with ``v = a x b`` and ``c = a.b`` (Rodrigues' formula).

    Args:
        first: ``a``, shape ``(3,)``, of unit length.
        second: ``b``, shape ``(3,)``, of unit length and not opposite to it.

    Returns:
        Array of shape ``(3, 3)``.
    """
    a, b = np.asarray(first, dtype=float), np.asarray(second, dtype=float)
    x, y, z = np.cross(a, b)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1.0 + float(a @ b)))


def sinr_under(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, case: ErrorCase) -> FloatArray:
    """Return every node's SINR at a pose when an error case comes true.

    Paper eq. 2.1 at the actual position ``p + d`` with the actual axis ``R u`` and jammers at ``m_j + e_j``.

    Args:
        scenario: nodes, jammers and receiver.
        position_m: the commanded position, shape ``(..., 3)``, metres.
        axis: the commanded unit antenna axis, shape ``(..., 3)``; the attitude of an antenna with a pattern.
        case: what is actually the case.

    Returns:
        Array of shape ``(..., n_nodes)``, power ratios.
    """
    p, u = _actual(scenario, position_m, axis, case)
    return sinr(scenario, p, u, actual_sources_m(scenario, case))


def actual_sources_m(scenario: Scenario, case: ErrorCase) -> FloatArray:
    """Place the nodes and then the jammers where they are in an error case, ``(..., n_sources, 3)``, metres.

    Args:
        scenario: nodes and jammers.
        case: what is actually the case.
    """
    jammers_m = scenario.jammer_positions_m.reshape(-1, 3) + case.jammer_offsets_m
    nodes_m = np.broadcast_to(
        scenario.node_positions_m, (*jammers_m.shape[:-2], *scenario.node_positions_m.shape)
    )
    return np.concatenate([nodes_m, jammers_m], axis=-2)


def ratios_under(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, case: ErrorCase) -> FloatArray:
    """Return the ratios of which the objective takes the smallest, when an error case comes true.

    Every node's margin, its SINR over its weight or requirement; or where the drone transmits the ratio
    ``(1 + SNR_k) / (1 + SNR_e)`` of every node and eavesdropper, whose logarithm to base 2 is their rate.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter.
        position_m: the commanded position, shape ``(..., 3)``, metres.
        axis: the commanded unit antenna axis, shape ``(..., 3)``.
        case: what is actually the case.

    Returns:
        Array of shape ``(..., n_nodes, 1)``, or ``(..., n_nodes, n_eavesdroppers)``.

    Raises:
        ValueError: the drone transmits, and no transmitter is stated.
    """
    if not scenario.objective_record.transmits:
        margins = sinr_under(scenario, position_m, axis, case) / scenario.node_required_sinr
        return np.asarray(margins[..., None])
    p, u = _actual(scenario, position_m, axis, case)
    wanted = node_snr(scenario, p, u)
    assert scenario.transmitter is not None, "or the signal to noise ratio would have failed"
    listeners_m = scenario.eavesdropper_positions_m + case.eavesdropper_offsets_m
    powers_w = np.full(listeners_m.shape[-2], scenario.transmitter.transmit_power_w)
    link = (scenario.reference_gain, scenario.antenna_record, scenario.eavesdropper_antennas)
    overheard = received_power_w(p, u, listeners_m, powers_w, *link) / scenario.eavesdropper_noise_w
    return np.asarray((1.0 + wanted[..., :, None]) / (1.0 + overheard[..., None, :]))


def objective_under(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, case: ErrorCase
) -> FloatArray:
    """Return the scenario's objective under an error case.

    The smallest margin over the nodes, or the smallest secrecy rate, ``max(0, log2)`` of the smallest ratio.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter.
        position_m: the commanded position, shape ``(..., 3)``, metres.
        axis: the commanded unit antenna axis, shape ``(..., 3)``.
        case: what is actually the case.

    Returns:
        Array of shape ``(...)``: power ratios, or bits/s/Hz.
    """
    smallest = np.min(ratios_under(scenario, position_m, axis, case), axis=(-2, -1))
    is_rate = scenario.objective_record.quantity(scenario).is_rate
    return np.asarray(np.log2(np.maximum(1.0, smallest)) if is_rate else smallest)


def _actual(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, case: ErrorCase
) -> tuple[FloatArray, FloatArray]:
    """Return the actual position, and the actual axis or attitude."""
    position, rotation = np.asarray(position_m, dtype=float) + case.position_offset_m, case.rotation_world
    if not scenario.antenna_record.is_quadratic:
        return position, np.asarray(rotation @ np.asarray(axis, dtype=float))
    return position, np.asarray((rotation @ np.asarray(axis, dtype=float)[..., None])[..., 0])
