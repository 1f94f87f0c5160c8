"""The verb ``studio``."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated

import typer

from nullpose.cli.options import AllowOutside, Overrides, ScenarioFile

if TYPE_CHECKING:
    from threading import Event

__all__ = ["studio"]

_LOOPBACK = "127.0.0.1"


def studio(
    file: ScenarioFile,
    overrides: Overrides = None,
    allow_outside: AllowOutside = False,
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port of the page.")] = 8080,
    host: Annotated[
        str, typer.Option("--host", help="Address to listen at. 0.0.0.0 lets other machines in.")
    ] = _LOOPBACK,
) -> None:
    """Open a scenario in the browser: drag what is on the ground, and see the proved best pose follow."""
    from nullpose.scenario import apply_overrides, load

    scenario = apply_overrides(load(file, allow_outside=allow_outside), overrides or [])
    from nullpose.studio.server import studio as running_studio

    with _until_ended() as ended, running_studio(scenario, host=host, port=port) as running:
        _announce(host, running.address)
        while not ended.wait(0.5):  # a wait without a limit would not hear Ctrl-C on every system
            pass
    typer.echo("stopped")


def _announce(host: str, address: str) -> None:
    typer.echo(f"nullpose studio: {address}   (Ctrl-C ends it)")
    if host not in (_LOOPBACK, "localhost", "::1"):
        typer.echo(
            f"listening at {host}: whoever has this address with its token can open the studio from another "
            "machine; what is sent is not encrypted"
        )


@contextmanager
def _until_ended() -> Iterator[Event]:
    """Return an event that Ctrl-C, or the system's wish to end the process, sets: the usual end of it."""
    import signal
    import threading

    ended = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield ended
        return
    signals = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    before = {number: signal.signal(number, lambda *_: ended.set()) for number in signals}
    try:
        yield ended
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
