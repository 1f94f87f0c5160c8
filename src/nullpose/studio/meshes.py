"""Shapes of the scene: triangles where the physics says, and as large."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import PatternAntenna, QuadraticAntenna
from nullpose.family.convex import convex_parts
from nullpose.physics import Pose
from nullpose.report.geometry import outline_m
from nullpose.scenario import NoFlyZone


class Mesh(NamedTuple):
    """A surface of triangles.

    Args:
        vertices: (n, 3) metres.
        faces: (m, 3) indices of vertices, counter-clockwise seen from outside.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]

    def placed(self, matrix: ArrayLike = 1.0, offset_m: ArrayLike = 0.0) -> Mesh:
        """Return the shape with ``A v + b`` in place of each vertex.

        Args:
            matrix: A, (3, 3), or a number that scales.
            offset_m: b, (3,) metres.
        """
        given = np.asarray(matrix, dtype=float)
        turned = self.vertices @ given.T if given.ndim else given * self.vertices
        return Mesh(turned + np.asarray(offset_m, dtype=float), self.faces)


def merged(meshes: Iterable[Mesh]) -> Mesh:
    """Return several shapes as one.

    Args:
        meshes: at least one.
    """
    vertices, faces = zip(*meshes, strict=True)
    starts = np.cumsum([0, *map(len, vertices[:-1])])
    return Mesh(
        np.vstack(vertices), np.vstack([face + start for face, start in zip(faces, starts, strict=True)])
    )


def revolved_mesh(radius_m: ArrayLike, height_m: ArrayLike, around: int) -> Mesh:
    """Return the surface that a line in the x-z plane makes about the z axis.

    Args:
        radius_m: (n,) distances of the line's points from the axis, metres; outside is to the right of the
            way from the first to the last.
        height_m: (n,) their heights, metres.
        around: steps about the axis.
    """
    radius, height = np.asarray(radius_m, dtype=float), np.asarray(height_m, dtype=float)
    azimuth = np.linspace(0.0, math.tau, around, endpoint=False)
    x, y = np.outer(radius, np.cos(azimuth)), np.outer(radius, np.sin(azimuth))
    vertices = np.stack([x, y, np.broadcast_to(height[:, None], x.shape)], axis=-1).reshape(-1, 3)
    here = np.arange(len(vertices)).reshape(x.shape)
    beside = np.roll(here, -1, axis=1)
    a, b, c, d = here[:-1], beside[:-1], here[1:], beside[1:]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([b, d, c], -1).reshape(-1, 3)])
    return Mesh(vertices, faces)


def doughnut_mesh(antenna: QuadraticAntenna, radius_m: float, gamma_rad: ArrayLike, around: int) -> Mesh:
    """Return the antenna's pattern about the z axis: the distance is the gain times the radius.

    Args:
        antenna: whose pattern it is.
        radius_m: where the gain is 1, metres.
        gamma_rad: (n,) angles from the lower end of the axis at which it is drawn, growing, radians.
        around: steps about the axis.
    """
    gamma = np.asarray(gamma_rad, dtype=float)
    distance = radius_m * antenna.gain(np.sin(gamma) ** 2)
    return revolved_mesh(distance * np.sin(gamma), -distance * np.cos(gamma), around)


def pattern_mesh(antenna: PatternAntenna, radius_m: float, rings: int = 60, around: int = 96) -> Mesh:
    """Return the surface of any pattern in the antenna's axes: the distance is the gain over its largest.

    Args:
        antenna: whose pattern it is.
        radius_m: where the gain is largest, metres.
        rings: steps from pole to pole.
        around: steps about the z axis.
    """
    gamma = np.linspace(0.0, math.pi, rings + 1)
    sphere = revolved_mesh(np.sin(gamma), -np.cos(gamma), around)
    gain = np.maximum(0.0, antenna.gain(sphere.vertices)) / antenna.peak
    return Mesh(radius_m * gain[:, None] * sphere.vertices, sphere.faces)


def doughnut_bands(
    antenna: QuadraticAntenna, radius_m: float, bands: int = 10, around: int = 32
) -> list[tuple[Mesh, float]]:
    """Return the antenna's pattern in bands, each with the gain in its middle.

    Args:
        antenna: whose pattern it is.
        radius_m: where the gain is 1, metres.
        bands: how many.
        around: steps about the axis.
    """
    ends = np.arcsin(np.sqrt(np.linspace(0.0, 1.0, bands + 1)))
    parts = []
    for band, (low, high) in enumerate(pairwise(ends)):
        below = np.linspace(low, high, 4)
        halves = [doughnut_mesh(antenna, radius_m, gamma, around) for gamma in (below, math.pi - below[::-1])]
        parts.append((merged(halves), float(antenna.gain((band + 0.5) / bands))))
    return parts


def ellipsoid_mesh(matrix_m: ArrayLike, rings: int = 16, around: int = 24) -> Mesh:
    """Return the surface ``{A x : |x| = 1}``.

    Args:
        matrix_m: A, (3, 3), metres.
        rings: steps from pole to pole.
        around: steps about the pole.
    """
    gamma = np.linspace(0.0, math.pi, rings + 1)
    return revolved_mesh(np.sin(gamma), -np.cos(gamma), around).placed(matrix_m)


