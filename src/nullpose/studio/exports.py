"""What can be taken away from a page: the scenario, the pose, the power plot, the scene, a picture of it."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial
from io import BytesIO
from textwrap import fill
from types import SimpleNamespace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from nullpose.errors import UsageError
from nullpose.report.numbers import MINUS
from nullpose.studio.answer import Answer, signed
from nullpose.studio.camera import aim, matter_m
from nullpose.studio.card import card_html
from nullpose.studio.guard import look_html
from nullpose.studio.look import LIGHT, Look, scale_colours
from nullpose.studio.opening import LOOPBACK, open_server, unannounced
from nullpose.studio.state import State
from nullpose.studio.toml_like import toml_like

if TYPE_CHECKING:
    from viser import CameraHandle, ClientHandle

_PHONE_PX = {"image_width": 390, "image_height": 844}

_ON_A_PHONE = """if (innerWidth < 600 && innerWidth < innerHeight) {
  const seen = { initialCameraPosition: %s, initialCameraLookAt: %s }, { get } = URLSearchParams.prototype;
  URLSearchParams.prototype.get = function (name) { return seen[name]?.join() ?? get.call(this, name); };
}"""
"""Gives viser, which asks the address of a page for it, a camera that sees the whole scene on a phone."""

_FINER = 2  # pixels of the picture for each of the canvas
_FAR_M = 1000.0  # what is farther from the camera is not in viser's pictures
_ROW = 0.022  # height of a row of the text below, widths of the picture
_LONGEST_TITLE = 55  # letters in a row
_LONGEST_S = 60.0
_GROUND, _INK = {False: "#ffffff", True: "#141414"}, {False: "#16191d", True: "#f1f3f5"}


def scenario_toml(state: State) -> bytes:
    """Write the scene as a scenario file, in the text of the file that it is from."""
    return toml_like(state.text, state.scenario).encode()


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
    if len(current) < len(state.cases):
        raise UsageError("the scene is being solved; try again when its pose is there")
    return current


def figure_png(state: State) -> bytes:
    """Draw the power plot as a picture (PNG).

    Raises:
        UsageError: there is no complete plot of the present scene yet.
    """
    from nullpose.report.figures.style import house_style
    from nullpose.report.figures.sweep import draw_sweep

    curve = state.curve
    if curve is None or not curve.complete or curve.version != state.version:
        raise UsageError("the plot of this scene is not complete yet; try again in a moment")
    figure, picture = draw_sweep(curve.table), BytesIO()
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
        aim(first, state.scenario, pose)
        if camera is not None:
            first.position, first.look_at, first.fov = camera.position, camera.look_at, camera.fov
            first.up = camera.up_direction
        stage = Stage(server.scene, look)
        stage.eye_m = first.position
        stage.render(replace(state, selected=None))
        page = str(server.scene.as_html(dark_mode=look.dark))
        phone = SimpleNamespace(fov=first.fov, **_PHONE_PX)
        aim(phone, state.scenario, pose)
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


def scene_png(state: State, client: ClientHandle, look: Look) -> bytes:
    """Draw a page's scene as a picture (PNG), with value, bound, status and colours below it.

    Args:
        state: of the page.
        client: its browser, which draws; this waits for it.
        look: the page's colours.

    Raises:
        UsageError: the present scene is not solved yet, a part of it is too far away, or the browser does
            not answer.
    """
    camera, pose = client.camera, current_answers(state)[0].result.pose
    far_m = float(np.linalg.norm(matter_m(state.scenario, pose) - camera.position, axis=1).max())
    if far_m > _FAR_M:
        raise UsageError(
            f"a part of the scene is {far_m:.0f} m from the camera, and a picture holds {_FAR_M:.0f} m; move "
            "the camera nearer, or export the scene (HTML), which has no limit"
        )
    width, height = _FINER * camera.image_width, _FINER * camera.image_height
    try:
        drawn = client.get_render(height, width, transport_format="png", timeout=_LONGEST_S)
    except (RuntimeError, TimeoutError) as error:
        raise UsageError(
            "the browser has drawn no picture; bring its tab to the front and try again"
        ) from error
    return _with_legend(drawn, state, look)


def _with_legend(drawn: NDArray[np.uint8], state: State, look: Look) -> bytes:
    """Set a picture on the page's ground, with rows of text and the map's colours below it."""
    from matplotlib.colors import to_rgb
    from matplotlib.figure import Figure

    rows: list[str] = []
    for answer in current_answers(state):
        bound = answer.bound_text and f", {answer.bound_text} {answer.unit}"
        rows.append(f"{signed(answer.shown_value, 4)} {answer.unit} {answer.value_words}{bound}")
        rows.append(f"{answer.case.label}: {state.status(answer.case)}")
    height, width = drawn.shape[:2]
    strip, ink, ground = int(_ROW * max(len(rows) + 1, 5) * width), _INK[look.dark], _GROUND[look.dark]
    share = drawn[..., 3:] / 255.0
    figure = Figure(figsize=(width / 100, (height + strip) / 100), dpi=100, facecolor=ground)
    figure.figimage(share * drawn[..., :3] / 255.0 + (1.0 - share) * np.array(to_rgb(ground)), 0, strip)
    size, tall, row_tall = 0.011 * width, strip / (height + strip), _ROW * width / (height + strip)
    write = partial(figure.text, color=ink, va="top")
    for row, text in enumerate(rows):
        weight = "normal" if row % 2 else "bold"
        write(0.02, tall - row_tall * (row + 0.5), text, weight=weight, size=size)
    if state.scale is not None:
        (low, high), unit = state.scale.ends, state.scale.field.unit
        bar = figure.add_axes((0.62, 0.72 * tall, 0.36, 0.12 * tall))
        bar.imshow(scale_colours(np.linspace(0.0, 1.0, 256), 0.0, 1.0)[None], aspect="auto")
        bar.set_axis_off()
        ends = f"{low:g} to {high:g} {unit}".replace("-", MINUS)
        words = f"{ends}: {fill(state.scale.field.title, _LONGEST_TITLE)}"
        write(0.62, tall - 1.7 * row_tall, words, size=0.75 * size)
    picture = BytesIO()
    figure.savefig(picture, format="png", dpi=100, facecolor=ground)
    return picture.getvalue()
