"""Poses for an antenna whose null is not perfect, against brute force."""

import numpy as np
import pytest
from scipy.optimize import differential_evolution
from sizes import chosen

from nullpose import Scenario, load, solve, solve_many
from nullpose.certificate import verify
from nullpose.physics import ErrorCase, objective_value, rotation_between
from nullpose.scenario import apply_overrides
from nullpose.solver.certificate_from_proof import certificate_of

PAPER = load("examples/paper.toml")


def with_null(depth_db: float, power_w: float = 1.0) -> Scenario:
    """Return the paper's scene with a null of some depth and some jamming."""
    overrides = [f"antenna.null_depth_db={depth_db}", f"jammers.M.power_w={power_w}"]
    return apply_overrides(PAPER, overrides)


def by_brute_force(scene: Scenario) -> float:
    """Return the largest smallest SINR that differential evolution finds."""

    def losses(x: np.ndarray) -> np.ndarray:
        azimuth, polar = x[3:]
        axes = np.stack([np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)])
        return -objective_value(scene, x[:3].T, axes.T)

    box = [(-40.0, 60.0), (-20.0, 80.0), (8.0, 30.0), (0.0, 2.0 * np.pi), (0.0, np.pi)]
    options = {"seed": 1, "tol": 1e-10, "maxiter": 600, "popsize": 15}
    return -float(differential_evolution(losses, box, vectorized=True, updating="deferred", **options).fun)


@pytest.mark.parametrize("depth_db", chosen([20.0, 30.0, 40.0], [1]))
def test_optimum(depth_db: float) -> None:
    """The certified value is what brute force finds."""
    scene = with_null(depth_db, 100.0)
    solution = solve(scene, gap=1e-6)
    assert solution.status == "certified"
    assert solution.objective.value == pytest.approx(by_brute_force(scene), rel=1e-6)


@pytest.mark.parametrize("scheme", ["optimum", "zero-interference", "maximum-gain", "vertical"])
def test_certificates(scheme: str) -> None:
    """Every case is proved, and its certificate verified."""
    solution = solve(with_null(25.0, 10.0), scheme, gap=1e-4)
    assert verify(certificate_of(solution)).proved


def test_a_deeper_null_is_never_worse() -> None:
    """The certified value grows with the depth, up to that of the perfect null."""
    values = [solve(with_null(depth, 10.0), gap=1e-6).objective.value for depth in (0.0, 10.0, 30.0, 60.0)]
    assert np.all(
        np.diff([*values, solve(apply_overrides(PAPER, ["jammers.M.power_w=10"])).objective.value]) > 0.0
    )


def test_many_scenes_with_antennas_of_their_own() -> None:
    """Solved together they have the values that they have alone."""
    scenes = [with_null(20.0), PAPER, with_null(35.0)]
    together = solve_many(scenes, gap=1e-6)
    alone = [solve(scene, gap=1e-6).objective.value for scene in scenes]
    np.testing.assert_allclose(np.ravel(together.value), alone, rtol=1e-6)


def test_robust_pose() -> None:
    """No error case tried leaves less than the pose guarantees."""
    scene = apply_overrides(load("examples/robust.toml"), ["antenna.null_depth_db=25"])
    solution = solve(scene, robust=True, gap=3e-2)
    assert solution.status == "certified"
    pose, guaranteed, rng = solution.pose, solution.details.robust.guaranteed, np.random.default_rng(3)
    reach_m, radius_m = scene.receiver.position_error_m, scene.jammers[0].uncertainty_m
    axis = pose.antenna_axis
    values = []
    for offset, jammer, lean in rng.normal(size=(300, 3, 3)):
        offset, jammer = offset / np.linalg.norm(offset), jammer / np.linalg.norm(jammer)
        across = lean - axis * (lean @ axis)
        angle = np.radians(scene.receiver.attitude_error_deg)
        actual = np.cos(angle) * axis + np.sin(angle) * across / np.linalg.norm(across)
        case = ErrorCase(
            position_offset_m=reach_m * offset,
            rotation_world=rotation_between(axis, actual),
            jammer_offsets_m=radius_m * jammer[None],
            eavesdropper_offsets_m=np.zeros((0, 3)),
        )
        values.append(float(objective_value(scene, pose.position_m, axis, case)))
    assert guaranteed <= min(values) < 1.5 * guaranteed
