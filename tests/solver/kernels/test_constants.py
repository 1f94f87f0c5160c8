"""The lemmas' numbers, derived again: the solver's copies and the verifier's."""

import math

import numpy as np
import pytest

from nullpose.certificate import lemmas
from nullpose.solver.kernels.bounds import constants

ANGLES = np.linspace(0.0, math.pi, 20_001)
K, M = np.cos(ANGLES), np.sin(ANGLES)  # of the angle between the line and the way to the point


def extremes(matrices: np.ndarray) -> tuple[float, float]:
    """Return the least and the largest eigenvalue of many symmetric matrices."""
    values = np.linalg.eigvalsh(matrices)
    return float(values.min()), float(values.max())


def blocks(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """Return matrices ((a, b), (b, c))."""
    return np.stack([np.stack([a, b], axis=-1), np.stack([b, c], axis=-1)], axis=-2)


# lemma 1: the second derivative of a link form has this block, and 8 k^2 - 2 across it
LEAST, MOST = extremes(blocks(2.0 * M**2, 6.0 * K * M, 6.0 - 10.0 * M**2))
# lemma 2: the length of the two parts of R'' that are across each other, over rho^2
TURN = float(np.max(M * np.sqrt(4.0 - 3.0 * M**2)))
# lemma 5: derivatives of a link vector
FIRST = extremes(-blocks(K, M, 0.0 * K))
SECOND = extremes(blocks(2.0 * K**2 - 3.0 * M**2, 4.0 * K * M, 2.0 * M**2))
THIRD = extremes(blocks(27.0 * K * M**2 - 6.0 * K**3, 9.0 * M**3 - 18.0 * K**2 * M, -18.0 * K * M**2))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("CONSTANT_FORM_BEND", float(np.max(np.abs(np.sin(2.0 * ANGLES)) + 2.0 * M**2))),
        ("DIRECTION_BEND", TURN),
        # the verifier's, which puts them together where it uses them
        ("CONSTANT_SWING", float(np.max(np.abs(np.sin(2.0 * ANGLES)) + 2.0 * M**2))),
        ("SPREAD_OVER_NORM", math.sqrt(2.0)),  # of diag(1, -1, 0), which has the largest
        ("DIRECTION_THIRD", float(np.max(6.0 * K**2 * M))),
        ("VECTOR_SLOPE", max(map(abs, FIRST))),
        ("VECTOR_BEND", max(map(abs, SECOND))),
        ("VECTOR_THIRD", max(map(abs, THIRD))),
        ("VECTOR_SQUARE_BEND", 2.0 * (max(map(abs, FIRST)) ** 2 + max(map(abs, SECOND)))),
    ],
)
def test_a_number_of_a_lemma_is_what_it_bounds_rounded_up(name: str, value: float) -> None:
    """No bound is too small, and none is needlessly large."""
    numbers = [vars(module)[name] for module in (constants, lemmas) if name in vars(module)]
    assert numbers
    for number in numbers:
        assert value * (1.0 - 1e-9) <= number <= value * 1.001
