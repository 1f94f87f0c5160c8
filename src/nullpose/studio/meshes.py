"""Shapes of the scene: triangles where the physics says, and as large."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.antenna import Antenna
from nullpose.physics import Pose
from nullpose.problem.airspace import convex_parts


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
        factor = np.asarray(matrix, dtype=float)
        turned = self.vertices @ factor.T if factor.ndim else factor * self.vertices
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


def revolved_mesh(radius_m: ArrayLike, height_m: ArrayLike, around: int, open_rad: float = 0.0) -> Mesh:
    """Return the surface that a line in the x-z plane makes about the z axis.

    Args:
        radius_m: (n,) distances of the line's points from the axis, metres; outside is to the right of the
            way from the first to the last.
        height_m: (n,) their heights, metres.
        around: steps about the axis.
        open_rad: angle that is left out, its middle along x, radians.
    """
    radius, height = np.asarray(radius_m, dtype=float), np.asarray(height_m, dtype=float)
    ends = 0.5 * open_rad, math.tau - 0.5 * open_rad
    azimuth = np.linspace(*ends, around + (open_rad > 0.0), endpoint=open_rad > 0.0)
    x, y = np.outer(radius, np.cos(azimuth)), np.outer(radius, np.sin(azimuth))
    vertices = np.stack([x, y, np.broadcast_to(height[:, None], x.shape)], axis=-1).reshape(-1, 3)
    index = np.arange(len(vertices)).reshape(x.shape)
    beside = np.roll(index, -1, axis=1)
    steps = slice(around)  # which lead back to the first if nothing is left out
    a, b, c, d = index[:-1, steps], beside[:-1, steps], index[1:, steps], beside[1:, steps]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([b, d, c], -1).reshape(-1, 3)])
    return Mesh(vertices, faces)


def pattern_mesh(
    antenna: Antenna,
    radius_m: float,
    rings: int,
    around: int,
    *,
    open_rad: float = 0.0,
    towards_rad: float = 0.0,
) -> tuple[Mesh, NDArray[np.float64]]:
    """Return the surface of a pattern in the antenna's axes, and each vertex's gain over the largest.

    The distance is that gain times the radius.

    Args:
        antenna: whose pattern it is.
        radius_m: where the gain is largest, metres.
        rings: steps from pole to pole.
        around: steps about the z axis.
        open_rad: angle about z that is left out, so that the inside is seen, radians.
        towards_rad: azimuth of the middle of that angle, radians.
    """
    gamma = np.linspace(0.0, math.pi, rings + 1)
    c, s = math.cos(towards_rad), math.sin(towards_rad)
    turn = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]]
    sphere = revolved_mesh(np.sin(gamma), -np.cos(gamma), around, open_rad).placed(turn)
    gain = relative_gain(antenna, sphere.vertices)
    return Mesh(radius_m * gain[:, None] * sphere.vertices, sphere.faces), gain


def relative_gain(antenna: Antenna, directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the gain over its largest, shape (n,).

    Args:
        antenna: any.
        directions: (n, 3) unit vectors in the antenna's axes.
    """
    if not antenna.is_quadratic:
        return np.maximum(0.0, antenna.gain(directions)) / antenna.peak
    return np.asarray(antenna.gain(1.0 - np.minimum(1.0, directions[:, 2] ** 2)))


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


def prism_edges(
    outline_m: ArrayLike, low_m: float, high_m: float, most_posts: int = 12
) -> NDArray[np.float64]:
    """Return the edges of an upright solid, (n, 2, 3): both its ends, and some of its upright edges.

    Args:
        outline_m: (n, 2) vertices, metres.
        low_m: its floor, metres.
        high_m: its ceiling, metres.
        most_posts: upright edges at most; a circle has many vertices.
    """
    outline = np.asarray(outline_m, dtype=float)
    loops = [_raised(outline, height_m) for height_m in (low_m, high_m)]
    ends = [np.stack([loop, np.roll(loop, -1, axis=0)], axis=1) for loop in loops]
    return np.concatenate([*ends, np.stack(loops, axis=1)[:: -(-len(outline) // most_posts)]])


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
    """Repeat a mesh along the x axis at the four arms, half-way between the axes."""
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


def beam_mesh(start_m: ArrayLike, end_m: ArrayLike, half_angle_rad: float, around: int = 40) -> Mesh:
    """Return a cone that widens from one point to another, without an end.

    Args:
        start_m: (3,) its tip, metres.
        end_m: (3,) the middle of its end, metres.
        half_angle_rad: between its axis and its surface, radians.
        around: steps about its axis.
    """
    start, along = np.asarray(start_m, dtype=float), np.subtract(end_m, start_m)
    radius_m = math.tan(half_angle_rad) * float(np.linalg.norm(along))
    across = np.linalg.svd(along[None])[2][1:]  # two unit vectors across it
    azimuth = np.linspace(0.0, math.tau, around, endpoint=False)
    ring = start + along + radius_m * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1) @ across
    i = np.arange(1, around + 1)
    return Mesh(np.vstack([start, ring]), np.stack([np.zeros_like(i), i, i % around + 1], axis=-1))
