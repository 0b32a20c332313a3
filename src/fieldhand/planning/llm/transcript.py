"""Transcripts of the conversation between planner and model, as JSON lines.

One session covers one request. Its first line records the request and the model; each further line is one exchange
with its new messages, the answer, and the problems of the answer; the last line is the outcome. No object that
contains a key is written, so keys never reach a transcript.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from fieldhand.compatibility import UTC
from fieldhand.errors import InputError, OutputError
from fieldhand.hidden_characters import json_text
from fieldhand.planning.llm.chat import ChatMessage, Reply

FORMAT = "fieldhand-transcript/1"


def wall_clock() -> datetime:
    """Return the current time with its time zone."""
    return datetime.now(UTC)


class TranscriptWriter:
    """Appends sessions to a file line by line, so that everything before a failure is preserved.

    Args:
        path: Transcript file; None for no transcript.
        now: Returns the current time.
        redact: Removes secrets from a line, since an endpoint may repeat the key in its answer.
    """

    def __init__(
        self, path: Path | None, now: Callable[[], datetime] = wall_clock, redact: Callable[[str], str] = str
    ) -> None:
        self._path = path
        self._now = now
        self._redact = redact

    def begin(self, request: str, **about: Any) -> None:
        """Start a session with the request verbatim and the planner, site and robot."""
        self._write({"kind": "session", "format": FORMAT, "at": self._time(), "request": request, **about})

    def exchange(self, new: Sequence[ChatMessage], reply: Reply, problems: Sequence[str]) -> None:
        """Append one exchange: the new messages, the answer, and its problems."""
        self._write(
            {
                "kind": "exchange",
                "at": self._time(),
                "messages": [{"role": m.role, "text": m.text} for m in new],
                "answer": reply.text,
                "finish": reply.finish,
                "tokens": list(reply.tokens),
                "problems": list(problems),
            }
        )

    def end(self, outcome: str, detail: str = "") -> None:
        """Close a session with its outcome: planned, clarify, refused or failed."""
        self._write({"kind": "end", "at": self._time(), "outcome": outcome, "detail": detail})

    def _time(self) -> str:
        return self._now().isoformat(timespec="seconds")

    def _write(self, line: dict[str, Any]) -> None:
        if self._path is None:
            return
        try:
            self._path.parent.mkdir(parents=True, exist_ok=True)
            self._path.touch(mode=0o600)
            with self._path.open("a", encoding="utf-8", errors="backslashreplace") as file:
                file.write(self._redact(json_text(line)) + "\n")
        except OSError as error:
            raise OutputError(
                f"the transcript cannot be written ({error.strerror})",
                where=str(self._path),
                advice="name another file",
            ) from error


@dataclass(frozen=True, kw_only=True)
class Exchange:
    """One exchange of a transcript."""

    messages: tuple[ChatMessage, ...]
    answer: str
    finish: str
    problems: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Session:
    """One request of a transcript, with its exchanges.

    Attributes:
        about: Other fields of the first line (planner, site, robot, origin).
        outcome: ``planned``, ``clarify``, ``refused`` or ``failed``; empty if the session is incomplete.
    """

    request: str
    about: dict[str, Any] = field(default_factory=dict)
    exchanges: tuple[Exchange, ...] = ()
    outcome: str = ""


def read_transcript(path: Path) -> tuple[Session, ...]:
    """Read the sessions of a transcript.

    Raises:
        InputError: The file cannot be read, or a line is not of this format.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"the transcript cannot be read ({error})", where=str(path)) from error
    sessions: list[Session] = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            _take(json.loads(line), sessions)
        except (ValueError, KeyError, TypeError, IndexError) as error:
            raise InputError(
                f"this is not a transcript line ({type(error).__name__}: {error})",
                where=f"{path}, line {number}",
                advice=f"record it again; the format is {FORMAT}",
            ) from error
    return tuple(sessions)


def _take(line: dict[str, Any], sessions: list[Session]) -> None:
    match line["kind"]:
        case "session":
            if line["format"] != FORMAT:
                raise ValueError(f"format {line['format']!r}")
            known = ("kind", "format", "request")
            sessions.append(Session(request=line["request"], about={k: v for k, v in line.items() if k not in known}))
        case "exchange":
            exchange = Exchange(
                messages=tuple(ChatMessage(role=m["role"], text=m["text"]) for m in line["messages"]),
                answer=line["answer"],
                finish=line["finish"],
                problems=tuple(line["problems"]),
            )
            last = sessions[-1]
            sessions[-1] = Session(
                request=last.request,
                about=last.about,
                exchanges=(*last.exchanges, exchange),
                outcome=last.outcome,
            )
        case "end":
            last = sessions[-1]
            sessions[-1] = Session(
                request=last.request, about=last.about, exchanges=last.exchanges, outcome=line["outcome"]
            )
        case kind:
            raise ValueError(f"kind {kind!r}")
