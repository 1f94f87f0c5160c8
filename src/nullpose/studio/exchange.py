"""What leaves a page, and what comes into it: files and pictures."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from viser import ClientHandle

from nullpose.errors import NullposeError
from nullpose.scenario.loading import scenario_from_text
from nullpose.studio.editor import Change
from nullpose.studio.exports import figure_png, pose_json, scenario_toml, scene_html
from nullpose.studio.look import Look
from nullpose.studio.panel import Panel
from nullpose.studio.picture import scene_png
from nullpose.studio.session import Session
from nullpose.studio.stage import Stage
from nullpose.studio.view import View

_TOLD_S = 8.0  # how long a notice stays


class Exchange:
    """The buttons of the tab "Files" of one page.

    Args:
        client: the browser.
        session: whose scene it is.
        panel: the page's panel.
        stage: what is drawn.
        look: the page's colours.
        change: how the view is changed.
    """

    def __init__(
        self,
        client: ClientHandle,
        session: Session,
        panel: Panel,
        stage: Stage,
        look: Look,
        change: Change,
    ) -> None:
        self._client, self._session, self._panel, self._stage = client, session, panel, stage
        self._look, self._change = look, change
        files: list[tuple[Any, str, Callable[[], bytes]]] = [
            (panel.save, "scenario.toml", partial(scenario_toml, session)),
            (panel.pose, "pose.json", partial(pose_json, session)),
            (panel.figure, "figure.png", partial(figure_png, session)),
            (panel.html, "scene.html", self._html),
            (panel.picture, "scene.png", lambda: scene_png(session, client, stage.scale, look)),
        ]
        for button, name, make in files:
            button.on_click(lambda event, name=name, make=make: self._send(name, make))
        panel.upload.on_upload(lambda event: self._load(event.target.value))

    def _send(self, name: str, make: Callable[[], bytes]) -> None:
        try:
            self._client.send_file_download(name, make(), save_immediately=True)
        except NullposeError as error:
            self._tell("Not exported", str(error))

    def _html(self) -> bytes:
        panel, stage = self._panel, self._stage
        shown = self._session, panel.map.value, stage.link_range_db
        return scene_html(*shown, look=self._look, camera=self._client.camera, pattern=panel.pattern.value)

    def _load(self, file: Any) -> None:
        def loaded(view: View) -> View:
            return view.with_scenario(scenario_from_text(file.content, file.name), file.content.decode())

        if not self._change(loaded, name=file.name):  # viser has said by now that the file has arrived
            told = "It arrived, but its faults are listed in the panel, and the scene is as it was."
            self._tell(f"{file.name} was not taken", told)

    def _tell(self, title: str, text: str) -> None:
        self._client.add_notification(title, text, color="red", auto_close_seconds=_TOLD_S)
