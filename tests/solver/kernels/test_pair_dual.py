"""Multipliers of pairs: a bound on the smallest quotient at any axis, and nearly the best."""

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.certificate.forms import matrices
from nullpose.objectives import Ratios
from nullpose.solver.kernels.linear_algebra import links, pair_dual

pair_multipliers, pair_tangent, log_quotient = map(
    plain, (pair_dual.pair_multipliers, links.pair_tangent, links.log_quotient)
)
ISOTROPIC = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) / 3.0
PLACES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))


def denominators(rng: np.random.Generator, count: int) -> np.ndarray:
    """Return noise and the drone's signal at points in random directions, (count, 3, 3)."""
    away = rng.normal(size=(count, 3))
    away /= np.linalg.norm(away, axis=1, keepdims=True)
    across = np.eye(3) - away[:, :, None] * away[:, None, :]
    return np.eye(3) + 10.0 ** rng.uniform(-1.0, 2.0, count)[:, None, None] * across


def scene(rng: np.random.Generator, nodes: int, eavesdroppers: int) -> tuple[Ratios, np.ndarray]:
    """Return ratios whose pairs are all nodes with all eavesdroppers, and their denominators."""
    count = nodes + eavesdroppers
    node, eavesdropper = np.divmod(np.arange(nodes * eavesdroppers), eavesdroppers)
    signals = np.append(10.0 ** rng.uniform(0.0, 1.0, nodes), 10.0 ** rng.uniform(-0.5, 1.0, eavesdroppers))
    each = np.arange(count)
    ratios = Ratios(
        np.zeros((count, 3)), 1.0 + signals, np.ones(count), each, each, np.ones(count),
        np.arange(count + 1), each, np.ones(count), pairs=np.column_stack([node, nodes + eavesdropper]),
    )  # fmt: skip
    return ratios, denominators(rng, count)


def bound_of(ratios: Ratios, level: float, groups: np.ndarray) -> tuple[float, float]:
    """Return the largest eigenvalue of the sum of tangents, and the smallest tangent at the form found."""
    node, eavesdropper = ratios.pairs.T
    jammed, heard, multipliers = groups[eavesdropper], groups[node], np.empty(len(node))
    matrix, room = np.empty(6), np.empty((len(node), 6))
    pair_multipliers(ratios, level, groups, room, 0, 1e-7, ISOTROPIC, multipliers, matrix)
    assert np.all(multipliers >= 0.0)
    assert np.sum(multipliers) == pytest.approx(1.0, abs=1e-12)
    twice = matrix * [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    tangents = np.zeros_like(jammed)
    for q, touched in enumerate(jammed @ twice):
        constant, slope = pair_tangent(ratios, q, level, touched)
        tangents[q] = slope * jammed[q] - heard[q]
        tangents[q, :3] += constant
    total = multipliers @ tangents
    return float(np.linalg.eigvalsh(matrices(total[:, None])[0])[-1]), float(np.min(tangents @ twice))


@pytest.mark.parametrize("numbers", [(1, 1), (2, 1), (1, 3), (3, 2)])
def test_multipliers_exclude_what_no_axis_reaches(numbers: tuple[int, int]) -> None:
    """At a level that an axis reaches the sum of tangents is not negative, and it is nearly the lowest."""
    rng = np.random.default_rng(sum(numbers))
    for _ in range(6):
        ratios, below = scene(rng, *numbers)
        axes = rng.normal(size=(2000, 3))
        axes /= np.linalg.norm(axes, axis=1, keepdims=True)
        received = np.einsum("ni,gij,nj->gn", axes, below, axes)
        each = 1.0 + (ratios.numerator_isotropic - 1.0)[:, None] / received
        node, eavesdropper = ratios.pairs.T
        reached = float(np.max(np.min(each[node] / each[eavesdropper], axis=0)))
        forms = np.stack([below[:, i, j] for i, j in PLACES], axis=1)
        for level in (max(1.0, reached), 1.5 * max(1.0, reached)):
            bound, primal = bound_of(ratios, level, forms)
            assert bound >= (-1e-9 if level == reached else -np.inf)
            assert bound >= primal - 1e-9
            assert bound == pytest.approx(primal, abs=1e-3 * np.max(forms[node, :3]))


def test_a_tangent_is_never_below_what_it_touches() -> None:
    """The tangent at any e0 bounds the node's denominator wherever the quotient is t or more."""
    rng = np.random.default_rng(3)
    for _ in range(100):
        ratios, _ = scene(rng, 1, 1)
        level, touched, e = 1.0 + 10.0 ** rng.uniform(-6.0, 1.0), *(10.0 ** rng.uniform(0.0, 3.0, 2))
        constant, slope = pair_tangent(ratios, 0, level, touched)
        wanted, overheard = ratios.numerator_isotropic - 1.0
        most = wanted * e / ((level - 1.0) * e + level * overheard)
        assert most <= (constant + slope * e) * (1.0 + 1e-12)
        assert log_quotient(ratios, 0, most, e) == pytest.approx(np.log(level), abs=1e-9)
        assert slope >= 0.0
