"""Errors turned into messages and exit codes: the one place where that happens."""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

import typer
from typer.core import TyperGroup

from nullpose.errors import NullposeError, SolveError

INTERNAL = 1
BAD_INPUT = 2
INTERRUPTED = 130  # 128 + SIGINT, as shells have it
PIPE_CLOSED = 141  # 128 + SIGPIPE


class FaultReportingGroup(TyperGroup):
    """The command line's verbs; what they raise on purpose ends as a message, never as a traceback."""

    def invoke(self, ctx: Any) -> Any:
        """Return what the verb returns, or end the process with a message and an exit code.

        Args:
            ctx: the parsed command line.
        """
        # the compiler of the kernels calls back from native code, where an interrupt becomes another error
        pressed = threading.Event()

        def note(number: int, frame: FrameType | None) -> None:
            pressed.set()
            signal.default_int_handler(number, frame)

        with signals_handled(note, "SIGINT"):
            try:
                result = super().invoke(ctx)
                sys.stdout.flush()
            except NullposeError as error:
                typer.echo(f"error: {error}", err=True)
                raise typer.Exit(INTERNAL if isinstance(error, SolveError) else BAD_INPUT) from error
            except BrokenPipeError as closed:
                # Whoever read our output has gone; the interpreter must not complain when it flushes at exit.
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
                raise typer.Exit(PIPE_CLOSED) from closed
            except (KeyboardInterrupt, Exception) as error:
                if pressed.is_set() or isinstance(error, KeyboardInterrupt):
                    typer.echo("interrupted", err=True)
                    raise typer.Exit(INTERRUPTED) from error
                if type(error).__module__.split(".")[0] not in {"typer", "click"}:
                    error.add_note("This is a fault of nullpose, not of your input: please report it.")
                raise
        return result


@contextmanager
def signals_handled(handler: Callable[[int, FrameType | None], object], *names: str) -> Iterator[None]:
    """Have signals handled by a function in the block; outside the main thread they stay as they are.

    Args:
        handler: called with a signal's number and the frame that it met.
        names: of the signals; those that the system does not know are left out.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [getattr(signal, name) for name in names if hasattr(signal, name)]
    before = {number: signal.signal(number, handler) for number in numbers}
    try:
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)
