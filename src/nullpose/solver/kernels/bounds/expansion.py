"""Link forms over a box of positions: value, first derivatives and a bound on the second.

The frame may stand still, or turn with the direction to a point, so that the form of that point keeps its
null along the third axis. The second derivative is bounded by the rules of ``link_field.py``. The proof is in
the documentation, "The certificate explained" (lemmas 1 and 2).

Forms are kept as (xx, yy, zz, xy, xz, yz), in the frame at the box's centre.
"""

from __future__ import annotations

import math

from nullpose.solver.kernels.bounds.link_field import (
    amplitude,
    anchor_fall,
    fall_of,
    rise_of,
    scaled_inverse,
    turned,
)
from nullpose.solver.kernels.bounds.node import CENTRE, HALF, LEVEL
from nullpose.solver.kernels.bounds.records import TOWARDS_POINT, WORLD, Frame
from nullpose.solver.kernels.compiler.jit import inner_kernel, kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.forms import seen_from
from nullpose.solver.kernels.linear_algebra.links import isotropic_share, strongest_point
from nullpose.solver.kernels.linear_algebra.symmetric import fill_identity, tangents
from nullpose.solver.kernels.linear_algebra.vectors import (
    along,
    cross,
    dot,
    minus,
    norm,
    over,
    row as row_of,
    square_range,
    store,
    unit,
)

_WITH_DIPOLES = 0.4  # of the distance of turning: the rest of link vectors grows faster with the rate


@inner_kernel
def min_square(points, j, centre, half):
    """Return the squared distance from point j to the nearest point of the box."""
    return square_range(points[j], centre, half, 3)[0]


@kernel
def min_distance(points, j, centre, half):
    """Return the distance from point j to the nearest point of the box."""
    return math.sqrt(min_square(points, j, centre, half))


@kernel
def frame_at(family, kind, anchor, centre, half, basis):
    """Return a frame at the centre, whose axes are filled into ``basis``.

    The third points at the anchor, or along the form of an anchor with a dipole.
    """
    points = family.points_m
    if kind == WORLD:
        fill_identity(basis)
        return Frame(kind, anchor, basis, math.inf, math.inf)
    a, b, c = scratch(3), scratch(3), scratch(3)
    r = minus(row_of(points, anchor), centre)
    rho = norm(r)
    store(over(r, rho), c)
    if isotropic_share(family.ground_leaks, anchor) < 1.0:
        v = row_of(family.ground_axes, anchor)  # along which it is seen, in place of the direction
        store(unit(along(v, -dot(v, c), c)), c)
    tangents(c, a, b)
    for i in range(3):
        basis[i, 0], basis[i, 1], basis[i, 2] = a[i], b[i], c[i]
    return Frame(kind, anchor, basis, rho, min_distance(points, anchor, centre, half))


@small_kernel
def fill_anchor(leak, frame, form, slopes):
    """Fill the anchor's form and its derivatives, exactly zero where they vanish, however strong it is."""
    form[:], slopes[:, :] = 0.0, 0.0
    form[0] = form[1] = 1.0 / (frame.radius_m * frame.radius_m)
    form[2] = leak * form[0]
    for i in range(3):
        slopes[i, 0] = slopes[i, 1] = 2.0 * frame.basis[i, 2] * form[0] / frame.radius_m
        slopes[i, 2] = leak * slopes[i, 0]


@kernel
def expand_point(family, j, is_above, frame, centre, half, form, slopes):
    """Fill the form of point j at the centre and its derivative along each world axis.

    Points with a turn of their own are looked at in the frame at rest only.

    Returns a bound on its second derivative along any unit direction, anywhere in the box: from above if
    ``is_above`` says so, else on minus it; and one on that of the link vector. For the anchor of a frame
    that turns towards it the first holds on the first two axes, and multiplied by the leak on the third, as
    the form does.
    """
    a = min_distance(family.points_m, j, centre, half)
    field = amplitude(family, j, is_above, centre, half)
    reach = scaled_inverse(field, a)
    if frame.kind == TOWARDS_POINT and j == frame.anchor:
        fill_anchor(family.leak, frame, form, slopes)
        bend = rise_of(reach, reach) if is_above else anchor_fall(field, a)
    else:
        fill_form(family, j, frame, centre, form, slopes)
        seen = turned(reach, 1.0 / frame.least_radius_m) if frame.kind == TOWARDS_POINT else reach
        bend, reach = rise_of(reach, seen) if is_above else fall_of(seen), seen
    scale_form(family.channels, field, form, slopes)
    return bend, reach.bend


