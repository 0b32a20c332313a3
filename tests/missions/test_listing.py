"""Missions are listed as they stand; of old ones only those go that have ended."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from datetime import datetime, timedelta
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from typer.testing import CliRunner

from fieldhand import missions
from fieldhand.cli.app import assemble
from fieldhand.compatibility import UTC
from fieldhand.errors import JournalError
from fieldhand.execution.journal import store
from fieldhand.folders import FolderLock
from fieldhand.missions.listing import ListedMission, list_missions, older_than, removable, remove
from fieldhand.task.results import Event
from support.missions.kept import inputs
from support.processes.command import Run

NOW = datetime(2026, 5, 1, 12, tzinfo=UTC)


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


class _PowerCut(Exception):
    pass


def begin(under: Path, name: str) -> Path:
    return missions.begin(under, name, inputs()).folder


def ended(under: Path, name: str) -> Path:
    folder = begin(under, name)
    missions.carry_out(missions.open_mission(folder), speed=None, emit=list[Event]().append)
    return folder


def cut_off(under: Path, name: str) -> Path:
    folder = begin(under, name)

    def cut(event: Event) -> None:
        raise _PowerCut

    with suppress(_PowerCut):
        missions.carry_out(missions.open_mission(folder), speed=None, emit=cut)
    return folder


def fieldhand(*words: str) -> Run:
    done = CliRunner().invoke(assemble(), ("missions", *words))
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return Run(status=done.exit_code, out=done.output, err="")


def test_every_mission_is_listed_as_it_stands_and_only_ended_ones_go(tmp_path: Path) -> None:
    under = tmp_path / "m"
    assert "no missions" in fieldhand("--missions", str(under)).out
    for k, make in enumerate((ended, cut_off, ended, ended, begin)):
        folder = make(under, f"m{k}")
        os.utime(folder / "mission.json", (k, k))
    (under / "m3" / "journal.sqlite").write_bytes(b"no journal")
    states = ["ended", "interrupted", "ended", "unreadable", "interrupted"]
    assert [entry.state for entry in list_missions(under)] == states
    shown = fieldhand("--missions", str(under)).out.splitlines()
    assert [line.split()[0] for line in shown] == ["m0", "m1", "m2", "m3", "m4"]
    assert "completed" in shown[0]
    assert "Measure CO2 at tree 5." in shown[0]
    with FolderLock(under / "m0"):
        assert [entry.state for entry in list_missions(under)][:2] == ["running", "interrupted"], "it writes its report"
        assert json.loads(fieldhand("--missions", str(under), "--keep", "0", "--json").out)["removed"] == ["m2"]
    record = json.loads(fieldhand("--missions", str(under), "--keep", "0", "--json").out)
    assert record["removed"] == ["m0"]
    assert [(m["id"], m["state"]) for m in record["missions"]] == [
        ("m1", "interrupted"), ("m3", "unreadable"), ("m4", "interrupted"),
    ]  # fmt: skip
    assert sorted(folder.name for folder in under.iterdir()) == ["m1", "m3", "m4"]
    assert missions.carry_out(missions.open_mission(under / "m1"), speed=None, emit=print).status == "completed"


def test_a_mission_that_goes_on_meanwhile_stays(tmp_path: Path) -> None:
    entry = list_missions(ended(tmp_path, "m0").parent)[0]
    with FolderLock(entry.folder), pytest.raises(JournalError, match="has not ended"):
        remove(entry)
    assert missions.status(entry.folder).now.state == "ended"


entries = st.lists(
    st.tuples(st.sampled_from(["running", "paused", "interrupted", "ended", "unreadable"]), st.integers(-5, 400))
).map(
    lambda drawn: tuple(
        ListedMission(
            folder=Path(f"m{k}"), begun=NOW, last=NOW - timedelta(days=days), state=state, status="", request="",
            signed=False,
        )
        for k, (state, days) in enumerate(drawn)
    )
)  # fmt: skip


@given(entries, st.none() | st.floats(0, 1e12), st.none() | st.integers(0, 6))
def test_what_may_go_has_ended_is_old_and_is_not_among_the_last(
    entries: tuple[ListedMission, ...], days: float | None, keep: int | None
) -> None:
    before = None if days is None else older_than(NOW, days)
    gone = removable(entries, ended_before=before, keep=keep)
    have_ended = [entry for entry in entries if entry.state == "ended"]
    assert set(gone) <= set(have_ended)
    if keep is not None:
        assert not set(gone) & set(have_ended[len(have_ended) - min(keep, len(have_ended)) :])
    if days is not None:
        assert all((NOW - entry.last) / timedelta(days=1) > days for entry in gone)
    stays = [e for e in have_ended if e not in gone]
    too_young = [e for e in stays if before is not None and e.last >= before]
    assert len(stays) - len(too_young) <= (keep or 0)
