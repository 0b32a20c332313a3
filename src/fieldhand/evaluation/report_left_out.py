"""What was not done and why, folded: one line for all places that were left out for the same cause."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fieldhand.clock import clock_time
from fieldhand.evaluation.report_facts import end_of, out_of_reach, plan_done
from fieldhand.evaluation.report_places import PlaceNames
from fieldhand.task.frames import Task
from fieldhand.task.plan import ForEach, walk
from fieldhand.task.results import Acted, Arrived, Event, MissionStatus, Shed, Visiting
from fieldhand.task.words import say_count

#: So many single decisions of the guard stand in the report; the event log has all.
_MOST_DETAILS = 60


@dataclass(frozen=True, kw_only=True)
class LeftOut:
    """Places that were left out for one cause.

    Attributes:
        mandatory: Whether it had to be done.
        said: In one sentence.
        details: Each decision of the guard as it was recorded.
    """

    mandatory: bool
    said: str
    details: tuple[str, ...]


def left_out(task: Task, events: Sequence[Event], names: PlaceNames) -> tuple[LeftOut, ...]:
    """The work that was not done: what the end of the mission kept from being reached, then what was given up."""
    groups: dict[tuple[bool, bool], list[Shed]] = {}
    for event in events:
        if isinstance(event, Shed):
            groups.setdefault((event.optional, out_of_reach(event)), []).append(event)
    found = [
        _folded(group, optional=optional, cut_off=cut_off, names=names)
        for (optional, cut_off), group in sorted(groups.items())
    ]
    missed = not_reached(task, events)
    return (_unreached(missed, events, names), *found) if missed else tuple(found)


def not_reached(task: Task, events: Sequence[Event]) -> tuple[str, ...]:
    """Places that the loop in hand had before it when the mission ended before its plan was done."""
    ended = end_of(events)
    begun = max((k for k, e in enumerate(events) if isinstance(e, Visiting)), default=None)
    if begun is None or (ended is not None and plan_done(events)):
        return ()
    loop = events[begun]
    node = next((n for n in walk(task.composition.plan) if n.id == loop.node), None)
    if not isinstance(loop, Visiting) or not isinstance(node, ForEach) or node.at_most is not None or node.until:
        return ()
    gone = {e.place for e in events[begun:] if isinstance(e, Arrived | Acted)}
    gone |= {p for e in events[begun:] if isinstance(e, Shed) for p in e.places}
    return tuple(place for place in loop.places if place not in gone)


def _unreached(missed: Sequence[str], events: Sequence[Event], names: PlaceNames) -> LeftOut:
    ended = end_of(events)
    how = "the log ends before the mission does" if ended is None else f"the mission {_ENDS[ended.status]} before"
    said = f"{say_count(len(missed), 'place')} not reached because {how}: {names.many(missed)}."
    return LeftOut(mandatory=True, said=said, details=())


_ENDS: dict[MissionStatus, str] = {
    "completed": "was over",
    "returned": "turned home",
    "exceeded": "turned home",
    "faulted": "ended with a fault",
    "aborted": "was stopped",
}


def _folded(group: Sequence[Shed], *, optional: bool, cut_off: bool, names: PlaceNames) -> LeftOut:
    places = list(dict.fromkeys(place for event in group for place in event.places))
    what = say_count(len(places), "place") if places else say_count(len(group), "step")
    done = "left out" if optional else "given up, though to be done,"
    where = f": {names.many(places)}" if places else ""
    them = "it" if len(places) == 1 else "them"
    why = f"no way led to {them}" if cut_off else f"the budget would hardly have lasted{_chances(group)}"
    details = [f"{clock_time(event.t)}  {' '.join(event.reason.split())}" for event in group[:_MOST_DETAILS]]
    if len(group) > _MOST_DETAILS:
        details.append(f"and {len(group) - _MOST_DETAILS} more in the event log")
    return LeftOut(mandatory=not optional, said=f"{what} {done} because {why}{where}.", details=tuple(details))


def _chances(group: Sequence[Shed]) -> str:
    """ " (84 to 93 % chance of running short)"; nothing where the log does not say."""
    found = sorted(round(100 * event.chance_short) for event in group if event.chance_short > 0.0)
    if not found:
        return ""
    spread = f"{found[0]}" if found[0] == found[-1] else f"{found[0]} to {found[-1]}"
    return f" ({spread} % chance of running short)"
