"""The application: routers, middleware and error handlers."""

from __future__ import annotations

from fastapi import FastAPI

from fieldhand import __version__
from fieldhand.api import catalogue, check, examples, plan, run, site
from fieldhand.api.gates import BodyGate, CallerGate, LastResort, SecurityHeaders
from fieldhand.api.plan import Planners
from fieldhand.api.problems import VisibleAnswer, answer_problems
from fieldhand.api.work import Limits, Workers


def create_app(planners: Planners, *, hosts: frozenset[str] | None, limits: Limits | None = None) -> FastAPI:
    """Create the ASGI application of the REST API.

    Args:
        planners: Returns the planner of a name.
        hosts: Host names that requests may address; None for any.
        limits: Limits of the server's work.
    """
    limits = limits or Limits()
    workers = Workers(limits)
    # FastAPI's interactive pages load scripts from other servers, so only the schema is served.
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
        examples.router(workers),
        plan.router(workers, planners),
        check.router(workers),
        run.router(workers, planners, limits),
    ):
        app.include_router(router, prefix="/api")
    # A request passes the middleware in the reverse order.
    app.add_middleware(BodyGate, most=limits.body_bytes)
    app.add_middleware(CallerGate, hosts=hosts)
    app.add_middleware(LastResort)
    app.add_middleware(SecurityHeaders)
    return app
