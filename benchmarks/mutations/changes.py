"""Changes to a certificate's data: one number, a column, a leaf, the claim, the scenario, or several."""

from __future__ import annotations

import copy
from functools import reduce
from operator import getitem
from typing import Any

import numpy as np

from benchmarks.mutations.truth import Data, pose_of, value_at
from nullpose.certificate.certificate import COLUMNS
from nullpose.certificate.file import scenario_digest
from nullpose.errors import ScenarioError
from nullpose.objectives import RECORDS
from nullpose.scenario import Scenario


def numbers(value: Any, path: tuple = ()) -> list[tuple]:
    """Return the paths of all numbers and texts inside."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        return [one for key, item in items for one in numbers(item, (*path, key))]
    return [path]


def changed(value: Any, rng: np.random.Generator) -> Any:
    """Return another value of the same kind: a little or a lot different."""
    if value is None:
        return "M"
    if isinstance(value, str):
        schemes = ("optimum", "vertical", "zero-interference", "maximum-gain")
        return str(rng.choice([*schemes, "free", "null M", "null M1", "M1", value + "x", value[:-1]]))
    if isinstance(value, int):
        steps = [1, -1, 2, -2, int(rng.integers(-60, 60)), 2**40, -(2**40)]
        return value + int(rng.choice(steps))
    kind = rng.integers(5)
    if kind == 0:
        return value * (1.0 + float(10.0 ** rng.uniform(-9, -1) * rng.choice([-1, 1])))
    if kind == 1:
        return -value
    if kind == 2:
        return value * float(10.0 ** rng.uniform(-3, 3))
    return value + float(rng.normal() * 10.0 ** rng.uniform(-6, 2)) if kind == 3 else 0.0


_LEAF = (*COLUMNS, "mixes")
_CLAIM = ("value", "upper_bound", "position_m", "angle", "root_m", "axis", "scheme", "null_jammer")
_FILE = ("format", "version", "scenario_sha256", "scenario", "scenario, digest redone")
_REDONE = tuple(f"{part}, claim redone" for part in ("scenario", "airframe", "no_fly", "antenna", "channel"))
_OBJECTIVE = "objective, claim redone"
CLASSES = (*_LEAF, *_CLAIM, *_FILE, *_REDONE, "leaf dropped", "leaf moved", "tree dropped", _OBJECTIVE)


def paths_of(kind: str, data: Data, rng: np.random.Generator) -> list[tuple]:
    """Return where a mutation of a class may strike."""
    tree = int(rng.integers(len(data["trees"])))
    if kind in _LEAF:
        column = data["trees"][tree]["leaves"].get(kind, [])
        rows = list(range(len(column)))
        if kind in ("cell", "sides"):  # rather those that have a cell
            cells = data["trees"][tree]["leaves"]["cell"]
            rows = [i for i in rows if cells[i][0] >= 0] or rows
        if kind in ("ball", "ball_multiplier"):
            rows = [i for i in rows if data["trees"][tree]["leaves"]["ball"][i] >= 0] or rows
        if not rows:
            return []
        row = int(rng.choice(rows))
        return numbers(column[row], ("trees", tree, "leaves", kind, row))
    if kind == "root_m":
        return numbers(data["trees"][tree]["root_m"], ("trees", tree, "root_m"))
    fixed: dict[str, list[tuple]] = {
        "axis": [("trees", tree, "axis")],
        "position_m": [("pose", kind, i) for i in range(3)],
        "angle": [("pose", name) for name in ("roll_rad", "pitch_rad", "yaw_rad")],
    }
    if kind in fixed:
        return fixed[kind]
    if kind.startswith("scenario") and kind != "scenario_sha256":
        return numbers(data["scenario"], ("scenario",))
    part = kind.partition(",")[0]
    if part in ("airframe", "antenna", "channel"):
        return numbers(data["scenario"].get(part, {}), ("scenario", part))
    if part == "no_fly":
        zones = data["scenario"]["airspace"].get("no_fly", [])
        return numbers(zones, ("scenario", "airspace", "no_fly"))
    return [(kind,)]


def spoiled(sound: Data, kind: str, rng: np.random.Generator) -> Data | None:
    """Return a certificate's data with one change of a class, or None if it has no such place."""
    data = copy.deepcopy(sound)
    leaves = data["trees"][int(rng.integers(len(data["trees"])))]["leaves"]
    if kind == _OBJECTIVE:
        data["scenario"]["objective"] = str(rng.choice(list(RECORDS)))
        data["scenario_sha256"] = scenario_digest(data["scenario"])
        return data
    if kind in ("leaf dropped", "leaf moved"):
        row = int(rng.integers(len(leaves["box"])))
        if kind == "leaf moved":
            leaves["box"][row] = list(leaves["box"][int(rng.integers(len(leaves["box"])))])
            return data
        for name in set(leaves) - {"mixes"}:
            del leaves[name][row]
        return data
    if kind == "tree dropped":
        del data["trees"][-1]
        return data
    paths = paths_of(kind, data, rng)
    if not paths:
        return None
    path = paths[int(rng.integers(len(paths)))]
    new = changed(reduce(getitem, path, data), rng)
    if new == reduce(getitem, path, data):
        return None
    reduce(getitem, path[:-1], data)[path[-1]] = new
    if kind.endswith("redone"):
        data["scenario_sha256"] = scenario_digest(data["scenario"])
    return data


