"""Every command in the docs runs, and every file that the docs link to is there."""

from __future__ import annotations

import os
import re
import shlex
from pathlib import Path

import pytest

from command import fieldhand

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
SHELL = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: Commands that serve until they are stopped have tests of their own, and so has the page that needs a robot.
SERVERS = ("fieldhand serve",)
ROBOT = "delivery"


def commands(page: Path) -> list[str]:
    """The ``fieldhand`` commands of a page's shell blocks, in their order."""
    lines = [line for block in SHELL.findall(page.read_text()) for line in block.replace("\\\n", " ").splitlines()]
    return [line.strip() for line in lines if line.strip().startswith("fieldhand ")]


@pytest.mark.parametrize("page", [page for page in PAGES if page.stem != ROBOT], ids=lambda p: p.stem)
def test_every_command_runs(page: Path, tmp_path: Path) -> None:
    for command in commands(page):
        if command.startswith(SERVERS):
            continue
        words = shlex.split(command, comments=True)[1:]
        env = os.environ | {"FIELDHAND_CONFIG": str(tmp_path / "config")}
        run = fieldhand(*words, cwd=tmp_path, env=env, fresh=page.stem == "README")
        assert run.status == 0, f"{command}\n{run.out[-2000:]}\n{run.err[-2000:]}"


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_every_link_leads_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#\s]+)", page.read_text()):
        if not target.startswith(("http://", "https://", "mailto:")):
            assert (page.parent / target).exists(), target
