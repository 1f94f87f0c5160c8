"""The strongest link of a point in a ball, with any antennas and channel: lemma 3 of docs/robust.md."""

from __future__ import annotations

import math

from nullpose.channel.model import BY_ELEVATION, EXPONENT, RATE, REFERENCE_M
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import elevation_gain, sight_probability, steepness
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    dot,
    norm,
    row,
)
from nullpose.solver.kernels.search.ball_forms import (
    Form,
    bound_of_part,
    form_times,
    largest_ratio,
)
from nullpose.solver.kernels.search.set_links import (
    ORIGIN,
    ROUND,
    ROUNDING,
    channel_slopes,
    has_dipole,
    link_and_slopes,
)

_MOST_PARTS = 64
_FEW_PARTS = 16  # in a channel by elevation
_SMALL = 1e-12
_LINES = 4  # tried for a part
_ANGLES = 8  # at which a gain by elevation is compared with a line
_TRIALS = 14  # slopes tried for a part
_FEW_TRIALS = 3
_RANGE = 1e-3  # accuracy of the range of g
_CLIMB = 6
_UP = (0.0, 0.0, 1.0)


@inner_kernel
def climb(sets, channels, j, y, q, leak, place):
    """Return (a link, its place) uphill from a place: the point whose normal is the gradient, repeatedly."""
    start, axis = place, row(sets.dipoles, j)
    best, _, slope = channel_slopes(channels, j, y, start, axis, leak)
    for _ in range(_CLIMB):
        length = norm(slope)
        if not length > 0.0:
            break
        new_place = along(q, sets.radii[j] / length, slope)
        new, _, slope = channel_slopes(channels, j, y, new_place, axis, leak)
        if not new > best * (1.0 + ROUNDING):
            break
        best, start = new, new_place
    return best, start


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
        bend = max(bend, steepness(row, gain) * gain * row[RATE] ** 2 * spread * (2.0 * p - 1.0))
        before = p
    most += 0.125 * step * step * (bend + 2.0 * slope * max(0.0, math.cos(2.0 * first)))
    return most + ROUNDING * (1.0 + slope)


@inner_kernel
def mean_form(row, y, leak, low, high, slope, weight):
    """Return a form that is not below ``|q|^3`` times the root of a link by elevation, lemma 3 (4)."""
    line, inverse = line_over(row, slope, low, high), 0.5 / weight
    length = 0.5 * weight * leak + inverse * (line + slope)
    return Form(y, _UP, 0.0, 0.5 * weight * (1.0 - leak), -inverse * slope, length)


@inner_kernel
def part_by_elevation(row, y, axis, leak, q, radius, part, nearest, tolerance, best, place):
    """Return (lemma 3 (4)'s bound for a part, where its form is about the largest).

    Lines are a tangent of the gain and its chord, with the weights of the best place, then of the form's.
    """
    near, far, low, high = part
    first, last = math.asin(math.sqrt(max(0.0, low))), math.asin(math.sqrt(min(1.0, high)))
    rise = elevation_gain(row, sight_probability(row, last)) - elevation_gain(
        row, sight_probability(row, first)
    )
    e, scale = row[EXPONENT], row[REFERENCE_M] ** -row[EXPONENT]
    root, bound, at, peak = math.sqrt(best / scale), math.inf, place, place
    for trial in range(_LINES):
        if trial % 2 == 0:
            angle = math.asin(min(1.0, -peak[2] / norm(peak)))
            p = sight_probability(row, angle)
            gain = elevation_gain(row, p)
            across = max(_SMALL, link_and_slopes(y, peak, axis, leak)[0] * dot(peak, peak))
            slope = (
                steepness(row, gain) * gain * row[RATE] * p * (1.0 - p) / max(_SMALL, math.sin(2.0 * angle))
            )
        else:
            slope = rise / max(_SMALL, high - low)
        form = mean_form(row, y, leak, low, high, slope, math.sqrt(gain / across))
        upper, peak = bound_of_part(
            form, 1.5 - 0.25 * e, _FEW_TRIALS, q, radius, near, far, nearest, 0.5 * tolerance, root, peak
        )
        if upper < bound:
            bound, at = upper, peak
        if bound <= root * (1.0 + 0.5 * tolerance):
            break
    return scale * bound * bound, at


@kernel
def strongest_by_parts(sets, channels, j, y, q, leak, tolerance):
    """Return (attained, upper bound, place) of the largest root link over ball j about q, by lemma 3.

    Parts of the ball, between two distances and two values of g, are halved until the bounds of all are
    within the tolerance, or there are many. In a channel by elevation the two are squared sines of it.
    """
    radius, axis, distance = sets.radii[j], row(sets.dipoles, j), norm(q)
    clear = (distance - radius) * (1.0 - ROUNDING)
    if not clear > 0.0:
        return math.inf, math.inf, ORIGIN
    power, scale, is_tilted, both = 2.0, 1.0, False, Form(y, axis, 1.0, 0.0, 0.0, 0.0)
    if channels.shape[0] > 0:
        e = channels[j, EXPONENT]
        power, scale = 2.0 - 0.5 * e, channels[j, REFERENCE_M] ** -e
        if channels[j, 0] == BY_ELEVATION:
            is_tilted = not has_dipole(axis) and q[2] + radius <= 0.0
            sine = min(1.0, max(0.0, (radius - q[2]) / clear))
            scale *= elevation_gain(channels[j], sight_probability(channels[j], math.asin(sine)))
            if is_tilted:
                both = Form(y, _UP, 0.0, 0.0, -1.0, 1.0)
    nearest, place = clear * clear, along(q, -radius / distance, q)
    parts = scratch(_MOST_PARTS, 4)
    parts[0, 0], parts[0, 1] = nearest, (distance + radius) ** 2
    parts[0, 2] = parts[0, 3] = dot(place, form_times(both, place)) / dot(place, place)
    if (has_dipole(axis) or is_tilted) and tolerance < math.inf:
        opposite = Form(y, both.axis, -both.both, 0.0, -both.beside, -both.length)
        parts[0, 3] = largest_ratio(both, q, radius, 1.0, 0.0, nearest, place, _RANGE)[0]
        parts[0, 2] = -largest_ratio(opposite, q, radius, 1.0, 0.0, nearest, place, _RANGE)[0]
    near, far, reach = nearest, parts[0, 1], 2.0 - power
    rest = 4.0 * ROUND * math.sqrt(scale * max(near**reach, far**reach) / near)
    best, place = climb(sets, channels, j, y, q, leak, place)
    for tip in range(6 if is_tilted else 0):
        size = radius if tip < 3 else -radius
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
        if is_tilted:
            part = near, far, low, high
            bound, at = part_by_elevation(
                channels[j], y, axis, leak, q, radius, part, nearest, tolerance, best, place
            )
        else:
            form = form_of(y, axis, leak, low, high)
            bound, at = bound_of_part(
                form, power, _TRIALS, q, radius, near, far, nearest, tolerance, best / scale, place
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
    return root, max(root, math.sqrt(upper) * (1.0 + ROUNDING) + rest), place
