"""Work over areas, along headlands and edges, and its words: what is covered, read back, reported and exported."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import shapely

from fieldhand.approval.checks import examine
from fieldhand.approval.readback import read_back
from fieldhand.evaluation.outcome import judge
from fieldhand.evaluation.report.content import compose
from fieldhand.exchange.btcpp import read_tree, write_tree
from fieldhand.forecast.estimate import estimate
from fieldhand.language import open_language
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import Excluding, InZone, Rows, Trees
from fieldhand.robot.capabilities import capabilities_of
from fieldhand.robot.model import RobotProfile
from fieldhand.site.loader import open_site
from fieldhand.site.model import Site
from fieldhand.task.frames import Task
from fieldhand.task.plan import InOrder, WorkAlong
from fieldhand.task.results import Ended, Event, Worked
from support.missions.rig import Rig, of_type, task_for
from support.missions.working import tractor

CORNER, POND = InZone(zone="wet corner"), InZone(zone="pond")
#: Kinds of work, each with the least metres driven for it.
KINDS: tuple[tuple[WorkAlong, float], ...] = (
    (WorkAlong(action="mow", mode="area", along=CORNER), 100.0),
    (WorkAlong(action="mow", mode="area", along=Excluding(places=CORNER)), 1_000.0),
    (WorkAlong(action="mow", mode="headlands", along=Trees()), 50.0),
    (WorkAlong(action="mow", mode="perimeter", along=POND), 20.0),
    (WorkAlong(action="", mode="perimeter", along=Trees(), laps=2), 300.0),
    (WorkAlong(action="mow", mode="aisles", along=Rows(first="3", last="5")), 100.0),
    (WorkAlong(action="spray", along=Rows(first="3", last="4"), sides="both"), 100.0),
)


@cache
def demo() -> Site:
    return open_site("demo")


def task_of(node: WorkAlong) -> Task:
    return task_for(InOrder(steps=(node,)))


def fly(task: Task, robot: RobotProfile) -> tuple[Event, ...]:
    return Rig(site=demo(), robot=robot).fly(task).events


@pytest.mark.parametrize(("node", "least_m"), KINDS, ids=lambda v: f"{v.action} {v.mode}" if hasattr(v, "mode") else "")
def test_the_mission_drives_and_works_what_is_forecast(node: WorkAlong, least_m: float) -> None:
    task, robot = task_of(node), tractor()
    forecast = estimate(task, demo(), robot)
    events = fly(task, robot)
    (end,) = of_type(events, Ended)
    assert end.status == "completed"
    assert end.travelled_m == pytest.approx(forecast.branches[0].metres.mean, rel=0.01)
    assert sum(e.leg_m for e in of_type(events, Worked)) >= least_m
    assert all(outcome.outcome == "success" for outcome in judge(task, events))


def swept(events: tuple[Event, ...], width_m: float) -> shapely.Geometry:
    projection = demo().projection
    strips = []
    for lat_lon in (part for event in of_type(events, Worked) for part in event.paths):
        degrees = np.asarray(lat_lon, dtype=np.float64)
        line = shapely.LineString(projection.metres(degrees[:, 0], degrees[:, 1]))
        strips.append(line.buffer(width_m / 2, cap_style="flat"))
    return shapely.union_all(strips)


def test_the_lanes_cover_the_area() -> None:
    robot = tractor()
    events = fly(task_of(KINDS[0][0]), robot)
    implement = robot.implements["mow"]
    zone = next(zone.polygon for zone in demo().zones if zone.name == "wet corner")
    mown = swept(events, implement.implement.width_m or 0.0)
    assert mown.intersection(zone).area / zone.area > 0.45  # the rest is rows of trunks with their clearance


def said(node: WorkAlong, tongue: str) -> str:
    task, robot = task_of(node), tractor()
    lines = read_back(task, demo(), robot, estimate(task, demo(), robot)).text_lines(usual=False)
    return "\n".join(open_language(tongue).say(line) for line in lines)


SPRAY = WorkAlong(action="spray", parameters=(("rate_l_ha", 300.0),), along=Rows(first="3", last="8"))


@pytest.mark.parametrize(
    ("node", "english", "spanish"),
    [
        (SPRAY, "Spray along rows 3 to 8, at 300 l/ha", "Pulverizar a lo largo de las hileras 3 a 8, a 300 l/ha"),
        (KINDS[0][0], "Mow over", "Segar sobre"),
        (KINDS[2][0], "Mow along the headlands of all rows", "Segar a lo largo de las cabeceras de todas las hileras"),
        (KINDS[3][0], "Mow around", "Segar alrededor de"),
        (KINDS[4][0], "Drive around the whole site, 2 times", "Conducir alrededor de todo el terreno, 2 veces"),
        (KINDS[6][0], "on both sides", "por ambos lados"),
    ],
)
def test_work_is_read_back_in_both_languages(node: WorkAlong, english: str, spanish: str) -> None:
    assert english in said(node, "en")
    assert spanish in said(node, "es")


def test_the_read_back_says_metres_area_and_amount() -> None:
    text = said(SPRAY, "en")
    assert "8 passes" in text  # a keep-out lies across two of the rows
    assert "m worked" in text
    assert "about" in text


def test_more_than_the_tank_holds_is_a_warning() -> None:
    node = WorkAlong(action="spray", parameters=(("rate_l_ha", 800.0),), along=Trees(), sides="both", laps=8)
    problems = examine(task_of(node), demo(), tractor()).problems
    assert any("the tank holds" in problem.what for problem in problems)


@pytest.mark.parametrize(
    ("along", "mode"), [(Rows(first="3", last="3"), "aisles"), (InZone(zone="meadow"), "area"), (POND, "area")]
)
def test_what_cannot_be_worked_is_an_error_of_the_approval(along: Selector, mode: str) -> None:
    node = WorkAlong(action="mow", mode=mode, along=along)  # type: ignore[arg-type]
    assert any(p.severity == "error" for p in examine(task_of(node), demo(), tractor()).problems)


def test_the_report_lists_what_was_worked() -> None:
    task, robot = task_of(SPRAY), tractor()
    events = fly(task, robot)
    report = compose(
        task=task, site=demo(), robot=robot, events=events, outcomes=judge(task, events), authorization=None,
        estimate=None,
    )  # fmt: skip
    assert report.worked
    assert "8 of 8" in str(report.worked)


@pytest.mark.parametrize("node", [node for node, _ in KINDS], ids=lambda v: f"{v.action} {v.mode}")
def test_an_exported_tree_imports_as_the_same_plan(node: WorkAlong) -> None:
    task, capabilities = task_of(node), capabilities_of(tractor())
    assert read_tree(write_tree(task, capabilities), capabilities).composition.plan == task.composition.plan
