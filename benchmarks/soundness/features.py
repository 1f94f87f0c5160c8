"""Random scenes for each thing that a scenario can ask for beyond the paper, made from their number alone."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from benchmarks.soundness.ends import channel_ends, narrow_airframe, quiet, rescaled, with_depths
from benchmarks.soundness.scenes import Scene
from benchmarks.soundness.search import feasible, nearest_in_band
from nullpose.channel import ENVIRONMENTS
from nullpose.errors import ScenarioError
from nullpose.physics import Reception
from nullpose.problem.build import build_family
from nullpose.scenario import Scenario

FloatArray = NDArray[np.float64]
Table = dict[str, Any]

_NOISE_W = 1e-3


def _plain(rng: np.random.Generator) -> Table:
    """A field of 60 m with two to five nodes and up to two jammers."""
    nodes = rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(2, 6)), 3))
    jammers = rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(0, 3)), 3))
    ratio = 10.0 ** rng.uniform(-2.0, 3.0) / max(1, len(jammers))
    return {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": _NOISE_W, "reference_gain_db": 0.0},
        "nodes": [
            {"position_m": p, "power_w": float(10.0 ** rng.uniform(-0.5, 0.5))} for p in nodes.tolist()
        ],
        "jammers": [{"position_m": p, "power_w": float(ratio)} for p in jammers.tolist()],
    }


def _airframe(rng: np.random.Generator) -> Table:
    """Tilts from none to much, dipoles mounted upright, flat or in between."""
    tilt = float(rng.choice([0.0, 0.0, 2.0, 10.0, 30.0, rng.uniform(0.0, 60.0)]))
    mount = float(rng.choice([0.0, 90.0, 90.0, 45.0, rng.uniform(0.0, 90.0)]))
    return _plain(rng) | {"airframe": {"tilt_max_deg": tilt, "mount_deg": mount}}


def _secrecy(rng: np.random.Generator) -> Table:
    """One to three eavesdroppers, some with better receivers than the nodes."""
    plain = _plain(rng)
    eavesdroppers = rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(1, 4)), 3))
    power_w = float(10.0 ** rng.uniform(-1.0, 1.0))
    jammers = plain["jammers"] if rng.uniform() < 0.3 else []
    heard = [
        {"position_m": p, "noise_w": _NOISE_W * float(10.0 ** rng.uniform(-0.5, 0.5))}
        for p in eavesdroppers.tolist()
    ]
    nodes = [{"position_m": node["position_m"]} for node in plain["nodes"]]
    secrecy = {"objective": "secrecy-rate", "transmitter": {"power_w": power_w}, "eavesdroppers": heard}
    return plain | secrecy | {"nodes": nodes, "jammers": jammers}


def _margins(rng: np.random.Generator) -> Table:
    """Nodes that ask for more than others, as a weight or as a requirement."""
    plain = _plain(rng)
    for node in plain["nodes"]:
        wish = rng.integers(3)
        if wish == 1:
            node["weight"] = float(10.0 ** rng.uniform(-0.7, 0.7))
        elif wish == 2:
            node["min_sinr_db"] = float(rng.uniform(-7.0, 7.0))
    return plain


def _star(rng: np.random.Generator, centre: FloatArray, size: float) -> list[list[float]]:
    """Return a star-shaped polygon, often not convex."""
    count = int(rng.integers(3, 8))
    angles = np.sort(rng.uniform(0.0, 1.0, count) + np.arange(count)) * 2.0 * np.pi / (count + 1.0)
    radii = size * rng.uniform(0.4, 1.3, count)
    corners = centre + radii[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    if not shapely.Polygon(corners).is_valid:  # three corners may leave the centre outside
        return _star(rng, centre, size)
    return [[float(x), float(y)] for x, y in corners]


def _no_fly(rng: np.random.Generator) -> Table:
    """One to three zones of every shape about the middle of the field, some of limited height."""
    zones = []
    for _ in range(int(rng.integers(1, 4))):
        centre, size = rng.uniform(10.0, 50.0, size=2), float(rng.uniform(4.0, 15.0))
        shape = rng.integers(3)
        zone: Table = {"polygon_m": _star(rng, centre, size)}
        if shape == 0:
            east = [centre[0] - size, centre[0] + 0.5 * size]
            zone = {"x_m": east, "y_m": [centre[1] - size, centre[1] + size]}
        elif shape == 1:
            zone = {"centre_m": centre.tolist(), "radius_m": size}
        if rng.uniform() < 0.4:
            zone["altitude_m"] = [0.0, float(rng.uniform(9.0, 25.0))]
        zones.append(zone)
    plain = _plain(rng)
    plain["airspace"]["no_fly"] = zones
    return plain


def _fence(rng: np.random.Generator) -> Table:
    """A fence that often leaves out where it would be best to be."""
    plain = _plain(rng)
    middle, size = rng.uniform(10.0, 50.0, size=2), float(rng.uniform(10.0, 30.0))
    plain["airspace"]["geofence_m"] = _star(rng, middle, size)
    return plain


def _together(rng: np.random.Generator) -> Table:
    """An airframe, requirements and a zone at once."""
    together = _margins(rng) | {"airframe": _airframe(rng)["airframe"]}
    together["airspace"] = _no_fly(rng)["airspace"]
    return together


def _extremes(rng: np.random.Generator) -> Table:
    """Powers and noise over many decades, to jamming of 1e16 times the noise at the keep-out."""
    plain = _plain(rng)
    noise_w = float(10.0 ** rng.uniform(-16.0, 0.0))
    plain["receiver"]["noise_w"] = noise_w
    for node in plain["nodes"]:
        node["power_w"] = noise_w * float(10.0 ** rng.uniform(-3.0, 12.0))
    for jammer in plain["jammers"]:
        jammer["power_w"] = noise_w * float(10.0 ** rng.uniform(0.0, 16.0)) / len(plain["jammers"])
    return plain


def _one_node_secrecy(rng: np.random.Generator) -> Table:
    """One node and one eavesdropper low on the ground, often under a low floor."""
    table = _secrecy(rng)
    table["airspace"]["altitude_m"] = [float(rng.uniform(2.0, 8.0)), 30.0]
    table["nodes"] = [{"position_m": [0.0, 0.0, 1.5]}]
    place = [*map(float, rng.uniform(-30.0, 30.0, 2)), 1.5]
    noise_w = _NOISE_W * float(10.0 ** rng.uniform(-0.5, 0.5))
    table["eavesdroppers"] = [{"position_m": place, "noise_w": noise_w}]
    return table


def _points(rng: np.random.Generator) -> Table:
    """An airspace that is one point, a line or a sheet."""
    plain = _plain(rng)
    corner, size = rng.uniform([10.0, 10.0, 8.0], [50.0, 50.0, 20.0]), rng.uniform(1.0, 20.0, 3)
    size[rng.permutation(3)[: int(rng.integers(1, 4))]] = 0.0
    ends = {key: [float(a), float(a + b)] for key, a, b in zip(_SIDES, corner, size, strict=True)}
    plain["airspace"] = ends
    return plain


def _slivers(rng: np.random.Generator) -> Table:
    """A fence or an airspace that is a hair wide."""
    plain = _plain(rng)
    width = float(10.0 ** rng.uniform(-6.0, -1.0))
    x, y = map(float, rng.uniform(10.0, 50.0, 2))
    if rng.uniform() < 0.5:
        turn = float(rng.uniform(0.0, np.pi))
        along, across = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
        ends = ((-1, 0), (1, 0), (1, 1), (-1, 1))
        corners = [[x, y] + a * 20.0 * along + b * width * across for a, b in ends]
        plain["airspace"]["geofence_m"] = [list(map(float, corner)) for corner in corners]
    else:
        plain["airspace"] |= {"x_m": [x, x + width], "y_m": [y - 20.0, y + 20.0]}
    return plain


def _touching(rng: np.random.Generator) -> Table:
    """No-fly zones that share a side or a corner, and one whose side is the fence's."""
    plain = _plain(rng)
    x, y = map(float, rng.integers(10, 40, 2))
    size = float(rng.integers(2, 12))
    zones: list[Table] = [{"x_m": [x, x + size], "y_m": [y, y + size]}]
    zones.append({"x_m": [x + size, x + 2.0 * size], "y_m": [y, y + size]})
    zones.append({"x_m": [x + 2.0 * size, x + 3.0 * size], "y_m": [y + size, y + 2.0 * size]})
    plain["airspace"]["no_fly"] = zones[: int(rng.integers(2, 4))]
    if rng.uniform() < 0.5:
        west, south, east, north = x, y - 15.0, x + 40.0, y + 30.0
        plain["airspace"]["geofence_m"] = [[west, south], [east, south], [east, north], [west, north]]
    return plain


