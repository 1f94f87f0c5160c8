"""Whitened forms: the same numbers whether a ratio's form is made or its value taken from the geometry."""

import numpy as np
import pytest

from nullpose.objectives import Ratios
from nullpose.solver.kernels.forms import bilinear
from nullpose.solver.kernels.jit import heap_kernel
from nullpose.solver.kernels.node import CENTRE, COLUMNS, HALF, LEVEL
from nullpose.solver.kernels.whitened import axis_of, fill_values, ratio_form, whiten, whiten_axis


@heap_kernel
def both_ways(family, row, denominator, u, by_form, by_geometry):
    """Fills every ratio's form at an axis in both ways; returns the axis' squared length when whitened."""
    basis, mean, back = np.eye(3), np.empty(6), np.empty((3, 3))
    denominators, form, v, again = (
        np.empty((family.denominator_isotropic.shape[0], 6)),
        np.empty(6),
        np.empty(3),
        np.empty(3),
    )
    whiten(family, basis, row, denominator, denominators, mean, back)
    whiten_axis(basis, back, u, v)
    axis_of(basis, back, v, again)
    for k in range(family.numerator_isotropic.shape[0]):
        ratio_form(family, False, basis, row, (denominators, mean, back), k, form)
        by_form[k] = bilinear(form, v, v)
    size = v[0] ** 2 + v[1] ** 2 + v[2] ** 2
    fill_values(family, row[CENTRE:HALF], row[LEVEL], again, size, by_geometry)
    return size


@pytest.mark.parametrize("groups", [1, 3])
@pytest.mark.parametrize("turned", [False, True])
def test_forms_and_geometry_agree(groups: int, turned: bool) -> None:
    """For axes of any length, with one denominator or several, as they are or turned."""
    rng = np.random.default_rng(groups)
    for _ in range(20):
        ratios, each = 4, 2
        points = ratios + groups * each
        turn = np.linalg.qr(rng.normal(size=(points, 3, 3)))[0] if turned else np.zeros((0, 3, 3))
        family = Ratios(
            rng.uniform(0.0, 50.0, (points, 3)),
            rng.uniform(0.0, 1.0, ratios),
            rng.uniform(10.0, 1000.0, ratios),
            np.arange(ratios),
            rng.integers(0, groups, ratios),
            rng.uniform(0.5, 2.0, groups),
            each * np.arange(groups + 1),
            ratios + np.arange(groups * each),
            rng.uniform(10.0, 1000.0, groups * each),
            turn,
        )
        row, u = np.zeros(COLUMNS), rng.normal(size=3)
        row[CENTRE:HALF], row[LEVEL] = rng.uniform(-20.0, 70.0, 3), rng.uniform(0.1, 3.0)
        links = rotated(family, row[CENTRE:HALF])
        denominator = np.zeros(6)
        if groups == 1:
            total = family.denominator_isotropic[0] * np.eye(3) + np.einsum(
                "e,eij->ij", family.denominator_weight, links[family.denominator_point]
            )
            denominator = -row[LEVEL] * total[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        by_form, by_geometry = np.empty(ratios), np.empty(ratios)
        size = both_ways(family, row, denominator, u, by_form, by_geometry)
        np.testing.assert_allclose(by_form, by_geometry, rtol=1e-9, atol=1e-12 * size)


def rotated(family: tuple, position_m: np.ndarray) -> np.ndarray:
    """Returns every point's link form as a matrix, in the axis' own coordinates."""
    r = family.points_m - position_m
    if len(family.turn):
        r = np.einsum("jai,ja->ji", family.turn, r)
    square = np.sum(r**2, axis=1)
    across = square[:, None, None] * np.eye(3) - r[:, :, None] * r[:, None, :]
    return across / square[:, None, None] ** 2
