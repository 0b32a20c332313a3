"""Whole commands in a language whose sentences have no words: names, numbers and the person's own words are left.

A sentence that is not made of messages keeps its English, and so is seen.
"""

from __future__ import annotations

import io
import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import pytest

from fieldhand.cli.demo import MISSIONS, DemoName
from fieldhand.language import catalogue
from fieldhand.program import main
from language.silent_language import silent_po, words_left, words_of

#: Names of the built-in orchard and robots, of options' values, units and kinds of file.
KNOWN = {
    *("fieldhand", "Demo", "orchard", "husky", "Husky", "amiga", "tractor", "start", "end", "geojson", "csv", "html"),
    *("ppm", "min", "auto", "english", "llm", "simulation", "dds", "rclpy", "max", "xx", "es", "en", "TREE", "domain"),
}
#: Commands, as advice names them.
COMMANDS = re.compile(r"fieldhand (?:approve|plan|run|resume|report|keys trust|keys confirm|status|inspect)\b")
#: Paths, options, variables, fingerprints, names of missions, files, nodes and quantities.
NAMES = re.compile(
    r"\bco2\b|\S*/\S*|--[a-z-]+|[A-Z]+_[A-Z_]+|\b[0-9a-f]{8,}\S*|\S*\d{8}\S*|\b\w+_\w+\b|[\w-]+\.(?=\w)\w+|/dev/null\S*"
)


@dataclass(frozen=True, kw_only=True)
class Printed:
    """Return the text that a command printed: its standard output, then its errors."""

    status: int
    text: str

    def leaks(self, *own: str) -> list[str]:
        """Return the lines that hold words of no message, but for names and what is the person's ``own``."""
        known = KNOWN | {word for text in own for word in words_of(text)}
        lines = [NAMES.sub("", COMMANDS.sub("", line)) for line in self.text.splitlines()]
        return [f"{left} <- {line}" for line in lines if (left := words_left(line, known))]


Command = Callable[..., Printed]


class Person(io.StringIO):
    """Standard input at which a person types."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Iterator[Command]:
    """A command of this process, in the language without words."""
    file = tmp_path / "locale" / "xx" / "LC_MESSAGES" / "fieldhand.po"
    file.parent.mkdir(parents=True)
    file.write_text(silent_po(), encoding="utf-8")
    monkeypatch.setattr(catalogue, "_locale", lambda: tmp_path / "locale")
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path / "missions"))
    for variable in ("XDG_STATE_HOME", "XDG_CONFIG_HOME"):
        monkeypatch.setenv(variable, str(tmp_path / variable.lower()))
    monkeypatch.setenv("LANG", "C")
    catalogue.open_language.cache_clear()

    def run(*words: str, typed: str | None = None, lang: str = "xx") -> Printed:
        monkeypatch.setattr(sys, "argv", ["fieldhand", *words, "--lang", lang])
        monkeypatch.setattr(sys, "stdin", io.StringIO() if typed is None else Person(typed))
        with pytest.raises(SystemExit) as ended:
            main()
        out, err = capsys.readouterr()
        code = ended.value.code
        return Printed(status=code if isinstance(code, int) else 0, text=out + err)

    yield run
    catalogue.open_language.cache_clear()


REQUEST = "Measure CO2 at trees 4 and 9. If the CO2 is low, take a picture of the tree next to it."
TIGHT = "Take pictures of as many trees as you can without driving more than 400 m."
FAR = "Go to tree 4 and measure CO2 without driving more than 2 m."
FAULTS = """\
readings:
  co2: 380
faults:
  - {fault: action_fails, action: take_thermal_picture, times: 2}
  - {fault: sensor_silent, quantity: co2, at: {id: "9"}}
"""
EMPTYING = """\
charge_percent: 24
faults:
  - {fault: battery_drains, factor: 14}
