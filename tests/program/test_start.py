"""A process of the command line imports what its command needs, and not what others need."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from fieldhand.cli.app import assemble
from support.processes.patience import LONG_S

#: Packages that planning a request on a small site does without: their imports would take most of its time.
NOT_FOR_PLANS = (
    "scipy",
    "numba",
    "llvmlite",
    "matplotlib",
    "PIL",
    "pandas",
    "fastapi",
    "uvicorn",
    "py_trees",
    "joblib",
)

#: Modules of this package for carrying out and judging missions.
OTHER_WORK = ("fieldhand.execution.mission_runner", "fieldhand.evaluation.outcome", "fieldhand.task.results")


@pytest.mark.parametrize(
    "request_",
    [
        "Take a thermal picture of tree 5.",
        "Measure CO2 at the middle tree. If it is low, take 2 pictures of nearby trees.",
    ],
)
def test_a_plan_imports_neither_solvers_nor_drawing(request_: str, tmp_path: Path) -> None:
    task = tmp_path / "task.xml"
    script = (
        f"import sys; sys.argv = ['fieldhand', 'plan', {request_!r}, '--site', 'demo', '-o', {str(task)!r}]\n"
        "from fieldhand.program import main\n"
        "try: main()\n"
        "except SystemExit as end: assert not end.code\n"
        f"packages = {{name.partition('.')[0] for name in sys.modules}} & set({NOT_FOR_PLANS})\n"
        f"print('imported:', sorted(packages | (set(sys.modules) & set({OTHER_WORK}))))\n"
        "print('commands:', [name for name in ('run', 'demo', 'agent') if f'fieldhand.cli.{name}' in sys.modules])\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=LONG_S, check=True)
    assert task.is_file()
    assert done.stdout.splitlines()[-2:] == ["imported: []", "commands: []"]


def test_a_command_alone_is_the_command_among_all() -> None:
    app = assemble()
    everything = get_command(app).commands  # type: ignore[attr-defined]
    runner = CliRunner()
    for name in everything:
        alone = assemble(only=name)
        assert list(get_command(alone).commands) == [name]  # type: ignore[attr-defined]
        among_all = runner.invoke(app, [name, "--help"])
        assert among_all.exit_code == 0
        assert runner.invoke(alone, [name, "--help"]).stdout == among_all.stdout


@pytest.mark.parametrize("word", [None, "--help", "serve", "bench", "nothing-of-this-name"])
def test_without_a_known_command_all_are_listed(word: str | None) -> None:
    assert len(get_command(assemble(only=word)).commands) > 20  # type: ignore[attr-defined]
