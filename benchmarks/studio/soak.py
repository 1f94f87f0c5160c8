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
_WARM = 1300  # steps after which memory counts: two rests and a comparison are over
_REST_EVERY = 600  # steps; then the hand rests for a proof, maps and a curve
_DRAG = 50  # steps from the press of the button to its release
_PHASES = {0: "start", _DRAG - 1: "end"}
_BETWEEN_S = 0.005


def soak(steps: int, most_minutes: float) -> dict[str, Any]:
    """Return what remains after so many drag steps on a page that a browser shows.

    The server's memory after the first rests and at the end, what the log has from warnings up, and the
    threads that are left when the studio is closed.

    Args:
        steps: how many; 36,000 are an hour of a hand that moves ten times a second.
        most_minutes: when it ends though there are steps left, minutes.
    """
    records = _Records()
    logging.getLogger().addHandler(records)
    before = set(threading.enumerate())
    began = time.perf_counter()
    with studio(load(_EXAMPLES / "paper.toml"), port=0) as running, opened(running.address):
        page = next(iter(running.pages.values()))
        early_mb, done = 0.0, 0
        until = time.perf_counter() + 60.0 * most_minutes
        while done < steps and time.perf_counter() < until:
            step, done = done, done + 1
            turn = 0.01 * step
            place = (17.0 + 12.0 * math.cos(turn), 15.0 + 12.0 * math.sin(turn), 4.0)
            page._dragged(("jammers", 0), place, _PHASES.get(step % _DRAG, "update"))
            if step % _REST_EVERY == _REST_EVERY - 1:
                second = case_named("Vertical") if step % (2 * _REST_EVERY) == 0 else None
                page.session.change(lambda view, second=second: view.with_compared(second))
                page.session.undo()
                time.sleep(2.5)
            time.sleep(_BETWEEN_S)
            if step == _WARM:
                early_mb = _memory_mb()
        late_mb = _memory_mb()
    gc.collect()
    time.sleep(1.0)
    left = [thread.name for thread in threading.enumerate() if thread not in before and thread.is_alive()]
    return {
        "steps": done,
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
