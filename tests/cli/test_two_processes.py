"""Two processes and one mission: one drives, whatever is deleted; and one whose folder goes away stops in order."""

from __future__ import annotations

import json
import shutil
import signal
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.errors import JournalError
from fieldhand.task.results import Acted, Ended
from support.processes.command import Started, fieldhand, started


def start(under: Path, folder: Path) -> tuple[Started, Path]:
    """A mission of six captures, driven in another process, and its folder once the first is made."""
    words = ["run", "Take a thermal picture of tree 1, tree 2, tree 3, tree 4, tree 5 and tree 6.", "--site", "demo"]
    process = started(*words, "--yes", "--confirm", "--speed", "20", "--missions", str(under), folder=folder)
    for line in process.out:
        if "thermal picture" in line and "°C" in line:
            return process, missions.find(under, None)
    pytest.fail("no capture was told")


def captures(folder: Path) -> list[str]:
    return [event.place for event in missions.events_of(folder) if isinstance(event, Acted)]


def test_a_second_process_never_drives_beside_the_first(tmp_path: Path) -> None:
    under = tmp_path / "missions"
    process, folder = start(under, tmp_path)
    try:
        (folder / "lock").touch()
        (folder / "lock").unlink()
        assert missions.is_running(folder)
        with pytest.raises(JournalError, match="another process is running this mission"):
            missions.carry_out(missions.open_mission(folder), speed=None, emit=lambda _: None)
        # The same files in another folder of the same name: there is no lock on that, and the journal is the same.
        old = folder.rename(under / "old")
        folder.mkdir()
        for path in old.iterdir():
            path.rename(folder / path.name)
        result = missions.carry_out(missions.open_mission(folder), speed=None, emit=lambda _: None)
    except BaseException:
        process.send_signal(signal.SIGKILL)
        raise
    finally:
        run = process.end()
    assert run.status == 2, run
    assert "Traceback" not in run.err
    assert result.status == "completed"
    assert sorted(captures(folder)) == ["1", "2", "3", "4", "5", "6"]
    assert len((folder / "events.jsonl").read_text().splitlines()) == len(result.events)


@pytest.mark.parametrize("harm", ["renamed", "deleted"])
def test_a_mission_whose_folder_goes_away_stops_and_says_so(tmp_path: Path, harm: str) -> None:
    process, folder = start(tmp_path / "missions", tmp_path)
    try:
        if harm == "renamed":
            folder.rename(tmp_path / "elsewhere")
        else:
            while folder.exists():  # SQLite removes files of its own meanwhile
                shutil.rmtree(folder, ignore_errors=True)
    except BaseException:
        process.send_signal(signal.SIGKILL)
        raise
    finally:
        run = process.end()
    assert run.status == 2, run
    assert "Traceback" not in run.err
    assert "is no longer in its place" in run.err or "cannot be written" in run.err
    if harm == "deleted":
        return
    (tmp_path / "elsewhere").rename(folder)
    done = fieldhand("resume", str(folder), "--json")
    assert done.status == 0, done.err
    assert json.loads(done.out)["status"] == "completed"
    assert sorted(captures(folder)) == ["1", "2", "3", "4", "5", "6"]
    assert isinstance(missions.events_of(folder)[-1], Ended)
