"""What decides what a robot does lies where nobody else can change it; one process at a time works there."""

from __future__ import annotations

import os
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from fieldhand import missions
from fieldhand.approval.keys.signing import SigningKeys
from fieldhand.approval.keys.trust import TrustStore
from fieldhand.delivery.mission_store import MissionStore
from fieldhand.errors import FieldhandError, JournalError
from fieldhand.execution.journal import store
from fieldhand.folders import FolderLock, FolderTaken, Unguarded, is_locked, require_guarded
from support.missions.kept import inputs
from support.missions.signed import KEY, NOW

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="rights are lists there")
as_root = pytest.mark.skipif(sys.platform == "win32" or os.geteuid() != 0, reason="only root can give files away")


@pytest.fixture(autouse=True)
def _no_waiting(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(store, "SYNCHRONOUS", "OFF")


def give_away(path: Path) -> None:
    os.chown(path, 12345, -1, follow_symlinks=False)


WIDE = 0o777
HARMS: dict[str, Callable[[Path], Path]] = {}


def harm(change: Callable[[Path], Path]) -> Callable[[Path], Path]:
    """A way in which others can change ``under/the folder``; it returns what has to be mended."""
    HARMS[change.__name__] = change
    return change


@harm
def others_may_write_in_it(under: Path) -> Path:
    (under / "the folder").chmod(WIDE)
    return under / "the folder"


@harm
def others_may_write_in_it_though_it_is_sticky(under: Path) -> Path:
    (under / "the folder").chmod(0o1777)
    return under / "the folder"


@harm
def others_may_write_above_it(under: Path) -> Path:
    under.chmod(WIDE)
    return under


@harm
def a_link_leads_through_where_others_may_write(under: Path) -> Path:
    (under / "wide").mkdir()
    (under / "the folder").rename(under / "wide" / "really")
    (under / "wide").chmod(WIDE)
    (under / "the folder").symlink_to("../under/wide/really")
    return under / "wide"


@pytest.mark.parametrize("name", HARMS)
def test_a_folder_that_others_can_change_is_refused_with_the_command_that_mends_it(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "under" / "the folder"
    folder.mkdir(parents=True)
    require_guarded(folder)
    wrong = HARMS[name](tmp_path / "under")
    with pytest.raises(Unguarded, match="can be written by others") as fault:
        require_guarded(folder)
    assert fault.value.path == wrong
    subprocess.run(shlex.split(fault.value.advice), check=True)
    require_guarded(folder)


@as_root
def test_a_folder_or_link_of_another_user_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "one" / "two"
    folder.mkdir(parents=True)
    (tmp_path / "link").symlink_to(folder)
    for given, through in ((folder.parent, folder), (folder, folder), (tmp_path / "link", tmp_path / "link")):
        give_away(given)
        with pytest.raises(Unguarded, match="belongs to another user") as fault:
            require_guarded(through)
        subprocess.run([word for word in shlex.split(fault.value.advice) if word != "sudo"], check=True)
        require_guarded(through)


@as_root
def test_a_group_of_ones_own_may_write_and_a_shared_one_may_not(tmp_path: Path) -> None:
    tmp_path.chmod(0o770)
    require_guarded(tmp_path)
    os.chown(tmp_path, -1, 1)
    with pytest.raises(Unguarded, match="can be written by others"):
        require_guarded(tmp_path)


def test_a_folder_for_everybody_whose_files_are_each_ones_own_may_be_on_the_way(tmp_path: Path) -> None:
    """As ``/tmp`` is."""
    (tmp_path / "tmp" / "mine").mkdir(parents=True)
    (tmp_path / "tmp").chmod(0o1777)
    require_guarded(tmp_path / "tmp" / "mine")


def test_links_in_a_circle_are_an_error(tmp_path: Path) -> None:
    (tmp_path / "a").symlink_to("b")
    (tmp_path / "b").symlink_to("a")
    with pytest.raises(OSError, match="symbolic links"):
        require_guarded(tmp_path / "a")


def test_no_mission_begins_or_goes_on_where_others_can_write(tmp_path: Path) -> None:
    under = tmp_path / "missions"
    under.mkdir()
    under.chmod(WIDE)
    with pytest.raises(JournalError, match="can be written by others; chmod go-w"):
        missions.begin(under, "m1", inputs())
    under.chmod(0o755)
    folder = missions.begin(under, "m1", inputs()).folder
    for path in (under, folder, folder / "mission.json", folder / "task.xml", folder / "site" / "demo.geojson"):
        before = path.stat().st_mode
        path.chmod(WIDE)
        with pytest.raises(JournalError, match="can be written by others; chmod go-w"):
            missions.read_folder(folder)
        path.chmod(before)
    given = missions.open_mission(folder)
    (folder / "journal.sqlite").chmod(0o666)
    with pytest.raises(JournalError, match="can be written by others; chmod go-w"):
        missions.carry_out(given, speed=None, emit=lambda _: None)
    (folder / "journal.sqlite").chmod(0o644)
    assert missions.carry_out(given, speed=None, emit=lambda _: None).status == "completed"


def test_a_mission_is_not_open_to_others_whatever_the_user_gives_to_new_files(tmp_path: Path) -> None:
    before = os.umask(0)
    try:
        folder = missions.begin(tmp_path / "missions", "m1", inputs()).folder
        assert missions.carry_out(missions.open_mission(folder), speed=None, emit=lambda _: None).status == "completed"
    finally:
        os.umask(before)


def test_neither_a_store_nor_keys_lie_where_others_can_write(tmp_path: Path) -> None:
    def nothing(data: bytes, source: str) -> object:
        raise AssertionError

    trusted, keys = TrustStore(tmp_path / "config"), SigningKeys(tmp_path / "config")
    trusted.trust(KEY.public, name="Ada", at=NOW)
    keys.make("Ada")
    MissionStore(tmp_path / "store", accept=nothing, now=lambda: NOW).close()  # type: ignore[arg-type]
    for folder, use in (
        ("config", trusted.known),
        ("config/trusted", trusted.known),
        ("config/keys", keys.held),
        ("store", lambda: MissionStore(tmp_path / "store", accept=nothing, now=lambda: NOW)),  # type: ignore[arg-type]
    ):
        (tmp_path / folder).chmod(WIDE)
        with pytest.raises(FieldhandError, match="can be written by others; chmod go-w"):
            use()
        (tmp_path / folder).chmod(0o700)
        use()


def test_a_lock_is_the_folders_own(tmp_path: Path) -> None:
    """Nothing in the folder can be deleted to release it, and it goes where the folder goes."""
    folder = tmp_path / "one"
    folder.mkdir()
    assert not is_locked(folder)
    with FolderLock(folder):
        assert is_locked(folder)
        folder.rename(tmp_path / "two")
        assert not is_locked(folder)
        assert is_locked(tmp_path / "two")
        with pytest.raises(FolderTaken):
            FolderLock(tmp_path / "two")
    FolderLock(tmp_path / "two").close()


def test_a_lock_ends_with_its_process(tmp_path: Path) -> None:
    code = (
        f"import pathlib, fieldhand.folders as f; l = f.FolderLock(pathlib.Path({str(tmp_path)!r})); print(1); input()"
    )
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stdin=subprocess.PIPE) as process:
        assert process.stdout is not None
        process.stdout.readline()
        assert is_locked(tmp_path)
        process.kill()
        process.wait()
        assert not is_locked(tmp_path)
