"""What cannot be written is found before anything is asked, planned or driven, and finding it leaves nothing behind."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import get_args, get_type_hints

import pytest
import typer
from typer.models import OptionInfo

from fieldhand.cli.app import assemble
from fieldhand.cli.outputs import require_folder
from fieldhand.errors import OutputError
from fieldhand_bench.commands.app import bench
from support.processes.command import fieldhand

#: Each asks for what needs a plan, a mission or a log, none of which is there.
COMMANDS: dict[str, tuple[str, ...]] = {
    "run": ("Read CO2 at tree 4.", "--site", "demo", "--yes"),
    "resume": (),
    "demo": (),
    "plan": ("Read CO2 at tree 4.", "--site", "demo"),
    "check": ("none.xml", "--site", "demo"),
    "approve": ("Read CO2 at tree 4.", "--site", "demo"),
    "site": ("demo",),
    "export mission": ("none.jsonl", "--to", "events"),
    "export nav2": ("--site", "demo"),
    "import": ("none.xml",),
    "replay": ("none.jsonl",),
    "report": ("none.jsonl",),
    "watch": ("https://127.0.0.1:1",),
    "keys new": ("--name", "Ada"),
    "robot show": ("husky",),
    "sim-robot": ("--site", "demo"),
    "robot calibrate": ("husky",),
    "bench orienteering": (
        "--graphs",
        "none",
    ),
    "bench coverage": ("--blocks", "1"),
    "bench missions": ("none",),
    "bench planning": (),
}
#: Of files and folders: what is read, and where a program keeps what it will find again.
READ = {"--world", "--task", "--missions", "--token-file", "--ca", "--graphs"}


def commands(app: typer.Typer, before: str = "") -> Iterator[tuple[str, Callable[..., None]]]:
    for command in app.registered_commands:
        assert command.callback is not None
        yield f"{before}{command.name or command.callback.__name__.replace('_', '-')}", command.callback
    for group in app.registered_groups:
        assert group.typer_instance is not None
        yield from commands(group.typer_instance, f"{before}{group.typer_instance.info.name} ")


def outputs() -> list[tuple[str, str]]:
    """Every option that names a file or folder and is not read."""
    found = []
    for name, command in (*commands(assemble()), *commands(bench, "bench ")):
        for hint in get_type_hints(command, include_extras=True).values():
            kind, *more = get_args(hint) or (hint,)
            if Path in (kind, *get_args(kind)) and more and isinstance(more[0], OptionInfo):
                # The first name of an annotated option stands where its default would.
                option = max((more[0].default, *more[0].param_decls), key=len)
                found += [(name, option)] if option not in READ else []
    return found


OUTPUTS = outputs()


def test_options_of_every_kind_are_found() -> None:
    assert {("run", "--events"), ("run", "--mcap"), ("run", "--out"), ("plan", "--picture")} < set(OUTPUTS)
    assert {("approve", "--output"), ("resume", "--mcap"), ("report", "--out")} < set(OUTPUTS)
    assert {name for name, _ in OUTPUTS} <= set(COMMANDS)


@pytest.mark.parametrize(("command", "option"), OUTPUTS)
def test_a_place_that_cannot_be_written_is_refused_before_all_else(command: str, option: str, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    words = (*command.split(), *COMMANDS[command], option, "file/below.png")
    run = fieldhand(*words, cwd=tmp_path, env=dict(os.environ) | {"FIELDHAND_CONFIG": str(tmp_path / "keys")})
    assert (run.status, run.out) == (2, ""), run
    assert run.err == (
        f"fieldhand: {option} file/below.png: cannot write: file is a file, not a folder;"
        " choose a folder that you may write to\n"
    )
    assert list(tmp_path.iterdir()) == [tmp_path / "file"]


@pytest.mark.parametrize(
    "words",
    [
        ("--events", "."),
        ("--mcap", "."),
        ("-o", "out"),
        ("--missions", "out/map.png/x.txt"),
        ("--events", "one", "--mcap", "deep/../one"),
        ("-o", "new", "--events", "new"),
        ("--transcript", "."),
    ],
    ids=" ".join,
)
def test_no_mission_is_begun_that_could_not_be_logged(words: tuple[str, ...], tmp_path: Path) -> None:
    (tmp_path / "out" / "map.png").mkdir(parents=True)
    (tmp_path / "out" / "map.png" / "x.txt").touch()
    (tmp_path / "deep").mkdir()
    before = sorted(tmp_path.rglob("*"))
    missions = {"FIELDHAND_MISSIONS": str(tmp_path / "missions")}
    run = fieldhand(*("run", *COMMANDS["run"]), *words, cwd=tmp_path, env=dict(os.environ) | missions)
    assert (run.status, run.out, run.err.count("\n")) == (2, "", 1), run
    assert sorted(tmp_path.rglob("*")) == before


def test_trying_leaves_nothing_behind_and_what_is_there_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "old.jsonl").write_text("kept")
    files = ("--events", "old.jsonl", "--mcap", "deep/new.mcap", "-o", "deep/out", "--transcript", "t.jsonl")
    run = fieldhand("run", "Colorless ideas dream.", "--site", "demo", "--planner", "english", *files, cwd=tmp_path)
    assert run.status == 2
    assert "colorless" in run.err.lower()
    assert [f.name for f in tmp_path.rglob("*")] == ["old.jsonl"]
    assert (tmp_path / "old.jsonl").read_text() == "kept"


def test_a_folder_without_rights_or_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(**_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "TemporaryFile", full)
    with pytest.raises(OutputError, match=r"^-o a: cannot write: No space left on device; choose"):
        require_folder(tmp_path / "a", "-o a")


def test_a_picture_of_no_kind_costs_no_planning(tmp_path: Path) -> None:
    run = fieldhand("plan", *COMMANDS["plan"], "--picture", "map.docx", cwd=tmp_path)
    assert (run.status, run.out) == (2, "")
    assert ".docx is not a supported picture format" in run.err


def test_a_device_takes_what_it_is_given(tmp_path: Path) -> None:
    run = fieldhand("run", *COMMANDS["run"], "--events", "/dev/null", "--mcap", "/dev/null", cwd=tmp_path)
    assert run.status == 0, run.err
