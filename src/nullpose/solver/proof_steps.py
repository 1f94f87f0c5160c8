"""A proof again, with a bound that falls step by step: which boxes are still open at each step."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from nullpose.antenna import PatternAntenna
from nullpose.objectives import FloatArray
from nullpose.problem.axis_field import AxisField
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.problem.schemes import Scheme
from nullpose.solver.options import SolveOptions
from nullpose.solver.pattern import PatternRun, reach_of
from nullpose.solver.proof import Proof
from nullpose.solver.result import Result
from nullpose.solver.rigour import Rigour
from nullpose.solver.worker_pool import Kernel, WorkerPool

IntArray = NDArray[np.int64]

_STEPS = 61
_WIDEST_GAP = 1.0
_CHUNK = 1000  # boxes between two looks at the clock
_MOST_BOXES = 100_000  # of a step, closed ones too
_LIMIT_S = 20.0


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ProofStep:
    """The boxes that are open when the bound has fallen to a gap above the value.

    Outside them no pose is above the value by more than the gap of the last step, at which none is open.

    Args:
        gap: of the smallest ratio, relative: no pose is above the value by more.
        centre_m: (b, 3) metres.
        half_m: (b, 3) half sides, metres.
    """

    gap: float
    centre_m: FloatArray
    half_m: FloatArray

    def holds(self, position_m: FloatArray) -> bool:
        """Return whether a position is in a box, or on its edge.

        Args:
            position_m: (3,) metres.
        """
        reach_m = self.half_m * (1.0 + 1e-9) + 1e-9
        return bool(np.any(np.all(np.abs(position_m - self.centre_m) <= reach_m, axis=1)))

    def reach_m(self, position_m: FloatArray) -> float:
        """Return how far from a position the boxes reach, metres; zero without any.

        Args:
            position_m: (3,) metres.
        """
        away_m = np.abs(position_m - self.centre_m) + self.half_m
        return float(np.max(np.linalg.norm(away_m, axis=1), initial=0.0))


class _Tree:
    """The boxes of one tree, all excluded at the level last asked for.

    Args:
        rows: (n, columns) in the kernels' layout, to begin with.
        middle: columns of a box's centre and half sides.
        named: columns that tell a row from all others.
        excluding: returns the kernel that excludes a level.
        orientation: shape of what a pose has beside its position.
    """

    def __init__(
        self,
        rows: FloatArray,
        middle: list[int],
        named: list[int],
        excluding: Callable[[float], Kernel],
        orientation: tuple[int, ...],
    ) -> None:
        self.rows, self._middle, self._named = rows, middle, named
        self._excluding, self._orientation = excluding, orientation
        self._stages: list[tuple[FloatArray, IntArray]] = []

    def refine(self, level: float, go_on: Callable[[], bool]) -> bool:
        """Return whether all boxes could be excluded at a lower level."""
        workers, kernel = WorkerPool(self.rows, 1, self._orientation), self._excluding(level)
        while not workers.done:
            if not go_on() or workers.filled > _MOST_BOXES:
                return False
            workers.work(kernel, _CHUNK, None)
        self.rows = workers.leaves()
        names = np.fromiter((hash(row.tobytes()) for row in self.rows[:, self._named]), np.int64)
        self._stages.append((self.rows[:, self._middle], names))
        return True

    def open_boxes(self, steps: int) -> list[FloatArray]:
        """Return for each of so many steps the boxes that were not yet closed."""
        last = self._stages[steps - 1][1]
        return [boxes[~np.isin(names, last)] for boxes, names in self._stages[:steps]]


def has_proof_steps(result: Result) -> bool:
    """Return whether a result's proof is one whose steps can be shown.

    Args:
        result: any.
    """
    objective, is_pattern = result.objective, not result.scenario.antenna_record.is_quadratic
    if not isinstance(result.scheme, Scheme) or objective.upper_bound is None or result.scenario.array:
        return False
    value, bound = _ratios(result)
    proved = is_pattern or (bool(result.proofs) and objective.rigour is not Rigour.FLOATING_POINT)
    return proved and 0.0 < bound / value - 1.0 < _WIDEST_GAP


def proof_steps(result: Result, go_on: Callable[[], None] = lambda: None) -> tuple[ProofStep, ...]:
    """Return the steps of a result's proof, the bound falling from twice the value to the one proved.

    The branch and bound is run again, each step with the boxes of the one before: a box is split until its
    bound is low enough. Those that are never split again are closed. If it takes too long, the steps end at
    a wider gap. A step at which even the box of the pose is closed is left out, but for the last.

    Args:
        result: one that :func:`has_proof_steps`.
        go_on: called now and then; what it raises ends the work.
    """
    value, bound = _ratios(result)
    trees, until = _trees(result), time.perf_counter() + _LIMIT_S

    def may_go_on() -> bool:
        go_on()
        return time.perf_counter() < until

    gaps = [float(gap) for gap in np.geomspace(_WIDEST_GAP, bound / value - 1.0, _STEPS)]
    done = 0
    for gap in gaps:
        level = bound if gap == gaps[-1] else value * (1.0 + gap)
        if not all(tree.refine(level, may_go_on) for tree in trees):
            break
        done += 1
    if done < 2:
        return ()
    found = []
    for gap, *parts in zip(gaps, *(tree.open_boxes(done) for tree in trees), strict=False):
        boxes = np.unique(np.concatenate(parts), axis=0)  # one may be open for several cells of axes
        found.append(ProofStep(gap=gap, centre_m=boxes[:, :3], half_m=boxes[:, 3:]))
    at_m = result.pose.position_m
    return tuple(step for step in found if step is found[-1] or step.holds(at_m))


def _ratios(result: Result) -> tuple[float, float]:
    """Return the smallest ratio and the bound on it."""
    objective = result.objective
    assert objective.upper_bound is not None, "the caller asks"
    if objective.quantity.is_rate:
        return 2.0**objective.value, 2.0**objective.upper_bound
    return objective.value, objective.upper_bound


def _trees(result: Result) -> list[_Tree]:
    scenario, scheme, antenna = result.scenario, Scheme(result.scheme), result.scenario.antenna_record
    if not antenna.is_quadratic:
        return [_pattern_tree(result, antenna)]
    family, fields = build_family(scenario), scheme.record.fields(scenario, result.null_jammer)
    assert fields is not None, "the caller asks"
    pairs = zip(fields.values(), result.proofs, strict=True)
    return [_dipole_tree(family, field, proof) for field, proof in pairs]


def _dipole_tree(family: Family, axis_field: AxisField, proof: Proof) -> _Tree:
    from nullpose.solver.kernels import branch, node
    from nullpose.solver.kernels.jit import entry_of
    from nullpose.solver.kernels.records import Goal

    root, weights = np.zeros(node.COLUMNS), proof.incumbent.multipliers.copy()
    node.keep_largest(weights, len(weights), root)
    root[node.CENTRE : node.HALF] = 0.5 * (proof.root[0] + proof.root[1])
    root[node.HALF : node.LEVEL] = 0.5 * (proof.root[1] - proof.root[0])
    root[node.FACE] = -1.0
    goal = Goal(math.inf, root.copy(), proof.axes_above)  # poses that are better by less than the gap
    problem = family.arrays, family.domain, axis_field.arrays
    middle, cell = list(range(node.LEVEL)), list(range(node.FACE, node.SIDE))
    return _Tree(
        root[None],
        middle,
        middle + cell,
        lambda level: partial(entry_of(branch.branch, family.arrays), *problem, level, goal),
        (3,),
    )


def _pattern_tree(result: Result, antenna: PatternAntenna) -> _Tree:
    from nullpose.solver.kernels.attitude import HALF, WARM
    from nullpose.solver.kernels.pattern_branch import branch_pattern

    scenario, (value, bound) = result.scenario, _ratios(result)
    family, reach = build_family(scenario, any_antenna=True), reach_of(scenario, antenna)
    run = PatternRun(family, antenna, reach, SolveOptions().of(scenario))
    run.search.compile()
    run.search.best, run.search.pose = math.log(value), (result.pose.position_m, np.eye(3))
    problem = family.arrays, family.domain, antenna.arrays, reach
    return _Tree(
        run.cells_of(run.root_of(bound / value - 1.0)),
        [0, 1, 2, HALF, HALF + 1, HALF + 2],
        list(range(WARM)),
        lambda level: partial(branch_pattern, *problem, level, math.inf, True),
        (3, 3),
    )
