"""The work of a finished or interrupted mission, from its event log, for plans that refer to it later."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np
import shapely

from fieldhand.compatibility import datetime_from_iso
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierOutcome, EarlierValue
from fieldhand.site.model import Site
from fieldhand.site.names import short
from fieldhand.task.results import Acted, Ended, Event, InDoubt, Started, Visiting, Worked

#: A tree counts as the same one up to this distance in metres, or this part of the spacing of the trees.
SAME_TREE_M, SAME_TREE_SPACINGS = 1.0, 0.4
#: A tree was worked on along a path at most this part of the distance between rows away.
WORKED_WITHIN_ROWS = 0.55
#: Distance between rows in metres where the site has none.
_NO_ROWS_M = 5.0
#: Longest name of a mission, place, action, quantity or unit that is taken from a log.
_LONGEST = 200


@dataclass(frozen=True, kw_only=True)
class LoggedWork:
    """The work that one mission did on a site.

    Attributes:
        mission: The mission with its captures.
        key: Task and time of the begin, by which two logs of one mission are recognized.
        moved: Number of captures whose tree the site no longer has at that position.
        elsewhere: True if it worked, and nowhere on the site.
    """

    mission: EarlierMission
    key: tuple[str, str]
    moved: int
    elsewhere: bool


def work_of(
    events: Sequence[Event],
    site: Site,
    *,
    name: str,
    local: Callable[[datetime], datetime],
    times: Sequence[datetime | None] = (),
    ended: datetime | None = None,
) -> LoggedWork | None:
    """Return the work of a mission at places of a site; None if its log has no begin or no date.

    A tree is the same if its id is, and its position up to :data:`SAME_TREE_M`, less where trees stand closer. Other
    places count by their position on the ground of the site. The name and the other contents of the site do not matter.

    Args:
        events: Events in the order of the log.
        site: The site.
        name: Name of the mission in its store; empty for the id of its Task.
        local: Returns an instant as a local time of the site.
        times: Time of each event by the clock of the robot, if its journal has it; by default the begin of the mission
            with the time of the event, which does not count the time without power.
        ended: Time of the last event, for a log that states no date.
    """
    started = next((event for event in events if isinstance(event, Started)), None)
    begun = None if started is None else _instant(started.at)
    if begun is None and times:
        begun = times[0]
    elif begun is None and ended is not None and events:
        begun = ended - timedelta(seconds=events[-1].t)
    if started is None or begun is None:
        return None
    places = _Places(site)
    captures: list[EarlierCapture] = []
    moved = 0
    for number, event in enumerate(events):
        at = (times[number] if number < len(times) else None) or begun + timedelta(seconds=event.t)
        when = local(at).isoformat(timespec="seconds")
        if isinstance(event, Acted | InDoubt):
            if isinstance(event, InDoubt) and event.then == "repeat":
                continue
            capture = places.capture(event, when)
            if capture is None:
                moved += 1
            else:
                captures.append(capture)
        elif isinstance(event, Worked) and event.action:
            captures += places.worked(event, when)
    whole = any(isinstance(event, Ended) for event in events)
    elsewhere = not captures and moved > 0 and started.site != site.name
    # A mission without an end may still reach the places that it has not reached; the log has only names for them.
    here = bool(captures) or (not moved and started.site == site.name)
    left_out = places.left_out(events, captures, local(begun).isoformat(timespec="seconds")) if whole and here else ()
    mission = EarlierMission(
        id=short(name or f"{started.task} of {begun:%Y-%m-%d %H:%M:%S}", _LONGEST),
        begun=local(begun).isoformat(timespec="seconds"),
        simulated=started.seed is not None,
        ended=whole,
        captures=(*_final(captures), *left_out),
    )
    return LoggedWork(
        mission=mission,
        key=(started.task, begun.isoformat(timespec="seconds")),
        moved=0 if elsewhere else moved,
        elsewhere=elsewhere,
    )


class _Places:
    """The places of a site by which logged ones are recognized.

    Args:
        site: The site.
    """

    def __init__(self, site: Site) -> None:
        self._site = site
        self._within = min(SAME_TREE_M, SAME_TREE_SPACINGS * site.spacing_m)
        xy = site.outline_xy
        low, high = xy.min(axis=0) - _NO_ROWS_M, xy.max(axis=0) + _NO_ROWS_M
        self._ground = (*low.tolist(), *high.tolist())

    def capture(self, event: Acted | InDoubt, when: str) -> EarlierCapture | None:
        """Return a capture at a place of the site; None if its place is not there, or not any more."""
        x, y = self._site.projection.metres([event.lat], [event.lon])[0].tolist()
        done = event.status == "success"
        values = tuple(
            EarlierValue(
                name=short(quantity, _LONGEST), value=value, unit=short(event.units.get(quantity, ""), _LONGEST)
            )
            for quantity, value in sorted(event.readings.items())
            if done and np.isfinite(value)
        )
        outcome: EarlierOutcome = "done" if done else "failed"
        action = short(event.action, _LONGEST)
        if event.kind == "tree":
            tree = self._site.by_id.get(event.place)
            if tree is None or float(np.hypot(tree.place.x - x, tree.place.y - y)) > self._within:
                return None
            return EarlierCapture(place=event.place, action=action, at=when, outcome=outcome, values=values)
        west, south, east, north = self._ground
        if not (west <= x <= east and south <= y <= north):
            return None
        kind = event.kind if event.kind in ("marker", "point", "gap") else "point"
        return EarlierCapture(
            place=short(event.place, _LONGEST),
            action=action,
            at=when,
            outcome=outcome,
            kind=kind,  # type: ignore[arg-type]
            lat=event.lat,
            lon=event.lon,
            values=values,
        )

    def worked(self, event: Worked, when: str) -> Iterator[EarlierCapture]:
        """Yield a capture for each tree beside the paths along which an implement was on."""
        site = self._site
        lines = [
            shapely.LineString(site.projection.metres(*zip(*path, strict=True)))
            for path in event.paths
            if len(path) > 1
        ]
        if not lines or not site.trees:
            return
        apart = min((s for block in site.planting.blocks if (s := block.row_spacing_m) > 0), default=_NO_ROWS_M)
        near = shapely.distance(shapely.points(site.xy), shapely.union_all(lines)) <= WORKED_WITHIN_ROWS * apart
        for index in np.flatnonzero(near).tolist():
            yield EarlierCapture(place=site.trees[index].place.id, action=short(event.action, _LONGEST), at=when)

    def left_out(
        self, events: Iterable[Event], captures: Iterable[EarlierCapture], when: str
    ) -> Iterator[EarlierCapture]:
        """Yield the trees that a mission planned to visit, and where it did nothing."""
        worked = {capture.place for capture in captures if capture.kind == "tree"}
        planned = (tree for event in events if isinstance(event, Visiting) for tree in event.places)
        for tree in dict.fromkeys(planned):
            if tree in self._site.by_id and tree not in worked:
                yield EarlierCapture(place=tree, at=when, outcome="left_out")


def _final(captures: Sequence[EarlierCapture]) -> Iterator[EarlierCapture]:
    """Yield the captures without failures that a later attempt of the same mission made up for."""
    last_done: dict[tuple[str, str, str], int] = {}
    last_failed: dict[tuple[str, str, str], int] = {}
    for number, capture in enumerate(captures):
        key = capture.kind, capture.place, capture.action
        (last_done if capture.outcome == "done" else last_failed)[key] = number
    for number, capture in enumerate(captures):
        key = capture.kind, capture.place, capture.action
        if capture.outcome == "done" or (last_failed[key] == number and last_done.get(key, -1) < number):
            yield capture


def _instant(text: str) -> datetime | None:
    """Return the time of a log; None if it states none."""
    try:
        found = datetime_from_iso(text)
    except ValueError:
        return None
    return found if found.tzinfo is not None else None
