"""Errors as JSON: ``{"status", "what", "where", "advice"}``, without tracebacks.

If warnings were not confirmed, ``warnings`` lists them.

400  the input cannot be used (every InputError)
401  no valid session or token
403  the request comes from a page of another site, or addresses another host name; the caller lacks a scope
404, 405  unknown address, method not allowed
408  the body is too slow
413  the body is too large
422  the body does not match the model; the mission is not approved; the robot cannot carry it out
429  too many attempts to log in
500  fault of the program, described in the log of the server
503  too much work at the same time; the database cannot be used

Messages are in the first known language of the request's ``Accept-Language``, else in English.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, Response

from fieldhand.errors import DatabaseError, FieldhandError, InputError, NotConfirmedError
from fieldhand.hidden_characters import json_text, visible_json
from fieldhand.language import ENGLISH, Language, languages, open_language

MEDIA_TYPE = "application/problem+json"

#: Parts of a pydantic location that name the tried member of a union instead of a field.
_CHOICES = ("SiteText", "dict[str,any]", "literal['demo','vineyard']")


class VisibleAnswer(JSONResponse):
    """A response for a web page, in which hidden characters are made visible."""

    def render(self, content: Any) -> bytes:
        return visible_json(content, separators=(",", ":"), allow_nan=False).encode()


class EscapedAnswer(JSONResponse):
    """A response for programs, in which hidden characters are escaped."""

    def render(self, content: Any) -> bytes:
        return json_text(content, separators=(",", ":"), allow_nan=False).encode()


class RefusedRequest(Exception):
    """Refusal of a request by the server itself.

    Args:
        status: HTTP status.
        what: Reason in words, without a full stop.
        advice: Advice to the client.
        where: Location in the request; empty if there is none.
    """

    def __init__(self, status: int, what: str, advice: str = "", where: str = "") -> None:
        self.status = status
        self.what = what
        self.advice = advice
        self.where = where
        super().__init__(what)


def problem(status: int, what: str, where: str = "", advice: str = "", **more: Any) -> Response:
    """Return the response for an error."""
    body = visible_json({"status": status, "what": what, "where": where, "advice": advice, **more})
    return Response(body, status_code=status, media_type=MEDIA_TYPE)


def too_big() -> Response:
    """Return the response for a body that is too large."""
    return problem(413, "the body is too large", "body", "send a smaller site or a shorter request")


def answer_problems(app: FastAPI) -> None:
    """Register handlers that turn every error of the application into a response."""

    @app.exception_handler(FieldhandError)
    async def _known(request: Request, error: FieldhandError) -> Response:
        more = {"warnings": error.warnings} if isinstance(error, NotConfirmedError) else {}
        status = 503 if isinstance(error, DatabaseError) else 400 if isinstance(error, InputError) else 422
        say = _asked_language(request).say
        return problem(status, say(error.what), error.where, say(error.advice), **more)

    @app.exception_handler(RefusedRequest)
    async def _refused(request: Request, error: RefusedRequest) -> Response:
        say = _asked_language(request).say
        response = problem(error.status, say(error.what), error.where, say(error.advice))
        if error.status == 401:
            response.headers["WWW-Authenticate"] = "Bearer"
        return response

    @app.exception_handler(RequestValidationError)
    async def _shape(_: Request, error: RequestValidationError) -> Response:
        first = error.errors()[0]
        return problem(422, _error_text(first), _place(first["loc"]), "see docs/api.md for what this address accepts")

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
            return problem(408, "the body arrived too slowly", "body", "send it again")
        if error.status_code == 503:
            return problem(503, "too many large requests at once", "body", "try again in a moment")
        return problem(error.status_code, HTTPStatus(error.status_code).phrase.lower())


def _asked_language(request: Request) -> Language:
    """Return the first language of ``Accept-Language`` that has a catalogue, else English."""
    for wanted in request.headers.get("accept-language", "")[:200].split(","):
        code = re.split(r"[;-]", wanted.strip().lower())[0]
        if code in languages():
            return open_language(code)
    return ENGLISH


def _error_text(error: dict[str, Any]) -> str:
    """Return the text of a pydantic error, without the input and without a full stop."""
    match error["type"]:
        case "missing":
            return "this is missing"
        case "extra_forbidden":
            return "this field is unknown"
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
    """Return the location in the body, such as ``site.text``."""
    parts = [str(part) for part in location if part not in _CHOICES]
    return ".".join(parts[1:] if len(parts) > 1 and parts[0] == "body" else parts)
