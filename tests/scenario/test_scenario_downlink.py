"""What a scenario makes of requirements, eavesdroppers and noise of their own."""

from typing import Any

import numpy as np
import pytest

from nullpose.scenario import Eavesdropper, Jammer, Node, Scenario, Transmitter
from scenes import NODE, small


def scene(**tables: Any) -> Scenario:
    """Returns a scene of two nodes, with other tables in place of those here."""
    nodes = [NODE, NODE | {"position_m": (0, 50, 0)}]
    return Scenario(**small(receiver={"noise_dbm": 0.0, "reference_gain_db": 10.0}, nodes=nodes) | tables)


def test_required_sinr() -> None:
    """A requirement is taken out of decibels, a weight as it is, and 1 where neither is stated."""
    nodes = [
        Node(position_m=(0, 0, 0), power_w=1, min_sinr_db=10.0),
        Node(position_m=(1, 0, 0), power_w=1, weight=2.5),
        Node(position_m=(2, 0, 0), power_w=1),
    ]
    weighted = scene(nodes=nodes)
    np.testing.assert_allclose(weighted.node_required_sinr, [10.0, 2.5, 1.0], rtol=1e-15)
    assert weighted.has_margins
    assert not scene().has_margins
    np.testing.assert_array_equal(scene().node_required_sinr, [1.0, 1.0])


SECRET: dict[str, Any] = {
    "objective": "secrecy-rate",
    "transmitter": Transmitter(power_w=1.0),
    "eavesdroppers": [
        Eavesdropper(position_m=(9, 9, 1)),
        Eavesdropper(name="van", position_m=(8, 9, 1), noise_dbm=-30.0, uncertainty_m=2.0),
    ],
}


def test_values_of_the_downlink() -> None:
    """Names, places, sets and noise in order: a point's own, or the receiver's, raised by the jamming."""
    nodes = [
        Node(position_m=(0, 0, 0)),
        Node(position_m=(0, 50, 0), noise_w=2e-3, power_w=2.0),
        Node(position_m=(0, 60, 0), noise_dbm=10.0, jamming_dbm=20.0),
    ]
    jammers = [Jammer(position_m=(0, 0, 5), power_w=3.0), Jammer(position_m=(0, 50, 10), power_dbm=30.0)]
    quiet, jammed = scene(**SECRET | {"nodes": nodes[:2]}), scene(**SECRET, nodes=nodes, jammers=jammers)
    assert quiet.eavesdropper_names == ("E1", "van")
    np.testing.assert_array_equal(quiet.eavesdropper_positions_m, [[9, 9, 1], [8, 9, 1]])
    np.testing.assert_allclose(quiet.eavesdropper_noise_w, [1e-3, 1e-6], rtol=1e-14)
    np.testing.assert_array_equal(quiet.eavesdropper_uncertainty_m, [0.0, 2.0])
    np.testing.assert_allclose(quiet.node_noise_w, [1e-3, 2e-3], rtol=1e-14)
    at_first, at_second = 10.0 * (3.0 / 25.0 + 1.0 / 2600.0), 10.0 * (3.0 / 2525.0 + 1.0 / 100.0)
    noise_w = [1e-3 + at_first, 2e-3 + at_second, 0.01 + 0.1]
    np.testing.assert_allclose(jammed.node_noise_w, noise_w, rtol=1e-14)
    np.testing.assert_array_equal(jammed.node_powers_w, [0.0, 2.0, 0.0])  # it is the drone that transmits


@pytest.mark.parametrize(
    ("tables", "uncertain"),
    [
        ({}, False),
        (SECRET, True),
        (SECRET | {"eavesdroppers": SECRET["eavesdroppers"][:1]}, False),
        ({"jammers": [Jammer(position_m=(9, 9, 1), power_w=1, uncertainty_m=0.0)]}, False),
        ({"jammers": [Jammer(position_m=(9, 9, 1), power_w=1, uncertainty_m=1.0)]}, True),
        ({"receiver": {"noise_w": 1, "reference_gain_db": 0, "attitude_error_deg": 2}}, True),
        ({"receiver": {"noise_w": 1, "reference_gain_db": 0, "position_error_m": 0.5}}, True),
    ],
)
def test_whether_anything_is_uncertain(tables: dict[str, Any], uncertain: bool) -> None:
    """Any set larger than a point, or any error of the vehicle, makes a scene uncertain."""
    assert scene(**tables).is_uncertain is uncertain