def _shared_place(rng: np.random.Generator) -> Table:
    """An eavesdropper a hair beside a node, with another noise or the same."""
    table = _secrecy(rng)
    beside = np.array(table["nodes"][0]["position_m"]) + rng.normal(0.0, 10.0 ** rng.uniform(-2.0, -0.5), 3)
    table["eavesdroppers"][0]["position_m"] = beside.tolist()
    if rng.uniform() < 0.5:
        table["eavesdroppers"][0]["noise_w"] = _NOISE_W
    return table


def _weights(rng: np.random.Generator) -> Table:
    """Weights over six decades."""
    plain = _plain(rng)
    for node in plain["nodes"]:
        node["weight"] = float(10.0 ** rng.uniform(-3.0, 3.0))
    return plain


def _tilts(rng: np.random.Generator) -> Table:
    """Airframes at the ends of what they may be: no tilt or all but 90 degrees, upright or all but level."""
    off = 10.0 ** rng.uniform(-12.0, -3.0, 2)
    ends = [0.0, 90.0, float(off[0]), 90.0 - float(off[1])]
    return _plain(rng) | {"airframe": {"tilt_max_deg": rng.choice(ends), "mount_deg": rng.choice(ends)}}


def _patterns(rng: np.random.Generator) -> Table:
    """Antennas that are no dipole: half-wave, the same all round, or with lobes."""
    makers = (_plain, _plain, _margins, _no_fly, _secrecy)
    table = makers[int(rng.integers(len(makers)))](rng)
    for point in [*table["nodes"], *table["jammers"]]:
        point["antenna"] = str(rng.choice(["isotropic", "circular"]))
    degree = int(rng.integers(1, 7))
    rows = [(0.5 * rng.normal(size=2 * n + 1) / (1.0 + n)).tolist() for n in range(degree + 1)]
    rows[0] = [1.0]
    if rng.uniform() < 0.3:
        rows = [[row[0], *(0.0 for _ in row[1:])] for row in rows]
    table["antenna"] = {"kind": "pattern", "harmonics": rows, "normalise": str(rng.choice(["none", "peak"]))}
    if rng.uniform() < 0.25:
        table["antenna"] = {"kind": "half-wave"}
    return table


