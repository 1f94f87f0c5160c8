"""One browser's page: panel and scene on one side, the session on the other."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray
from viser import ClientHandle

from nullpose.errors import ScenarioError
from nullpose.objectives import Quantity
from nullpose.scenario import Scenario
from nullpose.studio.camera import aim, canvas_px
from nullpose.studio.case import case_named
from nullpose.studio.editor import Editor
from nullpose.studio.edits import new_scenario
from nullpose.studio.events import Event, Progress
from nullpose.studio.exchange import Exchange
from nullpose.studio.look import DARK, LIGHT
from nullpose.studio.overlay import overlay_html
from nullpose.studio.panel import NO_CASE, Panel, by_hand
from nullpose.studio.plot import power_plot_svg
from nullpose.studio.readout import failure_html, readout_html
from nullpose.studio.session import Session
from nullpose.studio.stage import Stage
from nullpose.studio.view import Key, View

_GESTURE_S = 1.5  # slider steps closer in time than this are undone together

_LATE_S = 0.15  # while a hand moves its last answer stays, unless the next one takes longer than this

_log = logging.getLogger("nullpose.studio")


class Page:
    """The page of one browser, with a session of its own.

    Args:
        client: the browser.
        scenario: the scene to begin with.
        text: of the file that it is from; empty without a file.
        dark: whether the page is dark.
    """

    def __init__(
        self,
        client: ClientHandle,
        scenario: Scenario,
        text: str = "",
        *,
        dark: bool = False,
    ) -> None:
        self._client = client
        self._lock = threading.RLock()
        self._open = True
        self._gesture = 0
        self._slid_at = 0.0
        self._late: threading.Timer | None = None
        self._is_presented = False
        self._aimed: tuple[int, bool] | None = None
        self._fit: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
        look = DARK if dark else LIGHT
        self.session = Session(scenario, text, on_view=self._view_changed, on_event=self._told)
        self.panel = Panel(client.gui, dark=dark)
        self.stage = Stage(client.scene, self.session, look, self._dragged)
        own = client, self.session, self.panel
        self._editor = Editor(*own, self._change, self._refresh, lambda: self.stage.size_m)
        self._exchange = Exchange(*own, self.stage, look, self._change)
        self._listen()
        self.session.start()

    def close(self) -> None:
        """End the session's thread, and draw nothing more."""
        with self._lock:
            self._open = False
            self._not_late()
        self.session.close()

    def _listen(self) -> None:
        panel, session = self.panel, self.session
        controls: list[tuple[Any, Callable[[Any], object]]] = [
            (panel.case, lambda label: self._change(lambda view: view.with_case(case_named(label)))),
            (panel.compared, self._compare),
            (panel.power, self._slid),
            (panel.power_text, self._typed),
            *((one, self._refresh) for one in (panel.map, panel.pattern, panel.freed)),
        ]
        buttons: list[tuple[Any, Callable[[], object]]] = [
            (panel.undo, session.undo),
            (panel.redo, session.redo),
            (panel.aim, self.aim),
            (panel.new, self._new),
            (panel.present, self.present),
        ]
        for control, action in controls:
            control.on_update(by_hand(action))
        for button, press in buttons:
            button.on_click(lambda event, press=press: press())
        commands: list[tuple[str, Callable[[], object], Any, Any]] = [
            ("Undo", session.undo, "Z", "cmd/ctrl"),
            ("Redo", session.redo, "Z", "cmd/ctrl+shift"),
            ("Delete what is selected", self._editor.delete, "delete", None),
            ("End adding, select nothing", lambda: self._editor.begin(""), "escape", None),
            ("Begin or end presenting", self.present, "P", None),
            ("End presenting", lambda: self.present(False), "escape", None),
        ]
        for label, act, key, modifier in commands:
            command = self._client.gui.add_command(label, hotkey=key, modifier=modifier)
            command.on_trigger(lambda event, act=act: act())
        self._client.camera.on_update(self._looked)

    def _change(self, change: Callable[[View], View], gesture: str = "", name: str = "The change") -> bool:
        """Return whether a change was made; if not, its faults are shown."""
        try:
            self.session.change(change, gesture)
        except ScenarioError as error:
            self.panel.faults.content = failure_html(error, name)
            return False
        self.panel.faults.content = failure_html(None)
        return True

    def _compare(self, label: str) -> None:
        case = None if label == NO_CASE else case_named(label)
        self._change(lambda view: view.with_compared(case))

    def _typed(self, text: str) -> None:
        self._change(lambda view: view.with_power_text(text), name="The jamming power")
        with self._lock, self._client.atomic():
            self.panel.show_power(self.session.view)
            self.panel.power_text.value = self.session.view.power_text  # also if viser has it already

    def _slid(self, values: tuple[float]) -> None:
        now = time.monotonic()
        self._gesture += now - self._slid_at > _GESTURE_S
        self._slid_at = now
        self._change(lambda view: view.with_power_db(float(values[0])), f"power {self._gesture}")

    def _dragged(self, key: Key, position_m: NDArray[np.float64], phase: str) -> None:
        if phase == "start":
            self._gesture += 1
            self.stage.ground.dragged = key
        self._change(lambda view: view.moved(key, position_m), f"drag {self._gesture}", "The new place")
        if phase == "end":
            self.stage.ground.dragged = None
            self._refresh()  # which puts a point back whose new place was refused

    def _new(self) -> None:
        self._change(lambda view: view.with_scenario(new_scenario(), ""))

    def aim(self) -> None:
        """Let the camera look at the whole of the scene."""
        view, camera = self.session.view, self._client.camera
        answer = self.session.current(view.case)
        with self._client.atomic():
            aim(camera, view.scenario, answer.result.pose if answer else None)
        self._aimed = view.opened, answer is not None
        self._fit = canvas_px(camera), np.array(camera.position)

    async def _looked(self, _: object) -> None:
        """Aim again if only the canvas has another size, and turn the pattern towards the camera."""
        camera = self._client.camera
        if self._fit is not None:
            is_resized = not np.array_equal(self._fit[0], canvas_px(camera))
            if is_resized and np.allclose(self._fit[1], camera.position, rtol=1e-3):
                self.aim()
        self.stage.face(camera.position)

    def present(self, begin: bool | None = None) -> None:
        """Fold the panel, or unfold it.

        Args:
            begin: whether it is to be folded; None for the other of the two.
        """
        is_presented = self._is_presented
        self._is_presented = not is_presented if begin is None else begin
        if self._is_presented != is_presented:
            panel = self._client.gui.main_panel
            (panel.minimize if self._is_presented else panel.expand)()

    def _told(self, event: Event) -> None:
        if not isinstance(event, Progress):
            self._refresh()
            return
        with self._lock, self.session.still:
            self._show_overlay()

    def _show_overlay(self) -> None:
        self.panel.overlay.content = overlay_html(self.session, self.stage.scale)

    def _view_changed(self) -> None:
        with self._lock:
            if self.stage.ground.dragged is None:
                self._refresh()
            elif self._late is None and self._open:  # each step of a drag has one picture: with its answer
                self._late = threading.Timer(_LATE_S, self._refresh)
                self._late.daemon = True
                self._late.start()

    def _refresh(self, *_: object) -> None:
        with self._lock, self.session.still:
            self._not_late()
            if not self._open:
                return
            for part in (self._refresh_scene, self._refresh_panel):
                try:
                    try:
                        self._send(part)
                    except RuntimeError:  # viser's own thread took messages up at that very moment
                        self._send(part)
                except Exception:
                    _log.exception("the page could not be refreshed")

    def _send(self, part: Callable[[], None]) -> None:
        with self._client.atomic():
            part()
        self._client.flush()  # at once, since viser gathers messages for a sixtieth of a second

    def _not_late(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _refresh_scene(self) -> None:
        panel = self.panel
        view = self.session.view
        if self._aimed != (view.opened, True):
            self.aim()  # first, since the pattern is open towards the camera
        chosen = {
            "chosen_map": panel.map.value,
            "selected": self._editor.selected,
            "freed": panel.freed.value,
        }
        self.stage.show(self._client.camera.position, **chosen, pattern=panel.pattern.value)

    def _refresh_panel(self) -> None:
        session, view, panel = self.session, self.session.view, self.panel
        panel.show(view)
        self._editor.show(view)
        answer = session.current(view.case)
        panel.readout.content = readout_html(session)
        self._show_overlay()
        at_rest = self.stage.ground.dragged is None  # while a hand moves the plot is grey and stays as it is
        panel.plot.content = power_plot_svg(
            session.curve,
            version=session.version,
            power_db=view.power_db,
            value=answer.shown_value if answer and at_rest else None,
            unit=Quantity.of(view.scenario).unit,
        )
        panel.undo.disabled = not session.history.past
        panel.redo.disabled = not session.history.future
