"""The strongest link that a point known only up to a set can have: lemmas 1 to 3 of docs/robust.md.

The link ``|y x q|^2 / |q|^4`` of a point at q is ``|y x v|^2`` with ``v = q / |q|^2``: the squared distance
of the inverted point from the line of the axis (lemma 1). An antenna with a leak l adds ``l (y.v)^2``. A
point with a dipole has ``(1 - l) (y.a)^2 + l |a|^2``, a being its link vector.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from nullpose.channel.model import BY_DISTANCE, BY_ELEVATION
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import (
    elevation_gain,
    excess_in_sight,
    excess_jet,
    sight_probability,
    steepness,
)
from nullpose.solver.kernels.linear_algebra.symmetric import eigen3
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    combination,
    components,
    cross,
    dot,
    norm,
    over,
    perpendicular,
    row,
    rows,
    scaled,
    store,
    times,
)

ROUND = 4e-15  # of a cross product of two vectors, relative to the product of their lengths
_ROUNDING = 1e-13  # of a bound: what its few operations may lose
_MOST_PARTS = 64
_FEW_PARTS = 16  # in a channel by elevation
_SMALL = 1e-12
_LINES = 4  # tried for a part
_ANGLES = 8  # at which a gain by elevation is compared with a line
_TRIALS = 14  # slopes tried for a part
_QUICK_TRIALS = _FEW_TRIALS = 3
_RANGE = 1e-3  # accuracy of the range of g
_ITERATIONS = 40
_QUICK = 12
_CLIMB = 6
_ORIGIN = (0.0, 0.0, 0.0)

FloatArray = NDArray[np.float64]


class Sets(NamedTuple):
    """The sets that points are known up to, about a centre each: balls and ellipsoids.

    Where all are balls, the axes are None, and what ellipsoids need is not even compiled.
    """

    radii: FloatArray  # (n,) of a ball; negative for an ellipsoid
    axes: FloatArray | None  # (n, 3, 3) an ellipsoid's axes, as rows
    semi: FloatArray | None  # (n, 3) and its half lengths
    dipoles: FloatArray  # (n, 3) the axes of the dipoles there, zero where there is none; balls are of others
    extents: FloatArray  # (n,) the largest half length of each
    channels: FloatArray | None = None  # (n + 1, WIDTH) rows of their channels and the node's; None if free


class Form(NamedTuple):
    """A form ``both (y x q).(a x q) + across |y x q|^2 + beside |a x q|^2 + length |q|^2``."""

    y: tuple[float, float, float]
    axis: tuple[float, float, float]  # a
    both: float
    across: float
    beside: float
    length: float


@inner_kernel
def has_dipole(axis):
    """Check whether the axis of an antenna on the ground is that of a dipole; it is zero for others."""
    return dot(axis, axis) > 0.0


@inner_kernel
def link_and_slopes(y, q, axis, leak):
    """Return the link of a point at q, y being of unit length, and its derivatives by y and by q."""
    square, ahead = dot(q, q), dot(y, q)
    if not has_dipole(axis):
        across, bent = cross(y, q), (1.0 - leak) * ahead
        link = (dot(across, across) + leak * ahead * ahead) / (square * square)
        by_axis = scaled(2.0 / square**2, along(scaled(square, y), -bent, q))
        return link, by_axis, along(scaled(2.0 / square**2, along(q, -bent, y)), -4.0 * link / square, q)
    kept, part, other = (1.0 - leak) / square**3, leak / square**2, cross(axis, q)
    beside, both, across = dot(axis, q), dot(cross(y, q), other), dot(other, other)
    by_axis = along(
        scaled(2.0 * part * across, y), 2.0 * kept * both, along(scaled(square, axis), -beside, q)
    )
    turned = along(along(scaled(2.0 * dot(y, axis), q), -beside, y), -ahead, axis)
    by_place = scaled(2.0 * kept * both, along(turned, -3.0 * both / square, q))
    by_place = along(by_place, 2.0 * part, along(along(q, -beside, axis), -2.0 * across / square, q))
    return kept * both * both + part * across, by_axis, by_place


@small_kernel
def channel_slopes(channels, j, y, q, axis, leak):
    """Do what ``link_and_slopes`` does, with the excess gain of channel j if there are channels."""
    link, by_axis, by_place = link_and_slopes(y, q, axis, leak)
    if channels is not None:
        slopes, bends = scratch(3), scratch(3, 3)
        gain = excess_jet(channels[j], q, slopes, bends)  # its slopes are by the position
        by_place = along(by_place, -link, (slopes[0], slopes[1], slopes[2]))
        return gain * link, scaled(gain, by_axis), scaled(gain, by_place)
    return link, by_axis, by_place


@inner_kernel
def strongest_in_ball(y, q, radius):
    """Return lemma 2, (the largest root link over a ball about q, where it is), of a dipole without a leak.

    Infinite if the ball reaches the origin.
    """
    clear = dot(q, q) - radius * radius
    if not clear > 0.0:
        return math.inf, _ORIGIN
    side = along(q, -dot(q, y), y)
    # where the axis points at the centre any direction across it will do
    side = side if norm(side) > 1e-12 * norm(q) else perpendicular(y)
    inverted = over(along(q, radius / norm(side), side), clear)
    return (norm(cross(y, q)) + radius) / clear, over(inverted, dot(inverted, inverted))


@inner_kernel
def form_times(form, v):
    """Return the product of a form's matrix and a vector, its digits kept beside the nulls."""
    y, axis = form.y, form.axis
    of_y, of_axis = cross(y, v), cross(axis, v)
    product = scaled(-0.5 * form.both, along(cross(y, of_axis), 1.0, cross(axis, of_y)))
    product = along(along(product, -form.across, cross(y, of_y)), -form.beside, cross(axis, of_axis))
    return along(product, form.length, v)