def _antennas(rng: np.random.Generator) -> Table:
    """Dipoles tilted anyhow, circular antennas and nulls of finite depth, with and without other features."""
    makers = (_plain, _plain, _airframe, _secrecy, _together)
    table = makers[int(rng.integers(len(makers)))](rng)
    for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
        kind = rng.choice(["isotropic", "circular", "dipole", "dipole", "dipole"])
        point["antenna"] = str(kind)
        if kind == "dipole" and rng.uniform() < 0.6:
            point["antenna_axis"] = rng.normal(size=3).tolist()
    if rng.uniform() < 0.5:
        table["antenna"] = {"null_depth_db": float(rng.uniform(10.0, 50.0))}
    return table


GAPS = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5)
"""Gaps of the certificates that are checked."""
MOUNTS_DEG = (0.0, 30.0, 45.0, 89.999, 90.0)
"""Mounts of the antenna on level vehicles."""


def _profile(rng: np.random.Generator) -> Table:
    """A gain that is the same all round, often with a lobe below zero."""
    degree = int(rng.integers(1, 7))
    rows = [[float(rng.normal() / (1.0 + n))] + [0.0] * (2 * n) for n in range(degree + 1)]
    rows[0] = [float(rng.uniform(0.5, 2.0))]
    if rng.uniform() < 0.3:  # the same upside down
        rows = [[row[0] * (1 - n % 2), *row[1:]] for n, row in enumerate(rows)]
    rows = [[0.5 * each for each in row] for row in rows]  # no more on average than it is fed
    return {"kind": "pattern", "harmonics": rows, "normalise": str(rng.choice(["none", "peak"]))}


def _pattern(rng: np.random.Generator) -> Table:
    degree = int(rng.integers(1, 5))
    rows = [(0.5 * rng.normal(size=2 * n + 1) / (1.0 + n)).tolist() for n in range(degree + 1)]
    return {"kind": "pattern", "harmonics": [[1.0], *rows[1:]]}


