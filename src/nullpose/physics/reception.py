"""What the drone, and those on the ground, receive at a pose, and what an objective makes of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.error_case import ErrorCase
from nullpose.physics.sinr import (
    destination_snr,
    eavesdropper_snr,
    jammed_sinr,
    node_snr,
    overheard_sinr,
    received_from_sources_w,
    secrecy_rate_of,
    sinr,
)
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


@dataclass(frozen=True, eq=False)
class Reception:
    """Everything that is received with the drone at one pose or at many, each number evaluated once.

    Args:
        scenario: all points, receiver and transmitter; one antenna, not an array.
        position_m: the commanded position, shape ``(..., 3)``, metres.
        axis: the commanded unit antenna axis, shape ``(..., 3)``; the attitude ``(..., 3, 3)`` of an antenna
            with a pattern.
        case: where everything actually is; as stated, if left out.
    """

    scenario: Scenario
    position_m: ArrayLike
    axis: ArrayLike
    case: ErrorCase | None = None

    @cached_property
    def sinr(self) -> FloatArray:
        """Every node's SINR at the drone, ``(..., n_nodes)``, power ratios (paper eq. 2.1)."""
        return sinr(self.scenario, *self._pose, self._sources_m)

    @cached_property
    def node_snr(self) -> FloatArray:
        """Every node's SNR of the drone's signal, ``(..., n_nodes)``, power ratios."""
        return node_snr(self.scenario, *self._pose)

    @cached_property
    def destination_snr(self) -> FloatArray:
        """The destination's SNR of the drone's signal, ``(..., 1)``, a power ratio."""
        return destination_snr(self.scenario, *self._pose)

    @cached_property
    def eavesdropper_snr(self) -> FloatArray:
        """Every eavesdropper's SNR of the drone's signal, ``(..., n_eavesdroppers)``, power ratios."""
        return eavesdropper_snr(self.scenario, *self._pose, self._eavesdroppers_m)

    @cached_property
    def secrecy_rate(self) -> FloatArray:
        """Every node's secrecy rate, ``(..., n_nodes)``, bits/s/Hz."""
        return secrecy_rate_of(self.node_snr, self.eavesdropper_snr)

    @cached_property
    def jammed_sinr(self) -> FloatArray:
        """Every node's SINR of its source, the drone's jamming counted as noise, ``(..., n_nodes)``."""
        return jammed_sinr(self.scenario, self.node_snr)

    @cached_property
    def overheard_sinr(self) -> FloatArray:
        """The SINR of each node's source at every eavesdropper, ``(..., n_nodes, n_eavesdroppers)``."""
        return overheard_sinr(self.scenario, self.eavesdropper_snr, self._eavesdroppers_m)

    @cached_property
    def jammed_secrecy_rate(self) -> FloatArray:
        """Every node's secrecy rate, where the drone jams eavesdroppers, ``(..., n_nodes)``, bits/s/Hz."""
        return secrecy_rate_of(self.jammed_sinr[..., None], self.overheard_sinr)[..., 0]

    @cached_property
    def received_w(self) -> FloatArray:
        """The power that the drone receives, nodes first and then jammers, ``(..., n_sources)``, watts."""
        return received_from_sources_w(self.scenario, *self._pose, self._sources_m)

    @cached_property
    def _pose(self) -> tuple[ArrayLike, ArrayLike]:
        if self.case is None:
            return self.position_m, self.axis
        return self.case.pose(self.scenario, self.position_m, self.axis)

    @property
    def _eavesdroppers_m(self) -> FloatArray | None:
        if self.case is None:
            return None
        return np.asarray(self.scenario.eavesdropper_positions_m + self.case.eavesdropper_offsets_m)

    @property
    def _sources_m(self) -> FloatArray | None:
        return None if self.case is None else self.case.sources_m(self.scenario)


def objective_value(
    scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, case: ErrorCase | None = None
) -> FloatArray:
    """Evaluate the scenario's objective: the smallest SINR (paper eq. 2.2), say, a sum of rates or a mean.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter; one antenna, not an array.
        position_m: the commanded position, shape ``(..., 3)``, metres.
        axis: the commanded unit antenna axis, shape ``(..., 3)``; the attitude of an antenna with a pattern.
        case: where everything actually is; as stated, if left out.

    Returns:
        Array of shape ``(...)``: power ratios, or bits/s/Hz.
    """
    record = scenario.objective_record
    return record.value(scenario, record.evaluate(Reception(scenario, position_m, axis, case)))


def allowed_value(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Evaluate the objective, minus infinity where a sum or a mean leaves a node below what it requires.

    Args:
        scenario: as for ``objective_value``.
        position_m: likewise.
        axis: likewise.
    """
    reception, record = Reception(scenario, position_m, axis), scenario.objective_record
    numbers = record.evaluate(reception)
    value = record.value(scenario, numbers)
    if record.mean_offset is None:
        return value
    is_met = np.all(numbers["sinr"] >= scenario.node_requirements, axis=-1)
    return np.asarray(np.where(is_met, value, -np.inf))


def node_values(reception: Reception) -> FloatArray:
    """Evaluate the maximised quantity of every terminal, ``(..., n_terminals)``: ratios, or bits/s/Hz."""
    record = reception.scenario.objective_record
    return np.asarray(record.evaluate(reception)[record.quantity(reception.scenario).field])


def ratios_under(scenario: Scenario, position_m: ArrayLike, axis: ArrayLike, case: ErrorCase) -> FloatArray:
    """Evaluate the ratios of which the objective takes the smallest, when an error case comes true.

    Every node's margin, its SINR over its weight or requirement; or where the drone transmits the ratio
    ``(1 + SNR_k) / (1 + SNR_e)`` of every node and eavesdropper, whose logarithm to base 2 is their rate. Of
    a sum of rates or a mean the one ratio that stands for it.

    Args:
        scenario: nodes, jammers, eavesdroppers, receiver and transmitter.
        position_m: the commanded position, shape ``(..., 3)``, metres.
        axis: the commanded unit antenna axis, shape ``(..., 3)``; the attitude of an antenna with a pattern.
        case: where everything actually is.

    Returns:
        Array of shape ``(..., n_nodes, 1)``, ``(..., n_nodes, n_eavesdroppers)`` or ``(..., 1, 1)``.
    """
    reception, ratios_at = Reception(scenario, position_m, axis, case), scenario.objective_record.ratios_at
    if scenario.objective_record.mean_offset is not None:
        value = objective_value(scenario, position_m, axis, case)
        return scenario.objective_record.quantity(scenario).to_ratio(value)[..., None, None]
    return node_values(reception)[..., None] if ratios_at is None else ratios_at(reception)
