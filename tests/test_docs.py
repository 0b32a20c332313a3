"""Every command in the docs runs, so does every example in Python, and every file that the docs link to is there."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from contextlib import ExitStack
from importlib.util import find_spec
from pathlib import Path

import pytest

import fieldhand as fh
from ros2.conftest import LOOPBACK
from support.processes.command import fieldhand, in_background

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "benchmarks" / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SHELL = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
PYTHON = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
PYTHON_PAGE = ROOT / "docs" / "python.md"
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
    for target in re.findall(r"\]\(([^)#\s]+)", page.read_text()):
        if not target.startswith(("http://", "https://", "mailto:")):
            assert (page.parent / target).exists(), target


def test_every_python_example_runs(tmp_path: Path) -> None:
    for library in ("dask.distributed", "geopandas"):
        pytest.importorskip(library)
    page, script = PYTHON_PAGE.read_text(), ""
    for found in PYTHON.finditer(page):
        above = page[: found.start(1)].count("\n")  # a failure names the line of the page
        script += "\n" * (above - script.count("\n")) + found[1]
    (tmp_path / "python.md").write_text(script)
    # A process of its own: Dask looks for the addresses of this machine, which no test may do.
    run = subprocess.run(
        [sys.executable, "-W", "error", "python.md"], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert run.returncode == 0, run.stderr[-2000:]


def test_every_public_name_is_explained_and_used_in_an_example() -> None:
    page = PYTHON_PAGE.read_text()
    examples, prose = "\n".join(PYTHON.findall(page)), PYTHON.sub("", page)
    for name in fh.__all__:
        assert re.search(rf"\bfh\.{name}\b", examples), name
        assert re.search(rf"`(fh\.)?{name}\b", prose), name


def test_the_reference_lists_every_public_name() -> None:
    listed = re.findall(r"^::: fieldhand\.(\w+)$", (ROOT / "docs" / "reference.md").read_text(), re.MULTILINE)
    assert sorted(listed) == fh.__all__


def test_the_site_of_the_docs_leads_to_every_page() -> None:
    pages = re.findall(r"[\w-]+\.md", (ROOT / "mkdocs.yml").read_text())
    assert sorted(pages) == sorted(page.name for page in (ROOT / "docs").glob("*.md"))
