"""A pattern's gain towards a direction with its derivatives, and bounds of both over caps of directions."""

from __future__ import annotations

import math

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel

_ROUNDING_RAD = 1e-9  # radians by which a cap is wider than asked for


@kernel
def gain_at(pattern, x, y, z):
    """Return the gain towards a unit vector in body axes."""
    total, real, imaginary = 0.0, 1.0, 0.0
    top = pattern.cosine.shape[0]
    for m in range(pattern.orders):
        legendre, before = pattern.start[m], 0.0
        u, w = pattern.cosine[m, m] * legendre, pattern.sine[m, m] * legendre
        for n in range(m + 1, top):
            legendre, before = pattern.a[n, m] * z * legendre - pattern.b[n, m] * before, legendre
            u += pattern.cosine[n, m] * legendre
            w += pattern.sine[n, m] * legendre
        total += u * real + w * imaginary
        real, imaginary = real * x - imaginary * y, real * y + imaginary * x
    return max(0.0, total)


@inner_kernel
def gain_jet(pattern, d, slope, bend):
    """Fill gradient and Hessian at a unit vector d of the gain over squared distance; return the gain.

    That is ``g(r / |r|) / |r|^2`` as a function of r, in body axes: along ``k d + m f`` with f across d its
    second derivative is ``6 k^2 g - 6 k m g_f + m^2 (g_ff - 2 g)``.

    Args:
        pattern: its arrays.
        d: unit vector, a tuple.
        slope: output, (3,).
        bend: output, (3, 3).
    """
    x, y, z = d
    top = pattern.cosine.shape[0]
    g = hx = hy = hz = hxx = hxy = hxz = hyz = hzz = 0.0
    # (x + iy)^m, and the two powers before it times m and m (m - 1)
    c0, s0, c1, s1, c2, s2 = 1.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for m in range(pattern.orders):
        p, q, p1, q1, p2, q2 = pattern.start[m], 0.0, 0.0, 0.0, 0.0, 0.0
        u, w = pattern.cosine[m, m] * p, pattern.sine[m, m] * p
        u1 = w1 = u2 = w2 = 0.0
        for n in range(m + 1, top):
            a, b = pattern.a[n, m], pattern.b[n, m]
            p, q, p1, q1, p2, q2 = (
                a * z * p - b * q,
                p,
                a * (p + z * p1) - b * q1,
                p1,
                a * (2.0 * p1 + z * p2) - b * q2,
                p2,
            )
            c, s = pattern.cosine[n, m], pattern.sine[n, m]
            u += c * p
            w += s * p
            u1 += c * p1
            w1 += s * p1
            u2 += c * p2
            w2 += s * p2
        first, second = float(m), float(m * (m - 1))
        g += u * c0 + w * s0
        hx += first * (u * c1 + w * s1)
        hy += first * (w * c1 - u * s1)
        hz += u1 * c0 + w1 * s0
        hxx += second * (u * c2 + w * s2)
        hxy += second * (w * c2 - u * s2)
        hxz += first * (u1 * c1 + w1 * s1)
        hyz += first * (w1 * c1 - u1 * s1)
        hzz += u2 * c0 + w2 * s0
        c0, s0, c1, s1, c2, s2 = c0 * x - s0 * y, c0 * y + s0 * x, c0, s0, c1, s1
    h = ((hxx, hxy, hxz), (hxy, -hxx, hyz), (hxz, hyz, hzz))
    outward = x * hx + y * hy + z * hz
    across = (hx - outward * x, hy - outward * y, hz - outward * z)
    hd = (hxx * x + hxy * y + hxz * z, hxy * x - hxx * y + hyz * z, hxz * x + hyz * y + hzz * z)
    dhd = x * hd[0] + y * hd[1] + z * hd[2]
    for i in range(3):
        slope[i] = across[i] - 2.0 * g * d[i]
        for j in range(3):
            value = h[i][j] - hd[i] * d[j] - d[i] * hd[j] + (dhd + outward + 8.0 * g) * d[i] * d[j]
            value -= 3.0 * (across[i] * d[j] + d[i] * across[j])
            bend[i, j] = value - (outward + 2.0 * g if i == j else 0.0)
    return g


@inner_kernel
def cap_bounds(pattern, d, radius, out):
    """Fill bounds over all directions within an angle of d.

    Args:
        pattern: its arrays.
        d: unit vector, a tuple.
        radius: the angle, radians.
        out: output, (5,): minus the least gain, the largest, and the largest derivatives of order 1 to 3.
    """
    rows = pattern.rows
    step = math.pi / rows
    theta, wide = math.acos(max(-1.0, min(1.0, d[2]))), radius + _ROUNDING_RAD
    first = max(0, int((theta - wide) / step)) if theta > wide else 0
    last = min(rows - 1, int((theta + wide) / step))
    level = 0
    while (last >> level) - (first >> level) > 2:
        level += 1
    left, right, sideways = 0, 2 * rows - 1, math.sin(theta)
    whole = theta - wide <= 0.0 or theta + wide >= math.pi or math.sin(min(wide, 0.5 * math.pi)) >= sideways
    if not whole:
        phi, turn = math.atan2(d[1], d[0]), math.asin(math.sin(wide) / sideways) + _ROUNDING_RAD
        if phi < 0.0:
            phi += 2.0 * math.pi
        left = math.floor((phi - turn) / step) + 2 * rows
        right = math.floor((phi + turn) / step) + 2 * rows
        whole = right - left >= 2 * rows - 1
    if whole:
        left, right = 0, 2 * rows - 1
    across = 0
    while (right >> across) - (left >> across) > 2:
        across += 1
    columns = (2 * rows) >> across
    for n in range(5):
        out[n] = -math.inf
    for i in range(first >> level, (last >> level) + 1):
        for j in range(left >> across, (right >> across) + 1):
            at = pattern.offset[level, across] + i * columns + j % columns
            for n in range(5):
                out[n] = max(out[n], pattern.caps[at, n])
