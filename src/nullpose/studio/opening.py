"""Opening the server behind the pages, guarded, at an address of this machine."""

from __future__ import annotations

import ctypes
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING

import rich

from nullpose.errors import UsageError, install_command
from nullpose.studio.guard import Guard

if TYPE_CHECKING:
    from viser import ViserServer

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
