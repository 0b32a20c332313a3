"""List stored missions, and remove old ones that have ended."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime, timedelta
from pathlib import Path

from fieldhand.compatibility import UTC, datetime_from_iso
from fieldhand.errors import FieldhandError, JournalError
from fieldhand.folders import is_locked
from fieldhand.missions.find_mission import all_missions, begun_at
from fieldhand.missions.folder import JOURNAL, read_about, read_kept, remove_folder
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Continued, Ended, Exited, Paused

#: Beginnings of the log lines that decide the state of a mission; other lines are not parsed.
_TURNS = tuple(f'{{"event": "{kind.event}"' for kind in (Paused, Continued, Exited, Ended))


@dataclass(frozen=True, kw_only=True)
class ListedMission:
    """One mission of a list.

    Attributes:
        folder: Folder of the mission.
        begun: Time at which it was begun.
        last: Time of its last event.
        state: ``running``, ``paused``, ``interrupted``, ``ended``; ``unreadable`` if its folder is damaged.
        status: Final status; for an unreadable mission, the reason.
        request: Request that it was planned from.
        signed: True if it came from a signed mission file.
    """

    folder: Path
    begun: datetime
    last: datetime
    state: str
    status: str
    request: str
    signed: bool

    @property
    def id(self) -> str:
        """Name of the mission."""
        return self.folder.name


def list_missions(under: Path) -> tuple[ListedMission, ...]:
    """Return all missions below a folder, in the order in which they were begun."""
    return tuple(_entry(folder) for folder in all_missions(under))


def removable(
    entries: tuple[ListedMission, ...], *, ended_before: datetime | None = None, keep: int | None = None
) -> tuple[ListedMission, ...]:
    """Return missions to remove: only ended ones, never one that is running, paused, interrupted or unreadable.

    Args:
        entries: Missions from :func:`list_missions`.
        ended_before: Latest time of the last event; None for any time.
        keep: Number of ended missions to keep, the newest ones; None to keep none.
    """
    ended = tuple(entry for entry in entries if entry.state == "ended")
    if keep is not None:
        ended = ended[: max(0, len(ended) - keep)]
    return tuple(entry for entry in ended if ended_before is None or entry.last < ended_before)


def older_than(now: datetime, days: float) -> datetime:
    """Return the time a number of days before ``now``, or the earliest possible time."""
    try:
        return now - timedelta(days=days)
    except OverflowError:
        return datetime.min.replace(tzinfo=UTC)


def remove(entry: ListedMission) -> None:
    """Remove the folder of a mission that has ended.

    Raises:
        JournalError: The mission has not ended, or is being resumed; or its folder cannot be removed.
    """
    if _entry(entry.folder).state != "ended":
        raise JournalError("the mission has not ended", where=str(entry.folder))
    remove_folder(entry.folder)


def _entry(folder: Path) -> ListedMission:
    from fieldhand.evaluation.progress import state_of
    from fieldhand.execution.journal.store import read_summary
    from fieldhand.task.codec import decode

    begun = begun_at(folder)
    try:
        files = read_about(folder)[0]["files"]
        running = is_locked(folder)
        lines = read_summary(folder / JOURNAL)[1]
        events = [from_json(line) for _, line in lines if line.startswith(_TURNS)]
        task = decode(read_kept(folder, "task.xml", files["task.xml"]))
        last = datetime_from_iso(lines[-1][0]) if lines else begun
    except (FieldhandError, KeyError, TypeError, ValueError) as error:
        why = (
            str(error) if isinstance(error, FieldhandError) else f"its mission.json or journal cannot be read: {error}"
        )
        return ListedMission(
            folder=folder, begun=begun, last=begun, state="unreadable", status=why, request="", signed=False
        )
    state, end = state_of([event for event in events if event is not None], running=running)
    return ListedMission(
        folder=folder,
        begun=begun,
        last=last,
        # The end is logged, but the process is still writing the report.
        state="running" if running and state == "ended" else state,
        status="" if end is None else end.status,
        request=task.command.request,
        signed="signed.mission" in files,
    )
