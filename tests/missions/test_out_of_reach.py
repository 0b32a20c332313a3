"""What cannot be reached is passed over where anything else will do, and told where it matters."""

from __future__ import annotations

from dataclasses import replace

from shapely.geometry import Point, box

from fieldhand.approval.checks import check
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.places.selectors import Take, Trees
from fieldhand.planning.english.planner import EnglishPlanner
from fieldhand.planning.planner import Planned
from fieldhand.site.model import Site, Zone
from fieldhand.task.frames import Budget, Constraints
from fieldhand.task.plan import Act, ForEach
from fieldhand.task.results import Acted, Shed
from fieldhand.testing.small_orchard import husky, orchard, task_for
from support.missions.flights import fly_task

PICTURE = Act(id="", action="take_thermal_picture")


def with_pond_over(*trees: str) -> Site:
    """The orchard with a small pond over some of its trees."""
    site = orchard(rows=5, columns=6)
    ponds = [Zone(name=f"pond {t}", kind="keep_out", polygon=Point(*site.by_id[t].place.xy).buffer(0.8)) for t in trees]
    return replace(site, zones=tuple(ponds))


def test_optional_visits_pass_over_trees_in_a_pond_and_say_so() -> None:
    site = with_pond_over("8", "15")
    constraints = Constraints(budgets=(Budget(kind="distance_m", limit=2000.0),))
    task = task_for(site, ForEach(id="", select=Trees(), body=PICTURE, optional=True), constraints=constraints)
    found = check(task, site, husky())
    assert [p.severity for p in found] == ["warning"]
    assert "tree 8 and 1 more will be left out" in found[0].what
    events = fly_task(task, site).events
    assert {e.place for e in events if isinstance(e, Acted)} == {str(k) for k in range(1, 31)} - {"8", "15"}
    (shed,) = (e for e in events if isinstance(e, Shed))
    assert set(shed.places) == {"8", "15"}
    assert "pond 8" in shed.reason


def test_any_few_trees_are_not_those_in_a_pond() -> None:
    site = with_pond_over("1", "2")
    near = resolve(Take(count=3, of=Trees()), site, Context(here=site.start))
    assert not {"1", "2"} & {p.id for p in near}


def test_a_mission_that_returns_to_the_start_does_not_need_an_end_that_nobody_can_reach() -> None:
    site = orchard(rows=4, columns=5)
    end = Point(*site.markers["end"].xy)
    wall = Zone(name="wall", kind="keep_out", polygon=end.buffer(3.0).difference(end.buffer(1.5)))
    walled = replace(site, zones=(wall,))
    outcome = EnglishPlanner().plan("Take a picture of tree 12 and return to the start.", walled, husky())
    assert isinstance(outcome, Planned)
    assert check(outcome.task, walled, husky()) == ()
    flight = fly_task(outcome.task, walled)
    assert flight.end.status == "completed"


def test_an_exit_that_cannot_be_reached_is_told_before_approval_and_strands_no_work() -> None:
    site = orchard(rows=4, columns=5)
    end = Point(*site.markers["end"].xy)
    wall = Zone(name="wall", kind="keep_out", polygon=box(*end.buffer(3.0).bounds).difference(end.buffer(1.5)))
    walled = replace(site, zones=(wall,))
    task = task_for(walled, ForEach(id="", select=Trees(), body=PICTURE), nominal="stay")
    assert any("the end marker" in p.what and p.severity == "warning" for p in check(task, walled, husky()))
    assert len([e for e in fly_task(task, walled).events if isinstance(e, Acted)]) == 20
