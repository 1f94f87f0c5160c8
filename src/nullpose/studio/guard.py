"""The gate before viser, and the server behind it: requests with the token, from this page; and its frame."""

from __future__ import annotations

import ctypes
import hmac
import logging
import secrets
import socket
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import cache, partial
from http import HTTPStatus
from importlib.resources import files
from ipaddress import ip_address
from typing import TYPE_CHECKING, Any, TypeAlias
from urllib.parse import parse_qs

import rich

from nullpose.errors import UsageError, install_command

if TYPE_CHECKING:
    from viser import ViserServer
    from websockets.asyncio.server import ServerConnection
    from websockets.http11 import Request, Response

_Answer: TypeAlias = "Callable[[ServerConnection, Request], Response | None]"

_LOOPBACK_NAMES = {"localhost", "127.0.0.1", "::1"}
_ALIVE = "/alive"  # where a page asks whether its studio still runs
_HEADERS = {"Referrer-Policy": "no-referrer", "Content-Security-Policy": "frame-ancestors 'none'"}

_NO_TOKEN = "The token is missing or of another run: open the whole address that nullpose studio printed.\n"
_NOT_OURS = "The studio answers only at the address that it printed, and only to its own page.\n"

_patching = threading.Lock()
_log = logging.getLogger("nullpose.studio.requests")
# what others send that is no HTTP is no fault of ours, and fills no terminal
_log.addFilter(lambda record: record.getMessage() != "opening handshake failed")


PREFERS_DARK: ContextVar[bool] = ContextVar("prefers_dark")
"""Whether the browser whose websocket the running task serves prefers dark pages."""


class Guard:
    """Sees every request before viser does, for a page and for a websocket alike.

    No cookie is set: browsers send one to every port of a host, thus to other people's servers on it too.
    The token is in the page's address, and the script of the frame puts it into that of the websocket.

    Args:
        host: address that is listened at, as it was given.
        bound: the same as a number.
    """

    def __init__(self, host: str, bound: str) -> None:
        self._host, self._token = host.lower(), secrets.token_urlsafe(32)
        self._anywhere = ip_address(bound).is_unspecified
        self._names = {self._host, bound} | (_LOOPBACK_NAMES if ip_address(bound).is_loopback else set())
        self.stands = False

    def address(self, port: int) -> str:
        """Return the address to open in a browser, with the token.

        Args:
            port: where the server listens.
        """
        name = "localhost" if self._anywhere else self._host
        return f"http://{_bracketed(name)}:{port}/?token={self._token}"

    @contextmanager
    def before_viser(self) -> Iterator[None]:
        """Stand before the server that viser opens in the block; ``stands`` tells whether that came about."""
        from websockets.asyncio import server

        serve = server.serve

        def guarded(*arguments: object, process_request: Any = None, **options: object) -> object:
            self.stands = process_request is not None
            options |= {"process_request": partial(self._answer, process_request), "logger": _log}
            return serve(*arguments, **options)

        with _patching:
            server.serve = guarded  # the only way in: viser hands none of its settings through
            try:
                yield
            finally:
                server.serve = serve

    def _answer(self, viser: _Answer, connection: ServerConnection, request: Request) -> Response | None:
        """Return the response to a request; None lets a websocket be opened."""
        hosts, origins = request.headers.get_all("Host"), request.headers.get_all("Origin")
        if not self._ours(hosts, origins, connection.local_address[1]):
            return connection.respond(HTTPStatus.FORBIDDEN, _NOT_OURS)
        path, _, query = request.path.partition("?")
        values = parse_qs(query)
        if not hmac.compare_digest(values.get("token", [""])[0].encode(), self._token.encode()):
            return connection.respond(HTTPStatus.FORBIDDEN, _NO_TOKEN)
        if "Upgrade" in request.headers:  # this task goes on to serve the websocket
            PREFERS_DARK.set(values.get("dark") == ["1"])
        if path == _ALIVE:
            response = connection.respond(HTTPStatus.OK, "")
        else:
            response = _page(viser, connection, request) if path == "/" else viser(connection, request)
        if response is not None:
            response.headers.update(_HEADERS)
        return response

    def _ours(self, hosts: list[str], origins: list[str], port: int) -> bool:
        """Check that a request is to the address listened at, and from no other's page."""
        if len(hosts) != 1 or any(origin.lower() != f"http://{hosts[0].lower()}" for origin in origins):
            return False
        names = {_bracketed(name) for name in self._names}
        allowed = {f"{name}:{port}" for name in names} | (names if port == 80 else set())
        return self._anywhere or hosts[0].lower() in allowed


