"""An hour of dragging, sped up: what memory, log and threads say afterwards."""

from __future__ import annotations

import gc
import logging
import math
import threading
import time
from pathlib import Path
from typing import Any

from benchmarks.studio.chromium import opened
from nullpose import load
from nullpose.studio.case import case_named
from nullpose.studio.server import studio

__all__ = ["soak"]

_EXAMPLES = Path(__file__).parents[2] / "examples"
_WARM = 0.1  # share of the steps after which memory counts
_REST_EVERY = 600  # steps; then the hand rests for a proof, maps and a curve


def soak(steps: int) -> dict[str, Any]:
    """Return what remains after so many drag steps on a page that a browser shows.

    The server's memory after a tenth of the steps and at the end, what the log has from warnings up, and the
    threads that are left when the studio is closed.

    Args:
        steps: how many; 36,000 are an hour of a hand that moves ten times a second.
    """
    records = _Records()
    logging.getLogger().addHandler(records)
    before = set(threading.enumerate())
    began = time.perf_counter()
    with studio(load(_EXAMPLES / "paper.toml"), port=0) as running, opened(running.port):
        page = next(iter(running.pages.values()))
        early_mb = 0.0
        for step in range(steps):
            turn = 0.01 * step
            place = (17.0 + 12.0 * math.cos(turn), 15.0 + 12.0 * math.sin(turn), 4.0)
            page._dragged(("jammers", 0), place, "start" if step % 50 == 0 else "update")
            if step % _REST_EVERY == _REST_EVERY - 1:
                page.session.compare(case_named("Vertical") if step % (2 * _REST_EVERY) == 0 else None)
                page.session.undo()
                time.sleep(2.5)
            time.sleep(0.012)
            if step == int(_WARM * steps):
                early_mb = _memory_mb()
        late_mb = _memory_mb()
    gc.collect()
    time.sleep(1.0)
    left = [thread.name for thread in threading.enumerate() if thread not in before and thread.is_alive()]
    return {
        "steps": steps,
        "minutes": round((time.perf_counter() - began) / 60.0, 1),
        "memory_early_mb": round(early_mb, 1),
        "memory_late_mb": round(late_mb, 1),
        "growth_mb": round(late_mb - early_mb, 1),
        "log": records.messages,
        "threads_left": left,
    }


class _Records(logging.Handler):
    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.messages: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Keep what is logged."""
        self.messages.append(self.format(record))


def _memory_mb() -> float:
    gc.collect()
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return float(line.split()[1]) / 1024.0
    raise SystemExit("the soak reads /proc/self/status, which this system has not")
