"""The agent as an ASGI application."""

from __future__ import annotations

import time
from collections.abc import Awaitable, Callable

import anyio
from fastapi import FastAPI, Request
from starlette.responses import Response

from fieldhand import __version__
from fieldhand.agent.routes import RobotIdentity, router
from fieldhand.agent.token_gate import SmallBodyGate, TokenGate, WrongTokenLimits
from fieldhand.agent.uploads import UploadLimits
from fieldhand.api.gates import CallerGate, LastResort, SecurityHeaders
from fieldhand.api.problems import EscapedAnswer, answer_problems, problem
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.delivery.mission_supervisor import MissionSupervisor
from fieldhand.errors import ExecutionError, OutputError

#: Largest body that is not a mission, in bytes.
SMALL = 64_000


def create_agent(
    mission_store: MissionStore,
    supervisor: MissionSupervisor,
    who: RobotIdentity,
    *,
    token: str | None,
    hosts: frozenset[str] | None,
    uploads: UploadLimits | None = None,
    guessing: WrongTokenLimits | None = None,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], Awaitable[None]] = anyio.sleep,
) -> FastAPI:
    """Create the ASGI application of a robot's agent.

    Args:
        mission_store: Missions that were received.
        supervisor: Supervisor that carries them out.
        who: Identity of the robot.
        token: Token that a request must contain; None for none.
        hosts: Host names that requests may address; None for any.
        uploads: Limits on uploads.
        guessing: Limits on wrong tokens.
        clock: Returns monotonic seconds, for wrong tokens.
        sleep: Waits a number of seconds, for wrong tokens.
    """
    app = FastAPI(
        title="Fieldhand agent",
        version=__version__,
        docs_url=None,
        redoc_url=None,
        openapi_url=None,
        default_response_class=EscapedAnswer,
    )
    answer_problems(app)

    @app.exception_handler(OutputError)
    async def _unwritable(_: Request, error: OutputError) -> Response:
        """Respond to errors of the robot's disk, after which the client may try again."""
        return problem(507, error.what, error.where, error.advice)

    @app.exception_handler(ExecutionError)
    async def _too_late(_: Request, error: ExecutionError) -> Response:
        return problem(409, error.what, error.where, error.advice)

    app.include_router(router(mission_store, supervisor, who, uploads or UploadLimits()))
    # A request passes the middleware in the reverse order.
    app.add_middleware(SmallBodyGate, most=SMALL)
    app.add_middleware(TokenGate, token=token, guessing=guessing or WrongTokenLimits(), clock=clock, sleep=sleep)
    app.add_middleware(CallerGate, hosts=hosts)
    app.add_middleware(LastResort)
    app.add_middleware(SecurityHeaders)
    return app
