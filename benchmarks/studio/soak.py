"""Random editing in a browser: what memory, log, console and threads say afterwards."""

from __future__ import annotations

import gc
import logging
import threading
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.studio.chromium import opened
from nullpose import load
from nullpose.studio.case import cases_of
from nullpose.studio.edits import entries_of
from nullpose.studio.server import Studio, studio

__all__ = ["soak"]

_EXAMPLES = Path(__file__).parents[2] / "examples"
_SCENES = ("paper", "no-fly", "airframe", "field", "eavesdropper", "robust")
_TOOLS = ("node", "jammer", "eavesdropper", "no-fly zone", "fence")
_KEYS = ("Control+z", "Control+z", "Control+Shift+z", "Delete", "Escape")
_MOST_POINTS = 14
_DRAG = 25  # steps from the press of the button to its release
_REST_EVERY = 12  # edits; then the hand rests for a proof, maps and a curve
_RELOAD_EVERY = 150
_VISERS_OWN = ("THREE.Clock", "GPU stall", "GL Driver Message")
_WARM = 0.2  # share of the time after which memory counts: every scene has been there
_AT_REST_MS = 8000  # before memory is read: a proof that runs has memory of its own


def soak(minutes: float, seed: int = 0) -> dict[str, Any]:
    """Return what remains after random editing of a page that a browser shows.

    Points, zones and fences are added by clicks, dragged, typed and deleted, taken back and made again;
    cases, maps and scenes change; now and then the page is loaded again. What remains are the server's memory
    early and at the end, what its log and the browser's console have from warnings up, and threads.

    Args:
        minutes: how long.
        seed: of the random choices.
    """
    records = _Records()
    logging.getLogger().addHandler(records)
    before = set(threading.enumerate())
    began = time.perf_counter()
    with studio(load(_EXAMPLES / "paper.toml"), port=0) as running, opened(running.address) as browser:
        browser.on("console", lambda said: records.console(said.type, said.text))
        browser.on("pageerror", lambda error: records.console("error", str(error)))
        hand = _Hand(running, browser, np.random.default_rng(seed))
        early_mb = 0.0
        while (past := (time.perf_counter() - began) / 60.0) < minutes:
            hand.edit()
            if not early_mb and past > _WARM * minutes:
                early_mb = _memory_mb(browser)
        late_mb = _memory_mb(browser)
    gc.collect()
    time.sleep(1.0)
    left = [thread.name for thread in threading.enumerate() if thread not in before and thread.is_alive()]
    return {
        "edits": hand.done,
        "by kind": dict(sorted(hand.kinds.items())),
        "minutes": round((time.perf_counter() - began) / 60.0, 1),
        "memory_early_mb": round(early_mb, 1),
        "memory_late_mb": round(late_mb, 1),
        "growth_mb": round(late_mb - early_mb, 1),
        "log": records.messages,
        "threads_left": left,
    }


class _Hand:
    """Edits at random, half of it by mouse and keys in the browser."""

    def __init__(self, running: Studio, browser: Any, rng: np.random.Generator) -> None:
        self._running, self._browser, self._rng = running, browser, rng
        self.done, self.kinds = 0, Counter[str]()
        self._edits = (self._add, self._add, self._click, self._drag, self._drag, self._type, self._press)
        self._edits += (self._press, self._choose, self._load)

    @property
    def _ours(self) -> Any:
        return list(self._running.pages.values())[-1]

    def edit(self) -> None:
        """Make one edit; rest, or load the page again, when it is time to."""
        edit = self._edits[self._rng.integers(len(self._edits))]
        edit()
        self.done += 1
        self.kinds[edit.__name__.strip("_")] += 1
        if self.done % _REST_EVERY == 0:
            self._browser.wait_for_timeout(2500)
        if self.done % _RELOAD_EVERY == 0:
            self._browser.reload()
            self._browser.wait_for_selector("[data-np=status-0]", state="attached")
            self._browser.wait_for_timeout(4000)

    def _click(self) -> None:
        """Click somewhere in the scene, which selects what is there, or adds what was chosen."""
        x, y = self._rng.uniform((120, 150), (780, 700))
        self._browser.mouse.click(x, y)
        self._browser.wait_for_timeout(150)

    def _add(self) -> None:
        ours, tool = self._ours, str(self._rng.choice(_TOOLS))
        if len(list(ours.session.view.points())) < _MOST_POINTS:
            ours._editor.begin(tool)
            for _ in range(4 if tool == "fence" else 1):
                self._click()
            ours._editor.begin("")

    def _drag(self) -> None:
        ours = self._ours
        keys = [key for key, _ in ours.session.view.points()]
        key = keys[self._rng.integers(len(keys))]
        place = np.array(dict(ours.session.view.points())[key].position_m)
        step = 0.004 * ours.stage.size_m * self._rng.normal(size=3) * (1.0, 1.0, 0.0)
        for i in range(_DRAG):
            ours._dragged(key, place + i * step, {0: "start", _DRAG - 1: "end"}.get(i, "update"))
            time.sleep(0.03)

    def _type(self) -> None:
        ours = self._ours
        key = ours._editor.selected
        entries = [one for one in entries_of(ours.session.view, key) if not one.options]
        entry = entries[self._rng.integers(len(entries))]
        ours._editor._typed(key, {entry.path: f"{self._rng.uniform(-5, 40):.3g}"})

    def _press(self) -> None:
        self._browser.keyboard.press(str(self._rng.choice(_KEYS)))
        self._browser.wait_for_timeout(100)

    def _choose(self) -> None:
        """Change the jamming power, the case, the second case or the map."""
        ours = self._ours
        cases = cases_of(ours.session.view.scenario)
        case = cases[self._rng.integers(len(cases))]
        power_db = float(self._rng.uniform(-30, 40))
        changes = (
            lambda view: view.with_power_db(power_db),
            lambda view: view.with_case(case),
            lambda view: view.with_compared(case),
            lambda view: view.with_compared(None),
        )
        ours._change(changes[self._rng.integers(len(changes))])
        ours.panel.map.value = str(self._rng.choice(ours.panel.map.options))
        ours._refresh()

    def _load(self) -> None:
        scenario = load(_EXAMPLES / f"{self._rng.choice(_SCENES)}.toml")
        self._ours._change(lambda view: view.with_scenario(scenario, ""))
        self._ours.aim()


class _Records(logging.Handler):
    def __init__(self) -> None:
        super().__init__(logging.WARNING)
        self.messages: list[str] = []

    def console(self, kind: str, text: str) -> None:
        """Keep what the browser complains of, besides what viser's own code always does."""
        if kind in ("warning", "error") and not any(one in text for one in _VISERS_OWN):
            self.messages.append(f"console {kind}: {text}")

    def emit(self, record: logging.LogRecord) -> None:
        """Keep what is logged."""
        self.messages.append(self.format(record))


def _memory_mb(browser: Any) -> float:
    browser.wait_for_timeout(_AT_REST_MS)
    gc.collect()
    for line in Path("/proc/self/status").read_text(encoding="ascii").splitlines():
        if line.startswith("VmRSS:"):
            return float(line.split()[1]) / 1024.0
    raise SystemExit("the soak reads /proc/self/status, which this system has not")
