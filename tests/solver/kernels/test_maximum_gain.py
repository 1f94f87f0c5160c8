"""Maximum gain for any number of nodes, against dense grids of axes."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from paper_schemes import maximum_gain_axis, maximum_gain_sinr
from scipy.optimize import minimize
from sizes import diagonal

from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.search.maximum_gain import maximum_gain_value


def received(family: Family, p: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Returns the nodes' numerators (..., R) at unit axes (..., 3)."""
    r = family.ratios.points_m[family.ratios.numerator_point] - p
    across = np.cross(axes[..., None, :], r)
    return family.ratios.numerator_weight * np.sum(across**2, axis=-1) / np.sum(r**2, axis=-1) ** 2


def jamming(family: Family, p: np.ndarray, axes: np.ndarray) -> np.ndarray:
    """Returns the shared denominator (...) at unit axes (..., 3)."""
    r = family.ratios.points_m[family.ratios.denominator_point] - p
    across = np.cross(axes[..., None, :], r)
    return 1.0 + np.sum(
        family.ratios.denominator_weight * np.sum(across**2, axis=-1) / np.sum(r**2, axis=-1) ** 2, axis=-1
    )


def best_level(family: Family, p: np.ndarray, rng: np.random.Generator) -> float:
    """Returns the largest smallest numerator: the best of many axes, refined on the epigraph form."""
    axes = rng.normal(size=(20_000, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    values = np.min(received(family, p, axes), axis=1)
    best = scale = float(values.max())
    for start in np.argsort(-values)[:5]:
        result = minimize(
            lambda x: -x[3],
            [*axes[start], values[start] / scale],
            method="SLSQP",
            constraints=[
                {"type": "ineq", "fun": lambda x: received(family, p, x[:3]) / scale - x[3]},
                {"type": "eq", "fun": lambda x: x[:3] @ x[:3] - 1.0},
            ],
            options={"ftol": 1e-15, "maxiter": 200},
        )
        u = result.x[:3] / np.linalg.norm(result.x[:3])
        best = max(best, float(np.min(received(family, p, u))))
    return best


@pytest.mark.parametrize(("nodes", "jammers"), diagonal([1, 3, 5], [0, 1, 3]))
def test_the_axis_serves_the_nodes_best(nodes: int, jammers: int, random_scene: Callable) -> None:
    """No axis gives the worst node more; the value is the smallest ratio at the axis."""
    rng = np.random.default_rng(10 * nodes + jammers)
    for _ in range(6):
        family = build_family(random_scene(rng, nodes, jammers, 10.0))
        p = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0])
        axis = np.empty(3)
        value = maximum_gain_value(family.ratios, p, axis)
        assert np.linalg.norm(axis) == pytest.approx(1.0, abs=1e-14)
        level = float(np.min(received(family, p, axis)))
        best = best_level(family, p, rng)
        assert best * (1.0 - 1e-7) <= level
        assert best <= level * (1.0 + 1e-10)
        assert value == pytest.approx(math.log(level / jamming(family, p, axis)), abs=1e-12)


@pytest.mark.parametrize("nodes", [1, 3, 5])
def test_among_equal_axes_the_quietest_is_taken(nodes: int, random_scene: Callable) -> None:
    """Where one far node decides alone, a whole arc of axes serves the nodes alike: its quietest is taken."""
    rng = np.random.default_rng(nodes)
    arcs = 0
    for _ in range(40):
        family = build_family(random_scene(rng, nodes, 2, 10.0))
        p = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0])
        axis = np.empty(3)
        maximum_gain_value(family.ratios, p, axis)
        r = family.ratios.points_m[:nodes] - p
        reach = family.ratios.numerator_weight / np.sum(r**2, axis=1)
        worst = int(np.argmin(reach))
        if np.min(received(family, p, axis)) < reach[worst] * (1.0 - 1e-9):
            continue  # the others decide too, and the axis is a single one
        arcs += 1
        frame = np.linalg.svd(r[worst][None])[2][1:]
        turn = np.linspace(0.0, math.pi, 20_001)
        circle = np.column_stack([np.cos(turn), np.sin(turn)]) @ frame
        serving = np.min(received(family, p, circle), axis=1) >= reach[worst] * (1.0 - 1e-9)
        quietest = float(np.min(jamming(family, p, circle[serving])))
        assert jamming(family, p, axis) <= quietest * (1.0 + 1e-9)
        # a slope times the step of the circle is all that the grid can be above it
        assert jamming(family, p, axis) >= quietest * (1.0 - 1e-2)
    assert arcs >= 10


def test_two_nodes_are_served_broadside(scene: Callable) -> None:
    """For two equal nodes at the same distance the axis is the paper's, eq. 3.4, whatever the jammer."""
    rng = np.random.default_rng(33)
    for _ in range(20):
        nodes = rng.uniform([0.0, 0.0, 0.0], [50.0, 50.0, 5.0], (2, 3))
        two = scene(nodes, [(20.0, 60.0, 3.0)], jammer_powers_w=10.0)
        p = nodes.mean(axis=0) + 0.3 * np.cross(nodes[1] - nodes[0], rng.normal(size=3))
        axis = np.empty(3)
        value = maximum_gain_value(build_family(two).ratios, p, axis)
        # axes that serve a node to 1e-11 reach 3e-6 rad to both sides
        assert abs(axis @ maximum_gain_axis(two, p)) == pytest.approx(1.0, abs=1e-9)
        assert value == pytest.approx(math.log(np.min(maximum_gain_sinr(two, p))), abs=1e-4)
