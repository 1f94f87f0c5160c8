"""Scene i is the same anywhere, and drawn as the spec says."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from scipy import stats

from nullpose import Scenario, ScenarioError, UsageError
from nullpose.scenario import Eavesdropper, Jammer, Node
from nullpose.study.monte_carlo import StudySpec, draw_scene, scene_at

Spec = Callable[..., StudySpec]


def _drawn(spec: StudySpec, kind: str, count: int = 400) -> list[Any]:
    return [point for index in range(count) for point in getattr(draw_scene(spec, index), kind)]


def _plane_m(points: list[Any]) -> np.ndarray[Any, Any]:
    return np.array([point.position_m[:2] for point in points])


@given(seed=st.integers(0, 10**15), index=st.integers(0, 10**6), scenes=st.integers(1, 10**8))
def test_a_scene_depends_on_seed_and_number_alone(spec: Spec, seed: int, index: int, scenes: int) -> None:
    """Neither the number of scenes, nor cases, nor what is swept changes a scene."""
    one = spec(seed=seed, scenes=index + 1)
    cases, sweep = [{"scheme": "vertical"}], {"jammers.M.power_w": [1.0, 2.0]}
    other = spec(seed=seed, scenes=index + scenes, gap=1e-3, cases=cases, sweep=sweep)
    assert draw_scene(one, index) == draw_scene(other, index)
    swept = scene_at(other, index, 1)
    assert swept.jammers[0].power_w == 2.0
    assert swept.jammers[0].position_m == draw_scene(one, index).jammers[0].position_m


@given(index=st.integers(0, 10**6))
def test_one_kind_leaves_the_others(spec: Spec, index: int) -> None:
    """Other jammers leave the nodes as they are, and other powers the places."""
    scene = draw_scene(spec(scenes=10**7), index)
    farther = draw_scene(spec(scenes=10**7, jammers__radius_m=90.0, jammers__count=3), index)
    stronger = draw_scene(spec(scenes=10**7, jammers__power_w=5.0), index)
    assert farther.nodes == stronger.nodes == scene.nodes
    assert stronger.jammers[0].position_m == scene.jammers[0].position_m


@given(index=st.integers(0, 10**6), count=st.integers(1, 20))
def test_more_points_keep_the_first(spec: Spec, index: int, count: int) -> None:
    """A scene with more nodes has those of the one with fewer, in the same places with the same powers."""
    changes = {"nodes__power_w": {"uniform": [1.0, 2.0]}, "nodes__height_m": {"normal": [0.0, 1.0]}}
    drawn = spec(scenes=10**7, sweep={"nodes.count": [count, count + 5]}, **changes)
    few, many = scene_at(drawn, index, 0), scene_at(drawn, index, 1)
    assert (len(few.nodes), len(many.nodes)) == (count, count + 5)
    assert many.nodes[:count] == few.nodes


def test_a_known_scene_stays_what_it_is(spec: Spec) -> None:
    """The numbers behind a seed are those of the first release: a study can be told by its spec."""
    scene = draw_scene(spec(), 5)
    assert scene.nodes[0].position_m == pytest.approx(KNOWN_NODE_M, abs=1e-12)
    assert scene.jammers[0].position_m == pytest.approx(KNOWN_JAMMER_M, abs=1e-12)
    assert scene.jammers[0].power_w == pytest.approx(KNOWN_POWER_W, abs=1e-12)


def test_a_disc_is_filled_evenly(spec: Spec) -> None:
    """Squared distances from the centre and bearings are uniform."""
    offsets_m = _plane_m(_drawn(spec(scenes=10**6), "jammers", 500)) - [0.0, 25.0]
    shares = np.sum(offsets_m**2, axis=1) / 60.0**2
    bearings = np.arctan2(offsets_m[:, 1], offsets_m[:, 0]) / (2.0 * math.pi) + 0.5
    assert shares.max() <= 1.0
    assert stats.kstest(shares, "uniform").pvalue > 0.01
    assert stats.kstest(bearings, "uniform").pvalue > 0.01
    assert abs(stats.spearmanr(shares, bearings).statistic) < 0.1


def test_a_rectangle_is_filled_evenly(spec: Spec) -> None:
    """Both coordinates are uniform, and do not go together."""
    places_m = _plane_m(_drawn(spec(scenes=10**6), "nodes"))
    shares = (places_m - [-20.0, 0.0]) / [40.0, 50.0]
    assert stats.kstest(shares[:, 0], "uniform").pvalue > 0.01
    assert stats.kstest(shares[:, 1], "uniform").pvalue > 0.01
    assert abs(stats.spearmanr(shares[:, 0], shares[:, 1]).statistic) < 0.1


def test_a_poisson_process_has_its_mean_and_variance(spec: Spec) -> None:
    """The number of jammers has the variance of its mean, and the names count them."""
    density = 4.0 / (math.pi * 3600.0)
    drawn = spec(
        scenes=10**6, jammers__layout="poisson", jammers__count=None, jammers__density_per_m2=density
    )
    counts = np.array([len(draw_scene(drawn, index).jammers) for index in range(400)])
    assert counts.mean() == pytest.approx(4.0, abs=0.25)
    assert counts.var() == pytest.approx(4.0, rel=0.2)
    assert (counts == 0).any()
    assert draw_scene(drawn, int(counts.argmax())).jammer_names[-1] == f"M{counts.max()}"


def test_a_scene_without_nodes_is_drawn_again(spec: Spec) -> None:
    """A Poisson process of nodes is one of at least one node."""
    nodes = {"layout": "poisson", "density_per_m2": 1e-3, "x_m": [0, 20], "y_m": [0, 40], "power_w": 1.0}
    drawn = spec(scenes=10**6, nodes=nodes)
    counts = [len(draw_scene(drawn, index).nodes) for index in range(500)]
    assert min(counts) == 1
    truncated = 0.8 / -math.expm1(-0.8)
    assert np.mean(counts) == pytest.approx(truncated, abs=0.1)


def test_clusters_spread_about_their_centres(spec: Spec) -> None:
    """Each cluster has its number of points, with the spread stated."""
    nodes = {
        "layout": "clusters",
        "parents": [2, 3],
        "count": 40,
        "spread_m": 2.0,
        "x_m": [-500, 500],
        "y_m": [-500, 500],
        "power_w": 1.0,
    }
    drawn = spec(scenes=10**6, nodes=nodes)
    spreads, sizes = [], set()
    for index in range(20):
        places_m = _plane_m(list(draw_scene(drawn, index).nodes)).reshape(-1, 40, 2)
        sizes.add(len(places_m))
        spreads += list(places_m.std(axis=1).ravel())
    assert sizes == {2, 3}
    assert np.mean(spreads) == pytest.approx(2.0, rel=0.05)


def test_counts_are_drawn_evenly(spec: Spec) -> None:
    """Each number of a range is as likely as another, both ends included."""
    drawn = spec(scenes=10**6, jammers__count=[0, 3])
    counts = np.bincount([len(draw_scene(drawn, index).jammers) for index in range(400)])
    assert len(counts) == 4
    assert stats.chisquare(counts).pvalue > 0.01


def test_no_valid_scene_is_an_error(spec: Spec) -> None:
    """Where every draw is refused, the drawing ends, and says how often it was tried."""
    cramped = spec(
        scene__airspace={"altitude_m": [1, 2], "x_m": [0, 1], "y_m": [0, 1], "keep_out_m": 500.0},
    )
    with pytest.raises(ScenarioError, match=r"no room for the vehicle.*after 100 draws"):
        draw_scene(cramped, 0)


def test_points_that_meet_the_vehicle_are_drawn_again(spec: Spec) -> None:
    """Jammers whose uncertainty reaches into the airspace are drawn elsewhere; the nodes stay."""
    heights = {"uniform": [0.0, 7.0]}
    drawn = spec(scenes=10**6, jammers__uncertainty_m=5.0, jammers__height_m=heights)
    heights_m = [draw_scene(drawn, index).jammers[0].position_m[2] for index in range(200)]
    assert max(heights_m) < 3.0
    plain = spec(scenes=10**6)
    assert all(draw_scene(drawn, index).nodes == draw_scene(plain, index).nodes for index in range(20))


def test_a_star_sets_every_point_of_a_kind(spec: Spec) -> None:
    """A swept path with a star reaches all, however many; a key takes the place of its other unit."""
    drawn = spec(scenes=50, jammers__count=[0, 3], sweep={"jammers.*.power_w": [7.0]})
    for index in range(50):
        assert {jammer.power_w for jammer in scene_at(drawn, index, 0).jammers} <= {7.0}
    (jammer,) = scene_at(spec(sweep={"jammers.power_dbm": [20.0]}), 0, 0).jammers
    assert (jammer.power_w, jammer.power_dbm) == (None, 20.0)


def test_files_take_turns(spec: Spec, paper: Scenario) -> None:
    """With several files scene i is the i-th of them, begun anew after the last; the rest is drawn."""
    other = paper.model_copy(update={"receiver": {"noise_w": 2e-3, "reference_gain_db": 0.0}})
    scene = {"scenarios": [paper.to_dict(), other.to_dict()]}
    drawn = spec(scene=scene, nodes=None, scenes=4)
    noises = [draw_scene(drawn, index).receiver.noise_w for index in range(4)]
    assert noises == [1e-3, 2e-3, 1e-3, 2e-3]
    assert draw_scene(drawn, 0).node_names == paper.node_names
    assert draw_scene(drawn, 0).jammers[0].position_m != draw_scene(drawn, 2).jammers[0].position_m


def test_what_is_not_drawn_stays(spec: Spec, paper: Scenario) -> None:
    """Every table of a file is kept in its scenes, the antenna too; so is one stated in the spec."""
    stated = paper.to_dict() | {"antenna": {"null_depth_db": 30.0}, "airframe": {"tilt_max_deg": 10.0}}
    tables = {key: stated[key] for key in ("airspace", "receiver", "antenna", "airframe")}
    for scene in ({"scenarios": [stated]}, tables):
        drawn = draw_scene(spec(scene=scene), 0)
        assert drawn.antenna_record.leak == pytest.approx(1e-3)
        assert drawn.airframe.tilt_max_deg == 10.0


WHIP = {"antenna": "dipole", "antenna_axis": [1.0, 0.0, 1.0], "null_depth_db": 20.0, "gain_dbi": 2.15}
BALL = {"uncertainty_m": 2.0}
DOWNLINK = {"noise_dbm": -90.0, "jamming_dbm": -80.0}
DISC = {"layout": "disc", "count": 3, "centre_m": [0.0, 25.0], "radius_m": 60.0}


def _template(kind: str, *states: dict[str, Any]) -> dict[str, Any]:
    """A scene that states points of a kind, as the part of a spec that is not drawn."""
    transmits = kind == "eavesdroppers" or any("noise" in key for key in states[0])
    other: dict[str, Any] = (
        {"objective": "secrecy-rate", "transmitter": {"power_w": 1.0}} if transmits else {}
    )
    tables = {"nodes": [{"position_m": [90.0, 0.0, 0.0]} | ({} if transmits else {"power_w": 1.0})]}
    tables |= {"eavesdroppers": [{"position_m": [0.0, 90.0, 0.0]}]} if transmits else {}
    tables[kind] = [{"position_m": [9.0 * n, 0.0, 1.5], **state} for n, state in enumerate(states)]
    receiver = {"noise_w": 1e-3, "reference_gain_db": 0.0}
    return {"airspace": {"altitude_m": [8.0, 30.0]}, "receiver": receiver, **other, **tables}


COLLINEAR = [[-90.0, -20.0], [0.0, 3.0], [90.0, -20.0]]
STATES: list[tuple[str, dict[str, Any]]] = [
    ("nodes", {"power_dbm": 20.0, "min_sinr_db": 3.0, **WHIP}),
    ("nodes", {"power_w": 2.0, "weight": 2.0, "antenna": "circular"}),
    ("nodes", DOWNLINK),
    ("nodes", {"noise_w": 1e-5, "jamming_w": 1e-5}),
    ("jammers", {"power_w": 3.0, **WHIP, **BALL}),
    (
        "jammers",
        {"power_w": 3.0, "antenna": "profile", "antenna_file": "whip.csv", "antenna_profile": COLLINEAR},
    ),
    ("jammers", {"power_dbm": 33.0, "channel": {"model": "free-space"}}),
    ("eavesdroppers", {"noise_dbm": -90.0, **WHIP, **BALL}),
    ("eavesdroppers", {"noise_w": 1e-5}),
    ("eavesdroppers", {"bandwidth_hz": 2e7, "noise_figure_db": 6.0}),
]


@pytest.mark.parametrize(("kind", "state"), STATES)
def test_drawn_points_keep_what_those_of_the_scene_state(
    spec: Spec, kind: str, state: dict[str, Any]
) -> None:
    """Antennas, powers, weights, noise, uncertainty and height are those of the points that they replace."""
    power = {key: value for key, value in state.items() if kind == "jammers" and key.startswith("power")}
    unused = dict.fromkeys({"nodes", "jammers"} - {kind})
    study = spec(**{**unused, kind: DISC | power, "scene": _template(kind, state, state)})
    points = getattr(draw_scene(study, 0), kind)
    assert len(points) == 3
    assert {point.position_m[2] for point in points} == {1.5}
    for point in points:
        told = point.to_dict()
        assert {key: told[key] for key in told if key not in ("name", "position_m")} == state
    assert StudySpec.from_dict(study.to_dict()) == study


def test_every_key_of_a_point_is_tried() -> None:
    """A key that ground points gain is among those that drawn ones are known to keep."""
    tried = {key for _, state in STATES for key in state}
    keys = {key for kind in (Node, Jammer, Eavesdropper) for key in kind.model_fields}
    places = {"position_m", "lat_deg", "lon_deg", "alt_m", "alt_msl_m", "alt_agl_m"}
    motion = {"velocity_m_s", "track", "track_from"}  # the scenes of a study are still
    assert keys - tried == {"name", "from"} | places | motion  # names are those of the file


def test_what_a_draw_states_takes_the_place_of_the_scenes(spec: Spec) -> None:
    """With what describes it further, and its other units; the rest is kept."""
    nodes = {**DISC, "antenna": "isotropic", "power_w": 4.0, "height_m": 2.0}
    scene = _template("nodes", STATES[0][1])
    (node, *_) = draw_scene(spec(jammers=None, nodes=nodes, scene=scene), 0).nodes
    assert (node.antenna, node.antenna_axis, node.power_w, node.power_dbm) == ("isotropic", None, 4.0, None)
    assert (node.gain_dbi, node.min_sinr_db, node.position_m[2]) == (0.0, 3.0, 2.0)
    whips = {**DISC, "antenna": "dipole", "antenna_axis": [0.0, 1.0, 0.0], "gain_dbi": 1.76}
    (node, *_) = draw_scene(spec(jammers=None, nodes=whips, scene=scene), 0).nodes
    assert (node.antenna, node.antenna_axis, node.gain_dbi) == ("dipole", (0.0, 1.0, 0.0), 1.76)
    assert (
        draw_scene(spec(jammers=None, nodes=DISC | {"gain_dbi": 5.0}, scene=scene), 0).nodes[0].antenna
        == "dipole"
    )


@pytest.mark.parametrize(
    ("one", "other", "key"),
    [
        (WHIP, {}, "antenna"),
        (WHIP, WHIP | {"antenna_axis": [0.0, 0.0, 1.0]}, "antenna_axis"),
        ({"weight": 2.0}, {}, "weight"),
        ({"position_m": [40.0, 0.0, 9.0]}, {}, "height_m"),
        ({"power_w": 2.0}, {}, "power_w"),
    ],
)
def test_points_that_differ_are_not_replaced_in_silence(
    spec: Spec, one: dict[str, Any], other: dict[str, Any], key: str
) -> None:
    """Where the points of the scene differ in a key, the spec has to state it."""
    base = {"power_w": 1.0}
    scene = _template("nodes", base | one, base | other)
    with pytest.raises(ScenarioError) as caught:
        spec(jammers=None, nodes=DISC, scene=scene)
    faults = {fault.path: fault.message for fault in caught.value.faults}
    assert f"nodes.{key}" in faults
    assert "the scene's nodes, which are to be replaced, differ" in faults[f"nodes.{key}"]
    files = {"scenarios": [_template("nodes", base), scene]}
    with pytest.raises(ScenarioError, match=f"nodes.{key}"):
        spec(jammers=None, nodes=DISC, scene=files)


@pytest.mark.parametrize("index", [-1, 12, 1.5, True])
def test_a_scene_that_is_not_there(spec: Spec, index: Any) -> None:
    """Numbers outside the study are refused, with those that are in it."""
    with pytest.raises(UsageError, match="allowed: 0 to 11"):
        draw_scene(spec(), index)
    with pytest.raises(UsageError, match="allowed: 0 to 0"):
        scene_at(spec(), 0, 1)


KNOWN_NODE_M = (10.829712729719212, 0.5433872580263732, 0.0)
KNOWN_JAMMER_M = (19.44788720350625, 59.64147457992614, 4.0)
KNOWN_POWER_W = 0.12169329644213805
