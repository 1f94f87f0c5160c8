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
    g0 = np.array([[one.receiver.reference_gain] for one in scenarios])
    noise_w = np.array([[one.receiver.noise_power_w] for one in scenarios])
    required = np.array([one.node_required_sinr for one in scenarios])
    node_m = np.array([one.node_positions_m for one in scenarios])
    jammer_m = np.array([one.jammer_positions_m.reshape(-1, 3) for one in scenarios])
    node_w = np.array([one.node_powers_w for one in scenarios])
    jammer_w = np.array([one.jammer_powers_w for one in scenarios])
    antenna = scenarios[0].antenna_record
    if any(one.antenna_record != antenna or one.node_antennas or one.jammer_antennas for one in scenarios):
        poses = zip(scenarios, np.asarray(position_m), np.asarray(axis), strict=True)
        return np.array([margin(*each) for each in poses])
    signal_w = received_power_w(position_m, axis, node_m, node_w, g0, antenna)
    jamming_w = received_power_w(position_m, axis, jammer_m, jammer_w, g0, antenna)
    interference_w = np.sum(jamming_w, axis=-1, keepdims=True)
    return np.asarray(signal_w / (interference_w + noise_w) / required)
