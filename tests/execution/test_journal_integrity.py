"""A journal with rows that were changed, dropped or lost is refused; of two writers the earlier one stops."""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from execution.journalled import Field, PowerCut
from fieldhand.errors import JournalError
from fieldhand.execution import mission_clock
from fieldhand.execution.journal import store
from fieldhand.execution.journal.records import Record
from fieldhand.execution.journal.store import Journal, create, lines_after, read_summary
from fieldhand.execution.mission_runner import Result
from fieldhand.execution.operator_commands import CommandFile
from fieldhand.task.event_lines import to_json
from fieldhand.task.results import Resumed
from support.missions.rig import captured, of_type


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")
    monkeypatch.setattr(mission_clock.time, "sleep", lambda seconds: None)


def cut_off(folder: Path) -> Field:
    """A mission that was cut off half way."""
    field = Field(folder)
    with pytest.raises(PowerCut):
        field.fly(cut=9)
    return field


def copy_of(field: Field, to: Path) -> None:
    """Copy the folder of a mission while nobody has it open."""
    shutil.copytree(field.folder, to)


def opened(folder: Path) -> Journal:
    return Journal(folder / "journal.sqlite", "mission", folder / "log", lambda line: None)


def rows(folder: Path, table: str) -> int:
    with closing(sqlite3.connect(folder / "journal.sqlite")) as db:
        return int(db.execute(f"SELECT count(*) FROM {table}").fetchone()[0])


def change(folder: Path, *statements: str) -> None:
    with closing(sqlite3.connect(folder / "journal.sqlite", isolation_level=None)) as db:
        for statement in statements:
            db.execute(statement)


CHANGES = {
    "changed": (["UPDATE {t} SET {c} = {c} || ' ' WHERE n = 3"], "row 3 of its {t} is not the one that was written"),
    "dropped": (["DELETE FROM {t} WHERE n = 3"], "row 3 of its {t} is missing"),
    "moved": (
        ["UPDATE {t} SET n = -3 WHERE n = 3", "UPDATE {t} SET n = 3 WHERE n = 4", "UPDATE {t} SET n = 4 WHERE n = -3"],
        "row 3 of its {t} is not the one that was written",
    ),
    "its end dropped": (["DELETE FROM {t} WHERE n = (SELECT max(n) FROM {t})"], "rows are missing at its end"),
    "repeated": (
        ["INSERT INTO {t} SELECT (SELECT max(n) + 1 FROM {t}), {c0}, {c}, sha256 FROM {t} WHERE n = 2"],
        "is not the one that was written",
    ),
}


@pytest.mark.parametrize("harm", CHANGES)
@pytest.mark.parametrize(("table", "first", "column"), [("tape", "kind", "body"), ("events", "at", "line")])
def test_a_row_that_was_changed_dropped_or_moved_is_named(
    tmp_path: Path, table: str, first: str, column: str, harm: str
) -> None:
    field = cut_off(tmp_path / "m")
    statements, said = CHANGES[harm]
    change(field.folder, *(one.format(t=table, c=column, c0=first) for one in statements))
    with pytest.raises(JournalError, match=said.format(t=table)):
        field.fly()
    if table == "events" and harm != "its end dropped":
        with pytest.raises(JournalError, match="of its events"):
            read_summary(field.folder / "journal.sqlite")
        with pytest.raises(JournalError, match="of its events"):
            lines_after(field.folder / "journal.sqlite", 1, 500)


LOST = ("journal.sqlite-wal", "journal.sqlite-shm", "log", "journal.mark")


def killed(folder: Path) -> Path:
    """The folder of a mission as ``kill -9`` leaves it, with the latest rows in the write-ahead log alone."""
    live = Field(folder.with_name("live"))
    reader = sqlite3.connect(live.folder / "journal.sqlite")
    reader.execute("SELECT * FROM tape").fetchall()  # keeps the write-ahead log from being folded in
    with pytest.raises(PowerCut):
        live.fly(cut=9)
    shutil.copytree(live.folder, folder)
    reader.close()
    return folder


@pytest.mark.parametrize("lost", [LOST[:1], LOST[:2], LOST[:3], LOST, LOST[3:], LOST[2:3], LOST[1:2]])
def test_an_acted_on_journal_that_lost_its_latest_rows_does_not_begin_anew(
    tmp_path: Path, lost: tuple[str, ...]
) -> None:
    folder = killed(tmp_path / "m")
    for name in lost:
        (folder / name).unlink()
    if lost in (LOST[2:3], LOST[1:2]):
        with opened(folder) as journal:
            assert len(journal.before) > 5, "the log and the index of the write-ahead log are made anew"
        return
    with pytest.raises(JournalError, match=r"older than the mission|high-water mark of the journal"):
        opened(folder)


