"""What can be taken away from a page: the scenario, the pose, the power plot, the scene."""

from __future__ import annotations

import json
from io import BytesIO
from types import SimpleNamespace
from typing import Any

from nullpose.errors import UsageError
from nullpose.studio.answer import Answer
from nullpose.studio.drone import LINK_RANGE_DB
from nullpose.studio.look import LIGHT, Look
from nullpose.studio.session import Session
from nullpose.studio.toml_like import toml_like

_PHONE_PX = {"image_width": 390, "image_height": 844}

_ON_A_PHONE = """if (innerWidth < 600 && innerWidth < innerHeight) {
  const seen = { initialCameraPosition: %s, initialCameraLookAt: %s }, { get } = URLSearchParams.prototype;
  URLSearchParams.prototype.get = function (name) { return seen[name]?.join() ?? get.call(this, name); };
}"""
"""Gives viser, which asks the address of a page for it, a camera that sees the whole scene on a phone."""


def scenario_toml(session: Session) -> bytes:
    """Return the scene as a scenario file, in the text of the file that it is from.

    Args:
        session: whose.
    """
    return toml_like(session.view.text, session.view.scenario).encode()


def pose_json(session: Session) -> bytes:
    """Return the solutions of the cases that are shown, as JSON.

    Args:
        session: whose.

    Raises:
        UsageError: the present scene is not solved yet.
    """
    solved = [{"case": one.case.label} | one.result.to_dict() for one in current_answers(session)]
    return (json.dumps(solved[0] if len(solved) == 1 else solved, indent=2, allow_nan=False) + "\n").encode()


def current_answers(session: Session) -> list[Answer]:
    """Return the answers of the cases that are shown, all to the present scene.

    Args:
        session: whose.

    Raises:
        UsageError: the present scene is not solved yet.
    """
    current = [answer for answer in map(session.current, session.view.cases) if answer is not None]
    if len(current) < len(session.view.cases):
        raise UsageError("the scene is being solved; try again when its pose is there")
    return current


def figure_png(session: Session) -> bytes:
    """Return the power plot as a picture (PNG).

    Args:
        session: whose.

    Raises:
        UsageError: there is no complete plot of the present scene yet.
    """
    from nullpose.report.figures.style import house_style
    from nullpose.report.figures.sweep import draw_sweep

    curve = session.curve
    if curve is None or not curve.complete or curve.version != session.version:
        raise UsageError("the plot of this scene is not complete yet; try again in a moment")
    figure, picture = draw_sweep(curve.table), BytesIO()
    with house_style():
        figure.savefig(picture, format="png", dpi=200, facecolor="white")
    return picture.getvalue()


def scene_html(
    session: Session,
    chosen_map: str,
    link_range_db: tuple[float, float] = LINK_RANGE_DB,
    *,
    look: Look = LIGHT,
    camera: Any = None,
    pattern: bool = True,
) -> bytes:
    """Return the scene with its card as one HTML file that needs neither a server nor a network.

    Args:
        session: whose.
        chosen_map: the map that is shown.
        link_range_db: ends of the links' colours, dB.
        look: its colours.
        camera: of the page, to begin with what it sees; None for one that sees the whole scene, as it is on a
            phone in any case.
        pattern: whether the antenna's pattern is shown.

    Raises:
        UsageError: the present scene is not solved yet.
    """
    from nullpose.studio.camera import aim
    from nullpose.studio.frame import look_html
    from nullpose.studio.opening import LOOPBACK, open_server, unannounced
    from nullpose.studio.overlay import overlay_html
    from nullpose.studio.stage import Stage

    best = current_answers(session)[0]
    server, _ = open_server(LOOPBACK, 0)
    try:
        first = server.initial_camera
        aim(first, session.view.scenario, best.result.pose)
        if camera is not None:
            first.position, first.look_at, first.fov = camera.position, camera.look_at, camera.fov
            first.up = camera.up_direction
        stage = Stage(server.scene, session, look)
        stage.link_range_db = link_range_db
        stage.show(first.position, chosen_map=chosen_map, pattern=pattern)
        page = str(server.scene.as_html(dark_mode=look.dark))
        ends = {"position": first.position, "look_at": first.look_at, "fov": first.fov}
        phone = SimpleNamespace(**ends, **_PHONE_PX)
        aim(phone, session.view.scenario, best.result.pose)
    finally:
        with unannounced():
            server.stop()
    card = (
        f"{look_html()}<div id=np-overlay>{overlay_html(session, stage.scale)}</div>"
        f"<script>{_ON_A_PHONE % (phone.position.tolist(), phone.look_at.tolist())}</script>"
        "<script>document.documentElement.style.setProperty('--np-height',"
        "`${document.getElementById('np-overlay').offsetHeight}px`)</script>"  # viser's notices are below
    )
    head, body, rest = page.rpartition("</body>")
    return f"{head}{card}{body}{rest}".encode()
