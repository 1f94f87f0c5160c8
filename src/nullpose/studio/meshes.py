"""Shapes as arrays: vertices (n, 3) in metres and triangles (m, 3), in the frame that each says."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.physics import Pose, rotation_world_from_body
from nullpose.scenario import NoFlyZone

__all__ = [
    "Mesh",
    "antenna_wxyz",
    "attitude_wxyz",
    "body_mesh",
    "box_mesh",
    "cone_mesh",
    "diamond_mesh",
    "doughnut_mesh",
    "ellipsoid_mesh",
    "gain_bands",
    "null_line_m",
    "prism_mesh",
    "rod_mesh",
    "rotor_mesh",
    "zone_mesh",
]

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """A surface of triangles.

    Args:
        vertices: (n, 3) metres.
        faces: (m, 3) indices of vertices, counter-clockwise seen from outside.
        values: (n,) a number at each vertex, for its colour; or None.
    """

    vertices: FloatArray
    faces: IntArray
    values: FloatArray | None = None

    def __add__(self, other: Mesh) -> Mesh:
        """Return both together, their values left out."""
        return Mesh(
            np.vstack([self.vertices, other.vertices]),
            np.vstack([self.faces, other.faces + len(self.vertices)]),
        )

    def moved(self, offset_m: ArrayLike) -> Mesh:
        """Return the shape shifted.

        Args:
            offset_m: (3,) metres.
        """
        return Mesh(self.vertices + np.asarray(offset_m, dtype=float), self.faces, self.values)

    def turned(self, rotation: ArrayLike) -> Mesh:
        """Return the shape turned about the origin.

        Args:
            rotation: (3, 3).
        """
        return Mesh(self.vertices @ np.asarray(rotation, dtype=float).T, self.faces, self.values)


def doughnut_mesh(radius_m: float, rings: int = 24, around: int = 32) -> Mesh:
    """Return the dipole's pattern about the z axis: the distance is ``radius sin^2(gamma)`` (paper eq. 1.2).

    Its values are the gain, 1 broadside and 0 at the null.

    Args:
        radius_m: where the gain is 1, metres.
        rings: steps from one end of the axis to the other.
        around: steps about the axis.
    """
    gamma, turn = np.meshgrid(
        np.linspace(0.0, math.pi, rings + 1),
        np.linspace(0.0, math.tau, around, endpoint=False),
        indexing="ij",
    )
    gain = np.sin(gamma) ** 2
    vertices = np.stack(
        [gain * np.sin(gamma) * np.cos(turn), gain * np.sin(gamma) * np.sin(turn), gain * np.cos(gamma)],
        axis=-1,
    )
    return Mesh(radius_m * vertices.reshape(-1, 3), _grid_faces(rings, around), gain.ravel())


def gain_bands(mesh: Mesh, bands: int = 10) -> list[tuple[Mesh, float]]:
    """Return a pattern cut into bands of like gain, each with the gain in its middle.

    Args:
        mesh: with the gain at its vertices.
        bands: how many.
    """
    if mesh.values is None:
        return [(mesh, 1.0)]
    middle = mesh.values[mesh.faces].mean(axis=1)
    index = np.minimum((bands * middle).astype(int), bands - 1)
    parts = []
    for band in np.unique(index):
        used, faces = np.unique(mesh.faces[index == band], return_inverse=True)
        part = Mesh(mesh.vertices[used], faces.reshape(-1, 3), mesh.values[used])
        parts.append((part, (float(band) + 0.5) / bands))
    return parts


def _grid_faces(rings: int, around: int) -> IntArray:
    i, j = np.meshgrid(np.arange(rings), np.arange(around), indexing="ij")
    k = (j + 1) % around
    a, b, c, d = i * around + j, i * around + k, (i + 1) * around + j, (i + 1) * around + k
    return np.concatenate([np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)])


def ellipsoid_mesh(matrix_m: ArrayLike, rings: int = 16, around: int = 24) -> Mesh:
    """Return the surface ``{A x : |x| = 1}``.

    Args:
        matrix_m: A, (3, 3), metres.
        rings: steps from pole to pole.
        around: steps about the pole.
    """
    gamma, turn = np.meshgrid(
        np.linspace(0.0, math.pi, rings + 1),
        np.linspace(0.0, math.tau, around, endpoint=False),
        indexing="ij",
    )
    unit = np.stack([np.sin(gamma) * np.cos(turn), np.sin(gamma) * np.sin(turn), np.cos(gamma)], axis=-1)
    return Mesh(unit.reshape(-1, 3), _grid_faces(rings, around)).turned(matrix_m)


def prism_mesh(outline_m: ArrayLike, low_m: float, high_m: float) -> Mesh:
    """Return an upright solid's walls, floor and ceiling; its outline may be any simple polygon.

    Args:
        outline_m: (n, 2) vertices, counter-clockwise, metres.
        low_m: its floor, metres.
        high_m: its ceiling, metres.
    """
    outline = np.asarray(outline_m, dtype=float)
    n = len(outline)
    vertices = np.vstack([np.column_stack([outline, np.full(n, z)]) for z in (low_m, high_m)])
    i = np.arange(n)
    k = (i + 1) % n
    walls = np.concatenate([np.stack([i, k, k + n], -1), np.stack([i, k + n, i + n], -1)])
    caps = _ears(outline)
    return Mesh(vertices, np.concatenate([walls, caps[:, ::-1], caps + n]))


def _ears(outline: FloatArray) -> IntArray:
    """Return triangles that fill a simple counter-clockwise polygon, one corner cut off after the other."""
    left = list(range(len(outline)))
    triangles = []
    while len(left) > 3:
        for i in range(len(left)):
            a, b, c = left[i - 1], left[i], left[(i + 1) % len(left)]
            others = [outline[k] for k in left if k not in (a, b, c)]
            if _turn(outline[a], outline[b], outline[c]) > 0.0 and not any(
                _inside(other, outline[a], outline[b], outline[c]) for other in others
            ):
                triangles.append((a, b, c))
                del left[i]
                break
        else:  # corners in line with each other
            del left[0]
    return np.array([*triangles, tuple(left)], dtype=np.int64)


def _turn(a: FloatArray, b: FloatArray, c: FloatArray) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _inside(point: FloatArray, a: FloatArray, b: FloatArray, c: FloatArray) -> bool:
    return min(_turn(a, b, point), _turn(b, c, point), _turn(c, a, point)) >= 0.0


def zone_mesh(zone: NoFlyZone, low_m: float, high_m: float) -> Mesh:
    """Return a no-fly zone as far as it lies between two altitudes.

    Args:
        zone: box, cylinder or polygon.
        low_m: lowest altitude drawn, metres.
        high_m: highest altitude drawn, metres.
    """
    if zone.centre_m is not None and zone.radius_m is not None:
        turn = np.linspace(0.0, math.tau, 48, endpoint=False)
        outline = np.asarray(zone.centre_m) + zone.radius_m * np.column_stack([np.cos(turn), np.sin(turn)])
    else:
        outline = zone.outline_m
    floor_m = max(low_m, zone.floor_m)
    return prism_mesh(outline, floor_m, max(floor_m, min(high_m, zone.ceiling_m)))


def _tube(radius_m: float, bottom_m: float, top_m: float, sides: int = 16) -> Mesh:
    turn = np.linspace(0.0, math.tau, sides, endpoint=False)
    return prism_mesh(radius_m * np.column_stack([np.cos(turn), np.sin(turn)]), bottom_m, top_m)


def box_mesh(size_m: float) -> Mesh:
    """Return a cube that stands on the origin: a node.

    Args:
        size_m: its edge, metres.
    """
    half = 0.5 * size_m
    return prism_mesh([[-half, -half], [half, -half], [half, half], [-half, half]], 0.0, size_m)


def cone_mesh(size_m: float) -> Mesh:
    """Return a spike that stands on the origin: a jammer.

    Args:
        size_m: half its height, metres.
    """
    turn = np.linspace(0.0, math.tau, 20, endpoint=False)
    rim = np.column_stack([0.75 * size_m * np.cos(turn), 0.75 * size_m * np.sin(turn), np.zeros(20)])
    i = np.arange(20)
    k = (i + 1) % 20
    faces = np.concatenate([np.stack([i, k, np.full(20, 20)], -1), np.stack([k, i, np.full(20, 21)], -1)])
    return Mesh(np.vstack([rim, [0.0, 0.0, 2.0 * size_m], [0.0, 0.0, 0.0]]), faces)


def diamond_mesh(size_m: float) -> Mesh:
    """Return an octahedron that stands on the origin: an eavesdropper.

    Args:
        size_m: half its height, metres.
    """
    r = 0.8 * size_m
    points = [[r, 0, 0], [0, r, 0], [-r, 0, 0], [0, -r, 0], [0, 0, size_m], [0, 0, -size_m]]
    faces = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]]
    return Mesh(np.array(points, dtype=float), np.array(faces)).moved([0.0, 0.0, size_m])


def body_mesh(size_m: float) -> Mesh:
    """Return a multirotor's hull, four arms, motors and legs, x forward and z up in its body frame.

    Args:
        size_m: from its middle to a motor, metres.
    """
    hull = prism_mesh(
        size_m * np.array([[0.42, 0.0], [0.2, 0.26], [-0.34, 0.26], [-0.34, -0.26], [0.2, -0.26]]),
        -0.08 * size_m,
        0.12 * size_m,
    )
    arm = prism_mesh(
        size_m * np.array([[0.0, -0.05], [1.0, -0.05], [1.0, 0.05], [0.0, 0.05]]),
        -0.02 * size_m,
        0.06 * size_m,
    )
    motor = _tube(0.09 * size_m, -0.05 * size_m, 0.16 * size_m).moved([size_m, 0.0, 0.0])
    whole = hull
    for quarter in range(4):
        turn = rotation_world_from_body(0.0, 0.0, math.pi / 4 + quarter * math.pi / 2)
        whole = whole + (arm + motor).turned(turn)
    for side in (-1.0, 1.0):
        leg = _tube(0.03 * size_m, -0.42 * size_m, -0.05 * size_m, 8)
        whole = whole + leg.moved([0.0, side * 0.3 * size_m, 0.0])
    return whole


def rotor_mesh(size_m: float) -> Mesh:
    """Return the four rotors' discs in the body frame.

    Args:
        size_m: from the body's middle to a motor, metres.
    """
    disc = _tube(0.52 * size_m, 0.17 * size_m, 0.19 * size_m, 28)
    away = size_m * math.sqrt(0.5)
    corners = [(away, away), (-away, away), (-away, -away), (away, -away)]
    first, *others = (disc.moved([x, y, 0.0]) for x, y in corners)
    for one in others:
        first = first + one
    return first


def rod_mesh(length_m: float) -> Mesh:
    """Return the antenna: a rod along z through the origin.

    Args:
        length_m: its whole length, metres.
    """
    return _tube(0.022 * length_m, -0.5 * length_m, 0.5 * length_m, 12)


def attitude_wxyz(pose: Pose) -> FloatArray:
    """Return the body's attitude as a quaternion, scalar first: ``Rz(yaw) Ry(pitch) Rx(roll)``.

    Args:
        pose: how the drone is turned.
    """
    return _wxyz(rotation_world_from_body(pose.roll_rad, pose.pitch_rad, pose.yaw_rad))


def antenna_wxyz(mount_rad: float) -> FloatArray:
    """Return the turn, within the body, that puts z along the antenna: about y by the mount angle.

    Args:
        mount_rad: angle of the antenna from the body's vertical, towards its x axis, radians.
    """
    return np.array([math.cos(0.5 * mount_rad), 0.0, math.sin(0.5 * mount_rad), 0.0])


def _wxyz(rotation: FloatArray) -> FloatArray:
    from scipy.spatial.transform import Rotation

    x, y, z, w = Rotation.from_matrix(rotation).as_quat()
    return np.array([w, x, y, z]) * (-1.0 if w < 0.0 else 1.0)


def null_line_m(pose: Pose, up_m: float, ground_m: float = 0.0, most_m: float = 1e3) -> FloatArray:
    """Return the ends, (2, 3), of the null's line: above the drone, and where it meets the ground.

    Args:
        pose: where the drone is and how it is turned.
        up_m: how far it is drawn above the drone, metres.
        ground_m: altitude of the ground, metres.
        most_m: how far it is drawn at most, metres.
    """
    axis = pose.antenna_axis * (1.0 if pose.antenna_axis[2] >= 0.0 else -1.0)
    height_m = float(pose.position_m[2]) - ground_m
    down_m = min(most_m, height_m / axis[2]) if axis[2] > 1e-6 else most_m
    return np.stack([pose.position_m + up_m * axis, pose.position_m - down_m * axis])
