"""What one page's camera sees: aimed until a hand moves it, with labels that do not overlap."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from viser import ClientHandle

from nullpose.physics import rotation_world_from_body
from nullpose.studio.camera import CARD_PX, aim, around
from nullpose.studio.eye import Eye
from nullpose.studio.labels import Labels
from nullpose.studio.session import Session

_LOOKED_S = 0.25  # between two arrangements of the labels while the camera moves


class Sight:
    """The camera and the labels of one page.

    Args:
        client: the browser.
        session: whose scene it is.
        lock: under which the page changes.
        is_dragging: returns whether a hand drags a point; meanwhile no label is moved.
        face: called with where the camera stands, (3,) metres, a little after it has moved.

    Attributes:
        labels: of the page.
        aimed: whether the camera has been aimed at the scene with its drone.
    """

    def __init__(
        self,
        client: ClientHandle,
        session: Session,
        lock: threading.RLock,
        is_dragging: Callable[[], bool],
        face: Callable[[ArrayLike], None],
    ) -> None:
        self._client, self._session, self._lock = client, session, lock
        self._is_dragging, self._face = is_dragging, face
        self._fit: Eye | None = None
        self._way: tuple[Any, ...] | None = None
        self._moved: threading.Timer | None = None
        self._open = True
        self.labels, self.aimed = Labels(client.scene), False

    def aim(self) -> None:
        """Let the camera look at the whole of the scene."""
        view = self._session.view
        answer = self._session.current(view.case)
        self.aimed = answer is not None
        with self._client.atomic():
            self._fit = aim(self._client.camera, view.scenario, answer.result.pose if answer else None)

    def go_round(self, turn_rad: float) -> None:
        """Let the camera see points and drone from a side, whatever a hand has done with it.

        Args:
            turn_rad: from the south to that side, anticlockwise, radians.
        """
        view, camera = self._session.view, self._client.camera
        answer, canvas = self._session.answer(view.case), (camera.image_width, camera.image_height)
        if self._way is None or self._way[:3] != (view.scenario, answer, canvas):
            seen = around(camera, view.scenario, answer.result.pose if answer else None)
            self._way = view.scenario, answer, canvas, seen
        eye, foot_m = self._way[3]
        turn = rotation_world_from_body(0.0, 0.0, turn_rad)
        with self._client.atomic():
            camera.position, camera.look_at = (foot_m + turn @ end for end in eye[:2])

    def arrange(self) -> None:
        """Put the labels where they do not overlap; aim again if only the canvas has another size now."""
        with self._lock, self._client.atomic():
            if not self._open or self._is_dragging():
                return
            eye = Eye.of(self._client.camera)
            if self._fit is not None and eye.is_resized(self._fit):  # the panel has come, or gone
                self.aim()
                eye = self._fit
            self._face(eye.position_m)
            (width_px, height_px), cases = CARD_PX, len(self._session.view.cases)
            self.labels.arrange(eye, np.array([[0.0, 0.0, width_px, cases * height_px]]))

    def enlarge(self, factor: float) -> None:
        """Show the labels larger.

        Args:
            factor: how much; 1 for the usual size.
        """
        with self._lock, self._client.atomic():
            self.labels.enlarge(factor)
            self.arrange()

    def close(self) -> None:
        """Arrange nothing more."""
        self._open = False
        if self._moved is not None:
            self._moved.cancel()

    async def looked(self, _: object) -> None:
        """Arrange the labels a little after the camera has moved; viser calls it."""
        if self._moved is None or not self._moved.is_alive():
            self._moved = threading.Timer(_LOOKED_S, self.arrange)
            self._moved.daemon = True
            self._moved.start()
