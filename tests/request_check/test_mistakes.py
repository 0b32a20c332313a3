"""The check catches planted mistakes: named ones each, and of all kinds the share that the docs promise."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fieldhand.places import selectors as s
from fieldhand.planning.planner import Planned
from fieldhand.request_check import mismatches
from fieldhand.robot.loader import load_robot
from fieldhand.site.loader import open_site
from fieldhand.task import plan as p
from fieldhand.task.build import make_task
from fieldhand.task.frames import Task
from fieldhand.testing.generated.tasks import ROVER, Parts
from request_check.plan_mutants import mutants
from support.requests import english as english_requests
from support.requests import rows as row_requests
from support.requests.planned import outcome_of

DEMO = open_site("demo")
ROBOTS = {name: load_robot(name) for name in ("husky", "amiga")}
#: Every so many-th documented request stands for all of them here; the docs give the figures of all.
SAMPLE = (english_requests.PLANNED + row_requests.PLANNED)[::8]
#: Least share, of the kinds of which the sample holds enough.
LEAST = {
    "count": 0.9,
    "sensor": 0.85,
    "tree": 1.0,
    "budget invented": 1.0,
    "step dropped": 0.6,
    "row": 0.4,
    "side": 0.45,
}


def plan(request: str, robot: str = "husky") -> Task:
    outcome = outcome_of(robot, request)
    assert isinstance(outcome, Planned), outcome
    return outcome.task


def said_of(task: Task, request: str) -> Task:
    """The plan of other words, given for these."""
    return make_task(
        request=request,
        plan=task.composition.plan,
        measures={},
        constraints=task.constraints,
        nominal=task.composition.nominal,
    )


@pytest.mark.parametrize(
    ("said", "planned_as", "kind"),
    [
        ("Take 3 pictures of tree 4.", "Take 2 pictures of tree 4.", "count"),
        ("Take a picture of tree 4.", "Take 5 pictures of tree 4.", "count"),
        ("Take a picture of 6 trees in the northern half.", "Take a picture of 5 trees in the northern half.", "count"),
        ("Take a picture of tree 4.", "Measure CO2 at tree 4.", "sensor"),
        ("Read the air temperature at tree 4.", "Take a picture of tree 4.", "sensor"),
        ("Read co2 at tree 4 and take a picture.", "Read co2 at tree 4.", "sensor"),
        (
            "Take a picture of tree 4. If it is below 33 C, read CO2.",
            "Take a picture of tree 4. If it is below 30 C, read CO2.",
            "threshold",
        ),
        (
            "Take a picture of tree 4. If it is below 90 F, read CO2.",
            "Take a picture of tree 4. If it is below 90 C, read CO2.",
            "threshold",
        ),
        (
            "Take a picture of tree 4. If it is below 33 C, read CO2.",
            "Take a picture of tree 4. If it is above 33 C, read CO2.",
            "threshold",
        ),
        (
            "Take a picture of tree 4. If it is below 33 C, read CO2.",
            "Take a picture of tree 4. Read CO2.",
            "condition",
        ),
        ("Read CO2 at tree 4. If it is low, take a picture.", "Read CO2 at tree 4. Take a picture.", "condition"),
        (
            "Read CO2 at tree 4. If it is low, take a picture.",
            "Read CO2 at tree 4. If it is high, take a picture.",
            "condition",
        ),
        (
            "At tree 4 take a picture and read the air temperature. If the canopy is above 36 C, read CO2.",
            "At tree 4 take a picture and read the air temperature. If the air temperature is above 36 C, read CO2.",
            "sensor",
        ),
        ("Take a picture of the northernmost tree.", "Take a picture of the southernmost tree.", "side"),
        ("Take a picture at the north-west corner.", "Take a picture at the south-east corner.", "side"),
        ("Take a picture of tree 4.", "Take a picture of tree 40.", "place"),
        ("Take a picture of trees 4, 5 and 6.", "Take a picture of trees 4 and 5.", "place"),
        ("Take a picture of every tree in row 3.", "Take a picture of every tree in row 5.", "place"),
        ("Take a picture of tree 4 and go to the charger.", "Take a picture of tree 4.", "place"),
        ("Take 3 pictures in the wet corner.", "Take 3 pictures in the northern half.", "place"),
        ("Take a picture of every yellow tree.", "Take a picture of every tree.", "attribute"),
        ("Take a picture of every Carmel tree.", "Take a picture of every Nonpareil tree.", "attribute"),
        ("Take a picture of tree 4 within 10 minutes.", "Take a picture of tree 4.", "limit"),
        ("Take a picture of tree 4.", "Take a picture of tree 4 within 10 minutes.", "limit"),
        ("Take a picture of tree 4 within 10 minutes.", "Take a picture of tree 4 within 10 seconds.", "limit"),
        ("Photograph every corner, using at most 40 % of the battery.", "Photograph every corner.", "limit"),
        (
            "Photograph every corner and keep 40 % of the battery in reserve.",
            "Photograph every corner, using at most 40 % of the battery.",
            "limit",
        ),
        (
            "Take pictures of as many trees as you can within 300 m of driving.",
            "Take pictures of as many trees as you can within 300 feet of driving.",
            "limit",
        ),
        ("Take a picture of as many trees as possible in 5 minutes.", "Take a picture of every tree.", "limit"),
        (
            "Take a picture of every tree within 20 m of the start.",
            "Take a picture of every tree within 60 m of the start.",
            "distance",
        ),
        ("Take a picture of tree 4 and return to the start.", "Take a picture of tree 4.", "return"),
        ("Take a picture of tree 4, then come back to the starting point.", "Take a picture of tree 4.", "return"),
        (
            "visit trees 4, 5 and 6 in that order and take a picture of each",
            "visit trees 6, 5 and 4 in that order and take a picture of each",
            "order",
        ),
        (
            "photograph the yellow trees from north to south",
            "photograph the yellow trees from east to west",
            "order",
        ),
    ],
)
def test_a_plan_for_other_words_is_doubted(said: str, planned_as: str, kind: str) -> None:
    found = mismatches(said_of(plan(planned_as), said), DEMO, ROBOTS["husky"])
    assert kind in {m.kind for m in found}, found
    assert all(m.what and "\n" not in m.what for m in found)


def drives_to(*places: s.Selector, then: s.Selector | None = None) -> p.Node:
    """A drive to each place, and at the end a picture at another if there is one."""
    steps: list[p.Node] = [p.GoTo(id="", place=place) for place in places]
    picture = p.Act(id="", action="take_thermal_picture", at=then)
    return p.InOrder(id="", steps=(*steps, picture))


ROW = s.Rows(first="1", last="1")
NORTH, SOUTH = s.Extreme(side="north", of=ROW), s.Extreme(side="south", of=ROW)


@pytest.mark.parametrize(
    ("said", "node"),
    [
        ("Drive along row 1 and take a picture.", drives_to(NORTH)),
        ("Drive along row 1 and take a picture.", drives_to(NORTH, s.Extreme(side="east", of=ROW))),
        ("Drive along row 1 and take a picture.", drives_to(NORTH, s.Extreme(side="south"))),
        ("Drive along row 1 and take a picture.", drives_to(NORTH, SOUTH, then=s.Extreme(side="north"))),
        ("Drive to the north end of row 1 and take a picture.", drives_to(NORTH, SOUTH)),
    ],
    ids=["one end", "no way", "ends of other trees", "and a place at a side", "one end is asked for"],
)
def test_a_side_that_nobody_spoke_of_is_doubted_unless_it_tells_apart_the_ends_of_a_way(
    said: str, node: p.Node
) -> None:
    assert "side" in {
        m.kind for m in mismatches(make_task(request=said, plan=node, measures={}), DEMO, ROBOTS["husky"])
    }
    ends = make_task(request="Drive along row 1 and take a picture.", plan=drives_to(NORTH, SOUTH), measures={})
    assert mismatches(ends, DEMO, ROBOTS["husky"]) == ()


def test_planted_mistakes_are_caught_in_the_share_that_is_promised() -> None:
    planted: Counter[str] = Counter()
    caught: Counter[str] = Counter()
    for robot, request, _ in SAMPLE:
        for kind, mutant in mutants(plan(request, robot), DEMO, ROBOTS[robot]):
            planted[kind] += 1
            caught[kind] += bool(mismatches(mutant, DEMO, ROBOTS[robot]))
    assert sum(caught.values()) >= 0.85 * sum(planted.values())
    for kind, least in LEAST.items():
        assert planted[kind] >= 5, kind
        assert caught[kind] >= least * planted[kind], (kind, caught[kind], planted[kind])


def test_a_mismatch_names_the_node_that_it_is_about() -> None:
    task = said_of(plan("Take a picture of tree 40 and of tree 5."), "Take a picture of tree 4 and of tree 5.")
    (invented,) = [m for m in mismatches(task, DEMO, ROBOTS["husky"]) if "'40'" in m.what]
    assert invented.node in {"n1", "n2", "n3"}


WORDS = (
    "take", "3", "pictures", "of", "tree", "row", "4", "%", "of", "the", "battery", "33",
    "C", "ppm", "below", "above", "north", "if", "low", "then", "1,000", "m", "half", "hour", "#",
)  # fmt: skip


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
@given(
    task=Parts(ROVER).tasks(),
    request=st.one_of(
        st.text(max_size=80),
        st.lists(st.sampled_from([*WORDS, "9" * 400, "hundred " * 300]), max_size=20).map(" ".join),
    ),
)
def test_whatever_is_said_and_planned_never_breaks_it(task: Task, request: str) -> None:
    found = mismatches(said_of(task, request), DEMO, ROBOTS["husky"])
    assert all(m.what for m in found)
