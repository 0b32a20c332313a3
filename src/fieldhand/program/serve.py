"""``fieldhand serve``: the web page and the REST API."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

import typer

from fieldhand.errors import FieldhandError
from fieldhand.hidden_characters import print_error

if TYPE_CHECKING:
    from fastapi import FastAPI

    from fieldhand.fleet import Fleet


def serve(
    host: Annotated[
        str, typer.Option("--host", help="Address to listen on; this machine alone by default.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", min=1, max=65535, help="Port to listen on.")] = 8000,
) -> None:
    """Serve the web page and the REST API, with live missions of simulated robots."""
    import threading

    from fieldhand.api.serving import hosts_for, require_extra, serve_forever

    require_extra()
    from fieldhand import missions
    from fieldhand.fleet import Fleet

    fleet = Fleet(missions.missions_folder(os.environ))
    app = compose(os.environ, hosts=hosts_for(host), fleet=fleet)
    continuing = threading.Thread(target=_continue_missions, args=(fleet,), name="interrupted missions", daemon=True)
    serve_forever(app, host, port, on_start=continuing.start)


def _continue_missions(fleet: Fleet) -> None:
    """Resume the missions that were cut off, and print their names."""
    try:
        for name in fleet.continue_interrupted():
            print_error(f"going on with mission {name}")
    except FieldhandError as error:
        print_error(f"warning: {error}")


def compose(environ: Mapping[str, str], *, hosts: frozenset[str] | None, fleet: Fleet | None = None) -> FastAPI:
    """Create the ASGI application of the REST API and the web page.

    Args:
        environ: Environment variables that configure a language model.
        hosts: Host names that requests may address; None for any.
        fleet: Simulated robots; None to serve no live missions.

    Raises:
        InputError: The packages that serving needs are not installed.
    """
    from fieldhand.api.serving import require_extra

    require_extra()
    from fieldhand import mission
    from fieldhand.api.app import create_app
    from fieldhand.web.page import page_router

    app = create_app(lambda name: mission.make_planner(name, environ), hosts=hosts, fleet=fleet)
    app.include_router(page_router())
    return app
