"""A judge of spoiled certificates that shares no code with the verifier.

It evaluates the pose by the physics, looks whether sampled positions and axes of the sound certificate's
leaves are held by a leaf of the spoiled one, and whether each leaf's statement is true at sampled positions
of its box.
"""

from typing import Any

import numpy as np
from benchmarks.mutations.truth import Data, Problem, allowed_axes, claim_fault

from nullpose.certificate.file import scenario_digest
from nullpose.errors import ScenarioError, SolveError, UsageError
from nullpose.scenario import Scenario
from nullpose.solver import solve

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
        false = claim_fault(data, scenario) or self.optimum(data, scenario)
        if not false and sorted(tree["axis"] for tree in data["trees"]) != sorted(
            allowed_axes(data, scenario)
        ):
            false = "names of trees"
        return false or self.proof(data, scenario)

    def optimum(self, data: Data, scenario: Scenario) -> str:
        """Return whether a search finds a better pose than the bound allows."""
        if data["scenario"] == self.sound["scenario"] and data["upper_bound"] >= self.sound["upper_bound"]:
            return ""
        try:
            found = solve(scenario, data["scheme"], certify=False, null_jammer=data["null_jammer"])
        except (SolveError, UsageError):
            return ""
        better = Problem(scenario).value(found.pose) > data["upper_bound"] * (1 + 1e-9)
        return "bound below the optimum" if better else ""

    def proof(self, data: Data, scenario: Scenario) -> str:
        """Return what is false of the trees."""
        axes, problem = allowed_axes(data, scenario), Problem(scenario)
        for before, tree in zip(self.sound["trees"], data["trees"], strict=True):
            leaves = {name: np.array(c) for name, c in tree["leaves"].items() if name != "mixes"}
            leaves.setdefault("band", np.zeros(len(leaves["test"])))
            for column, width in {"box": 6, "cell": 5, "sides": 2}.items():  # also of a tree without leaves
                leaves[column] = leaves[column].reshape(-1, width)
            mixes = [dict(map(tuple, mix)) for mix in tree["leaves"]["mixes"]]
            words = (
                self.ranges(leaves, mixes, problem, data["upper_bound"], axes[tree["axis"]] is None)
                or self.root(np.array(tree["root_m"]), problem, data["upper_bound"])
                or self.hole(before["leaves"], leaves)
                or self.off_band(leaves, scenario.axis_band if tree["axis"] == "band" else (0.0, 1.0))
                or self.statement(np.array(tree["root_m"]), leaves, mixes, problem, axes[tree["axis"]])
            )
            if words:
                return words
        return ""

    def ranges(
        self, leaves: dict[str, Any], mixes: list[dict], problem: Problem, bound: float, is_free: bool
    ) -> str:
        """Return which number cannot be: none of these could be part of a proof."""
        ratios, points = len(problem.node), len(problem.points)
        borders = len(problem.balls) + len(problem.zones)
        test, point = leaves["test"], leaves["point"]
        depth = np.hstack([leaves["box"][:, ::2], leaves["cell"][:, 1::2]])
        index = np.hstack([leaves["box"][:, 1::2], leaves["cell"][:, 2::2]])
        needs_mix = test <= 2
        wrong = {
            "level above the bound": leaves["level"] > bound,
            "level": leaves["level"] <= 0.0,
            "test": (test < 0) | (test > 5) | ((test == 2) & is_free),
            "mix": needs_mix & ((leaves["mix"] < 0) | (leaves["mix"] >= len(mixes))),
            "frame": (test == 1) & ((point < 0) | (point >= points)),
            "node": (test == 3) & ((point < 0) | (point >= ratios)),
            "ball": ((test == 4) & ((point < 0) | (point >= borders))) | (leaves["ball"] >= borders),
            "multiplier": (leaves["ball_multiplier"] < 0.0) | np.any(leaves["sides"] < 0.0, axis=1),
            "depth": np.any((depth < 0) | (depth > 50), axis=1),
            "index": np.any((index < 0) | (index >= 2.0 ** np.clip(depth, 0, 50)), axis=1),
            "face": (leaves["cell"][:, 0] < -1) | (leaves["cell"][:, 0] > 2),
        }
        words = [name for name, mask in wrong.items() if np.any(mask)]
        if any(not mix or min(mix.values()) < 0.0 or not set(mix) <= set(range(ratios)) for mix in mixes):
            words.append("mixes")
        return ", ".join(words)

    def root(self, root_m: np.ndarray, problem: Problem, bound: float) -> str:
        """Return whether a face leaves out what distances do not exclude."""
        airspace = problem.scenario.airspace
        low, high = airspace.lower_m.copy(), airspace.upper_m.copy()
        if len(airspace.geofence_outline_m):
            low[:2] = np.maximum(low[:2], airspace.geofence_outline_m.min(axis=0))
            high[:2] = np.minimum(high[:2], airspace.geofence_outline_m.max(axis=0))
        points = problem.points[problem.node]
        gap2 = np.maximum(0.0, np.maximum(low - points, points - high)) ** 2
        for i in range(3):
            at, others2 = points[:, i], np.sum(gap2, axis=1) - gap2[:, i]
            for beyond, away_m in (
                (root_m[0, i] > low[i], at - root_m[0, i]),
                (root_m[1, i] < high[i], root_m[1, i] - at),
            ):
                least_m = np.sqrt(np.maximum(away_m, 1e-9) ** 2 + others2)
                best = problem.best_received(least_m * (1.0 + 1e-9))
                if beyond and np.all(best > bound):
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

    def off_band(self, leaves: dict[str, Any], band: tuple[float, float]) -> str:
        """Return whether a cell said to be out of reach holds an axis of the band."""
        cells = leaves["cell"][leaves["test"] == 5]
        if np.any(cells[:, 0] < 0):
            return "reach"
        shares = np.array([[x, y] for x in np.linspace(0, 1, 21) for y in np.linspace(0, 1, 21)])
        for cell in cells:
            ends = -1.0 + 2.0 * (cell[2::2] + shares) / 2.0 ** cell[1::2]
            u = np.ones((len(shares), 3))
            u[:, (cell[0] + 1) % 3], u[:, (cell[0] + 2) % 3] = ends[:, 0], ends[:, 1]
            upright = u[:, 2] ** 2 / np.sum(u * u, axis=1)
            if np.any((upright > band[0] + 1e-9) & (upright < band[1] - 1e-9) | (upright == band[0])):
                return "reach"
        return ""

    def statement(
        self, root_m: np.ndarray, leaves: dict[str, Any], mixes: list[dict], problem: Problem, axis: Any
    ) -> str:
        """Return which leaf's own statement fails at a position of its box."""
        share = 2.0 ** -leaves["box"][:, ::2]
        low = root_m[0] + (root_m[1] - root_m[0]) * leaves["box"][:, 1::2] * share
        half = 0.5 * (root_m[1] - root_m[0]) * share
        count, rows = len(low), np.arange(len(low))
        corners = np.tile(0.999 * CORNERS, (count, 1, 1))
        shifts = [corners, self.rng.uniform(-1, 1, (count, 4, 3)), np.zeros((count, 1, 3))]
        p = (low + half)[:, None] + np.concatenate(shifts, axis=1) * half[:, None]
        test, point, level, ball = (leaves[name] for name in ("test", "point", "level", "ball"))
        keep, balls = problem.scenario.airspace.keep_out_m, len(problem.balls)
        square, gains = (
            np.sum((problem.points - p[:, :, None]) ** 2, axis=-1),
            problem.gains(problem.points - p[:, :, None]),
        )
        around = (
            np.sum((problem.balls - p[:, :, None]) ** 2, axis=-1) if balls else np.zeros((*p.shape[:2], 1))
        )
        depths = np.stack([zone(p) for zone in problem.zones], -1) if problem.zones else np.zeros_like(around)
        allowed = np.all(square >= (keep * (1 + 1e-9)) ** 2, axis=-1)
        received = problem.above * gains[..., problem.node] / square[..., problem.node]
        best = problem.isotropic + received.min(axis=-1)
        if np.any(allowed & (best > level[:, None] * (1.0 + 1e-9)) & (test == 3)[:, None]):
            return "distance"
        in_ball = around[rows, :, np.clip(point, 0, max(balls - 1, 0))] < keep**2 * (1.0 + 1e-9)
        in_zone = depths[rows, :, np.clip(point - balls, 0, depths.shape[2] - 1)] > -1e-9
        if np.any(~np.where((point < balls)[:, None], in_ball, in_zone) & (test == 4)[:, None]):
            return "kept out"
        lambdas = np.zeros((count, len(problem.node)))
        for i in np.flatnonzero(test <= 2):
            for k, w in mixes[leaves["mix"][i]].items():
                lambdas[i, k] = w
        above, below = problem.forms(p)
        total = np.einsum("lk,lsk...->ls...", lambdas, above)
        total = total - np.einsum("lk,lsk...->ls...", lambdas * level[:, None], below)
        nu = np.where((ball >= 0) & (ball < balls), leaves["ball_multiplier"], 0.0)
        away = around[rows, :, np.clip(ball, 0, max(balls - 1, 0))] - keep**2
        total = total + (nu[:, None] * away)[..., None, None] * np.eye(3)
        # what a zone forbids by more than a hair is not spoken of
        of_zone = depths[rows, :, np.clip(ball - balls, 0, depths.shape[2] - 1)]
        spoken = (ball < balls)[:, None] | (of_zone < -1e-6)
        size = lambdas.sum(axis=1) * level * 1e-9
        band = problem.scenario.axis_band if axis is None else (0.0, 1.0)
        extra = [
            self.sides(*each, band)
            for each in zip(leaves["cell"], leaves["sides"], leaves["band"], strict=True)
        ]
        sided = total + np.array(extra)[:, None]
        tops = np.linalg.eigvalsh(sided)[..., -1]
        if band == (0.0, 0.0):
            tops = np.where((test == 0)[:, None], np.linalg.eigvalsh(sided[..., :2, :2])[..., -1], tops)
        if np.any((tops > size[:, None]) & spoken & (test <= 1)[:, None]):
            return "multipliers"
        for i in np.flatnonzero(test == 2):
            for s in np.flatnonzero(spoken[i]):
                u = axis(p[i, s])
                if np.all(np.isfinite(u)) and u @ total[i, s] @ u > size[i]:
                    return "multipliers"
        return ""

    def sides(
        self, cell: np.ndarray, multipliers: np.ndarray, of_band: float, band: tuple[float, float]
    ) -> np.ndarray:
        """Return the weighted form of a cell's sides and of the band."""
        form = of_band * ((band[1] if of_band > 0.0 else band[0]) * np.eye(3) - np.diag([0.0, 0.0, 1.0]))
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
