"""One browser's page: what a hand does changes the state, and every state is rendered."""

from __future__ import annotations

import logging
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from viser import ClientHandle, SceneClickEvent, UploadedFile

from nullpose.errors import NullposeError, ScenarioError
from nullpose.scenario import Scenario
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.camera import NARROW_PX, aim, canvas_px, ray
from nullpose.studio.case import case_named, new_scenario
from nullpose.studio.edits import Entry, with_typed, without
from nullpose.studio.exports import figure_png, pose_json, scene_html
from nullpose.studio.look import DARK, LIGHT
from nullpose.studio.panel import NO_CASE, Panel, by_hand
from nullpose.studio.picking import clicked, dragged_to_m, reading
from nullpose.studio.player import Player
from nullpose.studio.readout import macros
from nullpose.studio.session import History, Session
from nullpose.studio.stage import Drag, Stage
from nullpose.studio.state import Key, State
from nullpose.studio.toml_like import toml_like

_GESTURE_S = 1.5  # slider steps closer in time than this are undone together
_LATE_S = 0.15  # while a hand moves its last answer stays, unless the next one takes longer than this
_NOTICE_S = 8.0  # how long a notice stays

_log = logging.getLogger("nullpose.studio")


class Page:
    """The page of one browser, with a session of its own.

    Args:
        client: the browser.
        scenario: the scene to begin with; one in motion is shown at 0.
        text: of the file that it is from; empty without a file.
        dark: whether the page is dark.
    """

    def __init__(
        self, client: ClientHandle, scenario: Scenario, text: str = "", *, dark: bool = False
    ) -> None:
        self._client, self._look = client, DARK if dark else LIGHT
        self._lock, self._is_open = threading.RLock(), True
        self._gesture, self._slid_at = 0, 0.0
        self._late: threading.Timer | None = None
        self._aimed = (-1, False, 0)  # at which scene, whether with its drone, and beside how many cases
        self._fit = np.zeros(2), np.zeros(3)  # canvas and position of the camera when it was aimed
        self._grip_m = np.zeros(3)  # where a dragged point is held, from its position
        self._is_folded = False
        self._shown: History | None = None  # in the panel
        state = State(scenario=scenario.still()).with_scenario(scenario, text)
        self.session = Session(state, on_change=self._changed, on_event=lambda event: self.render())
        self._player = Player(self.session, self.change)
        self.panel = Panel(client.gui, self._typed, dark=dark)
        self.stage = Stage(client.scene, self._look, self._dragged)
        self._listen()
        self.session.start()
        self.render()

    def close(self) -> None:
        """End the session's thread, and draw nothing more."""
        with self._lock:
            self._is_open = False
            self._end_wait()
        self._player.stop()
        self.session.close()

    def change(self, change: Callable[[State], State], gesture: str = "", name: str = "The change") -> bool:
        """Change the state; False if it is refused, and then its faults are shown.

        Args:
            change: from the state now to the new one.
            gesture: a name that all steps of one gesture share, which are undone together.
            name: of what may be refused.
        """
        try:
            self.session.change(lambda state: replace(change(state), faults=""), gesture)
        except ScenarioError as error:
            faults = str(macros().faults(error, name))
            self.session.change(lambda state: replace(state, faults=faults))
            return False
        return True

    def aim(self) -> None:
        """Let the camera look at the whole of the scene."""
        state, camera = self.session.state, self._client.camera
        answer = state.current(state.case)
        with self._client.atomic():
            aim(
                camera,
                state.scenario,
                answer.result.pose if answer else None,
                turns=state.is_presented,
                cases=len(state.cases),
            )
        self._aimed, self.stage.eye_m = (
            (state.opened, answer is not None, len(state.cases)),
            camera.position,
        )
        self._fit = canvas_px(camera), np.array(camera.position)
        self.stage.is_narrow = self._fit[0][0] < NARROW_PX

    def render(self) -> None:
        """Send the browser what differs between the state and what it shows."""
        with self._lock, self.session.still:
            self._end_wait()
            if not self._is_open:
                return
            for part in (self._render_scene, self._render_panel):
                try:
                    try:
                        self._send(part)
                    except RuntimeError:  # viser's own thread took messages up at that very moment
                        self._send(part)
                except UserWarning:  # viser's, where warnings are errors: the page has gone meanwhile
                    return
                except Exception:
                    _log.exception("the page could not be refreshed")

    def _send(self, part: Callable[[], None]) -> None:
        with self._client.atomic():
            part()
        self._client.flush()  # at once, since viser gathers messages for a sixtieth of a second

    def _render_scene(self) -> None:
        state = self.session.state
        if self._aimed < (state.opened, state.current(state.case) is not None, len(state.cases)):
            self.aim()  # first, since the pattern is open towards the camera
        self.stage.render(state)
        if state.is_presented != self._is_folded:
            self._is_folded = state.is_presented
            panel = self._client.gui.main_panel
            (panel.minimize if state.is_presented else panel.expand)()
            self.aim()

    def _render_panel(self) -> None:
        if (history := self.session.history) is not self._shown:
            self.panel.render(history)
            self._shown = history

    def _changed(self) -> None:
        with self._lock:
            if self.session.state.dragged is None and not self._player.is_playing:
                self.render()
            elif (
                self._late is None and self._is_open
            ):  # a step of a drag or a play has one picture: its answer
                self._late = threading.Timer(_LATE_S, self.render)
                self._late.daemon = True
                self._late.start()

    def _end_wait(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _listen(self) -> None:
        panel, session, client = self.panel, self.session, self._client
        controls: dict[str, Callable[[Any], object]] = {
            "map_name": lambda value: self.change(lambda state: replace(state, map_name=value)),
            "has_pattern": lambda value: self.change(lambda state: replace(state, has_pattern=value)),
            "has_shadows": lambda value: self.change(lambda state: replace(state, has_shadows=value)),
            "case": lambda label: self.change(lambda state: state.with_case(case_named(label))),
            "compared": lambda label: self.change(
                lambda state: replace(state, compared=None if label == NO_CASE else case_named(label))
            ),
            "time": lambda values: self.change(lambda state: state.at_time(values[0]), name="The instant"),
            "power": self._slid,
            "power_text": self._power_typed,
            "pointer": self._pointed,
        }
        buttons: dict[str, Callable[[], object]] = {
            "play": self._player.press,
            "plan": session.plan,
            "undo": session.undo,
            "redo": session.redo,
            "delete": self._delete,
            "new": lambda: self.change(lambda state: state.with_scenario(new_scenario(), "")),
            "aim": self.aim,
            "present": self._present,
            "save": lambda: self._export(
                "scenario.toml", lambda state: toml_like(state.text, state.draft).encode()
            ),
            "pose": lambda: self._export("pose.json", pose_json),
            "figure": lambda: self._export("figure.png", figure_png),
            "html": lambda: self._export(
                "scene.html", lambda state: scene_html(state, self._look, client.camera)
            ),
        }
        for name, action in controls.items():
            getattr(panel, name).on_update(by_hand(action))
        for name, press in buttons.items():
            getattr(panel, name).on_click(lambda event, press=press: press())
        panel.add.on_click(lambda event: self.take_tool(event.target.value))
        panel.upload.on_upload(lambda event: self._load(event.target.value))
        commands: list[tuple[str, Callable[[], object], str, str | None]] = [
            ("Undo", session.undo, "Z", "cmd/ctrl"),
            ("Redo", session.redo, "Z", "cmd/ctrl+shift"),
            ("Delete what is selected", self._delete, "delete", None),
            ("End adding and presenting, select nothing", partial(self.take_tool, ""), "escape", None),
            ("Begin or end presenting", self._present, "P", None),
        ]
        for label, act, key, modifier in commands:
            client.gui.add_command(label, hotkey=key, modifier=modifier).on_trigger(
                lambda event, act=act: act()
            )
        client.camera.on_update(self._looked)
        client.scene.on_click()(self._clicked)

    def take_tool(self, tool: str) -> None:
        """Take up a tool, or none, which selects nothing either; presenting ends.

        Args:
            tool: what is to be added; empty for nothing.
        """
        self.change(lambda state: replace(state, tool=tool, selected=None, corners_m=(), is_presented=False))

    def _present(self) -> None:
        self.change(lambda state: replace(state, is_presented=not state.is_presented))

    def _slid(self, values: tuple[float]) -> None:
        now = time.monotonic()
        self._gesture += now - self._slid_at > _GESTURE_S
        self._slid_at = now
        self.change(lambda state: state.with_power_db(float(values[0])), f"power {self._gesture}")

    def _power_typed(self, text: str) -> None:
        self.change(lambda state: state.with_power_text(text), name="The jamming power")
        self.panel.power_text.value = self.session.state.power_text  # also if viser has it already

    def _typed(self, entry: Entry, text: str) -> None:
        self.change(lambda state: with_typed(state, entry, text), name="What was typed")

    def _delete(self) -> None:
        if (key := self.session.state.selected) is not None:
            self.change(lambda state: without(state, key), name="Deleting")

    async def _clicked(self, event: SceneClickEvent) -> None:  # in order, since it runs in the loop
        eye_m, direction = np.array(event.ray_origin), np.array(event.ray_direction)
        self.change(
            lambda state: clicked(state, self.stage.size_m, eye_m, direction),
            name="The fence" if self.session.state.corners_m else "The new point",
        )

    def _pointed(self, place: str) -> None:
        state, camera, key, lines = self.session.state, self._client.camera, None, list[str]()
        if place:
            key, lines = reading(
                state, self.stage.size_m, camera.position, ray(camera, *map(float, place.split()))
            )
        self.panel.tip.content = str(macros().tip(key, lines))
        if key != state.pointed:
            self.session.change(lambda state: replace(state, pointed=key))  # a refusal stays in sight

    def _dragged(self, key: Key, step: Drag) -> None:
        position_m, eye_m = (
            np.array(dict(self.session.state.points())[key].position_m),
            np.array(self._client.camera.position),
        )
        if step.phase == "start":
            self._gesture += 1
            self._grip_m = step.start_position - position_m
            self.change(lambda state: replace(state, dragged=key, selected=key))
        place_m = dragged_to_m(
            self.stage.size_m,
            position_m + self._grip_m,
            eye_m,
            step.end_position - eye_m,
            is_lifted=step.modifier == "shift",
        )
        if place_m is not None:
            to_m, gesture = place_m - self._grip_m, f"drag {self._gesture}"
            self.change(lambda state: state.moved(key, to_m), gesture, "The new place")
        if step.phase == "end":
            # rendered at rest, which puts a point back whose new place was refused
            self.session.change(lambda state: replace(state, dragged=None))

    async def _looked(self, _: object) -> None:
        """Aim again if only the canvas has another size, and turn the pattern towards the camera."""
        camera = self._client.camera
        is_resized = not np.array_equal(self._fit[0], canvas_px(camera))
        is_as_aimed = np.allclose(self._fit[1], camera.position, rtol=1e-3)
        if is_resized and (is_as_aimed or self._is_folded):
            self.aim()
        self.stage.eye_m = camera.position
        self.render()

    def _export(self, name: str, make: Callable[[State], bytes]) -> None:
        try:
            self._client.send_file_download(name, make(self.session.state), save_immediately=True)
        except NullposeError as error:
            self._notify("Not exported", str(error))

    def _load(self, file: UploadedFile) -> None:
        def loaded(state: State) -> State:
            return state.with_scenario(scenario_from_text(file.content, file.name), file.content.decode())

        if not self.change(loaded, name=file.name):  # viser has said by now that the file has arrived
            self._notify(
                f"{file.name} was not taken",
                "It arrived, but its faults are listed in the panel, and the scene is as it was.",
            )

    def _notify(self, title: str, text: str) -> None:
        self._client.add_notification(title, text, color="red", auto_close_seconds=_NOTICE_S)
