"""A certificate spoiled anywhere is rejected: each mutation is judged by plain sampling before.

The judge below shares no code with the verifier. It evaluates the pose by the physics, looks whether sampled
positions and axes of the sound certificate's leaves are held by a leaf of the spoiled one, and whether each
leaf's statement is true at sampled positions of its box. Whatever it finds false must be rejected.
"""

import copy
import json
import math
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from nullpose.certificate import Certificate, Leaves, certificate_text, parse_certificate, verify
from nullpose.certificate.file import scenario_digest
from nullpose.errors import CertificateError, ScenarioError
from nullpose.physics import Pose, maximum_gain_axis, min_sinr, zero_interference_axis
from nullpose.scenario import Scenario
from nullpose.solve import solve

Data = dict[str, Any]

WANTED = 500
CORNERS = np.array([[1.0 if c >> i & 1 else -1.0 for i in range(3)] for c in range(8)])


class Judge:
    """Finds what is false in a certificate that was sound before it was spoiled.

    Args:
        sound: the data before.
        rng: for its samples.
    """

    def __init__(self, sound: Data, rng: np.random.Generator) -> None:
        self.sound, self.rng = sound, rng

    def falsehood(self, data: Data) -> str:
        """Return what is false in the spoiled data, or nothing if nothing was found."""
        if (data["format"], data["version"]) != (self.sound["format"], self.sound["version"]):
            return "format"
        if data["scenario_sha256"] != scenario_digest(data["scenario"]):
            return "digest"
        try:
            scenario = Scenario.from_dict(data["scenario"])
        except ScenarioError:
            return "scenario"
        return self.claim(data, scenario) or self.optimum(data, scenario) or self.proof(data, scenario)

    def axes(self, data: Data, scenario: Scenario) -> dict[str, Any]:
        """Return the names and axes, functions of the position, that the scheme allows; None is any axis."""
        jammers = dict(zip(scenario.jammer_names, scenario.jammer_positions_m, strict=True))
        null = data["null_jammer"]
        if null is not None and data["scheme"] != "zero-interference":
            return {}
        if data["scheme"] == "optimum":
            return {"free": None}
        if data["scheme"] == "vertical":
            return {"vertical": lambda p: np.array([0.0, 0.0, 1.0])}
        if data["scheme"] == "maximum-gain" and len(scenario.nodes) == 2:
            return {"broadside": lambda p: maximum_gain_axis(scenario, p)}
        if data["scheme"] == "zero-interference":
            return {
                f"null {name}": lambda p, at=at: zero_interference_axis(p, at)
                for name, at in jammers.items()
                if null in (None, name)
            }
        return {}

    def claim(self, data: Data, scenario: Scenario) -> str:
        """Return what is false of the pose and the two numbers."""
        value, bound = data["value"], data["upper_bound"]
        if not value > 0.0 or bound < value:
            return "bound below the value"
        pose = Pose(**data["pose"])
        airspace, p = scenario.airspace, pose.position_m
        if np.any(p < airspace.lower_m) or np.any(p > airspace.upper_m):
            return "pose outside"
        points = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
        if np.min(np.linalg.norm(points - p, axis=1)) < airspace.keep_out_m - 1e-6:
            return "pose kept out"
        if abs(min_sinr(scenario, pose) - value) > 1e-9 * value:
            return "value"
        axes = self.axes(data, scenario)
        if not axes or sorted(tree["axis"] for tree in data["trees"]) != sorted(axes):
            return "names of trees"
        sines = [
            0.0 if f is None else np.linalg.norm(np.cross(f(p), pose.antenna_axis)) for f in axes.values()
        ]
        return "axis" if min(sines) > 1e-5 else ""

    def optimum(self, data: Data, scenario: Scenario) -> str:
        """Return whether a search finds a better pose than the bound allows."""
        if data["scenario"] == self.sound["scenario"] and data["upper_bound"] >= self.sound["upper_bound"]:
            return ""
        found = solve(scenario, data["scheme"], certify=False, null_jammer=data["null_jammer"])
        return "bound below the optimum" if found.objective.value > data["upper_bound"] * (1 + 1e-9) else ""

    def proof(self, data: Data, scenario: Scenario) -> str:
        """Return what is false of the trees."""
        axes = self.axes(data, scenario)
        for before, tree in zip(self.sound["trees"], data["trees"], strict=True):
            leaves = {name: np.array(c) for name, c in tree["leaves"].items() if name != "mixes"}
            mixes = [dict(map(tuple, mix)) for mix in tree["leaves"]["mixes"]]
            words = (
                self.ranges(leaves, mixes, scenario, data["upper_bound"], axes[tree["axis"]] is None)
                or self.root(np.array(tree["root_m"]), scenario, data["upper_bound"])
                or self.hole(before["leaves"], leaves)
                or self.statement(np.array(tree["root_m"]), leaves, mixes, scenario, axes[tree["axis"]])
            )
            if words:
                return words
        return ""

    def ranges(
        self, leaves: dict[str, Any], mixes: list[dict], scenario: Scenario, bound: float, is_free: bool
    ) -> str:
        """Return which number cannot be: none of these could be part of a proof."""
        nodes, points = len(scenario.nodes), len(scenario.nodes) + len(scenario.jammers)
        test, point = leaves["test"], leaves["point"]
        depth = np.hstack([leaves["box"][:, ::2], leaves["cell"][:, 1::2]])
        index = np.hstack([leaves["box"][:, 1::2], leaves["cell"][:, 2::2]])
        needs_mix = test <= 2
        wrong = {
            "level above the bound": leaves["level"] > bound,
            "level": leaves["level"] <= 0.0,
            "test": (test < 0) | (test > 4) | ((test == 2) & is_free),
            "mix": needs_mix & ((leaves["mix"] < 0) | (leaves["mix"] >= len(mixes))),
            "frame": (test == 1) & ((point < 0) | (point >= points)),
            "node": (test == 3) & ((point < 0) | (point >= nodes)),
            "ball": ((test == 4) & ((point < 0) | (point >= points))) | (leaves["ball"] >= points),
            "multiplier": (leaves["ball_multiplier"] < 0.0) | np.any(leaves["sides"] < 0.0, axis=1),
            "depth": np.any((depth < 0) | (depth > 50), axis=1),
            "index": np.any((index < 0) | (index >= 2.0 ** np.clip(depth, 0, 50)), axis=1),
            "face": (leaves["cell"][:, 0] < -1) | (leaves["cell"][:, 0] > 2),
        }
        words = [name for name, mask in wrong.items() if np.any(mask)]
        if any(not mix or min(mix.values()) < 0.0 or not set(mix) <= set(range(nodes)) for mix in mixes):
            words.append("mixes")
        return ", ".join(words)

    def root(self, root_m: np.ndarray, scenario: Scenario, bound: float) -> str:
        """Return whether a face leaves out what distances do not exclude."""
        scale = scenario.receiver.reference_gain / scenario.receiver.noise_power_w
        reach = np.sqrt(scale * scenario.node_powers_w / bound) * (1.0 - 1e-9)
        low, high = scenario.airspace.lower_m, scenario.airspace.upper_m
        for i in range(3):
            at = scenario.node_positions_m[:, i]
            if root_m[0, i] > low[i] and np.all(at - root_m[0, i] < reach):
                return "root"
            if root_m[1, i] < high[i] and np.all(root_m[1, i] - at < reach):
                return "root"
        return "root" if np.any(root_m[0] > root_m[1]) else ""

    def hole(self, before: dict[str, Any], leaves: dict[str, Any]) -> str:
        """Return whether samples of the sound leaves are held by no leaf any more."""
        box, cell = np.array(before["box"]), np.array(before["cell"])
        count = len(box)
        for _ in range(4):
            place = (box[:, 1::2] + self.rng.uniform(size=(count, 3))) / 2.0 ** box[:, ::2]
            face = np.where(cell[:, 0] < 0, self.rng.integers(3, size=count), cell[:, 0])
            whole = cell[:, :1] < 0
            depth, index = np.where(whole, 0, cell[:, 1::2]), np.where(whole, 0, cell[:, 2::2])
            axis = (index + self.rng.uniform(size=(count, 2))) / 2.0**depth
            held = np.all(
                np.floor(place[:, None] * 2.0 ** leaves["box"][None, :, ::2]) == leaves["box"][None, :, 1::2],
                axis=2,
            )
            on_cell = (face[:, None] == leaves["cell"][None, :, 0]) & np.all(
                np.floor(axis[:, None] * 2.0 ** leaves["cell"][None, :, 1::2])
                == leaves["cell"][None, :, 2::2],
                axis=2,
            )
            if not np.all(np.any(held & ((leaves["cell"][:, 0] < 0) | on_cell), axis=1)):
                return "hole"
        return ""

    def statement(
        self, root_m: np.ndarray, leaves: dict[str, Any], mixes: list[dict], scenario: Scenario, axis: Any
    ) -> str:
        """Return which leaf's own statement fails at a position of its box."""
        share = 2.0 ** -leaves["box"][:, ::2]
        low = root_m[0] + (root_m[1] - root_m[0]) * leaves["box"][:, 1::2] * share
        half = 0.5 * (root_m[1] - root_m[0]) * share
        count = len(low)
        shifts = np.concatenate(
            [
                np.tile(0.999 * CORNERS, (count, 1, 1)),
                self.rng.uniform(-1, 1, (count, 4, 3)),
                np.zeros((count, 1, 3)),
            ],
            axis=1,
        )
        p = (low + half)[:, None] + shifts * half[:, None]
        points = np.vstack([scenario.node_positions_m, scenario.jammer_positions_m.reshape(-1, 3)])
        nodes = len(scenario.nodes)
        scale = scenario.receiver.reference_gain / scenario.receiver.noise_power_w
        weight = scale * np.concatenate([scenario.node_powers_w, scenario.jammer_powers_w])
        r = points - p[:, :, None]
        square = np.sum(r * r, axis=-1)
        keep = scenario.airspace.keep_out_m
        allowed = np.all(square >= (keep * (1 + 1e-9)) ** 2, axis=-1)
        test, point, level = leaves["test"], leaves["point"], leaves["level"]
        rows = np.arange(count)
        best = (weight / square)[rows, :, np.where(test == 3, point, 0)]
        far = allowed & (best > level[:, None] * (1.0 + 1e-9)) & (test == 3)[:, None]
        inside = square[rows, :, np.where(test == 4, point, 0)] < keep**2 * (1.0 + 1e-9)
        kept = ~inside & (test == 4)[:, None]
        if np.any(far) or np.any(kept):
            return "distance"
        forms = weight[:, None, None] * (
            np.eye(3) / square[..., None, None]
            - r[..., :, None] * r[..., None, :] / square[..., None, None] ** 2
        )
        lambdas = np.zeros((count, nodes))
        for i in np.flatnonzero(test <= 2):
            for k, w in mixes[leaves["mix"][i]].items():
                lambdas[i, k] = w
        below = np.eye(3) + forms[:, :, nodes:].sum(axis=2)
        total = np.einsum("lk,lsk...->ls...", lambdas, forms[:, :, :nodes])
        total = total - (lambdas.sum(axis=1) * level)[:, None, None, None] * below
        ball = leaves["ball"]
        nu = np.where(ball >= 0, leaves["ball_multiplier"], 0.0)
        away = square[rows, :, np.maximum(ball, 0)] - keep**2
        total = total + (nu[:, None] * away)[..., None, None] * np.eye(3)
        size = lambdas.sum(axis=1) * level * 1e-9
        sided = (
            total
            + np.array([self.sides(c, s) for c, s in zip(leaves["cell"], leaves["sides"], strict=True)])[
                :, None
            ]
        )
        if np.any((np.linalg.eigvalsh(sided)[..., -1] > size[:, None]) & (test <= 1)[:, None]):
            return "multipliers"
        for i in np.flatnonzero(test == 2):
            for s in range(p.shape[1]):
                u = axis(p[i, s])
                if np.all(np.isfinite(u)) and u @ total[i, s] @ u > size[i]:
                    return "multipliers"
        return ""

    def sides(self, cell: np.ndarray, multipliers: np.ndarray) -> np.ndarray:
        """Return the weighted form of a cell's sides."""
        form = np.zeros((3, 3))
        if cell[0] < 0:
            return form
        for side in range(2):
            a, v = int(cell[0]), int(cell[0] + 1 + side) % 3
            width = 2.0 * 2.0 ** -float(cell[1 + 2 * side])
            low = -1.0 + width * cell[2 + 2 * side]
            form[v, v] -= multipliers[side]
            form[a, a] -= multipliers[side] * low * (low + width)
            form[a, v] += multipliers[side] * (low + 0.5 * width)
            form[v, a] += multipliers[side] * (low + 0.5 * width)
        return form


