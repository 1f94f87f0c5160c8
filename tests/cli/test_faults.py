"""Bad input at the command line: exit code 2, each fault with its place and what is allowed, no traceback."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from sizes import chosen
from typer.testing import Result

import nullpose.cli.check
from nullpose.cli.faults import BAD_INPUT, INTERNAL, INTERRUPTED, PIPE_CLOSED
from nullpose.errors import SolveError
from scenes import Run

Process = Callable[..., subprocess.CompletedProcess[str]]


@pytest.fixture
def good(paper: str, tmp_path: Path) -> Path:
    """A scenario file without faults, in a folder of its own."""
    return Path(shutil.copy(paper, tmp_path / "good.toml"))


def assert_refused(result: Result | subprocess.CompletedProcess[str], *words: str) -> None:
    """The run ended as bad input ends: its words on standard error only, no traceback."""
    code = result.exit_code if isinstance(result, Result) else result.returncode
    assert code == BAD_INPUT, result.stderr
    assert result.stdout == ""
    assert "Traceback" not in result.stderr
    assert [word for word in words if word not in result.stderr] == [], result.stderr


def test_all_faults_at_once(run: Run, good: Path) -> None:
    """Three faults are three messages, each with its place; broken TOML has a line and a column."""
    text = good.read_text(encoding="utf-8")
    bad = text.replace("[8.0, 30.0]", "[30.0, 8.0]").replace("noise_w = 1e-3", "noise_w = nan")
    good.write_text(bad.replace('"S2"', '"S1"'), encoding="utf-8")
    words = ("3 faults", "airspace.altitude_m", "receiver.noise_w: got NaN", "nodes[1].name")
    assert_refused(run("compare", good), f"error: {good}: ", *words)
    good.write_text(text.replace("[8.0, 30.0]", "[8.0, 30.0"), encoding="utf-8")
    assert_refused(run("solve", good), f"error: {good}: 1 fault", "line ", "column")


def test_unreadable_file(run: Run, tmp_path: Path) -> None:
    """A folder in place of a file is refused, and so are bytes that are no text."""
    assert_refused(run("solve", tmp_path), str(tmp_path), "folder")
    path = tmp_path / "bytes.toml"
    path.write_bytes(b"\xff\xfe\x00\x80")
    assert_refused(run("solve", path), str(path))


@pytest.mark.parametrize("inside", [False, True])
def test_output_folder_that_cannot_be_written(
    run: Run, good: Path, inside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file where the folder should be, or above it, is refused before any work."""
    monkeypatch.setattr("nullpose.study.sweep", None)
    out = good / "deeper" if inside else good
    arguments = ("--from", 1, "--to", 2, "--out", out)
    assert_refused(run("sweep", good, "--set", "jammers.M.power_w", *arguments), "cannot write", str(out))
    assert_refused(run("reproduce", "--out", out), "cannot write", str(out))
    assert good.is_file()


def _raising(error: BaseException) -> object:
    def show(*_: object) -> None:
        raise error

    return show


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (SolveError("no pose reaches every node"), INTERNAL, "error: no pose reaches every node\n"),
        (KeyboardInterrupt(), INTERRUPTED, "interrupted\n"),
    ],
)
def test_exit_codes(
    run: Run, good: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, words: str
) -> None:
    """A solve without an answer and an interrupt end with a line and a code of their own."""
    monkeypatch.setattr(nullpose.cli.check, "show", _raising(error))
    result = run("check", good)
    assert (result.exit_code, result.stderr) == (code, words)


