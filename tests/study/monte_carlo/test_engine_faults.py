"""What happens to a study when a process of it dies: no row is lost, none is double, and it is said."""

import os
import random
import re
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from nullpose.study.monte_carlo import StudySpec, read_study, run_study, study_status
from nullpose.study.monte_carlo.chunk import KILLED

Rows = Callable[[Path], pd.DataFrame]
SpecFile = Callable[..., Path]
Spec = Callable[..., StudySpec]

SCENES = 3000


@pytest.fixture(scope="module")
def whole(quick: Spec, rows: Rows, tmp_path_factory: pytest.TempPathFactory) -> pd.DataFrame:
    """The rows of the quick study, solved in one go in this process."""
    folder = tmp_path_factory.mktemp("whole")
    run_study(quick(scenes=SCENES), folder, workers=0)
    return rows(folder)


def test_a_client_killed_five_times(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows
) -> None:
    """Killed with -9 at random moments and begun again, the rows are those of one run, and each once."""
    farm.scheduler()
    farm.worker()
    spec, out = spec_file(tmp_path, scenes=SCENES), tmp_path / "out"
    chance, seen = random.Random(7), []
    for _ in range(5):
        before = len(_parts(out))
        client = farm.client(spec, out, "--chunk", 10)
        farm.until(
            lambda client=client, before=before: len(_parts(out)) > before or client.poll() is not None
        )
        time.sleep(chance.uniform(0.0, 0.15))
        os.killpg(client.pid, signal.SIGKILL)
        client.wait()
        seen.append(study_status(out).done)
        assert study_status(out).running == ""
    assert seen == sorted(seen)
    assert 0 < seen[0] < seen[-1] < SCENES, seen
    last = farm.client(spec, out)
    said, _ = last.communicate(timeout=60)
    assert last.returncode == 0, said
    assert study_status(out).complete
    pd.testing.assert_frame_equal(rows(out), whole)


def test_a_worker_killed_in_the_middle_of_a_part(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows
) -> None:
    """Its parts are done by the other worker, with the same rows."""
    farm.scheduler()
    workers = [farm.worker(), farm.worker()]
    out = tmp_path / "out"
    client = farm.client(spec_file(tmp_path, scenes=SCENES), out, "--chunk", 100)
    farm.until(lambda: len(_parts(out)) >= 4)
    os.killpg(workers[0].pid, signal.SIGKILL)
    said, _ = client.communicate(timeout=60)
    assert client.returncode == 0, said
    assert "1 worker\n" in said
    pd.testing.assert_frame_equal(rows(out), whole)


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
    said, _ = client.communicate(timeout=60)
    assert client.returncode == 2
    assert re.search(
        r"^error: scheduler: the one at tcp://\S+ went away; the parts so far are kept", said, re.M
    )
    assert "Traceback" not in said
    assert 0 < len(read_study(out).frame()) < SCENES
    run_study(read_study(out).spec, out, workers=0)
    pd.testing.assert_frame_equal(rows(out), whole)


def test_a_scene_that_no_worker_survives(
    farm: Any, spec_file: SpecFile, tmp_path: Path, whole: pd.DataFrame, rows: Rows
) -> None:
    """It becomes failures with a reason; the others of its part are solved."""
    deadly = tmp_path / "deadly.py"
    deadly.write_text(
        "import os\n"
        "from nullpose.study.monte_carlo import chunk\n"
        "def deadly(spec, scene, index, *rest, solved=chunk.solved_row):\n"
        "    return os._exit(9) if index == 7 else solved(spec, scene, index, *rest)\n"
        "chunk.solved_row = deadly\n",
        encoding="utf-8",
    )
    farm.environment["DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES"] = "0"
    farm.scheduler()
    for _ in range(3):
        farm.worker("--preload", deadly)
    client = farm.client(spec_file(tmp_path, scenes=20), tmp_path / "out", "--chunk", 5)
    said, _ = client.communicate(timeout=90)
    assert client.returncode == 0, said
    assert "workers died at scenes 5 to 9" in said
    found = rows(tmp_path / "out")
    assert list(found.loc[found["status"] == "failed", "scene"]) == [7]
    assert found["reason"][7] == KILLED
    others = found["scene"] != 7
    pd.testing.assert_frame_equal(found[others], whole[:20][others])


def test_workers_with_another_nullpose(farm: Any, spec_file: SpecFile, tmp_path: Path) -> None:
    """They are refused before any work, with both versions."""
    other = tmp_path / "other.py"
    other.write_text(
        "from nullpose.study.monte_carlo import versions\nversions.fingerprint.__wrapped__.__code__ = "
        "(lambda: '0.0.9+else').__code__\n",
        encoding="utf-8",
    )
    farm.scheduler()
    farm.worker("--preload", other)
    client = farm.client(spec_file(tmp_path), tmp_path / "out")
    said, _ = client.communicate(timeout=60)
    assert client.returncode == 2
    assert "has nullpose 0.0.9+else, and here it is" in said
    assert "Traceback" not in said


def test_an_address_where_no_scheduler_is(farm: Any, spec_file: SpecFile, tmp_path: Path) -> None:
    """The message says what to try, and no folder is left that looks like a study."""
    farm.address = "tcp://127.0.0.1:1"
    client = farm.client(spec_file(tmp_path), tmp_path / "out")
    said, _ = client.communicate(timeout=30)
    assert client.returncode == 2
    assert "no Dask scheduler answers at tcp://127.0.0.1:1" in said
    assert "dask worker tcp://127.0.0.1:1 --nthreads 1" in said
    assert "Traceback" not in said


def test_ctrl_c_ends_a_run_in_order(farm: Any, spec_file: SpecFile, tmp_path: Path) -> None:
    """The embedded cluster ends with the run, whose parts are kept; the message says how to go on."""
    out = tmp_path / "out"
    spec = spec_file(tmp_path, scenes=10**6)
    client = farm.start("nullpose", "study", "run", spec, "--out", out, "--workers", 1, "--chunk", 10)
    journal = out / "parts.jsonl"
    farm.until(lambda: journal.exists() and journal.read_text(encoding="utf-8").count("\n") >= 2)
    os.killpg(client.pid, signal.SIGINT)
    said, _ = client.communicate(timeout=60)
    assert client.returncode == 130
    assert "the parts so far are kept, and the same command goes on from there" in said
    assert "Traceback" not in said
    farm.until(lambda: not _is_there(client.pid))
    assert len(read_study(out).frame()) >= 20


def _is_there(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def _parts(out: Path) -> list[Path]:
    return sorted((out / "parts").glob("part-*"))