# a short dipole, one that leaks, a half-wave dipole, a profile, any pattern
_ON_THE_DRONE: tuple[Callable[[np.random.Generator], Table], ...] = (
    lambda rng: {},
    lambda rng: {"null_depth_db": float(rng.choice([0.0, 3.0, 20.0, 50.0]))},
    lambda rng: {"kind": "half-wave"},
    _profile,
    _pattern,
)


def put_antennas(rng: np.random.Generator, table: Table) -> Table:
    """Return a scene with some antenna on the drone, and antennas on the ground that go with it."""
    choice = int(rng.integers(len(_ON_THE_DRONE)))
    kinds = ["isotropic", "circular", "dipole"][: 3 if choice < 2 else 2]  # whips need a dipole on the drone
    if rng.uniform() < 0.6:
        for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
            point["antenna"] = str(rng.choice(kinds))
            point["gain_dbi"] = float(rng.choice([0.0, 1.76, 2.15, -3.0]))
            if point["antenna"] == "dipole" and rng.uniform() < 0.3:
                point["antenna_axis"] = rng.normal(size=3).tolist()
            if point["antenna"] == "dipole" and rng.uniform() < 0.4:
                point["null_depth_db"] = float(rng.choice([0.0, 20.0]))
    antenna = _ON_THE_DRONE[choice](rng)
    return table | ({"antenna": antenna} if antenna else {})


def _level(rng: np.random.Generator) -> Table:
    """Vehicles that do not tilt, with every antenna."""
    makers = (_plain, _plain, _margins, _no_fly, _secrecy)
    table = put_antennas(rng, makers[int(rng.integers(len(makers)))](rng))
    return table | {"airframe": {"tilt_max_deg": 0.0, "mount_deg": float(rng.choice(MOUNTS_DEG))}}


def _gaps(rng: np.random.Generator) -> Table:
    """Every antenna, on any vehicle: certificates from narrow gaps to wide ones."""
    makers = (_plain, _plain, _airframe, _together, _secrecy)
    return put_antennas(rng, makers[int(rng.integers(len(makers)))](rng))


def _channel(rng: np.random.Generator) -> Table:
    """A power law, an environment, or the numbers of one."""
    kind = rng.integers(3)
    if kind == 0:
        closest = float(rng.uniform(0.5, 0.9))
        return {
            "model": "power-law",
            "exponent": float(rng.uniform(1.6, 6.0)),
            "reference_distance_m": closest,
        }
    average = str(rng.choice(["power", "power", "db", "guaranteed"]))
    if kind == 1:
        town = {"model": "elevation", "environment": str(rng.choice(list(ENVIRONMENTS))), "average": average}
        return town | _own_exponent(rng)
    loss = float(rng.uniform(0.0, 5.0))
    losses = {"los_loss_db": loss, "nlos_loss_db": loss + float(rng.uniform(0.0, 30.0))}
    curve = {"a": float(rng.uniform(1.0, 40.0)), "b": float(10.0 ** rng.uniform(-1.5, 0.0))}
    return {"model": "elevation", "average": average} | curve | losses | _own_exponent(rng)


def _own_exponent(rng: np.random.Generator) -> Table:
    """An exponent beside line of sight by elevation, in every other scene."""
    if rng.uniform() < 0.5:
        return {}
    exponent = float(rng.uniform(1.6, 6.0))
    return {"exponent": exponent, "reference_distance_m": float(rng.choice([0.5, 0.9]))}


def _channels(rng: np.random.Generator) -> Table:
    """Channels of all points or of some, in the paper's cases and with other features."""
    makers = (_plain, _plain, _plain, _airframe, _secrecy, _margins, _no_fly, _antennas)
    choice = int(rng.integers(len(makers)))
    table = makers[choice](rng) | {"channel": _channel(rng)}
    exponent, closest = (
        table["channel"].get(key, other) for key, other in (("exponent", 2.0), ("reference_distance_m", 1.0))
    )
    quieter = closest**exponent * 25.0 ** (2.0 - exponent)  # at 25 m the SNR of free space
    for listener in [table["receiver"], *table.get("eavesdroppers", [])]:
        listener["noise_w"] *= quieter
    if rng.uniform() < 0.3:
        for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
            if rng.uniform() < 0.4:
                point["channel"] = _channel(rng) if rng.uniform() < 0.7 else "free-space"
    if choice < 3 and rng.uniform() < 0.6:
        some = ["vertical", "maximum-gain", *["zero-interference"] * (2 * len(table["jammers"]))]
        table["scheme"] = str(rng.choice(some))
    return table