def forged(data: Data, *, keep_bound: bool = False) -> Data | None:
    """Return a certificate for a changed scenario with value, bound and levels made to fit its pose."""
    try:
        scenario = Scenario.from_dict(data["scenario"])
    except ScenarioError:
        return None
    value = value_at(scenario, pose_of(data, scenario))
    factor = 1.0 if keep_bound else value / (data["value"] or 1.0)
    data["value"], data["upper_bound"] = value, max(value, factor * data["upper_bound"])
    for tree in data["trees"]:
        tree["leaves"]["level"] = [min(factor * x, data["upper_bound"]) for x in tree["leaves"]["level"]]
    return data


_LEAVES = ("leaf doubled", "leaves shuffled", "tests exchanged", "box halved", "cell halved", "cell moved")
_ROOT = ("leaves exchanged", "root shrunk", "root grown")
_NUMBERS = ("bound lowered", "bound at the value", "bound raised", "claim scaled", "levels lowered")
_MIXES = ("multipliers scaled", "multipliers exchanged")
_POSES = ("pose moved, claim redone", "pose turned, claim redone")
_MOTION = ("track moved, claim redone", "time changed, claim redone")
HELD = ("instant changed", "instant dropped", "instant doubled", "instants exchanged", *_MOTION)
"""Classes of changes to the certificate of a pose that is held in a scene in motion."""
MORE = (
    *_LEAVES,
    *_ROOT,
    *_NUMBERS,
    *_MIXES,
    *_POSES,
    *HELD,
    "key added",
    "key dropped",
    "no number",
    "several",
)
"""Classes of larger changes, many of them such as leave the claim true or nearly."""
_AFTER_EACH_OTHER = MORE[:-3]


def mutated(sound: Data, kind: str, rng: np.random.Generator) -> Data | None:
    """Return a certificate's data after a change of any class, or None if that changes nothing."""
    data = copy.deepcopy(sound)
    if kind == "several":
        for one in rng.choice([*CLASSES, *_AFTER_EACH_OTHER], size=int(rng.integers(2, 6))):
            if all(tree["leaves"]["box"] for tree in data["trees"]) and data["trees"]:
                data = mutated(data, str(one), rng) or data
    elif kind in MORE:
        tree = data["trees"][int(rng.integers(len(data["trees"])))]
        _change_leaves(kind, tree["leaves"], rng)
        _change_root(kind, tree, rng)
        _change_claim(kind, data, rng)
        _change_motion(kind, data, rng)
        _change_form(kind, data, tree["leaves"], rng)
    else:
        data = spoiled(sound, kind, rng) or sound
    if kind.endswith("claim redone"):
        data = forged(data, keep_bound=kind in MORE) or sound
    return None if data == sound else data


def _size(rng: np.random.Generator) -> float:
    """Return a share that is tiny as often as large."""
    return float(10.0 ** rng.uniform(-9.0, 0.0))


