"""A fault of the program is shown whole, and what its traceback quotes cannot steer the terminal."""

from __future__ import annotations

import sys

import pytest

from fieldhand.cli import app, main


def test_a_traceback_hides_nothing(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def fail(*_: object, **__: object) -> None:
        raise ValueError("\x9b2J\nfieldhand: all is well\u202e")

    monkeypatch.setattr(app, "assemble", fail)
    monkeypatch.setattr(sys, "argv", ["fieldhand", "site", "demo"])
    with pytest.raises(SystemExit) as ended:
        main()
    said = capsys.readouterr().err
    assert ended.value.code == 1
    assert said.startswith("Traceback")
    assert "ValueError: \\u{009b}2J" in said
    assert "\n  fieldhand: all is well\\u{202e}" in said
    assert not [line for line in said.splitlines()[1:] if not line.startswith("  ")]
