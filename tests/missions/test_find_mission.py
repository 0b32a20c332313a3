"""Which mission is meant, and folders that cannot be read."""

from __future__ import annotations

from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.errors import JournalError, WorldError
from fieldhand.execution.drivers.simulation.world_file import load_world


def test_a_folder_that_is_none_is_named(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    with pytest.raises(JournalError, match="file: cannot be read"):
        missions.find(file, None)


def test_where_nothing_was_begun_no_mission_is_found(tmp_path: Path) -> None:
    assert missions.all_missions(tmp_path / "none") == ()
    with pytest.raises(JournalError, match="no mission has been started"):
        missions.find(tmp_path, None)
    with pytest.raises(JournalError, match="no mission 'x'"):
        missions.find(tmp_path, "x")


def test_a_world_that_never_ends_is_not_read_to_its_end() -> None:
    with pytest.raises(WorldError, match="is larger than"):
        load_world(Path("/dev/zero"))
