"""Check what a Task takes from earlier missions: that they are given, and that its choices are what is meant."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.approval.problem import PlanProblem
from fieldhand.errors import NoPlaceError, PlaceError
from fieldhand.language import counted, message
from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution
from fieldhand.site.model import Site
from fieldhand.task.earlier import by_records, uses_records
from fieldhand.task.frames import Task


def records_problems(task: Task) -> Iterator[PlanProblem]:
    """Yield an error if a Task depends on earlier missions and contains none, and doubts about those it contains."""
    if not uses_records(task):
        return
    records = task.earlier
    if records is None:
        yield PlanProblem(
            where=message("earlier missions"),
            what=message("the plan depends on earlier missions, and the Task contains no record of them"),
            advice=message("give their folder with --missions, or in Python earlier=fh.earlier_missions(site)"),
        )
        return
    simulated = sum(mission.simulated for mission in records.missions)
    if simulated:
        yield _doubt(
            counted(
                "{count} of the earlier missions was only simulated",
                "{count} of the earlier missions were only simulated",
                simulated,
            ),
            message("leave out --count-simulated to count only what a robot did"),
        )
    open_ones = sum(not mission.ended for mission in records.missions)
    if open_ones:
        yield _doubt(
            counted(
                "{count} of the earlier missions has not ended, and counts with what it did so far",
                "{count} of the earlier missions have not ended, and count with what they did so far",
                open_ones,
            ),
            message("wait until it ends, or resume it with fieldhand resume, and count again with --recount"),
        )
    if records.damaged:
        yield _doubt(
            counted(
                "{count} log of earlier missions cannot be read and does not count",
                "{count} logs of earlier missions cannot be read and do not count",
                records.damaged,
            ),
            message("see which with fieldhand missions"),
        )
    if records.moved:
        yield _doubt(
            counted(
                "{count} earlier capture does not count, as the site has no tree of that name at that position",
                "{count} earlier captures do not count, as the site has no trees of those names at those positions",
                records.moved,
            ),
            message("go on if these trees were replanted or renamed"),
        )


def choice_problems(task: Task, site: Site) -> Iterator[PlanProblem]:
    """Yield a warning for each choice by earlier missions that found less than was asked for.

    Args:
        task: The Task.
        site: Its site, with the earlier missions.
    """
    for selector in by_records(task):
        if selector.relative:
            continue
        resolution = Resolution(site, Context(here=site.start))
        try:
            found = len(resolution.spots(selector))
        except NoPlaceError:
            found = 0
        except PlaceError:
            continue  # the places of its node are checked, too
        what = selector.doubt(found, site)
        if what:
            yield _doubt(what, message("choose another period if that is wrong"))


def none_now(error: NoPlaceError, node: str) -> PlanProblem:
    """Return the warning that a run of a standing mission, if it began now, would visit no place at a node."""
    return PlanProblem(
        node=node,
        where=message("earlier missions"),
        what=message("a run that began now would visit no place: {why}", why=error.what),
        advice=message("go on if it is meant for later runs, which choose anew"),
        severity="warning",
    )


def _doubt(what: str, advice: str) -> PlanProblem:
    return PlanProblem(where=message("earlier missions"), what=what, advice=advice, severity="warning")
