"""The server behind the pages: opens, serves each browser a page of its own, and closes without a trace."""

from __future__ import annotations

import logging
import threading
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

from nullpose.scenario import Scenario
from nullpose.studio.guard import LOOPBACK, PREFERS_DARK, open_server, require_viser, unannounced

if TYPE_CHECKING:
    from viser import ClientHandle, ViserServer

    from nullpose.studio.page import Page

MOST_PAGES = 8
"""How many pages a studio serves at a time; each has a thread that solves."""

_RELOAD_S = 10.0  # a page that is loaded again comes before its old self is gone: its thread has 5 s to end

_FULL = f"{MOST_PAGES} pages are open, and a studio serves no more. Close one, and load this one again."


_log = logging.getLogger("nullpose.studio")


class Studio:
    """A running studio; each browser that opens it has a page and a session of its own.

    Args:
        server: where the pages are.
        address: what to open in a browser; it holds the token, without which nothing is answered.
        scenario: the scene that every page begins with.
        text: of the file that it is from; empty without a file.
    """

    def __init__(self, server: ViserServer, address: str, scenario: Scenario, text: str = "") -> None:
        self.address = address
        self._server, self._scenario, self._text = server, scenario, text
        self._lock, self._places = threading.Lock(), threading.BoundedSemaphore(MOST_PAGES)
        # a page may be closed at any moment, also while it is sent what was found
        warnings.filterwarnings("ignore", "Queued a .* on a closed connection")
        self._closed = False
        self.pages: dict[int, Page] = {}
        server.on_client_connect(self._connect)
        server.on_client_disconnect(self._disconnect)

    def close(self) -> None:
        """End every page's thread and the server."""
        with self._lock:
            self._closed = True
            pages, self.pages = list(self.pages.values()), {}
        for page in pages:
            page.close()
        with unannounced():
            self._server.stop()

    async def _connect(self, client: ClientHandle) -> None:
        # the preference is known here, in the websocket's task, but to make a page would hold up all others
        threading.Thread(
            target=self._serve, args=(client, PREFERS_DARK.get()), name="nullpose-studio-page", daemon=True
        ).start()

    def _serve(self, client: ClientHandle, dark: bool) -> None:
        from nullpose.studio.page import Page

        if not self._places.acquire(timeout=_RELOAD_S):
            client.add_notification("Not opened", _FULL, color="red")
            return
        try:
            page = Page(client, self._scenario, self._text, dark=dark)
        except Exception:
            self._places.release()
            _log.exception("a page could not be made")
            client.add_notification(
                "Not opened", "The page could not be made; the terminal says why.", color="red"
            )
            return
        with self._lock:
            gone = self._closed or client.client_id not in self._server.get_clients()
            self.pages[client.client_id] = page
        if gone:
            self._disconnect(client)

    def _disconnect(self, client: ClientHandle) -> None:
        with self._lock:  # so that the studio's end waits for what a page is being sent
            if (page := self.pages.pop(client.client_id, None)) is not None:
                page.close()
                self._places.release()


@contextmanager
def studio(scenario: Scenario, text: str = "", *, host: str = LOOPBACK, port: int = 8080) -> Iterator[Studio]:
    """Run a studio for the length of a block.

    Args:
        scenario: the scene that every page begins with.
        text: of the file that it is from; empty without a file.
        host: address to listen at.
        port: where to listen; 0 for any that is free.

    Raises:
        UsageError: viser is not installed, the port is in use, or the address is none of this machine's.
    """
    require_viser()
    import numba  # noqa: F401  here, since pages opened at once would import it in several threads at a time

    running = Studio(*open_server(host, port), scenario, text)
    try:
        yield running
    finally:
        with suppress(KeyboardInterrupt):  # a second Ctrl-C must not leave a thread behind
            running.close()
