"""What a scene is drawn with, as data: frames, lines, labels, and triangles where the physics says."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Literal, NamedTuple

import numpy as np
import shapely
import trimesh
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation
from shapely.geometry.base import BaseGeometry

from nullpose.antenna import AnyAntenna
from nullpose.physics import rotation_world_from_body
from nullpose.studio.look import linear_colours
from nullpose.studio.state import Key

_SAME_AXES = np.eye(3)


class Mesh(NamedTuple):
    """A surface of triangles.

    Args:
        vertices: (n, 3) metres.
        faces: (m, 3) indices of vertices, counter-clockwise seen from outside.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]

    def placed(self, matrix: ArrayLike = _SAME_AXES, offset_m: ArrayLike = 0.0) -> Mesh:
        """Return the shape with ``A v + b`` in place of each vertex.

        Args:
            matrix: A, (3, 3).
            offset_m: b, (3,) metres.
        """
        return Mesh(self.vertices @ np.transpose(matrix) + np.asarray(offset_m), self.faces)


def merged(meshes: Iterable[Mesh]) -> Mesh:
    """Return several shapes as one.

    Args:
        meshes: at least one.
    """
    return Mesh(*trimesh.util.append_faces(*zip(*meshes, strict=True)))


def revolved_mesh(radius_m: ArrayLike, height_m: ArrayLike, around: int, open_rad: float = 0.0) -> Mesh:
    """Return the surface that a line in the x-z plane makes about the z axis.

    Args:
        radius_m: (n,) distances of the line's points from the axis, metres; outside is to the right of the
            way from the first to the last.
        height_m: (n,) their heights, metres.
        around: steps about the axis.
        open_rad: angle that is left out, its middle along x, radians.
    """
    surface = trimesh.creation.revolve(
        np.column_stack([radius_m, height_m]), math.tau - open_rad, sections=around, process=False
    )
    return Mesh(surface.vertices, surface.faces).placed(rotation_world_from_body(0.0, 0.0, 0.5 * open_rad))


def sphere_mesh(rings: int = 16, around: int = 24, open_rad: float = 0.0) -> Mesh:
    """Return the sphere of radius one.

    Args:
        rings: steps from pole to pole.
        around: steps about the z axis.
        open_rad: angle about z that is left out, its middle along x, radians.
    """
    gamma = np.linspace(0.0, math.pi, rings + 1)
    return revolved_mesh(np.sin(gamma), -np.cos(gamma), around, open_rad)


def pattern_mesh(
    antenna: AnyAntenna, rings: int, around: int, open_rad: float = 0.0, towards_rad: float = 0.0
) -> tuple[Mesh, NDArray[np.float64]]:
    """Return the surface of a pattern in the antenna's axes, and each vertex's gain over the largest.

    That gain is the distance.

    Args:
        antenna: whose pattern it is.
        rings: steps from pole to pole.
        around: steps about the z axis.
        open_rad: angle about z that is left out, so that the inside is seen, radians.
        towards_rad: azimuth of the middle of that angle, radians.
    """
    directions, faces = sphere_mesh(rings, around, open_rad).placed(
        rotation_world_from_body(0.0, 0.0, towards_rad)
    )
    gain = relative_gain(antenna, directions)
    return Mesh(gain[:, None] * directions, faces), gain


