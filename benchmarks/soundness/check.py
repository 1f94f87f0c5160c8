"""One scene's verdict."""

from __future__ import annotations

import time
from dataclasses import dataclass

from scipy.spatial.transform import Rotation

from benchmarks.soundness.ends import subsets_of
from benchmarks.soundness.scenes import Scene
from benchmarks.soundness.search import best_value, feasible
from nullpose.certificate import verify
from nullpose.objectives import LEAST_RATE_BPS_HZ, Quantity
from nullpose.physics import objective_value
from nullpose.solver import Rigour, solve
from nullpose.solver.certificate_from_proof import certificate_of

_ROUNDING = 1e-12
_BELOW = 1e-6  # relative: where two searches end
_MOST_LEAVES = 30_000  # that are verified: with more it takes a minute


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What became of a scene: its value and bound, what other searches find, and what is unsound."""

    scene: Scene
    status: str
    value: float
    upper_bound: float
    searched: float  # by the independent search
    fast: float  # by the search alone
    promised: bool  # that the proof can be verified
    checked: bool  # by the verifier, which takes long if there are many leaves
    seconds: float
    faults: tuple[str, ...]


def check_scene(scene: Scene, *, starts: int = 200, time_limit_s: float = 5.0) -> Outcome:
    """Return whether a scene's value and bound withstand a search, a re-evaluation and the verifier.

    The search and the verifier are independent of the solver; the verifier sees what was certified.
    """
    if scene.scenario.array is not None:
        return _check_array(scene)
    began = time.perf_counter()
    limits = {} if scene.cells is None else {"node_limit": scene.cells}
    solution = solve(scene.scenario, scene.scheme, gap=scene.gap, time_limit_s=time_limit_s, **limits)
    seconds = time.perf_counter() - began
    objective, pose = solution.objective, solution.pose
    assert objective.upper_bound is not None
    orientation = pose.orientation(scene.scenario.antenna_record)
    turned = orientation if orientation.ndim == 1 else Rotation.from_matrix(orientation).as_quat()
    near = (pose.position_m, turned)
    fast = solve(scene.scenario, scene.scheme, certify=False).objective.value
    searched = best_value(scene.scenario, scene.scheme, starts=starts, seed=scene.number, near=near)
    faults = []
    if searched > objective.upper_bound * (1.0 + _ROUNDING):
        faults.append(f"a pose reaches {searched!r}, above the bound {objective.upper_bound!r}")
    again = float(objective_value(scene.scenario, pose.position_m, orientation))
    if again != objective.value:
        faults.append(f"the pose gives {again!r}, not {objective.value!r}")
    if objective.value > objective.upper_bound * (1.0 + _ROUNDING):
        faults.append(f"the value {objective.value!r} is above the bound {objective.upper_bound!r}")
    keeps = scene.scenario.airspace.keep_out_m * (1.0 - 1e-12)
    grown = scene.scenario.model_copy(
        update={"airspace": scene.scenario.airspace.model_copy(update={"keep_out_m": keeps})}
    )
    if not feasible(grown, pose.position_m[None])[0]:
        faults.append("the pose is outside the airspace")
    airframe = scene.scenario.airframe
    if airframe is not None and pose.tilt_rad > airframe.tilt_max_rad:
        faults.append(f"the pose tilts by {pose.tilt_rad!r} rad, more than {airframe.tilt_max_rad!r}")
    # a proof that closes at once leaves the value within the gap; with few cells the search is not made whole
    within = max(
        _BELOW, scene.gap or 0.0, solution.provenance["gap"] if solution.status == "certified" else 0.0
    )
    floor = LEAST_RATE_BPS_HZ if Quantity.of(scene.scenario).is_rate else 0.0  # of what a gap is relative to
    if objective.value < fast - within * max(fast, floor) and scene.cells is None:
        faults.append(f"the value {objective.value!r} is below that of the search alone, {fast!r}")
    if scene.cells is None:
        faults += _below_subsets(scene, objective.value, within, floor)
    promised = solution.rigour is Rigour.VERIFIABLE and bool(solution.proofs)
    checked = promised and sum(len(proof.leaves) for proof in solution.proofs) <= _MOST_LEAVES
    if checked:
        verdict = verify(certificate_of(solution))
        faults += [] if verdict.proved else [f"its certificate is {verdict.message}"]
    return Outcome(
        scene=scene,
        status=solution.status.value,
        value=objective.value,
        upper_bound=objective.upper_bound,
        searched=searched,
        fast=fast,
        promised=promised,
        checked=checked,
        seconds=seconds,
        faults=tuple(faults),
    )


def _below_subsets(scene: Scene, value: float, within: float, floor: float = 0.0) -> list[str]:
    """Return where a search of some of the poses has more than the answer over all of them."""
    faults = []
    for words, scenario, scheme in subsets_of(scene.scenario, scene.scheme):
        less = solve(scenario, scheme, certify=False).objective.value
        if value < less - within * max(less, floor):
            faults.append(f"the value {value!r} is below that {words}, {less!r}")
    return faults


def _check_array(scene: Scene) -> Outcome:
    """Return whether an array has no less than one of its elements, and no more than its bound."""
    began = time.perf_counter()
    solution = solve(scene.scenario)
    seconds = time.perf_counter() - began
    value, bound = solution.objective.value, solution.objective.upper_bound
    fast = solve(scene.scenario, certify=False).objective.value
    faults = _below_subsets(scene, value, _BELOW)
    if bound is not None and max(value, fast) > bound * (1.0 + _ROUNDING):
        faults.append(f"the value {max(value, fast)!r} is above the bound {bound!r}")
    if value < fast * (1.0 - _BELOW):
        faults.append(f"the value {value!r} is below that of the search alone, {fast!r}")
    return Outcome(
        scene=scene,
        status=solution.status.value,
        value=value,
        upper_bound=float("inf") if bound is None else bound,
        searched=value,
        fast=fast,
        promised=False,
        checked=False,
        seconds=seconds,
        faults=tuple(faults),
    )
