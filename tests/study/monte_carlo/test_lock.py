"""One client writes a folder; what a dead one left is taken over."""

import os
import signal
import socket
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from nullpose import OutputError
from nullpose.study.monte_carlo import StudySpec, run_study
from nullpose.study.monte_carlo.lock import holder, locked

Spec = Callable[..., StudySpec]


def test_a_second_client_is_refused(tmp_path: Path) -> None:
    """While one holds the folder another is told which process does."""
    with locked(tmp_path):
        assert holder(tmp_path) == f"process {os.getpid()} on {socket.gethostname()}"
        with (
            pytest.raises(OutputError, match=f"process {os.getpid()} on .* writes this study now"),
            locked(tmp_path),
        ):
            pass
    assert holder(tmp_path) == ""
    with locked(tmp_path):
        pass


def test_the_lock_of_a_dead_client_is_taken_over(tmp_path: Path, quick: Spec) -> None:
    """A file that names a process of this machine without the system's lock stops nobody."""
    (tmp_path / "lock").write_text(f"process 1 on {socket.gethostname()}\n", encoding="utf-8")
    assert holder(tmp_path) == ""
    assert run_study(quick(), tmp_path, workers=0).complete


def test_the_lock_of_another_machine_is_left(tmp_path: Path, quick: Spec) -> None:
    """Whether its process lives cannot be told from here: the message says what to remove."""
    (tmp_path / "lock").write_text("process 77 on elsewhere\n", encoding="utf-8")
    assert holder(tmp_path) == "process 77 on elsewhere"
    with pytest.raises(OutputError, match=r"process 77 on elsewhere .* remove .*lock"):
        run_study(quick(), tmp_path, workers=0)


def test_half_a_lock(tmp_path: Path, quick: Spec) -> None:
    """Half a file from a killed client is taken over too."""
    (tmp_path / "lock").write_text("process ", encoding="utf-8")
    assert run_study(quick(), tmp_path, workers=0).complete


def test_two_programs_at_once(farm: Any, spec_file: Any, tmp_path: Path) -> None:
    """The second ends with a message while the first goes on."""
    spec, out = spec_file(tmp_path, scenes=10**6), tmp_path / "out"
    command = ("nullpose", "study", "run", spec, "--out", out, "--workers", 0)
    first = farm.start(*command, "--chunk", 10)
    farm.until(lambda: (out / "parts.jsonl").exists())
    second = farm.start(*command)
    said, _ = second.communicate(timeout=60)
    assert second.returncode == 2
    assert f"process {first.pid} on {socket.gethostname()} writes this study now" in said
    assert first.poll() is None
    os.killpg(first.pid, signal.SIGKILL)


def test_a_lock_of_other_bytes_names_nobody(tmp_path: Path) -> None:
    """Whatever stands in the file, the command that reads it goes on."""
    (tmp_path / "lock").write_bytes(b"process \xff\xaa on here\n")
    assert holder(tmp_path) == ""
