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

#: Bytes of a body that is no mission.
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
    """The agent of one robot.

    Args:
        mission_store: Where its missions arrive.
        supervisor: Who carries them out.
        who: What robot it is.
        token: That a caller has to say; None for none.
        hosts: Names under which it may be called; None for any.
        uploads, guessing: What it puts up with.
        clock, sleep: For wrong tokens.
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
        """The robot's own disk: the sender is not at fault, and may try again."""
        return problem(507, error.what, error.where, error.advice)

    @app.exception_handler(ExecutionError)
    async def _too_late(_: Request, error: ExecutionError) -> Response:
        return problem(409, error.what, error.where, error.advice)

    app.include_router(router(mission_store, supervisor, who, uploads or UploadLimits()))
    # The last that is added is the first that a request passes.
    app.add_middleware(SmallBodyGate, most=SMALL)
    app.add_middleware(TokenGate, token=token, guessing=guessing or WrongTokenLimits(), clock=clock, sleep=sleep)
    app.add_middleware(CallerGate, hosts=hosts)
    app.add_middleware(LastResort)
    app.add_middleware(SecurityHeaders)
    return app
