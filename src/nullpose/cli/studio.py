"""The verb ``studio``."""

from __future__ import annotations

from typing import Annotated

import typer

from nullpose.cli.options import Overrides, ScenarioFile

__all__ = ["studio"]

_LOOPBACK = "127.0.0.1"


def studio(
    file: ScenarioFile,
    overrides: Overrides = None,
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port of the page.")] = 8080,
    host: Annotated[
        str, typer.Option("--host", help="Address to listen at. 0.0.0.0 lets other machines in.")
    ] = _LOOPBACK,
) -> None:
    """Open a scenario in the browser: drag what is on the ground, and see the proved best pose follow."""
    from nullpose.scenario import apply_overrides, load

    scenario = apply_overrides(load(file), overrides or [])
    from nullpose.studio.server import studio as running_studio

    with running_studio(scenario, host=host, port=port) as running:
        _announce(host, running.port)
        _wait()
    typer.echo("stopped")


def _announce(host: str, port: int) -> None:
    local = host in (_LOOPBACK, "localhost", "::1")
    shown = "localhost" if host in ("0.0.0.0", "::") else f"[{host}]" if ":" in host else host
    typer.echo(f"nullpose studio: http://{shown}:{port}   (Ctrl-C ends it)")
    if not local:
        typer.echo(f"listening at {host}: other machines can open it too, and nothing asks them who they are")


def _wait() -> None:
    """Wait for Ctrl-C or for the system to end the process."""
    import signal
    import threading

    ended = threading.Event()
    before = signal.signal(signal.SIGTERM, lambda number, frame: ended.set())
    try:
        while not ended.wait(0.5):  # a wait without a limit would not hear Ctrl-C on every system
            pass
    except KeyboardInterrupt:
        typer.echo("")
    finally:
        signal.signal(signal.SIGTERM, before)
