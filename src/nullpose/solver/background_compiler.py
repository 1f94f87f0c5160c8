"""Kernels compiled by processes of their own, which keep them on disk also if this process ends first."""

from __future__ import annotations

import gc
import os
import pickle
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from importlib import import_module
from pathlib import Path
from typing import Any

from nullpose.solver.kernels.compiler import interpreted
from nullpose.solver.kernels.compiler.notices import UNCACHED, warn_once

LOOK_S = 0.1  # between two looks at the processes
_QUIET_S = 3.0  # nobody is told of what takes no longer
_LONGEST_S = 300.0  # then they are no longer waited for, and this process compiles
_LONGEST_WITHOUT_S = 5.0  # likewise where no folder keeps kernels, so that no process can help
_SPACE = 2_000_000  # bytes that must be free on the disk
_MOST = 2  # processes at a time: search and proof are the two long parts
_STARTED: list[subprocess.Popen[bytes]] = []
"""All processes: one that is still running may not be forgotten."""
_PROGRAM = "from nullpose.solver.background_compiler import compile_requested as c; c()"


class BackgroundCompiler:
    """Compiles kernels in other processes, while Python runs them in this one.

    For one folder of kernels the processes of one command run at a time; other commands wait for what these
    keep there. They write to no terminal and may outlive this process.

    Args:
        announce: called now and then while a user has to wait.
        counts: whether the time of compiling counts towards time limits.
    """

    def __init__(self, announce: Callable[[], object] = lambda: None, counts: bool = False) -> None:
        self._announce, self.counts = announce, counts
        self._asking = threading.Lock()
        # module and name of a kernel, types of its arguments
        self._requests: list[tuple[str, str, object]] = []
        self._sent = 0  # requests that a process was started for
        self._processes: list[subprocess.Popen[bytes]] = []
        self._folder: str | None = None
        self._lock = -1  # of the folder, a file's number
        self._is_ended = False
        self._began = self._looked = self._busy_s = 0.0

    @contextmanager
    def in_use(self) -> Iterator[None]:
        """Let Python run, in the block, what is compiled by these processes."""
        interpreted.compiler = self
        try:
            yield
        except KeyboardInterrupt:
            self.end()
            raise
        finally:
            interpreted.compiler = None
            with self._asking:
                self._start()
                self._unlock()

    def takes(self, kernel: Any, signature: object) -> bool:
        """Request a kernel unless it was; true while Python is to run it, since it is compiled elsewhere.

        Args:
            kernel: the kernel.
            signature: types of its arguments.
        """
        request = kernel.py_func.__module__, kernel.py_func.__qualname__, signature
        with self._asking:
            if request not in self._requests:  # otherwise it was compiled in vain, unless it still is
                if not self._is_busy():
                    self._began, self._looked = time.monotonic(), time.monotonic() - LOOK_S
                if not self._requests:  # all commands begin with the same kernels, and meet at this folder
                    self._folder = kernel.stats.cache_path
                self._requests.append(request)
        return self.is_busy() and not kernel.has_code(signature)

    def is_busy(self) -> bool:
        """Test if anything is left to compile."""
        with self._asking:
            now = time.monotonic()
            if now >= self._looked + LOOK_S:
                self._start()
                self._busy_s += now - self._looked if self._is_busy() else 0.0
                self._looked = now
                if self._is_busy() and now > self._began + _QUIET_S:
                    self._announce()
            return self._is_busy()

    def busy_s(self) -> float:
        """Sum up the time in which there was, as far as a look has shown, seconds."""
        self.is_busy()
        return self._busy_s

    def wait(self, kernel: Any, signature: object, look: Callable[[], object] = lambda: None) -> bool:
        """Wait until a kernel is compiled; return False if that has been ended.

        Args:
            kernel: the kernel.
            signature: types of its arguments.
            look: called now and then; what it raises ends the wait.
        """
        while self.takes(kernel, signature) and not self._is_ended:
            look()
            time.sleep(LOOK_S)
        return not self._is_ended

    def end(self) -> None:
        """End the processes, since Ctrl-C was pressed: Python runs what is left to do."""
        self._is_ended = True
        for process in self._processes:
            process.kill()

    def _is_busy(self) -> bool:
        longest_s = _LONGEST_WITHOUT_S if self._folder is None else _LONGEST_S
        is_left = self._sent < len(self._requests) or bool(self._processes)
        return self._is_ended or (is_left and time.monotonic() < self._began + longest_s)

    def _start(self) -> None:
        """Start a process for the requests that none was started for, unless those of another command run."""
        self._processes = [each for each in self._processes if each.poll() is None]
        if self._is_ended or self._sent == len(self._requests) or len(self._processes) >= _MOST:
            return
        if not self._has_lock():
            return
        requests, self._sent = self._requests[self._sent :], len(self._requests)
        with suppress(OSError):
            _STARTED.append(
                subprocess.Popen(
                    [sys.executable, "-P", "-c", _PROGRAM, pickle.dumps(requests).hex()],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.DEVNULL,
                    start_new_session=True,  # a terminal that closes is not its end
                    pass_fds=(self._lock,) if os.name == "posix" else (),
                )
            )
            self._processes.append(_STARTED[-1])

    def _has_lock(self) -> bool:
        """Lock the folder of kernels; false if it has no space, or another command fills it."""
        if self._folder is None or self._lock >= 0:
            return self._lock >= 0
        path = Path(self._folder) / "compiling.lock"
        try:
            self._lock = os.open(path, os.O_RDWR | os.O_CREAT)
            if _is_locked_elsewhere(self._lock):
                self._unlock()
            else:
                path.write_bytes(bytes(_SPACE))
                path.write_bytes(b"")
        except OSError as error:
            self._unlock()
            warn_once(f"Kernels cannot be kept in {self._folder}: {error.strerror}. {UNCACHED}")
            self._folder = None
        return self._lock >= 0

    def _unlock(self) -> None:
        """Give up the lock here; processes that have it keep it."""
        if self._lock >= 0:
            os.close(self._lock)
        self._lock = -1


def _is_locked_elsewhere(file: int) -> bool:
    """Test if another process has locked a file; lock it for this one if not.

    Where the system or the folder has no such locks, several commands may compile the same kernels.
    """
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (ImportError, OSError) as error:
        return isinstance(error, BlockingIOError)
    return False


def compile_requested() -> None:
    """Compile the kernels that the command line names."""
    gc.disable()  # a compiler makes little garbage, and looking for it is a fifth of its time
    for module, name, signature in pickle.loads(bytes.fromhex(sys.argv[1])):
        getattr(import_module(module), name).compile(signature)
