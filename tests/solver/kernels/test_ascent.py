"""Newton's method for multipliers: what it returns is the dual's optimum, and an axis that reaches it."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from tests.reference.plain_kernels import plain

from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.bounds.ascent import POOL, Pool, ascend
from nullpose.solver.kernels.bounds.node import CENTRE, COLUMNS, FACE, HALF, LEVEL, keep_largest
from nullpose.solver.kernels.linear_algebra import dual, forms as kernels_of_forms, symmetric

TOLERANCE = 1e-6

congruence, dual_multipliers, fill_forms, inverse_factor, top_eigenvector = map(
    plain,
    (
        kernels_of_forms.congruence,
        dual.dual_multipliers,
        kernels_of_forms.fill_forms,
        kernels_of_forms.inverse_factor,
        symmetric.top_eigenvector,
    ),
)


def ascended(family, row, mean, back, weights, v):
    """Returns what the kernel does for a free axis in the world's frame."""
    whitening, every = (mean.reshape((1, 6)), mean, back), np.empty(family.numerator_isotropic.shape[0])
    pool = Pool(
        np.empty((POOL, 6)), np.empty(POOL, np.int64), np.empty(POOL), np.empty(POOL), np.empty((POOL, 2)),
        np.empty(3), np.empty(3, np.int64),
    )  # fmt: skip
    top, followed, _ = plain(ascend)(
        family, False, np.eye(3), row, whitening, pool, 0, TOLERANCE, every, weights, v
    )
    return top, followed


def whitened(family: Family, position_m: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns every ratio's whitened form at a position, and what whitens."""
    ratios = len(family.ratios.numerator_point)
    numerators, denominators = np.empty((ratios, 6)), np.empty((1, 6))
    fill_forms(family.ratios, position_m, numerators, denominators)
    back, forms = np.empty((3, 3)), np.empty((ratios, 6))
    inverse_factor(denominators[0], back)
    for k in range(ratios):
        congruence(numerators[k], back, forms[k])
    return forms, denominators[0], back


def value(form: np.ndarray, v: np.ndarray) -> float:
    """Returns a form at a vector."""
    xx, yy, zz, xy, xz, yz = form
    return float(v @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ v)


@pytest.mark.parametrize("start", ["equal", "none"])
def test_it_agrees_with_the_interior_point(start: str, random_scene: Callable) -> None:
    """Where it converges, from equal multipliers or from none: same value, reached by the axis."""
    rng = np.random.default_rng(5)
    converged = 0
    for number in range(120):
        scene = random_scene(rng, 2 + number % 7, 1 + number % 3, 10.0 ** rng.uniform(-2.0, 2.0))
        family = build_family(scene)
        ratios = len(family.ratios.numerator_point)
        position_m = np.array([*rng.uniform(0.0, 100.0, 2), rng.uniform(8.0, 30.0)])
        forms, mean, back = whitened(family, position_m)
        level = float(np.max(forms[:, :3]))
        row = np.zeros(COLUMNS)
        if start == "equal":
            keep_largest(np.full(ratios, 1.0 / ratios), ratios, row, False)
        row[CENTRE:HALF], row[LEVEL], row[FACE] = position_m, level, -1.0
        weights, v = np.empty(ratios + 4), np.empty(3)
        found, followed = ascended(family.ratios, row, mean, back, weights, v)
        best, matrix = np.empty(ratios), np.empty(6)
        third = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0]) / 3.0
        wanted = dual_multipliers(
            forms, 0, ratios, level, math.inf, 1e-9, third, best, matrix, np.empty(0), 0.0
        )
        if math.isfinite(found):  # multipliers, good or not, bound the dual from above
            mix, top_axis = weights[:ratios] @ forms, np.empty(3)
            assert math.isclose(weights[:ratios].sum(), 1.0, rel_tol=1e-9)
            assert np.all(weights[:ratios] >= 0.0)
            assert math.isclose(top_eigenvector(mix, top_axis), found, rel_tol=1e-9)
            assert found >= wanted - 1e-7 * level
        if followed:
            converged += 1
            assert abs(found - wanted) <= 2.0 * TOLERANCE * level
            assert min(value(form, v) for form in forms) >= found - 1.01 * TOLERANCE * level
    assert converged >= 60


def test_where_there_is_a_duality_gap_it_says_so(scene: Callable) -> None:
    """Four nodes around the position, in directions that no axis is across of: no axis reaches the dual."""
    places = [[10.0, 0.0, 0.0], [-5.0, 9.0, 0.0], [-5.0, -9.0, 0.0], [0.0, 0.0, -10.0]]
    family = build_family(scene(places, altitude_m=(0.5, 30.0)))
    position_m = np.array([0.0, 0.0, 0.0])
    forms, mean, back = whitened(family, position_m)
    row = np.zeros(COLUMNS)
    keep_largest(np.full(4, 0.25), 4, row, False)
    row[CENTRE:HALF], row[LEVEL], row[FACE] = position_m, float(np.min(forms[:, :3].sum(axis=1))) / 3.0, -1.0
    weights, v = np.empty(8), np.empty(3)
    found, followed = ascended(family.ratios, row, mean, back, weights, v)
    assert not followed
    assert found == math.inf
