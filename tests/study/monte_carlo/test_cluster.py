"""The embedded cluster: only its own client reaches it, and nothing of it is left behind."""

import asyncio
import os
import signal
import stat
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

import dask
import pytest
from distributed import Security
from distributed.comm import connect

from nullpose.study.monte_carlo.cluster import connected

SpecFile = Callable[..., Path]


def _answers(address: str, **arguments: Any) -> bool:
    """Returns whether a connection can be opened and its greetings are understood."""

    async def reach() -> None:
        comm = await connect(address, timeout=2.0, **arguments)
        await comm.close()

    try:
        asyncio.run(reach())
    except OSError:
        return False
    return True


def test_only_the_studys_own_client_reaches_its_scheduler_and_workers() -> None:
    """A client in plain text, or with a certificate of its own, is refused by scheduler and workers."""
    other = Security.temporary().get_connection_args("client")
    with connected(None, 1) as client:
        addresses = [client.scheduler.address, *client.nthreads()]
        assert len(addresses) == 2
        for address in addresses:
            assert address.startswith("tls://127.0.0.1:")
            assert not _answers(address.replace("tls://", "tcp://"))
            assert not _answers(address, **other)
            assert _answers(address, **client.security.get_connection_args("client"))


def test_nothing_is_told_over_http() -> None:
    """The pages that Dask would serve to anybody, with the tasks and the machine, are not there."""
    with connected(None, 1) as client:
        server = client.cluster.scheduler.http_server
        for page in ("info/main/workers.html", "json/identity.json", "metrics", "health"):
            with pytest.raises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(f"http://127.0.0.1:{server.port}/{page}", timeout=5.0)
            assert refused.value.code == 404
            refused.value.close()


def test_scratch_files_lie_in_a_private_folder_that_goes_with_the_cluster(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nobody else can look into it or put a module there, and none of it is left."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    before = dask.config.get("temporary-directory", None)
    with connected(None, 1) as client:
        (folder,) = tmp_path.iterdir()
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        (scratch,) = client.run(lambda dask_worker: dask_worker.local_directory).values()
        assert folder in Path(scratch).parents
    assert not list(tmp_path.iterdir())
    assert dask.config.get("temporary-directory", None) == before


@pytest.mark.parametrize("to_group", [True, False], ids=["Ctrl-C", "parent-alone"])
@pytest.mark.parametrize("moment", ["start-up", "at-work", "twice"])
def test_an_interrupt_leaves_nothing(
    farm: Any, spec_file: SpecFile, tmp_path: Path, moment: str, to_group: bool
) -> None:
    """Whenever it comes, and if it comes twice: code 130, and no warning, file or process is left."""
    scratch, out = tmp_path / "temporary", tmp_path / "out"
    scratch.mkdir()
    farm.environment["TMPDIR"] = str(scratch)
    spec = spec_file(tmp_path, scenes=10**6)
    client = farm.start("nullpose", "study", "run", spec, "--out", out, "--workers", 2, "--chunk", 10)
    farm.until(lambda: any(scratch.iterdir()) if moment == "start-up" else (out / "parts.jsonl").exists())
    interrupt = os.killpg if to_group else os.kill
    interrupt(client.pid, signal.SIGINT)
    if moment == "twice":
        time.sleep(0.1)
        interrupt(client.pid, signal.SIGINT)
    said, _ = client.communicate(timeout=30)
    assert client.returncode == 130, said
    assert "the same command goes on from there" in said
    for word in ("Traceback", "leaked", "Warning", "semaphore"):
        assert word not in said
    assert not list(scratch.iterdir())
    farm.until(lambda: not _is_there(client.pid))


def _is_there(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True
