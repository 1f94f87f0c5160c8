"""Who is let into the studio, asked of real servers by real clients; run with ``make test-studio``."""

from __future__ import annotations

import http.client
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from types import SimpleNamespace
from typing import Any
from urllib.parse import urlsplit

import msgspec
import pytest
import viser
from playwright.sync_api import Browser
from viser import _messages
from viser.infra import _infra
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

from nullpose.errors import UsageError
from nullpose.scenario import Scenario
from nullpose.solver import solve
from nullpose.studio.guard import LOOPBACK, open_server
from nullpose.studio.server import MOST_PAGES, studio

PROTOCOL: Any = f"viser-v{viser.__version__}"
OTHER_TOKEN = "A" * 43

Answer = Callable[[str, str | None, str], int]


class Asked:
    """A server, and what it answers to a host, an origin and a query."""

    def __init__(self, address: str) -> None:
        parts = urlsplit(address)
        assert parts.port is not None
        self.port, self.query = parts.port, parts.query

    def get(self, path: str, host: str, origin: str | None = None) -> tuple[int, Any]:
        """Return the status and the headers of what is at a path."""
        headers = {"Host": host} | ({} if origin is None else {"Origin": origin})
        connection = http.client.HTTPConnection(LOOPBACK, self.port, timeout=120.0)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        answer.read()
        connection.close()
        return answer.status, answer.headers

    def page(self, host: str, origin: str | None, query: str) -> int:
        """Return the status of the page."""
        return self.get(f"/index.html?{query}", host, origin)[0]

    def websocket(self, host: str, origin: str | None, query: str) -> int:
        """Return the status of a handshake; 200 stands for one that is let in."""
        more: Any = {"additional_headers": {} if origin is None else {"Origin": origin}}
        with socket.create_connection((LOOPBACK, self.port)) as plain:
            try:
                connect(f"ws://{host}/?{query}", sock=plain, subprotocols=[PROTOCOL], **more).close()
            except InvalidStatus as refused:
                return int(refused.response.status_code)
        return 200


@pytest.fixture(scope="module")
def alone() -> Iterator[Asked]:
    """A server that listens to this machine alone."""
    server, address = open_server(LOOPBACK, 0)
    yield Asked(address)
    server.stop()


@pytest.fixture(scope="module")
def everywhere() -> Iterator[Asked]:
    """A server that listens to all."""
    server, address = open_server("0.0.0.0", 0)
    yield Asked(address)
    server.stop()


@pytest.fixture(params=["alone", "everywhere"])
def asked(request: pytest.FixtureRequest) -> Asked:
    """Each of the two."""
    return request.getfixturevalue(request.param)


@pytest.fixture(params=["page", "websocket"])
def kind(request: pytest.FixtureRequest) -> str:
    """What is asked for."""
    return str(request.param)


def test_the_token_lets_in_and_nothing_else(asked: Asked, kind: str) -> None:
    """By every name of this machine, from the studio's page and from what is no browser."""
    answer: Answer = getattr(asked, kind)
    wrong = ("", "token=", f"token={OTHER_TOKEN}", "token=%FF%00", "tokens=1;token", asked.query[:-1])
    for name in ("localhost", "127.0.0.1", "[::1]"):
        host = f"{name}:{asked.port}"
        for origin in (f"http://{host}", None):
            assert answer(host, origin, asked.query) == 200
            assert [answer(host, origin, query) for query in wrong] == len(wrong) * [403]


def test_another_pages_origin_is_refused(asked: Asked, kind: str) -> None:
    """With the right token, too: also a page of this machine at another port, and one without an address."""
    answer: Answer = getattr(asked, kind)
    host = f"localhost:{asked.port}"
    for origin in (
        "http://evil.example",
        "null",
        "",
        "http://localhost",
        "http://localhost:1",
        f"https://{host}",
    ):
        assert answer(host, origin, asked.query) == 403, origin


def test_another_host_is_refused(alone: Asked, kind: str) -> None:
    """A name that is made to point here afterwards is none of the studio's, whatever else is right."""
    answer: Answer = getattr(alone, kind)
    for name in ("evil.example:{}", "localhost", "localhost:1", "evil.localhost:{}", "127.0.0.2:{}"):
        host = name.format(alone.port)
        assert [answer(host, origin, alone.query) for origin in (f"http://{host}", None)] == [403, 403], host


def test_a_machine_with_many_names_is_asked_by_its_own_page(
    everywhere: Asked, alone: Asked, kind: str
) -> None:
    """Where all may come any name will do, but the page must be of the one that is asked, with its token."""
    answer: Answer = getattr(everywhere, kind)
    assert answer("box.example:8080", None, alone.query) == 403
    assert answer("box.example:8080", "http://box.example:8080", everywhere.query) == 200
    assert answer("box.example:8080", "http://other.example:8080", everywhere.query) == 403


