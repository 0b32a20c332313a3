"""Transcripts: what is written can be read back, and what is no transcript is refused with its line."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest

from fieldhand.compatibility import UTC
from fieldhand.errors import InputError, OutputError
from fieldhand.planning.llm.chat import ChatMessage, Reply
from fieldhand.planning.llm.transcript import TranscriptWriter, read_transcript

NOON = datetime(2025, 6, 1, 12, tzinfo=UTC)


def write(path: Path, request: str = "Visit the trees.") -> None:
    writer = TranscriptWriter(path, now=lambda: NOON)
    writer.begin(request, planner="llm:m", note="by hand")
    writer.exchange(
        [ChatMessage(role="system", text="rules\nof two lines"), ChatMessage(role="user", text=request)],
        Reply(text="a"),
        ["p"],
    )
    writer.exchange([ChatMessage(role="user", text="mend it")], Reply(text="ü ≤ 2", finish="length"), [])
    writer.end("planned")


def test_what_is_written_can_be_read_back(tmp_path: Path) -> None:
    path = tmp_path / "new" / "t.jsonl"
    write(path)
    write(path, "Visit them again.")
    first, second = read_transcript(path)
    assert (first.request, second.request) == ("Visit the trees.", "Visit them again.")
    assert (first.outcome, first.about["note"], first.about["at"]) == ("planned", "by hand", NOON.isoformat())
    assert [(e.answer, e.finish, e.problems) for e in first.exchanges] == [
        ("a", "stop", ("p",)),
        ("ü ≤ 2", "length", ()),
    ]
    assert first.exchanges[0].messages[0] == ChatMessage(role="system", text="rules\nof two lines")


def test_no_file_is_written_where_none_is_named() -> None:
    TranscriptWriter(None).begin("anything")


def test_an_unwritable_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(OutputError) as caught:
        TranscriptWriter(tmp_path).begin("anything")
    assert caught.value.where == str(tmp_path)


@pytest.mark.parametrize(
    "line",
    [
        "not json",
        "[]",
        "{}",
        '{"kind": "exchange", "messages": [], "answer": "", "finish": "", "problems": []}',
        '{"kind": "session", "format": "another/1", "request": "x"}',
        '{"kind": "rumour"}',
    ],
)
def test_what_is_no_transcript_is_refused_with_its_line(tmp_path: Path, line: str) -> None:
    path = tmp_path / "t.jsonl"
    path.write_text("\n" + line + "\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_transcript(path)
    assert caught.value.where == f"{path}, line 2"


def test_a_missing_file_is_said(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        read_transcript(tmp_path / "nowhere.jsonl")


def test_a_key_that_an_endpoint_sends_back_is_not_kept(tmp_path: Path) -> None:
    path = tmp_path / "t.jsonl"
    writer = TranscriptWriter(path, now=lambda: NOON, redact=lambda line: line.replace("secret", "***"))
    writer.begin("Take a picture.", planner="llm:secret")
    assert "secret" not in path.read_text()
    assert path.stat().st_mode & 0o077 == 0