@inner_kernel
def lengthened(form, length):
    """Return a form with another multiple of ``|q|^2``."""
    return Form(form.y, form.axis, form.both, form.across, form.beside, length)


@inner_kernel
def largest_form(form, q, semi):
    """Return (an upper bound on a form over the ellipsoid ``q + semi x``, where it is about attained).

    The dual of a quadratic function over the unit ball, which has no gap: the least ``k + m + sum_i b_i^2 /
    (m - e_i)`` over m above the eigenvalues e, b being the linear part along the eigenvectors.
    """
    matrix, values, vectors, pull, x = scratch(3, 3), scratch(3), scratch(3, 3), scratch(3), scratch(3)
    for i in range(3):
        unit_vector = (1.0 if i == 0 else 0.0, 1.0 if i == 1 else 0.0, 1.0 if i == 2 else 0.0)
        store(scaled(semi[i], times(semi, form_times(form, unit_vector))), matrix[i])
    eigen3(matrix, values, vectors)
    image = form_times(form, q)
    slope, bound, m = times(semi, image), dot(q, image), 0.0
    size = abs(bound)
    for i in range(3):
        pull[i] = slope[0] * vectors[0, i] + slope[1] * vectors[1, i] + slope[2] * vectors[2, i]
        m = max(m, values[i] + abs(pull[i]))
        size += abs(values[i]) + abs(pull[i])
    for _ in range(_ITERATIONS):
        square = change = 0.0
        for i in range(3):
            x[i] = pull[i] / (m - values[i]) if m > values[i] else 0.0
            square += x[i] * x[i]
            change += x[i] * x[i] / (m - values[i]) if m > values[i] else 0.0
        step = square * (math.sqrt(square) - 1.0) / change if square > 1.0 + 1e-15 else 0.0
        if not step > 1e-16 * m:
            break
        m += step
    x[0] = math.copysign(math.sqrt(max(0.0, 1.0 - square) + x[0] * x[0]), x[0])  # along the largest
    total = _ORIGIN
    for i in range(3):
        bound += pull[i] * pull[i] / (m - values[i]) if m > values[i] else 0.0
        total = along(total, x[i], (vectors[0, i], vectors[1, i], vectors[2, i]))
    place = along(q, 1.0, times(semi, scaled(1.0 / max(1.0, norm(total)), total)))
    return bound + m + _ROUNDING * (size + m), place


@inner_kernel
def largest_ratio(form, q, semi, slope, constant, nearest, place, close):
    """Return (an upper bound on a form's ratio to ``slope |q'|^2 + constant``, where it is about attained).

    By Dinkelbach's method from a place, until the bound is relatively close to what is attained. The
    denominator is positive from the squared distance ``nearest`` on.
    """
    upper, at = math.inf, place
    ratio = dot(at, form_times(form, at)) / (slope * dot(at, at) + constant)
    for _ in range(_QUICK):
        most, at = largest_form(lengthened(form, form.length - ratio * slope), q, semi)
        upper = min(upper, ratio + max(0.0, most - ratio * constant) / (slope * nearest + constant))
        new = dot(at, form_times(form, at)) / (slope * dot(at, at) + constant)
        if new > ratio:
            ratio, place = new, at
        if upper - ratio <= close * abs(ratio):
            break
    return upper, place


