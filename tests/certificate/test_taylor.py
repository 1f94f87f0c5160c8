"""Taylor numbers: whatever the formula, its ranges and derivatives contain those of the exact numbers."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from tests.certificate.plain import one_box, seeds

from nullpose.certificate.channels import elevation
from nullpose.certificate.interval import Interval
from nullpose.certificate.taylor import (
    Taylor,
    chosen,
    coordinates,
    cross,
    exponential,
    inverse,
    logarithm,
    pairs,
    root,
)

OFFSET = np.array([[7.0], [-3.0], [-40.0]])  # to a place that no box comes near


def squared(x: Any) -> Any:
    """Return the square of a number of either kind."""
    return x.squared() if isinstance(x, Taylor) else x * x


def rooted(x: Any) -> Any:
    """Return the square root of either kind."""
    return x.of(root) if isinstance(x, Taylor) else x.sqrt()


def of(rule: Callable, name: str) -> Callable:
    """Return a function of either kind: by a rule, or by its name."""
    return lambda x: x.of(rule) if isinstance(x, Taylor) else getattr(x, name)()


exp, log, inverted = (
    of(exponential, "exp"),
    of(logarithm, "ln"),
    lambda x: x.of(inverse) if isinstance(x, Taylor) else 1 / x,
)


def distance2(p: Any) -> Any:
    """Return the squared distance from the place."""
    return squared(p[0] - 7) + squared(p[1] + 3) + squared(p[2] + 40)


FORMULAS: dict[str, Callable[[Any], Any]] = {
    "sum": lambda p: p[0] + p[1] * 3 - p[2] + 1,
    "product": lambda p: (p[0] - p[1]) * (p[1] + p[2]) * p[0],
    "of itself": lambda p: squared(p[0] - p[1]) - p[0] * p[0],
    "quotient": lambda p: (p[0] * p[1] - p[2]) / distance2(p),
    "root": lambda p: rooted(distance2(p)) * p[1],
    "exponential": lambda p: exp((p[0] - p[2]) * inverted(rooted(distance2(p)))),
    "logarithm": lambda p: squared(log(distance2(p))) - p[0],
    "link": lambda p: squared(p[0] * 2 - p[2]) * squared(inverted(distance2(p))),
}


def position(centre_m: np.ndarray, half_m: np.ndarray) -> Taylor:
    """Return the coordinates of a box."""
    centre = Interval(centre_m[:, None])
    return coordinates(centre, centre + Interval(-half_m[:, None], half_m[:, None]))


def enclosures(f: Taylor, x: np.ndarray, y: np.ndarray, centre: np.ndarray) -> list[Interval]:
    """Return f at x by its range and by its expansion, and what its slopes say of f at x less f at y."""
    i, j, _ = pairs(3)
    step = x - centre
    taylor = f.at.value[0] + (f.at.slopes[:, 0] * step).total()
    taylor = taylor + (f.over.bends[:, 0] * (step[i] * step[j] * np.where(i == j, 0.5, 1.0))).total()
    return [f.over.value[0], taylor, (f.over.slopes[:, 0] * (x - y)).total()]


@pytest.mark.parametrize("name", FORMULAS)
@given(seed=seeds)
def test_formulas_enclose_their_exact_values(name: str, seed: int) -> None:
    """At random places of a box; a difference of two places is what the slopes allow."""
    rng, formula = np.random.default_rng(seed), FORMULAS[name]
    boxes = one_box(rng)
    centre, half = boxes.centre[0], boxes.half[0]
    f, flat = formula(position(centre, half)), np.zeros(1)
    f = f + f.alike(flat)
    assert np.all(np.isfinite(f.bends.low) & np.isfinite(f.bends.high))
    with localcontext(prec=50):

        def at(place: np.ndarray) -> Decimal:
            return formula([Decimal(float(e)) for e in place])

        def inside(bound: Interval, exact: Decimal) -> bool:
            slack = Decimal("1e-14") * (
                abs(exact) + Decimal(float(f.over.value.magnitude()[0]))
            )  # of the steps
            return Decimal(float(bound.low)) - slack <= exact <= Decimal(float(bound.high)) + slack

        assert Decimal(float(f.at.value.low[0])) <= at(centre) <= Decimal(float(f.at.value.high[0]))
        for _ in range(4):
            x, y = centre + rng.uniform(-1.0, 1.0, (2, 3)) * half
            over, taylor, change = enclosures(f, x, y, centre)
            assert Decimal(float(over.low)) <= at(x) <= Decimal(float(over.high))
            assert inside(taylor, at(x))
            assert inside(change, at(x) - at(y))


@given(seed=seeds)
def test_small_boxes_leave_little_unknown(seed: int) -> None:
    """The derivatives at the centre are those of central differences, and their ranges shrink to them."""
    rng = np.random.default_rng(seed)
    centre = one_box(rng).centre[0]
    p = position(centre, np.full(3, 1e-6))
    f = FORMULAS["link"](p)
    slopes, curve, bends = f.at.slopes, f.at.bends, f.over.bends
    for i, step in enumerate(1e-4 * np.eye(3)):
        ends = (position(place, np.zeros(3)) for place in (centre + step, centre - step))
        above, below = (FORMULAS["link"](end).at for end in ends)
        size = slopes.magnitude().max()
        assert abs((above.value - below.value).middle()[0] / 2e-4 - slopes.middle()[i, 0]) <= 1e-5 * size
        bend = (above.slopes[i] - below.slopes[i]).middle()[0] / 2e-4
        assert abs(bend - curve.middle()[i, 0]) <= 1e-5 * curve.magnitude().max()
    assert np.all((bends.low <= curve.low) & (curve.high <= bends.high))
    assert np.all(bends.high - bends.low <= 1e-4 * bends.magnitude().max())


@given(seed=seeds)
def test_vectors_have_the_formulas_of_their_components(seed: int) -> None:
    """Cross products are across both factors, and a mask chooses box by box."""
    rng = np.random.default_rng(seed)
    boxes = one_box(rng)
    p = position(boxes.centre[0], boxes.half[0])
    q = p - OFFSET
    product = (cross(p, q) * q).total()
    for part in (*product.at, *product.over):
        assert np.all(part.low <= 0.0)
        assert np.all(part.high >= 0.0)
    either = chosen(np.array([rng.random() < 0.5]), p[0], p[0].alike(np.array([2.0])))
    assert either.at.value.low[0] in (p.at.value.low[0, 0], 2.0)


@given(seed=seeds)
def test_elevations_enclose_the_angle(seed: int) -> None:
    """Of any place of a box as seen from the origin; also over it, where no slope is known."""
    rng = np.random.default_rng(seed)
    boxes = one_box(rng)
    centre, half = boxes.centre[0], boxes.half[0]
    if rng.random() < 0.3:
        centre = np.append(half[:2] * rng.uniform(-1.0, 1.0, 2), centre[2])
    with np.errstate(all="ignore"):
        angle, tangent = elevation(position(centre, half))
    for _ in range(8):
        x, y = centre + rng.uniform(-1.0, 1.0, (2, 3)) * half
        there, other = (np.arctan2(e[2], np.hypot(e[0], e[1])) for e in (x, y))
        with np.errstate(invalid="ignore"):
            over, taylor, change = enclosures(angle, x, y, centre)
        assert over.low - 1e-14 <= there <= over.high + 1e-14
        assert tangent.low[0] * (1.0 - 1e-14) <= np.tan(there) * (1.0 + 1e-12)
        for bound, exact in ((taylor, there), (change, there - other)):
            assert not exact < bound.low - 1e-13
            assert not exact > bound.high + 1e-13
