"""Server-Sent Events of live missions: one stream per page, resumable, with a heartbeat every second.

    mission     state of a mission, when it has changed
    event       event of a mission, as in its log, with its number and in words; its id is the position of the stream
    position    position of a robot under way, at most five times per second
    gone        a mission whose folder was removed or cannot be read
    heartbeat   every second

A stream holds no more than one answer in memory: it reads on when its reader has taken what was sent. Events are read
from the journals, so that a slow or interrupted reader misses none.
"""

from __future__ import annotations

import re
from collections.abc import AsyncIterator, Awaitable, Callable, Iterator
from dataclasses import asdict, dataclass, field
from datetime import datetime
from typing import Annotated, Any

import anyio
from anyio import CapacityLimiter, to_thread
from fastapi import APIRouter, Depends, Query, Request
from starlette.responses import StreamingResponse

from fieldhand.api.admission import is_ending
from fieldhand.api.callers import Scope, is_still_allowed, require
from fieldhand.api.event_records import event_record, summary_record
from fieldhand.api.inputs import Lang
from fieldhand.api.missions import no_mission
from fieldhand.api.problems import RefusedRequest
from fieldhand.compatibility import UTC
from fieldhand.errors import FieldhandError
from fieldhand.fleet import Fleet, FleetMission, SeenPosition
from fieldhand.hidden_characters import visible_json
from fieldhand.language import Language, message, open_language

#: Missions that one stream follows at most.
MOST_MISSIONS = 50
#: Seconds between two looks, between two heartbeats, and until a page connects again (milliseconds).
LOOK_S, HEARTBEAT_S, RETRY_MS = 0.2, 1.0, 1000
#: Seconds between two looks whether the caller may still read.
ALLOWED_EVERY_S = 10.0
#: Events of all missions in one answer, about 400 kB.
_MOST_EVENTS = 400
#: Threads that read for all streams.
_READERS = 8

_CURSOR = re.compile(r"(?P<id>[A-Za-z0-9][A-Za-z0-9_-]{0,99}):(?P<n>[0-9]{1,12})")


@dataclass
class _Followed:
    """A mission that a stream follows, and what was sent of it."""

    after: int = 0
    summary: FleetMission | None = None
    position: SeenPosition | None = None


