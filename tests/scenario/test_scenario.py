"""Scenarios built in Python: values, arrays, identity."""

import pickle

import numpy as np
import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Airspace, Jammer, Node, Receiver, Scenario
from scenes import NODE, small


def paper_scenario() -> Scenario:
    """Returns the paper's scenario, built without a file."""
    return Scenario(
        name="paper",
        airspace=Airspace(altitude_m=(8.0, 30.0)),
        receiver=Receiver(noise_w=1e-3, reference_gain_db=0.0),
        nodes=(Node(position_m=(0, 0, 0), power_w=1), Node(position_m=(0, 50, 0), power_dbm=30)),
        jammers=(Jammer(name="M", position_m=(17.0, 15.0, 4.0), power_w=10.0),),
    )


@pytest.mark.parametrize(
    "array", ["node_positions_m", "node_powers_w", "jammer_positions_m", "jammer_powers_w"]
)
def test_arrays_are_cached_and_read_only(array: str) -> None:
    """An array is the same object on every access and refuses to be written to, after unpickling too."""
    scenario = paper_scenario()
    assert getattr(scenario, array) is getattr(scenario, array)
    for one in (scenario, pickle.loads(pickle.dumps(scenario))):
        with pytest.raises(ValueError, match="read-only"):
            getattr(one, array)[...] = 0.0


def test_plain_values_and_numpy_are_accepted() -> None:
    """Tables may be dictionaries, lists tuples or arrays, numbers numpy's; the result is equal."""
    nodes = (
        {"name": "S1", "position_m": np.zeros(3), "power_w": 1},
        {"position_m": [0, np.int32(50), np.float64(0.0)], "power_dbm": np.float32(30.0)},
    )
    loose = Scenario.from_dict(
        {
            "name": "paper",
            "airspace": {"altitude_m": np.array([8, 30])},
            "receiver": {"noise_w": np.float64(1e-3), "reference_gain_db": np.int64(0)},
            "nodes": nodes,
            "jammers": [Jammer(name="M", position_m=np.array([17.0, 15.0, 4.0]), power_w=10)],
        }
    )
    assert loose.node_positions_m is not None  # a cached array is no part of the value
    assert loose == paper_scenario()
    assert hash(loose) == hash(paper_scenario())
    assert loose != loose.model_copy(update={"name": "other"})
    assert Node(position_m=(0, 0, 0), power_w=1) != Jammer(position_m=(0, 0, 0), power_w=1)
    assert type(loose.nodes[0].position_m) is tuple
    assert all(type(value) is float for node in loose.nodes for value in node.position_m)


def test_names_left_out_follow_the_place() -> None:
    """Unnamed nodes are S1, S2 and so on by their place in the list, unnamed jammers M1, M2."""
    gate = NODE | {"position_m": (1.0, 0.0, 0.0), "name": "gate"}
    nodes = [NODE, gate, Node(position_m=(2.0, 0.0, 0.0), power_w=1.0)]
    jammers = [Jammer(position_m=(3.0, 0.0, 0.0), power_w=1.0)]
    scenario = Scenario(**small(nodes=nodes, jammers=jammers))
    assert scenario.node_names == ("S1", "gate", "S3")
    assert scenario.jammer_names == ("M1",)
    assert scenario.name == ""


def test_direct_construction_raises_every_fault() -> None:
    """Building in Python raises the same ScenarioError as a file, with all faults and no source."""
    with pytest.raises(ScenarioError) as caught:
        Scenario(
            airspace={"altitude_m": (30.0, 8.0)},
            receiver={"noise_w": float("nan"), "reference_gain_db": 0.0},
            nodes=[{"position_m": np.zeros(2), "power_w": np.float64(-1.0)}, 3],
            jammers=Jammer(position_m=(0.0, 0.0, 0.0), power_w=1.0),
            colour="blue",
        )
    assert [fault.path for fault in caught.value.faults] == [
        "airspace.altitude_m",
        "receiver.noise_w",
        "nodes[0].position_m",
        "nodes[0].power_w",
        "nodes[1]",
        "jammers",
        "colour",
    ]
    assert caught.value.source == ""
    assert "an object of type Jammer" in str(caught.value)
    assert caught.value.__cause__ is None
    assert caught.value.__suppress_context__


@pytest.mark.parametrize(
    "data", [None, 3, [], "scenario", [("name", "x")], {1: 2, "name": "x"}, {"nodes": [{1: 2}]}]
)
def test_from_dict_refuses_what_is_no_table(data: object) -> None:
    """Anything that is no mapping with texts for keys is refused by ScenarioError."""
    with pytest.raises(ScenarioError):
        Scenario.from_dict(data)


def test_model_copy_is_validated() -> None:
    """A copy with a changed value is validated and carries no stale array."""
    scenario = paper_scenario()
    before = scenario.jammer_powers_w
    louder = scenario.jammers[0].model_copy(update={"power_w": 99.0})
    changed = scenario.model_copy(update={"jammers": (louder,)})
    assert before.tolist() == [10.0]
    assert changed.jammer_powers_w.tolist() == [99.0]
    with pytest.raises(ScenarioError, match="power_w: got -1"):
        louder.model_copy(update={"power_w": -1})


def test_scenarios_are_frozen() -> None:
    """Values can be neither set nor deleted."""
    scenario = paper_scenario()
    with pytest.raises(ValueError, match="frozen"):
        scenario.name = "other"
    with pytest.raises(ValueError, match="frozen"):
        del scenario.nodes[0].power_w
    assert scenario == paper_scenario()
