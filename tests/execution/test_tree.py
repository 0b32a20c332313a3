"""What each plan node does, seen in the events of a whole small mission."""

from __future__ import annotations

import math

import pytest
from py_trees.common import Status

from fieldhand.execution.drivers.simulation.world import ActionFails, DriveFails, SensorSilent, TreeRef, Truth, World
from fieldhand.execution.tree import compile_tree
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import (
    Bound,
    Excluding,
    Farthest,
    Half,
    Here,
    Marker,
    Nearest,
    NotVisited,
    Take,
    TreeIs,
    UnionOf,
)
from fieldhand.task.conditions import Compare, TreeHas
from fieldhand.task.plan import Act, AnyOrder, ForEach, GoTo, If, InOrder, Node, Repeat, StopMission, Try, walk
from fieldhand.task.results import Acted, Arrived, Decided, Driving, Faulted, Visiting
from support.missions.rig import BudgetOf, Rig, captured, husky, of_type, orchard, task_for

PICTURE, CO2, AIR = "take_thermal_picture", "read_co2", "read_ambient_temperature"
HOT = Compare(reading="r", quantity="canopy_temperature", test="gt", value=33, unit="degC")


def tree(name: str) -> TreeIs:
    return TreeIs(tree=name)


def act(action: str = PICTURE, at: Selector | None = None, **more: object) -> Act:
    return Act(id="", action=action, at=at, **more)


def seq(*steps: Node) -> InOrder:
    return InOrder(id="", steps=steps)


def each(*names: str, body: Node | None = None, **more: object) -> ForEach:
    return ForEach(id="", select=UnionOf(parts=tuple(tree(n) for n in names)), body=body or act(), **more)


def world(default: float, **trees: float) -> World:
    values = tuple((TreeRef(id=name), value) for name, value in trees.items())
    return World(readings={"canopy_temperature": Truth(default=default, trees=values)})


def places(plan: Node, rig: Rig | None = None) -> list[str]:
    """The trees of the successful captures; the mission must complete."""
    result = (rig or Rig()).fly(plan)
    assert result.status == "completed", result.reason
    return [place for _, place in captured(result.events)]


def test_every_node_is_a_behavior_named_by_its_id() -> None:
    plan = seq(
        AnyOrder(id="", steps=(act(at=tree("r0c0")), GoTo(id="", place=tree("r1c1")))),
        each("r0c0", "r0c1"),
        Repeat(id="", times=2, body=If(id="", condition=HOT, then=act(), otherwise=StopMission(id=""))),
        Try(id="", body=act(CO2), otherwise=act(AIR)),
    )
    task, rig = task_for(plan), Rig()
    root = compile_tree(rig.attempt(task))
    names = [behavior.name for behavior in root.iterate()]
    for node in walk(task.composition.plan):
        assert any(name.startswith(f"{node.id} ") for name in names)
    assert "n3 take a thermal picture at tree r0c0" in names
    assert root.status == Status.INVALID


def test_a_sequence_goes_in_order() -> None:
    assert places(seq(act(at=tree("r3c4")), act(at=tree("r0c0")), act(at=tree("r2c2")))) == ["r3c4", "r0c0", "r2c2"]


def test_an_empty_sequence_is_done_at_once() -> None:
    result = Rig().fly(InOrder(id="", steps=()))
    assert result.status == "completed"
    assert of_type(result.events, Acted) == []


def test_any_order_drives_least() -> None:
    """Given in the worst order along a row, done one after another."""
    steps = tuple(act(at=tree(f"r0c{c}")) for c in (4, 0, 3, 1, 2))
    assert places(AnyOrder(id="", steps=steps)) == ["r0c0", "r0c1", "r0c2", "r0c3", "r0c4"]


def test_any_order_is_computed_where_it_is_reached() -> None:
    steps = tuple(act(at=tree(f"r0c{c}")) for c in (0, 4, 2))
    plan = seq(GoTo(id="", place=Marker(name="end")), AnyOrder(id="", steps=steps), GoTo(id="", place=tree("r3c0")))
    assert places(plan) == ["r0c4", "r0c2", "r0c0"]


