"""The rows of a study are the same wherever it runs, in whatever parts."""

import socketserver
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
from distributed import Security

from nullpose.errors import ClusterError
from nullpose.study.monte_carlo import StudyProgress, StudySpec, run_study

Rows = Callable[[Path], pd.DataFrame]
Spec = Callable[..., StudySpec]

CASES = [{"name": "free"}, {"name": "level", "airframe": "tilt-10"}]
SWEEP = {"jammers.M.power_w": [0.1, 10.0]}


def test_the_rows_do_not_depend_on_who_makes_them(farm: Any, spec: Spec, tmp_path: Path, rows: Rows) -> None:
    """In this process, on an embedded cluster of two, on one hand-started worker and on two: row for row."""
    study = spec(cases=CASES, sweep=SWEEP)
    run_study(study, tmp_path / "here", workers=0, chunk=5)
    told: list[StudyProgress] = []
    run_study(study, tmp_path / "embedded", workers=2, chunk=1, on_progress=told.append)
    farm.scheduler()
    farm.worker()
    run_study(study, tmp_path / "one", scheduler=farm.address, chunk=4)
    farm.worker()
    run_study(study, tmp_path / "two", scheduler=farm.address)
    expected = rows(tmp_path / "here")
    assert len(expected) == 12 * 2 * 2
    for folder in ("embedded", "one", "two"):
        pd.testing.assert_frame_equal(rows(tmp_path / folder), expected)
    assert {at.workers for at in told} == {2}
    assert [at.done for at in told if not at.note] == list(range(1, 13))
    assert told[-1].rate > 0.0
    assert told[-1].seconds_left == 0.0


def test_workers_may_come_late(farm: Any, quick: Spec, tmp_path: Path) -> None:
    """Without a worker the run waits for one, and says so."""
    farm.scheduler()
    notes: list[str] = []

    def note(at: StudyProgress) -> None:
        notes.append(at.note)
        if at.note.startswith("no worker") and len(farm.started) == 1:
            farm.worker()

    assert run_study(quick(), tmp_path / "out", scheduler=farm.address, chunk=4, on_progress=note).complete
    assert notes[0] == f"no worker at {farm.address} yet: waiting for one"


def test_a_scheduler_behind_tls(farm: Any, spec_file: Callable[..., Path], tmp_path: Path) -> None:
    """With the certificate that Dask's configuration names it is reached; without it, it is not."""
    own, spec = Security.temporary(), spec_file(tmp_path)
    named = {"CA_FILE": own.tls_ca_file}
    for role in ("client", "scheduler", "worker"):
        named[f"{role.upper()}__CERT"] = own.tls_client_cert
        named[f"{role.upper()}__KEY"] = own.tls_client_key
    without = farm.environment
    farm.environment = dict(without)
    for name, text in named.items():
        (tmp_path / name).write_text(text, encoding="ascii")
        farm.environment[f"DASK_DISTRIBUTED__COMM__TLS__{name}"] = str(tmp_path / name)
    farm.scheduler("--protocol", "tls")
    assert farm.address.startswith("tls://")
    farm.worker()
    run = farm.client(spec, tmp_path / "out")
    said, _ = run.communicate(timeout=60)
    assert run.returncode == 0, said
    farm.environment = without
    run = farm.client(spec, tmp_path / "other")
    said, _ = run.communicate(timeout=60)
    assert run.returncode == 2
    assert "no Dask scheduler answers at tls://" in said


def test_a_server_that_is_no_scheduler(quick: Spec, tmp_path: Path) -> None:
    """Whatever it answers, it is told as one that is not there."""

    class Page(socketserver.BaseRequestHandler):
        def handle(self) -> None:
            self.request.sendall(b"HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")

    with socketserver.TCPServer(("127.0.0.1", 0), Page) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        with pytest.raises(ClusterError, match="no Dask scheduler answers at"):
            run_study(quick(), tmp_path, scheduler=f"tcp://127.0.0.1:{server.server_address[1]}")
        server.shutdown()


@pytest.mark.parametrize("address", ["nowhere", "http://127.0.0.1:1", "tcp://127.0.0.1:notaport"])
def test_an_address_that_is_none(quick: Spec, tmp_path: Path, address: str) -> None:
    """It is refused in this package's words."""
    with pytest.raises(ClusterError, match="no Dask scheduler answers at"):
        run_study(quick(), tmp_path / "out", scheduler=address)
