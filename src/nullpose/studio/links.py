"""The links in the scene: beams from the drone to its nodes, brighter and wider the higher their SINR."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.solver import Result
from nullpose.studio.colours import linear_colours, scale_colours
from nullpose.studio.drawing import add_lines, add_mesh, put
from nullpose.studio.look import Look
from nullpose.studio.meshes import Mesh, merged, revolved_mesh

if TYPE_CHECKING:
    from viser import SceneApi

_WIDTHS = (0.003, 0.005, 0.0075, 0.01)  # by the quarter of the colours' range, sizes of the scene
_OUTLINE = 0.0022  # beyond both sides of a beam, sizes of the scene
_AROUND = 8  # sides of an outline
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
        self._scene, self._name, self._colour = scene, f"{name}/links-outline", look.outline
        self._outline: Any = None

    def _show_outlines(self, tubes: Mesh) -> None:
        """Draw the far sides of tubes, which are seen beside the beams inside them.

        One mesh, and no batch of instances: of those the browser misses a picture when their count changes.
        """
        if self._outline is None or len(self._outline.faces) != len(tubes.faces):
            self._outline = add_mesh(self._scene, self._name, tubes, self._colour, side="back")
        else:
            self._outline.vertices = tubes.vertices.astype(np.float32)

    def show(self, result: Result, range_db: tuple[float, float]) -> None:
        """Draw the links of a result.

        Args:
            result: pose and links.
            range_db: ends of the colours, dB.
        """
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
        self._show_outlines(_tubes(ends, 0.5 * self._widths_m[quarter] + self._outline_m))


def _tubes(ends_m: NDArray[np.float32], radius_m: NDArray[np.float64]) -> Mesh:
    """Return tubes around lines, (n, 2, 3), of radii, (n,), as one shape."""
    way = (ends_m[:, 1] - ends_m[:, 0]).astype(float)
    across = np.cross(
        way, np.where(np.abs(way[:, :1]) < np.abs(way[:, 1:2]), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    )
    across *= radius_m[:, None] / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    other = np.cross(way, across) / np.maximum(np.linalg.norm(way, axis=1, keepdims=True), 1e-9)
    tube = revolved_mesh([1.0, 1.0], [0.0, 1.0], _AROUND)
    turned = tube.vertices @ np.stack([across, other, way], axis=1)
    return merged(Mesh(one + start, tube.faces) for one, start in zip(turned, ends_m[:, 0], strict=True))