def test_any_order_goes_on_where_a_step_has_no_place() -> None:
    """The step that cannot be placed says so when it is reached; a try around it catches that."""
    lost = Try(id="", body=act(at=tree("oak")), otherwise=act(CO2))
    result = Rig().fly(AnyOrder(id="", steps=(act(at=tree("r0c1")), lost)))
    assert result.status == "completed"
    assert captured(result.events) == [(PICTURE, "r0c1"), (CO2, "r0c1")]


def test_act_without_a_place_is_done_at_the_place_in_hand() -> None:
    result = Rig().fly(seq(act(at=tree("r1c1")), act(CO2)))
    assert captured(result.events) == [(PICTURE, "r1c1"), (CO2, "r1c1")]
    assert len(of_type(result.events, Driving)) == 2  # there, and home


def test_an_action_carries_the_place_of_its_tree() -> None:
    result = Rig().fly(act(at=tree("r1c1")))
    place = orchard().by_id["r1c1"].place
    (acted,) = of_type(result.events, Acted)
    assert (acted.lat, acted.lon, acted.kind, acted.units) == (
        place.lat,
        place.lon,
        "tree",
        {"canopy_temperature": "degC"},
    )


def test_count_makes_that_many_captures_at_one_stop() -> None:
    result = Rig().fly(act(at=tree("r1c1"), count=3))
    assert captured(result.events) == [(PICTURE, "r1c1")] * 3
    assert [e.count for e in of_type(result.events, Acted)] == [1, 1, 1]


def test_a_robot_that_is_there_already_does_not_drive() -> None:
    result = Rig().fly(seq(act(at=tree("r1c1")), act(at=tree("r1c1")), GoTo(id="", place=tree("r1c1"))))
    assert [e.place for e in of_type(result.events, Arrived)] == ["r1c1", "end"]


def test_labels_bind_places() -> None:
    plan = seq(
        GoTo(id="", place=tree("r0c0"), label="a"),
        act(at=Farthest(origin=Bound(label="a")), label="b"),
        act(at=Bound(label="a")),
        act(at=Bound(label="b")),
    )
    assert places(plan) == ["r3c4", "r0c0", "r3c4"]


def test_relative_places_resolve_where_they_are_reached() -> None:
    plan = seq(act(at=tree("r1c1")), act(at=Take(count=1, of=NotVisited())), act(at=Nearest(to=Here(), fresh=True)))
    done = places(plan)
    assert done[0] == "r1c1"
    assert len(set(done)) == 3
    spot = {t.place.id: t.place.xy for t in orchard().trees}
    assert math.dist(spot[done[0]], spot[done[1]]) == pytest.approx(5.0)
    assert math.dist(spot[done[1]], spot[done[2]]) == pytest.approx(5.0)


def test_for_each_resolves_once_and_binds_each_place() -> None:
    """The selector depends on what was visited; the loop keeps the places that it had when it was reached."""
    body = seq(act(at=Bound(label="t")), act(CO2, at=Nearest(to=Bound(label="t"))))
    plan = ForEach(id="", select=Excluding(places=Half(side="north"), of=NotVisited()), label="t", body=body)
    result = Rig().fly(plan)
    (visiting,) = of_type(result.events, Visiting)
    assert [p for a, p in captured(result.events) if a == PICTURE] == list(visiting.places)
    assert sorted(visiting.places) == sorted(t.place.id for t in orchard().trees if t.place.y < 7.5)


def test_for_each_in_the_order_given() -> None:
    assert places(each("r0c3", "r0c1", "r0c2", order="given")) == ["r0c3", "r0c1", "r0c2"]


def test_for_each_in_the_best_order_ends_towards_home_when_it_ends_the_plan() -> None:
    """Home is at the east end; without a plan after it, the loop ends there."""
    assert places(each("r0c3", "r0c1", "r0c2")) == ["r0c1", "r0c2", "r0c3"]


