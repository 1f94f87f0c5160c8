"""One client at a time writes a study's folder."""

from __future__ import annotations

import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

from nullpose.errors import OutputError
from nullpose.files import check_outputs

__all__ = ["LOCK", "holder", "locked"]

LOCK = "lock"

_LONGEST = 4096  # characters that are read: a lock names a process and a machine


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Hold a folder in the block, so that no other client writes it.

    The system gives the lock back when a process ends, however it does: that of a killed client is taken
    over.

    Args:
        folder: the study's folder.

    Raises:
        OutputError: another client holds it.
    """
    path = folder / LOCK
    check_outputs({}, {"the study's lock": path})
    file = path.open("a+", encoding="utf-8")
    try:
        if not _taken(file) or _elsewhere(file):
            raise OutputError(_refusal(folder, _content(file)))
        file.seek(0)
        file.truncate()
        json.dump({"pid": os.getpid(), "host": socket.gethostname()}, file)
        file.flush()
        yield
        file.seek(0)
        file.truncate()
    finally:
        file.close()


def holder(folder: Path) -> str:
    """Return who writes a folder now, as in "process 1234 on host"; empty if nobody does.

    Args:
        folder: the study's folder.
    """
    try:
        if not (folder / LOCK).is_file():
            return ""
        with (folder / LOCK).open("r+", encoding="utf-8") as file:
            if _taken(file) and not _elsewhere(file):
                return ""
            return _named(_content(file))
    except OSError:
        return ""


def _taken(file: IO[str]) -> bool:
    """Take the system's lock on a file; return whether that was possible."""
    try:
        import fcntl
    except ImportError:  # no such locks on Windows: what the file says has to do
        return not _content(file) or not _alive(_content(file).get("pid"))
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system that knows no locks
        return not _content(file) or not _alive(_content(file).get("pid"))
    return True


def _elsewhere(file: IO[str]) -> bool:
    """Return whether the file names another machine, whose locks may not be seen from here."""
    host = _content(file).get("host")
    return host is not None and host != socket.gethostname()


def _content(file: IO[str]) -> dict[str, Any]:
    file.seek(0)
    with suppress(ValueError, RecursionError):
        content = json.loads(file.read(_LONGEST))
        if isinstance(content, dict):
            return content
    return {}


def _alive(pid: object) -> bool:
    import psutil

    return isinstance(pid, int) and bool(psutil.pid_exists(pid))


def _named(content: dict[str, Any]) -> str:
    return f"process {content.get('pid', 'unknown')} on {content.get('host', 'this machine')}"


def _refusal(folder: Path, content: dict[str, Any]) -> str:
    if content.get("host") not in (None, socket.gethostname()):
        return (
            f"{folder}: {_named(content)} writes this study, or was killed doing so; if it is gone, remove "
            f"{folder / LOCK} and try again"
        )
    return f"{folder}: {_named(content)} writes this study now; wait for it, or end it, and try again"