def numbers(value: Any, path: tuple = ()) -> list[tuple]:
    """Return the paths of all numbers and texts inside."""
    if isinstance(value, dict | list):
        items = value.items() if isinstance(value, dict) else enumerate(value)
        return [one for key, item in items for one in numbers(item, (*path, key))]
    return [path]


def look(data: Any, path: tuple) -> Any:
    """Return what a path points at."""
    for key in path:
        data = data[key]
    return data


def changed(value: Any, rng: np.random.Generator) -> Any:
    """Return another value of the same kind: a little or a lot different."""
    if value is None:
        return "M"
    if isinstance(value, str):
        others = [
            "optimum",
            "vertical",
            "zero-interference",
            "maximum-gain",
            "free",
            "null M",
            "null M1",
            "M1",
        ]
        return str(rng.choice([*others, value + "x", value[:-1]]))
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


COLUMNS = ("box", "cell", "test", "point", "level", "mix", "sides", "ball", "ball_multiplier", "mixes")
CLASSES = (
    *COLUMNS,
    "value",
    "upper_bound",
    "position_m",
    "angle",
    "root_m",
    "axis",
    "scheme",
    "null_jammer",
    "format",
    "version",
    "scenario_sha256",
    "scenario",
    "scenario, digest redone",
    "scenario, claim redone",
    "leaf dropped",
    "leaf moved",
    "tree dropped",
)


