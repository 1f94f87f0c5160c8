"""Editing in a page: what is selected, what the next click on the ground does, what is typed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np
from viser import ClientHandle

from nullpose.studio.drawing import add_lines, put
from nullpose.studio.edits import (
    ADDED,
    Entry,
    entries_of,
    with_added,
    with_fence,
    with_typed,
    without,
)
from nullpose.studio.inspector import Inspector
from nullpose.studio.panel import FENCE, Panel
from nullpose.studio.picking import ground_place_m, picked
from nullpose.studio.readout import tool_html
from nullpose.studio.session import Session
from nullpose.studio.view import Key, View

_SKETCH = (213, 94, 0)
_CLOSE = 0.03  # of the scene's size: so near its first corner a click closes a fence
_FEWEST = 3
_HOW = "Click on the ground to place the {}. Escape ends it."
_FENCE_HOW = (
    "Click the corners of the fence on the ground; click the first one again to close it ({} so far)."
)


class Change(Protocol):
    """Changes the view, and returns whether it could be; if not, the faults are shown."""

    def __call__(self, change: Callable[[View], View], gesture: str = "", name: str = "The change") -> bool:
        """See the class."""


class Editor:
    """What a page edits besides dragging.

    Args:
        client: the browser.
        session: whose scene it is.
        panel: the page's panel.
        change: how the view is changed.
        refresh: draws the page anew.
        size_m: returns the size of the scene as it is drawn, metres.

    Attributes:
        selected: the point or zone whose values are shown, or None.
    """

    def __init__(
        self,
        client: ClientHandle,
        session: Session,
        panel: Panel,
        change: Change,
        refresh: Callable[[], None],
        size_m: Callable[[], float],
    ) -> None:
        self._client, self._session, self._panel = client, session, panel
        self._change, self._refresh, self._size_m = change, refresh, size_m
        self.selected: Key | None = None
        self._tool = ""
        self._corners: list[Any] = []
        self._own = Inspector(client.gui, panel.own_values, lambda texts: self._typed(self.selected, texts))
        self._vehicle = Inspector(client.gui, panel.vehicle_values, lambda texts: self._typed(None, texts))
        panel.add.on_click(lambda event: self.begin(event.target.value))
        panel.delete.on_click(lambda event: self.delete())

        async def clicked(event: Any) -> None:  # in order, since it runs in the loop
            self._clicked(np.array(event.ray_origin), np.array(event.ray_direction))

        client.scene.on_click()(clicked)

    def show(self, view: View) -> None:
        """Show the values of what is selected, and of the vehicle.

        Args:
            view: the view now.
        """
        panel, key = self._panel, self.selected
        if key is not None and key[1] >= len(view.members(key[0])):
            key = self.selected = None
        entries: tuple[Entry, ...] = () if key is None else entries_of(view, key)
        put(panel.own_values, visible=bool(entries))
        if entries:
            put(panel.own_values, label=f"Selected: {entries[0].text}")
        self._own.show(entries)
        self._vehicle.show(entries_of(view, None))
        told = _FENCE_HOW.format(len(self._corners)) if self._tool == FENCE else _HOW.format(self._tool)
        put(panel.tool, content=tool_html(told if self._tool else ""))

    def begin(self, tool: str) -> None:
        """Take up a tool, or none, which selects nothing either.

        Args:
            tool: what is to be added; empty for nothing.
        """
        self._tool, self.selected = tool, None
        self._sketch([])
        self._refresh()

    def _clicked(self, eye_m: Any, way: Any) -> None:
        size_m, tool = self._size_m(), self._tool  # which another thread may end meanwhile
        place_m = ground_place_m(size_m, eye_m, way)
        if not tool:
            self.selected = picked(self._session.view, size_m, eye_m, way)
        elif place_m is None:
            return
        elif tool == FENCE:
            self._corner(place_m, size_m)
        elif self._change(lambda view: with_added(view, tool, place_m, size_m), name="The new point"):
            self.selected = ADDED[tool], len(self._session.view.members(ADDED[tool])) - 1
            self._tool = ""
        self._refresh()

    def _corner(self, place_m: Any, size_m: float) -> None:
        corners = self._corners
        closes = len(corners) >= _FEWEST and np.linalg.norm(place_m - corners[0]) < _CLOSE * size_m
        if not closes:
            self._sketch([*corners, place_m])
        elif self._change(lambda view: with_fence(view, corners), name="The fence"):
            self.begin("")

    def _sketch(self, corners: list[Any]) -> None:
        """Draw the fence as far as it is drawn by now."""
        self._corners, size_m = corners, self._size_m()
        self._client.scene.remove_by_name("/sketch")
        if corners:
            points = np.insert(np.array(corners), 2, 0.003 * size_m, axis=1)
            first = points[0] + 0.012 * size_m * np.array([[[-1, 0, 0], [1, 0, 0]], [[0, -1, 0], [0, 1, 0]]])
            lines = np.concatenate([first, np.stack([points[:-1], points[1:]], axis=1)])
            add_lines(self._client.scene, "/sketch", lines, _SKETCH, 4.0)

    def delete(self) -> None:
        """Take what is selected out of the scene."""
        key = self.selected
        if key is not None and self._change(lambda view: without(view, key), name="Deleting"):
            self.selected = None
            self._refresh()

    def _typed(self, key: Key | None, texts: dict[str, str]) -> None:
        entries = entries_of(self._session.view, key)
        self._change(lambda view: with_typed(view, entries, texts), name="What was typed")
