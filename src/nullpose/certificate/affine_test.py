"""Leaves of an axis that the position gives: a weighted sum that stays negative all over the box.

Each link is ``f = |u x r|^2 / (|u|^2 |r|^4)`` with ``u = o + M p`` and ``r = q - p``, a quotient of
polynomials. Value and gradient are taken at the centre, the Hessian over the whole box, all in interval
arithmetic; the maximum of the quadratic is bounded by its dual (see "The certificate explained").
"""

from __future__ import annotations

import numpy as np

from nullpose.certificate.allowed import Weighted, negative_where_allowed
from nullpose.certificate.boxes import Boxes, group_shares, mix_slots
from nullpose.certificate.certificate import FloatArray, IntArray, Leaves
from nullpose.certificate.interval import Interval, dot, stack
from nullpose.family import AxisField, Family

__all__ = ["affine_holds", "link_jet"]

_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
_SHARES = (1.0, 0.5, 0.25, 0.1, 0.03, 0.01)

Jet = tuple[Interval, list[Interval], list[Interval], Interval]


def link_jet(field: AxisField, boxes: Boxes, points: FloatArray) -> Jet:
    """Return a link's value and gradient at the centres, its Hessian and its value over the boxes.

    Args:
        field: the axis field.
        boxes: b of them.
        points: (b, 3) the ground point of each.
    """
    at = _pieces(field, Interval(boxes.centre), points)
    over = _spread(field, at, boxes, points)
    value, slopes = _value(at), _slopes(at)
    hessian = _hessian(over)
    weakest, isotropic = _value(over), 1.0 / over["s"]
    # sin^2 <= 1, and never below zero
    ranged = Interval(np.maximum(weakest.low, 0.0), np.fmin(weakest.high, isotropic.high))
    return value, slopes, hessian, ranged


def _pieces(field: AxisField, p: Interval, points: FloatArray) -> dict[str, Interval]:
    """Return u x r, |u|^2 and |r|^2 with their derivatives, at or over p."""
    u = stack([dot(Interval(field.matrix[m]), p) + field.offset[m] for m in range(3)])
    r = Interval(points) - p
    entries, slopes, bends = [], [], []
    for m in range(3):
        a, b = (m + 1) % 3, (m + 2) % 3
        entries.append(u[:, a] * r[:, b] - u[:, b] * r[:, a])
        slope, bend = [], np.zeros((3, 3))
        for i in range(3):
            x = r[:, b] * field.matrix[a, i] - r[:, a] * field.matrix[b, i]
            x = x - u[:, a] if i == b else (x + u[:, b] if i == a else x)
            slope.append(x)
            bend[i, b] -= field.matrix[a, i]
            bend[b, i] -= field.matrix[a, i]
            bend[i, a] += field.matrix[b, i]
            bend[a, i] += field.matrix[b, i]
        slopes.append(stack(slope))
        bends.append(bend)
    gram = [dot(Interval(field.matrix[:, i]), field.matrix[:, k]) * 2.0 for i, k in _PAIRS]
    return {
        "c": stack(entries),
        "dc": stack(slopes),  # (b, derivative, entry)
        "bend": Interval(np.stack(bends)),
        "n": stack(entries).squared().total(),
        "b": u.squared().total(),
        "s": r.squared().total(),
        "db": stack([dot(Interval(field.matrix[:, i]), u) * 2.0 for i in range(3)]),
        "ds": r * -2.0,
        "gram": stack(gram),
    }


