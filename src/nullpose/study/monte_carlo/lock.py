"""One client at a time writes a study's folder."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from nullpose.errors import OutputError
from nullpose.files import check_outputs

LOCK = "lock"

_LONGEST = 4096  # characters that are read: a lock names a process and a machine
_OWNER = re.compile(r"process (\d{1,9}) on (.+)\n", re.ASCII)


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
    path, own = folder / LOCK, f"process {os.getpid()} on {socket.gethostname()}\n"
    check_outputs({}, {"the study's lock": path})
    with path.open("a+", encoding="utf-8", errors="replace") as file:
        if other := _other(file):
            raise OutputError(
                f"{folder}: {other} writes this study now, or was killed doing so; wait for it, or end it; "
                f"if it is gone, remove {path} and try again"
            )
        file.truncate(0)
        file.write(own)
        file.flush()
        yield
        file.truncate(0)


def holder(folder: Path) -> str:
    """Return who writes a folder now, as in "process 1234 on host"; empty if nobody does.

    Args:
        folder: the study's folder.
    """
    with suppress(OSError):
        if (folder / LOCK).is_file():
            with (folder / LOCK).open("r+", encoding="utf-8", errors="replace") as file:
                return _other(file)
    return ""


def _other(file: IO[str]) -> str:
    """Take the system's lock on a file; return who holds it if somebody else does."""
    file.seek(0)
    here = socket.gethostname()
    # Half a line from a killed client names nobody.
    found = _OWNER.fullmatch(file.read(_LONGEST))
    pid, host = found.groups() if found else ("-1", here)
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        taken = True
    except BlockingIOError:
        taken = False
    except (ImportError, OSError):  # Windows, or a file system that knows no locks: the file has to do
        import psutil

        taken = not psutil.pid_exists(int(pid))
    if taken and host == here:  # the locks of another machine may not be seen from here
        return ""
    return f"process {pid} on {host}"