@dataclass
class MissionStream:
    """The messages of one stream.

    Attributes:
        fleet: The missions.
        language: Language of the words.
        named: Names of the missions to follow; None for those under way, and each that begins later.
        after: Number of the last event that the reader has, by mission.
        behind: True if more events could be read at once.
    """

    fleet: Fleet
    language: Language
    named: tuple[str, ...] | None
    after: dict[str, int]
    behind: bool = False
    _followed: dict[str, _Followed] = field(default_factory=dict)
    _known: frozenset[str] | None = None

    def messages(self) -> Iterator[str]:
        """Return what has happened since the last call, of each mission at most its share of an answer."""
        self.behind, names = False, self._names()
        share = max(1, _MOST_EVENTS // max(1, len(names)))
        for name in names:
            if name in self._followed or len(self._followed) < MOST_MISSIONS:
                one = self._followed.setdefault(name, _Followed(after=self.after.get(name, 0)))
                yield from self._of(name, one, share)

    def _names(self) -> tuple[str, ...]:
        if self.named is not None:
            return self.named
        present = self.fleet.ids()
        if self._known is None:
            # A reader that comes back also gets the end of the missions that have ended meanwhile.
            under_way = self.fleet.under_way()
            self._known = frozenset(n for n in present if n not in under_way and n not in self.after)
        # An interrupted mission that is resumed is under way again.
        resumed = self._known & frozenset(self.fleet.under_way())
        self._known -= resumed
        return tuple(dict.fromkeys([*self._followed, *(n for n in present if n not in self._known)]))

    def _of(self, name: str, one: _Followed, most: int) -> Iterator[str]:
        try:
            feed = self.fleet.feed(name)
            if feed is None:
                raise FileNotFoundError
            lines = feed.lines_after(one.after, most)
            self.behind |= len(lines) == most
            for line in lines:
                one.after = line.n
                yield _message("event", event_record(feed, line, self.language), at=self._cursor())
            summary = feed.summary()
            # The state follows the events that lead to it.
            if summary is not one.summary and summary.now.events <= one.after:
                one.summary = summary
                yield _message("mission", summary_record(feed, self.language, summary))
            position = feed.position()
            if position is not None and position != one.position:
                one.position = position
                yield _message("position", {"mission": name, **asdict(position)})
        except (FieldhandError, OSError) as error:
            why = self.language.say(error.what) if isinstance(error, FieldhandError) else ""
            self._followed.pop(name, None)
            if self.named is not None:
                self.named = tuple(n for n in self.named if n != name)
            self._known = (self._known or frozenset()) | {name}
            yield _message("gone", {"mission": name, "why": why})

    def _cursor(self) -> str:
        """Return the position of the stream, from which a reader continues."""
        reached = {**self.after, **{name: one.after for name, one in self._followed.items()}}
        return ",".join(f"{name}:{n}" for name, n in reached.items())


def router(fleet: Fleet) -> APIRouter:
    """``GET /stream``."""
    routes = APIRouter(tags=["missions"])
    readers = CapacityLimiter(_READERS)

    @routes.get("/stream", dependencies=[Depends(require(Scope.READ))])
    async def stream(
        request: Request,
        missions: Annotated[str | None, Query(max_length=10_000)] = None,
        after: Annotated[str, Query(max_length=10_000)] = "",
        lang: Lang = "en",
    ) -> StreamingResponse:
        """Follow missions: their events, states and positions as Server-Sent Events."""
        named = None if missions is None else tuple(dict.fromkeys(filter(None, missions.split(","))))
        if named is not None:
            if len(named) > MOST_MISSIONS:
                raise RefusedRequest(
                    422,
                    message("a stream follows at most {count} missions", count=MOST_MISSIONS),
                    message("name fewer"),
                    "missions",
                )
            for name in named:
                if await to_thread.run_sync(fleet.folder, name, limiter=readers) is None:
                    raise no_mission(name)
        reached = cursor_of(request.headers.get("last-event-id") or after)
        source = MissionStream(fleet, open_language(lang), named, reached)
        # Between proxies and browsers, nothing may keep or collect the messages.
        headers = {"Cache-Control": "no-store", "X-Accel-Buffering": "no"}
        return StreamingResponse(
            _sent(source, readers, _over(request)), media_type="text/event-stream", headers=headers
        )

    return routes


def cursor_of(text: str) -> dict[str, int]:
    """Return the number of the last event that a reader has, by mission, from the id of a message.

    Raises:
        RefusedRequest: It is not the id of a message (status 422).
    """
    found: dict[str, int] = {}
    for part in filter(None, text.split(",")):
        match = _CURSOR.fullmatch(part.strip())
        if match is None or len(found) >= 10 * MOST_MISSIONS:
            raise RefusedRequest(
                422, message("this is not the id of a message of a stream"), message("leave it out"), "after"
            )
        found[match["id"]] = int(match["n"])
    return found


def _over(request: Request) -> Callable[[], Awaitable[bool]]:
    """Return a function that returns True once the server ends, or the caller may not read any longer."""
    asked = anyio.current_time()

    async def over() -> bool:
        nonlocal asked
        if anyio.current_time() >= asked + ALLOWED_EVERY_S:
            asked = anyio.current_time()
            if not await is_still_allowed(request, Scope.READ):
                return True
        return is_ending(request.scope)

    return over


async def _sent(
    source: MissionStream, readers: CapacityLimiter, over: Callable[[], Awaitable[bool]]
) -> AsyncIterator[str]:
    """Yield the messages of a stream until it is over; the next ones are read when these were taken."""
    yield f"retry: {RETRY_MS}\n\n"
    beat = -HEARTBEAT_S
    while not await over():
        begun = anyio.current_time()
        if begun >= beat + HEARTBEAT_S:
            beat = begun
            yield _message("heartbeat", {"at": datetime.now(UTC).isoformat(timespec="milliseconds")})
        text = await to_thread.run_sync(_joined(source.messages), limiter=readers)
        if text:
            yield text
        await anyio.sleep(0.0 if source.behind else max(0.0, begun + LOOK_S - anyio.current_time()))


def _joined(messages: Callable[[], Iterator[str]]) -> Callable[[], str]:
    return lambda: "".join(messages())


def _message(kind: str, record: dict[str, Any], at: str = "") -> str:
    """Return one message; its JSON has no line end."""
    lines = [f"event: {kind}", *([f"id: {at}"] if at else []), f"data: {visible_json(record, separators=(',', ':'))}"]
    return "\n".join(lines) + "\n\n"
