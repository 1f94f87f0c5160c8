"""What is drawn of a session in 3-D, in a page and in an exported scene: ground, map and drones."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from viser import SceneApi

from nullpose.studio.carpet import Carpet
from nullpose.studio.drone import LINK_RANGE_DB, Drone
from nullpose.studio.field_map import MAPS, FieldMap
from nullpose.studio.look import Look
from nullpose.studio.overlay import Scale
from nullpose.studio.readout import drone_text
from nullpose.studio.scene import Ground, OnDrag, scene_size_m
from nullpose.studio.session import Session
from nullpose.studio.view import Key

_OTHER_SIZE = (0.6, 1.7)  # a scene that much smaller or larger is drawn anew, at its own size


class Stage:
    """All that is drawn of one session.

    Args:
        scene: of viser's.
        session: whose.
        look: the colours.
        on_drag: called with a point's key, its new position and the phase of the drag; None for a scene
            whose points are not dragged.

    Attributes:
        ground: what the scenario states.
        scale: the map that is shown and its colours, or None.
        size_m: of the scene as it is drawn, metres.
        link_range_db: ends of the links' colours, dB.
    """

    def __init__(
        self,
        scene: SceneApi,
        session: Session,
        look: Look,
        on_drag: OnDrag | None = None,
    ) -> None:
        self._session = session
        self.ground = Ground(scene, on_drag, look)
        self._carpet = Carpet(scene, look)
        self._drones = [Drone(scene, slot, look) for slot in (0, 1)]
        self._map_shown: tuple[FieldMap | None, str] = (None, "")
        self.scale: Scale | None = None
        self.size_m = np.inf
        self.link_range_db = LINK_RANGE_DB

    def show(
        self,
        eye_m: ArrayLike,
        *,
        chosen_map: str,
        pattern: bool,
        selected: Key | None = None,
        freed: bool = False,
    ) -> None:
        """Draw the session's view and what is known of it.

        Args:
            eye_m: (3,) where the camera stands, towards which the patterns are open, metres.
            chosen_map: which map, one of ``MAPS``, or any other for none.
            pattern: whether the radiation patterns are shown.
            selected: the point that has arrows to drag it by, or None.
            freed: whether it can be dragged off its altitude.
        """
        session, view = self._session, self._session.view
        size_m = scene_size_m(view.scenario)
        if not _OTHER_SIZE[0] < size_m / self.size_m < _OTHER_SIZE[1]:
            self.size_m = size_m
        answer = session.current(view.case)
        self.ground.show(view, answer, self.size_m, selected=selected, freed=freed)
        self._show_map(chosen_map)
        for slot, drone in enumerate(self._drones):
            answer = session.answer(view.cases[slot]) if slot < len(view.cases) else None
            if answer is None or len(answer.result.links) != len(view.scenario.nodes):
                drone.hide()
                continue
            shown = drone_text(session, slot), self.size_m, self.link_range_db, eye_m
            drone.show(answer, *shown, pattern=pattern)

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

    def face(self, eye_m: ArrayLike) -> None:
        """Turn the patterns' openings towards the camera.

        Args:
            eye_m: (3,) where it stands, metres.
        """
        for drone in self._drones:
            drone.face(eye_m)
