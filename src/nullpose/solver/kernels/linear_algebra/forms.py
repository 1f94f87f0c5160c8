"""Symmetric 3x3 forms kept as (xx, yy, zz, xy, xz, yz), and those of a family at a position."""

from __future__ import annotations

import math

from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel, rare_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import excess_at
from nullpose.solver.kernels.linear_algebra.links import isotropic_share
from nullpose.solver.kernels.linear_algebra.symmetric import add_identity, entry, fill_identity
from nullpose.solver.kernels.linear_algebra.vectors import along, dot, minus, row, scaled


@kernel
def form_value(forms, k, v):
    """Return ``v^T A_k v``."""
    a = forms[k]
    return (
        a[0] * v[0] * v[0]
        + a[1] * v[1] * v[1]
        + a[2] * v[2] * v[2]
        + 2.0 * (a[3] * v[0] * v[1] + a[4] * v[0] * v[2] + a[5] * v[1] * v[2])
    )


@inner_kernel
def smallest_form(forms, v):
    """Return the index of the smallest form at a vector, and its value."""
    least, smallest = 0, math.inf
    for k in range(forms.shape[0]):
        value = form_value(forms, k, v)
        if value < smallest:
            least, smallest = k, value
    return least, smallest


@kernel
def bilinear(a, x, y):
    """Return ``x^T A y``."""
    return (
        a[0] * x[0] * y[0]
        + a[1] * x[1] * y[1]
        + a[2] * x[2] * y[2]
        + a[3] * (x[0] * y[1] + x[1] * y[0])
        + a[4] * (x[0] * y[2] + x[2] * y[0])
        + a[5] * (x[1] * y[2] + x[2] * y[1])
    )


@kernel
def congruence(form, basis, out):
    """Fill ``R^T A R`` for a form and a 3x3 matrix."""
    half = scratch(3, 3)
    for m in range(3):
        x, y, z = basis[0, m], basis[1, m], basis[2, m]
        half[0, m] = form[0] * x + form[3] * y + form[4] * z
        half[1, m] = form[3] * x + form[1] * y + form[5] * z
        half[2, m] = form[4] * x + form[5] * y + form[2] * z
    for k in range(6):
        i, j = entry(k)
        out[k] = basis[0, i] * half[0, j] + basis[1, i] * half[1, j] + basis[2, i] * half[2, j]


@kernel
def inverse_factor(a, out):
    """Fill the transposed inverse of the Cholesky factor of a positive definite form: ``C^T A C = I``."""
    l00 = math.sqrt(a[0])
    l10, l20 = a[3] / l00, a[4] / l00
    l11 = math.sqrt(a[1] - l10 * l10)
    l21 = (a[5] - l20 * l10) / l11
    l22 = math.sqrt(a[2] - l20 * l20 - l21 * l21)
    out[:, :] = 0.0
    out[0, 0], out[1, 1], out[2, 2] = 1.0 / l00, 1.0 / l11, 1.0 / l22
    out[0, 1] = -l10 / (l00 * l11)
    out[1, 2] = -l21 / (l11 * l22)
    out[0, 2] = (l10 * l21 / l11 - l20) / (l00 * l22)


@inner_kernel
def in_frame(basis, v):
    """Return a vector of the world in a frame."""
    return (
        basis[0, 0] * v[0] + basis[1, 0] * v[1] + basis[2, 0] * v[2],
        basis[0, 1] * v[0] + basis[1, 1] * v[1] + basis[2, 1] * v[2],
        basis[0, 2] * v[0] + basis[1, 2] * v[1] + basis[2, 2] * v[2],
    )


@inner_kernel
def seen_from(points, turn, j, p, basis):
    """Return the direction from p to point j in a frame; in its own coordinates if points are turned."""
    return in_frame(turn[j] if turn.shape[0] > 0 else basis, minus(row(points, j), p))


@inner_kernel
def add_form(x, y, z, leak, weight, isotropic, out):
    """Add ``weight * M(r)`` and ``isotropic * I`` to a form of six numbers, r being (x, y, z)."""
    rho2 = x * x + y * y + z * z
    s = weight / (rho2 * rho2)
    bent = (1.0 - leak) * s
    out[0] += isotropic + s * (leak * x * x + y * y + z * z)
    out[1] += isotropic + s * (x * x + leak * y * y + z * z)
    out[2] += isotropic + s * (x * x + y * y + leak * z * z)
    out[3] -= bent * x * y
    out[4] -= bent * x * z
    out[5] -= bent * y * z


@rare_kernel
def add_dipole_form(family, axes, j, basis, r, weight, out):
    """Add ``weight`` times the form of point j's dipole with a perfect null; r is in the frame."""
    v = in_frame(family.turn[j] if family.turn.shape[0] > 0 else basis, axes[j])
    rho2 = dot(r, r)
    a = along(scaled(rho2, v), -dot(v, r), r)
    s = weight / (rho2 * rho2 * rho2)
    add_identity(family.leak * s * dot(a, a), out)
    for k in range(6):
        m, n = entry(k)
        out[k] += (1.0 - family.leak) * s * a[m] * a[n]


@small_kernel
def add_point(family, j, p, basis, weight, isotropic, out):
    """Add ``weight * M`` of point j and ``isotropic * I``, in a frame, to a form of six numbers."""
    weight *= excess_at(family, j, p)
    x, y, z = seen_from(family.points_m, family.turn, j, p, basis)
    share = isotropic_share(family.ground_leaks, j)
    add_form(x, y, z, family.leak, share * weight, isotropic, out)
    if share < 1.0:
        add_dipole_form(family, family.ground_axes, j, basis, (x, y, z), (1.0 - share) * weight, out)


@small_kernel
def add_denominator(family, g, weight, p, basis, out):
    """Add ``weight * D_g``, in a frame, to a form of six numbers."""
    add_identity(weight * family.denominator_isotropic[g], out)
    for e in range(family.denominator_start[g], family.denominator_start[g + 1]):
        scale = weight * family.denominator_weight[e]
        add_point(family, family.denominator_point[e], p, basis, scale, 0.0, out)


@kernel
def fill_forms(family, p, numerators, denominators):
    """Fill every numerator (R, 6) and denominator (G, 6) of a family at a position."""
    n0, nw, npt = family.numerator_isotropic, family.numerator_weight, family.numerator_point
    numerators[:, :] = 0.0
    denominators[:, :] = 0.0
    world = scratch(3, 3)
    fill_identity(world)
    for k in range(nw.shape[0]):
        add_point(family, npt[k], p, world, nw[k], n0[k], numerators[k])
    for g in range(denominators.shape[0]):
        add_denominator(family, g, 1.0, p, world, denominators[g])
