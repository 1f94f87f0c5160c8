"""The kernel of the map, compiled by another process where it has to be, so that pages stay responsive."""

from __future__ import annotations

import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

import numpy as np

from nullpose.family import build_family
from nullpose.scenario import Airspace, Node, Receiver, Scenario

__all__ = ["MapKernel", "compile_map_kernel"]

_PROGRAM = "from nullpose.studio.map_kernel import compile_map_kernel as c; c()"


class MapKernel:
    """Whether the kernel can be called without compiling it; starts its compilation if it cannot."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        self._asked = False

    def is_ready(self) -> bool:
        """Return whether the kernel is at hand; the first call begins its compilation if it is not."""
        with self._lock:
            if not self._asked and not _is_compiled():
                with suppress(OSError):
                    command = [sys.executable, "-c", _PROGRAM]
                    quiet = subprocess.DEVNULL
                    self._process = subprocess.Popen(command, stdin=quiet, stderr=quiet)
            self._asked = True
            return self._process is None or self._process.poll() is not None

    def __del__(self) -> None:
        self.close()

    def close(self) -> None:
        """End a compilation that still runs."""
        with self._lock:
            self._asked = True
            if self._process is not None:
                self._process.kill()
                self._process.wait()


def compile_map_kernel() -> None:
    """Compile the kernel, or load it from its cache, by calling it once."""
    from nullpose.solve.kernels.axis import best_axis

    scenario = Scenario(
        airspace=Airspace(altitude_m=(8.0, 30.0)),
        receiver=Receiver(noise_w=1e-3, reference_gain_db=0.0),
        nodes=(Node(position_m=(0.0, 0.0, 0.0), power_w=1.0),),
    )
    best_axis(build_family(scenario).arrays, np.array([5.0, 5.0, 9.0]), np.empty(3))


def _is_compiled() -> bool:
    """Return whether the kernel is compiled, in this process or on disk, or is not to be compiled at all."""
    from nullpose.solve.kernels.axis import best_axis

    if getattr(best_axis, "signatures", True):  # a plain function has none
        return True
    cache_path = best_axis.stats.cache_path
    return cache_path is None or any(Path(cache_path).glob("axis.best_axis-*.nbi"))