def _change_leaves(kind: str, leaves: Data, rng: np.random.Generator) -> None:
    count = len(leaves["box"])
    one, other = (int(row) for row in rng.integers(count, size=2))
    columns = [name for name in leaves if name != "mixes"]
    some = np.flatnonzero(rng.uniform(size=count) < rng.uniform())
    if kind == "leaf doubled":
        for name in columns:
            leaves[name].insert(other, copy.deepcopy(leaves[name][one]))
    elif kind == "leaves shuffled":
        order = rng.permutation(count)
        for name in columns:
            leaves[name] = [leaves[name][row] for row in order]
    elif kind == "tests exchanged":
        for name in set(columns) - {"box", "cell"}:
            leaves[name][one], leaves[name][other] = leaves[name][other], leaves[name][one]
    elif kind == "box halved":
        side = 2 * int(rng.integers(3))
        leaves["box"][one][side] += 1
        leaves["box"][one][side + 1] = 2 * leaves["box"][one][side + 1] + int(rng.integers(2))
    elif kind in ("cell halved", "cell moved") and leaves["cell"][one][0] >= 0:
        side, cell = 1 + 2 * int(rng.integers(2)), leaves["cell"][one]
        halved = int(kind == "cell halved")
        cell[side], cell[side + 1] = cell[side] + halved, (cell[side + 1] << halved) + int(rng.integers(2))
    elif kind == "leaves exchanged":
        name = str(rng.choice(["box", "cell", "mix"]))
        leaves[name][one], leaves[name][other] = leaves[name][other], leaves[name][one]
    elif kind == "levels lowered":
        for row in some:
            leaves["level"][row] *= 1.0 - _size(rng)
    elif kind == "multipliers scaled" and leaves["mixes"]:
        mix = leaves["mixes"][int(rng.integers(len(leaves["mixes"])))]
        mix[:] = [[k, w * 2.0 ** int(rng.integers(-9, 10))] for k, w in mix]
    elif kind == "multipliers exchanged":
        leaves["mix"][one], leaves["mix"][other] = leaves["mix"][other], leaves["mix"][one]


def _change_root(kind: str, tree: Data, rng: np.random.Generator) -> None:
    if not kind.startswith("root"):
        return
    low, high = tree["root_m"]
    axis, end = int(rng.integers(3)), int(rng.integers(2))
    step = (high[axis] - low[axis]) * _size(rng) * (1.0 if end == 0 else -1.0)
    tree["root_m"][end][axis] += step if kind == "root shrunk" else -step


def _change_claim(kind: str, data: Data, rng: np.random.Generator) -> None:
    value, bound = data["value"], data["upper_bound"]
    if kind == "bound lowered":
        data["upper_bound"] = bound - (bound - value) * float(rng.uniform(0.0, 1.5))
    elif kind == "bound at the value":
        data["upper_bound"] = value * (1.0 + _size(rng) * 1e-3)
    elif kind == "bound raised":
        data["upper_bound"] = bound * (1.0 + _size(rng))
    elif kind == "claim scaled":
        factor = 1.0 + _size(rng) * float(rng.choice([-1.0, 1.0]))
        data["value"], data["upper_bound"] = value * factor, bound * factor
    elif kind == "pose moved, claim redone":
        size = 10.0 * _size(rng)
        data["pose"]["position_m"] = [x + size * float(rng.normal()) for x in data["pose"]["position_m"]]
    elif kind == "pose turned, claim redone":
        angle = str(rng.choice(["roll_rad", "pitch_rad", "yaw_rad"]))
        data["pose"][angle] += _size(rng) * float(rng.normal())
    for tree in data["trees"]:  # so that the change is not found out by a comparison
        tree["leaves"]["level"] = [min(level, data["upper_bound"]) for level in tree["leaves"]["level"]]


def _change_motion(kind: str, data: Data, rng: np.random.Generator) -> None:
    instants, scenario = data.get("instants"), data["scenario"]
    if kind not in HELD or not instants or scenario.get("time") is None:
        return
    one, other = (int(place) for place in rng.integers(len(instants), size=2))
    points = [*scenario.get("jammers", []), *scenario.get("eavesdroppers", [])]
    if kind == "instant changed":
        instants[one] += int(rng.integers(-3, 4))
    elif kind == "instant dropped":
        del instants[one]
    elif kind == "instant doubled":
        instants.insert(other, instants[one])
    elif kind == "instants exchanged":
        instants[one], instants[other] = instants[other], instants[one]
    elif kind == "track moved, claim redone":
        track = next(point["track"] for point in points if point.get("track"))
        track[int(rng.integers(len(track)))][1 + int(rng.integers(3))] += (
            20.0 * _size(rng) * float(rng.normal())
        )
    elif kind == "time changed, claim redone":
        scenario["time"][str(rng.choice(["duration_s", "step_s"]))] *= 1.0 - _size(rng)
    data["scenario_sha256"] = scenario_digest(scenario)


def _change_form(kind: str, data: Data, leaves: Data, rng: np.random.Generator) -> None:
    places: list[Data] = [data, data["pose"], data["scenario"], data["trees"][0], leaves]
    place = places[int(rng.integers(len(places)))]
    key = str(rng.choice(sorted(place)))
    if kind == "key added":
        place[key + "s"] = place[key]
    elif kind == "key dropped":
        del place[key]
    elif kind == "no number":
        place[key] = [None, "1.0", [], {}, True, 10**400, {"value": 1}][int(rng.integers(7))]
    if place is data.get("scenario") and rng.uniform() < 0.7:
        data["scenario_sha256"] = scenario_digest(data["scenario"])