def _channel_ends(rng: np.random.Generator) -> Table:
    """Channels at the ends of what may be stated, in the paper's cases and with other features."""
    makers = (_plain, _plain, _airframe, _secrecy, _margins)
    table = quiet(rng, makers[int(rng.integers(len(makers)))](rng) | {"channel": channel_ends(rng)})
    upright = rng.uniform() < 1.0 / 3.0 and "airframe" not in table
    return table | {"scheme": "vertical" if upright else "optimum"}


def _narrow(rng: np.random.Generator) -> Table:
    """Airframes that tilt by a hair, with strong jammers, eavesdroppers and channels."""
    makers = (_plain, _secrecy, _margins, _channel_ends, _extremes)
    table = makers[int(rng.integers(len(makers)))](rng)
    return table | {"airframe": narrow_airframe(rng), "scheme": "optimum"}


def _depths(rng: np.random.Generator) -> Table:
    """Nulls of every depth on the drone and on the ground."""
    makers = (_plain, _airframe, _secrecy, _extremes)
    return with_depths(rng, makers[int(rng.integers(len(makers)))](rng))


def _scales(rng: np.random.Generator) -> Table:
    """Scenes from some metres to hundreds of kilometres."""
    makers = (_plain, _airframe, _secrecy, _margins)
    return rescaled(rng, makers[int(rng.integers(len(makers)))](rng))


def _one_element(rng: np.random.Generator) -> Table:
    """Arrays of one element, which are a vertical dipole on a level vehicle, with strong jammers."""
    makers = (_plain, _margins, _extremes)
    table = makers[int(rng.integers(len(makers)))](rng)
    return table | {"array": {"elements": 1, "layout": "linear", "spacing_wavelengths": 0.5}}


def _ground_profile(rng: np.random.Generator) -> Table:
    """Antennas on the ground that are tables over elevation: smooth, steep or coarse."""
    makers = (_plain, _plain, _airframe, _secrecy, _margins, _no_fly)
    table = makers[int(rng.integers(len(makers)))](rng)
    if rng.uniform() < 0.4:
        channel = {"model": "elevation", "environment": str(rng.choice(list(ENVIRONMENTS)))}
        table["channel"] = channel | {"average": str(rng.choice(["power", "db", "guaranteed"]))}
        table["channel"] |= _own_exponent(rng)
    for point in [*table["nodes"], *table["jammers"], *table.get("eavesdroppers", [])]:
        if rng.uniform() < 0.7:
            inner = np.unique(np.round(rng.uniform(-80.0, 80.0, int(rng.integers(0, 30))), 1))
            gains_dbi = rng.normal(-4.0, float(rng.choice([1.0, 4.0, 8.0])), len(inner) + 2)
            rows = np.column_stack([[-90.0, *inner, 90.0], np.minimum(gains_dbi, 0.0)])
            point |= {"antenna": "profile", "antenna_profile": rows.tolist()}
        if rng.uniform() < 0.1:
            point["position_m"][2] = float(rng.uniform(0.0, 40.0))  # the drone below its horizon
    if not table.keys() & {"airframe", "eavesdroppers"} and rng.uniform() < 0.5:
        some = ["vertical", "maximum-gain", *["zero-interference"] * (2 * len(table["jammers"]))]
        table["scheme"] = str(rng.choice(some))
    return table


def _served(rng: np.random.Generator, objective: str) -> Table:
    """Two to six nodes and up to three jammers, with what else a scene can state, and a transmitter."""
    makers = (_plain, _airframe, _margins, _no_fly, _together, _antennas)
    while "eavesdroppers" in (table := makers[int(rng.integers(len(makers)))](rng)):
        pass
    for kind, most in (("nodes", 6), ("jammers", 3)):
        if len(table[kind]) < most and rng.uniform() < 0.3:
            place = rng.uniform(0.0, [60.0, 60.0, 5.0]).tolist()
            table[kind].append({"position_m": place, "power_w": float(10.0 ** rng.uniform(-0.5, 0.5))})
    if rng.uniform() < 0.4:
        table["channel"] = _channel(rng)
    power_w = float(10.0 ** rng.uniform(-1.0, 1.5))
    return table | {"objective": objective, "transmitter": {"power_w": power_w}}


