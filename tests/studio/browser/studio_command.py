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
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Browser
from tests.studio.browser.hand import CERTIFIED, EXAMPLES


class Command:
    """A studio that runs as a command, at a free port unless one is given."""

    def __init__(self, *options: str, port: int = 0) -> None:
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = port or int(probe.getsockname()[1])
        command = [sys.executable, "-u", "-m", "nullpose", "studio", str(EXAMPLES / "paper.toml")]
        self.process = subprocess.Popen(
            [*command, "--port", str(self.port), *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def address(self) -> str:
        """Return the address that it prints when it is open."""
        assert self.process.stdout is not None
        found = re.search(r"http://\S+", self.process.stdout.readline())
        assert found is not None
        return found[0]

    def ended(self, by: int = signal.SIGINT) -> tuple[str, str]:
        """End it by a signal, and return what it says after its address, and its complaints."""
        os.killpg(self.process.pid, by)
        assert self.process.wait(300.0) == 0
        assert self.process.stdout is not None
        assert self.process.stderr is not None
        with self.process.stdout, self.process.stderr:
            return self.process.stdout.read(), self.process.stderr.read()


Start = Callable[..., Command]


@pytest.fixture
def start() -> Iterator[Start]:
    """Starts studios, none of which outlives the test."""
    with ExitStack() as stack:

        def started(*options: str, port: int = 0) -> Command:
            command = Command(*options, port=port)
            stack.callback(command.process.kill)
            return command

        yield started


def _html(address: str) -> bytes:
    return bytes(urllib.request.urlopen(address, timeout=120.0).read(200)).lower()


def test_interrupt_ends_it_without_a_trace(start: Start) -> None:
    """After Ctrl-C the process and its group are gone, with code 0; rubbish before left no complaint."""
    command = start()
    address = command.address()
    assert address.startswith(f"http://127.0.0.1:{command.port}/?token=")
    for rubbish in (b"rubbish\r\n\r\n", b"\x16\x03\x01\x02", b"GET / HTTP/1.1\r\n\r\n"):
        with socket.create_connection(("127.0.0.1", command.port)) as plain:
            plain.sendall(rubbish)
            plain.shutdown(socket.SHUT_WR)
            plain.recv(1000)
    assert b"html" in _html(address)
    assert command.ended() == ("stopped\n", "")
    with pytest.raises(ProcessLookupError):
        os.killpg(command.process.pid, 0)


def test_the_printed_address_opens_in_a_browser(browser: Browser, start: Start, words: Any) -> None:
    """The scene with its proof, also loaded again, from nowhere else; the bare address shows nothing."""
    words.expected = ["Forbidden"]
    command = start()
    address = command.address()
    page = browser.new_context().new_page()
    page.set_default_timeout(300_000)
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("websocket", lambda websocket: asked.append(websocket.url))
    page.goto(address)
    page.wait_for_function(CERTIFIED)
    page.reload()
    page.wait_for_function(CERTIFIED)
    places = {urlsplit(url).netloc for url in asked if not url.startswith(("blob:", "data:"))}
    assert places == {urlsplit(address).netloc}
    bare = page.goto(address.partition("?")[0])
    assert bare is not None
    assert bare.status == 403
    assert "open the whole address" in page.content()
    page.context.close()
    assert command.ended()[1] == ""


def test_a_port_in_use_ends_with_a_message(start: Start) -> None:
    """A second studio at the same port ends with code 2 and one line, and the first goes on."""
    first = start()
    address = first.address()
    second = start(port=first.port)
    _, err = second.process.communicate(timeout=300.0)
    assert second.process.returncode == 2
    assert f"--port: {first.port} is in use" in err
    assert err.count("\n") == 1
    _html(address)
    first.ended(signal.SIGTERM)


def test_it_listens_to_this_machine_only_unless_told(start: Start) -> None:
    """Without --host other addresses are refused; with one, it says who can come in, and with what."""
    command = start()
    command.address()
    with socket.socket() as probe:
        probe.settimeout(2.0)
        assert probe.connect_ex(("127.0.0.2", command.port)) != 0
    assert "another machine" not in command.ended()[0]
    command = start("--host", "0.0.0.0")
    elsewhere = command.address().replace("localhost", "127.0.0.2")
    assert b"html" in _html(elsewhere)
    with pytest.raises(urllib.error.HTTPError, match="403") as refused:
        _html(elsewhere.partition("?")[0])
    refused.value.close()
    assert "whoever has this address with its token can open the studio" in command.ended()[0]
