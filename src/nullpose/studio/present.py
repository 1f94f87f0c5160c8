"""Present mode: the panel is folded, the labels are larger, and the camera goes slowly around the scene."""

from __future__ import annotations

import math
import threading
import time

import numpy as np
from viser import ClientHandle

from nullpose.studio.sight import Sight

ENLARGED = 1.5
"""How much larger the labels are in present mode."""

_STEP_S = 0.05
_TURN_RAD_S = math.tau / 60.0  # once around in a minute


class Present:
    """What a page does while it is presented.

    Args:
        client: the browser.
        sight: its camera and labels.
    """

    def __init__(self, client: ClientHandle, sight: Sight) -> None:
        self._client, self._sight = client, sight
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
            # on a phone they would not fit beside each other
            self._sight.enlarge(min(ENLARGED, max(1.1, self._client.camera.image_width / 500.0)))
            self._ended.clear()
            self._thread = threading.Thread(target=self._go_round, name="nullpose-studio-camera", daemon=True)
            self._thread.start()

    def end(self) -> None:
        """Give the page back as it was, the camera where it is."""
        if self.close():
            self._client.gui.main_panel.expand()
            self._sight.enlarge(1.0)

    def close(self) -> bool:
        """Return whether the camera was going, which ends; the browser, which may be gone, is not told."""
        thread, self._thread = self._thread, None
        if thread is not None:
            self._ended.set()
            thread.join(1.0)
        return thread is not None

    def _go_round(self) -> None:
        camera, began = self._client.camera, time.monotonic()
        east_m, north_m, _ = np.subtract(camera.position, camera.look_at)
        first_rad = math.atan2(north_m, east_m) + math.pi / 2.0  # from the south
        while not self._ended.wait(_STEP_S):
            self._sight.go_round(first_rad + _TURN_RAD_S * (time.monotonic() - began))
