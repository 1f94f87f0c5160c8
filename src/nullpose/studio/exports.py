"""What can be taken away from a page: the pose, its figure, the scene as one page."""

from __future__ import annotations

import json
from dataclasses import replace
from io import BytesIO
from types import SimpleNamespace
from typing import TYPE_CHECKING

from nullpose.errors import require_usage
from nullpose.studio.answer import Answer
from nullpose.studio.camera import aim
from nullpose.studio.guard import look_html
from nullpose.studio.look import LIGHT, Look
from nullpose.studio.opening import LOOPBACK, open_server, unannounced
from nullpose.studio.readout import card_html
from nullpose.studio.state import State

if TYPE_CHECKING:
    from viser import CameraHandle

_ON_A_PHONE = """if (innerWidth < 600 && innerWidth < innerHeight) {
  const seen = { initialCameraPosition: %s, initialCameraLookAt: %s }, { get } = URLSearchParams.prototype;
  URLSearchParams.prototype.get = function (name) { return seen[name]?.join() ?? get.call(this, name); };
}"""
"""Gives viser, which asks the address of a page for it, a camera that sees the whole scene on a phone."""


def pose_json(state: State) -> bytes:
    """Write the solutions of the cases that are shown, as JSON.

    Raises:
        UsageError: the present scene is not solved yet.
    """
    solved = [{"case": answer.case.label} | answer.result.to_dict() for answer in current_answers(state)]
    return (json.dumps(solved[0] if len(solved) == 1 else solved, indent=2, allow_nan=False) + "\n").encode()


def current_answers(state: State) -> list[Answer]:
    """Return the answers of the cases that are shown, all to the present scene.

    Raises:
        UsageError: the present scene is not solved yet.
    """
    current = [answer for answer in map(state.current, state.cases) if answer is not None]
    require_usage(
        len(current) >= len(state.cases), "the scene is being solved; try again when its pose is there"
    )
    return current


def figure_png(state: State) -> bytes:
    """Draw the scene with the pose of the chosen case as ``solve --figure`` does (PNG).

    Raises:
        UsageError: the present scene is not solved yet.
    """
    from nullpose.report.figures.poses import draw_result
    from nullpose.report.figures.style import house_style

    figure, picture = draw_result(current_answers(state)[0].result), BytesIO()
    with house_style():
        figure.savefig(picture, format="png", dpi=200, facecolor="white")
    return picture.getvalue()


def scene_html(state: State, look: Look = LIGHT, camera: CameraHandle | None = None) -> bytes:
    """Write the scene with its card as one HTML file that needs neither a server nor a network.

    Args:
        state: of the page.
        look: its colours.
        camera: of the page, to begin with its view; None for one that sees the whole scene, as it is on a
            phone in any case.

    Raises:
        UsageError: the present scene is not solved yet.
    """
    from nullpose.studio.stage import Stage

    pose = current_answers(state)[0].result.pose
    server, _ = open_server(LOOPBACK, 0)
    try:
        first = server.initial_camera
        aim(first, state.scenario, pose, cases=len(state.cases))
        if camera is not None:
            first.position, first.look_at, first.fov = camera.position, camera.look_at, camera.fov
            first.up = camera.up_direction
        stage = Stage(server.scene, look)
        stage.eye_m = first.position
        stage.render(replace(state, selected=None, pointed=None))
        page = str(server.scene.as_html(dark_mode=look.dark))
        phone = SimpleNamespace(image_width=390, image_height=844)
        aim(phone, state.scenario, pose, cases=len(state.cases))
    finally:
        with unannounced():
            server.stop()
    card = (
        f"{look_html()}<div id=np-overlay>{card_html(state)}</div>"
        f"<script>{_ON_A_PHONE % (phone.position.tolist(), phone.look_at.tolist())}</script>"
        "<script>document.documentElement.style.setProperty('--np-height',"
        "`${document.getElementById('np-overlay').offsetHeight}px`)</script>"  # viser's notices are below
    )
    head, body, rest = page.rpartition("</body>")
    return f"{head}{card}{body}{rest}".encode()
