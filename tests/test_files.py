from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fieldhand import files
from fieldhand.files import FileFault, config_folder, read_file, state_folder, write_stored, write_whole


@given(data=st.binary(max_size=40), most=st.integers(min_value=0, max_value=40), plain=st.booleans())
def test_a_file_is_read_whole_or_refused_for_its_size(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, most: int, plain: bool
) -> None:
    path = tmp_path_factory.getbasetemp() / "some.bin"
    path.write_bytes(data)
    if len(data) <= most:
        assert read_file(path, most, plain=plain) == data
        return
    with pytest.raises(FileFault, match=f"^is larger than {most} bytes$") as caught:
        read_file(path, most, plain=plain)
    assert caught.value.kind == "too large"
    assert most < caught.value.size <= len(data)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="there is no endless file here")
def test_a_file_without_end_is_refused() -> None:
    with pytest.raises(FileFault, match="is larger than 1,000 bytes"):
        read_file(Path("/dev/zero"), 1000)
    with pytest.raises(FileFault, match="is not a file") as caught:
        read_file(Path("/dev/zero"), 1000, plain=True)
    assert caught.value.kind == "no file"


@pytest.mark.parametrize(
    ("name", "plain", "kind", "what"),
    [
        ("none", True, "missing", "there is no such file"),
        ("none", False, "unreadable", "cannot be read: No such file"),
        ("", True, "no file", "is not a file"),
        ("", False, "unreadable", "cannot be read: Is a directory"),
        ("x" * 5000, False, "unreadable", "cannot be read: File name too long"),
        ("a\0b", False, "unreadable", "cannot be read: embedded null byte"),
    ],
)
def test_what_cannot_be_read_says_why(tmp_path: Path, name: str, plain: bool, kind: str, what: str) -> None:
    with pytest.raises(FileFault) as caught:
        read_file(tmp_path / name, 10, plain=plain)
    assert caught.value.kind == kind
    assert caught.value.what.startswith(what)


@pytest.mark.parametrize("step", ["fsync", "replace"])
def test_a_file_is_written_as_a_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, step: str) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "m.mission"
    write_whole(path, b"the first", mode=0o600)
    with monkeypatch.context() as patch:
        patch.setattr(files.os if step == "fsync" else Path, step, full)
        with pytest.raises(OSError, match="No space left"):
            write_whole(path, b"the second")
    assert path.read_bytes() == b"the first"
    assert list(tmp_path.iterdir()) == [path]
    if os.name == "posix":
        assert path.stat().st_mode & 0o777 == 0o600
    write_whole(path, b"the second")
    assert path.read_bytes() == b"the second"


def test_a_new_file_takes_the_place_of_none(tmp_path: Path) -> None:
    path = tmp_path / "key"
    write_stored(path, b"mine", new=True)
    with pytest.raises(FileExistsError):
        write_stored(path, b"another", new=True)
    assert path.read_bytes() == b"mine"


def test_a_users_folders_are_where_the_system_has_them() -> None:
    assert config_folder({"FIELDHAND_CONFIG": "/etc/f", "HOME": "/h"}) == Path("/etc/f")
    assert config_folder({"XDG_CONFIG_HOME": "/x", "HOME": "/h"}) == Path("/x/fieldhand")
    assert config_folder({"HOME": "/h"}) == Path("/h/.config/fieldhand")
    assert state_folder({"XDG_STATE_HOME": "/x", "HOME": "/h"}) == Path("/x/fieldhand")
    assert state_folder({"HOME": "/h"}) == Path("/h/.local/state/fieldhand")
    assert state_folder({}) == Path.home() / ".local/state/fieldhand"
