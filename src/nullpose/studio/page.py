"""One browser's page: panel and scene on one side, the session on the other."""

from __future__ import annotations

import logging
import threading
import time
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import NullposeError, ScenarioError
from nullpose.scenario import Scenario
from nullpose.studio.camera import camera_m, near_m
from nullpose.studio.case import case_named
from nullpose.studio.drone import LINK_RANGE_DB, Carpet, Drone
from nullpose.studio.events import Event, FieldMap
from nullpose.studio.exports import figure_png, pose_json, scene_html
from nullpose.studio.map_kernel import MapKernel
from nullpose.studio.panel import BEST_MAP, FOOTPRINT, NO_CASE, NO_MAP, Panel
from nullpose.studio.plot import power_plot_svg, scale_svg
from nullpose.studio.readout import drone_text, failure_html, readout_html
from nullpose.studio.scene import Ground, scene_size_m
from nullpose.studio.session import Session
from nullpose.studio.view import POWER_DB, PointKey

if TYPE_CHECKING:
    from viser import ClientHandle

__all__ = ["Page"]

_GESTURE_S = 1.5  # slider steps closer in time than this are undone together

_LATE_S = 0.15  # while a hand moves its last answer stays, unless the next one takes longer than this

_log = logging.getLogger("nullpose.studio")


