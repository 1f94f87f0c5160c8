"""Labels that never overlap: of two in each other's way the one that matters more stays."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nullpose.studio.drawing import put
from nullpose.studio.eye import Eye

if TYPE_CHECKING:
    from viser import SceneApi

FloatArray = NDArray[np.float64]

ANCHORS = ("bottom-center", "center-left", "center-right", "top-center")
"""Parts of a label that can be at its place, the one that is tried first being the first."""

_EM_PX = 12.0  # viser's size of a letter at scale one
_HEIGHT_EM, _PAD_EM, _GAP_PX = 1.4, 0.25, 3.0
_NARROW, _WIDE = frozenset(" .,:;'!|()-iljtfrI"), frozenset("mwMW@%")
_NARROW_EM, _WIDE_EM, _LETTER_EM = 0.34, 0.95, 0.6


class Rank(IntEnum):
    """What a label is of; those of a smaller rank stay where two are in each other's way."""

    VALUE, WORST, JAMMER, POINT, NULL, ZONE, SCALE = range(7)


@dataclass(slots=True, eq=False)
class _Label:
    handle: Any
    place_m: FloatArray
    rank: Rank
    anchors: tuple[str, ...]
    scale: float


class Labels:
    """All labels of a page.

    Args:
        scene: the page's scene.
    """

    def __init__(self, scene: SceneApi) -> None:
        self._scene = scene
        self._all: dict[str, _Label] = {}
        self._larger = 1.0

    def put(
        self,
        name: str,
        text: str,
        place_m: ArrayLike,
        rank: Rank,
        *,
        scale: float = 0.9,
        anchors: tuple[str, ...] = ANCHORS[:1],
        offset_m: ArrayLike | None = None,
    ) -> None:
        """Show a label, or change the one of this name.

        Args:
            name: its place in the scene's tree.
            text: what it says.
            place_m: (3,) where it is in the world, metres.
            rank: what it is of.
            scale: of its letters.
            anchors: which parts of it may be at that place, the best first.
            offset_m: (3,) where it is in the frame that it is part of; None outside of all frames, metres.
        """
        position = np.array(place_m if offset_m is None else offset_m, dtype=float)
        label = self._all.get(name)
        if label is None:
            handle = self._scene.add_label(
                name, text, position=position, anchor=anchors[0], font_screen_scale=self._larger * scale
            )
            label = self._all[name] = _Label(handle, position, rank, anchors, scale)
        label.place_m, label.rank, label.scale = np.array(place_m, dtype=float), rank, scale
        put(label.handle, text=text, font_screen_scale=self._larger * scale)
        label.handle.position = position

    def enlarge(self, factor: float) -> None:
        """Show all labels larger, those to come too, and none of the scales where they are.

        Args:
            factor: how much; 1 for the usual size.
        """
        self._larger = factor
        for label in self._all.values():
            put(label.handle, font_screen_scale=factor * label.scale)

    def drop(self, prefix: str) -> None:
        """Take labels out of the scene.

        Args:
            prefix: how their names begin.
        """
        for name in [name for name in self._all if name.startswith(prefix)]:
            self._all.pop(name).handle.remove()

    def arrange(self, eye: Eye, taken: FloatArray | None = None) -> None:
        """Hide the labels that would be cut off or over one that matters more, or put them beside it.

        Args:
            eye: the camera.
            taken: (n, 4) left, upper, right and lower edges of what else is over the canvas, pixels.
        """
        taken = np.empty((0, 4)) if taken is None else taken
        canvas = [eye.width_px, eye.height_px, eye.width_px, eye.height_px]
        for label in sorted(self._all.values(), key=lambda one: one.rank):
            x, y, ahead = eye.pixels(label.place_m[None])[0]
            if not ahead > 0.0:
                continue
            boxes = {anchor: _box_px(label.handle, anchor, x, y) for anchor in label.anchors}
            whole = (a for a, box in boxes.items() if np.array_equal(box, np.clip(box, 0.0, canvas)))
            free = (a for a in whole if not _overlap(boxes[a], taken))
            anchor = None if label.rank is Rank.SCALE and self._larger > 1.0 else next(free, None)
            put(label.handle, visible=anchor is not None)
            if anchor is not None:
                put(label.handle, anchor=anchor)
                taken = np.vstack([taken, boxes[anchor]])


def _box_px(handle: Any, anchor: str, x: float, y: float) -> FloatArray:
    """Return a label's left, upper, right and lower edge on the canvas, as far as the font is known."""
    em = _EM_PX * handle.font_screen_scale
    letters = sum(
        _NARROW_EM if one in _NARROW else _WIDE_EM if one in _WIDE else _LETTER_EM for one in handle.text
    )
    size = em * np.array([letters + _PAD_EM, _HEIGHT_EM]) + _GAP_PX
    vertical, horizontal = anchor.split("-")
    share = {"left": 0.0, "top": 0.0, "center": 0.5, "right": 1.0, "bottom": 1.0}
    corner = np.array([x, y]) - size * [share[horizontal], share[vertical]]
    return np.concatenate([corner, corner + size])


def _overlap(box: FloatArray, others: FloatArray) -> bool:
    return bool(np.any(np.all((box[:2] < others[:, 2:]) & (others[:, :2] < box[2:]), axis=1)))
