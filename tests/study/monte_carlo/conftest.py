"""Specs small enough to be run many times."""

import contextlib
import copy
import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from nullpose.scenario.toml_file import toml_text
from nullpose.study.monte_carlo import StudySpec, read_study

ROOT = Path(__file__).parents[3]
EXAMPLE = ROOT / "examples" / "study.toml"

TABLES: dict[str, Any] = {
    "name": "small",
    "seed": 3,
    "scenes": 12,
    "gap": 1e-2,
    "scene": {
        "airspace": {"altitude_m": [8.0, 30.0]},
        "receiver": {"noise_w": 1e-3, "reference_gain_db": 0.0},
    },
    "nodes": {
        "layout": "rectangle",
        "count": 2,
        "x_m": [-20.0, 20.0],
        "y_m": [0.0, 50.0],
        "power_w": 1.0,
    },
    "jammers": {
        "layout": "disc",
        "name": "M",
        "count": 1,
        "centre_m": [0.0, 25.0],
        "radius_m": 60.0,
        "height_m": 4.0,
        "power_w": {"log_uniform": [0.1, 10.0]},
    },
}

Tables = Callable[..., dict[str, Any]]


@pytest.fixture(scope="session")
def tables() -> Tables:
    """The small spec as plain data, with changes by dotted path; None takes a key away."""

    def changed(**changes: Any) -> dict[str, Any]:
        whole = copy.deepcopy(TABLES)
        for path, value in changes.items():
            *parents, key = path.split("__")
            table = whole
            for parent in parents:
                table = table.setdefault(parent, {})
            if value is None:
                table.pop(key, None)
            else:
                table[key] = value
        return whole

    return changed


@pytest.fixture(scope="session")
def spec(tables: Tables) -> Callable[..., StudySpec]:
    """The small spec with changes by dotted path."""
    return lambda **changes: StudySpec.from_dict(tables(**changes))


@pytest.fixture(scope="session")
def quick(spec: Callable[..., StudySpec]) -> Callable[..., StudySpec]:
    """A study whose scenes take less than a millisecond: a pose that is given."""
    pose = {"name": "hover", "pose": {"position_m": [0.0, 25.0, 10.0], "roll_deg": 90.0}}
    return lambda **changes: spec(**{"cases": [pose], **changes})


class Farm:
    """Processes that a test starts, all of which end with it.

    Args:
        folder: where they leave their files.
    """

    LONGEST_S = 600.0
    """What a busy machine may take for anything."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.started: list[subprocess.Popen[str]] = []
        self.address = ""
        self.environment = os.environ | {"COLUMNS": "200"}

    def start(self, *arguments: object) -> subprocess.Popen[str]:
        """Starts a Python module as a program, in a group of its own."""
        process = subprocess.Popen(
            [sys.executable, "-m", *(str(argument) for argument in arguments)],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env=self.environment,
            start_new_session=True,
        )
        self.started.append(process)
        return process

    def scheduler(self, *more: object) -> subprocess.Popen[str]:
        """Starts a scheduler on a free port of this machine, and waits until it can be reached."""
        file = self.folder / f"scheduler-{len(self.started)}.json"
        options = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", file)
        process = self.start("dask", "scheduler", *options, *more)
        self.until(lambda: file.exists() and file.read_text(encoding="utf-8").strip().endswith("}"))
        self.address = json.loads(file.read_text(encoding="utf-8"))["address"]
        return process

    def worker(self, *options: object) -> subprocess.Popen[str]:
        """Starts a worker of the scheduler; killed, it stays away."""
        usual = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", self.folder)
        return self.start("dask", "worker", self.address, *usual, *options)

    def client(self, spec: Path, out: Path, *options: object) -> subprocess.Popen[str]:
        """Starts `nullpose study run` on the scheduler."""
        return self.start(
            "nullpose", "study", "run", spec, "--out", out, "--scheduler", self.address, *options
        )

    @staticmethod
    def until(met: Callable[[], object]) -> None:
        """Waits until something holds."""
        deadline = time.monotonic() + Farm.LONGEST_S
        while not met():
            assert time.monotonic() < deadline, "it did not happen in time"
            time.sleep(0.02)

    @staticmethod
    def is_there(group: int) -> bool:
        """Tells whether a group has a process."""
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return False
        return True

    def end(self) -> None:
        """Kills what is still there, with what it started."""
        for process in self.started:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.communicate()


@pytest.fixture
def farm(tmp_path: Path) -> Iterator[Farm]:
    """Processes that end with the test."""
    farm = Farm(tmp_path)
    yield farm
    farm.end()


@pytest.fixture(scope="session")
def spec_file(tables: Tables) -> Callable[..., Path]:
    """Writes the quick study, with changes, to a file of a folder."""

    def written(folder: Path, **changes: Any) -> Path:
        pose = {"name": "hover", "pose": {"position_m": [0.0, 25.0, 10.0], "roll_deg": 90.0}}
        path = folder / "spec.toml"
        path.write_text(toml_text(tables(**{"cases": [pose], **changes})), encoding="utf-8")
        return path

    return written


@pytest.fixture(scope="session")
def rows() -> Callable[[Path], pd.DataFrame]:
    """The rows of a study's folder, without what differs from run to run."""
    return lambda folder: read_study(folder).frame().drop(columns="seconds")
