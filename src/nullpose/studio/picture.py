"""A picture of the scene as a browser draws it, with value, bound, status and colours below it."""

from __future__ import annotations

from io import BytesIO
from textwrap import fill
from typing import Any

import numpy as np
from numpy.typing import NDArray
from viser import ClientHandle

from nullpose.errors import UsageError
from nullpose.report.numbers import MINUS
from nullpose.studio.answer import Answer, signed
from nullpose.studio.colours import scale_colours
from nullpose.studio.exports import current_answers
from nullpose.studio.look import Look
from nullpose.studio.overlay import Scale
from nullpose.studio.scene import grid_m
from nullpose.studio.session import Session

_FINER = 2  # pixels of the picture for each of the canvas
_FAR_M = 1000.0  # what is farther from the camera is not in viser's pictures
_ROW = 0.022  # height of a row of the text below, widths of the picture
_LONGEST_TITLE = 55  # letters in a row
_LONGEST_S = 60.0
_GROUND, _INK = {False: "#ffffff", True: "#141414"}, {False: "#16191d", True: "#f1f3f5"}


def scene_png(session: Session, client: ClientHandle, scale: Scale | None, look: Look) -> bytes:
    """Return what a page shows of its scene as a picture (PNG), with what it says of it.

    Args:
        session: of the page.
        client: its browser, which draws; this waits for it.
        scale: the map that is shown, or None.
        look: the page's colours.

    Raises:
        UsageError: the present scene is not solved yet, a part of it is too far away, or the browser does
            not answer.
    """
    answers, camera, scenario = current_answers(session), client.camera, session.view.scenario
    low, high, _ = grid_m(scenario)
    corners = [[x, y, 0.0] for x in (low[0], high[0]) for y in (low[1], high[1])]
    seen_m = np.vstack([corners, answers[0].result.pose.position_m])
    far_m = float(np.linalg.norm(seen_m - camera.position, axis=1).max())
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
    return _with_legend(drawn, [row for answer in answers for row in _rows(session, answer)], scale, look)


def _rows(session: Session, answer: Answer) -> tuple[str, str]:
    """Return what the page says of an answer."""
    unit = answer.result.objective.quantity.unit
    bound = answer.bound_text and f", {answer.bound_text} {unit}"
    numbers = f"{signed(answer.shown_value, 4)} {unit} {answer.value_words}{bound}"
    return numbers, f"{answer.case.label}: {session.status(answer.case)}"


def _with_legend(drawn: NDArray[Any], rows: list[str], scale: Scale | None, look: Look) -> bytes:
    """Return a picture on the page's ground, with rows of text and a colour scale below it."""
    from matplotlib.colors import to_rgb
    from matplotlib.figure import Figure

    height, width = drawn.shape[:2]
    strip, ink, ground = int(_ROW * max(len(rows) + 1, 5) * width), _INK[look.dark], _GROUND[look.dark]
    share = drawn[..., 3:] / 255.0
    figure = Figure(figsize=(width / 100, (height + strip) / 100), dpi=100, facecolor=ground)
    figure.figimage(share * drawn[..., :3] / 255.0 + (1.0 - share) * np.array(to_rgb(ground)), 0, strip)
    size, tall = 0.011 * width, strip / (height + strip)

    def write(x: float, row: float, text: str, **how: Any) -> None:
        y = tall - _ROW * (row + 0.5) * width / (height + strip)
        figure.text(x, y, text, color=ink, va="top", **{"size": size, **how})

    for row, text in enumerate(rows):
        write(0.02, row, text, weight="normal" if row % 2 else "bold")
    if scale is not None:
        (low, high), unit = scale.ends, scale.field.unit
        bar = figure.add_axes((0.62, 0.72 * tall, 0.36, 0.12 * tall))
        bar.imshow(scale_colours(np.linspace(0.0, 1.0, 256), 0.0, 1.0)[None], aspect="auto")
        bar.set_axis_off()
        for x, end, side in ((0.62, f"{low:g}", "left"), (0.98, f"{high:g} {unit}", "right")):
            write(x, 1.2, end.replace("-", MINUS), ha=side, size=0.8 * size)
        write(0.62, 2.2, fill(scale.field.title, _LONGEST_TITLE), size=0.7 * size)
    picture = BytesIO()
    figure.savefig(picture, format="png", dpi=100, facecolor=ground)
    return picture.getvalue()
