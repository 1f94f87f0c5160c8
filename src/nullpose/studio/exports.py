"""What can be taken away from a page: the pose, its figure, the scene as one page; or shown."""

from __future__ import annotations

import json
import sys
import webbrowser
from dataclasses import replace
from html import escape
from io import BytesIO
from pathlib import Path
from tempfile import NamedTemporaryFile
from types import SimpleNamespace
from typing import TYPE_CHECKING

from nullpose.errors import checked, require_usage
from nullpose.scenario import Scenario
from nullpose.solver import Result, Scheme, solve
from nullpose.solver.robust import RobustDetails
from nullpose.studio.answer import Answer, answer_of, with_errors
from nullpose.studio.case import OPTIMUM, PoseCase
from nullpose.studio.field_map import field_map
from nullpose.studio.guard import LOOPBACK, look_html, open_server, require_viser, unannounced
from nullpose.studio.look import DARK, LIGHT, Look
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
    from nullpose.studio.camera import aim
    from nullpose.studio.readout import card_html
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


@checked
def show(found: Scenario | Result, *, height: int = 600, dark: bool = False) -> Path | None:
    """Show a scene in 3-D with its best pose: in a notebook below the cell, otherwise in the browser.

    What is shown can be turned and zoomed. It needs no server and no network, and stays in a saved notebook.

    Args:
        found: a result, whose pose is shown, or a scenario, which is solved first.
        height: of the picture in a notebook, pixels.
        dark: whether its background is dark.

    Returns:
        The file that was written and opened, which only this user can read; None in a notebook.

    Raises:
        UsageError: viser is not installed, or the result is of an array.
        WrongTypeError: given is neither.
        SolveError: the scenario has no pose.

    Example:
        >>> import nullpose
        >>> result = nullpose.solve(nullpose.load("examples/paper.toml"))
        >>> nullpose.show(result)  # doctest: +SKIP
    """
    require_viser()
    found = solve(OPTIMUM.on(found)) if not isinstance(found, Result) else found
    page = _page(found, dark=dark)
    ipython = sys.modules.get("IPython")
    if ipython is not None and hasattr(ipython.get_ipython(), "kernel"):  # IPython in a terminal has none
        frame = f'<iframe srcdoc="{escape(page)}" width="100%" height="{height}" style="border:0"></iframe>'
        ipython.display.display(ipython.display.HTML(f"<div>{frame}</div>"))
        return None
    with NamedTemporaryFile("w", encoding="utf-8", prefix="nullpose-", suffix=".html", delete=False) as file:
        file.write(page)
    webbrowser.open(Path(file.name).as_uri())
    return Path(file.name)


def _page(result: Result, *, dark: bool) -> str:
    """Write the scene of a result as HTML."""
    require_usage(
        not hasattr(result.details, "weights"),
        "show: given the result of an array; allowed: of one antenna. Try plot.plan(result)",
    )
    case = PoseCase(
        label=result.label,
        scheme=result.scheme if isinstance(result.scheme, Scheme) else Scheme.OPTIMUM,
        robust=isinstance(result.details, RobustDetails),
    )
    state = State(scenario=result.scenario, case=case)
    answer = with_errors(answer_of(state.version, case, result))
    return scene_html(
        state.with_event(answer).with_event(field_map(answer)), DARK if dark else LIGHT
    ).decode()
