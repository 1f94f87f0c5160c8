"""Real roots on [-1, 1], against NumPy's companion matrices and polynomials of known roots."""

import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.polynomial import Polynomial
from tests.reference.plain_kernels import plain

from nullpose.solver.kernels.linear_algebra import polynomial

SEEDS = st.integers(0, 2**32 - 1)
EDGE = 1.0 + 1e-9

real_roots = plain(polynomial.real_roots)


def roots_of(coefficients: np.ndarray, degree: int | None = None) -> np.ndarray:
    """Returns the kernel's roots; coefficients run from the constant up."""
    found = np.empty(12)
    nominal = np.int64(len(coefficients) - 1 if degree is None else degree)
    count = real_roots(np.asarray(coefficients, dtype=float), nominal, found)
    return found[:count].copy()


@given(seed=SEEDS, degree=st.integers(1, 8))
def test_roots_are_those_of_the_companion_matrix(seed: int, degree: int) -> None:
    """On random coefficients the roots are NumPy's real ones in [-1, 1], each once and ascending."""
    coefficients = np.random.default_rng(seed).normal(size=degree + 1)
    all_roots = Polynomial(coefficients).roots()
    # a pair this close to the real line, or a root this close to an edge, could go either way
    near_real = np.abs(all_roots.imag) < 1e-6
    undecided = near_real & ((np.abs(all_roots.imag) > 1e-12) | (np.abs(np.abs(all_roots.real) - 1.0) < 1e-7))
    if not np.any(undecided):
        expected = np.sort(all_roots.real[near_real & (np.abs(all_roots.real) < 1.0)])
        np.testing.assert_allclose(roots_of(coefficients), expected, atol=1e-9)


@pytest.mark.parametrize("edge", [-1.0, 1.0])
def test_roots_on_the_edge(edge: float) -> None:
    """A root on an edge is kept, a hair beyond too, and one further out is not."""
    for root, kept in [
        (edge, True),
        (edge * (1.0 + 1e-12), True),
        (edge * (1.0 - 1e-12), True),
        (1.001 * edge, False),
    ]:
        found = roots_of(np.array([-root, 1.0]))
        assert len(found) == kept
        if kept:
            assert found[0] == pytest.approx(root, abs=1e-15)


@pytest.mark.parametrize("degree", range(9))
def test_the_zero_polynomial(degree: int) -> None:
    """The polynomial that is zero everywhere ends, with few roots, all of them in the range."""
    found = roots_of(np.zeros(9), degree)
    assert len(found) <= 10
    assert np.all(np.abs(found) <= EDGE)
