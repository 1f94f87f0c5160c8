"""The link of a point that is known up to a set, and its slopes (docs/robust.md).

The link ``|y x q|^2 / |q|^4`` of a point at q is ``|y x v|^2`` with ``v = q / |q|^2``: the squared distance
of the inverted point from the line of the axis (lemma 1). An antenna with a leak l adds ``l (y.v)^2``. A
point with a dipole has ``(1 - l) (y.a)^2 + l |a|^2``, a being its link vector.
"""

from __future__ import annotations

from typing import NamedTuple

from nullpose.objectives import FloatArray
from nullpose.solver.kernels.compiler.jit import inner_kernel, small_kernel
from nullpose.solver.kernels.compiler.scratch import scratch
from nullpose.solver.kernels.linear_algebra.channel import excess_jet
from nullpose.solver.kernels.linear_algebra.vectors import along, cross, dot, scaled

ROUND = 4e-15  # of a cross product of two vectors, relative to the product of their lengths
ROUNDING = 1e-13  # of a bound: what its few operations may lose
ORIGIN = (0.0, 0.0, 0.0)


class Sets(NamedTuple):
    """The balls that points are known up to, about a centre each."""

    radii: FloatArray  # (n,)
    dipoles: FloatArray  # (n, 3) the axes of the dipoles there, zero where there is none
    channels: FloatArray  # (n + 1, WIDTH) rows of their channels and the node's; no row if all are free


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
    if channels.shape[0] > 0:
        slopes, bends = scratch(3), scratch(3, 3)
        gain = excess_jet(channels[j], q, slopes, bends)  # its slopes are by the position
        by_place = along(by_place, -link, (slopes[0], slopes[1], slopes[2]))
        return gain * link, scaled(gain, by_axis), scaled(gain, by_place)
    return link, by_axis, by_place