def paths_of(kind: str, data: Data, rng: np.random.Generator) -> list[tuple]:
    """Return where a mutation of a class may strike."""
    tree = int(rng.integers(len(data["trees"])))
    if kind in COLUMNS:
        column = data["trees"][tree]["leaves"][kind]
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
    if kind == "axis":
        return [("trees", tree, "axis")]
    if kind == "position_m":
        return [("pose", kind, i) for i in range(3)]
    if kind == "angle":
        return [("pose", name) for name in ("roll_rad", "pitch_rad", "yaw_rad")]
    if kind.startswith("scenario") and kind != "scenario_sha256":
        return numbers(data["scenario"], ("scenario",))
    return [(kind,)]


def spoiled(sound: Data, kind: str, rng: np.random.Generator) -> Data | None:
    """Return a certificate's data with one change of a class, or None if it has no such place."""
    data = copy.deepcopy(sound)
    leaves = data["trees"][int(rng.integers(len(data["trees"])))]["leaves"]
    if kind in ("leaf dropped", "leaf moved"):
        row = int(rng.integers(len(leaves["box"])))
        if kind == "leaf moved":
            leaves["box"][row] = list(leaves["box"][int(rng.integers(len(leaves["box"])))])
            return data
        for name in COLUMNS[:-1]:
            del leaves[name][row]
        return data
    if kind == "tree dropped":
        del data["trees"][-1]
        return data
    paths = paths_of(kind, data, rng)
    if not paths:
        return None
    path = paths[int(rng.integers(len(paths)))]
    new = changed(look(data, path), rng)
    if new == look(data, path):
        return None
    look(data, path[:-1])[path[-1]] = new
    if kind.endswith("redone"):
        data["scenario_sha256"] = scenario_digest(data["scenario"])
    return forged(data) if kind == "scenario, claim redone" else data