@inner_kernel
def climb(sets, channels, j, y, q, leak, place):
    """Return (a link, its place) uphill from a place: the point whose normal is the gradient, repeatedly.

    All in the axes of ellipsoid j.
    """
    frame, semi, axis = rows(sets.axes[j]), row(sets.semi, j), row(sets.dipoles, j)
    y, q = combination(frame, y), combination(frame, q)
    start = combination(frame, place)
    best, _, slope = channel_slopes(channels, j, y, start, axis, leak)
    for _ in range(_CLIMB):
        normal = times(semi, components(frame, slope))
        length = norm(normal)
        if not length > 0.0:
            break
        new_place = along(q, 1.0, combination(frame, times(semi, over(normal, length))))
        new, _, slope = channel_slopes(channels, j, y, new_place, axis, leak)
        if not new > best * (1.0 + _ROUNDING):
            break
        best, start = new, new_place
    return best, components(frame, start)


@inner_kernel
def form_of(y, axis, leak, low, high):
    """Return a form that over ``|q|^4`` is not below the link where ``low <= g <= high``, lemma 3 (1)."""
    if not has_dipole(axis):
        return Form(y, axis, 0.0, 1.0 - leak, 0.0, leak)
    kept = 1.0 - leak
    return Form(y, axis, kept * (low + high), 0.0, leak, -kept * low * high)


@inner_kernel
def line_over(row, slope, low, high):
    """Return c such that ``c + slope t`` is not below a gain by elevation where ``low <= t <= high``.

    t is the squared sine of the elevation, which is above the horizon, and the slope positive. Between two
    angles a function is above its chord by no more than an eighth of the step's square times minus its second
    derivative.
    """
    first, last = math.asin(math.sqrt(max(0.0, low))), math.asin(math.sqrt(min(1.0, high)))
    step, most, bend = (last - first) / _ANGLES, -math.inf, 0.0
    before = sight_probability(row, first)
    for i in range(_ANGLES + 1):
        p = sight_probability(row, first + i * step)
        gain, sine = elevation_gain(row, p), math.sin(first + i * step)
        most = max(most, gain - slope * sine * sine)
        spread = 0.25 if before < 0.5 < p else max(before * (1.0 - before), p * (1.0 - p))
        bend = max(bend, steepness(row, gain) * gain * row[2] ** 2 * spread * (2.0 * p - 1.0))
        before = p
    most += 0.125 * step * step * (bend + 2.0 * slope * max(0.0, math.cos(2.0 * first)))
    return most + _ROUNDING * (1.0 + slope)


@inner_kernel
def mean_form(row, y, up, leak, low, high, slope, weight):
    """Return a form that over ``|q|^3`` is not below the root of a link by elevation, lemma 3 (4)."""
    line, inverse = line_over(row, slope, low, high), 0.5 / weight
    length = 0.5 * weight * leak + inverse * (line + slope)
    return Form(y, up, 0.0, 0.5 * weight * (1.0 - leak), -inverse * slope, length)


@inner_kernel
def part_by_elevation(row, y, axis, up, leak, q, semi, part, nearest, tolerance, best, place):
    """Return (lemma 3 (4)'s bound for a part, where its form is about the largest).

    Lines are a tangent of the gain and its chord, with the weights of the best place, then of the form's.
    """
    near, far, low, high = part
    first, last = math.asin(math.sqrt(max(0.0, low))), math.asin(math.sqrt(min(1.0, high)))
    rise = elevation_gain(row, sight_probability(row, last)) - elevation_gain(
        row, sight_probability(row, first)
    )
    root, bound, at, peak = math.sqrt(best), math.inf, place, place
    for trial in range(_LINES):
        if trial % 2 == 0:
            angle = math.asin(min(1.0, -dot(peak, up) / norm(peak)))
            p = sight_probability(row, angle)
            gain = elevation_gain(row, p)
            across = max(_SMALL, link_and_slopes(y, peak, axis, leak)[0] * dot(peak, peak))
            slope = steepness(row, gain) * gain * row[2] * p * (1.0 - p) / max(_SMALL, math.sin(2.0 * angle))
        else:
            slope = rise / max(_SMALL, high - low)
        form = mean_form(row, y, up, leak, low, high, slope, math.sqrt(gain / across))
        upper, peak = bound_of_part(
            form, 1.5, _FEW_TRIALS, q, semi, near, far, nearest, 0.5 * tolerance, root, peak
        )
        if upper < bound:
            bound, at = upper, peak
        if bound <= root * (1.0 + 0.5 * tolerance):
            break
    return bound * bound, at