def test_interrupt_that_comes_out_as_another_error(
    run: Run, good: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An interrupt that native code swallowed is still told as one."""

    def show(*_: object) -> None:
        try:
            signal.raise_signal(signal.SIGINT)
        except KeyboardInterrupt:
            raise RuntimeError("half compiled") from None

    monkeypatch.setattr(nullpose.cli.check, "show", show)
    result = run("check", good)
    assert (result.exit_code, result.stderr) == (INTERRUPTED, "interrupted\n")


def test_internal_fault_asks_for_a_report(run: Run, good: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """An error that nobody foresaw keeps its traceback, and says whose fault it is."""
    monkeypatch.setattr(nullpose.cli.check, "show", _raising(RuntimeError("unforeseen")))
    result = run("check", good)
    assert result.exit_code == INTERNAL
    assert "report it" in result.exception.__notes__[0]


def test_interrupt_of_the_real_program(good: Path, tmp_path: Path) -> None:
    """Ctrl-C in the middle of a sweep ends it with a short line and code 130."""
    power = ("--set", "jammers.M.power_w", "--from", "1", "--to", "2", "--points", "2000")
    program = subprocess.Popen(
        [sys.executable, "-m", "nullpose", "sweep", str(good), *power, "--out", str(tmp_path / "out")],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while not (tmp_path / "out").exists() and program.poll() is None:
        time.sleep(0.05)
    time.sleep(1.0)  # by now it solves
    program.send_signal(signal.SIGINT)
    stdout, stderr = program.communicate(timeout=600)
    # A signal that hits code run from a text makes Python end by the signal itself, which shells show as 130.
    assert program.returncode in (INTERRUPTED, -signal.SIGINT)
    assert stdout == ""
    assert stderr.endswith("interrupted\n")
    assert "Traceback" not in stderr


@pytest.mark.parametrize("arguments", chosen([["schema"], ["check", "FILE"]], [1]))
def test_reader_that_goes_away(good: Path, arguments: list[str]) -> None:
    """A closed pipe ends the program without a word."""
    words = [str(good) if argument == "FILE" else argument for argument in arguments]
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "wb") as pipe:
        done = subprocess.run(
            [sys.executable, "-m", "nullpose", *words], stdout=pipe, stderr=subprocess.PIPE, check=False
        )
    assert (done.returncode, done.stderr) == (PIPE_CLOSED, b"")


@pytest.mark.parametrize(
    ("arguments", "path", "words"),
    [
        (("--set", "jammers.M.power_w=-1"), "jammers[0].power_w", "must be a power in W"),
        (("--scheme", "optimun"), "", "did you mean 'optimum'?"),
        (("--sceme", "optimum"), "", "--sceme"),
    ],
)
def test_a_fault_is_an_object(
    run: Run, paper: str, arguments: tuple[str, ...], path: str, words: str
) -> None:
    """It has every fault with its path, and the exit code; standard output stays empty."""
    result = run("solve", paper, "--json", *arguments)
    told = json.loads(result.stderr.splitlines()[-1])
    assert (result.exit_code, result.stdout, told["exit_code"]) == (2, "", 2)
    assert list(told) == ["error", "source", "faults", "exit_code"]
    assert told["faults"][0]["path"] == path
    assert words in told["faults"][0]["message"]


def test_every_fault_is_there(run: Run, paper: str) -> None:
    """More than the twenty that a text tells."""
    settings = [word for i in range(30) for word in ("--set", f"jammers.M{i}.power_w=1")]
    told = json.loads(run("check", paper, "--json", *settings).stderr)
    assert (told["error"], len(told["faults"])) == ("ScenarioError", 30)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize(
    ("stream", "verb"),
    chosen(
        [
            (">/dev/full", ("--version",)),
            (">&-", ("--help",)),
            (">/dev/full", ("schema",)),
            (">&-", ("check", "examples/paper.toml")),
        ],
        [1, 2],
    ),
)
def test_an_output_that_takes_nothing_is_one_line(stream: str, verb: tuple[str, ...]) -> None:
    """A full disk or a closed output ends with a line on standard error and the code of bad input."""
    command = f'"$0" -m nullpose "$@" {stream}'
    done = subprocess.run(["sh", "-c", command, sys.executable, *verb], capture_output=True, text=True)
    assert done.returncode == BAD_INPUT
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: standard output cannot be written: ")


def test_narrow_terminals_count_as_twenty_columns() -> None:
    """Tables are still words then, not letters below each other."""
    command = [sys.executable, "-m", "nullpose", "check", "examples/paper.toml"]
    outputs = [
        subprocess.run(command, capture_output=True, env=os.environ | {"COLUMNS": columns}).stdout
        for columns in ("0", "20")
    ]
    assert outputs[0] == outputs[1]
    assert b"Airspace" in outputs[0]