"""


def test_a_mission_from_its_plan_to_its_report(command: Command, tmp_path: Path) -> None:
    out = tmp_path / "out"
    plan = command("plan", REQUEST, "--site", "demo", "-o", str(tmp_path / "task.xml"))
    assert plan.status == 0
    assert not plan.leaks(REQUEST)
    assert not command("check", str(tmp_path / "task.xml"), "--site", "demo").leaks(REQUEST)
    done = command("run", REQUEST, "--site", "demo", "--yes", "--confirm", "-o", str(out))
    assert done.status == 0
    assert not done.leaks(REQUEST)
    assert not command("status").leaks(REQUEST)
    assert not command("report", "-o", str(tmp_path / "again")).leaks(REQUEST)


def test_a_mission_that_is_left_incomplete(command: Command) -> None:
    done = command("run", TIGHT, "--site", "demo", "--yes", "--confirm")
    assert not done.leaks(TIGHT)
    assert not command("status").leaks(TIGHT)


@pytest.mark.parametrize(("request_", "world"), [(REQUEST, FAULTS), (TIGHT, EMPTYING)], ids=["faults", "emptying"])
def test_a_mission_on_which_things_go_wrong(command: Command, tmp_path: Path, request_: str, world: str) -> None:
    file = tmp_path / "world.yaml"
    file.write_text(world)
    done = command("run", request_, "--site", "demo", "--yes", "--confirm", "--world", str(file))
    assert done.status == 1
    assert not done.leaks(request_)
    assert not command("status").leaks(request_)


def test_the_plan_is_declined_or_nobody_is_there(command: Command) -> None:
    for words, typed in (
        (["--yes"], None),
        ([], None),
        ([], "n\n"),
        (["--confirm"], "no\n"),
        (["--confirm"], "\n"),
        (["--confirm"], "perhaps\nn\n"),
        ([], ""),
    ):
        done = command("run", MISSIONS[DemoName.PICTURES].request, "--site", "demo", *words, typed=typed)
        assert done.status == 1
        assert not done.leaks(MISSIONS[DemoName.PICTURES].request)


@pytest.mark.parametrize("typed", ["s\n", "y\n", "YES\n", "perhaps\nyes\n"])
def test_yes_is_said_in_the_language_or_in_english(command: Command, typed: str) -> None:
    assert command("run", REQUEST, "--site", "demo", typed=typed).status == 0


def test_a_plan_that_fails_its_checks(command: Command) -> None:
    assert not command("run", FAR, "--site", "demo", "--yes").leaks(FAR)
    assert not command("run", FAR, "--site", "demo", "--yes", "--json").leaks(FAR)


ASKED = ["Take a picture.", "Take pictures of some trees in row 3.", "Measure CO2 at the corner tree."]
REFUSED = ["Fly to the moon.", "Photograph tree 9999.", "Prends une photo des arbres", "Take a picture at noon."]


@pytest.mark.parametrize("request_", [*ASKED, *REFUSED])
def test_a_question_and_a_refusal(command: Command, request_: str) -> None:
    for words in (("plan", request_), ("run", request_, "--yes")):
        done = command(*words, "--site", "demo")
        assert done.status == 2
        assert not done.leaks(request_)


def test_a_person_is_asked_and_answers_with_a_number(command: Command) -> None:
    done = command("plan", ASKED[1], "--site", "demo", typed="1\n")
    assert done.status == 0
    assert not done.leaks(ASKED[1])
    assert not command("plan", ASKED[1], "--site", "demo", typed="").leaks(ASKED[1])


@pytest.mark.parametrize(
    "words",
    [
        ("Take a picture of tree 4.", "--site", "nowhere.geojson"),
        ("Take a picture of tree 4.",),
        ("Take a picture of tree 4.", "--site", "demo", "--robot", "nobody"),
        ("Take a picture of tree 4.", "--site", "demo", "--planner", "nobody"),
        ("Take a picture of tree 4.", "--site", "demo", "--planner", "llm"),
        ("Take a picture of tree 4.", "--site", "demo", "--speed", "fast"),
        ("Take a picture of tree 4.", "--site", "demo", "--on", "fast"),
        ("Take a picture of tree 4.", "--site", "demo", "--answer", "fast"),
        ("Take a picture of tree 4.", "--site", "demo", "--domain", "3"),
        ("Take a picture of tree 4.", "--site", "demo", "--world", "nothing.yaml"),
        ("Take a picture of tree 4.", "--site", "demo", "--production"),
        ("Take a picture of tree 4.", "--site", "demo", "-o", "/dev/null/out"),
        ("", "--site", "demo"),
        ("nothing.mission", "--site", "demo"),
        ("nothing.xml", "--site", "demo"),
    ],
)
def test_what_cannot_be_used(command: Command, words: tuple[str, ...]) -> None:
    done = command("run", *words)
    assert done.status
    assert done.text.startswith("fieldhand: ")
    assert not done.leaks(words[0], "nobody fast null")


def test_accounts_and_their_errors(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("sqlalchemy")
    own = (
        "Ada",
        "admin",
        "local",
        "read",
        "plan",
        "approve",
        "command",
        "NAME",
        "cron",
        "accounts",
        "add",
        "boss",
        "fly",
    )
    roles = ("viewer", "planner", "approver")
    for words in (
        ("list",),
        ("add", "Ada", "--role", "admin"),
        ("role", "Ada", "viewer"),
        ("password", "Ada"),
        ("token", "cron", "--scopes", "read"),
        ("token", "cron", "--scopes", "read", "--days", "1"),
        ("link",),
    ):
        monkeypatch.setenv("FIELDHAND_PASSWORD", "six yellow plums")
        done = command("accounts", *words)
        assert done.status == 0, done.text
        assert not replace(done, text=re.sub(r"\bfh_\S+", "", done.text)).leaks(*own, *roles)
    for words, password in (
        (("add", "ada"), "six yellow plums"),
        (("add", "Bob"), "short"),
        (("add", "Bob"), "aaaaaaaaaaaaaa"),
        (("add", "Bob"), ""),
        (("add", "local"), "six yellow plums"),
        (("add", "a\u202eb"), "six yellow plums"),
        (("add", "x" * 101), "six yellow plums"),
        (("add", "Bob", "--role", "boss"), "six yellow plums"),
        (("remove", "Bob"), ""),
        (("token", "x", "--scopes", "fly"), ""),
    ):
        monkeypatch.setenv("FIELDHAND_PASSWORD", password)
        failed = command("accounts", *words)
        assert failed.status == 2
        assert not failed.leaks(*own, *roles, "Bob", "ada", "RIGHT TO LEFT OVERRIDE")
    monkeypatch.setenv("FIELDHAND_DATABASE", "nonsense")
    assert not command("accounts", "list").leaks(
        "sqlite", "postgresql", "FOLDER", "FILE", "USER", "PASSWORD", "HOST", "NAME"
    )
    monkeypatch.delenv("FIELDHAND_DATABASE")
    assert not command("accounts", "remove", "Ada").leaks(*own)