@small_kernel
def scale_form(channels, field, form, slopes):
    """Multiply a form and its derivatives by the square of an amplitude."""
    if channels.shape[0] > 0:
        for k in range(6):
            for i in range(3):
                slopes[i, k] *= field.value * field.value
                slopes[i, k] += 2.0 * field.value * field.gradient[i] * form[k]
            form[k] *= field.value * field.value


@small_kernel
def fill_form(family, j, frame, centre, form, slopes):
    """Fill the form of point j, without its channel's excess, and its derivatives."""
    turn, leak = family.turn, family.leak
    bent = 1.0 - leak
    x, y, z = seen_from(family.points_m, turn, j, centre, frame.basis)
    basis, turns = turn[j] if turn.shape[0] > 0 else frame.basis, frame.kind == TOWARDS_POINT
    rate = 1.0 / frame.radius_m
    i2 = 1.0 / (x * x + y * y + z * z)
    i4 = i2 * i2
    form[0] = (leak * x * x + y * y + z * z) * i4
    form[1] = (x * x + leak * y * y + z * z) * i4
    form[2] = (x * x + y * y + leak * z * z) * i4
    b4 = bent * i4
    form[3], form[4], form[5] = -x * y * b4, -x * z * b4, -y * z * b4
    for i in range(3):
        q0, q1, q2 = basis[i, 0], basis[i, 1], basis[i, 2]
        u, v, w = -q0, -q1, -q2
        if turns:
            u += q0 * z * rate
            v += q1 * z * rate
            w -= (q1 * y + q0 * x) * rate
        dot = x * u + y * v + z * w
        k = 4.0 * dot * b4 * i2
        base = -2.0 * dot * i4
        slopes[i, 0] = base - 2.0 * x * u * b4 + k * x * x
        slopes[i, 1] = base - 2.0 * y * v * b4 + k * y * y
        slopes[i, 2] = base - 2.0 * z * w * b4 + k * z * z
        slopes[i, 3] = -(x * v + y * u) * b4 + k * x * y
        slopes[i, 4] = -(x * w + z * u) * b4 + k * x * z
        slopes[i, 5] = -(y * w + z * v) * b4 + k * y * z


@small_kernel
def reach_of_link(family, j, is_above, centre, half):
    """Return the reach of point j's link vector over a box, in a frame at rest."""
    field = amplitude(family, j, is_above, centre, half)
    return scaled_inverse(field, min_distance(family.points_m, j, centre, half))


@inner_kernel
def expand_once(family, j, is_above, frame, centre, half, workspace):
    """Fill link j's form, its slopes and the bounds of ``expand_point``, unless the box's are there."""
    side, form, slopes = (1.0 if is_above else -1.0), workspace.forms[j], workspace.form_slopes[j]
    if workspace.expanded_side[j] != side:
        bends = expand_point(family, j, is_above, frame, centre, half, form, slopes)
        workspace.bends[j, 0], workspace.bends[j, 1] = bends
        workspace.expanded_side[j] = side


@small_kernel
def best_frame(family, is_horizontal, row, sums):
    """Return the frame in which a sum's remainders are smallest, and the point that it turns towards.

    A frame that turns spares us the remainder of the point that it turns towards, and makes all others
    larger: worth it where one interferer outweighs the rest.
    """
    points, centre, half = family.points_m, row[CENTRE:HALF], row[HALF:LEVEL]
    anchor = strongest_point(family, centre)
    if anchor < 0 or family.turn.shape[0] > 0 or is_horizontal:
        return WORLD, anchor
    rho = min_distance(points, anchor, centre, half)
    if family.ground_axes.shape[0] > 0:
        rho *= _WITH_DIPOLES
    if isotropic_share(family.ground_leaks, anchor) < 1.0:
        # the nearer to its own null, the faster its form turns
        away = minus(row_of(points, anchor), centre)
        rho *= norm(cross(family.ground_axes[anchor], away)) / norm(away)
        if not rho > 0.0:
            return WORLD, anchor
    still = turning = 0.0
    for j in range(sums.shape[0]):
        weight = abs(sums[j])
        if weight > 0.0:
            reach = reach_of_link(family, j, sums[j] > 0.0, centre, half)
            seen = turned(reach, 1.0 / rho)
            if sums[j] > 0.0:
                still += weight * rise_of(reach, reach)
                turning += weight * rise_of(reach, seen)
            else:
                still += weight * fall_of(reach)
                turning += weight * fall_of(seen) if j != anchor else 0.0
    return (TOWARDS_POINT if turning < still else WORLD), anchor
