"""A scene in a notebook, or in a browser, without a studio that runs."""

from __future__ import annotations

import sys
import webbrowser
from html import escape
from pathlib import Path
from tempfile import NamedTemporaryFile

from nullpose.errors import checked, require_usage
from nullpose.scenario import Scenario
from nullpose.solver import Result, Scheme, solve
from nullpose.solver.robust import RobustDetails
from nullpose.studio.answer import answer_of, with_errors
from nullpose.studio.case import OPTIMUM, PoseCase
from nullpose.studio.field_map import field_map
from nullpose.studio.look import DARK, LIGHT
from nullpose.studio.opening import require_viser
from nullpose.studio.state import State


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
    from nullpose.studio.exports import scene_html

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