def _page(viser: _Answer, connection: ServerConnection, request: Request) -> Response | None:
    """Return viser's page with what the studio adds to it; None for a websocket."""
    request.headers.pop("Accept-Encoding", None)
    if (response := viser(connection, request)) is not None:
        response.body = framed(response.body)
        response.headers.pop("Content-Length")
        response.headers["Content-Length"] = str(len(response.body))
    return response


def framed(page: bytes) -> bytes:
    """Give viser's page the studio's title, style, and script, which runs before anything of viser's.

    Args:
        page: viser's page as HTML.
    """
    head = f"<head>{look_html()}<script>{_asset('frame.js')}</script>"
    return page.replace(b"<head>", head.encode(), 1).replace(b"<title>Viser<", b"<title>nullpose studio<", 1)


def look_html() -> str:
    """Return the overlay's style and what keeps the colours of lines, for an exported page too."""
    return f"<style>{_asset('frame.css')}</style><script>{_asset('lines.js')}</script>"


@cache
def _asset(name: str) -> str:
    return (files("nullpose.studio") / "assets" / name).read_text(encoding="utf-8")


def _bracketed(name: str) -> str:
    return f"[{name}]" if ":" in name else name


LOOPBACK = "127.0.0.1"
"""The address that only programs on this machine reach."""


@contextmanager
def unannounced() -> Iterator[None]:
    """Let viser say nothing of its server within a block, not in a notebook either."""
    console = rich.get_console()
    before, console.quiet = console.quiet, True
    try:
        yield
    finally:
        console.quiet = before


def require_viser() -> None:
    """Do nothing if viser can be imported.

    Raises:
        UsageError: it cannot, with what to do about it.
    """
    try:
        import viser  # noqa: F401  only whether it is installed
    except ImportError as error:
        raise UsageError(
            f"the studio needs viser, which is not installed; {install_command('studio')}"
        ) from error


def open_server(host: str, port: int) -> tuple[ViserServer, str]:
    """Return a server without a page, and its address with the token that every request to it needs.

    Args:
        host: address to listen at.
        port: where to listen; 0 for any that is free.

    Raises:
        UsageError: the port is in use, the address is none of this machine's, or viser cannot be guarded.
    """
    guard = Guard(host, _require_free(host, port))
    import viser

    with guard.before_viser(), unannounced():  # to announce it is for the command line
        server = viser.ViserServer(host=host, port=port, label="nullpose studio", verbose=False)
    if not guard.stands:
        server.stop()
        raise UsageError(
            f"viser {viser.__version__} opens its server in a way that nullpose cannot guard; any web page "
            f"could use the studio; run: {sys.executable} -m pip install 'viser>=1.1,<2'"
        )
    server.request_share_url = lambda verbose=True: None  # a page could ask for a tunnel from the internet
    # no shadows, nothing mirrored: without a graphics card those two took half of the time of a picture
    server.scene.configure_default_lights(cast_shadow=False)
    server.scene.configure_environment_map(hdri=None)
    server.scene.add_light_ambient("/light", intensity=1.6)
    # what long proofs free goes back to the system: glibc's own setting follows the largest array freed, and
    # up to 64 MB then stay with every thread's heap
    with suppress(AttributeError, OSError, TypeError):  # another C library has no such setting
        ctypes.CDLL(None).mallopt(-1, 1 << 20)  # M_TRIM_THRESHOLD of malloc.h, bytes
    return server, guard.address(server.get_port())


def _require_free(host: str, port: int) -> str:
    """Return the address that a host stands for, at which a port is free."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        with socket.socket(family, kind, protocol) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(address)
    except PermissionError as error:
        raise UsageError(f"--port: {port} needs special rights; choose one above 1023") from error
    except OSError as error:
        if isinstance(error, socket.gaierror) or error.errno in _NO_SUCH_ADDRESS:
            raise UsageError(f"--host: given {host}; allowed: a name or address of this machine") from error
        raise UsageError(
            f"--port: {port} is in use by another program; choose another, as in --port {port + 1}"
        ) from error
    return str(address[0])


_NO_SUCH_ADDRESS = {99, 49, 10049}  # EADDRNOTAVAIL on Linux, macOS, Windows