def test_a_journal_and_a_log_from_a_copy_are_older_than_their_mark(tmp_path: Path) -> None:
    field = cut_off(tmp_path / "m")
    copy_of(field, tmp_path / "copy")
    field.fly()
    for name in ("journal.sqlite", "log"):
        shutil.copy(tmp_path / "copy" / name, field.folder / name)
    with pytest.raises(JournalError, match=r"older than the mission: \d+ rows of its tape are there"):
        opened(field.folder)


def test_another_journal_that_went_as_far_is_told_from_its_own(tmp_path: Path) -> None:
    field = cut_off(tmp_path / "m")
    copy_of(field, tmp_path / "copy")
    for folder in (field.folder, tmp_path / "copy"):
        with opened(folder) as journal:
            journal.append(Record(kind="sight", body=f'"{folder.name}"'))
            journal.commit()
    shutil.copy(tmp_path / "copy" / "journal.sqlite", field.folder / "journal.sqlite")
    with pytest.raises(JournalError, match="older than the mission"):
        opened(field.folder)


@pytest.mark.parametrize("torn", [slice(0, 512), slice(512, 1024), slice(100, 300)])
def test_a_mark_that_was_cut_off_in_mid_write_leaves_the_one_before(tmp_path: Path, torn: slice) -> None:
    field = cut_off(tmp_path / "m")
    mark = field.folder / "journal.mark"
    data = bytearray(mark.read_bytes())
    data[torn] = bytes(len(data[torn]))
    mark.write_bytes(data)
    assert field.fly().status == "completed"
    mark.write_bytes(bytes(1024))
    with pytest.raises(JournalError, match="is damaged"):
        field.fly()


def test_one_writer_at_a_time(tmp_path: Path) -> None:
    """The lock is on the folder: there is no file whose loss would let a second one in."""
    field = Field(tmp_path / "m")
    with opened(field.folder):
        (field.folder / "lock").touch()
        (field.folder / "lock").unlink()
        with pytest.raises(JournalError, match="another process is running this mission"):
            opened(field.folder)
    opened(field.folder).close()


def in_another_folder(folder: Path) -> None:
    """Put the files of a folder into a new one of the same name: they are the same files, and the lock is not there."""
    old = folder.rename(folder.with_name("old"))
    folder.mkdir()
    for file in old.iterdir():
        file.rename(folder / file.name)


def test_of_two_writers_that_no_lock_keeps_apart_the_earlier_stops(tmp_path: Path) -> None:
    """And nothing of what it still has is written between the rows of the other."""
    field = cut_off(tmp_path / "m")
    before = rows(field.folder, "tape")
    one = opened(field.folder)
    one.append(Record(kind="sight", body="one"))
    one.commit()
    in_another_folder(field.folder)
    with opened(field.folder) as two:
        for _ in range(2):
            one.append(Record(kind="sight", body="one again"))
            with pytest.raises(JournalError, match=r"taken over this mission|could not be written before"):
                one.commit()
        two.append(Record(kind="sight", body="two"))
        two.commit()
        one.close()
    with closing(sqlite3.connect(field.folder / "journal.sqlite")) as db:
        found = [body for (body,) in db.execute("SELECT body FROM tape WHERE n > ? ORDER BY n", [before])]
    assert found == ["one", "two"]


def test_rows_of_another_writer_are_an_error_and_never_dropped(tmp_path: Path) -> None:
    """Also where that one is no version of this program, and counts no epochs."""
    field = cut_off(tmp_path / "m")
    with opened(field.folder) as journal:
        change(
            field.folder,
            "INSERT INTO tape SELECT (SELECT max(n) + 1 FROM tape), kind, body, sha256 FROM tape WHERE n = 1",
        )
        journal.append(Record(kind="sight", body="{}"))
        with pytest.raises(JournalError, match="rows that another process has written"):
            journal.commit()


def _deleted(folder: Path) -> None:
    for file in folder.iterdir():
        file.unlink()
    folder.rmdir()


def _replaced(folder: Path) -> None:
    data = (folder / "journal.sqlite").read_bytes()
    (folder / "journal.sqlite").unlink()
    (folder / "journal.sqlite").write_bytes(data)


HARMS: dict[str, Callable[[Path], object]] = {
    "the folder is renamed": lambda folder: folder.rename(folder.with_name("elsewhere")),
    "the folder is deleted": _deleted,
    "the journal is replaced": _replaced,
    "the journal is deleted": lambda folder: (folder / "journal.sqlite").unlink(),
    "its write-ahead log is deleted": lambda folder: (folder / "journal.sqlite-wal").unlink(),
}


@pytest.mark.parametrize("harm", HARMS)
def test_a_journal_that_goes_from_its_place_ends_the_mission_in_order(tmp_path: Path, harm: str) -> None:
    whole = Field(tmp_path / "whole").fly()
    field, told = Field(tmp_path / "m", outlives=True), 0

    class Harmed(Journal):
        def commit(self, *, order: int = 0) -> None:
            nonlocal told
            told += 1
            if told == 8:
                HARMS[harm](field.folder)
            super().commit(order=order)

    with pytest.raises(JournalError, match=r"is no longer in its place|cannot be written"):
        field.fly(journal=Harmed)
    assert field.driver.poll().over, "no wheel turns"
    assert told == 8, "nothing is begun behind it"
    if (tmp_path / "elsewhere").exists():
        (tmp_path / "elsewhere").rename(field.folder)
        assert same(field.fly(), whole)
    elif "write-ahead" in harm or "replaced" in harm:
        # The program had the deleted log open, and has folded it in; beside a copy of its journal it still fits.
        assert same(field.fly(), whole)
    else:
        with pytest.raises(JournalError):
            field.fly()