def _downlink(rng: np.random.Generator) -> Table:
    """Nodes that receive, some with noise or jamming of their own, under every scheme that has a meaning."""
    table = _served(rng, "downlink")
    for node in table["nodes"]:
        if rng.uniform() < 0.5:
            node["noise_w"] = _NOISE_W * float(10.0 ** rng.uniform(-1.0, 1.0))
        if rng.uniform() < 0.3:
            node["jamming_w"] = _NOISE_W * float(10.0 ** rng.uniform(-1.0, 2.0))
    upright = rng.uniform() < 0.2 and "airframe" not in table
    return table | {"scheme": "vertical" if upright else "optimum"}


def _relay(rng: np.random.Generator) -> Table:
    """A destination like a node or like none of them, under every scheme."""
    table = _served(rng, "relay")
    low, high = ([0.0, 0.0, 0.0], [60.0, 60.0, 5.0]) if rng.uniform() < 0.5 else ([80.0, -30.0, 0.0], 120.0)
    alike = table["nodes"][0]
    keys = alike.keys() & {"antenna", "antenna_axis", "weight", "min_sinr_db"}
    end = {key: alike[key] for key in sorted(keys)} | {"position_m": rng.uniform(low, high).tolist()}
    end["noise_w"] = _NOISE_W * float(10.0 ** rng.uniform(-2.0, 1.0))
    if rng.uniform() < 0.5:
        end["jamming_w"] = _NOISE_W * float(10.0 ** rng.uniform(-1.0, 1.0))
    some = ["optimum"] * 4
    if "airframe" not in table:
        some += ["vertical", "maximum-gain", *["zero-interference"] * len(table["jammers"])]
    return table | {"destination": end, "scheme": str(rng.choice(some))}


def _friendly_jamming(rng: np.random.Generator) -> Table:
    """One to three nodes, each near a source, some with noise of their own, and one or two eavesdroppers."""
    table = _served(rng, "friendly-jamming")
    low, high = rng.uniform(-30.0, 0.0, 2), rng.uniform(60.0, 120.0, 2)
    ends = {axis: [float(low[i]), float(high[i])] for i, axis in enumerate(("x_m", "y_m"))}
    nodes = [
        {key: each for key, each in node.items() if key not in ("weight", "min_sinr_db", "power_w")}
        for node in table["nodes"][: int(rng.integers(1, 4))]
    ]
    places_m = np.array([node["position_m"] for node in nodes[: int(rng.integers(1, 3))]])
    places_m += rng.uniform([2.0, -15.0, 0.0], [15.0, 15.0, 2.0], size=places_m.shape)
    for node in nodes:
        node["from"] = f"A{rng.integers(len(places_m)) + 1}"
        if rng.uniform() < 0.3:
            node["noise_w"] = _NOISE_W * float(10.0 ** rng.uniform(-1.0, 1.0))
    table["airspace"] = ends | table["airspace"]
    sources = [{"position_m": p, "power_w": float(10.0 ** rng.uniform(-0.5, 1.5))} for p in places_m.tolist()]
    heard = [
        {"position_m": p, "noise_w": _NOISE_W * float(10.0 ** rng.uniform(-0.5, 0.5))}
        for p in rng.uniform(0.0, [60.0, 60.0, 5.0], size=(int(rng.integers(1, 3)), 3)).tolist()
    ]
    upright = rng.uniform() < 0.2 and "airframe" not in table
    scheme = "vertical" if upright else "optimum"
    return table | {"nodes": nodes, "sources": sources, "eavesdroppers": heard, "scheme": scheme}