class Page:
    """The page of one browser, with a session of its own.

    Args:
        client: the browser.
        scenario: the scene to begin with.
        map_kernel: shared by all pages.
    """

    def __init__(self, client: ClientHandle, scenario: Scenario, map_kernel: MapKernel) -> None:
        self._client = client
        self._lock = threading.RLock()
        self._open = True
        self._gesture = 0
        self._slid_at = 0.0
        self._late: threading.Timer | None = None
        self._size_m = 0.0
        self._map_shown: tuple[FieldMap | None, str] = (None, NO_MAP)
        self._link_range_db = LINK_RANGE_DB
        self._drones: list[Drone] = []
        self.session = Session(
            scenario, on_view=self._view_changed, on_event=self._found, map_kernel=map_kernel
        )
        self.panel = Panel(client.gui)
        self._ground = Ground(client.scene, self._dragged)
        self._carpet = Carpet(client.scene)
        self._listen()
        self.session.start()

    def close(self, timeout_s: float = 5.0) -> bool:
        """Return whether the session's thread has ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        with self._lock:
            self._open = False
            self._not_late()
        return self.session.close(timeout_s)

    def _listen(self) -> None:
        panel, session = self.panel, self.session
        panel.case.on_update(_by_hand(lambda value: self._do(lambda: session.choose(case_named(value)))))
        panel.compared.on_update(
            _by_hand(
                lambda value: self._do(
                    lambda: session.compare(None if value == NO_CASE else case_named(value))
                )
            )
        )
        panel.power.on_update(_by_hand(self._slid))
        panel.map.on_update(_by_hand(lambda value: self._refresh()))
        panel.pattern.on_update(_by_hand(lambda value: self._refresh()))
        panel.freed.on_update(_by_hand(lambda value: self._refresh()))
        panel.undo.on_click(lambda event: self._do(session.undo))
        panel.redo.on_click(lambda event: self._do(session.redo))
        panel.aim.on_click(lambda event: self._aim())
        panel.upload.on_upload(lambda event: self._load(event.target.value))
        panel.save.on_click(lambda event: self._send("scenario.toml", self._scenario_toml))
        panel.pose.on_click(lambda event: self._send("pose.json", lambda: pose_json(session)))
        panel.figure.on_click(lambda event: self._send("figure.png", lambda: figure_png(session)))
        panel.html.on_click(lambda event: self._send("scene.html", self._html))

    def _do(self, change: Any, name: str = "The change") -> bool:
        """Return whether a change was made; if not, its faults are shown."""
        try:
            change()
        except ScenarioError as error:
            self.panel.faults.content = failure_html(error, name)
            return False
        self.panel.faults.content = failure_html(None)
        return True

    def _slid(self, value: float) -> None:
        now = time.monotonic()
        if now - self._slid_at > _GESTURE_S:
            self._gesture += 1
        self._slid_at = now
        self._do(lambda: self.session.set_power_db(float(value), f"power {self._gesture}"))

    def _dragged(self, key: PointKey, position_m: NDArray[np.float64], phase: str) -> None:
        if phase == "start":
            self._gesture += 1
            self._ground.hold(key)
        moved = self._do(lambda: self.session.move(key, position_m, f"drag {self._gesture}"), "The new place")
        if phase == "end":
            self._ground.let_go()
            if not moved:
                self._ground.restore(self.session.view)
            self._refresh()

    def _load(self, file: Any) -> None:
        if self._do(lambda: self.session.load(file.content, file.name), file.name):
            self._aim()

    def _scenario_toml(self) -> bytes:
        return self.session.view.scenario.to_toml().encode()

    def _html(self) -> bytes:
        return scene_html(self.session, self.panel.map.value, self._link_range_db, camera_m)

    def _send(self, name: str, make: Any) -> None:
        try:
            self._client.send_file_download(name, make(), save_immediately=True)
        except NullposeError as error:
            self._client.add_notification("Not exported", str(error), color="red", auto_close_seconds=8.0)

    def _aim(self) -> None:
        position, look_at = camera_m(self.session.view.scenario)
        with self._client.atomic():
            self._client.camera.position = position
            self._client.camera.look_at = look_at
            self._client.camera.near = near_m(self.session.view.scenario)

    def _view_changed(self) -> None:
        if self._ground.dragged is None:
            self._refresh()
            return
        with self._lock:  # one picture for each step of a drag, that with its answer
            if self._late is None and self._open:
                self._late = threading.Timer(_LATE_S, self._draw_late)
                self._late.daemon = True
                self._late.start()

    def _draw_late(self) -> None:
        with self._lock:
            self._late = None
            self._refresh()

    def _not_late(self) -> None:
        with self._lock:
            if self._late is not None:
                self._late.cancel()
                self._late = None

    def _found(self, event: Event) -> None:
        if event.version == self.session.version:
            self._not_late()
        if isinstance(event, FieldMap) and event.version == self.session.version:
            self._map_shown = (None, NO_MAP)
        self._refresh()

    def _refresh(self) -> None:
        with self._lock:
            if not self._open:
                return
            try:
                for part in (self._refresh_scene, self._refresh_panel):
                    with self._client.atomic():
                        part()
                    self._client.flush()  # at once, since viser gathers messages for a sixtieth of a second
            except Exception:
                _log.exception("the page could not be refreshed")

    def _refresh_scene(self) -> None:
        session, view = self.session, self.session.view
        size_m = scene_size_m(view.scenario) if not self._drones else self._size_m
        self._ground.show(view, freed=self.panel.freed.value)
        if not self._drones or not 0.6 < scene_size_m(view.scenario) / self._size_m < 1.7:
            size_m = scene_size_m(view.scenario)
            for drone in self._drones:
                drone.remove()
            self._size_m = size_m
            self._drones = [Drone(self._client.scene, slot, size_m) for slot in (0, 1)]
            self._ground.draw(view, freed=self.panel.freed.value)
        self._show_map()
        for slot, drone in enumerate(self._drones):
            case = view.cases[slot] if slot < len(view.cases) else None
            answer = session.answer(case) if case is not None else None
            if case is None or answer is None or len(answer.links) != len(view.scenario.nodes):
                drone.hide()
                continue
            drone.show(
                answer, drone_text(self.session, slot), self._link_range_db, pattern=self.panel.pattern.value
            )

    def _show_map(self) -> None:
        fields, wanted = self.session.field_map, self.panel.map.value
        if (fields, wanted) == self._map_shown:
            return
        self._map_shown = (fields, wanted)
        if fields is None or wanted == NO_MAP:
            self._carpet.hide()
            self.panel.scale.content = ""
            return
        field = fields.best if wanted == BEST_MAP else fields.footprint
        low, high = self._carpet.show(field, lift_m=0.0 if wanted == BEST_MAP else 0.05)
        title = {
            BEST_MAP: f"best value at each place, {field.altitude_m:.1f} m up; lines to nodes",
            FOOTPRINT: "gain over path loss on the ground, 0 straight below at full gain",
        }[wanted]
        self.panel.scale.content = scale_svg(low, high, title, field.unit)
        if wanted == BEST_MAP and field.unit == "dB":
            self._link_range_db = (low, high)

    def _refresh_panel(self) -> None:
        session, view, panel = self.session, self.session.view, self.panel
        panel.show_cases(view)
        answer = session.answer(view.case)
        current = session.is_current(answer)
        panel.readout.content = readout_html(session)
        at_rest = self._ground.dragged is None  # while a hand moves the plot is grey and stays as it is
        panel.plot.content = power_plot_svg(
            session.curve,
            version=session.version,
            power_db=view.power_db,
            value=answer.shown_value if answer is not None and current and at_rest else None,
            unit="dB" if answer is None else answer.quantity.unit,
        )
        panel.show_power(view.power_db, POWER_DB)
        panel.undo.disabled = not session.can_undo
        panel.redo.disabled = not session.can_redo


def _by_hand(action: Any) -> Any:
    """Return a callback for what a user does, and not the program; in order, since it runs in the loop."""

    async def callback(event: Any) -> None:
        if event.client is not None:
            action(event.target.value)

    return callback
