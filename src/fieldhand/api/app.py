"""The application: its addresses, what every request passes, and how failures are answered."""

from __future__ import annotations

from fastapi import FastAPI

from fieldhand import __version__
from fieldhand.api import catalogue, check, plan, run, site
from fieldhand.api.gates import BodyGate, CallerGate, LastResort, SecurityHeaders
from fieldhand.api.plan import Planners
from fieldhand.api.problems import VisibleAnswer, answer_problems
from fieldhand.api.work import Limits, Workers


def create_app(planners: Planners, *, hosts: frozenset[str] | None, limits: Limits | None = None) -> FastAPI:
    """The REST API as an ASGI application.

    Args:
        planners: Gives the planner of a name.
        hosts: Names under which a browser may call; None for any.
        limits: What the server takes on; see :class:`Limits`.
    """
    limits = limits or Limits()
    workers = Workers(limits)
    # The interactive pages of the framework load scripts from elsewhere; the schema alone is served.
    app = FastAPI(
        title="Fieldhand",
        version=__version__,
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/openapi.json",
        default_response_class=VisibleAnswer,
    )
    answer_problems(app)
    for router in (
        catalogue.router(workers),
        site.router(workers),
        plan.router(workers, planners),
        check.router(workers),
        run.router(workers, planners, limits),
    ):
        app.include_router(router, prefix="/api")
    # The last that is added is the first that a request passes.
    app.add_middleware(BodyGate, most=limits.body_bytes)
    app.add_middleware(CallerGate, hosts=hosts)
    app.add_middleware(LastResort)
    app.add_middleware(SecurityHeaders)
    return app
