"""The earlier missions that a Task depends on, as a part of the Task."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import cast

from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import TaskError
from fieldhand.language import message
from fieldhand.places.earlier.from_records import FromRecords
from fieldhand.places.selector import Selector
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import walk
from fieldhand.task.timing import Schedule

#: Largest number of captures that a Task contains.
MOST_CAPTURES = 10_000


def by_records(task: Task) -> tuple[FromRecords, ...]:
    """Return the selectors of a Task that depend on earlier missions, each once."""
    found = (part for selector in _selectors(task) for part in selector.walk() if part.uses_records)
    return tuple(cast(FromRecords, part) for part in dict.fromkeys(found))


def uses_records(task: Task) -> bool:
    """Return True if a Task depends on what earlier missions did on its site."""
    return any(part.uses_records for selector in _selectors(task) for part in selector.walk())


def with_earlier(task: Task, records: EarlierMissions | None) -> Task:
    """Return a Task with the earlier missions that it depends on, in place of those that it contains.

    Its id ends with a hash of them, so that a Task with other records is another Task.

    Args:
        task: The Task.
        records: Earlier missions on its site; None to remove them.

    Raises:
        TaskError: The Task depends on more captures than it can contain.
        PlaceError: A period is not a possible one.
    """
    plain = _plain_id(task)
    used = by_records(task)
    if records is None or not used:
        return replace(task, id=plain, earlier=None)
    needed = relevant(records, used)
    return replace(task, id=f"{plain}-{_digest(needed)}", earlier=needed)


def site_of(task: Task, site: Site) -> Site:
    """Return the site with the earlier missions that a Task contains; as it is, if the Task contains none."""
    return site if task.earlier is None else site.with_earlier(task.earlier)


def site_of_run(task: Task, site: Site) -> Site:
    """Return the site with the earlier missions by which a run chooses its places.

    Those of a Task were approved with it. Each run of a standing mission counts anew: then the site comes with them.
    """
    return site if isinstance(task.timing, Schedule) and site.earlier is not None else site_of(task, site)


def together(signed: EarlierMissions | None, own: EarlierMissions) -> EarlierMissions:
    """Return the missions that a robot did itself and those that a Task contains, each mission once.

    Args:
        signed: Missions in the Task; None for none.
        own: Missions that the robot did, counted now.
    """
    if signed is None:
        return own
    known = {datetime_from_iso(mission.begun) for mission in own.missions}
    others = [mission for mission in signed.missions if datetime_from_iso(mission.begun) not in known]
    missions = sorted((*others, *own.missions), key=lambda mission: (datetime_from_iso(mission.begun), mission.id))
    return replace(own, missions=tuple(missions))


def may_have_none(task: Task, selector: Selector) -> bool:
    """Return True if a selector may select nothing: a run of a standing mission may find that all was done before."""
    return isinstance(task.timing, Schedule) and any(part.uses_records for part in selector.walk())


def relevant(records: EarlierMissions, selectors: tuple[FromRecords, ...]) -> EarlierMissions:
    """Return only those captures that the places of some selectors depend on; missions are kept even without any.

    Raises:
        TaskError: They are too many.
        PlaceError: A period is not a possible one.
    """
    kept = {id(capture) for selector in selectors for _, capture in selector.used(records)}
    if len(kept) > MOST_CAPTURES:
        raise TaskError(
            message(
                "the plan depends on {count} captures of earlier missions, and a Task contains at most {most}",
                count=len(kept),
                most=MOST_CAPTURES,
            ),
            advice=message("choose a shorter period"),
        )
    missions = tuple(
        replace(mission, captures=tuple(capture for capture in mission.captures if id(capture) in kept))
        for mission in records.missions
    )
    return replace(records, missions=tuple(mission for mission in missions if mission.captures) or missions[-1:])


def _selectors(task: Task) -> Iterator[Selector]:
    for node in walk(task.composition.plan):
        if node.selector is not None:
            yield node.selector
    for rule in task.constraints.avoid:
        yield rule.places


def _plain_id(task: Task) -> str:
    """Return the id of a Task without the hash of its earlier missions."""
    return task.id if task.earlier is None else re.sub(rf"-{_digest(task.earlier)}$", "", task.id)


def _digest(records: EarlierMissions) -> str:
    return hashlib.sha256(repr(records).encode()).hexdigest()[:8]
