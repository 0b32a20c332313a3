"""Machine code compiled from other sources is removed; code that fits stays."""

from __future__ import annotations

from pathlib import Path

from fieldhand.orienteering.kernels.compiled import remove_stale


def test_what_was_compiled_from_other_sources_is_removed(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text("a = 1\n")
    cache = tmp_path / "__pycache__"
    cache.mkdir()
    kept = [cache / "kernel.f-1.py311.nbi", cache / "kernel.f-1.py311.1.nbc"]
    for file in kept:
        file.write_bytes(b"code")
    remove_stale(tmp_path)
    assert not any(file.exists() for file in kept)
    for file in kept:
        file.write_bytes(b"code")
    remove_stale(tmp_path)
    assert all(file.exists() for file in kept)
    (tmp_path / "kernel.py").write_text("a = 2\n")
    remove_stale(tmp_path)
    assert not any(file.exists() for file in kept)


def test_a_folder_without_machine_code_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "kernel.py").write_text("a = 1\n")
    remove_stale(tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["kernel.py"]
