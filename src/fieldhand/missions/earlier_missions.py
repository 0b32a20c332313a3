"""Summarize what the missions in a store did on a site, for plans that refer to earlier missions."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, tzinfo
from pathlib import Path

from fieldhand.compatibility import UTC, datetime_from_iso
from fieldhand.errors import FieldhandError, InputError
from fieldhand.evaluation.earlier_work import LoggedWork, work_of
from fieldhand.language import message
from fieldhand.missions.find_mission import all_missions, missions_folder
from fieldhand.missions.folder import JOURNAL, read_about
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.event_lines import from_json
from fieldhand.task.results import Acted, Ended, Event, InDoubt, Started, Visiting, Worked
from fieldhand.timetable.day_times import local_zone

#: Largest number of missions that are read, the latest ones; largest log file in bytes; largest number of captures.
MOST_MISSIONS, MOST_LOG_BYTES, MOST_CAPTURES = 1_000, 100_000_000, 500_000
#: Largest journal in bytes, which contains every input of its mission, too.
MOST_JOURNAL_BYTES = 2_000_000_000

_LOGS = (".jsonl", ".mcap")
#: Beginnings of the log lines that are parsed.
_LINES = tuple(f'{{"event": "{kind.event}"' for kind in (Started, Visiting, Acted, InDoubt, Worked, Ended))


@dataclass(frozen=True, kw_only=True)
class _Log:
    """One log.

    Attributes:
        name: Name of its mission.
        events: Its events.
        times: Time of each event, if the robot's journal has it.
        ended: Time of the last event, for a log without a date: those of simulations have none.
    """

    name: str
    events: Sequence[Event]
    times: Sequence[datetime | None] = ()
    ended: datetime | None = None


def earlier_missions(
    site: Site,
    folder: Path | str | None = None,
    *,
    logs: Iterable[Path | Sequence[Event]] = (),
    now: datetime | None = None,
    zone: tzinfo | None = None,
    simulated: bool = False,
    notice: Callable[[str], None] = lambda _: None,
) -> EarlierMissions:
    """Return what the missions in a folder did on a site.

    A mission counts with what it did, even if it was interrupted or failed; of one without an end, places that it has
    not reached are not ``left_out``. Logs that cannot be read or were changed are left out. The log of a simulation
    without a date counts as ended when its file was written, or else ``now``.

    Args:
        site: The site.
        folder: Folder of all missions, which may also contain event logs as files; by default that of the command line
            (``FIELDHAND_MISSIONS``, else one in the user's state folder), or none if ``logs`` are given.
        logs: Further missions: paths of event logs (JSON lines, MCAP), or the events of runs.
        now: Time from which periods such as "yesterday" are counted, with time zone; the present by default.
        zone: Time zone of the site; that of the system by default.
        simulated: Count simulated missions, too; by default only what a robot did counts.
        notice: Called with a message for each log that is left out because it cannot be read.

    Raises:
        JournalError: The folder may not be read.
        InputError: ``now`` has no time zone.
    """
    local = zone or local_zone(os.environ)
    moment = now or datetime.now(UTC)
    if moment.tzinfo is None:
        raise InputError(
            message("the time has no time zone"), where="now", advice=message("give datetime.now(timezone.utc)")
        )
    more = tuple(logs)
    under = Path(folder) if folder is not None else None if more else missions_folder(os.environ)
    damaged: list[str] = []

    def left_out(name: str, error: Exception) -> None:
        damaged.append(name)
        notice(message("{log} is left out of the earlier missions: {why}", log=name, why=str(error)))

    read = [*_in_folder(under, left_out), *_given(more, left_out)]
    found: dict[tuple[str, str], LoggedWork] = {}
    for log in read:
        try:
            work = work_of(
                log.events,
                site,
                name=log.name,
                local=lambda at: at.astimezone(local),
                times=log.times,
                ended=log.ended or moment,
            )
        except (ValueError, OverflowError, TypeError) as error:
            left_out(log.name, error)
            continue
        if work is not None:
            found.setdefault(work.key, work)
    every = sorted(found.values(), key=lambda work: (datetime_from_iso(work.mission.begun), work.mission.id))
    here = [work for work in every if work.mission.captures or work.moved]
    counting = [work for work in here if simulated or not work.mission.simulated]
    return EarlierMissions(
        as_of=moment.astimezone(local).isoformat(timespec="seconds"),
        missions=tuple(work.mission for work in _latest(counting)),
        moved=sum(work.moved for work in counting),
        damaged=len(damaged),
        simulations=len(here) - len(counting),
        elsewhere=sum(work.elsewhere for work in every),
    )


def _latest(works: Sequence[LoggedWork]) -> Sequence[LoggedWork]:
    """Return the latest missions whose captures do not exceed the limit."""
    total, first = 0, len(works)
    for number in range(len(works) - 1, -1, -1):
        total += len(works[number].mission.captures)
        if total > MOST_CAPTURES:
            break
        first = number
    return works[first:]


def _in_folder(under: Path | None, left_out: Callable[[str, Exception], None]) -> Iterator[_Log]:
    """Yield the logs of the latest missions in a folder, then those of files in it."""
    if under is None:
        return
    for folder in all_missions(under)[-MOST_MISSIONS:]:
        try:
            yield _journal(folder)
        except (FieldhandError, OSError, ValueError) as error:
            left_out(folder.name, error)
    yield from _given(_files(under), left_out)


def _files(under: Path) -> tuple[Path, ...]:
    """Return the event logs that are files in a folder, or in a folder there that is no mission."""
    try:
        inside = sorted(under.iterdir())
        beside = [path / "events.jsonl" for path in inside if path.is_dir() and not (path / "mission.json").exists()]
        found = [path for path in (*inside, *beside) if path.suffix in _LOGS and path.is_file()]
        return tuple(sorted(found, key=lambda path: (path.stat().st_mtime_ns, str(path))))[-MOST_MISSIONS:]
    except OSError:
        return ()


def _journal(folder: Path) -> _Log:
    """Return the log of a mission from its journal, with the time of each event by the robot's clock.

    Raises:
        JournalError, TaskError: The journal cannot be read.
        InputError: It is too large, or of another mission.
        ValueError: A time in it is none.
    """
    from fieldhand.execution.journal.store import mission_of, read_summary

    if (folder / JOURNAL).stat().st_size > MOST_JOURNAL_BYTES:
        raise InputError(message("is larger than {most} bytes", most=MOST_JOURNAL_BYTES))
    whole = read_about(folder)[1]
    if mission_of(folder / JOURNAL) != hashlib.sha256(whole).hexdigest():
        raise InputError(message("its mission.json and its journal are not of the same mission"))
    lines = [(at, line) for at, line in read_summary(folder / JOURNAL)[1] if line.startswith(_LINES)]
    events = [(at, event) for at, line in lines if (event := from_json(line, where=folder.name)) is not None]
    return _Log(
        name=folder.name,
        events=tuple(event for _, event in events),
        times=tuple(datetime_from_iso(at) for at, _ in events),
    )


def _given(logs: Iterable[Path | Sequence[Event]], left_out: Callable[[str, Exception], None]) -> Iterator[_Log]:
    from fieldhand.exchange.mcap import is_mcap, read_mcap
    from fieldhand.execution.event_log import read_events

    for log in logs:
        if not isinstance(log, str | Path):
            yield _Log(name="", events=log)
            continue
        path = Path(log)
        try:
            if path.stat().st_size > MOST_LOG_BYTES:
                raise InputError(message("is larger than {most} bytes", most=MOST_LOG_BYTES), where=str(path))
            yield _Log(
                name="",
                events=read_mcap(path) if is_mcap(path) else read_events(path, whole=False),
                ended=datetime.fromtimestamp(path.stat().st_mtime, UTC),
            )
        except (FieldhandError, OSError, ValueError) as error:
            left_out(str(path), error)