def forged(data: Data) -> Data | None:
    """Return a certificate for a changed scenario with value, bound and levels made to fit its pose."""
    try:
        scenario = Scenario.from_dict(data["scenario"])
    except ScenarioError:
        return None
    value = min_sinr(scenario, Pose(**data["pose"]))
    factor = value / data["value"]
    data["value"], data["upper_bound"] = value, factor * data["upper_bound"]
    for tree in data["trees"]:
        tree["leaves"]["level"] = [min(factor * x, data["upper_bound"]) for x in tree["leaves"]["level"]]
    return data


def rejection(data: Data) -> str:
    """Return the words with which a certificate is refused or rejected; none if it is accepted."""
    try:
        verdict = verify(parse_certificate(json.dumps(data)))
    except (CertificateError, ScenarioError) as error:
        return str(error)
    assert verdict.message.startswith("proved: " if verdict.proved else "rejected: ")
    return "" if verdict.proved else verdict.message.removeprefix("rejected: ")


@pytest.fixture(scope="module")
def sound(
    paper: Callable, scene: Callable, certified: Callable, cut_into_cells: Callable
) -> dict[str, Certificate]:
    """Returns small certificates of all kinds."""
    three = scene([(0, 0, 0), (40, 5, 2), (10, 40, 1)], [(17, 15, 4), (30, 30, 0)])
    room = {"x_m": (-20.0, 30.0), "y_m": (5.0, 60.0)}
    return {
        "optimum": certified(paper(10.0), gap=0.2),
        "cells": cut_into_cells(certified(paper(0.1), gap=0.2)),
        "ball": certified(paper(keep_out_m=26.5), gap=0.02),
        "vertical": certified(paper(), "vertical", gap=0.4),
        "broadside": certified(paper(**room), "maximum-gain", gap=0.4),
        "null": certified(three, "zero-interference", gap=0.4),
    }


