"""What holds at the corners of a cell of errors, and how a ratio bends between (docs/robust.md, lemma 4)."""

from __future__ import annotations

import math
from typing import NamedTuple

from nullpose.channel.model import EXPONENT
from nullpose.objectives import FloatArray
from nullpose.solver.kernels.bounds.constants import VECTOR_BEND, VECTOR_SLOPE
from nullpose.solver.kernels.bounds.error_cells import SLACK, ahead, axis_at, farthest
from nullpose.solver.kernels.bounds.link_field import Reach, distance_amplitude, times_amplitude
from nullpose.solver.kernels.compiler.jit import inner_kernel
from nullpose.solver.kernels.linear_algebra.channel import excess_in_sight
from nullpose.solver.kernels.linear_algebra.vectors import corner_of, cross, dot, minus, norm, row, scaled
from nullpose.solver.kernels.search.set_links import ROUND, has_dipole
from nullpose.solver.kernels.search.worst_case_links import strongest_link


class Corners(NamedTuple):
    """What holds at the corners of a cell: ``m`` of the axis, ``e`` of the offset."""

    values: FloatArray  # (m, e) F, from below
    sizes: FloatArray  # (m, e) the sizes of its terms
    cone: FloatArray  # (m,) G, negative outside the cone
    ball: FloatArray  # (e,) H, negative outside the ball of offsets
    across: FloatArray  # (n,) W_j, the largest |y x v_j|


@inner_kernel
def least_dipole_link(ratio, y, q):
    """Return the link of a node with a dipole for an axis y of any length, rounding taken off."""
    square, length, other = dot(q, q), norm(y), cross(ratio.dipole, q)
    both = max(0.0, abs(dot(cross(y, q), other)) - 4.0 * ROUND * length * square)
    leaking = max(0.0, norm(other) - ROUND * norm(q))
    link = (1.0 - ratio.leak) * both * both / square + ratio.leak * (length * leaking) ** 2
    return link / (square * square)


@inner_kernel
def link_reach(channels, j, q, near, far, is_dipole):
    """Return the reach of a link vector times the amplitude of its channel, between two distances.

    Args:
        channels: the rows, if there are any.
        j: which.
        q: of the point, or of the centre of its set.
        near: the least distance; in a channel by elevation the position is known.
        far: the largest.
        is_dipole: whether the vector is that of a dipole.
    """
    slope, bend = (VECTOR_SLOPE, VECTOR_BEND) if is_dipole else (1.0, 2.0)
    reach = Reach(1.0 / near, slope / near**2, bend / near**3)
    if channels.shape[0] > 0:
        if channels[j, EXPONENT] != 0.0:
            reach = times_amplitude(distance_amplitude(channels[j], q, near * near, far * far), reach)
        if near == far:
            reach = Reach(math.sqrt(excess_in_sight(channels[j], q)) / near, reach.slope, reach.bend)
    return reach


@inner_kernel
def evaluate_corners(ratio, weight, errors, level, cell, tolerance, corners):
    """Fill what holds at the corners; return False near a jammer. The node's weight is 0 if left out.

    With an infinite tolerance F is what is attained, not what it is at least.
    """
    n_axes, n_offsets = corners.values.shape
    for e in range(n_offsets):
        offset = corner_of(cell.d, cell.d_half, e)
        node = minus(ratio.node, offset)
        strength = weight
        if ratio.sets.channels.shape[0] > 0:  # the node's is the last
            strength *= excess_in_sight(ratio.sets.channels[ratio.shares.shape[0]], node)
        corners.ball[e] = errors.reach**2 - dot(offset, offset)
        for m in range(n_axes):
            x = corner_of(cell.x, cell.x_half, 2 * m)
            y, square, length = axis_at(errors, cell.face, x), dot(x, x), norm(x)
            corners.cone[m] = x[ahead(cell.face)] ** 2 - errors.cosine**2 * square
            signal, noise = ratio.isotropic * square, square
            if weight > 0.0 and has_dipole(ratio.dipole):
                signal += strength * least_dipole_link(ratio, y, node)
            elif weight > 0.0:
                rounding = ROUND * length * norm(node)
                across = max(0.0, norm(cross(y, node)) - rounding) / dot(node, node)
                leaking = max(0.0, abs(dot(y, node)) - rounding) / dot(node, node)
                signal += strength * (across * across + ratio.leak * leaking * leaking)
            for j in range(ratio.shares.shape[0]):
                q = minus(row(ratio.centres, j), offset)
                found, root, _ = strongest_link(
                    ratio.sets, j, scaled(1.0 / length, y), q, ratio.leak, tolerance
                )
                root = root if tolerance < math.inf else found
                if not root < math.inf:
                    return False
                noise += ratio.shares[j] * (length * root) ** 2
                before = corners.across[j] if e + m > 0 else 0.0
                corners.across[j] = max(before, length * root)
            corners.values[m, e] = signal - level * noise
            corners.sizes[m, e] = signal + level * noise
    return True


@inner_kernel
def curvatures(ratio, channels, weight, level, cell, across):
    """Return lemma 4's A, B and C; infinite unless the cell keeps clear of all sets."""
    lean, swing, length = norm(cell.x_half), norm(cell.d_half), norm(farthest(cell.x, cell.x_half))
    n, q = ratio.shares.shape[0], minus(ratio.node, cell.d)
    near, far = norm(q) - swing if weight > 0.0 else math.inf, norm(q) + swing
    node = link_reach(channels, n, q, near, far, has_dipole(ratio.dipole))
    a = 2.0 * max(0.0, ratio.isotropic - level + weight * node.length**2)
    b = 4.0 * weight * length * node.length * node.slope
    c = 2.0 * weight * length**2 * (node.slope**2 + node.length * node.bend)
    for j in range(n):
        q = minus(row(ratio.centres, j), cell.d)
        near = norm(q) - ratio.sets.radii[j] - swing
        if not near > 0.0:
            return math.inf, math.inf, math.inf
        far = norm(q) + ratio.sets.radii[j] + swing
        reach = link_reach(channels, j, q, near, far, has_dipole(row(ratio.sets.dipoles, j)))
        most = across[j] + lean * reach.length + swing * length * reach.slope  # no corner is farther off
        part = 2.0 * level * ratio.shares[j] * most
        b += part * reach.slope
        c += part * length * reach.bend
    return a, b, c


@inner_kernel
def least_corner(corners, nu, mu):
    """Return the least of ``F - nu G - mu H`` at the corners, rounding taken off."""
    least = math.inf
    for m in range(corners.values.shape[0]):
        for e in range(corners.values.shape[1]):
            cone, ball = corners.cone[m], corners.ball[e]
            rounding = SLACK * (corners.sizes[m, e] + nu * (1.0 + abs(cone)) + mu * abs(ball))
            least = min(least, corners.values[m, e] - nu * cone - mu * ball - rounding)
    return least
