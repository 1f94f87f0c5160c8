"""The command: its messages, and that nothing of it is left behind."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

PAPER = Path(__file__).parents[3] / "examples" / "paper.toml"


def _command(*arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-u", "-m", "nullpose", "studio", str(PAPER), *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def _open(port: int, seconds: float = 60.0) -> bytes:
    until = time.monotonic() + seconds
    while True:
        try:
            return bytes(urllib.request.urlopen(f"http://127.0.0.1:{port}", timeout=5.0).read(200))
        except OSError:
            assert time.monotonic() < until
            time.sleep(0.05)


def test_interrupt_ends_it_without_a_trace() -> None:
    """After Ctrl-C the process and all of its group are gone, with code 0 and no complaint."""
    port = _free_port()
    process = _command("--port", str(port))
    assert b"html" in _open(port).lower()
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=30.0)
    assert (process.returncode, err) == (0, "")
    assert f"http://127.0.0.1:{port}" in out
    try:
        os.killpg(process.pid, 0)
        alone = False
    except ProcessLookupError:
        alone = True
    assert alone


def test_a_port_in_use_ends_with_a_message() -> None:
    """A second studio at the same port ends with code 2 and one line, and the first goes on."""
    port = _free_port()
    first = _command("--port", str(port))
    _open(port)
    second = _command("--port", str(port))
    _, err = second.communicate(timeout=60.0)
    assert second.returncode == 2
    assert f"--port: {port} is in use" in err
    assert err.count("\n") == 1
    _open(port)
    first.send_signal(signal.SIGTERM)
    first.communicate(timeout=30.0)
    assert first.returncode == 0


def test_it_listens_to_this_machine_only_unless_told() -> None:
    """Without --host other addresses are refused; with one, it says who can come in."""
    port = _free_port()
    process = _command("--port", str(port))
    _open(port)
    with socket.socket() as probe:
        probe.settimeout(2.0)
        assert probe.connect_ex(("127.0.0.2", port)) != 0
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=30.0)
    assert "other machines" not in out
    port = _free_port()
    process = _command("--port", str(port), "--host", "0.0.0.0")
    _open(port)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=30.0)
    assert "other machines can open it too" in out
