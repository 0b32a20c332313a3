"""Tests of readings and of attributes, as conditions of the plan: which reading a test is about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Any, cast

from fieldhand.language import message, named
from fieldhand.language.words import say_name
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.places.resolution import resolve
from fieldhand.planning.grammar.dialogue.energy import battery_condition
from fieldhand.planning.grammar.dialogue.plans import (
    Path,
    as_for_each,
    captures_at_last_place,
    is_conditional,
    is_inside,
    measured,
    node_at,
    walk,
    with_node,
    with_selector,
)
from fieldhand.planning.grammar.dialogue.state import DialogueState, NotComposed, OpenQuestion, Setting
from fieldhand.planning.grammar.meaning import BATTERY_TEST, NTH_READING, AllTests, Check, PlaceMeaning, Test
from fieldhand.planning.grammar.places.compass import CORNERS, SIDES
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.selections import as_in_row, as_some, as_zone, named_places
from fieldhand.robot.model import RobotProfile
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.terms import Test as Comparison

#: Metres by which the place farthest to a side lies farther than the others of its group.
_FARTHER_M = 1.0
#: Tests of an attribute.
TREE_TESTS: Mapping[Check, Comparison] = {"eq": "eq", "lt": "lt", "le": "le", "gt": "gt", "ge": "ge"}


def condition_of(setting: Setting, state: DialogueState, tests: AllTests) -> tuple[c.Condition, DialogueState]:
    """Return the condition of tests, and the state in which the tested readings have names.

    Raises:
        NotComposed: Which reading or tree is tested is unclear.
    """
    if tests.of_last:
        return of_several(setting, state, tests)
    made: list[c.Condition] = []
    for test in tests.tests:
        if test.attribute:
            made.append(_of_tree(state, test))
        elif test.quantity == BATTERY_TEST:
            made.append(battery_condition(state, test))
        else:
            if test.place is not None and len(tests.tests) > 1:
                state, taken = readings_at(setting, state, test)
                state = replace(state, captured=_only(taken))
                test = replace(test, place=None)
            one, state = _of_reading(setting, state, test)
            made.append(one)
    if len(made) == 1:
        return made[0], state
    return (c.AnyOf if tests.any_of else c.AllOf)(conditions=tuple(made)), state


def _only(paths: Sequence[Path]) -> Path:
    """Return the only one of some paths.

    Raises:
        NotComposed: There is none, or there are several.
    """
    if len(paths) != 1:
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    return paths[0]


def of_several(setting: Setting, state: DialogueState, tests: AllTests) -> tuple[c.Condition, DialogueState]:
    """Return the condition on the last several readings together ("both are low"), and the state that names them.

    Raises:
        NotComposed: Which readings are meant is unclear.
    """
    state, paths = _last_readings(setting, state, tests.tests[0])
    if len(paths) < 2 or (tests.at_least == 1 or tests.at_least > len(paths)):
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    made: list[c.Condition] = []
    for path in paths:
        one, state = _of_reading(setting, replace(state, captured=path), tests.tests[0])
        made.append(c.Not(condition=one) if tests.of_last == "none" else one)
    if tests.at_least:
        groups = [c.AllOf(conditions=group) for group in combinations(made, tests.at_least)]
        return (groups[0] if len(groups) == 1 else c.AnyOf(conditions=tuple(groups))), state
    return (c.AnyOf if tests.of_last == "any" else c.AllOf)(conditions=tuple(made)), state


def _last_readings(setting: Setting, state: DialogueState, test: Test) -> tuple[DialogueState, list[Path]]:
    """Return the paths of the last captures of what is tested; a for-each over named places becomes one each."""
    steps = state.block.steps
    if steps and as_for_each(steps[-1]) is not None:
        state = _one_by_one(setting, state, len(steps) - 1)
    found: list[Path] = []
    for number, step in enumerate(state.block.steps):
        if step.act is None:
            found = []
        elif fits(step, test, setting.robot):
            found.append((*state.scope, number))
    return state, found


def _one_by_one(setting: Setting, state: DialogueState, number: int) -> DialogueState:
    """Return the state with the captures at each of the named places of a for-each, in place of that step of the block.

    Raises:
        NotComposed: The places are not named one by one, or something else is done there.
    """
    steps = state.block.steps
    loop, acts = as_for_each(steps[number]), captures_at_last_place(steps[: number + 1])
    places = () if loop is None else named_places(loop.select)
    if (
        loop is None
        or loop.optional
        or loop.at_most is not None
        or not acts
        or not places
        or not all(_is_one(setting, one) for one in places)
    ):
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    each = [
        replace(act, at=place, at_said=loop.said) if first == 0 else act
        for place in places
        for first, act in enumerate(acts)
    ]
    block = replace(state.block, steps=(*steps[:number], *each, *steps[number + 1 :]))
    return replace(state, plan=with_node(state.plan, state.scope, block), loop=None)


def _of_tree(state: DialogueState, test: Test) -> c.Condition:
    """Return the condition on an attribute of the current tree."""
    if state.where is None and state.loop is None:
        raise NotComposed(message("it is not clear which tree is meant", context="fault"))
    condition = c.TreeHas(attribute=test.attribute, test=TREE_TESTS[test.check], value=test.value)
    return c.Not(condition=condition) if test.negated else condition


def _of_reading(setting: Setting, state: DialogueState, test: Test) -> tuple[c.Condition, DialogueState]:
    """Return the condition on a reading, and the state in which that reading has a name."""
    robot = setting.robot
    state, path = _tested_capture(setting, state, test)
    act = None if path is None else node_at(state.plan, path).act
    if path is None or act is None:
        raise NotComposed(message("nothing before it measures that", context="fault"))
    measures = measured(robot, act.action)
    quantity = "" if test.quantity.startswith(NTH_READING) else test.quantity
    quantity = quantity or (measures[0] if measures else "")
    if quantity not in measures:
        raise NotComposed(message("the reading before it measures something else", context="fault"))
    unit = robot.quantity[quantity].unit
    if test.unit and test.unit != unit:
        raise NotComposed(message("the reading before it is in another unit", context="fault"))
    if not act.reading:
        act = replace(act, reading=f"r{state.readings + 1}")
        state = replace(state, readings=state.readings + 1, plan=with_node(state.plan, path, act))
    condition = checked(test, act.reading, quantity, robot)
    return (c.Not(condition=condition) if test.negated else condition), replace(state, captured=path)


def checked(test: Test, reading: str, quantity: str, robot: RobotProfile) -> c.Condition:
    """Return the condition of a test that is not negated.

    Raises:
        NotComposed: The robot's profile does not say what the level is.
    """
    unit = robot.quantity[quantity].unit
    if test.check == "level":
        if test.value not in robot.quantity[quantity].levels:
            what = message(
                "what is a {level} {quantity}? {name} does not define that level",
                level=named(test.value, "level"),
                quantity=say_name(quantity),
                name=robot.name,
            )
            raise OpenQuestion(message("{what}; say a threshold in {unit}", context="question", what=what, unit=unit))
        return c.Level(reading=reading, quantity=quantity, level=test.value)
    if test.check == "between":
        low, high = test.value
        return c.Between(reading=reading, quantity=quantity, low=low, high=high, unit=unit)
    if test.check == "known":
        raise NotComposed(message("it is not clear what ends then", context="fault"))
    return c.Compare(reading=reading, quantity=quantity, test=test.check, value=test.value, unit=unit)


def _tested_capture(setting: Setting, state: DialogueState, test: Test) -> tuple[DialogueState, Path | None]:
    """Return the path of the capture whose reading is tested: the last one, if its quantity and unit fit."""
    if test.quantity.startswith(NTH_READING):
        return _nth_reading(setting, state, replace(test, quantity=""), int(test.quantity.removeprefix(NTH_READING)))
    return state, _last_reading(state, test, setting.robot)


def _nth_reading(setting: Setting, state: DialogueState, test: Test, number: int) -> tuple[DialogueState, Path | None]:
    """Return the path of a reading by its number, 1 for the first; "there" is not known behind another than the last.

    Raises:
        NotComposed: It is not clear which reading is meant.
    """
    if state.block.steps and as_for_each(state.block.steps[-1]) is not None:
        state, measuring = _last_readings(setting, state, test)
    else:
        measuring = [path for path, node in walk(state.plan) if fits(node, test, setting.robot)]
    if number == 1 and measuring:
        found = measuring[0]
    elif 1 < number <= len(measuring) or (number < 0 and len(measuring) > 1):
        found = measuring[number - 1 if number > 0 else number]
    else:
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    return (state if found == measuring[-1] else replace(state, where=None)), found


def _last_reading(state: DialogueState, test: Test, robot: RobotProfile) -> Path | None:
    """Return the path of the last capture whose quantity and unit fit a test."""
    if state.captured is not None and fits(node_at(state.plan, state.captured), test, robot):
        return state.captured
    fitting = [path for path, node in walk(state.plan) if fits(node, test, robot)]
    return fitting[-1] if fitting else None


def fits(node: p.Node, test: Test, robot: RobotProfile) -> bool:
    """Return True if a capture measures what is tested."""
    if node.act is None:
        return False
    measures = measured(robot, node.act.action)
    if not set(test.setting) <= set(node.act.parameters):
        return False
    if test.quantity:
        return test.quantity in measures
    return bool(measures) and (not test.unit or robot.quantity[measures[0]].unit == test.unit)


def readings_at(setting: Setting, state: DialogueState, test: Test) -> tuple[DialogueState, list[Path]]:
    """Return the paths of the last reading of each action at the place of a test, outside of conditions.

    A for-each over that place and others becomes one capture each.

    Raises:
        NotComposed: Which of the places of the readings is meant is unclear.
    """
    if test.place is None:
        return state, []
    loops = [number for number, step in enumerate(state.plan.steps) if step.visits_each and step.selector is not None]
    visited = named_places(state.plan.steps[loops[-1]].selector or s.Here()) if loops else ()
    if not state.scope and visited:
        meant = _place_meant(setting, visited, test.place)
        if meant is not None or test.place.like is not None:
            state = replace(_one_by_one(setting, state, loops[-1]), choice=None)
    taken: list[tuple[Path, s.Selector, p.Act]] = []
    where: s.Selector | None = None
    for number, step in enumerate(state.plan.steps):
        where = step.selector if step.selector is not None else where
        if step.act is not None and where is not None and fits(step, test, setting.robot):
            taken.append(((number,), where, step.act))
    places = tuple(dict.fromkeys(place for _, place, _ in taken))
    meant = _place_meant(setting, places, test.place)
    if meant is None and _is_among(setting, state, test):
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    if meant is not None and test.place.like is not None and not _says_side(meant, test.place.like.side):
        steps = tuple(_said_to_side(step, meant, test.place.like.side, places) for step in state.plan.steps)
        state = replace(state, plan=replace(state.plan, steps=steps))
    if meant is None and test.place.like is not None:
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    return state, list({act.action: path for path, place, act in taken if place == meant}.values())


def _is_among(setting: Setting, state: DialogueState, test: Test) -> bool:
    """Return True if a reading in a zone is tested, and readings were taken at plants of it."""
    some = None if test.place is None else as_some(test.place.selector)
    if some is None:
        return False
    inside, where = {*(ids_of(some.of, setting.site) or ())}, None
    for _, node in walk(state.plan):
        where = node.selector if node.selector is not None else where
        if where is not None and fits(node, test, setting.robot):
            taken = as_some(where)
            if inside & {*(ids_of(where if taken is None else taken.of, setting.site) or ())}:
                return True
    return False


def _says_side(place: s.Selector, side: str) -> bool:
    """Return True if a place names a side, or is a corner or an end of a row."""
    return side not in SIDES or any(side in part.sides or as_in_row(part) is not None for part in place.walk())


def _said_to_side(step: p.Node, place: s.Selector, side: str, places: Sequence[s.Selector]) -> p.Node:
    """Return a step at a place with that place as the farthest to a side of all of them ("the northern one")."""
    farthest = s.Extreme(side=cast(Any, side), of=s.UnionOf(parts=tuple(places)))
    if step.selector != place:
        return step
    return with_selector(step, farthest) if step.act is None else replace(step.act, at=farthest)


def _is_one(setting: Setting, place: s.Selector) -> bool:
    """Return True for a single place."""
    return place.single or len(ids_of(place, setting.site) or ()) == 1


def _place_meant(setting: Setting, places: Sequence[s.Selector], place: PlaceMeaning) -> s.Selector | None:
    """Return the one of several single places that a phrase means: the same one, or the farthest to a side."""
    if place.like is None:
        meant = ids_of(place.selector, setting.site)
        same = [one for one in places if meant and ids_of(one, setting.site) == meant]
        if not same and (some := as_some(place.selector)) is not None and (zone := as_zone(some.of)) is not None:
            same = [one for one in places if one == s.PointsIn(zone=zone.zone, count=1)]
        return place.selector if place.selector in places else same[0] if len(same) == 1 else None
    side = place.like.side
    if side in CORNERS:
        corner = ids_of(s.Corners(which=(cast(Any, side),)), setting.site)
        same = [one for one in places if ids_of(one, setting.site) == corner]
        return same[0] if len(same) == 1 else None
    if side not in SIDES or len(places) < 2 or not all(_is_one(setting, one) for one in places):
        return None
    if any(one.relative for one in places):
        return None
    found = [resolve(one, setting.site, Context(here=setting.site.start)) for one in places]
    along = [at[0].y if side in ("north", "south") else at[0].x for at in found if len(at) == 1]
    ranked = sorted(along, reverse=side in ("north", "east"))
    known = len(ranked) == len(places) and abs(ranked[0] - ranked[1]) >= _FARTHER_M
    return places[along.index(ranked[0])] if known else None


def reading_before(plan: p.InOrder, before: Path, robot: RobotProfile) -> Path | None:
    """Return the path of the last capture of a reading before a step and outside of conditions."""
    found: Path | None = None
    for path, node in walk(plan):
        if is_inside(path, before):
            break
        if node.act is not None and measured(robot, node.act.action) and not is_conditional(path):
            found = path
    return found
