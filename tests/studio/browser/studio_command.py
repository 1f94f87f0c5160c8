"""The command: its messages, the address that it prints, and that nothing of it is left behind."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser

PAPER = Path(__file__).parents[3] / "examples" / "paper.toml"
CERTIFIED = "document.querySelector('[data-np=status-0]')?.innerText.includes('certified to')"


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


def _address(process: subprocess.Popen[str]) -> str:
    """Returns the address that a studio prints when it is open."""
    assert process.stdout is not None
    found = re.search(r"http://\S+", process.stdout.readline())
    assert found is not None
    return found[0]


def _ended(process: subprocess.Popen[str]) -> tuple[str, str]:
    """Returns what a studio said after its address, and its complaints."""
    assert process.stdout is not None
    assert process.stderr is not None
    process.wait(30.0)
    with process.stdout, process.stderr:
        return process.stdout.read(), process.stderr.read()


def _html(address: str) -> bytes:
    return bytes(urllib.request.urlopen(address, timeout=5.0).read(200)).lower()


def test_interrupt_ends_it_without_a_trace() -> None:
    """After Ctrl-C the process and all of its group are gone, with code 0 and no complaint."""
    port = _free_port()
    process = _command("--port", str(port))
    address = _address(process)
    assert address.startswith(f"http://127.0.0.1:{port}/?token=")
    assert b"html" in _html(address)
    os.killpg(process.pid, signal.SIGINT)
    assert _ended(process) == ("stopped\n", "")
    assert process.returncode == 0
    try:
        os.killpg(process.pid, 0)
        alone = False
    except ProcessLookupError:
        alone = True
    assert alone


def test_the_printed_address_opens_in_a_browser(browser: Browser, words: Any) -> None:
    """The scene with its proof, also loaded again, from nowhere else; the bare address shows nothing."""
    words.expected = ["Forbidden"]
    process = _command("--port", str(_free_port()))
    address = _address(process)
    page = browser.new_context().new_page()
    page.set_default_timeout(90_000)
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("websocket", lambda websocket: asked.append(websocket.url))
    page.goto(address)
    page.wait_for_function(CERTIFIED)
    page.reload()
    page.wait_for_function(CERTIFIED)
    assert {urlsplit(url).netloc for url in asked if not url.startswith(("blob:", "data:"))} == {
        urlsplit(address).netloc
    }
    bare = page.goto(address.partition("?")[0])
    assert bare is not None
    assert bare.status == 403
    assert "open the whole address" in page.content()
    page.context.close()
    process.send_signal(signal.SIGINT)
    assert _ended(process)[1] == ""


def test_what_is_no_http_leaves_no_word_in_the_terminal() -> None:
    """Whoever sends rubbish to the port fills no terminal with it, and the studio goes on."""
    port = _free_port()
    process = _command("--port", str(port))
    address = _address(process)
    for rubbish in (b"rubbish\r\n\r\n", b"\x16\x03\x01\x02", b"GET / HTTP/1.1\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", port)) as plain:
            plain.sendall(rubbish)
            plain.shutdown(socket.SHUT_WR)
            plain.recv(1000)
    _html(address)
    process.send_signal(signal.SIGINT)
    assert _ended(process) == ("stopped\n", "")


def test_a_port_in_use_ends_with_a_message() -> None:
    """A second studio at the same port ends with code 2 and one line, and the first goes on."""
    port = _free_port()
    first = _command("--port", str(port))
    address = _address(first)
    second = _command("--port", str(port))
    _, err = second.communicate(timeout=60.0)
    assert second.returncode == 2
    assert f"--port: {port} is in use" in err
    assert err.count("\n") == 1
    _html(address)
    first.send_signal(signal.SIGTERM)
    _ended(first)
    assert first.returncode == 0


def test_it_listens_to_this_machine_only_unless_told() -> None:
    """Without --host other addresses are refused; with one, it says who can come in, and with what."""
    port = _free_port()
    process = _command("--port", str(port))
    _address(process)
    with socket.socket() as probe:
        probe.settimeout(2.0)
        assert probe.connect_ex(("127.0.0.2", port)) != 0
    process.send_signal(signal.SIGINT)
    assert "another machine" not in _ended(process)[0]
    process = _command("--port", str(port), "--host", "0.0.0.0")
    address = _address(process)
    elsewhere = address.replace("localhost", "127.0.0.2")
    assert b"html" in _html(elsewhere)
    with pytest.raises(urllib.error.HTTPError, match="403") as refused:
        _html(elsewhere.partition("?")[0])
    refused.value.close()
    process.send_signal(signal.SIGINT)
    assert (
        "whoever has this address with its token can open the studio from another machine"
        in (_ended(process)[0])
    )
