"""Servers on real sockets, and connections that keep them busy."""

from __future__ import annotations

import select
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path

import pytest
from fastapi import FastAPI

from fieldhand.api.connections import Connections
from fieldhand.api.serving import make_server

#: Seconds after which a test gives up; nothing is asserted about how long anything takes.
GIVE_UP_S = 60.0

#: What each kind of connection sends, and then no more.
SENT = {
    "silent": b"",
    "half a header": b"GET /agent HTTP/1.1\r\nHost: localhost\r\nX-A: b",
    "a body that does not come": (
        b"POST /agent/orders HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        b'Content-Length: 1000\r\n\r\n{"order":'
    ),
    "a wrong token, the answer unread": (
        b"GET /agent HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer wrong\r\n\r\n"
    ),
    "requests without end, no answer read": b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n" * 50,
    "no HTTP": b"\x16\x03\x01\x00\xff" * 10,
}


@contextmanager
def served(app: FastAPI, limits: Connections | None = None, tls: tuple[Path, Path] | None = None) -> Iterator[int]:
    """Serve an application on a port of its own, as ``fieldhand agent`` and ``fieldhand serve`` do."""
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        server = make_server(app, limits=limits, tls=tls)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
        thread.start()
        try:
            until(lambda: server.started)
            yield int(listening.getsockname()[1])
        finally:
            server.should_exit = True
            thread.join(GIVE_UP_S)


@contextmanager
def crowd(port: int, kind: str, many: int) -> Iterator[list[socket.socket]]:
    """Connections of one kind, that stay for as long as the server lets them."""
    with ExitStack() as stack:
        made = []
        for _ in range(many):
            link = stack.enter_context(closing(socket.socket()))
            link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            link.settimeout(GIVE_UP_S)
            link.connect(("127.0.0.1", port))
            with suppress(ConnectionError):  # it may be closed again for a newer one
                link.sendall(SENT[kind])
            made.append(link)
        yield made


def is_closed(link: socket.socket) -> bool:
    """Return True if the server has ended a connection; read nothing of it."""
    poll = select.poll()
    poll.register(link, select.POLLRDHUP)
    return bool(poll.poll(0))


def until(so: Callable[[], bool]) -> None:
    """Wait until something is so."""
    end = time.monotonic() + GIVE_UP_S
    while not so():
        if time.monotonic() > end:
            pytest.fail("it never was so")
        time.sleep(0.01)
