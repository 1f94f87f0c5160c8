"""The verb ``studio``."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Annotated

import typer

from nullpose.cli.faults import signals_handled
from nullpose.cli.options import AllowOutside, At, Overrides, SceneOptions
from nullpose.cli.printing import say

_LOOPBACK = "127.0.0.1"


def studio(
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE",
            help="Scenario file (TOML). Left out: a new scene with one node, to build on.",
            show_default=False,
        ),
    ] = None,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    at_s: At = None,
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port of the page.")] = 8080,
    host: Annotated[
        str, typer.Option("--host", help="Address to listen at. 0.0.0.0 lets other machines in.")
    ] = _LOOPBACK,
) -> None:
    """Open a scenario in the browser.

    Add, move and delete nodes and jammers. The best pose and its bound are computed again at each step.
    """
    from nullpose.scenario import apply_overrides
    from nullpose.scenario.toml_file import file_text
    from nullpose.studio.case import new_scenario
    from nullpose.studio.server import studio as running_studio

    if file is None:
        scenario, text = apply_overrides(new_scenario(), overrides or []), ""
    else:
        scene = SceneOptions(file=file, overrides=overrides, allow_outside=allow_outside, at_s=at_s)
        scenario, text = scene.read(in_motion=at_s is None), file_text(file)

    ended = threading.Event()
    with (
        signals_handled(lambda *_: ended.set(), "SIGINT", "SIGTERM", "SIGHUP"),
        running_studio(scenario, text, host=host, port=port) as running,
    ):
        _announce(host, running.address)
        while not ended.wait(0.5):  # a wait without a limit would not hear Ctrl-C on every system
            pass
    say("stopped")


def _announce(host: str, address: str) -> None:
    say(f"nullpose studio: {address}   (Ctrl-C ends it)")
    if host not in (_LOOPBACK, "localhost", "::1"):
        say(
            f"listening at {host}: whoever has this address with its token can open the studio from another "
            "machine; what is sent is not encrypted"
        )
