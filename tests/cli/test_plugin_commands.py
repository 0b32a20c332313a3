"""Commands that other distributions add: run like others, never instead of them, and a broken one fails alone."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from fieldhand.cli import main, plugin_commands
from fieldhand.plugins import Plugin

Command = Callable[..., tuple[int, str, str]]

#: Of the packages that a command of a plugin may need to run, and its help may not.
HEAVY = ("fieldhand_bench.site", "fieldhand_bench.fly", "numpy", "scipy", "pyvrp", "matplotlib", "joblib")


@pytest.fixture
def fieldhand(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    """The command line in this process; returns exit status, standard output and standard error."""

    def command(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["fieldhand", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr()
        assert isinstance(ended.value.code, int | None)
        return ended.value.code or 0, said.out, said.err

    return command


def install(folder: Path, monkeypatch: pytest.MonkeyPatch, entries: str, **modules: str) -> None:
    """Install a distribution ``acme`` that registers commands."""
    info = folder / "acme-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(f"[fieldhand.commands]\n{entries}\n")
    for name, source in modules.items():
        (folder / f"{name}.py").write_text(source)
        monkeypatch.delitem(sys.modules, name, raising=False)
    monkeypatch.syspath_prepend(folder)


def test_a_function_becomes_a_command_and_a_typer_app_a_group(
    fieldhand: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = (
        "import typer\n"
        "def greet(name: str = 'you') -> None:\n    'Greet.'\n    typer.echo(f'hello {name}')\n"
        "tools = typer.Typer(help='Tools of Acme.')\n"
        "tools.command('greet')(greet)\n"
    )
    install(tmp_path, monkeypatch, "greet = acme_good:greet\nacme = acme_good:tools", acme_good=source)
    assert fieldhand("greet", "--name", "Ada") == (0, "hello Ada\n", "")
    assert fieldhand("acme", "greet") == (0, "hello you\n", "")
    status, out, err = fieldhand("--help")
    assert (status, err) == (0, "")
    assert "Tools of Acme." in out
    assert "Greet." in out


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("import nothing_of_this_name", "cannot be loaded: ModuleNotFoundError"),
        ("tools = 7", "neither a typer.Typer nor a function"),
        ("def tools(what: str | int) -> None: ...", "is not a command"),
    ],
)
def test_a_broken_one_fails_alone_and_is_named(
    fieldhand: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, source: str, reason: str
) -> None:
    install(tmp_path, monkeypatch, "acme = acme_bad:tools", acme_bad=source)
    plugin_commands._command_of.cache_clear()
    status, out, err = fieldhand("--help")
    assert status == 0
    assert "plan" in out
    assert err.startswith("fieldhand: warning: fieldhand.commands: acme = acme_bad:tools: the plugin ")
    assert "'acme' of acme 1.0" in err
    assert reason in err
    status, out, err = fieldhand("acme", "greet")
    assert (status, out) == (2, "")
    assert len(err.splitlines()) == 1
    assert reason in err
    assert fieldhand("site", "demo", "--json")[0] == 0


def test_no_plugin_takes_the_name_of_a_command(
    fieldhand: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    install(tmp_path, monkeypatch, "plan = acme_bad:tools", acme_bad="raise ValueError")
    status, _, err = fieldhand("plan", "Read CO2 at tree 4.", "--site", "demo")
    assert (status, err) == (0, "")
    assert fieldhand("--help")[2] == ""


def test_without_its_distribution_a_command_says_what_to_install(
    fieldhand: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    nothing: dict[str, Plugin] = {}
    monkeypatch.setattr(plugin_commands, "active", lambda *_, **__: nothing)
    assert fieldhand("bench", "site") == (
        2,
        "",
        "fieldhand: bench: the command is part of fieldhand-bench, which is not installed;"
        " install it with: pip install fieldhand-bench\n",
    )
    assert "bench" not in fieldhand("--help")[1]
    status, _, err = fieldhand("nothing-of-this-name")
    assert status == 2
    assert "nothing-of-this-name" in err


def test_the_help_lists_the_benchmarks_and_imports_nothing_that_they_run() -> None:
    program = (
        "import sys; from fieldhand.program import main; sys.argv = ['fieldhand', '--help']\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        f"print([name for name in {HEAVY} if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "bench " in run.stdout
    assert run.stdout.splitlines()[-1] == "[]"
