"""Errors turned into messages and exit codes: the one place where that happens."""

from __future__ import annotations

import errno
import io
import json
import os
import re
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from difflib import get_close_matches
from types import FrameType
from typing import Any

import typer
from typer.core import TyperGroup

from nullpose.cli.printing import say
from nullpose.errors import Fault, NullposeError, RequirementError, ScenarioError, SolveError, UsageError

INTERNAL = 1
BAD_INPUT = 2
INTERRUPTED = 130  # 128 + SIGINT, as shells have it
PIPE_CLOSED = 141  # 128 + SIGPIPE

_WRONG_USAGE: Any = typer.BadParameter.__mro__[1]  # what the parser raises of any option


class FaultReportingGroup(TyperGroup):
    """The command line's verbs; what they raise on purpose ends as a message, never as a traceback."""

    def invoke(self, ctx: Any) -> object:
        """Run the verb, or end the process with a message and an exit code."""
        as_json = "--json" in [*ctx._protected_args, *ctx.args]
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
                is_internal = isinstance(error, SolveError) and not isinstance(error, RequirementError)
                code = INTERNAL if is_internal else BAD_INPUT
                say(_as_json(error, code) if as_json else f"error: {error}", err=True, broken=not as_json)
                raise typer.Exit(code) from error
            except _WRONG_USAGE as error:
                error.message = _plain_choice(error.message)
                shown = io.StringIO()
                error.show(shown)
                json_text = _as_json(UsageError(error.format_message()), BAD_INPUT)
                say(json_text if as_json else shown.getvalue().rstrip(), err=True, broken=not as_json)
                raise typer.Exit(BAD_INPUT) from error
            except BrokenPipeError as closed:
                # Whoever read our output has gone; the interpreter must not complain when it flushes at exit.
                os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
                raise typer.Exit(PIPE_CLOSED) from closed
            except (KeyboardInterrupt, Exception) as error:
                if pressed.is_set() or isinstance(error, KeyboardInterrupt):
                    say("interrupted", err=True)
                    raise typer.Exit(INTERRUPTED) from error
                if type(error).__module__.split(".")[0] not in {"typer", "click"}:
                    error.add_note("This is a fault of nullpose, not of your input: please report it.")
                raise
        return result


@contextmanager
def streams_checked() -> Iterator[None]:
    """End the process with a line and a code where standard output is closed or full."""
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115
    try:
        if sys.stdout is None:
            raise OSError(errno.EBADF, "it is closed")
        yield
    except OSError as error:
        if error.filename is not None or isinstance(error, NullposeError | BrokenPipeError):
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # the interpreter flushes at exit
        with suppress(OSError):
            say(f"error: standard output cannot be written: {error.strerror or error}", err=True)
        sys.exit(BAD_INPUT)


def _as_json(error: NullposeError, code: int) -> str:
    """Write an error as one line of JSON."""
    faults = error.faults if isinstance(error, ScenarioError) else (Fault("", str(error)),)
    return json.dumps(
        {
            "error": type(error).__name__,
            "source": getattr(error, "source", ""),
            "faults": [{"path": fault.path, "message": fault.message} for fault in faults],
            "exit_code": code,
        }
    )


def _plain_choice(message: str) -> str:
    """Add to a message on a word that is no choice the choice that may be meant."""
    message = message.removeprefix("Value error, ")
    word, *choices = re.findall(r"'([^']*)'", message) if "is not one of" in message else [""]
    guess = get_close_matches(word, choices, 1)
    return f"{message.removesuffix('.')}; did you mean '{guess[0]}'?" if guess else message


@contextmanager
def signals_handled(handler: Callable[[int, FrameType | None], object], *names: str) -> Iterator[None]:
    """Have the signals of these names, where the system knows them, handled by a function in the block.

    Outside the main thread they stay as they are.
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
            if signal.getsignal(number) is handler:  # a verb that is ending ignores it from then on
                signal.signal(number, old)