def test_after_a_for_each_its_label_means_every_place_visited() -> None:
    plan = seq(
        each("r0c0", "r0c1", "r0c2", label="t", at_most=2),
        act(CO2, at=Farthest(origin=tree("r0c0"), of=Bound(label="t"))),
    )
    assert captured(Rig().fly(plan).events)[-1] == (CO2, "r0c1")


def test_for_each_at_most() -> None:
    assert len(places(each("r0c0", "r0c1", "r0c2", at_most=2))) == 2
    assert len(places(each("r0c0", "r0c1", "r0c2", at_most=2, optional=True))) == 2
    assert len(places(each("r0c0", "r0c1", at_most=5))) == 2


def test_for_each_until() -> None:
    plan = each("r0c0", "r0c1", "r0c2", "r0c3", body=act(reading="r"), until=HOT)
    result = Rig(world=world(30, r0c2=40)).fly(plan)
    assert [p for _, p in captured(result.events)] == ["r0c0", "r0c1", "r0c2"]
    assert [e.holds for e in of_type(result.events, Decided)] == [False, False, True]


def test_repeat() -> None:
    assert len(places(Repeat(id="", times=3, body=act(at=tree("r0c0"))))) == 3
    assert places(Repeat(id="", times=3, body=act(at=Take(count=1, of=NotVisited())))) == ["r0c0", "r0c1", "r0c2"]


def test_repeat_until() -> None:
    plan = Repeat(id="", times=9, body=act(at=Take(count=1, of=NotVisited()), reading="r"), until=HOT)
    assert places(plan, Rig(world=world(30, r0c1=40))) == ["r0c0", "r0c1"]
    assert len(places(plan, Rig(world=world(30)))) == 9


@pytest.mark.parametrize(("temperature", "action"), [(40.0, CO2), (30.0, AIR)])
def test_if_follows_the_reading(temperature: float, action: str) -> None:
    plan = seq(act(at=tree("r0c0"), reading="r"), If(id="", condition=HOT, then=act(CO2), otherwise=act(AIR)))
    result = Rig(world=world(temperature)).fly(plan)
    assert [a for a, _ in captured(result.events)] == [PICTURE, action]
    (decided,) = of_type(result.events, Decided)
    assert decided.holds == (action == CO2)


def test_if_without_otherwise_goes_on() -> None:
    plan = seq(act(at=tree("r0c0"), reading="r"), If(id="", condition=HOT, then=act(CO2)), act(AIR))
    assert [a for a, _ in captured(Rig(world=world(30)).fly(plan).events)] == [PICTURE, AIR]


def test_if_is_tested_anew_in_every_round() -> None:
    body = seq(act(reading="r"), If(id="", condition=HOT, then=act(CO2), otherwise=act(AIR)))
    result = Rig(world=world(30, r0c1=40)).fly(each("r0c0", "r0c1", "r0c2", body=body))
    assert [a for a, _ in captured(result.events)] == [PICTURE, AIR, PICTURE, CO2, PICTURE, AIR]


def test_if_on_what_the_site_says() -> None:
    kerman = TreeHas(attribute="variety", test="eq", value="Kerman")
    assert places(each("r0c0", "r0c1", "r0c2", "r0c3", body=If(id="", condition=kerman, then=act()))) == [
        "r0c1",
        "r0c3",
    ]


def test_a_reading_of_an_earlier_round_decides_nothing() -> None:
    """The sensor is silent at the second tree: the hot reading of the first must not make the robot read CO2 there."""
    body = seq(
        Try(id="", body=act(reading="r"), otherwise=act(AIR)), If(id="", condition=HOT, then=act(CO2), otherwise=None)
    )
    silent = SensorSilent(quantity="canopy_temperature", at=TreeRef(id="r0c1"))
    rig = Rig(world=World(readings={"canopy_temperature": Truth(default=40.0)}, faults=(silent,)))
    result = rig.fly(each("r0c0", "r0c1", body=body))
    assert captured(result.events) == [(PICTURE, "r0c0"), (CO2, "r0c0"), (AIR, "r0c1")]
    assert of_type(result.events, Decided)[-1].why == "there is no reading of canopy temperature"


