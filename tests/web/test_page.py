"""The page is whole in itself: it refers to nothing that is not served, and puts no data in as markup."""

from __future__ import annotations

import gzip
import json
import re
from html.parser import HTMLParser
from importlib import resources
from pathlib import Path

import pytest
from fastapi import FastAPI

from fieldhand.api.gates import SECURITY_HEADERS
from fieldhand.errors import InputError
from fieldhand.program.serve import compose
from fieldhand.web import page
from fieldhand.web.page import assets, page_router
from support.processes.browser import Browser

UI = Path(__file__).parents[2] / "src" / "fieldhand" / "web" / "ui"
SOURCES = {str(path.relative_to(UI)): path.read_text() for path in sorted(UI.glob("src/**/*.ts"))}
REPLAY = (resources.files("fieldhand.exchange.replay") / "page.js").read_text(encoding="utf-8")


class Page(HTMLParser):
    """The parts of the page that the checks below need."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.inline: list[str] = []
        self._open = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._open = tag

    def handle_data(self, data: str) -> None:
        if self._open in ("script", "style") and data.strip():
            self.inline.append(data)


def parsed() -> Page:
    found = Page()
    found.feed(assets()["index.html"].data.decode())
    return found


def served() -> Browser:
    return Browser(compose({}, hosts=frozenset({"localhost"})))


def address(name: str) -> str:
    return {"index.html": "/", "sw.js": "/sw.js"}.get(name, f"/static/{name}")


def test_everything_that_the_page_refers_to_is_served() -> None:
    web = served()
    manifest = json.loads(assets()["manifest.webmanifest"].data)
    references = {value for _, attrs in parsed().tags for key in ("src", "href") if (value := attrs.get(key))}
    references |= {icon["src"] for icon in manifest["icons"]} | {manifest["start_url"]}
    assert len(references) > 4
    for one in references:
        assert web.get(one).status_code == 200, one


def test_every_built_file_is_served_with_its_type_and_the_security_headers() -> None:
    web = served()
    for name, asset in assets().items():
        answer = web.get(address(name), headers={"accept-encoding": "identity"})
        assert answer.status_code == 200, name
        assert answer.content == asset.data
        assert answer.headers["content-type"] == page.MEDIA_TYPES[name.rpartition(".")[2]]
        assert all(answer.headers[key] == value for key, value in SECURITY_HEADERS.items())


def test_the_worker_keeps_every_other_file() -> None:
    worker = assets()["sw.js"].data.decode()
    for name in assets().keys() - {"sw.js", "index.html"}:
        assert f'"{name}"' in worker, name


def test_the_page_keeps_to_its_own_security_policy() -> None:
    assert not parsed().inline
    for tag, attrs in parsed().tags:
        assert "style" not in attrs, tag
        assert not [name for name in attrs if name.startswith("on")], tag


def test_the_sources_name_no_other_server() -> None:
    for name, text in {**SOURCES, "index.html": (UI / "index.html").read_text()}.items():
        assert set(re.findall(r"(?:https?|wss?):?//[^\s\"'`)]+", text)) <= {"http://www.w3.org/2000/svg"}, name


@pytest.mark.parametrize("name", [*SOURCES, "replay"])
def test_no_data_becomes_markup_or_code(name: str) -> None:
    forbidden = (
        r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|createContextualFragment|srcdoc"
        r"|DOMParser|setHTMLUnsafe|javascript:|setTimeout\(\s*[\"'`]|\.(?:href|src|location)\s*=[^=]"
    )
    assert not re.search(forbidden, {**SOURCES, "replay": REPLAY}[name])


def test_packages_are_locked_without_the_addresses_of_registries() -> None:
    lock = json.loads((UI / "package-lock.json").read_text())
    packages = [entry for name, entry in lock["packages"].items() if name]
    assert packages
    for entry in packages:
        assert "resolved" not in entry
        assert entry["integrity"].startswith("sha512-")


def test_the_licences_of_all_packages_in_the_page_are_shipped() -> None:
    notices = assets()["third-party.txt"].data.decode()
    for name, version in json.loads((UI / "package.json").read_text())["dependencies"].items():
        assert f"{name} {version} (" in notices


def test_what_changes_is_revalidated_and_what_cannot_is_kept() -> None:
    web = served()
    for name in assets():
        first = web.get(address(name))
        again = web.get(address(name), headers={"if-none-match": first.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
        assert web.get(address(name), headers={"if-none-match": '"old"'}).status_code == 200
        hashed = re.search(r"-[\w-]{8}\.(js|css)$", name) is not None
        assert ("immutable" in first.headers["cache-control"]) is hashed


def test_files_are_compressed_for_those_who_can_read_it() -> None:
    web = served()
    script = next(name for name in assets() if re.match(r"index-.*\.js", name))
    packed = web.get(address(script), headers={"accept-encoding": "br, gzip;q=0.5"})
    plain = web.get(address(script), headers={"accept-encoding": "br"})
    assert packed.headers["content-encoding"] == "gzip"
    assert "content-encoding" not in plain.headers
    assert int(packed.headers["content-length"]) < len(plain.content) / 2
    assert packed.content == plain.content == gzip.decompress(assets()[script].packed)
    assert packed.headers["etag"] != plain.headers["etag"]


@pytest.mark.parametrize(
    "path",
    [
        "/static/",
        "/static/page.py",
        "/static/../page.py",
        "/static/%2e%2e/page.py",
        "/index.html",
        "/static/index.html",
        "/static/sw.js",
        "/static/sources.sha256",
    ],
)
def test_nothing_but_the_files_of_the_page_is_served(path: str) -> None:
    assert served().get(path).status_code == 404


def test_the_page_can_be_mounted_on_any_application() -> None:
    app = FastAPI()
    app.include_router(page_router())
    assert Browser(app).get("/").status_code == 200


def test_a_page_that_was_not_built_is_an_error_with_the_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(page.resources, "files", lambda _: tmp_path)
    with pytest.raises(InputError, match="has not been built") as raised:
        assets()
    command = raised.value.advice.rpartition(": ")[2]
    assert command.startswith("python scripts/")
    assert (UI.parents[3] / command.split()[1]).is_file()
