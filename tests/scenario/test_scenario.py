"""Scenarios built in Python: values, arrays, identity."""

import json
import pickle
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st

from nullpose.errors import ScenarioError
from nullpose.scenario import (
    Airspace,
    Eavesdropper,
    Jammer,
    Node,
    Receiver,
    Scenario,
    Transmitter,
    apply_overrides,
    load,
)
from scenes import EXAMPLES, NODE, small


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


SCENARIOS = sorted(path for path in EXAMPLES.glob("*.toml") if not path.stem.startswith("study"))  # a spec

watts = st.floats(1e-30, 1e30)
titles = st.text(st.characters(exclude_categories=["C", "Z"]), max_size=12)

lengths = st.floats(0.01, 3.0)
places = st.lists(st.tuples(*[st.integers(-500, 500).map(float)] * 3), unique=True, min_size=4, max_size=4)
optional_label = st.none() | st.text(
    st.characters(exclude_categories=["C", "Z"]), min_size=1, max_size=4
).filter(lambda name: name not in ("S1", "S2", "M1"))
extents = st.none() | lengths

airframes = st.one_of(
    st.none(),
    st.fixed_dictionaries(
        {"tilt_max_deg": st.floats(0.0, 180.0)}, optional={"mount_deg": st.floats(0.0, 90.0)}
    ),
    st.fixed_dictionaries({"preset": st.sampled_from(["omnidirectional", "level", "hexarotor-tilted-30"])}),
)
zones = st.one_of(
    st.fixed_dictionaries({"x_m": st.just([0.0, 5.0]), "y_m": st.just([-5.0, 5.0])}),
    st.fixed_dictionaries({"centre_m": st.just([3.0, 4.0]), "radius_m": lengths}),
    st.fixed_dictionaries({"polygon_m": st.just([[0.0, 0.0], [4.0, 1.0], [2.0, 7.0]])}),
)


def stated(**values: Any) -> dict[str, Any]:
    """Returns the values that are not None."""
    return {key: value for key, value in values.items() if value is not None}


@st.composite
def scenarios(draw: st.DrawFn) -> Scenario:
    """Returns scenarios of either objective in which anything may be stated."""
    at = draw(places)
    secret = draw(st.booleans())
    kinds = draw(st.lists(zones, max_size=3))
    no_fly = [zone | stated(altitude_m=draw(st.none() | st.just([0.0, 9.0]))) for zone in kinds]
    fence = [[-600.0, -600.0], [600.0, -600.0], [600.0, 600.0], [0.0, 100.0], [-600.0, 600.0]]
    margin = draw(st.sampled_from([{}, {"weight": 2.5}, {"min_sinr_db": -3.0}]))
    noise = draw(st.sampled_from([{}, {"noise_w": 2e-3, "jamming_dbm": 3.0}, {"noise_dbm": 1.0}]))
    uncertain = stated(uncertainty_m=draw(extents))
    errors = {"attitude_error_deg": draw(st.sampled_from([0.0, 2.0])), "position_error_m": draw(lengths)}
    data = stated(
        name=draw(titles),
        airspace=stated(
            altitude_m=[600.0, 700.0],
            keep_out_m=10.0,
            geofence_m=draw(st.sampled_from([None, fence])),
            no_fly=no_fly or None,
        ),
        receiver={"noise_w": draw(watts), "reference_gain_db": 0.0} | errors,
        airframe=draw(airframes),
        nodes=[
            {"position_m": at[0]} | (noise if secret else margin | {"power_w": 1.0}),
            {"position_m": at[1], "power_dbm": draw(st.floats(-270.0, 330.0))},
        ],
        jammers=[{"position_m": at[2], "power_w": 1.0} | uncertain],
    )
    if secret:
        data |= {
            "objective": "secrecy-rate",
            "transmitter": {"power_w": 1.0},
            "eavesdroppers": [{"position_m": at[3]} | uncertain | stated(name=draw(optional_label))],
        }
    return Scenario.from_dict(data)


@given(scenarios())
def test_round_trips(scenario: Scenario) -> None:
    """By TOML, JSON, pickle and copy a scenario is equal to the last bit; no default is written."""
    data = scenario.to_dict()
    copies = [
        Scenario.from_dict(tomllib.loads(scenario.to_toml())),
        Scenario.from_dict(json.loads(json.dumps(data, allow_nan=False))),
        pickle.loads(pickle.dumps(scenario)),
        scenario.model_copy(),
        apply_overrides(scenario, []),
    ]
    assert all(copy == scenario and hash(copy) == hash(scenario) for copy in copies)
    assert ("objective" in data) is (scenario.objective == "secrecy-rate")
    assert ("eavesdroppers" in data) is bool(scenario.eavesdroppers)
    assert ("attitude_error_deg" in data["receiver"]) is (scenario.receiver.attitude_error_deg > 0.0)
    assert ("no_fly" in data["airspace"]) is bool(scenario.airspace.no_fly)
    assert "mount_deg" not in data.get("airframe", {}) or scenario.airframe.mount_deg > 0.0
    assert all(None not in table.values() for table in data.values() if isinstance(table, dict))


@pytest.mark.parametrize("example", SCENARIOS, ids=lambda path: path.name)
def test_examples_round_trip(example: Path, tmp_path: Path) -> None:
    """Every example loads, and loads equal from what it is written back as."""
    scenario = load(example)
    (tmp_path / "copy.toml").write_text(scenario.to_toml(), encoding="utf-8")
    assert load(tmp_path / "copy.toml") == scenario == Scenario.from_dict(scenario.to_dict())
