"""Many scenes, a pose in each: the equations of one scene, worked out for all of them together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from nullpose.physics.objective import margin
from nullpose.physics.sinr import received_power_w
from nullpose.physics.types import FloatArray
from nullpose.scenario import Scenario


def margins_of_many(scenarios: Sequence[Scenario], position_m: ArrayLike, axis: ArrayLike) -> FloatArray:
    """Return every node's margin in every scene: its SINR over its weight or required SINR, if it has one.

    The same numbers as those of :func:`margin`, scene by scene (paper eq. 2.1).

    Args:
        scenarios: with as many nodes and as many jammers each; their antennas may differ.
        position_m: the drone's position in each scene, shape ``(s, 3)``, metres.
        axis: unit antenna axis in each, shape ``(s, 3)``.

    Returns:
        Array of shape ``(s, n_nodes)``, power ratios.
    """
    g0 = np.array([[one.reference_gain] for one in scenarios])
    noise_w = np.array([[one.receiver.noise_power_w] for one in scenarios])
    required = np.array([one.node_required_sinr for one in scenarios])
    source_m = np.array([one.source_positions_m for one in scenarios])
    source_w = np.array([one.source_powers_w for one in scenarios])
    antenna = scenarios[0].antenna_record
    if any(one.antenna_record != antenna or one.source_antennas for one in scenarios):
        poses = zip(scenarios, np.asarray(position_m), np.asarray(axis), strict=True)
        return np.array([margin(*each) for each in poses])
    received_w, nodes = received_power_w(position_m, axis, source_m, source_w, g0, antenna), required.shape[1]
    interference_w = np.sum(received_w[:, nodes:], axis=-1, keepdims=True)
    return np.asarray(received_w[:, :nodes] / (interference_w + noise_w) / required)
