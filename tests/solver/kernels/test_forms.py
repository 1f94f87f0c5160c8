"""Symmetric forms kept as six numbers, against dense matrices."""

from collections.abc import Callable

import numpy as np
from hypothesis import given, strategies as st

from nullpose.solver.kernels.forms import bilinear, congruence, fill_forms, form_value, inverse_factor

SEEDS = st.integers(0, 2**32 - 1)


def six(matrix: np.ndarray) -> np.ndarray:
    """Returns (xx, yy, zz, xy, xz, yz) of a symmetric matrix."""
    return np.array([matrix[0, 0], matrix[1, 1], matrix[2, 2], matrix[0, 1], matrix[0, 2], matrix[1, 2]])


def symmetric(rng: np.random.Generator) -> np.ndarray:
    """Returns a random symmetric matrix."""
    matrix = rng.normal(size=(3, 3))
    return matrix + matrix.T


@given(seed=SEEDS)
def test_products_by_dense_matrices(seed: int) -> None:
    """Quadratic and bilinear forms and congruences are those of the matrix."""
    rng = np.random.default_rng(seed)
    matrix, basis = symmetric(rng), rng.normal(size=(3, 3))
    x, y = rng.normal(size=(2, 3))
    np.testing.assert_allclose(form_value(six(matrix)[None], 0, x), x @ matrix @ x, atol=1e-13)
    np.testing.assert_allclose(bilinear(six(matrix), x, y), x @ matrix @ y, atol=1e-13)
    out = np.empty(6)
    congruence(six(matrix), basis, out)
    np.testing.assert_allclose(out, six(basis.T @ matrix @ basis), atol=1e-12)


@given(seed=SEEDS)
def test_the_inverse_factor_makes_a_form_the_identity(seed: int) -> None:
    """The factor C of a positive definite form has C^T A C = I."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(3, 3))
    matrix = root @ root.T + 0.1 * np.eye(3)
    factor, out = np.empty((3, 3)), np.empty(6)
    inverse_factor(six(matrix), factor)
    np.testing.assert_allclose(factor.T @ matrix @ factor, np.eye(3), atol=1e-11)
    congruence(six(matrix), factor, out)
    np.testing.assert_allclose(out, [1.0, 1.0, 1.0, 0.0, 0.0, 0.0], atol=1e-11)


@given(seed=SEEDS, ratios=st.integers(1, 5), groups=st.integers(1, 3))
def test_the_forms_of_a_family(
    seed: int, ratios: int, groups: int, random_family: Callable, dense_forms: Callable
) -> None:
    """The forms of a family at a position are its dense matrices, whatever the outputs held before."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, ratios, groups)
    p = rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0])
    numerators, denominators = np.full((ratios, 6), 9.0), np.full((groups, 6), 9.0)
    fill_forms(family.arrays, p, numerators, denominators)
    dense_tops, dense_bottoms = dense_forms(family, p)
    np.testing.assert_allclose(numerators, [six(matrix) for matrix in dense_tops], rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(
        denominators, [six(matrix) for matrix in dense_bottoms], rtol=1e-11, atol=1e-11
    )
