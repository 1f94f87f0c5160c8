"""Small dense symmetric matrices, against LAPACK."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from tests.reference.plain_kernels import plain

from nullpose.solver.kernels.linear_algebra import symmetric

SEEDS = st.integers(0, 2**32 - 1)

cholesky_factor, cholesky_solve, eigen3, gauss_solve = map(
    plain, (symmetric.cholesky_factor, symmetric.cholesky_solve, symmetric.eigen3, symmetric.gauss_solve)
)


def eigen(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Returns the kernel's eigenvalues and eigenvectors of a 3x3 matrix, and checks that it is left alone."""
    values, vectors, before = np.empty(3), np.empty((3, 3)), matrix.copy()
    eigen3(matrix, values, vectors)
    np.testing.assert_array_equal(matrix, before)
    return values, vectors


def check_eigen(matrix: np.ndarray) -> None:
    """Checks values against LAPACK, order, orthonormality and residual, all to the matrix's own size."""
    values, vectors = eigen(matrix)
    size = np.abs(matrix).max()
    assert all(a >= b for a, b in pairwise(values))
    np.testing.assert_allclose(values, np.linalg.eigvalsh(matrix)[::-1], atol=2e-15 * size)
    np.testing.assert_allclose(vectors.T @ vectors, np.eye(3), atol=3e-15)
    np.testing.assert_allclose(matrix @ vectors, vectors * values, atol=4e-15 * size)


@given(seed=SEEDS, exponent=st.integers(-100, 100))
def test_eigenvalues_of_any_matrix(seed: int, exponent: int) -> None:
    """Random symmetric matrices of any size agree with LAPACK."""
    matrix = np.random.default_rng(seed).normal(size=(3, 3))
    check_eigen((matrix + matrix.T) * 2.0**exponent)


@pytest.mark.parametrize("power", [1e3, 1e6, 1e9])
def test_small_eigenvalue_of_a_strong_denominator(power: float) -> None:
    """Of I + b (I - d d^T) the small eigenvalue, 1, keeps what b leaves of a double's digits."""
    direction = np.array([2.0, -3.0, 6.0]) / 7.0
    values, vectors = eigen(np.eye(3) + power * (np.eye(3) - np.outer(direction, direction)))
    assert values[2] == pytest.approx(1.0, abs=1e-15 * power)
    np.testing.assert_allclose(values[:2], 1.0 + power, rtol=1e-15)
    np.testing.assert_allclose(np.abs(vectors[:, 2] @ direction), 1.0, atol=1e-15)


@given(seed=SEEDS, size=st.integers(1, 6))
def test_cholesky_against_numpy(seed: int, size: int) -> None:
    """The factor is LAPACK's, and the solution solves the system, inside larger scratch arrays."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(size, size + 2))
    matrix = root @ root.T + 1e-3 * np.eye(size)
    right = rng.normal(size=size)
    scratch, solution = rng.normal(size=(8, 8)), rng.normal(size=8)
    scratch[:size, :size], solution[:size] = matrix, right
    rest = solution[size:].copy()
    assert cholesky_factor(scratch, size)
    np.testing.assert_allclose(
        np.tril(scratch[:size, :size]), np.linalg.cholesky(matrix), rtol=1e-9, atol=1e-11
    )
    cholesky_solve(scratch, size, solution)
    np.testing.assert_allclose(matrix @ solution[:size], right, atol=1e-10)
    np.testing.assert_array_equal(solution[size:], rest)


@given(seed=SEEDS, size=st.integers(1, 12))
def test_gauss_against_numpy(seed: int, size: int) -> None:
    """Any regular system, zeros on the diagonal included, is solved as LAPACK does."""
    rng = np.random.default_rng(seed)
    matrix, right = rng.normal(size=(size, size)), rng.normal(size=size)
    if size > 1:
        matrix[0, 0] = 0.0
    scratch, solution = np.zeros((12, 12)), np.zeros(12)
    scratch[:size, :size], solution[:size] = matrix, right
    assert gauss_solve(scratch, solution, size)
    expected = np.linalg.solve(matrix, right)
    np.testing.assert_allclose(
        solution[:size], expected, rtol=1e-13 * np.linalg.cond(matrix), atol=1e-13 * np.abs(expected).max()
    )


@pytest.mark.parametrize("size", [1, 2, 5])
def test_gauss_of_a_singular_system(size: int) -> None:
    """A singular system is refused: zero, of rank one less, or with a number that is not finite."""
    deficient = np.random.default_rng(3).normal(size=(size, size))
    deficient[-1] = deficient[:-1].sum(axis=0)
    broken = np.eye(size)
    broken[0, 0] = np.nan
    for matrix in (np.zeros((size, size)), deficient, broken):
        assert not gauss_solve(matrix.copy(), np.ones(size), size)