def test_false_certificates_are_rejected(sound: dict[str, Certificate]) -> None:
    """Five hundred random changes that make a statement false are each rejected, with a reason."""
    rng = np.random.default_rng(2024)
    bases = {name: json.loads(certificate_text(one)) for name, one in sound.items()}
    judges = {name: Judge(data, rng) for name, data in bases.items()}
    for name, data in bases.items():
        assert judges[name].falsehood(data) == ""
        assert rejection(data) == ""
    found: Counter[str] = Counter()
    struck: Counter[str] = Counter()
    accepted = []
    turn = 0
    while sum(found.values()) < WANTED:
        kind = CLASSES[turn % len(CLASSES)]
        turn += 1
        assert turn < 10 * WANTED
        name = str(rng.choice(list(bases)))
        if kind in ("cell", "sides"):
            name = "cells"
        elif kind in ("ball", "ball_multiplier"):
            name = "ball"
        data = spoiled(bases[name], kind, rng)
        falsehood = "" if data is None else judges[name].falsehood(data)
        if not falsehood:
            continue
        found[kind] += 1
        struck[falsehood] += 1
        if not rejection(data):
            accepted.append((name, kind, falsehood))
    assert accepted == []
    assert set(found) == set(CLASSES)
    assert {"value", "hole", "multipliers", "distance", "root", "digest", "bound below the optimum"} <= set(
        struck
    )


def test_leaves_are_needed_one_and_all(sound: dict[str, Certificate]) -> None:
    """Without any one leaf, or with its level far too low, the rest is rejected."""
    for one in (sound["cells"], sound["null"]):
        tree = one.trees[0]
        rng = np.random.default_rng(5)
        for row in rng.choice(len(tree.leaves), size=15, replace=False):
            kept = np.delete(np.arange(len(tree.leaves)), row)
            columns = {name: getattr(tree.leaves, name)[kept] for name in Leaves.__slots__ if name != "mixes"}
            leaves = Leaves(mixes=tree.leaves.mixes, **columns)
            verdict = verify(replace(one, trees=(replace(tree, leaves=leaves), *one.trees[1:])))
            assert not verdict.proved
            assert "do not cover" in verdict.message
            level = tree.leaves.level.copy()
            level[row] *= 1e-9
            leaves = replace(tree.leaves, level=level)
            verdict = verify(replace(one, trees=(replace(tree, leaves=leaves), *one.trees[1:])))
            if tree.leaves.test[row] != 4:
                assert not verdict.proved
                assert f"leaf {row} " in verdict.message


def test_a_bound_that_is_too_low_is_rejected(sound: dict[str, Certificate]) -> None:
    """With bound and levels lowered together to just below the value, some leaf fails."""
    for one in sound.values():
        bound = one.value * (1.0 + 1e-9)
        trees = tuple(
            replace(t, leaves=replace(t.leaves, level=np.minimum(t.leaves.level, bound))) for t in one.trees
        )
        verdict = verify(replace(one, upper_bound=bound, trees=trees))
        assert not verdict.proved
        assert "is not excluded" in verdict.message or "root" in verdict.message


def test_undefined_numbers_prove_nothing(sound: dict[str, Certificate]) -> None:
    """Numbers that no file can hold, but a program could put in, do not slip through."""
    one = sound["ball"]
    tree = one.trees[0]
    for bad in (math.nan, math.inf):
        for field in ("value", "upper_bound"):
            assert not verify(replace(one, **{field: bad})).proved
        for name in ("level", "ball_multiplier"):
            column = np.full(len(tree.leaves), bad)
            leaves = replace(tree.leaves, **{name: column})
            assert not verify(replace(one, trees=(replace(tree, leaves=leaves),))).proved
        root_m = tree.root_m.copy()
        root_m[0, 0] = bad
        assert not verify(replace(one, trees=(replace(tree, root_m=root_m),))).proved
