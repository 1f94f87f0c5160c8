"""What one page draws in 3-D: ground, map and drones, with its camera and its labels."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from nullpose.studio.carpet import Carpet
from nullpose.studio.drone import LINK_RANGE_DB, Drone
from nullpose.studio.field_map import MAPS, FieldMap
from nullpose.studio.look import Look
from nullpose.studio.overlay import Scale
from nullpose.studio.readout import drone_text
from nullpose.studio.scene import Ground, OnDrag, scene_size_m
from nullpose.studio.session import Session
from nullpose.studio.sight import Seen, Sight
from nullpose.studio.view import Key

if TYPE_CHECKING:
    from viser import ClientHandle

_OTHER_SIZE = (0.6, 1.7)  # a scene that much smaller or larger is drawn anew, at its own size


class Stage:
    """The 3-D part of one page.

    Args:
        client: the browser.
        session: whose scene it is.
        look: the page's colours.
        lock: under which the page changes.
        on_drag: called with a point's key, its new position and the phase of the drag.

    Attributes:
        ground: what the scenario states.
        sight: camera and labels.
        scale: the map that is shown and its colours, or None.
        size_m: of the scene as it is drawn, metres.
        link_range_db: ends of the links' colours, dB.
    """

    def __init__(
        self, client: ClientHandle, session: Session, look: Look, lock: threading.RLock, on_drag: OnDrag
    ) -> None:
        self._client, self._session = client, session
        self.sight = Sight(client, lock, self._seen, self._face)
        labels = self.sight.labels
        self.ground = Ground(client.scene, labels, on_drag, look)
        self._carpet = Carpet(client.scene, labels, look)
        self._drones = [Drone(client.scene, labels, slot, look) for slot in (0, 1)]
        self._map_shown: tuple[FieldMap | None, str] = (None, "")
        self.scale: Scale | None = None
        self.size_m = np.inf
        self.link_range_db = LINK_RANGE_DB

    def show(self, *, chosen_map: str, selected: Key | None, freed: bool, pattern: bool) -> None:
        """Draw the session's view and what is known of it.

        Args:
            chosen_map: which map, one of ``MAPS``, or any other for none.
            selected: the point that has arrows to drag it by, or None.
            freed: whether it can be dragged off its altitude.
            pattern: whether the radiation patterns are shown.
        """
        session, view = self._session, self._session.view
        size_m = scene_size_m(view.scenario)
        if not _OTHER_SIZE[0] < size_m / self.size_m < _OTHER_SIZE[1]:
            self.size_m = size_m
        answer = session.current(view.case)
        self.ground.show(view, answer, self.size_m, selected=selected, freed=freed)
        self._show_map(chosen_map)
        if not self.sight.aimed:
            self.sight.aim()  # first, since the pattern is open towards the camera
        for slot, drone in enumerate(self._drones):
            answer = session.answer(view.cases[slot]) if slot < len(view.cases) else None
            if answer is None or len(answer.result.links) != len(view.scenario.nodes):
                drone.hide()
                continue
            eye_m = np.array(self._client.camera.position)
            shown = drone_text(session, slot), self.size_m, self.link_range_db, eye_m
            drone.show(answer, *shown, pattern=pattern)
        self.sight.arrange()

    def _show_map(self, name: str) -> None:
        maps = self._session.field_map
        if (maps, name) == self._map_shown:
            return
        self._map_shown = (maps, name)
        field = None if maps is None else maps.named(name)
        if field is None:
            self._carpet.hide()
            self.scale = None
            return
        ends, of_value = self._carpet.show(field), name == MAPS[0]
        if of_value and field.unit == "dB":
            self.link_range_db = ends
        self.scale = Scale(field=field, ends=ends, of_value=of_value, links_db=self.link_range_db)

    def _face(self, eye_m: ArrayLike) -> None:
        for drone in self._drones:
            drone.face(eye_m)

    def _seen(self) -> Seen:
        view = self._session.view
        answer = self._session.current(view.case)
        pose = answer.result.pose if answer else None
        return Seen(view.scenario, pose, len(view.cases), self.ground.dragged is None)