def same(result: Result, whole: Result) -> bool:
    return captured(result.events) == captured(whole.events) and len(of_type(result.events, Resumed)) == 1


def test_a_journal_without_checksums_is_read_and_gone_on_with(tmp_path: Path) -> None:
    """One of the version before: it gets checksums and a mark."""
    whole, field = Field(tmp_path / "whole").fly(), cut_off(tmp_path / "m")
    path = field.folder / "journal.sqlite"
    now = read_summary(path)
    change(
        field.folder,
        "ALTER TABLE tape DROP COLUMN sha256",
        "ALTER TABLE events DROP COLUMN sha256",
        "UPDATE about SET value = '1' WHERE key = 'format'",
        "DELETE FROM about WHERE key IN ('epoch', 'rows')",
    )
    (field.folder / "journal.mark").unlink()
    assert read_summary(path) == now
    assert len(lines_after(path, 2, 3)) == 3
    result = field.fly()
    assert same(result, whole)
    assert field.lines == [to_json(event) for event in result.events]
    change(field.folder, "DELETE FROM tape WHERE n = 3")
    with pytest.raises(JournalError, match="row 3 of its tape is missing"):
        field.fly()


def test_a_writer_of_the_version_before_stops_once_its_journal_was_taken_over(tmp_path: Path) -> None:
    field = cut_off(tmp_path / "m")
    with (
        opened(field.folder),
        closing(sqlite3.connect(field.folder / "journal.sqlite")) as older,
        pytest.raises(sqlite3.OperationalError, match="4 columns but 3 values"),
    ):
        older.executemany("INSERT OR IGNORE INTO tape VALUES (?, ?, ?)", [(1, "sight", "{}")])


@pytest.mark.parametrize("at", ["BEGIN IMMEDIATE", "COMMIT"])
@pytest.mark.parametrize("behind", [False, True])
def test_ctrl_c_within_a_commit_writes_each_row_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, at: str, behind: bool
) -> None:
    pressed = False

    class Interrupted(sqlite3.Connection):
        def execute(self, sql: str, /, *values: object) -> sqlite3.Cursor:  # type: ignore[override]
            nonlocal pressed
            now = pressed and sql == at
            pressed = pressed and not now
            if now and not behind:
                raise KeyboardInterrupt
            done = super().execute(sql, *values)  # type: ignore[arg-type]
            if now:
                raise KeyboardInterrupt
            return done

    create(tmp_path / "journal.sqlite", "mission")
    monkeypatch.setattr(store.sqlite3, "connect", Interrupted)
    told: list[str] = []
    with Journal(tmp_path / "journal.sqlite", "mission", tmp_path / "log", told.append) as journal:
        journal.append(Record(kind="sight", body="1"))
        journal.event("one")
        pressed = True
        with pytest.raises(KeyboardInterrupt):
            journal.commit()
        journal.append(Record(kind="sight", body="2"))
        journal.event("two")
        journal.commit()
    assert told == (tmp_path / "log").read_text().splitlines() == ["one", "two"]
    with closing(sqlite3.connect(tmp_path / "journal.sqlite")) as db:
        assert db.execute("SELECT n, body FROM tape ORDER BY n").fetchall() == [(1, "1"), (2, "2")]


def test_a_journal_under_a_second_name_is_refused(tmp_path: Path) -> None:
    field = cut_off(tmp_path / "m")
    other = tmp_path / "other"
    other.mkdir()
    (other / "journal.sqlite").hardlink_to(field.folder / "journal.sqlite")
    with pytest.raises(JournalError, match="second name"):
        opened(field.folder)
    (other / "journal.sqlite").unlink()
    (other / "journal.sqlite").symlink_to(field.folder / "journal.sqlite")
    with pytest.raises(JournalError, match="is a link"):
        opened(other)


def test_orders_that_lie_elsewhere_than_people_give_them_stop_the_mission(tmp_path: Path) -> None:
    order_file = CommandFile(tmp_path / "orders.sqlite")
    order_file.create()
    assert order_file.current() is None
    (tmp_path / "orders.sqlite").rename(tmp_path / "moved")
    for _ in range(2):
        order = order_file.current()
        assert order is not None
        assert (order.wanted, "cannot be read" in order.reason) == ("abort", True)
    with pytest.raises(JournalError, match="orders of the mission cannot be used"):
        order_file.give("pause", "lunch")
    assert not (tmp_path / "orders.sqlite").exists()