def test_the_last_of_several_captures_is_the_reading() -> None:
    result = Rig().fly(seq(act(at=tree("r0c0"), count=2, reading="r"), If(id="", condition=HOT, then=act(CO2))))
    last = of_type(result.events, Acted)[1].readings["canopy_temperature"]
    (decided,) = of_type(result.events, Decided)
    assert decided.why.startswith(f"canopy temperature {last:.4g}")


def test_try_goes_on_with_the_otherwise() -> None:
    plan = seq(act(at=tree("r0c0")), Try(id="", body=act(CO2), otherwise=act(AIR)), act())
    result = Rig(world=World(faults=(ActionFails(action=CO2),))).fly(plan)
    assert result.status == "completed"
    assert [a for a, _ in captured(result.events)] == [PICTURE, AIR, PICTURE]
    (fault,) = of_type(result.events, Faulted)
    assert (fault.fault, fault.handled) == ("action_failed", True)


def test_try_leaves_a_body_that_went_well_alone() -> None:
    plan = seq(GoTo(id="", place=tree("r0c0")), Try(id="", body=act(CO2), otherwise=act(AIR)))
    assert captured(Rig().fly(plan).events) == [(CO2, "r0c0")]


def test_try_catches_a_drive_that_failed_and_goes_on_from_there() -> None:
    rig = Rig(robot=husky(retries=0), world=World(faults=(DriveFails(at=TreeRef(id="r0c2")),)))
    result = rig.fly(Try(id="", body=act(at=tree("r0c2")), otherwise=act(CO2, at=tree("r3c0"))))
    assert result.status == "completed"
    assert captured(result.events) == [(CO2, "r3c0")]
    drives = of_type(result.events, Driving)
    assert result.spent.metres - sum(d.planned_m for d in drives[1:]) == pytest.approx(drives[0].planned_m / 2)
    arrived = of_type(result.events, Arrived)[0]
    assert drives[2].path[0] == pytest.approx((arrived.lat, arrived.lon), abs=1e-9)


def test_try_catches_a_place_that_is_not_there() -> None:
    """After every tree was visited there is no other one."""
    everywhere = ForEach(id="", select=NotVisited(), body=act())
    plan = seq(everywhere, Try(id="", body=act(at=Take(count=1, of=NotVisited())), otherwise=act(CO2)))
    result = Rig(site=orchard(1, 3)).fly(plan)
    assert result.status == "completed"
    assert [a for a, _ in captured(result.events)] == [PICTURE] * 3 + [CO2]
    (fault,) = of_type(result.events, Faulted)
    assert (fault.fault, fault.handled) == ("no_place", True)


@pytest.mark.parametrize(("leave", "status"), [("nominal", "completed"), ("faulted", "faulted")])
def test_stop_ends_the_mission_wherever_it_stands(leave: str, status: str) -> None:
    body = seq(
        act(),
        Try(id="", body=Repeat(id="", times=3, body=StopMission(id="", exit=leave)), otherwise=act(AIR)),
        act(CO2),
    )
    result = Rig().fly(seq(each("r0c0", "r0c1", body=body), act(AIR)))
    assert captured(result.events) == [(PICTURE, "r0c0")]
    assert result.status == status


def test_a_try_that_was_used_in_one_round_tries_again_in_the_next() -> None:
    body = Try(id="", body=act(CO2), otherwise=act(AIR))
    rig = Rig(robot=husky(retries=0), world=World(faults=(ActionFails(action=CO2, times=1),)))
    result = rig.fly(each("r0c0", "r0c1", body=body))
    assert captured(result.events) == [(AIR, "r0c0"), (CO2, "r0c1")]


def test_optional_visits_are_asked_for_after_every_leg() -> None:
    guard = BudgetOf(99)
    Rig(guard=guard).fly(each("r0c0", "r0c1", "r0c2", optional=True))
    asked = [set(left) for _, place, left in guard.asked if not place]
    assert asked == [{"r0c0", "r0c1", "r0c2"}, {"r0c1", "r0c2"}, {"r0c2"}]
