"""Present mode: the panel is folded, the labels are larger, and the camera goes slowly around the scene."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable

import numpy as np
from viser import ClientHandle

from nullpose.physics import rotation_world_from_body

ENLARGED = 1.5
"""How much larger the labels are in present mode."""

_STEP_S = 0.05
_TURN_RAD_S = math.tau / 60.0  # once around in a minute


class Present:
    """What a page does while it is presented.

    Args:
        client: the browser.
        enlarge: called with how large the labels are to be.
    """

    def __init__(self, client: ClientHandle, enlarge: Callable[[float], None]) -> None:
        self._client, self._enlarge = client, enlarge
        self._ended = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def is_on(self) -> bool:
        """Whether the page is presented now."""
        return self._thread is not None

    def toggle(self) -> None:
        """Begin, or end."""
        (self.end if self.is_on else self.begin)()

    def begin(self) -> None:
        """Fold the panel, enlarge the labels, and set the camera going."""
        if self._thread is None:
            self._client.gui.main_panel.minimize()
            self._enlarge(ENLARGED)
            self._ended.clear()
            self._thread = threading.Thread(target=self._go_round, name="nullpose-studio-camera", daemon=True)
            self._thread.start()

    def end(self) -> None:
        """Give the page back as it was, the camera where it is."""
        if self.close():
            self._client.gui.main_panel.expand()
            self._enlarge(1.0)

    def close(self) -> bool:
        """Return whether the camera was going, which ends; the browser, which may be gone, is not told."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._ended.set()
            thread.join(1.0)
        return thread is not None

    def _go_round(self) -> None:
        camera, began = self._client.camera, time.monotonic()
        middle_m, first_m = np.array(camera.look_at), np.array(camera.position)
        while not self._ended.wait(_STEP_S):
            turn = rotation_world_from_body(0.0, 0.0, _TURN_RAD_S * (time.monotonic() - began))
            with self._client.atomic():
                camera.position, camera.look_at = middle_m + turn @ (first_m - middle_m), middle_m
