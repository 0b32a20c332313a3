"""The FastAPI router of the web page: its files, read once, each at its own address."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import resources

from fastapi import APIRouter, Request, Response

MEDIA_TYPES = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
}
INDEX = "index.html"


@dataclass(frozen=True, kw_only=True)
class Asset:
    """A file of the page.

    Attributes:
        data: Content.
        media_type: Value of the ``Content-Type`` header.
        tag: ``ETag``, which changes with the content.
    """

    data: bytes
    media_type: str
    tag: str


def assets() -> Mapping[str, Asset]:
    """Return every file of the page by name."""
    found = {}
    for file in sorted((resources.files("fieldhand.web") / "static").iterdir(), key=lambda f: f.name):
        kind = MEDIA_TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            data = file.read_bytes()
            tag = f'"{hashlib.sha256(data).hexdigest()[:24]}"'
            found[file.name] = Asset(data=data, media_type=kind, tag=tag)
    return found


def page_router() -> APIRouter:
    """Return the router of ``GET /`` and ``GET /static/{name}``, which serves the page's files only."""
    routes = APIRouter(include_in_schema=False)
    for name, asset in assets().items():
        path = "/" if name == INDEX else f"/static/{name}"
        routes.add_api_route(path, _sender(asset), methods=["GET", "HEAD"])
    return routes


def _sender(asset: Asset) -> Callable[[Request], Response]:
    # Browsers revalidate on every request, so that a new version of the program takes effect at once.
    headers = {"ETag": asset.tag, "Cache-Control": "no-cache"}

    def send(request: Request) -> Response:
        if request.headers.get("if-none-match") == asset.tag:
            return Response(status_code=304, headers=headers)
        return Response(asset.data, media_type=asset.media_type, headers=headers)

    return send
