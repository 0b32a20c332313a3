"""Words for the earlier missions that a plan depends on."""

from __future__ import annotations

from fieldhand.compatibility import datetime_from_iso
from fieldhand.errors import PlaceError
from fieldhand.language import Number, counted, message
from fieldhand.language.words import capitalised
from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution
from fieldhand.places.wording import say_selector
from fieldhand.site.earlier_missions import EarlierMissions
from fieldhand.site.model import Site
from fieldhand.task.earlier import by_records
from fieldhand.task.frames import Task
from fieldhand.task.timing import Schedule


def say_earlier(task: Task, site: Site) -> tuple[str, ...]:
    """Return what a Task takes from earlier missions, as sentences; empty if it does not depend on any.

    Args:
        task: The Task, with the earlier missions that it depends on.
        site: Its site.
    """
    if task.earlier is None:
        return ()
    seen = site.with_earlier(task.earlier)
    counts = tuple(_say_count(task, seen))
    more = []
    if task.earlier.elsewhere:
        more.append(
            counted(
                "{count} mission that worked elsewhere does not count.",
                "{count} missions that worked elsewhere do not count.",
                task.earlier.elsewhere,
            )
        )
    if task.earlier.simulations:
        more.append(
            counted(
                "{count} simulated mission does not count (--count-simulated).",
                "{count} simulated missions do not count (--count-simulated).",
                task.earlier.simulations,
            )
        )
    if isinstance(task.timing, Schedule):
        more.append(message("Each run counts anew, with the missions that the robot itself did before it."))
    return (*counts, say_known(task.earlier), *more)


def say_known(records: EarlierMissions) -> str:
    """Return the number of earlier missions and when they were counted, as a sentence."""
    when = say_local(records.as_of)
    if not records.missions:
        return message("No earlier mission is on record on {time}.", time=when)
    return counted(
        "{count} mission is on record on {time}; it began on {begun}.",
        "{count} missions are on record on {time}; the last began on {begun}.",
        len(records.missions),
        time=when,
        begun=say_local(records.missions[-1].begun),
    )


def say_local(at: str) -> str:
    """Return a local time of the site: "2026-11-27 06:30"."""
    return Number(f"{datetime_from_iso(at):%Y-%m-%d %H:%M}")


def _say_count(task: Task, site: Site) -> list[str]:
    """Return a sentence for each selector: how many places it chooses, of how many."""
    found: list[str] = []
    for selector in by_records(task):
        if selector.relative:
            continue
        resolution = Resolution(site, Context(here=site.start))
        try:
            of = len(resolution.spots(selector.of))
            chosen = len(resolution.spots(selector))
        except PlaceError:
            continue
        text = message("{trees}: {count} of {total}.", trees=say_selector(selector), count=chosen, total=of)
        found.append(capitalised(text))
    return found