def _mean(rng: np.random.Generator, objective: str) -> Table:
    """Two to twenty nodes, some with weights, and up to three jammers, with what else a scene can state.

    In half of the scenes that leave the axis free nodes require what they have at some pose, or less.
    """
    makers = (_plain, _airframe, _no_fly, _together, _antennas)
    while "eavesdroppers" in (table := makers[int(rng.integers(len(makers)))](rng)):
        pass
    nodes, jammers = int(rng.choice([2, 3, 4, 6, 10, 20])), int(rng.integers(4))
    for kind, count in (("nodes", nodes), ("jammers", jammers)):
        for _ in range(count - len(table[kind])):
            place = rng.uniform(0.0, [60.0, 60.0, 5.0]).tolist()
            table[kind].append({"position_m": place, "power_w": float(10.0 ** rng.uniform(-0.5, 0.5))})
    del table["jammers"][jammers:]
    for node in table["nodes"]:
        node.pop("min_sinr_db", None)
        if rng.uniform() < 0.3:
            node["weight"] = float(10.0 ** rng.uniform(-1.0, 1.0))
    if rng.uniform() < 0.3:
        table["channel"] = _channel(rng)
    some = ["optimum"] * 4
    if "airframe" not in table:
        some += ["vertical", "maximum-gain", *["zero-interference"] * jammers]
    table |= {"objective": objective, "scheme": str(rng.choice(some))}
    if table["scheme"] == "optimum" and rng.uniform() < 0.5:
        _require(rng, table)
    return table


def _require(rng: np.random.Generator, table: Table) -> None:
    """Let nodes require up to 6 dB less than what they have at a random pose, if one is met."""
    plain = Scenario.from_dict({key: value for key, value in table.items() if key != "scheme"})
    low, high = np.maximum(plain.airspace.lower_m, -20.0), np.minimum(plain.airspace.upper_m, 80.0)
    places = rng.uniform(low, high, (200, 3))
    places = places[feasible(plain, places)]
    if not len(places):
        return
    axis = nearest_in_band(rng.normal(size=(1, 3)), *plain.axis_band)[0]
    heard = Reception(plain, places[0], axis).sinr
    for node, sinr in zip(table["nodes"], heard, strict=True):
        if rng.uniform() < 0.5 and sinr > 1e-9:
            node["min_sinr_db"] = float(10.0 * np.log10(sinr) - rng.uniform(0.0, 6.0))


_SIDES = ("x_m", "y_m", "altitude_m")

FEATURES: dict[str, Callable[[np.random.Generator], Table]] = {
    "airframe": _airframe,
    "secrecy": _secrecy,
    "margins": _margins,
    "no-fly": _no_fly,
    "fence": _fence,
    "together": _together,
    "antennas": _antennas,
    "patterns": _patterns,
    "extremes": _extremes,
    "one-node-secrecy": _one_node_secrecy,
    "points": _points,
    "slivers": _slivers,
    "touching": _touching,
    "shared-place": _shared_place,
    "weights": _weights,
    "tilts": _tilts,
    "level": _level,
    "gaps": _gaps,
    "channels": _channels,
    "channel-ends": _channel_ends,
    "narrow": _narrow,
    "depths": _depths,
    "scales": _scales,
    "one-element": _one_element,
    "ground-profile": _ground_profile,
    "downlink": _downlink,
    "relay": _relay,
    "sum-rate": partial(_mean, objective="sum-rate"),
    "proportional-fair": partial(_mean, objective="proportional-fair"),
    "friendly-jamming": _friendly_jamming,
}

ENDS = ("channel-ends", "narrow", "depths", "scales", "one-element")
"""Features whose numbers go to the ends of what may be stated, and together sometimes beyond."""

_CELLS = 15_000  # of the proofs at given gaps: what is left then is promised too, and quickly verified


def make_feature_scene(feature: str, number: int) -> Scene:
    """Return the scene of a number with something that scenarios can ask for; the first that is allowed."""
    rng = np.random.default_rng([20261, list(FEATURES).index(feature), number])
    has_gap = feature in ("gaps", "channels", "channel-ends", "ground-profile")
    while True:
        table = FEATURES[feature](rng)
        scheme = table.pop("scheme", "optimum")
        try:
            scenario = Scenario.from_dict(table | {"name": f"{feature} {number}"})
            if scenario.array is None and scenario.antenna_record.is_quadratic:
                # a jammer may be louder than a solver takes
                build_family(scenario, any_channel=True, any_objective=True)
        except ScenarioError:
            if feature not in ENDS:
                raise
            continue
        break
    return Scene(
        number=number,
        kind=feature,
        scheme=scheme,
        scenario=scenario,
        gap=GAPS[number % len(GAPS)] if has_gap else None,
        cells=_CELLS if has_gap else None,
    )
