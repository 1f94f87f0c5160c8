"""Ratios at a pose and their derivatives, against dense matrices and exact arithmetic."""

import math
from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st
from sizes import few_examples
from tests.reference.plain_kernels import plain

from nullpose.certificate.pose_value import exact, link
from nullpose.problem.build import build_family
from nullpose.problem.family import Family
from nullpose.solver.kernels.linear_algebra import links
from nullpose.solver.kernels.linear_algebra.links import log_objective

derivatives, log_ratios = plain(links.derivatives), plain(links.log_ratios)
SEEDS = st.integers(0, 2**32 - 1)


def log_values(family: Family, p: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Returns the kernel's log ratios at a pose."""
    out = np.empty(len(family.ratios.numerator_point))
    log_ratios(family.ratios, p, u, np.empty(len(family.ratios.denominator_isotropic)), out)
    return out


def kernel_derivatives(
    family: Family, p: np.ndarray, u: np.ndarray, multipliers: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Returns the kernel's log ratios, their gradients and their weighted Hessian at a pose."""
    ratios = len(family.ratios.numerator_point)
    f, grads, hess = np.empty(ratios), np.empty((ratios, 6)), np.empty((6, 6))
    work = np.empty((len(family.ratios.denominator_isotropic), 50))
    derivatives(family.ratios, p, u, multipliers, f, grads, hess, work)
    return f, grads, hess


def exact_forms(family: Family, pose: list[Fraction]) -> tuple[list[Fraction], list[Fraction]]:
    """Returns every ratio's numerator and denominator at a pose (p, u), in exact rational arithmetic."""
    ratios = family.ratios
    p, u = np.array(pose[:3]), np.array(pose[3:])
    links = np.array([link(point, p, u, Fraction(ratios.leak)) for point in exact(ratios.points_m)])
    above = exact(ratios.numerator_isotropic) + exact(ratios.numerator_weight) * links[ratios.numerator_point]
    entries = exact(ratios.denominator_weight) * links[ratios.denominator_point]
    sums = [sum(entries[a:b], Fraction(0)) for a, b in pairwise(ratios.denominator_start)]
    below = exact(ratios.denominator_isotropic) + np.array(sums)
    return list(above * (u @ u)), list(below[ratios.denominator_of] * (u @ u))


def exact_derivatives(
    family: Family, p: np.ndarray, u: np.ndarray, multipliers: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Returns gradients (R, 6) and weighted Hessian (6, 6) of the log ratios by exact central differences.

    In rational arithmetic nothing is rounded, so the step can be as small as one likes: at 1e-25 its square,
    the relative error of the differences, is far below a double's last digit.
    """
    step = Fraction(1, 10**25)
    pose = [Fraction(float(x)) for x in (*p, *u)]

    def forms(*moves: tuple[int, int]) -> list[Fraction]:
        moved = list(pose)
        for index, sign in moves:
            moved[index] += sign * step
        numerators, denominators = exact_forms(family, moved)
        return numerators + denominators

    ratios = len(family.ratios.numerator_point)
    middle = forms()
    up, down = ([forms((i, sign)) for i in range(6)] for sign in (1, -1))
    first = [[(up[i][k] - down[i][k]) / (2 * step) for i in range(6)] for k in range(2 * ratios)]
    logs = [[slope / middle[k] for slope in first[k]] for k in range(2 * ratios)]
    grads = [[logs[k][i] - logs[ratios + k][i] for i in range(6)] for k in range(ratios)]
    hess = np.zeros((6, 6))
    weights = [Fraction(float(z)) for z in multipliers]
    for i in range(6):
        for j in range(i + 1):
            if i == j:
                second = [(a - 2 * b + c) / step**2 for a, b, c in zip(up[i], middle, down[i], strict=True)]
            else:
                both, neither = forms((i, 1), (j, 1)), forms((i, -1), (j, -1))
                mixed = forms((i, 1), (j, -1)), forms((i, -1), (j, 1))
                second = [
                    (a + b - c - d) / (4 * step**2) for a, b, c, d in zip(both, neither, *mixed, strict=True)
                ]
            curved = [second[k] / middle[k] - logs[k][i] * logs[k][j] for k in range(2 * ratios)]
            total = sum(weights[k] * (curved[k] - curved[ratios + k]) for k in range(ratios))
            hess[i, j] = hess[j, i] = float(total)
    return np.array([[float(x) for x in row] for row in grads]), hess


def some_pose(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Returns a position above the field and an axis of any length."""
    return rng.uniform([0.0, 0.0, 8.0], [100.0, 100.0, 30.0]), rng.normal(size=3)


@given(seed=SEEDS, ratios=st.integers(1, 5), groups=st.integers(1, 3))
def test_log_ratios_by_dense_matrices(
    seed: int, ratios: int, groups: int, random_family: Callable, dense_forms: Callable
) -> None:
    """The log ratios are those of u^T N u over u^T D u, and the objective is the smallest."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, ratios, groups)
    p, u = some_pose(rng)
    numerators, denominators = dense_forms(family, p)
    expected = np.log(
        np.einsum("i,kij,j->k", u, numerators, u)
        / np.einsum("i,kij,j->k", u, denominators[family.ratios.denominator_of], u)
    )
    np.testing.assert_allclose(log_values(family, p, u), expected, atol=1e-11)
    logs, out = np.empty(groups), np.empty(ratios)
    assert log_objective(family.ratios, p, u, logs, out) == np.min(log_values(family, p, u))


@pytest.mark.parametrize("offset", [1e-2, 1e-5, 1e-8])
def test_log_ratios_beside_the_null(offset: float, paper: Callable) -> None:
    """Beside the jammer's null, under a million times the power, the log ratios keep their digits."""
    family = build_family(paper(1e6))
    rng = np.random.default_rng(3)
    for _ in range(20):
        p, _ = some_pose(rng)
        u = family.ratios.points_m[2] - p
        u += offset * np.linalg.norm(u) * rng.normal(size=3)
        numerators, denominators = exact_forms(family, [Fraction(float(x)) for x in (*p, *u)])
        expected = [math.log(n / d) for n, d in zip(numerators, denominators, strict=True)]
        np.testing.assert_allclose(log_values(family, p, u), expected, atol=1e-13)


@few_examples(8)
@given(seed=SEEDS, ratios=st.integers(1, 3), groups=st.integers(1, 2))
def test_derivatives_are_exact(seed: int, ratios: int, groups: int, random_family: Callable) -> None:
    """Gradients and weighted Hessian agree with exact differences to rounding, several denominators too."""
    rng = np.random.default_rng(seed)
    family = random_family(rng, ratios, groups)
    p, u = some_pose(rng)
    multipliers = rng.uniform(0.1, 1.0, ratios)
    f, grads, hess = kernel_derivatives(family, p, u, multipliers)
    np.testing.assert_allclose(f, log_values(family, p, u), atol=1e-14)
    exact_grads, exact_hess = exact_derivatives(family, p, u, multipliers)
    np.testing.assert_allclose(grads, exact_grads, rtol=1e-10, atol=1e-12 * np.abs(exact_grads).max())
    np.testing.assert_allclose(hess, exact_hess, rtol=1e-9, atol=1e-12 * np.abs(exact_hess).max())


@pytest.mark.parametrize("ratio", [1.0, 1e3, 1e6])
@pytest.mark.parametrize("offset", [1e-3, 1e-6])
def test_derivatives_beside_the_null(ratio: float, offset: float, paper: Callable) -> None:
    """Beside the null the derivatives stay exact to rounding, seen against their own huge size."""
    family = build_family(paper(ratio))
    p = np.array([-2.24, 23.82, 8.0])
    u = family.ratios.points_m[2] - p
    u /= np.linalg.norm(u)
    u += offset * np.array([0.3, -0.8, 0.5])
    multipliers = np.array([0.6, 0.4])
    _, grads, hess = kernel_derivatives(family, p, u, multipliers)
    exact_grads, exact_hess = exact_derivatives(family, p, u, multipliers)
    np.testing.assert_allclose(grads, exact_grads, atol=1e-13 * np.abs(exact_grads).max() + 1e-12)
    np.testing.assert_allclose(hess, exact_hess, atol=1e-13 * np.abs(exact_hess).max() + 1e-12)
