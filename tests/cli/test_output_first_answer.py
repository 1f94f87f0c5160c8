"""The first answer, from an empty folder of kernels, each in a process of its own."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
PAPER, FRAME = (ROOT / "examples" / f"{name}.toml" for name in ("paper", "frame"))
MOST_S = 600.0  # of compiling on a busy machine

Start = Callable[..., subprocess.Popen[str]]


def with_folder(folder: Path) -> list[int]:
    """Returns the processes that a test has started, and those that they have, by its folder of kernels."""
    mark = f"NULLPOSE_TEST_KERNELS={folder}".encode()
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            is_here = mark in (process / "environ").read_bytes().split(b"\0")
        except OSError:
            continue
        found += [int(process.name)] * is_here
    return found


def until(met: Callable[[], bool]) -> None:
    """Waits for what other processes do."""
    end = time.monotonic() + MOST_S
    while not met():
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Starts the program in a process group of its own, with kernels in an empty folder; ends it at last.

    A warm one has the folder that all tests share, in which there are kernels.
    """
    folder = str(tmp_path / "kernels")
    marked = os.environ | {"NULLPOSE_TEST_KERNELS": folder, "COLUMNS": "200"}

    def begin(*arguments: object, is_warm: bool = False) -> subprocess.Popen[str]:
        return subprocess.Popen(
            [sys.executable, "-m", "nullpose", *map(str, arguments)],
            env=marked if is_warm else marked | {"NUMBA_CACHE_DIR": folder},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            process_group=0,
        )

    yield begin
    for each in with_folder(tmp_path / "kernels"):
        os.kill(each, signal.SIGKILL)


def answered(program: subprocess.Popen[str]) -> tuple[dict[str, Any], str]:
    """Returns what a program has printed as JSON, without how long it took, and what is on standard error."""
    out, err = program.communicate(timeout=MOST_S)
    assert program.returncode == 0, err
    found = json.loads(out)
    del found["stats"]["wall_s"]
    return found, err


def most_at_once(program: subprocess.Popen[str], folder: Path) -> int:
    """Returns how many processes there are at most until a program ends."""
    most = 0
    while program.poll() is None:
        most = max(most, len(with_folder(folder)))
        time.sleep(0.02)
    return most


def flat(value: Any, path: str = "") -> dict[str, Any]:
    """Returns what JSON holds, by path."""
    if not isinstance(value, dict | list):
        return {path: value}
    items = value.items() if isinstance(value, dict) else enumerate(value)
    return {key: leaf for name, each in items for key, leaf in flat(each, f"{path}.{name}").items()}


def test_the_first_answer_waits_for_no_compiler(start: Start, tmp_path: Path) -> None:
    """It is that of machine code, with its proof, before the kernels are compiled, which goes on after it."""
    first, err = answered(
        start("solve", PAPER, "--json", "--verify", "--certificate", tmp_path / "paper.cert.json")
    )
    assert with_folder(tmp_path / "kernels")
    assert first["rigour"] == "verified"
    assert err.count("Compiling kernels") == err.count("\n") <= 1  # a busy machine takes seconds
    for each in with_folder(tmp_path / "kernels"):
        os.kill(each, signal.SIGKILL)
    until(lambda: not with_folder(tmp_path / "kernels"))
    program = start("solve", PAPER, "--json", "--verify", is_warm=True)
    assert most_at_once(program, tmp_path / "kernels") == 1
    second, _ = answered(program)
    del first["files"]
    one, other = flat(first), flat(second)
    assert one.keys() == other.keys()
    for path, value in one.items():
        is_number = isinstance(value, float)
        assert other[path] == (pytest.approx(value, rel=1e-9) if is_number else value), path


@pytest.mark.grid
def test_the_terminal_that_closes_ends_no_compilation(start: Start, tmp_path: Path) -> None:
    """What hangs up the program and all of its group leaves the kernels to be compiled."""
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)  # nohup has it ignored, and so all that it starts
    program = start("solve", FRAME, "--json")
    signal.signal(signal.SIGHUP, before)
    kernels, compilers = tmp_path / "kernels", set[int]()

    def is_compiling() -> bool:
        for each in with_folder(kernels):
            with suppress(OSError):
                if b"background_compiler" in Path(f"/proc/{each}/cmdline").read_bytes():
                    compilers.add(each)
        return bool(compilers) or program.poll() is not None

    until(is_compiling)
    assert program.poll() is None
    os.killpg(program.pid, signal.SIGHUP)
    program.communicate(timeout=MOST_S)
    time.sleep(0.3)  # by now the signal has ended whom it can
    assert compilers & set(with_folder(kernels)) or list(kernels.rglob("*.nbc"))


def test_ctrl_c_ends_the_compilation_too(start: Start, tmp_path: Path) -> None:
    """A terminal sends Ctrl-C to the whole group; the code is that of interrupts, and no process is left."""
    program = start("solve", FRAME)
    until(lambda: len(with_folder(tmp_path / "kernels")) > 1)
    os.killpg(program.pid, signal.SIGINT)
    _, err = program.communicate(timeout=MOST_S)
    assert program.returncode == 130
    assert "Traceback" not in err
    until(lambda: not with_folder(tmp_path / "kernels"))


@pytest.mark.grid
def test_a_second_command_starts_no_second_compilation(start: Start, tmp_path: Path) -> None:
    """While one compiles, another has Python prove its answer to the end, but for a limit that it states."""
    import fcntl

    answered(start("solve", PAPER, "--json"))
    for each in with_folder(tmp_path / "kernels"):
        os.kill(each, signal.SIGKILL)
    (lock,) = (tmp_path / "kernels").rglob("compiling.lock")
    with lock.open("r+") as held:
        until(lambda: not with_folder(tmp_path / "kernels"))
        fcntl.flock(held, fcntl.LOCK_EX)
        program = start("solve", PAPER, "--json")
        assert most_at_once(program, tmp_path / "kernels") == 1
        found, _ = answered(program)
        assert found["status"] == "certified"
        ended, _ = answered(start("solve", PAPER, "--json", "--time-limit", "0.01"))
        assert ended["reason"] == "the time limit of 0.01 s"
        assert ended["objective"]["upper_bound"] > found["objective"]["value"] >= 1.25
        assert not with_folder(tmp_path / "kernels")
