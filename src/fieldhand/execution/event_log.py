"""Event logs: one JSON object per line (docs/formats.md, "Event log")."""

from __future__ import annotations

import contextlib
from pathlib import Path
from types import TracebackType
from typing import IO

from fieldhand.errors import InputError, OutputError, TaskError
from fieldhand.files import FileFault, open_output, read_file
from fieldhand.task.event_lines import from_json, to_json
from fieldhand.task.results import Event

#: Size limit in bytes; a mission of ten thousand captures takes 10 MB.
MAX_BYTES = 500_000_000


class EventLog:
    """Writes events as they happen; each line is flushed before anything else is done.

    Args:
        path: File to write; its folder is created.
        begun: Length in bytes of an existing beginning to keep; the rest is replaced.

    Raises:
        OutputError: The file cannot be written, now or later (a full disk).
    """

    def __init__(self, path: Path, *, begun: int = 0) -> None:
        self._path = path
        try:
            self._file: IO[str] = open_output(path, "a" if begun else "w")
            if begun:
                self._file.truncate(begun)
        except (OSError, ValueError) as error:
            raise self._unwritable(error) from None

    def __call__(self, event: Event) -> None:
        """Write one event."""
        self.line(to_json(event))

    def line(self, line: str) -> None:
        """Write the line of an event."""
        try:
            self._file.write(line + "\n")
            self._file.flush()
        except (OSError, ValueError) as error:
            raise self._unwritable(error) from None

    def close(self) -> None:
        """Close the file.

        Raises:
            OutputError: Buffered events cannot be written.
        """
        try:
            self._file.close()
        except (OSError, ValueError) as error:
            raise self._unwritable(error) from None

    def __enter__(self) -> EventLog:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _unwritable(self, error: Exception) -> OutputError:
        why = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        why = "its folder is a file" if isinstance(error, FileExistsError) else why
        return OutputError(
            f"the event log cannot be written: {why}",
            where=str(self._path),
            advice="give a file in a folder that you may write to",
        )


def read_events(path: Path, *, whole: bool = True) -> tuple[Event, ...]:
    """Return the events of a log in order, without those of types unknown to this version.

    Args:
        path: The file.
        whole: True to reject a truncated last line; False to skip it.

    Raises:
        InputError: The file cannot be read.
        TaskError: A line is not an event; the error names the line.
    """
    try:
        text = read_file(path, MAX_BYTES).decode()
    except (FileFault, UnicodeDecodeError) as fault:
        what = fault.what if isinstance(fault, FileFault) else "cannot be read: it is not UTF-8 text"
        raise InputError(f"the event log {what}", where=str(path), advice="give a log that --events wrote") from None
    lines = text.split("\n")
    # A complete line ends in a line break.
    last = [] if whole else [lines.pop()]
    events = [from_json(line, where=f"{path}, line {k}") for k, line in enumerate(lines, start=1) if line.strip()]
    for line in last:
        with contextlib.suppress(TaskError):
            events.append(from_json(line))
    return tuple(event for event in events if event is not None)
