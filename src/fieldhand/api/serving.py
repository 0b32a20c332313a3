"""Serve an application until it is stopped."""

from __future__ import annotations

import ipaddress
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING

from fieldhand.errors import InputError

if TYPE_CHECKING:
    from fastapi import FastAPI


def require_extra() -> None:
    """Check that the optional packages are installed.

    Raises:
        InputError: They are not.
    """
    for package in ("fastapi", "uvicorn"):
        if find_spec(package) is None:
            raise InputError(
                f"serving needs a package that is not installed ({package})",
                advice='install it with: pip install "fieldhand[serve]"',
            )


def is_loopback(host: str) -> bool:
    """Whether an address to listen on is reached from this machine alone."""
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def hosts_for(host: str) -> frozenset[str] | None:
    """Names under which a browser may call a server that listens on ``host``; None for any, if others may reach it."""
    return frozenset({"localhost", "127.0.0.1", "::1", host}) if is_loopback(host) else None


def serve_forever(app: FastAPI, host: str, port: int) -> None:
    """Serve on that address until Ctrl-C, saying where, and warning where others can reach it.

    Raises:
        InputError: The address cannot be listened on.
    """
    import uvicorn

    require_free(host, port)
    shown = f"[{host}]" if ":" in host else host
    print(f"Fieldhand is at http://{shown}:{port}/ (Ctrl-C to stop)", file=sys.stderr)  # noqa: T201
    if not is_loopback(host):
        print(  # noqa: T201
            "warning: everyone who reaches this address can plan and simulate missions; there is no login",
            file=sys.stderr,
        )
    uvicorn.run(
        app, host=host, port=port, log_level="warning", server_header=False, date_header=False, limit_concurrency=200
    )


def require_free(host: str, port: int) -> None:
    """Try the address first: a server that cannot listen says so in one line, not in a log.

    Raises:
        InputError: It cannot be listened on.
    """
    import socket

    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as tried:
            tried.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            tried.bind(address)
    except OSError as error:
        raise InputError(
            f"cannot listen: {error.strerror or error}",
            where=f"{host}:{port}",
            advice="choose another --host or --port",
        ) from None