def prism_mesh(outline_m: ArrayLike, low_m: float, high_m: float) -> Mesh:
    """Return an upright solid's walls, floor and ceiling; its outline may be any simple polygon.

    Args:
        outline_m: (n, 2) vertices, counter-clockwise, metres.
        low_m: its floor, metres.
        high_m: its ceiling, metres.
    """
    outline = np.asarray(outline_m, dtype=float)
    n, i = len(outline), np.arange(len(outline))
    k = (i + 1) % n
    walls = np.concatenate([np.stack([i, k, k + n], -1), np.stack([i, k + n, i + n], -1)])
    parts = [Mesh(np.vstack([_raised(outline, low_m), _raised(outline, high_m)]), walls)]
    for part in convex_parts(outline):
        fan = np.array([(0, j, j + 1) for j in range(1, len(part) - 1)])
        parts += [Mesh(_raised(part, low_m), fan[:, ::-1]), Mesh(_raised(part, high_m), fan)]
    return merged(parts)


def _raised(outline_m: NDArray[np.float64], height_m: float) -> NDArray[np.float64]:
    return np.column_stack([outline_m, np.full(len(outline_m), height_m)])


def zone_mesh(zone: NoFlyZone, low_m: float, high_m: float) -> Mesh:
    """Return a no-fly zone as far as it lies between two altitudes.

    Args:
        zone: box, cylinder or polygon.
        low_m: lowest altitude drawn, metres.
        high_m: highest altitude drawn, metres.
    """
    floor_m = max(low_m, zone.floor_m)
    ceiling_m = max(floor_m, min(high_m, zone.ceiling_m))
    return prism_mesh(outline_m(zone), floor_m, ceiling_m)


def _tube(radius_m: float, bottom_m: float, top_m: float, around: int = 16) -> Mesh:
    return revolved_mesh([0.0, radius_m, radius_m, 0.0], [bottom_m, bottom_m, top_m, top_m], around)


MARKS = {
    "nodes": prism_mesh([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], 0.0, 1.0),
    "jammers": revolved_mesh([0.0, 0.75, 0.0], [0.0, 0.0, 2.0], 20),
    "eavesdroppers": revolved_mesh([0.0, 0.8, 0.0], [0.0, 1.0, 2.0], 4),
}
"""A cube, a spike and an octahedron of size one that stand on the origin."""

_HULL = [[0.42, 0.0], [0.2, 0.26], [-0.34, 0.26], [-0.34, -0.26], [0.2, -0.26]]
_ARM = [[0.0, -0.05], [1.0, -0.05], [1.0, 0.05], [0.0, 0.05]]


def body_mesh(size_m: float) -> Mesh:
    """Return a multirotor's hull, four arms, motors and legs, x forward and z up in its body frame.

    Args:
        size_m: from its middle to a motor, metres.
    """
    arm = merged([prism_mesh(_ARM, -0.02, 0.06), _tube(0.09, -0.05, 0.16).placed(offset_m=[1.0, 0.0, 0.0])])
    legs = [_tube(0.03, -0.42, -0.05, 8).placed(offset_m=[0.0, y, 0.0]) for y in (-0.3, 0.3)]
    return merged([prism_mesh(_HULL, -0.08, 0.12), *_four(arm), *legs]).placed(size_m)


def rotor_mesh(size_m: float) -> Mesh:
    """Return the four rotors' discs in the body frame.

    Args:
        size_m: from the body's middle to a motor, metres.
    """
    return merged(_four(_tube(0.52, 0.17, 0.19, 28).placed(offset_m=[1.0, 0.0, 0.0]))).placed(size_m)


def _four(mesh: Mesh) -> list[Mesh]:
    """Return what is drawn along the x axis at the four arms, half-way between the axes."""
    c = math.sqrt(0.5)
    first = mesh.placed([[c, -c, 0.0], [c, c, 0.0], [0.0, 0.0, 1.0]])
    return [
        first.placed([[x, -y, 0.0], [y, x, 0.0], [0.0, 0.0, 1.0]])
        for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))
    ]


def rod_mesh(length_m: float) -> Mesh:
    """Return the antenna: a rod along z through the origin.

    Args:
        length_m: its whole length, metres.
    """
    return _tube(0.022, -0.5, 0.5, 12).placed(length_m)


def null_line_m(pose: Pose, up_m: float, most_m: float = 1e3) -> NDArray[np.float64]:
    """Return the ends, (2, 3), of the null's line: above the drone, and where it meets the ground.

    Args:
        pose: where the drone is, and its attitude.
        up_m: how far it is drawn above the drone, metres.
        most_m: how far it is drawn at most, metres.
    """
    axis = pose.antenna_axis * (1.0 if pose.antenna_axis[2] >= 0.0 else -1.0)
    down_m = min(most_m, float(pose.position_m[2]) / axis[2]) if axis[2] > 1e-6 else most_m
    return np.stack([pose.position_m + up_m * axis, pose.position_m - down_m * axis])