@kernel
def strongest_in_ellipsoid(sets, channels, j, y, q, leak, tolerance):
    """Return (attained, upper bound, place) of the largest root link over an ellipsoid about q, by lemma 3.

    Parts of the ellipsoid, between two distances and two values of g, are halved until the bounds of all are
    within the tolerance, or there are many. In a channel by elevation the two are squared sines of it.
    """
    frame, semi = rows(sets.axes[j]), row(sets.semi, j)
    y, q, axis = components(frame, y), components(frame, q), components(frame, row(sets.dipoles, j))
    if not least_distance(q, semi) > 0.0:
        return math.inf, math.inf, _ORIGIN
    power, scale, is_tilted = 2.0, 1.0, False
    lengths, both = Form(y, axis, 0.0, 0.0, 0.0, 1.0), Form(y, axis, 1.0, 0.0, 0.0, 0.0)
    up = components(frame, (0.0, 0.0, 1.0))
    if channels is not None:
        kind = channels[j, 0]
        if kind == BY_DISTANCE:
            power, scale = 2.0 - 0.5 * channels[j, 1], channels[j, 2] ** -channels[j, 1]
        elif kind == BY_ELEVATION:
            is_tilted = not has_dipole(axis) and dot(q, up) + norm(times(semi, up)) <= 0.0
            high = norm(times(semi, up)) - dot(q, up)
            sine = min(1.0, max(0.0, high / least_distance(q, semi)))
            scale = elevation_gain(channels[j], sight_probability(channels[j], math.asin(sine)))
            if is_tilted:
                both = Form(y, up, 0.0, 0.0, -1.0, 1.0)
    negative, place = largest_form(lengthened(lengths, -1.0), q, semi)
    nearest, longest = max(-negative, least_distance(q, semi) ** 2), max(semi[0], max(semi[1], semi[2]))
    parts = scratch(_MOST_PARTS, 4)
    parts[0, 0], parts[0, 1] = nearest, (norm(q) + longest) ** 2
    parts[0, 2] = parts[0, 3] = dot(place, form_times(both, place)) / dot(place, place)
    if (has_dipole(axis) or is_tilted) and tolerance < math.inf:
        opposite = Form(y, both.axis, -both.both, 0.0, -both.beside, -both.length)
        parts[0, 3] = largest_ratio(both, q, semi, 1.0, 0.0, nearest, place, _RANGE)[0]
        parts[0, 2] = -largest_ratio(opposite, q, semi, 1.0, 0.0, nearest, place, _RANGE)[0]
    near, far, reach = nearest, parts[0, 1], 2.0 - power
    rest = 4.0 * ROUND * math.sqrt(scale * max(near**reach, far**reach) / near)
    best, place = climb(sets, channels, j, y, q, leak, place)
    for tip in range(6 if is_tilted else 0):
        size = semi[tip % 3] if tip < 3 else -semi[tip % 3]
        end = size if tip % 3 == 0 else 0.0, size if tip % 3 == 1 else 0.0, size if tip % 3 == 2 else 0.0
        found, peak = climb(sets, channels, j, y, q, leak, along(q, 1.0, end))
        if found > best:
            best, place = found, peak
    upper, examined, most = 0.0, 0, _FEW_PARTS if is_tilted else _MOST_PARTS
    top = 0 if is_tilted and not tolerance < math.inf else 1  # the climbs have found it
    while top > 0:
        top -= 1
        examined += 1
        near, far, low, high = parts[top, 0], parts[top, 1], parts[top, 2], parts[top, 3]
        bound, at = math.inf, place
        if channels is not None:  # noqa: SIM102  this test alone is decided when it is compiled
            if is_tilted:
                part = near, far, low, high
                bound, at = part_by_elevation(
                    channels[j], y, axis, up, leak, q, semi, part, nearest, tolerance, best, place
                )
        if not is_tilted:
            form = form_of(y, axis, leak, low, high)
            bound, at = bound_of_part(
                form, power, _TRIALS, q, semi, near, far, nearest, tolerance, best / scale, place
            )
            bound *= scale
        found, peak = climb(sets, channels, j, y, q, leak, at)
        if found > best:
            best, place = found, peak
        if bound <= best * (1.0 + tolerance) or examined > most or top + 2 > _MOST_PARTS:
            upper = max(upper, bound)
            continue
        for k in range(4):
            parts[top + 1, k] = parts[top, k]
        square = dot(at, at)
        is_wide = (1.0 - leak) * (high - low) ** 2 * square > bound * (far - near) ** 2
        if is_tilted:
            is_wide = 8.0 * (high - low) * far > (far - near) * high
        if is_wide:
            cut = 0.5 * (low + high) if is_tilted else dot(at, form_times(both, at)) / square
            edge = 0.1 * (high - low)
            parts[top, 3] = parts[top + 1, 2] = min(high - edge, max(low + edge, cut))
        else:
            parts[top, 1] = parts[top + 1, 0] = 0.5 * (near + far)
        top += 2
    root = math.sqrt(best)
    return (
        root,
        max(root, math.sqrt(upper) * (1.0 + _ROUNDING) + rest),
        combination(frame, place),
    )