def test_two_hosts_or_two_origins_are_refused(alone: Asked) -> None:
    """What is said twice is not chosen from."""
    host = f"localhost:{alone.port}"
    once = [f"Host: {host}", f"Origin: http://{host}"]
    for more, status in ([], 200), ([once[0]], 403), (["Origin: http://evil.example"], 403):
        head = "\r\n".join([f"GET /index.html?{alone.query} HTTP/1.1", *once, *more, "", ""])
        with socket.create_connection((LOOPBACK, alone.port)) as plain:
            plain.sendall(head.encode())
            assert plain.recv(1000).startswith(b"HTTP/1.1 %d " % status)


def test_the_page_keeps_its_token_and_stands_in_no_frame(alone: Asked) -> None:
    """What is asked for names its address to nobody, stands in no page, and sets no cookie."""
    assert len(alone.query) == len("token=") + 43
    host = f"localhost:{alone.port}"
    for path in ("/", "/index.html", "/alive"):
        status, headers = alone.get(f"{path}?{alone.query}&fixedDpr=0.5", host)
        assert status == 200
        assert headers["Referrer-Policy"] == "no-referrer"
        assert headers["Content-Security-Policy"] == "frame-ancestors 'none'"
        assert headers["Set-Cookie"] is None
    for query, origin in ((f"token={OTHER_TOKEN}", None), ("", None), (alone.query, "http://evil.example")):
        assert alone.get(f"/alive?{query}", host, origin)[0] == 403  # also whether the studio still runs


def test_a_viser_that_cannot_be_guarded_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """If it opens its server in another way, no studio opens, and the message says what to install."""
    whole = _infra.websockets
    elsewhere = SimpleNamespace(**vars(whole.asyncio.server))
    others = {"asyncio": SimpleNamespace(server=elsewhere)}
    monkeypatch.setattr(_infra, "websockets", SimpleNamespace(**vars(whole) | others))
    with socket.socket() as probe:
        probe.bind((LOOPBACK, 0))
        port = probe.getsockname()[1]
    with pytest.raises(UsageError, match=r"viser>=1\.1,<2"):
        open_server(LOOPBACK, port)
    with socket.socket() as probe:
        assert probe.connect_ex((LOOPBACK, port)) != 0


def test_no_page_gets_a_tunnel_from_the_internet() -> None:
    """A page that asks for an address at viser's public server gets none, and nothing goes out."""
    server, address = open_server(LOOPBACK, 0)
    with _page(address) as page:
        page.send(_packed(_messages.ShareUrlRequest()))
        _until(server.get_clients)
        time.sleep(0.5)
        assert server._share_tunnel is None
    server.stop()


def test_the_ninth_page_is_told_and_gets_no_thread(browser: Browser, paper: Scenario) -> None:
    """It says so on its page; when another has closed, it is served."""
    solve(paper)  # kernels that are there: a thread that waits for a compiler ends late
    before = _threads()
    with studio(paper, port=0) as running, browser.new_context() as context, ExitStack() as stack:
        pages = [stack.enter_context(_page(running.address)) for _ in range(MOST_PAGES)]
        _until(lambda: len(running.pages) == MOST_PAGES)
        ninth = context.new_page()
        ninth.set_default_timeout(300_000)
        ninth.goto(running.address)
        ninth.get_by_text(f"{MOST_PAGES} pages are open").wait_for()
        assert len(running.pages) == _threads() - before == MOST_PAGES
        pages[0].close()
        _until(lambda: len(running.pages) == MOST_PAGES - 1)
        ninth.reload()
        _until(lambda: len(running.pages) == _threads() - before == MOST_PAGES)
        context.close()
    _until(lambda: _threads() == before)


def _threads() -> int:
    return sum(thread.name == "nullpose-studio-worker" for thread in threading.enumerate())


def _page(address: str) -> ClientConnection:
    """Returns a websocket that behaves like a page, as far as a server sees."""
    opened = connect(
        address.replace("http://", "ws://"), subprotocols=[PROTOCOL], max_size=None, max_queue=None
    )
    place = {"wxyz": (1.0, 0.0, 0.0, 0.0), "position": (9.0, 9.0, 9.0), "look_at": (0.0, 0.0, 0.0)}
    lens = {"fov": 1.0, "near": 0.1, "far": 100.0, "image_height": 100, "image_width": 100}
    opened.send(_packed(_messages.ViewerCameraMessage(**place, **lens, up_direction=(0.0, 0.0, 1.0))))
    return opened


def _packed(message: Any) -> bytes:
    return bytes(msgspec.msgpack.encode(message.as_serializable_dict([])))


def _until(met: Callable[[], object]) -> None:
    until = time.monotonic() + 300.0
    while not met():
        assert time.monotonic() < until, "it did not happen in time"
        time.sleep(0.02)
