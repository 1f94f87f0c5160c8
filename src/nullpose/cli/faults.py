"""Errors turned into messages and exit codes: the one place where that happens."""

from __future__ import annotations

import os
import sys
from typing import Any

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
        try:
            result = super().invoke(ctx)
            sys.stdout.flush()
        except NullposeError as error:
            _say(f"error: {error}")
            raise typer.Exit(INTERNAL if isinstance(error, SolveError) else BAD_INPUT) from error
        except KeyboardInterrupt as interrupt:
            _say("interrupted")
            raise typer.Exit(INTERRUPTED) from interrupt
        except BrokenPipeError as closed:
            # Whoever read our output has gone; the interpreter must not complain when it flushes at exit.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            raise typer.Exit(PIPE_CLOSED) from closed
        except Exception as error:
            if not _belongs_to_typer(error):
                error.add_note(
                    "This is a fault of nullpose, not of your input: please report it with the lines above."
                )
            raise
        return result


def _belongs_to_typer(error: Exception) -> bool:
    return type(error).__module__.split(".")[0] in {"typer", "click"}


def _say(message: str) -> None:
    typer.echo(message, err=True)
