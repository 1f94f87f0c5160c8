"""The lemmas' numbers, each derived again: as a maximum, or by derivatives along random lines."""

import math
from collections.abc import Callable

import numpy as np
from scipy.optimize import minimize, minimize_scalar

from nullpose.certificate import lemmas

STEP = 1e-3


def unit(vector: np.ndarray) -> np.ndarray:
    """Return the vector at length 1."""
    return vector / np.linalg.norm(vector)


def highest(function: Callable[[float], float]) -> float:
    """Return the largest value of a function of an angle."""
    starts = np.linspace(0.0, math.pi, 60)
    return max(
        -minimize_scalar(lambda x: -function(x), bounds=(x - 0.1, x + 0.1), method="bounded").fun
        for x in starts
    )


def second(function: Callable[[float], np.ndarray]) -> np.ndarray:
    """Return a second derivative at zero, by differences of the fourth order."""
    values = {n: np.asarray(function(n * STEP)) for n in (-2, -1, 0, 1, 2)}
    return (16.0 * (values[1] + values[-1]) - values[2] - values[-2] - 30.0 * values[0]) / (12.0 * STEP**2)


def frame(ahead: np.ndarray, anchor_m: np.ndarray) -> Callable[[float], np.ndarray]:
    """Return the rotation that keeps the third axis on the anchor along a line, in the plane of both."""
    direction = unit(anchor_m)
    across = unit(ahead - (ahead @ direction) * direction)

    def rotation(t: float) -> np.ndarray:
        now = unit(anchor_m - t * ahead)
        angle = math.atan2(float(now @ across), float(now @ direction))
        turn = np.outer(across, direction) - np.outer(direction, across)
        return np.eye(3) + math.sin(angle) * turn + (1.0 - math.cos(angle)) * (turn @ turn)

    return rotation


def test_the_bend_of_a_direction() -> None:
    """With ``phi' = sin a`` and ``phi'' = 2 sin a cos a`` it is the largest ``|phi'' - i phi'^2|``."""
    bend = highest(lambda a: math.hypot(2.0 * math.sin(a) * math.cos(a), math.sin(a) ** 2))
    assert bend <= lemmas.DIRECTION_BEND <= bend * (1.0 + 1e-9)
    assert lemmas.AREA_BEND == 2.0 * lemmas.DIRECTION_BEND
    assert 2.0 + bend <= lemmas.NULL_SWERVE
    third = highest(lambda a: 6.0 * math.cos(a) ** 2 * math.sin(a))
    assert third <= lemmas.DIRECTION_THIRD <= third * 1.001


def test_derivatives_of_a_link_vector() -> None:
    """The largest along a line of the first three of ``v/|r| - (v.r) r/|r|^3``, at ``|r| = 1``."""

    def size(parameters: np.ndarray, n: int) -> float:
        r, v = np.array([1.0, 0.0, 0.0]), unit(parameters[1:])
        ahead = np.array([math.cos(parameters[0]), math.sin(parameters[0]), 0.0])
        gained = np.array([0.0, 2.0 * float(r @ ahead), 1.0])  # |r + t ahead|^2 = 1 + this, in powers of t
        powers = []
        for exponent in (-0.5, -1.5):
            series, term = np.array([1.0, 0.0, 0.0, 0.0]), np.array([1.0])
            for k in range(3):
                term = np.convolve(term, gained)[:4] * (exponent - k) / (k + 1)
                series[: len(term)] += term
            powers.append(series)
        product = np.convolve([v @ r, v @ ahead], powers[1])
        vector = np.outer(v, powers[0])[:, n] - r * product[n] - ahead * product[n - 1]
        return math.factorial(n) * float(np.linalg.norm(vector))

    for n, bound in enumerate((lemmas.VECTOR_SLOPE, lemmas.VECTOR_BEND, lemmas.VECTOR_THIRD), start=1):
        starts = np.random.default_rng(n).normal(size=(8, 4))
        found = [minimize(lambda x, n=n: -size(x, n), x0, method="Nelder-Mead").fun for x0 in starts]
        assert 0.998 * bound <= -min(found) <= bound


def test_forms_in_a_turning_frame() -> None:
    """A constant form, a link's form and its vector bend by no more than is stated, whatever the line."""
    rng = np.random.default_rng(5)
    for _ in range(150):
        ahead, anchor_m, offset_m = unit(rng.normal(size=3)), *(4.0 * rng.normal(size=(2, 3)))
        rho, a = np.linalg.norm(anchor_m), np.linalg.norm(offset_m)
        if min(a, rho) < 0.5:
            continue
        rotation = frame(ahead, anchor_m)

        def seen(t: float, *, rotation=rotation, offset_m=offset_m, ahead=ahead) -> np.ndarray:
            return rotation(t).T @ (offset_m - t * ahead)

        def form(t: float, *, seen=seen) -> np.ndarray:
            b = seen(t)
            return (b @ b * np.eye(3) - np.outer(b, b)) / (b @ b) ** 2

        bends = np.linalg.eigvalsh(second(form))
        mixed, swing = 1.0 / (a**3 * rho), 1.0 / (a**2 * rho**2)
        assert bends[-1] <= 6.0 / a**4 + 16.0 * mixed + (6.0 + lemmas.AREA_BEND) * swing + 1e-6
        assert bends[0] >= -(4.0 / a**4 + 12.0 * mixed + (4.0 + lemmas.AREA_BEND) * swing) - 1e-6
        vector = second(lambda t, seen=seen: seen(t) / (seen(t) @ seen(t)))
        most = 2.0 / a**3 + 6.0 / (a**2 * rho) + lemmas.NULL_SWERVE / (a * rho**2)
        assert np.linalg.norm(vector) <= most + 1e-6
        q = np.diag(rng.uniform(0.0, 1.0, 3))
        spread = np.ptp(np.diag(q))
        basis = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        q = basis @ q @ basis.T
        turned = second(lambda t, q=q, rotation=rotation: rotation(t).T @ q @ rotation(t))
        assert np.linalg.norm(turned, 2) <= lemmas.FORM_SWING * spread / rho**2 + 1e-6


def test_the_spread_of_eigenvalues() -> None:
    """It is at most the root of two times the Frobenius norm, which ``diag(1, -1, 0)`` reaches."""
    forms = np.random.default_rng(2).normal(size=(500, 3, 3))
    forms = np.concatenate([forms + forms.swapaxes(1, 2), [np.diag([1.0, -1.0, 0.0])]])
    ratio = np.ptp(np.linalg.eigvalsh(forms), axis=1) / np.linalg.norm(forms, axis=(1, 2))
    assert 0.999999 * lemmas.SPREAD_OVER_NORM <= ratio.max() <= lemmas.SPREAD_OVER_NORM
