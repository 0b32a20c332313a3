"""Serve an application over HTTP."""

from __future__ import annotations

import ipaddress
import logging
import sys
import traceback
from collections.abc import Callable, Iterable
from contextlib import suppress
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from fieldhand.errors import InputError
from fieldhand.hidden_characters import print_error, visible

if TYPE_CHECKING:
    from pathlib import Path

    import uvicorn
    from fastapi import FastAPI

    from fieldhand.api.connections import Connections


def require_extra(*packages: str) -> None:
    """Require that optional packages for serving are installed.

    Args:
        packages: Names of the packages; those that every server needs if there are none.

    Raises:
        InputError: One is missing.
    """
    for package in packages or ("fastapi", "uvicorn"):
        if find_spec(package) is None:
            raise InputError(
                f"serving needs a package that is not installed ({package})",
                advice='install it with: pip install "fieldhand[serve]"',
            )


def is_loopback(host: str) -> bool:
    """Return True if only this machine can reach an address."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def hosts_for(host: str) -> frozenset[str] | None:
    """Return the host names of a server that listens on ``host``; None for any, if other machines can reach it."""
    return frozenset({"localhost", "127.0.0.1", "::1", host}) if is_loopback(host) else None


def serve_forever(
    app: FastAPI,
    host: str,
    port: int,
    *,
    tls: tuple[Path, Path] | None = None,
    lines: Callable[[str], Iterable[str]] = lambda _: (),
    on_start: Callable[[], object] = lambda: None,
) -> None:
    """Print the address and serve until Ctrl-C.

    Args:
        app: The application.
        host: Address to listen on.
        port: Port to listen on.
        tls: Files of certificate and key (PEM); None for HTTP.
        lines: Returns more lines to print, for the URL of the server.
        on_start: Called once the address is known to be free.

    Raises:
        InputError: The address cannot be used.
    """
    log_visibly()
    require_free(host, port)
    shown = f"[{host}]" if ":" in host else host
    url = f"http{'s' if tls else ''}://{shown}:{port}/"
    print_error(f"Fieldhand is at {url} (Ctrl-C to stop)", *lines(url))
    on_start()
    with suppress(KeyboardInterrupt):
        make_server(app, host, port, tls=tls).run()


def make_server(
    app: FastAPI,
    host: str = "127.0.0.1",
    port: int = 0,
    *,
    tls: tuple[Path, Path] | None = None,
    limits: Connections | None = None,
) -> uvicorn.Server:
    """Return the server of an application, with limits on its connections.

    Args:
        app: The application.
        host: Address to listen on.
        port: Port to listen on; 0 for a free one.
        tls: Files of certificate and key (PEM); None for HTTP.
        limits: Limits on the connections, reduced if the system limits the open files of the process.
    """
    import ssl
    from dataclasses import replace

    import uvicorn

    from fieldhand.api.connections import Connections, protocol_factory

    context = None
    if tls is not None:
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.load_cert_chain(*tls)
    limits = limits or Connections()
    limits = replace(limits, total=min(limits.total, _most_connections()))
    config = uvicorn.Config(
        app,
        host=host,
        port=port,
        log_level="error",  # malformed requests are not logged as warnings
        http=protocol_factory(limits, context),  # type: ignore[arg-type]
        ws="none",
        server_header=False,
        date_header=False,
        # Headers that name the client can be forged; only the address of the connection counts.
        proxy_headers=False,
        # Number of connections that asyncio accepts before any is closed.
        backlog=64,
        timeout_graceful_shutdown=5,
    )
    return uvicorn.Server(config)


def _most_connections() -> int:
    """Return the number of connections that leaves enough open files for the rest of the process."""
    try:
        import resource
    except ImportError:
        return sys.maxsize
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    return sys.maxsize if soft == resource.RLIM_INFINITY else max(16, soft // 2 - 64)


def log_visibly() -> None:
    """Make hidden characters visible in all log records of the process, and put each on one line."""
    logging.setLogRecordFactory(_VisibleRecord)


class _VisibleRecord(logging.LogRecord):
    """A log record without control characters, so that its text cannot control a terminal."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        if self.exc_info and self.exc_info[0] is not None:
            self.exc_text = visible("".join(traceback.format_exception(*self.exc_info)), lines=True)

    def getMessage(self) -> str:  # noqa: N802  name of the standard library
        return visible(super().getMessage())


def require_free(host: str, port: int) -> None:
    """Require that an address can be listened on, so that the error is one line instead of a log.

    Raises:
        InputError: It cannot.
    """
    import socket

    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as tried:
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind(address)
    except (OSError, UnicodeError) as error:  # UnicodeError: invalid host name
        why = (error.strerror if isinstance(error, OSError) else None) or error
        raise InputError(
            f"cannot listen: {why}",
            where=f"{host}:{port}",
            advice="choose another --host or --port",
        ) from None