def relative_gain(antenna: AnyAntenna, directions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the gain over its largest, shape (n,).

    Args:
        antenna: any.
        directions: (n, 3) unit vectors in the antenna's axes.
    """
    if not antenna.is_quadratic:
        return np.maximum(0.0, antenna.gain(directions)) / antenna.peak
    return np.asarray(antenna.gain(1.0 - np.minimum(1.0, directions[:, 2] ** 2)))


def level_mesh(area_m: BaseGeometry, height_m: float = 0.0) -> Mesh:
    """Return a level surface, whole or in parts, seen from above.

    Args:
        area_m: shapely's polygon, or several, metres.
        height_m: where it is, metres.
    """
    corners = [
        shapely.get_coordinates(triangle)[:3]
        for triangle in shapely.orient_polygons(shapely.constrained_delaunay_triangles(area_m)).geoms
    ]
    return Mesh(_raised(np.vstack(corners), height_m), np.arange(3 * len(corners)).reshape(-1, 3))


def prism_mesh(area_m: shapely.Polygon, low_m: float, high_m: float) -> Mesh:
    """Return an upright solid's walls, floor and ceiling.

    Args:
        area_m: its outline, with what is open inside it, metres.
        low_m: its floor, metres.
        high_m: its ceiling, metres.
    """
    area, ends = shapely.orient_polygons(area_m), (low_m, high_m)
    floor, ceiling = (level_mesh(area, height_m) for height_m in ends)
    walls = [_wall_mesh(np.asarray(ring.coords), ends) for ring in (area.exterior, *area.interiors)]
    return merged([floor._replace(faces=floor.faces[:, ::-1]), ceiling, *walls])


def _wall_mesh(ring_m: NDArray[np.float64], ends_m: tuple[float, float]) -> Mesh:
    """Build the wall on a line that ends where it begins, (n, 2), its outside on the right."""
    below, count = np.arange(len(ring_m) - 1), len(ring_m)
    return Mesh(
        np.vstack([_raised(ring_m, height_m) for height_m in ends_m]),
        np.add.outer(below, [[0, 1, count], [1, count + 1, count]]).reshape(-1, 3),
    )


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


def _four(mesh: Mesh) -> list[Mesh]:
    """Repeat a mesh along the x axis at the four arms, half-way between the axes."""
    return [
        mesh.placed(rotation_world_from_body(0.0, 0.0, math.radians(angle)))
        for angle in (45.0, 135.0, 225.0, 315.0)
    ]


_SLANT = np.array(
    [[1.0, 0.0, math.sqrt(2.0)], [0.0, math.sqrt(3.0), 0.0], [-math.sqrt(2.0), 0.0, 1.0]]
) / math.sqrt(3.0)

MARKS = {
    **dict.fromkeys(("nodes", "destinations"), prism_mesh(shapely.box(-0.5, -0.5, 0.5, 0.5), 0.0, 1.0)),
    "jammers": merged(_four(_tube(0.22, -1.15, 1.15, 8).placed(_SLANT, [0.0, 0.0, 0.8]))),
    "eavesdroppers": revolved_mesh([0.0, 0.8, 0.0], [0.0, 1.0, 2.0], 4),
    "sources": revolved_mesh([0.0, 0.8, 0.0], [0.0, 0.0, 1.6], 4),
}
"""On the origin: a cube, a cross of four diagonals (an X from every side), an octahedron, a pyramid."""

_HULL = shapely.Polygon([(0.42, 0.0), (0.2, 0.26), (-0.34, 0.26), (-0.34, -0.26), (0.2, -0.26)])
_ARM = prism_mesh(shapely.box(0.0, -0.05, 1.0, 0.05), -0.02, 0.06)

BODY = merged(
    [
        prism_mesh(_HULL, -0.08, 0.12),
        *_four(merged([_ARM, _tube(0.09, -0.05, 0.16).placed(offset_m=[1.0, 0.0, 0.0])])),
        *(_tube(0.03, -0.42, -0.05, 8).placed(offset_m=[0.0, y, 0.0]) for y in (-0.3, 0.3)),
    ]
)
"""A multirotor's hull, four arms, motors and legs, x forward and z up; one from its middle to a motor."""

ROTORS = merged(_four(_tube(0.52, 0.17, 0.19, 28).placed(offset_m=[1.0, 0.0, 0.0])))
"""The four rotors' discs of the same body."""

ROD = _tube(0.022, -0.5, 0.5, 12)
"""The antenna: a rod of length one along z through the origin."""


FLAT = {"cast_shadow": False, "receive_shadow": False}
"""Shadows took half of the time of a picture without a graphics card."""


class Shape(NamedTuple):
    """What stands at a name of a scene's tree.

    Args:
        kind: of viser's methods the one that adds it, without its ``add_``.
        values: its arguments.
        key: of the point that it is the body of, by which a hand can drag it.
    """

    kind: str
    values: Mapping[str, object]
    key: Key | None = None


Shapes = dict[str, Shape]
"""All or a part of a scene, by the names in its tree."""


def frame(position_m: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike = _SAME_AXES) -> Shape:
    """Describe a frame that others are part of.

    Args:
        position_m: (3,) metres.
        rotation: (3, 3) in the parent's axes.
    """
    wxyz = np.roll(Rotation.from_matrix(np.asarray(rotation)).as_quat(), 1)  # real part first
    return Shape("frame", {"show_axes": False, "position": np.asarray(position_m), "wxyz": wxyz})


def mesh(surface: Mesh, colour: ArrayLike, **style: object) -> Shape:
    """Describe a mesh.

    Args:
        surface: vertices and triangles.
        colour: red, green, blue.
        style: more of what viser takes.
    """
    arrays = {"vertices": surface.vertices.astype(np.float32), "faces": surface.faces.astype(np.uint32)}
    return Shape("mesh_simple", arrays | {"color": tuple(np.asarray(colour).tolist())} | FLAT | style)


def coloured_mesh(surface: Mesh, colours: ArrayLike) -> Shape:
    """Describe a mesh that is seen from both sides, with a colour at each vertex.

    Args:
        surface: vertices and triangles.
        colours: (n, 3) red, green, blue in sRGB.
    """
    # without a material of its own the surface is of metal, which is dark where nothing is mirrored
    matt = trimesh.visual.material.PBRMaterial(metallicFactor=0.0, roughnessFactor=1.0, doubleSided=True)
    visual = trimesh.visual.TextureVisuals(material=matt)
    visual.vertex_attributes["color"] = np.insert(linear_colours(colours), 3, 255, axis=1)  # opaque
    coloured = trimesh.Trimesh(surface.vertices, surface.faces, process=False, visual=visual)
    _ = coloured.vertex_normals  # once asked for they are sent; without them every triangle is seen
    return Shape("mesh_trimesh", {"mesh": coloured} | FLAT)


def lines(
    segments_m: ArrayLike, colour: ArrayLike, thickness: float, units: Literal["screen", "world"] = "screen"
) -> Shape:
    """Describe lines.

    Args:
        segments_m: (n, 2, 3) their ends, metres.
        colour: (3,) red, green, blue; or (n, 2, 3), that of each end, which is in linear light.
        thickness: on the screen, pixels, or in the world, metres.
        units: which of the two.
    """
    return Shape(
        "line_segments",
        {
            "points": np.asarray(segments_m, dtype=np.float32),
            "colors": np.asarray(colour, dtype=np.uint8),
            "thickness": thickness,
            "thickness_units": units,
        },
    )


def label(text: str, position_m: ArrayLike, scale: float = 0.9, anchor: str = "bottom-center") -> Shape:
    """Describe a label.

    Args:
        text: what it says.
        position_m: (3,) in the frame that it is part of, metres.
        scale: of its letters.
        anchor: the part of it that is at that place.
    """
    return Shape(
        "label",
        {
            "text": text,
            "position": np.asarray(position_m, dtype=float),
            "font_screen_scale": scale,
            "anchor": anchor,
        },
    )
