"""The application: routers, middleware and error handlers."""

from __future__ import annotations

from fastapi import FastAPI

from fieldhand import __version__
from fieldhand.api import accounts as accounts_routes
from fieldhand.api import audit, catalogue, check, event_stream, health, missions, plan, run, session, site, tokens
from fieldhand.api.account_service import AccountService
from fieldhand.api.callers import CredentialGate
from fieldhand.api.gates import BodyGate, CallerGate, LastResort, SecurityHeaders
from fieldhand.api.plan import Planners
from fieldhand.api.problems import VisibleAnswer, answer_problems
from fieldhand.api.work import Limits, Workers
from fieldhand.fleet import Fleet


def create_app(
    planners: Planners,
    *,
    hosts: frozenset[str] | None,
    limits: Limits | None = None,
    accounts: AccountService | None = None,
    fleet: Fleet | None = None,
) -> FastAPI:
    """Create the ASGI application of the REST API.

    Args:
        planners: Returns the planner of a name.
        hosts: Host names that requests may address; None for any.
        limits: Limits of the server's work.
        accounts: Accounts of the server; None to admit this machine alone, without login.
        fleet: Simulated robots; None to serve no live missions.
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
    record = audit.recorder(accounts)
    for router in (
        catalogue.router(workers),
        site.router(workers),
        plan.router(workers, planners, record),
        check.router(workers),
        run.router(workers, planners, limits, record),
    ):
        app.include_router(router, prefix="/api")
        app.include_router(router, prefix="/api/v1")
    if accounts is not None:
        for router in (
            session.router(accounts),
            accounts_routes.router(accounts),
            tokens.router(accounts),
            audit.router(accounts),
            health.router(accounts),
        ):
            app.include_router(router, prefix="/api/v1")
    if fleet is not None:
        for live in (missions.router(workers, planners, fleet, record), event_stream.router(fleet)):
            app.include_router(live, prefix="/api/v1")
    # A request passes the middleware in the reverse order.
    app.add_middleware(BodyGate, most=limits.body_bytes)
    app.add_middleware(CredentialGate, service=accounts)
    app.add_middleware(CallerGate, hosts=hosts)
    app.add_middleware(LastResort)
    app.add_middleware(SecurityHeaders)
    return app
