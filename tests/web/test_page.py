"""The page is whole in itself: it refers to nothing that is not served, and puts no data in as markup."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from importlib import resources

import pytest
from fastapi import FastAPI

from fieldhand.api.gates import SECURITY_HEADERS
from fieldhand.program.serve import compose
from fieldhand.web.page import assets, page_router
from support.processes.browser import Browser

SCRIPTS = {name: asset.data.decode() for name, asset in assets().items() if name.endswith(".js")}
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


def page() -> Page:
    found = Page()
    found.feed(assets()["index.html"].data.decode())
    return found


def served() -> Browser:
    return Browser(compose({}, hosts=frozenset({"localhost"})))


def references() -> set[str]:
    of_page = {value for _, attrs in page().tags for key in ("src", "href") if (value := attrs.get(key))}
    of_scripts = {f"/static/{name}" for text in SCRIPTS.values() for name in re.findall(r'from "\./([^"]+)"', text)}
    return {one for one in of_page | of_scripts if not one.startswith("#")}


def test_everything_that_the_page_refers_to_is_served_with_its_type() -> None:
    web = served()
    kinds = {"css": "text/css", "js": "text/javascript", "svg": "image/svg+xml"}
    assert references()
    for address in references():
        answer = web.get(address)
        assert answer.status_code == 200, address
        assert answer.headers["content-type"].startswith(kinds[address.rpartition(".")[2]])


def test_every_file_of_the_page_is_used() -> None:
    files = {f.name for f in (resources.files("fieldhand.web") / "static").iterdir() if f.is_file()}
    assert files == {address.removeprefix("/static/") for address in references()} | {"index.html"}


def test_the_page_is_served_at_the_root_with_the_security_headers() -> None:
    answer = served().get("/")
    assert answer.status_code == 200
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert all(answer.headers[name] == value for name, value in SECURITY_HEADERS.items())
    assert "<title>Fieldhand</title>" in answer.text


def test_the_page_keeps_to_its_own_security_policy() -> None:
    assert not page().inline
    for tag, attrs in page().tags:
        assert "style" not in attrs, tag
        assert not [name for name in attrs if name.startswith("on")], tag
    for name, text in SCRIPTS.items():
        assert not re.search(r"setAttribute\(\s*\"style|style: ", text), name


def test_nothing_is_loaded_from_elsewhere() -> None:
    for name, asset in assets().items():
        addresses = re.findall(r"https?://[^\s\"')]+|url\([^)]*\)|@import", asset.data.decode())
        assert set(addresses) <= {"http://www.w3.org/2000/svg"}, name


@pytest.mark.parametrize("name", [*SCRIPTS, "replay"])
def test_no_data_becomes_markup_or_code(name: str) -> None:
    forbidden = (
        r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|createContextualFragment|srcdoc"
        r"|DOMParser|setHTMLUnsafe|javascript:|setTimeout\(\s*[\"'`]|\.(?:href|src|location)\s*="
    )
    assert not re.search(forbidden, {**SCRIPTS, "replay": REPLAY}[name])


def test_every_element_that_a_script_asks_for_is_there() -> None:
    ids = [attrs["id"] for _, attrs in page().tags if "id" in attrs]
    assert len(ids) == len(set(ids))
    asked = {name for text in SCRIPTS.values() for name in re.findall(r'\$\("([^"]+)"\)', text)}
    assert asked
    assert asked <= set(ids)


def test_every_field_has_a_label_and_every_labelled_thing_exists() -> None:
    tags = page().tags
    ids = {attrs["id"] for _, attrs in tags if "id" in attrs}
    labelled = {attrs["for"] for tag, attrs in tags if tag == "label"}
    assert labelled <= ids
    for tag, attrs in tags:
        if tag in ("input", "select", "textarea"):
            assert attrs["id"] in labelled, attrs
        if "aria-labelledby" in attrs:
            assert attrs["aria-labelledby"] in ids
        if tag == "img":
            assert "alt" in attrs
    assert ("html", {"lang": "en"}) in tags


def test_what_is_imported_is_exported() -> None:
    for text in SCRIPTS.values():
        for names, module in re.findall(r'import \{([^}]+)\} from "\./([^"]+)"', text):
            for name in (one.split(" as ")[0].strip() for one in names.split(",")):
                assert re.search(
                    rf"export (async )?(const|function|class) {re.escape(name)}(?![\w$])", SCRIPTS[module]
                ), name


def test_an_unchanged_file_is_not_sent_again() -> None:
    web = served()
    first = web.get("/static/app.js")
    again = web.get("/static/app.js", headers={"if-none-match": first.headers["etag"]})
    assert (again.status_code, again.content) == (304, b"")
    assert web.get("/static/app.js", headers={"if-none-match": '"old"'}).status_code == 200


@pytest.mark.parametrize(
    "path",
    [
        "/static/",
        "/static/page.py",
        "/static/../page.py",
        "/static/%2e%2e/page.py",
        "/index.html",
        "/static/index.html",
    ],
)
def test_nothing_but_the_files_of_the_page_is_served(path: str) -> None:
    assert served().get(path).status_code == 404


def test_the_page_can_be_mounted_on_any_application() -> None:
    app = FastAPI()
    app.include_router(page_router())
    assert Browser(app).get("/").status_code == 200
