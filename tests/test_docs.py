"""Every command in the docs runs, so does every example in Python, and every file that the docs link to is there."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from contextlib import ExitStack
from importlib import import_module
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from pydoc import locate
from types import ModuleType

import pytest

import fieldhand as fh
from fieldhand import errors
from fieldhand.compatibility import tomllib
from fieldhand.places.selectors import SELECTORS
from fieldhand.plugins import GROUPS
from ros2.conftest import LOOPBACK
from support.processes.command import fieldhand, in_background

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "benchmarks" / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SHELL = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
PYTHON = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
PYTHON_PAGE, REFERENCE = ROOT / "docs" / "python.md", ROOT / "docs" / "reference.md"
#: Commands that serve until they are stopped have tests of their own, and so has the page that needs a robot.
SERVERS = ("fieldhand serve",)
ROBOT = "delivery"
#: A robot that goes on beside the commands after it, and what those need that reach it.
SIM_ROBOT, OVER_DDS = "fieldhand sim-robot", ("--on dds", "--live")


def page_name(page: Path) -> str:
    """The page without its ending, as its test is called."""
    return page.stem if page.parent.name != "benchmarks" else f"benchmarks/{page.stem}"


def commands(page: Path) -> list[str]:
    """The ``fieldhand`` commands of a page's shell blocks, in their order."""
    lines = [line for block in SHELL.findall(page.read_text()) for line in block.replace("\\\n", " ").splitlines()]
    return [line.strip() for line in lines if line.strip().startswith("fieldhand ")]


def _has_examples(page: Path) -> bool:
    """Return True for a page with examples in Python that have no test of their own."""
    return page.stem not in ("planning-llm", "testing") and PYTHON.search(page.read_text()) is not None


@pytest.mark.parametrize("page", [page for page in PAGES if page.stem != ROBOT], ids=page_name)
def test_every_command_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FIELDHAND_CONFIG", str(tmp_path / "config"))
    monkeypatch.setenv("CYCLONEDDS_URI", LOOPBACK)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(200 + os.getpid() % 33))
    dds = find_spec("cyclonedds") is not None
    with ExitStack() as robots:
        for command in commands(page):
            words = shlex.split(command, comments=True)[1:]
            if command.startswith(SERVERS) or (not dds and any(needs in command for needs in OVER_DDS)):
                continue
            if command.startswith(SIM_ROBOT):
                if dds:
                    robots.enter_context(in_background(*words, out=tmp_path / "robot"))
                continue
            fresh = page.parent == ROOT and not any(needs in command for needs in OVER_DDS)
            run = fieldhand(*words, cwd=tmp_path, fresh=fresh)
            assert run.status == 0, f"{command}\n{run.out[-2000:]}\n{run.err[-2000:]}"


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_every_link_leads_somewhere(page: Path) -> None:
    for target, anchor in re.findall(r"\]\(([^)#\s]*)(?:#([^)\s]+))?\)", page.read_text()):
        if not target.startswith(("http://", "https://", "mailto:")):
            linked = page.parent / target if target else page
            assert linked.exists(), target
            # An anchor with a dot is one of the reference, which ``make docs`` checks.
            assert not anchor or "." in anchor or anchor in _anchors(linked), f"{target}#{anchor}"


def _anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S), re.M)
    return {re.sub(r"\s+", "-", re.sub(r"[^\w\s-]", "", heading.lower()).strip()) for heading in headings}