def _spread(
    field: AxisField, at: dict[str, Interval], boxes: Boxes, points: FloatArray
) -> dict[str, Interval]:
    """Return the pieces over the boxes: u x r is quadratic, so that its expansion at the centre is exact."""
    low, high = boxes.corners
    over = _pieces(field, Interval(low.low, high.high), points)
    h = Interval(boxes.half)
    entries, slopes = [], []
    for m in range(3):
        bend = np.abs(at["bend"].low[m])
        swing = [dot(h, bend[i]).high for i in range(3)]
        slopes.append(stack([at["dc"][:, i, m] + Interval(-swing[i], swing[i]) for i in range(3)]))
        steep = stack([Interval(at["dc"][:, i, m].magnitude()) + Interval(swing[i]) * 0.5 for i in range(3)])
        reach = dot(steep, h).high
        entries.append(at["c"][:, m] + Interval(-reach, reach))
    return over | {
        "c": stack(entries),
        "dc": stack(slopes),
        "n": stack(entries).squared().total(),
    }


def _value(x: dict[str, Interval]) -> Interval:
    return x["n"] / (x["b"] * x["s"].squared())


def _slopes(x: dict[str, Interval]) -> list[Interval]:
    weight = x["b"] * x["s"].squared()
    out = []
    for i in range(3):
        dn = dot(x["c"], x["dc"][:, i, :]) * 2.0
        out.append((dn - x["n"] * (x["db"][:, i] / x["b"] + x["ds"][:, i] * 2.0 / x["s"])) / weight)
    return out


def _hessian(x: dict[str, Interval]) -> list[Interval]:
    """Return the second derivatives of n / (b s^2): with w = 1 / (b s^2), ``w (n'' + n' l + l' n + n q)``."""
    dn = [dot(x["c"], x["dc"][:, i, :]) * 2.0 for i in range(3)]
    beta = [x["db"][:, i] / x["b"] for i in range(3)]
    sigma = [x["ds"][:, i] / x["s"] for i in range(3)]
    fall = [-(beta[i] + sigma[i] * 2.0) for i in range(3)]  # of log w
    out = []
    for m, (i, k) in enumerate(_PAIRS):
        same = i == k
        first = x["dc"][:, i, :].squared().total() if same else dot(x["dc"][:, i, :], x["dc"][:, k, :])
        bent = dot(x["c"], x["bend"].low[:, i, k])
        bb = beta[i].squared() if same else beta[i] * beta[k]
        ss = sigma[i].squared() if same else sigma[i] * sigma[k]
        q = (bb + beta[i] * sigma[k] + sigma[i] * beta[k]) * 2.0 + ss * 6.0 - x["gram"][m] / x["b"]
        if same:
            q = q - 4.0 / x["s"]
        total = (first + bent) * 2.0 + dn[i] * fall[k] + dn[k] * fall[i] + x["n"] * q
        out.append(total / (x["b"] * x["s"].squared()))
    return out


def affine_holds(family: Family, field: AxisField, leaves: Leaves, boxes: Boxes) -> np.ndarray:
    """Return which boxes their leaf's multipliers exclude under the axis field.

    Args:
        family: the ratios.
        field: the axis field.
        leaves: with multipliers and level.
        boxes: to be tested.
    """
    ratio, weight = mix_slots(leaves, boxes)
    value = Interval(np.zeros(len(boxes)))
    slopes, hessian = [value] * 3, [value] * 6
    terms = []
    certain = np.zeros(len(boxes), dtype=bool)
    for k, w in zip(ratio, weight, strict=True):
        value = value + Interval(w) * family.numerator_isotropic[k]
        terms.append((family.numerator_point[k], Interval(w) * family.numerator_weight[k]))
        certain |= w > 0.0
    for g, share in enumerate(group_shares(family, ratio, weight)):
        if not np.any(share.high > 0.0):
            continue
        level = share * leaves.level[boxes.leaf]
        value = value - level * family.denominator_isotropic[g]
        for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
            point = np.full(len(boxes), family.denominator_point[e])
            terms.append((point, -(level * family.denominator_weight[e])))
    ranged = value
    for point, scale in terms:
        jet = link_jet(field, boxes, family.points_m[point])
        value = value + scale * jet[0]
        slopes = [x + scale * y for x, y in zip(slopes, jet[1], strict=True)]
        hessian = [x + scale * y for x, y in zip(hessian, jet[2], strict=True)]
        ranged = ranged + scale * jet[3]

    def test(rows: IntArray, constraints: Weighted) -> np.ndarray:
        here = value[rows]
        steep, bent = [x[rows] for x in slopes], [x[rows] for x in hessian]
        for nu, bound in constraints:
            here = here + bound.value * nu
            for i in range(3):
                steep[i] = steep[i] + bound.slopes[:, i] * nu
                bent[i] = bent[i] + 2.0 * nu * bound.bend[:, i]
        return _quadratic_negative(boxes.chosen(rows), here, steep, bent)

    holds = (ranged.high < 0.0) | negative_where_allowed(
        family, leaves, boxes, test, lambda: np.stack([x.middle() for x in slopes], -1)
    )
    return np.asarray(certain & holds)


