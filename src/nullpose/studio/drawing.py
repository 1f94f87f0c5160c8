"""What everything in a page's scene is drawn with: meshes without shadows, lines and labels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from nullpose.studio.look import linear_colours
from nullpose.studio.meshes import Mesh

if TYPE_CHECKING:
    from viser import SceneApi

FLAT = {"cast_shadow": False, "receive_shadow": False}
"""Shadows took half of the time of a picture without a graphics card."""


def add_mesh(scene: SceneApi, name: str, mesh: Mesh, colour: ArrayLike, **style: Any) -> Any:
    """Return the handle of a mesh added to a scene.

    Args:
        scene: the page's scene.
        name: its place in the scene's tree.
        mesh: vertices and triangles.
        colour: red, green, blue.
        style: more of what viser takes.
    """
    vertices, faces = mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)
    return scene.add_mesh_simple(
        name, vertices, faces, color=np.asarray(colour, dtype=np.uint8), **FLAT, **style
    )


def add_coloured_mesh(scene: SceneApi, name: str, mesh: Mesh, colours: ArrayLike) -> Any:
    """Return the handle of a mesh added to a scene, seen from both sides, with a colour at each vertex.

    Args:
        scene: the page's scene.
        name: its place in the scene's tree.
        mesh: vertices and triangles.
        colours: (n, 3) red, green, blue in sRGB.
    """
    import trimesh

    # without a material of its own the surface is of metal, which is dark where nothing is mirrored
    matt = trimesh.visual.material.PBRMaterial(metallicFactor=0.0, roughnessFactor=1.0, doubleSided=True)
    visual = trimesh.visual.TextureVisuals(material=matt)
    opaque = np.full((len(mesh.vertices), 1), 255, dtype=np.uint8)
    visual.vertex_attributes["color"] = np.hstack([linear_colours(colours), opaque])
    surface = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False, visual=visual)
    _ = surface.vertex_normals  # once asked for they are sent; without them every triangle is seen
    return scene.add_mesh_trimesh(name, surface, **FLAT)


def add_lines(
    scene: SceneApi,
    name: str,
    segments_m: ArrayLike,
    colour: ArrayLike,
    thickness: float,
    units: Literal["screen", "world"] = "screen",
) -> Any:
    """Return the handle of lines added to a scene.

    Args:
        scene: the page's scene.
        name: its place in the scene's tree.
        segments_m: (n, 2, 3) their ends, metres.
        colour: (3,) red, green, blue; or (n, 2, 3), that of each end, which is in linear light.
        thickness: on the screen, pixels, or in the world, metres.
        units: which of the two.
    """
    points = np.asarray(segments_m, dtype=np.float32)
    colours = np.asarray(colour, dtype=np.uint8)
    return scene.add_line_segments(name, points, colours, thickness=thickness, thickness_units=units)


def add_label(
    scene: SceneApi,
    name: str,
    text: str,
    position_m: ArrayLike,
    scale: float = 0.9,
    anchor: str = "bottom-center",
) -> Any:
    """Return the handle of a label added to a scene.

    Args:
        scene: the page's scene.
        name: its place in the scene's tree.
        text: what it says.
        position_m: (3,) in the frame that it is part of, metres.
        scale: of its letters.
        anchor: the part of it that is at that place.
    """
    position = np.asarray(position_m, dtype=float)
    return scene.add_label(name, text, position=position, font_screen_scale=scale, anchor=anchor)


def put(handle: Any, **values: object) -> None:
    """Set what differs of a handle: what is set as it was would be sent all the same.

    Args:
        handle: of viser's.
        values: by their names.
    """
    for name, value in values.items():
        if getattr(handle, name) != value:
            setattr(handle, name, value)
