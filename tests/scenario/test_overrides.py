"""Single values changed by path."""

import numpy as np
import pytest

from nullpose.errors import ScenarioError
from nullpose.scenario import Airframe, NoFlyZone, Override, Scenario, apply_overrides, load, parse_override
from nullpose.scenario.geodesy import enu_from_geodetic
from scenes import EXAMPLES, small

NO_ASSIGNMENTS = ("", "=", "a", "a=", "=1", " = 1", "a= ")
PAPER = load(EXAMPLES / "paper.toml")


def faults_of(*overrides: str | Override, scenario: Scenario = PAPER) -> dict[str, str]:
    """Returns the messages, by path, with which overrides are refused."""
    with pytest.raises(ScenarioError) as caught:
        apply_overrides(scenario, overrides)
    assert caught.value.source.startswith("override")
    return {fault.path: fault.message for fault in caught.value.faults}


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a=1", 1),
        (" a = 1 ", 1),
        ("a=.5", 0.5),
        ("a=5.", 5.0),
        ("a=[5, 20]", [5, 20]),
        ("a=true", True),
        ('a="10"', "10"),
        ("a='x=y'", "x=y"),
        ("a=word", "word"),
        ("a=10 W", "10 W"),
        ("a={x = 1}", {"x": 1}),
        ("a=[]", []),
    ],
)
def test_values_are_toml_or_bare_words(text: str, value: object) -> None:
    """A value is read as TOML; what is not, is a number to anyone else or a text."""
    assert parse_override(text) == Override("a", value)
    assert type(parse_override(text).value) is type(value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        *((text, r"an equals sign and a value, as in jammers\.M\.power_w=10") for text in NO_ASSIGNMENTS),
        *((text, "is not TOML") for text in ("a=[1, 2", "a={x", 'a="x', "a='x", "a=1\nb=2")),
    ],
)
def test_what_is_no_assignment(text: str, words: str) -> None:
    """Without a path or a value the form is named; what does not end, or goes on, is not TOML."""
    with pytest.raises(ScenarioError, match=words):
        parse_override(text)


@pytest.mark.parametrize(
    ("override", "table", "update"),
    [
        ("jammers.M.power_w=10", "jammers", {"power_w": 10.0}),
        ("jammers[0].power_w=10", "jammers", {"power_w": 10.0}),
        ("jammers.'M'.power_w=10", "jammers", {"power_w": 10.0}),
        ('jammers."M".power_w=10', "jammers", {"power_w": 10.0}),
        ("nodes.S1.position_m[2]=3", "nodes", {"position_m": (0.0, 0.0, 3.0)}),
        ("airspace.altitude_m=[5, 20]", "airspace", {"altitude_m": (5.0, 20.0)}),
        ("airspace.x_m=[-9, 9]", "airspace", {"x_m": (-9.0, 9.0)}),
        ("receiver.noise_dbm=-90", "receiver", {"noise_dbm": -90.0, "noise_w": None}),
        ("receiver.frequency_hz=1e9", "receiver", {"frequency_hz": 1e9, "reference_gain_db": None}),
    ],
)
def test_one_value_is_changed(override: str, table: str, update: dict[str, object]) -> None:
    """Found by name, quoted or not, or by index; all else stays, but another unit of the same is dropped."""
    stated = getattr(PAPER, table)
    first = (stated[0] if isinstance(stated, tuple) else stated).model_copy(update=update)
    changed = (first, *stated[1:]) if isinstance(stated, tuple) else first
    assert apply_overrides(PAPER, [override]) == PAPER.model_copy(update={table: changed})


def test_keys_of_tables_that_are_not_there_yet() -> None:
    """Setting a key begins its table; one that could not be set leaves no trace."""
    assert apply_overrides(PAPER, ["airframe.tilt_max_deg=10"]).airframe == Airframe(tilt_max_deg=10.0)
    changes = ["objective=secrecy-rate", "transmitter.power_dbm=30"]
    changes += ["eavesdroppers=[{position_m = [9, 9, 0]}]", "eavesdroppers.E1.noise_dbm=-90"]
    secret = apply_overrides(PAPER, changes)
    assert secret.eavesdroppers[0].noise_dbm == -90.0
    assert list(faults_of("airframe.tilt_deg=10")) == ["airframe.tilt_deg"]


def test_zones_and_fences() -> None:
    """Zones are members by name or index, and of a fence each number has a place."""
    fenced = apply_overrides(
        PAPER,
        [
            "airspace.geofence_m=[[-50, -50], [50, -50], [50, 90], [-50, 90]]",
            "airspace.geofence_m[2][1]=99",
            "airspace.no_fly=[{name = 'tower', centre_m = [17, 15], radius_m = 5}, {x_m=[0, 1], y_m=[0, 1]}]",
            "airspace.no_fly.tower.radius_m=6",
            "airspace.no_fly[0].centre_m[0]=18",
            "airspace.no_fly.Z2.altitude_m=[0, 9]",
        ],
    )
    assert fenced.airspace.geofence_m[2] == (50.0, 99.0)
    assert fenced.airspace.no_fly[0] == NoFlyZone(name="tower", centre_m=(18, 15), radius_m=6)
    assert fenced.airspace.no_fly[1].altitude_m == (0.0, 9.0)
    message = faults_of("airspace.no_fly.towr.radius_m=6", scenario=fenced)["airspace.no_fly.towr.radius_m"]
    assert "got towr, must be one of [0], [1], tower, Z2" in message


