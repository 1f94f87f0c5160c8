"""Errors turned into messages and exit codes: the one place where that happens."""

from __future__ import annotations

import os
import signal
import sys
import threading
from types import FrameType
from typing import Any, Self

import typer
from typer.core import TyperGroup

from nullpose.errors import NullposeError, SolveError

__all__ = ["BAD_INPUT", "INTERNAL", "INTERRUPTED", "PIPE_CLOSED", "FaultReportingGroup"]

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
        with _Interrupts() as interrupts:
            try:
                result = super().invoke(ctx)
                sys.stdout.flush()
            except NullposeError as error:
                _say(f"error: {error}")
                raise typer.Exit(INTERNAL if isinstance(error, SolveError) else BAD_INPUT) from error
            except KeyboardInterrupt as interrupt:
                raise _interrupted() from interrupt
            except BrokenPipeError as closed:
                # Whoever read our output has gone; the interpreter must not complain when it flushes at exit.
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
                raise typer.Exit(PIPE_CLOSED) from closed
            except Exception as error:
                if interrupts.seen:
                    raise _interrupted() from error
                if not _belongs_to_typer(error):
                    error.add_note("This is a fault of nullpose, not of your input: please report it.")
                raise
        return result


class _Interrupts:
    """Remembers that Ctrl-C was pressed.

    The compiler of the kernels calls back from native code, where an interrupt is lost and comes out as some
    other error.
    """

    def __init__(self) -> None:
        self.seen = False
        self._before: Any = None

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, *_: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.seen = True
        signal.default_int_handler(number, frame)


def _interrupted() -> typer.Exit:
    _say("interrupted")
    return typer.Exit(INTERRUPTED)


def _belongs_to_typer(error: Exception) -> bool:
    return type(error).__module__.split(".")[0] in {"typer", "click"}


def _say(message: str) -> None:
    typer.echo(message, err=True)