def _quadratic_negative(
    boxes: Boxes, value: Interval, slopes: list[Interval], hessian: list[Interval]
) -> np.ndarray:
    """Return where ``f + g.x + x^T H x / 2`` is negative for all ``|x_i| <= h_i`` and every H in bounds.

    The radius of H is paid for in full; then any mu with A = diag(mu) - H positive definite and
    ``f + sum(mu) / 2 + g^T A^-1 g / 2 < 0`` is a proof. Which mu is a guess, and may be a poor one.
    """
    h = boxes.half
    rest = value
    g = [s * h[:, i] for i, s in enumerate(slopes)]
    middle = []
    for entry, (i, k) in zip(hessian, _PAIRS, strict=True):
        scaled = entry * (Interval(h[:, i]) * h[:, k])
        middle.append(scaled.middle())
        rest = rest + scaled.radius() * (0.5 if i == k else 1.0)
    full = np.empty((len(boxes), 3, 3))
    for x, (i, k) in zip(middle, _PAIRS, strict=True):
        full[:, i, k] = full[:, k, i] = np.where(np.isfinite(x), x, 0.0)
    steep = np.stack([x.magnitude() for x in g], -1)
    tiny = 1e-7 * np.abs(rest.high)[:, None]
    lean = np.diagonal(full, axis1=1, axis2=2) + _off(full)
    guesses = [steep + np.maximum(lean, 0.0) + tiny]
    values, vectors = np.linalg.eigh(full)
    convex = np.abs(np.einsum("bik,bk,bjk->bij", vectors, np.maximum(values, 0.0), vectors)).sum(axis=2)
    guesses += [share * steep + convex + tiny for share in _SHARES]
    holds = np.zeros(len(boxes), dtype=bool)
    for mu in guesses:
        holds |= _dual_negative(rest, g, middle, mu)
    return holds


def _off(full: FloatArray) -> FloatArray:
    return np.asarray(np.abs(full).sum(axis=2) - np.abs(np.diagonal(full, axis1=1, axis2=2)))


def _dual_negative(rest: Interval, g: list[Interval], middle: list[FloatArray], mu: FloatArray) -> np.ndarray:
    a, b, c = (Interval(mu[:, i]) - middle[i] for i in range(3))
    d, e, f = (Interval(-middle[i]) for i in (3, 4, 5))
    minor = a * b - d.squared()
    det = c * minor - a * f.squared() - b * e.squared() + d * e * f * 2.0
    form = (
        g[0].squared() * (b * c - f.squared())
        + g[1].squared() * (a * c - e.squared())
        + g[2].squared() * minor
    )
    cross = g[0] * g[1] * (e * f - d * c) + g[0] * g[2] * (d * f - b * e) + g[1] * g[2] * (d * e - a * f)
    bound = (rest + Interval(mu).total() * 0.5) * det + (form + cross * 2.0) * 0.5
    return np.asarray((a.low > 0.0) & (minor.low > 0.0) & (det.low > 0.0) & (bound.high < 0.0))
