"""What a scene is drawn with, as data: frames, meshes without shadows, lines and labels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from nullpose.studio.look import linear_colours
from nullpose.studio.meshes import Mesh
from nullpose.studio.state import Key

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


def frame(position_m: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None) -> Shape:
    """Describe a frame that others are part of.

    Args:
        position_m: (3,) metres.
        rotation: (3, 3); None for the parent's axes.
    """
    values = {"show_axes": False, "position": np.asarray(position_m)}
    if rotation is not None:
        values["wxyz"] = np.roll(Rotation.from_matrix(np.asarray(rotation)).as_quat(), 1)  # real part first
    return Shape("frame", values)


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
    import trimesh

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
    points, colours = np.asarray(segments_m, dtype=np.float32), np.asarray(colour, dtype=np.uint8)
    return Shape(
        "line_segments",
        {"points": points, "colors": colours, "thickness": thickness, "thickness_units": units},
    )


def label(text: str, position_m: ArrayLike, scale: float = 0.9, anchor: str = "bottom-center") -> Shape:
    """Describe a label.

    Args:
        text: what it says.
        position_m: (3,) in the frame that it is part of, metres.
        scale: of its letters.
        anchor: the part of it that is at that place.
    """
    style = {"font_screen_scale": scale, "anchor": anchor}
    return Shape("label", {"text": text, "position": np.asarray(position_m, dtype=float)} | style)
