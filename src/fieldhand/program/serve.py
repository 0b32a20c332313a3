"""``fieldhand serve``: the web page and the REST API."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.errors import FieldhandError
from fieldhand.hidden_characters import print_error

if TYPE_CHECKING:
    from fastapi import FastAPI

    from fieldhand.accounts.accounts import Accounts
    from fieldhand.fleet import Fleet

#: Packages of the extra ``serve``, as they are imported.
_PACKAGES = ("fastapi", "uvicorn", "sqlalchemy", "alembic", "argon2")


def serve(
    host: Annotated[
        str, typer.Option("--host", help="Address to listen on; this machine alone by default.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port to listen on.")] = 8000,
    tls_cert: Annotated[Path | None, typer.Option("--tls-cert", help="Certificate for TLS (PEM).")] = None,
    tls_key: Annotated[
        Path | None, typer.Option("--tls-key", help="Its private key (PEM), which only you can read.")
    ] = None,
    insecure: Annotated[
        bool, typer.Option("--insecure", help="Let other machines log in without TLS: others can read passwords.")
    ] = False,
) -> None:
    """Serve the web page and the REST API, with live missions of simulated robots."""
    import threading
    from contextlib import closing

    from fieldhand.api.serving import hosts_for, require_extra, serve_forever
    from fieldhand.program.tls_files import tls_files

    require_extra(*_PACKAGES)
    from fieldhand import missions
    from fieldhand.accounts.accounts import open_accounts
    from fieldhand.fleet import Fleet

    tls = tls_files(tls_cert, tls_key, ("--tls-cert", "--tls-key"))
    _require_tls(host, tls=tls is not None, insecure=insecure)
    with closing(open_accounts(os.environ)) as accounts:
        fleet = Fleet(missions.missions_folder(os.environ))
        app = compose(os.environ, hosts=hosts_for(host), accounts=accounts, fleet=fleet)
        continuing = threading.Thread(target=_continue_missions, args=(fleet,), name="missions", daemon=True)
        serve_forever(
            app,
            host,
            port,
            tls=tls,
            lines=lambda url: _greeting(url, accounts, insecure=insecure and tls is None),
            on_start=continuing.start,
        )


def _continue_missions(fleet: Fleet) -> None:
    """Resume the missions that were cut off, and print their names."""
    try:
        for name in fleet.continue_interrupted():
            print_error(f"going on with mission {name}")
    except FieldhandError as error:
        print_error(f"warning: {error}")


def compose(
    environ: Mapping[str, str],
    *,
    hosts: frozenset[str] | None,
    accounts: Accounts | None = None,
    fleet: Fleet | None = None,
) -> FastAPI:
    """Create the ASGI application of the REST API and the web page.

    Args:
        environ: Environment variables that configure a language model.
        hosts: Host names that requests may address; None for any.
        accounts: Accounts of the server; None to admit this machine alone, without login.
        fleet: Simulated robots; None to serve no live missions.

    Raises:
        InputError: The packages that serving needs are not installed.
    """
    from fieldhand.api.serving import require_extra

    require_extra(*_PACKAGES)
    from fieldhand import mission
    from fieldhand.api.account_service import AccountService
    from fieldhand.api.app import create_app
    from fieldhand.web.page import page_router

    service = None if accounts is None else AccountService(accounts)
    app = create_app(lambda name: mission.make_planner(name, environ), hosts=hosts, accounts=service, fleet=fleet)
    app.include_router(page_router())
    return app


def _require_tls(host: str, *, tls: bool, insecure: bool) -> None:
    """Require TLS if other machines can reach the address.

    Raises:
        InputError: There is none, and ``--insecure`` was not given.
    """
    from fieldhand.api.serving import is_loopback
    from fieldhand.errors import InputError
    from fieldhand.language import message

    if not (tls or insecure or is_loopback(host)):
        raise InputError(
            message("others can reach this address, and could read passwords without TLS"),
            where="--host",
            advice=message("give --tls-cert and --tls-key; or --insecure to accept that"),
        )


def _greeting(url: str, accounts: Accounts, *, insecure: bool) -> Iterator[str]:
    """Yield the lines that a server prints below its address."""
    from fieldhand.language import message, spoken

    say = spoken(None, os.environ).say
    # An address that stands for all of the machine's is not one to open.
    own = url.replace("//0.0.0.0:", "//127.0.0.1:").replace("//[::]:", "//[::1]:")
    link = f"{own}#code={accounts.codes.new()}"
    yield say(message("To log in as this machine's administrator, open (once, within 12 hours): {link}", link=link))
    if insecure:
        yield say(message("warning: without TLS, others on the network can read passwords and change what is sent"))
