"""The FastAPI router of the web page: its built files, read once, each at its own address."""

from __future__ import annotations

import gzip
import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import resources

from fastapi import APIRouter, Request, Response

from fieldhand.errors import InputError

MEDIA_TYPES = {
    "html": "text/html; charset=utf-8",
    "css": "text/css; charset=utf-8",
    "js": "text/javascript; charset=utf-8",
    "svg": "image/svg+xml",
    "txt": "text/plain; charset=utf-8",
    "webmanifest": "application/manifest+json",
}
INDEX = "index.html"
#: The service worker has its address at the root, because it serves pages at and below its own address only.
WORKER = "sw.js"

#: Names that contain a hash of the content, so that the file at such an address never changes.
_HASHED = re.compile(r"-[\w-]{8}\.(?:js|css)")


@dataclass(frozen=True, kw_only=True)
class Asset:
    """A file of the page.

    Attributes:
        data: Content.
        packed: Content, compressed with gzip.
        media_type: Value of the ``Content-Type`` header.
        tag: ``ETag``, which changes with the content.
        lasting: True if the content at this address never changes.
    """

    data: bytes
    packed: bytes
    media_type: str
    tag: str
    lasting: bool


def assets() -> Mapping[str, Asset]:
    """Return every file of the page by name.

    Raises:
        InputError: The page has not been built.
    """
    found = {}
    folder = resources.files("fieldhand.web") / "static"
    files = sorted(folder.iterdir(), key=lambda f: f.name) if folder.is_dir() else []
    for file in files:
        kind = MEDIA_TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            data = file.read_bytes()
            found[file.name] = Asset(
                data=data,
                packed=gzip.compress(data, mtime=0),
                media_type=kind,
                tag=hashlib.sha256(data).hexdigest()[:24],
                lasting=_HASHED.search(file.name) is not None,
            )
    if INDEX not in found:
        raise InputError(
            "the web page has not been built",
            where="src/fieldhand/web/static",
            advice="build it with: python scripts/build_page.py",
        )
    return found


def page_router() -> APIRouter:
    """Return the router of ``GET /``, ``GET /sw.js`` and ``GET /static/{name}``, which serves the page's files only.

    Raises:
        InputError: The page has not been built.
    """
    routes = APIRouter(include_in_schema=False)
    addresses = {INDEX: "/", WORKER: f"/{WORKER}"}
    for name, asset in assets().items():
        routes.add_api_route(addresses.get(name, f"/static/{name}"), _sender(asset), methods=["GET", "HEAD"])
    return routes


def _sender(asset: Asset) -> Callable[[Request], Response]:
    # Browsers revalidate what can change on every request, so that a new version of the program takes effect at once.
    caching = "public, max-age=31536000, immutable" if asset.lasting else "no-cache"
    plain = {"ETag": f'"{asset.tag}"', "Cache-Control": caching, "Vary": "Accept-Encoding"}
    packed = {**plain, "ETag": f'"{asset.tag}-gzip"', "Content-Encoding": "gzip"}

    def send(request: Request) -> Response:
        accepted = {part.split(";")[0].strip() for part in request.headers.get("accept-encoding", "").split(",")}
        headers = packed if "gzip" in accepted else plain
        if request.headers.get("if-none-match") == headers["ETag"]:
            return Response(
                status_code=304, headers={name: headers[name] for name in ("ETag", "Cache-Control", "Vary")}
            )
        return Response(
            asset.packed if "gzip" in accepted else asset.data, media_type=asset.media_type, headers=headers
        )

    return send
