"""The server behind the pages: opens, serves each browser a page of its own, and closes without a trace."""

from __future__ import annotations

import logging
import socket
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from io import StringIO
from typing import TYPE_CHECKING, Any

from nullpose.errors import UsageError
from nullpose.scenario import Scenario
from nullpose.studio.guard import Guard
from nullpose.studio.map_kernel import MapKernel

if TYPE_CHECKING:
    from viser import ClientHandle, SceneApi, ViserServer

    from nullpose.studio.page import Page

__all__ = ["LOOPBACK", "MOST_PAGES", "Studio", "open_server", "require_viser", "studio"]

LOOPBACK = "127.0.0.1"
"""The address that only programs on this machine reach."""

MOST_PAGES = 8
"""How many pages a studio serves at a time; each has a thread that solves."""

_RELOAD_S = 2.0  # a page that is loaded again comes before its old self is gone

_INSTALL = 'the studio needs viser, which is not installed; run: pip install "nullpose[studio]"'

_FULL = f"{MOST_PAGES} pages are open, and a studio serves no more. Close one, and load this one again."

_log = logging.getLogger("nullpose.studio")


def require_viser() -> None:
    """Do nothing if viser can be imported.

    Raises:
        UsageError: it cannot, with what to do about it.
    """
    try:
        import viser  # noqa: F401
    except ImportError as error:
        raise UsageError(_INSTALL) from error


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

    with guard.before_viser(), redirect_stdout(StringIO()):  # to announce it is for the command line
        server = viser.ViserServer(host=host, port=port, label="nullpose studio", verbose=False)
    if not guard.stands:
        server.stop()
        raise UsageError(
            f"viser {viser.__version__} opens its server in a way that nullpose cannot guard; any web page "
            'could use the studio; run: pip install "viser>=1.1,<2"'
        )
    if port not in (0, server.get_port()):  # taken in the meantime, and viser moved on to the next
        server.stop()
        raise UsageError(_port_in_use(port))
    server.request_share_url = lambda verbose=True: None  # a page could ask for a tunnel from the internet
    _light(server.scene)
    return server, guard.address(server.get_port())


def _light(scene: SceneApi) -> None:
    # no shadows, nothing mirrored: without a graphics card those two took half of the time of a picture
    scene.configure_default_lights(cast_shadow=False)
    scene.configure_environment_map(hdri=None)
    scene.add_light_ambient("/light", intensity=1.6)


def _port_in_use(port: int) -> str:
    return f"--port: {port} is in use by another program; choose another, as in --port {port + 1}"


def _require_free(host: str, port: int) -> str:
    """Return the address that a host stands for, at which a port is free."""
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(
            host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
    except OSError as error:
        raise UsageError(f"--host: given {host}; allowed: a name or address of this machine") from error
    with socket.socket(family, kind, protocol) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(address)
        except PermissionError as error:
            raise UsageError(f"--port: {port} needs special rights; choose one above 1023") from error
        except OSError as error:
            if error.errno in _NO_SUCH_ADDRESS:
                message = f"--host: given {host}; allowed: a name or address of this machine"
                raise UsageError(message) from error
            raise UsageError(_port_in_use(port)) from error
    return str(address[0])


_NO_SUCH_ADDRESS = {99, 49, 10049}  # EADDRNOTAVAIL on Linux, macOS, Windows


class Studio:
    """A running studio; each browser that opens it has a page and a session of its own.

    Args:
        server: where the pages are.
        address: what to open in a browser; it holds the token, without which nothing is answered.
        scenario: the scene that every page begins with.
    """

    def __init__(self, server: ViserServer, address: str, scenario: Scenario) -> None:
        from nullpose.studio.page import camera_m, near_m

        self.address = address
        self._server, self._scenario = server, scenario
        self._lock, self._room = threading.Lock(), threading.BoundedSemaphore(MOST_PAGES)
        self._map_kernel = MapKernel()
        # a page may be closed at any moment, also while it is sent what was found
        warnings.filterwarnings("ignore", "Queued a .* on a closed connection")
        self._closed = False
        self.pages: dict[int, Any] = {}
        server.initial_camera.position, server.initial_camera.look_at = camera_m(scenario)
        server.initial_camera.near = near_m(scenario)
        server.on_client_connect(self._connect)
        server.on_client_disconnect(self._disconnect)

    def close(self) -> None:
        """End every page's thread and the server."""
        with self._lock:
            self._closed = True
            pages, self.pages = list(self.pages.values()), {}
        for page in pages:
            page.close()
        self._map_kernel.close()
        with redirect_stdout(StringIO()):
            self._server.stop()

    def _connect(self, client: ClientHandle) -> None:
        from nullpose.studio.page import Page

        if not self._room.acquire(timeout=_RELOAD_S):
            client.add_notification("Not opened", _FULL, color="red")
            return
        try:
            page = Page(client, self._scenario, self._map_kernel)
        except Exception:
            self._room.release()
            _log.exception("a page could not be made")
            client.add_notification(
                "Not opened", "The page could not be made; the terminal says why.", color="red"
            )
            return
        with self._lock:
            gone = self._closed or client.client_id not in self._server.get_clients()
            if not gone:
                self.pages[client.client_id] = page
        if gone:
            self._end(page)

    def _disconnect(self, client: ClientHandle) -> None:
        with self._lock:
            page = self.pages.pop(client.client_id, None)
        if page is not None:
            self._end(page)

    def _end(self, page: Page) -> None:
        page.close()
        self._room.release()


@contextmanager
def studio(scenario: Scenario, *, host: str = LOOPBACK, port: int = 8080) -> Iterator[Studio]:
    """Run a studio for the length of a block.

    Args:
        scenario: the scene that every page begins with.
        host: address to listen at.
        port: where to listen; 0 for any that is free.

    Raises:
        UsageError: viser is not installed, the port is in use, or the address is none of this machine's.
    """
    require_viser()
    import numba  # noqa: F401  here, since pages opened at once would import it in several threads at a time

    running = Studio(*open_server(host, port), scenario)
    try:
        yield running
    finally:
        with suppress(KeyboardInterrupt):  # a second Ctrl-C must not leave a thread behind
            running.close()