@pytest.mark.parametrize("page", [page for page in PAGES if _has_examples(page)], ids=page_name)
def test_every_python_example_runs(page: Path, tmp_path: Path) -> None:
    if page == PYTHON_PAGE:
        for library in ("dask.distributed", "geopandas"):
            pytest.importorskip(library)
    text, script = page.read_text(), ""
    for found in PYTHON.finditer(text):
        above = text[: found.start(1)].count("\n")  # a failure names the line of the page
        script += "\n" * (above - script.count("\n")) + found[1]
    (tmp_path / page.name).write_text(script)
    # A process of its own: Dask looks for the addresses of this machine, which no test may do.
    run = subprocess.run(
        [sys.executable, "-W", "error", page.name], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert run.returncode == 0, run.stderr[-2000:]


def test_every_public_name_is_explained_and_used_in_an_example() -> None:
    page = PYTHON_PAGE.read_text()
    examples, prose = "\n".join(PYTHON.findall(page)), PYTHON.sub("", page)
    for name in fh.__all__:
        assert re.search(rf"\bfh\.{name}\b", examples), name
        assert re.search(rf"`(fh\.)?{name}\b", prose), name


def test_the_reference_lists_every_public_name() -> None:
    listed = re.findall(r"^::: fieldhand\.(\w+)$", REFERENCE.read_text(), re.MULTILINE)
    assert sorted(listed) == fh.__all__


def test_the_reference_lists_every_error() -> None:
    listed = re.findall(r"^::: fieldhand\.(?:errors\.)?(\w+)$", REFERENCE.read_text(), re.MULTILINE)
    assert set(errors.__all__) - {"few"} <= set(listed)


def test_every_name_of_the_reference_is_there() -> None:
    for name in re.findall(r"^::: (\S+)$", REFERENCE.read_text(), re.MULTILINE):
        assert locate(name) is not None, name


def test_the_site_of_the_docs_leads_to_every_page() -> None:
    navigation = (ROOT / "mkdocs.yml").read_text().partition("\nnav:")[2]
    pages = re.findall(r"[\w-]+\.md", navigation)
    written = [page.name for page in (ROOT / "docs").glob("*.md")]
    assert sorted(pages) == sorted([*written, *_hooks().SOURCES])
    for source in _hooks().SOURCES.values():
        assert (ROOT / source).exists(), source


def _hooks() -> ModuleType:
    found = spec_from_file_location("mkdocs_hooks", ROOT / "scripts" / "mkdocs_hooks.py")
    assert found is not None
    assert found.loader is not None
    module = module_from_spec(found)
    found.loader.exec_module(module)
    return module


def test_the_map_of_the_packages_is_the_one_that_is_enforced() -> None:
    page = (ROOT / "docs" / "architecture.md").read_text()
    drawn = page.partition("## The packages")[2].split("\n\n")[2]
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    assert [line.strip() for line in drawn.splitlines()] == contracts[0]["layers"]
    rooms = [room.strip() for layer in contracts[0]["layers"] for room in layer.split("|")]
    table = page.partition("## The packages")[2].partition("\n## ")[0]
    for room in rooms:
        assert re.search(rf"^\|[^|]*`{room}`", table, re.MULTILINE), room


def test_the_map_of_the_code_names_what_its_files_define() -> None:
    table = (ROOT / "docs" / "architecture.md").read_text().partition("## Where is")[2].partition("\n## ")[0]
    for _, files, names in re.findall(r"^\|(.*)\|(.*)\|(.*)\|$", table, re.MULTILINE)[2:]:
        named = re.findall(r"`([\w/.]+\.py)`", files)
        text = "".join((ROOT / "src" / "fieldhand" / file).read_text() for file in named)
        for name in re.findall(r"`(?:\w+\.)?(\w+)`", names):
            assert not named or re.search(rf"(def|class) {name}\b|^{name} = ", text, re.MULTILINE), f"{named}: {name}"


def test_the_page_of_sites_defines_every_selector() -> None:
    page = (ROOT / "docs" / "site.md").read_text().partition("## What the words mean")[2].partition("\n### ")[0]
    named = {
        name for row in re.findall(r"^\|[^|]*\|([^|]*)\|", page, re.MULTILINE) for name in re.findall(r"`(\w+)`", row)
    }
    assert named - {"side"} == {selector.__name__ for selector in SELECTORS}


#: Files of a user or of a mission, of which the docs speak beside files of the repository.
NAV2 = {"map.yaml", "keepout.yaml", "speed.yaml", "path.yaml", "nav2_params.yaml"}
THEIRS = NAV2 | {"scout.yaml", "mine.yaml", "robot.yaml", "world.yaml", "w.yaml", "trusted/", "keys/", "site/"}


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_every_file_and_module_that_is_named_is_there(page: Path) -> None:
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    places = {f"/{name}" for name in listed} | {f"/{folder}/" for name in listed for folder in Path(name).parents}
    text = page.read_text()
    for named in re.findall(r"`([\w.-][\w./-]*(?:\.(?:py|cpp|sh|yaml|toml|md|lark)|/))`", text):
        assert named in THEIRS or any(place.endswith(f"/{named}") for place in places), named
    for dotted in re.findall(r"`(fieldhand(?:_bench)?(?:\.\w+)+)[`(]", text):
        if dotted not in GROUPS and not dotted[10].isupper():  # neither a group of plugins nor a schema
            assert _resolves(dotted), dotted


def _resolves(dotted: str) -> bool:
    """Return True if a dotted name is a module, or a name in one."""
    module, rest = dotted, list[str]()
    while module and not _is_module(module):
        module, _, last = module.rpartition(".")
        rest.insert(0, last)
    value: object = import_module(module) if module else None
    for name in rest:
        value = getattr(value, name, None)
    return value is not None


def _is_module(name: str) -> bool:
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:
        return False
