"""The links in the scene: beams from the drone to its nodes, brighter and wider the higher their SINR."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nullpose.solve import Result
from nullpose.studio.colours import linear_colours, scale_colours
from nullpose.studio.drawing import FLAT, add_lines, put
from nullpose.studio.look import Look
from nullpose.studio.meshes import revolved_mesh

if TYPE_CHECKING:
    from viser import SceneApi

_WIDTHS = (0.003, 0.005, 0.0075, 0.01)  # by the quarter of the colours' range, sizes of the scene
_OUTLINE = 0.0022  # beyond both sides of a beam, sizes of the scene
_ROOM = 16  # nodes
_NOWHERE = np.zeros((1, 2, 3))


class Links:
    """The beams of one drone.

    Args:
        scene: the page's scene.
        name: of the drone, its place in the scene's tree.
        look: the page's colours.
        size_m: of the scene, from which the beams' widths follow.
    """

    def __init__(self, scene: SceneApi, name: str, look: Look, size_m: float) -> None:
        self._widths_m = size_m * np.array(_WIDTHS)
        self._outline_m = size_m * _OUTLINE
        self._beams = [
            add_lines(scene, f"{name}/links-{i}", _NOWHERE, _NOWHERE, width_m, units="world")
            for i, width_m in enumerate(self._widths_m)
        ]
        self._scene, self._name, self._colour, self._room = scene, f"{name}/links-outline", look.outline, 0

    def _make_room(self, count: int) -> None:
        """Have outlines for so many beams: a batch that grows in the browser is not drawn there."""
        if count <= self._room:
            return
        self._room = max(_ROOM, 2 * count)
        tube, still = revolved_mesh([1.0, 1.0], [0.0, 1.0], 10), np.array([1.0, 0.0, 0.0, 0.0])
        # its far side, which is seen beside the beam inside it: the beam stands out on a map of its colour
        self._outline = self._scene.add_batched_meshes_simple(
            self._name,
            tube.vertices.astype(np.float32),
            tube.faces.astype(np.uint32),
            np.tile(still, (self._room, 1)),
            np.zeros((self._room, 3)),
            batched_scales=np.full((self._room, 3), 1e-6),
            batched_colors=self._colour,
            side="back",
            lod="off",
            **FLAT,
        )

    def show(self, result: Result, range_db: tuple[float, float]) -> None:
        """Draw the links of a result.

        Args:
            result: pose and links.
            range_db: ends of the colours, dB.
        """
        self._make_room(len(result.links))
        sinr_db = np.array([link.sinr_db for link in result.links])
        nodes, here = result.scenario.node_positions_m, result.pose.position_m
        ends = np.stack([nodes, np.broadcast_to(here, nodes.shape)], axis=1).astype(np.float32)
        colours = np.repeat(linear_colours(scale_colours(sinr_db, *range_db))[:, None], 2, axis=1)
        quarter = np.digitize(sinr_db, np.linspace(*range_db, len(_WIDTHS) + 1)[1:-1])
        for i, beams in enumerate(self._beams):
            own = quarter == i
            put(beams, visible=bool(own.any()))
            if beams.visible:
                beams.points, beams.colors = ends[own], colours[own]
        radius_m = 0.5 * self._widths_m[quarter] + self._outline_m
        way = ends[:, 1] - ends[:, 0]
        length_m = np.linalg.norm(way, axis=1)
        self._outline.batched_positions = ends[:, 0]
        self._outline.batched_wxyzs = _turned_up(way / np.maximum(length_m, 1e-9)[:, None])
        self._outline.batched_scales = np.stack([radius_m, radius_m, length_m], axis=-1).astype(np.float32)


def _turned_up(ways: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return rotations as unit quaternions, (n, 4), that turn the z axis onto unit vectors, (n, 3)."""
    x, y, z = ways.T
    half = np.stack([np.maximum(1.0 + z, 1e-6), -y, x, 0.0 * z], axis=-1)
    turned: NDArray[np.float32] = half / np.linalg.norm(half, axis=1, keepdims=True)
    return turned
