"""What goes wrong, as JSON: ``{"status", "what", "where", "advice"}``, never a traceback.

Where warnings were not confirmed, ``warnings`` holds each of them.

400  what was given cannot be used (every InputError)
403  a page of another site tries to use this one, or calls it by another name
404, 405  no such address, no such method
408  the body came too slowly
413  the body is too big
422  the shape of the body is wrong; a mission is not approved; the robot could not do it
500  a fault of the program; the log of the server says more
503  too much work at once
"""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from fieldhand.errors import FieldhandError, InputError, NotConfirmedError
from fieldhand.hidden_characters import json_text, visible_json

MEDIA_TYPE = "application/problem+json"

#: Parts of a pydantic location that say which kind of a choice was tried, not where the fault is.
_CHOICES = ("SiteText", "dict[str,any]", "literal['demo']")


class VisibleAnswer(JSONResponse):
    """An answer whose texts a page shows as they stand: hidden characters in them are made visible."""

    def render(self, content: Any) -> bytes:
        return visible_json(content, separators=(",", ":"), allow_nan=False).encode()


class EscapedAnswer(JSONResponse):
    """An answer for programs: the same text again, hidden characters as escapes."""

    def render(self, content: Any) -> bytes:
        return json_text(content, separators=(",", ":"), allow_nan=False).encode()


class Turned(Exception):
    """A request that the server turns away before any room has seen it.

    Args:
        status: HTTP status.
        what: What is wrong, in words, without a full stop.
        advice: What to do.
    """

    def __init__(self, status: int, what: str, advice: str = "") -> None:
        self.status = status
        self.what = what
        self.advice = advice
        super().__init__(what)


def problem(status: int, what: str, where: str = "", advice: str = "", **more: Any) -> Response:
    """A problem as a response."""
    body = visible_json({"status": status, "what": what, "where": where, "advice": advice, **more})
    return Response(body, status_code=status, media_type=MEDIA_TYPE)


def too_big() -> Response:
    """The problem of a body that is larger than the server takes."""
    return problem(413, "the body is too large", "body", "send a smaller site or a shorter request")


def answer_problems(app: FastAPI) -> None:
    """Have the application answer every failure with a problem."""

    @app.exception_handler(FieldhandError)
    async def _known(_: Request, error: FieldhandError) -> Response:
        more = {"warnings": error.warnings} if isinstance(error, NotConfirmedError) else {}
        return problem(400 if isinstance(error, InputError) else 422, error.what, error.where, error.advice, **more)

    @app.exception_handler(Turned)
    async def _turned(_: Request, error: Turned) -> Response:
        return problem(error.status, error.what, advice=error.advice)

    @app.exception_handler(RequestValidationError)
    async def _shape(_: Request, error: RequestValidationError) -> Response:
        first = error.errors()[0]
        return problem(422, _said(first), _place(first["loc"]), "see docs/api.md for what this address takes")

    @app.exception_handler(HTTPException)
    async def _http(request: Request, error: HTTPException) -> Response:
        if error.status_code in (404, 405):
            what = "there is nothing here" if error.status_code == 404 else f"{request.method} is not for this address"
            response = problem(error.status_code, what, advice="docs/api.md lists every address")
            response.headers.update(error.headers or {})
            return response
        if error.status_code == 400:
            return problem(400, "the body cannot be read as JSON", "body", "send one JSON object in UTF-8")
        if error.status_code == 413:
            return too_big()
        if error.status_code == 408:
            return problem(408, "the body came too slowly", "body", "send it again")
        if error.status_code == 503:
            return problem(503, "too many large requests at once", "body", "try again in a moment")
        return problem(error.status_code, HTTPStatus(error.status_code).phrase.lower())


def _said(error: dict[str, Any]) -> str:
    """What pydantic found, without what was sent and without a full stop."""
    match error["type"]:
        case "missing":
            return "this is missing"
        case "extra_forbidden":
            return "this is not known here"
        case "json_invalid":
            return f"the body is not JSON: {error['ctx']['error']}"
        case "value_error":
            return str(error["ctx"]["error"])
        case "string_unicode":
            return "this is not valid Unicode text"
        case _:
            message = str(error["msg"])
            return message[:1].lower() + message[1:]


def _place(location: Sequence[str | int]) -> str:
    """Where in the body, as ``site.text``."""
    parts = [str(part) for part in location if part not in _CHOICES]
    return ".".join(parts[1:] if len(parts) > 1 and parts[0] == "body" else parts)