@inner_kernel
def bound_of_part(form, power, trials, q, semi, near, far, nearest, tolerance, best, place):
    """Return (lemma 3 (2)'s bound where ``near <= |q'|^2 <= far``, where its form is about the largest).

    The form is over the power of ``|q'|^2``. The slope of the line under that is sought by bisection, until
    the bound is close to the best link.
    """
    bound, low, high = math.inf, 0.0, math.inf
    slope, at = min(max(dot(place, place), near), far), place
    for trial in range(trials):
        touch, square, steep = min(max(slope, near), far), 0.0, power * slope ** (power - 1.0)
        constant = touch**power - steep * touch
        if steep * nearest + constant > 0.0:
            upper, at = largest_ratio(form, q, semi, steep, constant, nearest, place, 0.2 * tolerance)
            bound = min(bound, upper)
            if bound <= best * (1.0 + tolerance):
                break
            square = dot(at, at)
        low, high = (slope, high) if square > touch else (low, slope)
        if not high - low > 1e-3 * slope:
            break
        inside = trial < _QUICK_TRIALS and low < square < high
        slope = square if inside else 0.5 * (low + min(high, 2.0 * slope))
    return bound, at


@inner_kernel
def least_distance(q, semi):
    """Return a lower bound on the distance from the origin to an ellipsoid about q; negative if inside."""
    size = (q[0] / semi[0], q[1] / semi[1], q[2] / semi[2])
    normal = norm((size[0] / semi[0], size[1] / semi[1], size[2] / semi[2]))
    # the tangent plane across the line to the centre, as the ellipsoid's form sees it
    return 0.999 * max(
        norm(q) - max(semi[0], max(semi[1], semi[2])), norm(size) * (norm(size) - 1.0) / normal
    )


@inner_kernel
def clearance_of(radius, axes, semi, j, q):
    """Do what ``clearance`` does; compiled without the branch where there are no axes."""
    if axes is not None:  # noqa: SIM102  this test alone is decided when it is compiled
        if radius < 0.0:
            return least_distance(components(rows(axes[j]), q), row(semi, j))
    return norm(q) - radius


@inner_kernel
def strongest_of(sets, axes, semi, channels, j, y, q, leak, tolerance):
    """Do what ``strongest_link`` does; compiled without the branch where there are no axes."""
    radius, dipole = sets.radii[j], row(sets.dipoles, j)
    if axes is not None:  # noqa: SIM102  this test alone is decided when it is compiled
        if radius < 0.0:
            return strongest_in_ellipsoid(sets, channels, j, y, q, leak, tolerance)
    if radius == 0.0:
        scale = 1.0
        if channels is not None:
            scale = math.sqrt(excess_in_sight(channels[j], q))
        root = scale * math.sqrt(link_and_slopes(y, q, dipole, leak)[0])
        return root, root * (1.0 + _ROUNDING) + 4.0 * ROUND * scale / norm(q), q
    most, place = strongest_in_ball(y, q, radius)
    return most, most + ROUND * norm(q) / (dot(q, q) - radius * radius), place


@kernel
def clearance(sets, j, q):
    """Return a lower bound on the distance from the origin to set j about q; not positive if it is inside."""
    return clearance_of(sets.radii[j], sets.axes, sets.semi, j, q)


@kernel
def strongest_link(sets, j, y, q, leak, tolerance):
    """Return (attained, upper bound, place) of the largest root link of set j about q, y a unit vector."""
    return strongest_of(sets, sets.axes, sets.semi, sets.channels, j, y, q, leak, tolerance)
