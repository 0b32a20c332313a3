"""Missions at samples of a vineyard and of a meadow are driven, and judged from their logs."""

from __future__ import annotations

import pytest

from fieldhand import mission
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Grid, InBlock, Missing, PointsIn, Quota, Transect
from fieldhand.site.loader import open_site
from fieldhand.task.build import make_task
from fieldhand.task.codec import decode, encode
from fieldhand.task.frames import Task
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Arrived
from support.missions.flights import fly_request, fly_task
from support.missions.rig import of_type

SITE = open_site("vineyard")
SAMPLES = [
    (Missing(of=InBlock(block="South")), 11, "gap"),
    (Quota(per="variety", count=2), 6, "tree"),
    (Transect(count=5, of=InBlock(block="North")), 5, "tree"),
    (Transect(count=4, zone="meadow"), 4, "point"),
    (Grid(every_m=30.0, zone="meadow"), 4, "point"),
    (PointsIn(zone="meadow", count=3, random=True), 3, "point"),
]


def task_at(selector: Selector) -> Task:
    plan = ForEach(id="", select=selector, body=Act(id="", action="take_picture"))
    return make_task(request="a test", plan=plan, measures={})


@pytest.mark.parametrize(("selector", "count", "kind"), SAMPLES, ids=lambda v: type(v).__name__)
def test_each_place_of_a_sample_is_visited_once_and_its_log_is_judged_complete(
    selector: Selector, count: int, kind: str
) -> None:
    task = task_at(selector)
    assert decode(encode(task)) == task
    flown = fly_task(task, SITE, "amiga")
    assert len({e.place for e in of_type(flown.events, Arrived) if e.kind == kind}) == count
    assert [e.kind for e in of_type(flown.events, Acted)] == [kind] * count
    assert flown.end.status == "completed"
    assert flown.assessment.success


def test_a_capture_at_a_gap_that_is_lost_from_the_log_is_missed() -> None:
    task = task_at(Missing(of=InBlock(block="South")))
    flown = fly_task(task, SITE, "amiga")
    lost = next(e for e in flown.events if isinstance(e, Acted))
    assert not mission.assess(task, [e for e in flown.events if e is not lost]).goals_met


def test_a_request_for_gaps_is_driven_from_the_aisles_beside_them() -> None:
    flown = fly_request("take pictures of the missing vines in the south block", site="vineyard", robot="amiga")
    assert flown.end.status == "completed"
    assert len(of_type(flown.events, Acted)) == 11
