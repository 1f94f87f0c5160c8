"""The boxes of a proof in a page's scene: those that are open at each gap."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.scenario import Scenario
from nullpose.solver.proof_steps import ProofStep
from nullpose.studio.drawing import FLAT, put
from nullpose.studio.meshes import Mesh
from nullpose.studio.scene import ground_m

if TYPE_CHECKING:
    from viser import SceneApi

BOXES = "/proof"
"""Where they are in the scene's tree."""

BOX_COLOUR = (214, 51, 132)
"""A pink that stands out from all else in the scene, on light ground and on dark."""

MOST_BOXES = 4_000
"""How many boxes of a step are drawn without a graphics card."""

MOST_BOXES_BY_CARD = 20_000
"""How many are drawn with one."""

_UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0], dtype=np.float32)
_EDGE = 0.003  # width of a box's edges, of the size of what is drawn
_EDGES = (0.03, 0.1, 0.5)  # the same, of the box's sides; with the last it is solid


def drawn_airspace_m(scenario: Scenario) -> NDArray[np.float64]:
    """Return the lowest and the highest corner of the airspace as far as it is drawn, (2, 3) metres.

    Args:
        scenario: the scene.
    """
    (low, high), airspace = ground_m(scenario), scenario.airspace
    return np.array(
        [np.maximum(airspace.lower_m, [*low, 0.0]), np.minimum(airspace.upper_m, [*high, np.inf])]
    )


class Replay:
    """The boxes of a proof in a scene; see :meth:`show`.

    There is one batch of boxes for each width of edges, whose places and sizes are set anew at each step.

    Args:
        scene: the page's scene.
        within_m: (2, 3) corners, metres; what of a box is outside is not drawn.
        most: how many boxes of a step are drawn, the largest of them.
    """

    def __init__(self, scene: SceneApi, within_m: NDArray[np.float64], most: int = MOST_BOXES) -> None:
        self._within_m, self._most = within_m, most
        self._batches = [_batch(scene, edge) for edge in _EDGES]

    def show(self, step: ProofStep) -> None:
        """Draw the boxes that are open at a step.

        Args:
            step: of the proof.
        """
        least, most = self._within_m
        low, high = (
            np.maximum(step.centre_m - step.half_m, least),
            np.minimum(step.centre_m + step.half_m, most),
        )
        seen = np.all(high >= low, axis=1)
        side, middle = (high - low)[seen], (0.5 * (low + high))[seen]
        largest = np.argsort(-np.max(side, axis=1), kind="stable")[: self._most]
        side, middle = side[largest], middle[largest]
        edge = _EDGE * float(np.max((most - least)[:2])) / np.maximum(np.max(side, axis=1, initial=0.0), 1e-9)
        widest = np.searchsorted(np.sqrt(np.multiply(_EDGES[1:], _EDGES[:-1])), edge)
        for i, batch in enumerate(self._batches):
            own = widest == i
            if np.any(own):
                batch.batched_wxyzs = np.tile(_UPRIGHT, (int(np.sum(own)), 1))
                batch.batched_positions = middle[own].astype(np.float32)
                batch.batched_scales = np.maximum(side[own], 1e-6).astype(np.float32)
            put(batch, visible=bool(np.any(own)))


def _batch(scene: SceneApi, edge: float) -> Any:
    """Return the handle of boxes with edges of a width; of none as yet."""
    frame, one = _frame_mesh(edge), np.zeros((1, 3), dtype=np.float32)
    return scene.add_batched_meshes_simple(
        f"{BOXES}/{edge:g}",
        frame.vertices.astype(np.float32),
        frame.faces.astype(np.uint32),
        batched_wxyzs=_UPRIGHT[None],
        batched_positions=one,
        batched_scales=one,
        batched_colors=BOX_COLOUR,
        lod="off",
        side="double",
        visible=False,
        **FLAT,
    )


def _frame_mesh(edge: float) -> Mesh:
    """Return the edges of a cube of side 1 about the origin: on each face a border of a width."""
    ring = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]) / 2.0
    flat = np.vstack([ring, (1.0 - 2.0 * edge) * ring])
    band = [face for i, k in ((0, 1), (1, 2), (2, 3), (3, 0)) for face in ((i, k, k + 4), (i, k + 4, i + 4))]
    faces = [np.insert(flat, axis, side, axis=1) for axis in range(3) for side in (-0.5, 0.5)]
    triangles = np.vstack([np.array(band) + 8 * number for number in range(6)])
    return Mesh(np.vstack(faces), triangles)
