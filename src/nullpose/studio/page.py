"""One browser's page: panel and scene on one side, the session on the other."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import NullposeError, ScenarioError
from nullpose.objectives import Quantity
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.autosave import Left
from nullpose.studio.carpet import Carpet
from nullpose.studio.case import case_named
from nullpose.studio.drawing import put
from nullpose.studio.drone import LINK_RANGE_DB, Drone
from nullpose.studio.editor import Editor
from nullpose.studio.edits import new_scenario
from nullpose.studio.events import Event, Progress
from nullpose.studio.exports import figure_png, pose_json, scenario_toml, scene_html
from nullpose.studio.field_map import MAPS, FieldMap
from nullpose.studio.look import DARK, LIGHT
from nullpose.studio.overlay import Scale, overlay_html
from nullpose.studio.panel import NO_CASE, Panel, show_link
from nullpose.studio.picture import scene_png
from nullpose.studio.plot import power_plot_svg, scale_svg
from nullpose.studio.present import Present
from nullpose.studio.proof_view import ProofView
from nullpose.studio.readout import drone_text, failure_html, readout_html
from nullpose.studio.scene import Ground, scene_size_m
from nullpose.studio.scene_link import scene_to_text
from nullpose.studio.session import Session
from nullpose.studio.sight import Seen, Sight
from nullpose.studio.view import Key, View

if TYPE_CHECKING:
    from viser import ClientHandle

_GESTURE_S = 1.5  # slider steps closer in time than this are undone together

_LATE_S = 0.15  # while a hand moves its last answer stays, unless the next one takes longer than this

_OTHER_SIZE = (0.6, 1.7)  # a scene that much smaller or larger is drawn anew, at its own size

_log = logging.getLogger("nullpose.studio")


class Page:
    """The page of one browser, with a session of its own.

    Args:
        client: the browser.
        scenario: the scene to begin with.
        text: of the file that it is from; empty without a file.
        dark: whether the page is dark.
        address: of the studio as this browser reaches it.
        left: what to go on from, in place of the scene; None to begin anew.
    """

    def __init__(
        self,
        client: ClientHandle,
        scenario: Scenario,
        text: str = "",
        *,
        dark: bool = False,
        address: str = "",
        left: Left | None = None,
    ) -> None:
        self._client, self._address = client, address
        self._lock = threading.RLock()
        self._open = True
        self._gesture = 0
        self._slid_at = 0.0
        self._late: threading.Timer | None = None
        self._size_m = np.inf
        self._map_shown: tuple[FieldMap | None, str] = (None, "")
        self._scale: Scale | None = None
        self._link_range_db = LINK_RANGE_DB
        self._sight = Sight(client, self._lock, self._seen)
        self._look = look = DARK if dark else LIGHT
        labels = self._sight.labels
        self._drones = [Drone(client.scene, labels, slot, look) for slot in (0, 1)]
        told: dict[str, Any] = {"on_view": self._view_changed, "on_event": self._told}
        self.session = Session(scenario, text, history=None if left is None else left.history, **told)
        self.panel = Panel(client.gui, dark=dark)
        self._ground = Ground(client.scene, labels, self._dragged, look)
        self._carpet = Carpet(client.scene, labels, look)
        own = client, self.session, self.panel
        self._editor = Editor(*own, self._change, self._refresh, lambda: self._size_m)
        self.present = Present(client, self._enlarge)
        self._proof = ProofView(*own, self._lock, self._refresh, self._show_overlay)
        self._listen()
        if left is not None:
            self._go_on(left)
        self.session.start()

    def close(self, timeout_s: float = 5.0) -> bool:
        """Return whether the session's thread has ended within a time.

        Args:
            timeout_s: the longest to wait, seconds.
        """
        with self._lock:
            self._open = False
            self._not_late()
            self._proof.stop()
            self._sight.close()
        self.present.close()
        return self.session.close(timeout_s)

    def _listen(self) -> None:
        panel, session = self.panel, self.session
        controls: list[tuple[Any, Callable[[Any], object]]] = [
            (panel.case, lambda label: self._change(lambda view: view.with_case(case_named(label)))),
            (panel.compared, self._compare),
            (panel.power, self._slid),
            *((one, self._refresh) for one in (panel.map, panel.pattern, panel.freed)),
        ]
        files: list[tuple[Any, str, Callable[[], bytes]]] = [
            (panel.save, "scenario.toml", partial(scenario_toml, session)),
            (panel.pose, "pose.json", partial(pose_json, session)),
            (panel.figure, "figure.png", partial(figure_png, session)),
            (panel.html, "scene.html", self._html),
            (panel.picture, "scene.png", lambda: scene_png(session, self._client, self._scale, self._look)),
        ]
        buttons: list[tuple[Any, Callable[[], object]]] = [
            (panel.undo, session.undo),
            (panel.redo, session.redo),
            (panel.aim, self._sight.aim),
            (panel.new, self._new),
            (panel.link, self._link),
            (panel.present, self.present.begin),
            *((button, partial(self._send, name, make)) for button, name, make in files),
        ]
        for control, action in controls:
            control.on_update(_by_hand(action))
        for button, press in buttons:
            button.on_click(lambda event, press=press: press())
        for key, act in (("P", self._toggle_present), ("escape", self.present.end)):
            command: Any = self._client.gui.add_command("Begin or end presenting", hotkey=key)
            command.on_trigger(lambda event, act=act: act())
        self._client.camera.on_update(self._sight.looked)
        panel.form.on_submit(lambda event: self._typed(panel.power_text.value))
        panel.upload.on_upload(lambda event: self._load(event.target.value))

    def _change(self, change: Callable[[View], View], gesture: str = "", name: str = "The change") -> bool:
        """Return whether a change was made; if not, its faults are shown."""
        try:
            self.session.change(change, gesture)
        except ScenarioError as error:
            self.tell(error, name)
            return False
        self.panel.faults.content = failure_html(None)
        return True

    @property
    def left(self) -> Left:
        """What a later page of the same tab goes on from."""
        camera = self._client.camera
        return Left(self.session.history, camera.position, camera.look_at, self.panel.controls)

    def _go_on(self, left: Left) -> None:
        self.panel.choose(left.controls)
        self._sight.go_on(left.eye_m, left.look_at_m)

    def tell(self, error: ScenarioError, name: str) -> None:
        """Show the faults of what was refused.

        Args:
            error: with the faults.
            name: what was refused.
        """
        self.panel.faults.content = failure_html(error, name)

    def _link(self) -> None:
        try:
            show_link(self._client.gui, f"{self._address}&scene={scene_to_text(self.session.view.scenario)}")
        except NullposeError as error:
            self._client.add_notification("No link", str(error), color="red", auto_close_seconds=8.0)

    def _compare(self, label: str) -> None:
        case = None if label == NO_CASE else case_named(label)
        self._change(lambda view: view.with_compared(case))

    def _typed(self, text: str) -> None:
        self._change(lambda view: view.with_power_text(text), name="The jamming power")
        with self._lock, self._client.atomic():
            self.panel.show_power(self.session.view)

    def _slid(self, values: tuple[float]) -> None:
        now = time.monotonic()
        self._gesture += now - self._slid_at > _GESTURE_S
        self._slid_at = now
        self._change(lambda view: view.with_power_db(float(values[0])), f"power {self._gesture}")

    def _dragged(self, key: Key, position_m: NDArray[np.float64], phase: str) -> None:
        if phase == "start":
            self._gesture += 1
            self._ground.dragged = key
        self._change(lambda view: view.moved(key, position_m), f"drag {self._gesture}", "The new place")
        if phase == "end":
            self._ground.dragged = None
            self._refresh()  # which puts a point back whose new place was refused

    def _new(self) -> None:
        self._change(lambda view: view.with_scenario(new_scenario(), ""))
        self._sight.aimed = False

    def _load(self, file: Any) -> None:
        def loaded(view: View) -> View:
            return view.with_scenario(scenario_from_text(file.content, file.name), file.content.decode())

        if self._change(loaded, name=file.name):
            self._sight.aimed = False
        else:  # viser has said by now that the file has arrived
            told = "It arrived, but its faults are listed in the panel, and the scene is as it was."
            title = f"{file.name} was not taken"
            self._client.add_notification(title, told, color="red", auto_close_seconds=8.0)

    def _send(self, name: str, make: Callable[[], bytes]) -> None:
        try:
            self._client.send_file_download(name, make(), save_immediately=True)
        except NullposeError as error:
            self._client.add_notification("Not exported", str(error), color="red", auto_close_seconds=8.0)

    def _toggle_present(self) -> None:
        (self.present.end if self.present.is_on else self.present.begin)()

    def _enlarge(self, factor: float) -> None:
        with self._lock, self._client.atomic():
            self._sight.labels.enlarge(factor)
        self._sight.arrange()

    def _html(self) -> bytes:
        shown = self.session, self.panel.map.value, self._link_range_db
        pattern = self.panel.pattern.value
        return scene_html(*shown, look=self._look, camera=self._client.camera, pattern=pattern)

    def _seen(self) -> Seen | None:
        view = self.session.view
        answer = self.session.current(view.case)
        pose = answer.result.pose if answer else None
        seen = Seen(view.scenario, pose, len(view.cases), self._ground.dragged is None)
        return seen if self._open else None

    def _told(self, event: Event) -> None:
        if not isinstance(event, Progress):
            self._refresh()
            return
        with self._lock, self.session.still:
            self._show_overlay()

    def _show_overlay(self) -> None:
        self.panel.overlay.content = overlay_html(self.session, self._scale, self._proof.bar)

    def _view_changed(self) -> None:
        with self._lock:
            self._proof.stop()
            if self._ground.dragged is None:
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
            try:
                for part in (self._refresh_scene, self._refresh_panel):
                    with self._client.atomic():
                        part()
                    self._client.flush()  # at once, since viser gathers messages for a sixtieth of a second
            except Exception:
                _log.exception("the page could not be refreshed")

    def _not_late(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _refresh_scene(self) -> None:
        session, view = self.session, self.session.view
        size_m = scene_size_m(view.scenario)
        if not _OTHER_SIZE[0] < size_m / self._size_m < _OTHER_SIZE[1]:
            self._size_m = size_m
        chosen = {"selected": self._editor.selected, "freed": self.panel.freed.value}
        self._ground.show(view, session.current(view.case), self._size_m, **chosen)
        self._show_map()
        if not self._sight.aimed:
            self._sight.aim()  # first, since the pattern is open towards the camera
        for slot, drone in enumerate(self._drones):
            answer = session.answer(view.cases[slot]) if slot < len(view.cases) else None
            if answer is None or len(answer.result.links) != len(view.scenario.nodes):
                drone.hide()
                continue
            text = drone_text(session, slot)
            pattern = self.panel.pattern.value and not self._proof.is_playing
            eye_m = np.array(self._client.camera.position)
            drone.show(answer, text, self._size_m, self._link_range_db, eye_m, pattern=pattern)
        self._sight.arrange()

    def _show_map(self) -> None:
        maps, name = self.session.field_map, self.panel.map.value
        if (maps, name) == self._map_shown:
            return
        self._map_shown = (maps, name)
        field = None if maps is None else maps.named(name)
        if field is None:
            self._carpet.hide()
            self.panel.scale.content, self._scale = "", None
            return
        ends = self._carpet.show(field)
        self._scale = Scale(field=field, ends=ends, of_value=name == MAPS[0])
        self.panel.scale.content = scale_svg(*ends, field.title, field.unit)
        if name == MAPS[0] and field.unit == "dB":
            self._link_range_db = ends

    def _refresh_panel(self) -> None:
        session, view, panel = self.session, self.session.view, self.panel
        panel.show(view)
        self._editor.show(view)
        answer = session.current(view.case)
        panel.readout.content = readout_html(session)
        self._show_overlay()
        at_rest = self._ground.dragged is None  # while a hand moves the plot is grey and stays as it is
        panel.plot.content = power_plot_svg(
            session.curve,
            version=session.version,
            power_db=view.power_db,
            value=answer.shown_value if answer and at_rest else None,
            unit=Quantity.of(view.scenario).unit,
        )
        put(panel.replay, disabled=not self._proof.can_play)
        panel.undo.disabled = not session.history.past
        panel.redo.disabled = not session.history.future


def _by_hand(action: Callable[[Any], object]) -> Any:
    """Return a callback for what a user does, and not the program; in order, since it runs in the loop."""

    async def callback(event: Any) -> None:
        if event.client is not None:
            action(event.target.value)

    return callback
