"""Who works on a study, and what happens when a process of it dies: no row is lost, none is double."""

import os
import random
import re
import signal
import socketserver
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import psutil
import pytest
from sizes import and_slow
from typer.testing import CliRunner

from nullpose.cli.app import app
from nullpose.errors import ClusterError
from nullpose.study.monte_carlo import (
    StudyProgress,
    StudySpec,
    load_spec,
    read_study,
    run_study,
    study_status,
)
from nullpose.study.monte_carlo.chunk import KILLED

Rows = Callable[[Path], pd.DataFrame]
SpecFile = Callable[..., Path]
Spec = Callable[..., StudySpec]

SCENES = 800
CASES = [{"name": "free"}, {"name": "level", "airframe": "tilt-10-horizontal"}]
SWEEP = {"jammers.M.power_w": [0.1, 10.0]}

# A module that lets every process that solves scene 7 die.
DEADLY = """
import os
from nullpose.study.monte_carlo import chunk
def deadly(spec, scene, index, *rest, solved=chunk.solved_row):
    return os._exit(9) if index == 7 else solved(spec, scene, index, *rest)
chunk.solved_row = deadly
"""
# The same as a script, whose worker processes import it.
DEADLY_SCRIPT = """
import sys
from nullpose.cli.app import main
if __name__ == "__main__":
    main()
"""


