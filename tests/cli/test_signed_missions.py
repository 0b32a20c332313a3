"""From a key to a finished mission on a robot that trusts it, at the command line; and nothing else in production."""

from __future__ import annotations

import hashlib
import io
import json
import sqlite3
import sys
from collections import Counter
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from cli.opened import read_files_under
from fieldhand import missions
from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.cli import app, approving, main, show
from fieldhand.compatibility import UTC
from fieldhand.exchange.mcap import read_mcap
from fieldhand.execution.journal import store
from fieldhand.robot.loader import profile_bytes
from fieldhand.site.loader import demo_path
from fieldhand.task.codec import encode
from fieldhand.task.results import Acted
from support.missions.signed import pack_mission, signing_key
from support.processes.browser import browser, corner_warnings, corner_xml
from support.processes.command import Run

REQUEST = "Read CO2 at tree 4."
Command = Callable[..., Run]


@cache
def _commands() -> Any:
    """Every command, put together once: that takes longer than most of what they do here."""
    return get_command(app.assemble())


@pytest.fixture
def fieldhand(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    """The command line in this process, on a machine where nobody has made or trusted a key."""
    monkeypatch.setenv("FIELDHAND_CONFIG", str(tmp_path / "config"))
    monkeypatch.chdir(tmp_path)
    commands = _commands()
    monkeypatch.setattr(app, "assemble", lambda *_, **__: commands)

    def command(*words: str, typed: str = "") -> Run:
        monkeypatch.setattr(sys, "argv", ["fieldhand", *words])
        monkeypatch.setattr(sys, "stdin", io.StringIO(typed))
        capsys.readouterr()
        status: Any = 0
        try:
            main()
        except SystemExit as end:
            status = end.code
        said = capsys.readouterr()
        assert "Traceback" not in said.err
        return Run(status=status or 0, out=said.out, err=said.err)

    return command


def approved(fieldhand: Command, *more: str) -> None:
    run = fieldhand("approve", REQUEST, "--site", "demo", "-o", "m.mission", "--yes", *more)
    assert run.status == 0, run.err


def refuses(run: Run, status: int, *words: str) -> None:
    assert run.status == status, (run.out, run.err)
    lines = [line for line in run.err.splitlines() if line.startswith("fieldhand: ")]
    assert len(lines) == 1, run.err
    for word in words:
        assert word in lines[0]


def test_the_whole_way(fieldhand: Command, tmp_path: Path) -> None:
    refuses(fieldhand("approve", REQUEST, "--site", "demo", "-o", "m.mission", "--yes"), 2, "fieldhand keys new")
    assert not Path("m.mission").exists()
    made = json.loads(fieldhand("keys", "new", "--name", "Ada", "--json").out)
    assert "PRIVATE" not in json.dumps(made)
    approved(fieldhand)
    signed = Path("m.mission").read_bytes()

    refuses(fieldhand("run", "m.mission"), 1, "not trusted here", made["fingerprint"])
    Path("mail.txt").write_text(f"Hello,\n> {made['public_key']}\nAda\n")
    wrong = signing_key(9).public.fingerprint
    refuses(fieldhand("keys", "trust", "mail.txt", "--fingerprint", wrong), 2, "another fingerprint")
    refuses(fieldhand("keys", "trust", "mail.txt"), 1, "needs a terminal")
    assert json.loads(fieldhand("keys", "list", "--json").out)["known"] == []
    trusted = fieldhand("keys", "trust", "mail.txt", "--fingerprint", made["fingerprint"], "--name", "Ada L.", "--json")
    assert json.loads(trusted.out)["state"] == "trusted"

    found = json.loads(fieldhand("inspect", "m.mission", "--json").out)
    assert (found["runs"], found["problems"], found["signature"]["state"]) == (True, [], "trusted")
    assert found["manifest"]["approved"]["by"] == "Ada"
    assert any("read CO₂" in line for line in found["review"]["read_back"])
    flown = fieldhand("run", "m.mission", "--production", "--seed", "3", "--events", "signed.jsonl")
    assert flown.status == 0, flown.err
    assert "signed with the key of Ada L." in flown.out
    fieldhand("run", REQUEST, "--site", "demo", "--yes", "--seed", "3", "--events", "asked.jsonl")
    assert Path("signed.jsonl").read_text() == Path("asked.jsonl").read_text()
    assert Path("m.mission").read_bytes() == signed

    assert fieldhand("keys", "revoke", made["fingerprint"].lower()).status == 0
    assert "REVOKED" in fieldhand("keys", "list").out
    refuses(fieldhand("run", "m.mission"), 1, "Ada L.", "revoked on")
    told = fieldhand("inspect", "m.mission", "--json")
    assert (told.status, json.loads(told.out)["signature"]["state"]) == (1, "revoked")
    refuses(fieldhand("keys", "trust", "mail.txt", "--yes"), 2, "revoked")


@pytest.fixture
def trusting(fieldhand: Command) -> Command:
    """A machine that has and trusts the key of Ada."""
    key, _ = SigningKeys(Path("config")).make("Ada")
    TrustStore(Path("config")).trust(key.public, name="Ada", at=datetime.now(UTC))
    return fieldhand


def test_production_takes_nothing_unsigned(trusting: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    approved(trusting)
    Path("task.xml").write_bytes(b"<task/>")
    for words in ((REQUEST,), ("task.xml",), ("m.zip",)):
        refuses(trusting("run", *words, "--site", "demo", "--yes", "--production"), 1, "only signed missions")
    monkeypatch.setenv("FIELDHAND_PRODUCTION", "1")
    for words in (("run", REQUEST, "--site", "demo", "--yes"), ("demo",)):
        refuses(trusting(*words), 1, "only signed missions")
    assert not Path("out").exists()
    answer = browser().post(
        "/api/run", {"xml": corner_xml(), "approved_by": "Ana", "confirmed": corner_warnings(), "seed": 3}
    )
    assert answer.status_code == 422
    assert "only signed missions" in answer.json()["what"]
    assert trusting("run", "m.mission").status == 0
    monkeypatch.setenv("FIELDHAND_PRODUCTION", "perhaps")
    refuses(trusting("run", REQUEST, "--site", "demo", "--yes"), 2, "neither yes nor no")


def test_what_is_given_beside_a_mission_must_be_what_was_approved(trusting: Command) -> None:
    approved(trusting)
    assert trusting("run", "m.mission", "--site", "demo", "--robot", "husky").status == 0
    refuses(trusting("run", "m.mission", "--robot", "amiga"), 2, "--robot", "amiga", "husky")
    from fieldhand.site.loader import demo_path

    Path("demo.geojson").write_bytes(demo_path().read_bytes() + b"\n")
    refuses(trusting("run", "m.mission", "--site", "demo.geojson"), 2, "--site", "Demo orchard")
    refuses(trusting("run", REQUEST), 2, "no site is given")


def test_a_mission_that_was_changed_is_broken(trusting: Command) -> None:
    approved(trusting)
    data = bytearray(Path("m.mission").read_bytes())
    data[-300] ^= 4
    Path("m.mission").write_bytes(data)
    refuses(trusting("run", "m.mission"), 2, "m.mission")
    told = trusting("inspect", "m.mission", "--json")
    found = json.loads(told.out)
    assert (told.status, found["runs"], found["signature"]["state"]) == (1, False, "broken")
    shown = trusting("inspect", "m.mission")
    refuses(shown, 1, "m.mission")
    assert "would not run here" in shown.out


def test_a_mission_of_a_stranger_is_shown_and_not_run(trusting: Command) -> None:
    now = datetime.now(UTC).isoformat(timespec="seconds")
    Path("m.mission").write_bytes(pack_mission(key=signing_key(5, "Mallory"), by="Ada", at=now))
    shown = trusting("inspect", "m.mission")
    refuses(shown, 1, "not trusted here")
    assert "Signature unknown" in shown.out
    assert "read CO₂" in shown.out
    refuses(trusting("run", "m.mission"), 1, "not trusted here")


def test_a_missing_mission_and_another_ending_are_said(trusting: Command) -> None:
    for command in ("run", "inspect"):
        refuses(trusting(command, "none.mission"), 2, "none.mission", "no such file")
    run = trusting("approve", REQUEST, "--site", "demo", "-o", "m.zip", "--yes")
    refuses(run, 2, "m.zip", "m.mission")


@pytest.mark.parametrize(("typed", "signed"), [("y\ny\n", True), ("n\n", False), ("y\nn\n", False)])
def test_a_person_confirms_the_warnings_and_then_signs(
    trusting: Command, typed: str, signed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(approving, "may_ask", lambda: True)
    Path("task.xml").write_bytes(_doubtful())
    run = trusting("approve", "task.xml", "--site", "demo", "-o", "m.mission", "--picture", "map.png", typed=typed)
    assert "Is the plan right in spite of the" in run.out
    assert ("Approve and sign?" in run.out) == typed.startswith("y")
    assert Path("map.png").read_bytes().startswith(b"\x89PNG")
    assert Path("m.mission").exists() == signed
    assert run.status == (0 if signed else 1)


def _doubtful() -> bytes:
    """A Task for two readings of which the request says three."""
    from fieldhand.cli.inputs import open_site_and_robot
    from fieldhand.planning.english.planner import EnglishPlanner
    from fieldhand.planning.planner import Planned

    site_and_robot = open_site_and_robot("demo", "husky")
    outcome = EnglishPlanner().plan("Take 2 pictures of tree 4.", site_and_robot.site, site_and_robot.robot)
    assert isinstance(outcome, Planned)
    return encode(outcome.task).replace(b"Take 2", b"Take 3")


def test_yes_alone_signs_nothing_that_is_warned_of(trusting: Command) -> None:
    Path("task.xml").write_bytes(_doubtful())
    words = ("approve", "task.xml", "--site", "demo", "-o", "m.mission", "--yes", "--json")
    refuses(trusting(*words), 1, "not confirmed")
    assert not Path("m.mission").exists()
    record = json.loads(trusting(*words, "--confirm").out)
    assert any("3 pictures" in warning for warning in record["authorization"]["confirmed"])
    assert json.loads(trusting("inspect", "m.mission", "--json").out)["hashes"]["bundle"] == record["sha256"]


def test_a_passphrase_comes_from_the_environment(fieldhand: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    refuses(fieldhand("keys", "new", "--passphrase"), 2, "FIELDHAND_KEY_PASSPHRASE")
    monkeypatch.setenv("FIELDHAND_KEY_PASSPHRASE", "correct horse")
    assert fieldhand("keys", "new", "--name", "Ada").status == 0
    assert b"ENCRYPTED" in Path("config/keys/ada.key").read_bytes()
    approved(fieldhand)
    for passphrase in ("wrong horse", ""):
        monkeypatch.setenv("FIELDHAND_KEY_PASSPHRASE", passphrase)
        run = fieldhand("approve", REQUEST, "--site", "demo", "-o", "other.mission", "--yes")
        refuses(run, 2, "ada.key", "passphrase")
    assert not Path("other.mission").exists()


class _PowerCut(BaseException):
    """No handler of the program's own stops it."""


@pytest.fixture
def cut_off(trusting: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a signed mission that was cut off while it was driving, on a machine in production."""
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path / "missions"))
    monkeypatch.setenv("FIELDHAND_PRODUCTION", "1")
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    approved(trusting)
    with monkeypatch.context() as patch:
        told = show.out.print

        def cut(line: object = "", *more: object) -> None:
            if "at tree 4 (" in str(line):
                raise _PowerCut
            told(line, *more)

        patch.setattr(show.out, "print", cut)
        with pytest.raises(_PowerCut):
            trusting("run", "m.mission")
    Path("m.mission").unlink()
    (folder,) = (tmp_path / "missions").iterdir()
    assert missions.status(folder).now.state == "interrupted"
    return folder


def _events(folder: Path) -> int:
    return len(missions.events_of(folder))


def test_a_signed_mission_is_resumed_in_production_from_its_folder_alone(trusting: Command, cut_off: Path) -> None:
    text = trusting("resume", "--mcap", "m.mcap")
    assert (text.status, missions.status(cut_off).now.status) == (0, "completed"), text.err
    assert "signed with the key of Ada" in text.out
    assert read_mcap(Path("m.mcap")) == missions.events_of(cut_off)
    record = json.loads(trusting("resume", "--json", "--production").out)
    data = (cut_off / "signed.mission").read_bytes()
    assert record["signed"]["hashes"]["bundle"] == hashlib.sha256(data).hexdigest()
    assert record["signed"]["key"]["name"] == record["signed"]["authorization"]["by"] == "Ada"
    assert record["mission"] == cut_off.name


def test_a_key_that_was_revoked_since_ends_a_mission(trusting: Command, cut_off: Path) -> None:
    before = _events(cut_off)
    (key,) = json.loads(trusting("keys", "list", "--json").out)["known"]
    assert trusting("keys", "revoke", key["fingerprint"]).status == 0
    refuses(trusting("resume"), 1, "revoked on", "signed.mission")
    assert _events(cut_off) == before


def _declare(folder: Path, **changed: bytes | None) -> None:
    """Change files of a mission, and everything in its folder that would show it."""
    about = json.loads((folder / "mission.json").read_bytes())
    for name, data in changed.items():
        file = next(file for file in about["files"] if file.replace("/", "_").startswith(name))
        if data is None:
            del about["files"][file]
            (folder / file).unlink()
        else:
            about["files"][file] = hashlib.sha256(data).hexdigest()
            (folder / file).write_bytes(data)
            if name == "site":
                about["authorization"]["site_sha256"] = hashlib.sha256(data).hexdigest()
    (folder / "mission.json").write_text(json.dumps(about))
    with closing(sqlite3.connect(folder / "journal.sqlite", isolation_level=None)) as db:
        whole = (folder / "mission.json").read_bytes()
        db.execute("UPDATE about SET value = ? WHERE key = 'mission'", [hashlib.sha256(whole).hexdigest()])


@pytest.mark.parametrize(("at", "declared"), [(-300, False), (-300, True), (40, True), (-1, True)])
def test_a_changed_byte_of_the_bundle_in_the_folder_ends_a_mission(
    trusting: Command, cut_off: Path, at: int, declared: bool
) -> None:
    data = bytearray((cut_off / "signed.mission").read_bytes())
    data[at] ^= 4
    before = _events(cut_off)
    if declared:
        _declare(cut_off, signed=bytes(data))
    else:
        (cut_off / "signed.mission").write_bytes(data)
    refuses(trusting("resume"), 2, "signed.mission" if declared else "not the file that the mission started with")
    assert _events(cut_off) == before


@pytest.mark.parametrize("declared", [False, True])
def test_a_site_that_was_replaced_in_the_folder_ends_a_mission(
    trusting: Command, cut_off: Path, declared: bool
) -> None:
    (file,) = (cut_off / "site").iterdir()
    other = file.read_bytes().replace(b"Carmel", b"Caramel")
    before = _events(cut_off)
    if declared:
        _declare(cut_off, site=other)
        refuses(trusting("resume"), 1, "the site in the mission's folder is not what was signed")
    else:
        file.write_bytes(other)
        refuses(trusting("resume"), 2, "not the file that the mission started with")
    assert _events(cut_off) == before


def test_a_folder_without_its_bundle_is_not_resumed_in_production(
    trusting: Command, cut_off: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = _events(cut_off)
    _declare(cut_off, signed=None)
    refuses(trusting("resume"), 1, "only signed missions")
    monkeypatch.delenv("FIELDHAND_PRODUCTION")
    refuses(trusting("resume", "--production"), 1, "only signed missions")
    assert _events(cut_off) == before
    assert trusting("resume").status == 0


#: What SQLite opens it opens itself; what a person reads afterwards decides nothing.
_WRITTEN = {"events.jsonl", "report.html", "observations.csv", "observations.geojson"}


def _deciding(read: Counter[Path]) -> dict[str, int]:
    return {path.name: times for path, times in read.items() if path.name not in _WRITTEN}


def test_each_file_that_decides_what_the_robot_does_is_read_once(
    trusting: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file that was put in the place of one that was verified is never looked at."""
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path / "missions"))
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    approved(trusting)
    Path("world.yaml").write_text("readings:\n  co2: 380\n")
    (file,) = TrustStore(tmp_path / "config").folder.glob("*-*.json")
    trust = file.name
    with read_files_under(tmp_path) as read:
        assert trusting("run", "m.mission", "--production", "--world", "world.yaml").status == 0
    assert _deciding(read) == {"m.mission": 1, "world.yaml": 1, trust: 1, "list.json": 1, "journal.mark": 1}
    (folder,) = (tmp_path / "missions").iterdir()
    with read_files_under(tmp_path) as read:
        assert trusting("resume", folder.name, "--production").status == 0
    once = ("mission.json", "signed.mission", "task.xml", "robot.yaml", "world.yaml", "demo.geojson", trust)
    once = (*once, "list.json", "approvals.json")
    assert _deciding(read) == dict.fromkeys((*once, "journal.mark"), 1)

    for name, data in (("demo.geojson", demo_path().read_bytes()), ("robot.yaml", profile_bytes("husky")[0])):
        Path(name).write_bytes(data)
    with read_files_under(tmp_path) as read:
        run = trusting("run", REQUEST, "--site", "demo.geojson", "--robot", "robot.yaml", "--yes")
        assert run.status == 0, run.err
    assert _deciding(read) == {"demo.geojson": 1, "robot.yaml": 1, "journal.mark": 1}


def test_what_was_verified_is_what_is_run_whatever_is_put_in_its_place(
    trusting: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Every file of the mission's folder, and the bundle, are replaced the moment the folder is there."""
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path / "missions"))
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    approved(trusting)
    trusting("run", "Take a thermal picture of tree 10.", "--site", "demo", "--yes", "--confirm")
    (other,) = (tmp_path / "missions").iterdir()
    begin = missions.begin

    def swapped(*words: Any) -> missions.StoredMission:
        given = begin(*words)
        for file in ("task.xml", "mission.json", "robot.yaml"):
            (given.folder / file).write_bytes((other / file).read_bytes())
        Path("m.mission").write_bytes(b"another")
        return given

    monkeypatch.setattr(missions, "begin", swapped)
    done = json.loads(trusting("run", "m.mission", "--production", "--json").out)
    events = missions.events_of(tmp_path / "missions" / done["mission"])
    assert [(e.action, e.place) for e in events if isinstance(e, Acted)] == [("read_co2", "4")]


def _page(folder: str) -> str:
    return Path(folder, "report.html").read_text()


def test_a_signed_mission_and_its_folder_are_reported_exported_and_replayed_without_more(
    trusting: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FIELDHAND_MISSIONS", str(tmp_path / "missions"))
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    approved(trusting)
    done = json.loads(
        trusting("run", "m.mission", "--mcap", "m.mcap", "--events", "m.jsonl", "-o", "out", "--json").out
    )
    name, (key,) = done["mission"], json.loads(trusting("keys", "list", "--json").out)["known"]
    log = missions.events_of(tmp_path / "missions" / name)
    assert read_mcap(Path("m.mcap")) == log
    assert done["signed"]["hashes"]["bundle"] == hashlib.sha256(Path("m.mission").read_bytes()).hexdigest()
    for words in ((), ("m.mcap", "--task", "m.mission")):
        assert trusting("report", *words, "-o", "again").status == 0
        assert f"the key of Ada ({key['fingerprint']})" in _page("again")
        assert Path("again/observations.csv").read_bytes() == Path("out/observations.csv").read_bytes()
    assert f"the key of Ada ({key['fingerprint']})" in _page("out")
    for given, to in (("m.mission", "btcpp"), (name, "btcpp"), ("m.mission", "kml"), (name, "geojson"), (name, "mcap")):
        assert trusting("export", given, "--to", to, "-o", f"{given}.{to}").status == 0
    assert Path("m.mission.btcpp").read_bytes() == Path(f"{name}.btcpp").read_bytes()
    assert read_mcap(Path(f"{name}.mcap")) == log
    for words in ((str(tmp_path / "missions" / name),), ("m.jsonl", "--site", "m.mission")):
        facts = json.loads(trusting("replay", *words, "-o", "m.html", "--json").out)
        assert (facts["events"], facts["captures"]) == (len(log), 1)
    refuses(trusting("report", name, "--site", "demo"), 2, "--site", "already contains it")
    refuses(
        trusting("report", "m.jsonl", "--task", "m.mission", "--robot", "husky"), 2, "--robot", "already contains it"
    )
    refuses(trusting("report", "m.jsonl"), 2, "--task", "not given")
    refuses(trusting("replay", "nowhere", "-o", "x.html"), 2, "no mission 'nowhere'")
    assert trusting("keys", "revoke", key["fingerprint"]).status == 0
    assert trusting("report", name, "-o", "again").status == 0
    assert "revoked on" in _page("again")