def test_later_overrides_win_and_see_earlier_ones() -> None:
    """Overrides are applied in order, and only the outcome has to be a scenario."""
    assert apply_overrides(PAPER, ["name=a", "name=windy day"]).name == "windy day"
    assert apply_overrides(PAPER, ["nodes.S1.name=gate", "nodes.gate.power_w=7"]).nodes[0].power_w == 7.0
    risen = apply_overrides(PAPER, ["airspace.altitude_m[0]=40", "airspace.altitude_m[1]=50"])
    assert risen.airspace.altitude_m == (40.0, 50.0)


def test_names_that_need_quotes() -> None:
    """A name with a dot, a bracket or an equals sign is reached in quotes."""
    dotted = apply_overrides(PAPER, ['nodes.S1.name="a.b=[c]"'])
    assert apply_overrides(dotted, ['nodes."a.b=[c]".power_w=5']).nodes[0].power_w == 5.0
    message = faults_of("nodes.ab.power_w=5", scenario=apply_overrides(PAPER, ["nodes.S1.name='a b'"]))
    assert 'did you mean nodes."a b".power_w?' in message["nodes.ab.power_w"]


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("jammer.M.power_w", "did you mean jammers.M.power_w?"),
        ("power_w", "must be one of name, objective"),
        ("jammers.N.power_w", "got N, must be one of [0], M; did you mean jammers.M.power_w?"),
        ("jammers[1].power_w", "got [1], must be one of [0], M"),
        ("airspace.keepout", "did you mean airspace.keep_out_m?"),
        ("receiver[0]", "must be one of noise_w"),
        ("airspace.altitude_m[2]", "got [2], must be one of [0], [1]"),
        ("airspace.altitude_m[0][0]", "it has no members, so set it whole"),
        ("name.first", "it has no members, so set it whole"),
        ("jammers..power_w", "this is not a path"),
        ("nodes[-1].power_w", "this is not a path"),
        ("[0].power_w", "must be one of name, objective"),
    ],
)
def test_paths_that_lead_nowhere(path: str, words: str) -> None:
    """A path that does not exist is named, with the place where it ends and what there is."""
    ((given, message),) = faults_of(f"{path}=1").items()
    assert given == path
    assert words in message


def test_every_fault_of_every_override_at_once() -> None:
    """Missing paths, broken values and faulty results are reported together."""
    faults = faults_of("jammers.N.power_w=1", "name=[", "noise", "jammers.M.power_w=-1", "nodes.S1.name=M")
    assert list(faults) == ["jammers.N.power_w", "name", "noise", "jammers[0].name", "jammers[0].power_w"]


POINT = {"lat_deg": 50.001, "lon_deg": 14.502, "alt_m": 232.0, "power_w": 1.0}
ORIGIN = {"lat_deg": 50.0, "lon_deg": 14.5, "alt_m": 230.0}
EARTHLY = Scenario.from_dict(small(origin=ORIGIN, nodes=[POINT, POINT | {"lat_deg": 50.002}]))


@pytest.mark.parametrize(
    ("override", "lat_deg", "origin_lat_deg"),
    [
        ("nodes.S1.lat_deg=50.003", 50.003, 50.0),
        ("origin.lat_deg=50.001", 50.001, 50.001),
        ("origin={lat_deg = 50.001, lon_deg = 14.5, alt_m = 230.0}", 50.001, 50.001),
    ],
)
def test_points_stay_on_the_earth(override: str, lat_deg: float, origin_lat_deg: float) -> None:
    """A latitude moves its point alone, to the last bit; metres change when the origin moves."""
    changed = apply_overrides(EARTHLY, [override])
    place = enu_from_geodetic([lat_deg, 14.502, 232.0], [origin_lat_deg, 14.5, 230.0])
    np.testing.assert_array_equal(changed.node_positions_m[0], place)
    assert [node.lat_deg for node in changed.nodes] == [lat_deg, 50.002]
    if origin_lat_deg == 50.0:
        np.testing.assert_array_equal(changed.node_positions_m[1], EARTHLY.node_positions_m[1])


@pytest.mark.parametrize("override", ["nodes.S1.position_m=[5, 222, 2]", "nodes.S1.position_m[0]=5"])
def test_metres_replace_the_latitude(override: str) -> None:
    """A position in metres, or one of its numbers, replaces the place on the Earth."""
    changed = apply_overrides(EARTHLY, [override])
    assert changed.nodes[0].position_m[0] == 5.0
    assert changed.nodes[0].lat_deg is None
    assert changed.nodes[1] == EARTHLY.nodes[1]


@pytest.mark.parametrize(
    ("name", "override"), [("geodetic", "nodes_from=nodes.csv"), ("frame", "antenna.file=other.out")]
)
def test_no_override_names_a_file(name: str, override: str) -> None:
    """What was read of a file is not kept for another, and no other is read."""
    scenario = load(EXAMPLES / f"{name}.toml")
    path, message = next(iter(faults_of(override, scenario=scenario).items()))
    assert path == override.split("=")[0]
    assert "only a scenario file on this machine may name" in message