@pytest.fixture(scope="module")
def whole(quick: Spec, rows: Rows, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    """The rows of the quick study, solved in one go in this process."""
    folder = tmp_path_factory.mktemp("whole")
    run_study(quick(scenes=SCENES), folder, workers=0)
    return rows(folder)


def test_the_rows_do_not_depend_on_who_makes_them(farm: Any, spec: Spec, tmp_path: Path, rows: Rows) -> None:
    """In this process, in a pool of two, on one worker of a cluster and on two: row for row."""
    study = spec(cases=CASES, sweep=SWEEP)
    run_study(study, tmp_path / "here", workers=0, chunk=5)
    told: list[StudyProgress] = []
    run_study(study, tmp_path / "pool", workers=2, chunk=1, on_progress=told.append)
    farm.scheduler()
    farm.worker()
    run_study(study, tmp_path / "one", scheduler=farm.address, chunk=4)
    farm.worker()
    run_study(study, tmp_path / "two", scheduler=farm.address)
    expected = rows(tmp_path / "here")
    assert len(expected) == 12 * 2 * 2
    for folder in ("pool", "one", "two"):
        pd.testing.assert_frame_equal(rows(tmp_path / folder), expected)
    assert 2 in {at.workers for at in told} <= {0, 2}  # none before the pool stands
    assert [at.done for at in told] == sorted(at.done for at in told)
    assert told[-1].done == 12
    assert told[-1].rate > 0.0
    assert told[-1].seconds_left == 0.0


@pytest.mark.grid
def test_workers_may_come_late(farm: Any, quick: Spec, tmp_path: Path) -> None:
    """Without a worker the run waits for one, and says so."""
    farm.scheduler()
    counts: list[int] = []

    def count(at: StudyProgress) -> None:
        counts.append(at.workers)
        if not at.workers and len(farm.started) == 1:
            farm.worker()

    assert run_study(quick(), tmp_path / "out", scheduler=farm.address, chunk=4, on_progress=count).complete
    assert (counts[0], counts[-1]) == (0, 1)


@pytest.mark.parametrize("address", ["nowhere", "http://127.0.0.1:1", "tcp://127.0.0.1:notaport", "page"])
def test_an_address_without_a_scheduler(quick: Spec, tmp_path: Path, address: str) -> None:
    """No address, another server or none: it is refused in this package's words."""

    class Page(socketserver.BaseRequestHandler):
        def handle(self) -> None:
            self.request.sendall(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")

    with socketserver.TCPServer(("127.0.0.1", 0), Page) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        if address == "page":
            address = f"tcp://127.0.0.1:{server.server_address[1]}"
        with pytest.raises(ClusterError, match="no Dask scheduler answers at"):
            run_study(quick(), tmp_path / "out", scheduler=address)
        server.shutdown()


def test_an_address_where_nobody_listens(spec_file: SpecFile, tmp_path: Path) -> None:
    """The command ends with what to try, and no folder is left that looks like a study."""
    arguments = ("--out", tmp_path / "out", "--scheduler", "tcp://127.0.0.1:1")
    done = CliRunner().invoke(app, ["study", "run", *map(str, (spec_file(tmp_path), *arguments))])
    assert done.exit_code == 2
    assert "dask worker tcp://127.0.0.1:1 --nthreads 1" in " ".join(done.stderr.split())
    assert not (tmp_path / "out" / "manifest.json").exists()


@pytest.mark.parametrize(
    ("where", "times"), and_slow([("pool", 1)], [("pool", 5), ("cluster", 2), ("cluster", 5)])
)
def test_a_client_killed_several_times(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows, where: str, times: int
) -> None:
    """Killed with -9 at random moments and run again, the rows are those of one run, and each once.

    The pool's processes end with the client, even if it is killed alone.
    """
    options: tuple[object, ...] = ("--workers", min(times, 2))
    if where == "cluster":
        farm.scheduler()
        farm.worker()
        options = ("--scheduler", farm.address)
    spec, out = spec_file(tmp_path, scenes=SCENES), tmp_path / "out"
    command = ("nullpose", "study", "run", spec, "--out", out, *options)
    chance, seen = random.Random(7), []
    for _ in range(times):
        before = len(_parts(out))
        client = farm.start(*command, "--chunk", 10)
        farm.until(
            lambda client=client, before=before: len(_parts(out)) > before or client.poll() is not None
        )
        time.sleep(chance.uniform(0.0, 0.15))
        os.kill(client.pid, signal.SIGKILL)
        client.wait()
        farm.until(lambda client=client: not farm.is_there(client.pid))
        seen.append(study_status(out).done)
        assert study_status(out).running == ""
    assert seen == sorted(seen)
    assert 0 < seen[0] <= seen[-1] < SCENES, seen
    assert times == 1 or seen[0] < seen[-1]
    assert run_study(load_spec(spec), out, workers=0).complete
    pd.testing.assert_frame_equal(rows(out), whole)


@pytest.mark.grid
def test_a_worker_of_a_cluster_killed(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows
) -> None:
    """Its parts are done by the other worker, with the same rows."""
    farm.scheduler()
    workers = [farm.worker(), farm.worker()]
    out = tmp_path / "out"
    client = farm.client(spec_file(tmp_path, scenes=SCENES), out, "--chunk", 50)
    farm.until(lambda: len(_parts(out)) >= 4)
    os.killpg(workers[0].pid, signal.SIGKILL)
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 0, said
    pd.testing.assert_frame_equal(rows(out), whole)


def test_a_process_of_the_pool_killed(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows
) -> None:
    """The run goes on with new ones; the rows are the same, none of them a failure."""
    out = tmp_path / "out"
    spec = spec_file(tmp_path, scenes=SCENES)
    client = farm.start("nullpose", "study", "run", spec, "--out", out, "--workers", 1, "--chunk", 50)
    farm.until(lambda: len(_parts(out)) >= 4)
    children = psutil.Process(client.pid).children()
    next(child for child in children if "spawn_main" in " ".join(child.cmdline())).kill()
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 0, said
    pd.testing.assert_frame_equal(rows(out), whole)


@pytest.mark.grid
@pytest.mark.parametrize("where", and_slow(["pool"], ["cluster"]))
def test_a_scene_that_no_worker_survives(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows, where: str
) -> None:
    """It becomes failures with a reason; the others of its part are solved."""
    deadly, out, spec = tmp_path / "deadly.py", tmp_path / "out", spec_file(tmp_path, scenes=20)
    deadly.write_text(DEADLY, encoding="utf-8")
    if where == "cluster":
        farm.environment["DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES"] = "0"
        farm.scheduler()
        for _ in range(5):
            farm.worker("--preload", deadly)
        client = farm.client(spec, out, "--chunk", 5)
    else:
        deadly.write_text(DEADLY + DEADLY_SCRIPT, encoding="utf-8")
        farm.environment["PYTHONPATH"] = f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"
        client = farm.start("deadly", "study", "run", spec, "--out", out, "--workers", 2, "--chunk", 5)
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 0, said
    assert "workers died at scenes 5 to 9" in said
    found = rows(out)
    assert list(found.loc[found["status"] == "failed", "scene"]) == [7]
    assert found["reason"][7] == KILLED
    others = found["scene"] != 7
    pd.testing.assert_frame_equal(found[others], whole[:20][others])


@pytest.mark.grid
def test_a_scheduler_that_goes_away(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows
) -> None:
    """The client ends with a message; what is there stays, and this machine alone goes on from it."""
    scheduler = farm.scheduler()
    farm.worker()
    spec, out = spec_file(tmp_path, scenes=SCENES), tmp_path / "out"
    client = farm.client(spec, out, "--chunk", 10)
    farm.until(lambda: len(_parts(out)) >= 4)
    os.killpg(scheduler.pid, signal.SIGKILL)
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 2
    assert re.search(
        r"^error: scheduler: the one at tcp://\S+ went away; the parts so far are kept", said, re.M
    )
    assert "Traceback" not in said
    assert 0 < len(read_study(out).frame()) < SCENES
    run_study(read_study(out).spec, out, workers=0)
    pd.testing.assert_frame_equal(rows(out), whole)


@pytest.mark.grid
def test_workers_with_another_nullpose(farm: Any, spec_file: SpecFile, tmp_path: Path) -> None:
    """They are refused before any work, with both versions."""
    other = tmp_path / "other.py"
    other.write_text(
        "from nullpose.study.monte_carlo import chunk\nchunk.fingerprint.__wrapped__.__code__ = "
        "(lambda: '0.0.9+else').__code__\n",
        encoding="utf-8",
    )
    farm.scheduler()
    farm.worker("--preload", other)
    client = farm.client(spec_file(tmp_path), tmp_path / "out")
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 2
    assert "has nullpose 0.0.9+else, and here it is" in said
    assert "Traceback" not in said


def test_a_script_without_a_guard(farm: Any, spec_file: SpecFile, tmp_path: Path) -> None:
    """Its worker processes cannot import it: the message says what it lacks, and nothing hangs."""
    script = tmp_path / "unguarded.py"
    spec = spec_file(tmp_path)
    script.write_text(
        "from nullpose.study.monte_carlo import load_spec, run_study\n"
        f"run_study(load_spec({str(spec)!r}), {str(tmp_path / 'out')!r}, workers=2)\n",
        encoding="utf-8",
    )
    farm.environment["PYTHONPATH"] = f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"
    client = farm.start("unguarded")
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 1
    assert "no process can be started on this machine; in a script call run_study under" in said


@pytest.mark.parametrize(
    ("moment", "to_group"),
    and_slow(
        [pytest.param("at-work", False, marks=pytest.mark.grid), ("twice", True)],
        [("start-up", True), ("start-up", False), ("at-work", True), ("twice", False)],
    ),
)
def test_an_interrupt_leaves_nothing(
    farm: Any, spec_file: SpecFile, tmp_path: Path, moment: str, to_group: bool
) -> None:
    """Whenever it comes, and if it comes twice: code 130, parts are kept, no file or process is left."""
    scratch, out = tmp_path / "temporary", tmp_path / "out"
    scratch.mkdir()
    farm.environment["TMPDIR"] = str(scratch)
    spec = spec_file(tmp_path, scenes=10**6)
    client = farm.start("nullpose", "study", "run", spec, "--out", out, "--workers", 2, "--chunk", 10)
    farm.until(lambda: (out / "lock").exists() if moment == "start-up" else len(_parts(out)) >= 2)
    time.sleep(random.uniform(0.0, 0.5))
    interrupt = os.killpg if to_group else os.kill
    interrupt(client.pid, signal.SIGINT)
    if moment == "twice":
        time.sleep(0.1)
        interrupt(client.pid, signal.SIGINT)
    said, _ = client.communicate(timeout=farm.LONGEST_S)
    assert client.returncode == 130, said
    assert "the parts so far are kept, and the same command goes on from there" in said
    for word in ("Traceback", "leaked", "Warning", "semaphore"):
        assert word not in said, said
    assert not list(scratch.iterdir())
    farm.until(lambda: not farm.is_there(client.pid))
    if moment != "start-up":
        assert len(read_study(out).frame()) >= 20


def _parts(out: Path) -> list[Path]:
    return sorted((out / "parts").glob("part-*"))
