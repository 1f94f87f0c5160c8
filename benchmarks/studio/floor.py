"""A page with a handle and a box that follows it, whose server answers at once: what any page would take."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from benchmarks.studio.drag import Marks
from nullpose.studio.opening import open_server

__all__ = ["empty_page"]

_TOLD = '<div data-np="numbers-0" data-version="{}"><div data-np="status-0">certified to {}</div></div>'


@contextmanager
def empty_page(marks: Marks) -> Iterator[tuple[str, Callable[[], Any], Any, Any]]:
    """Give an address, the camera of the page that is opened there, and from where to where to drag.

    Args:
        marks: where the server notes what it hears and answers.
    """
    server, address = open_server("127.0.0.1", 0)
    server.initial_camera.position, server.initial_camera.look_at = (60.0, -40.0, 45.0), (0.0, 0.0, 0.0)
    server.gui.main_panel.dock_right()
    told = server.gui.add_html(_TOLD.format(0, 0))
    handle = server.scene.add_transform_controls(
        "/handle", scale=8.0, line_width=3.0, disable_rotations=True, depth_test=False
    )
    box = server.scene.add_box("/box", dimensions=(2.0, 2.0, 2.0), cast_shadow=False, receive_shadow=False)
    version = 0

    async def on_update(event: Any) -> None:
        nonlocal version
        version += 1
        marks.heard.append((time.time(), version))
        place = event.target.position + np.array([0.0, 6.0, 0.0])
        marks.solved.append((time.time(), version, place))
        box.position = place
        told.content = _TOLD.format(version, event.target.position)
        server.flush()

    handle.on_update(on_update)
    try:
        grip = np.array([4.8, 0.0, 0.0])
        yield address, lambda: next(iter(server.get_clients().values())).camera, grip, 2.0 * grip
    finally:
        server.stop()
