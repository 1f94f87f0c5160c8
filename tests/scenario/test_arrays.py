"""A scenario from arrays is that of the file; shapes that do not fit are told as shapes."""

from pathlib import Path

import numpy as np
import pytest

import nullpose
from nullpose import Scenario, ScenarioError, UsageError

PAPER = Scenario.from_file(Path(__file__).parents[2] / "examples" / "paper.toml")
NODES_M = np.array([[0.0, 0.0, 0.0], [0.0, 50.0, 0.0]])


def test_the_paper_from_arrays() -> None:
    """The scene of the paper, in code, gives every pose what the file's does."""
    scene = Scenario.from_arrays(NODES_M, [[17, 15, 4]], noise_w=1e-3, altitude_m=(8, 30))
    pose = nullpose.Pose([3.0, 24.0, 9.0], 0.2, -1.1)
    assert nullpose.evaluate(scene, pose) == nullpose.evaluate(PAPER, pose)
    assert scene.airspace == PAPER.airspace
    assert scene.jammer_names == ("M1",)


def test_powers_and_other_tables() -> None:
    """Powers by point or one for all; other keys as in a file, those of two tables beside the given ones."""
    scene = Scenario.from_arrays(
        NODES_M,
        node_power_w=[1.0, 2.0],
        noise_w=1e-9,
        altitude_m=(8, 30),
        name="two nodes",
        airspace={"keep_out_m": 3.0},
        receiver={"attitude_error_deg": 2.0},
    )
    assert scene.node_powers_w.tolist() == [1.0, 2.0]
    assert scene.jammers == ()
    assert (scene.name, scene.airspace.keep_out_m) == ("two nodes", 3.0)
    assert (scene.receiver.noise_power_w, scene.receiver.attitude_error_deg) == (1e-9, 2.0)
    assert Scenario.from_dict(scene.to_dict()) == scene


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"nodes_m": [0, 0, 0]}, r"nodes_m: given shape \(3,\).*\(n, 3\).*try .*\[\[east, north, up\]\]"),
        ({"nodes_m": np.zeros((4, 2))}, r"nodes_m: given shape \(4, 2\).*zeros for heights"),
        ({"nodes_m": np.zeros((3, 5))}, r"nodes_m: given shape \(3, 5\).*\.T"),
        ({"nodes_m": [[0, 0, 0], [1, 2]]}, "nodes_m: .*rows of equal length"),
        ({"jammers_m": np.zeros((2, 2, 3))}, r"jammers_m: given shape \(2, 2, 3\)"),
        ({"node_power_w": [1.0, 2.0, 3.0]}, r"node_power_w: given shape \(3,\) with 2 nodes.*\(2,\)"),
    ],
)
def test_a_wrong_shape_is_told_as_a_shape(given: dict, told: str) -> None:
    """The message has the shape that was given, the one that is allowed, and what to try."""
    with pytest.raises(UsageError, match=told):
        Scenario.from_arrays(**{"nodes_m": NODES_M, "noise_w": 1e-3, "altitude_m": (8, 30)} | given)


def test_a_carrier_takes_the_place_of_the_papers_path_gain() -> None:
    """The default of 0 dB gives way to a frequency; both stated are refused as in a file."""
    arguments = {"noise_w": 1e-9, "altitude_m": (8, 30), "receiver": {"frequency_hz": 2.4e9}}
    scene = Scenario.from_arrays(NODES_M, **arguments)
    assert 10.0 * np.log10(scene.receiver.reference_gain) == pytest.approx(-40.05, abs=5e-3)
    with pytest.raises(ScenarioError, match="both reference_gain_db and frequency_hz"):
        Scenario.from_arrays(NODES_M, **arguments, reference_gain_db=0.0)
    stated = Scenario.from_arrays(NODES_M, **arguments | {"receiver": {"reference_gain_db": -7.0}})
    assert stated.receiver.reference_gain_db == -7.0
