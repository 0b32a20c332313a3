"""Tests of several readings together, and places chosen by readings: which readings of the plan they are about."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, cast

from fieldhand.language import message
from fieldhand.language.words import say_name
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.plans import (
    EMPTY,
    Path,
    as_for_each,
    block_at,
    is_conditional,
    is_inside,
    node_at,
    walk,
    with_node,
)
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    Spans,
    with_assumption,
    with_last_step,
    with_step,
)
from fieldhand.planning.grammar.dialogue.tested import checked, fits
from fieldhand.planning.grammar.meaning import (
    DIFFERENCE,
    NTH_READING,
    AllTests,
    CaptureCommand,
    Command,
    DriveCommand,
    HowMany,
    LinkedCommand,
    PlaceMeaning,
    Subject,
    Test,
    When,
    wait_seconds,
)
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.selections import (
    are_rows,
    as_in_row,
    as_zone,
    blocks_of,
    is_in_block,
    is_one_row,
    named_places,
    over,
    picks_per_row,
)
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown

#: Maximum number of readings at one place where the request gives none.
MOST_READINGS = 30
#: Number of readings that the mean of which the error is asked needs, by default and at least.
_LEAST_READINGS = 5


def is_of_series(state: DialogueState, tests: AllTests) -> bool:
    """Return True for tests of several readings that are not named one by one."""
    if tests.of_series:
        return True
    if not tests.of_last:
        return False
    loop = None if state.loop is None else as_for_each(node_at(state.plan, state.loop[:-1]))
    return loop is not None and not named_places(loop.select)


def when_series(
    setting: Setting, state: DialogueState, command: When, following: Sequence[LinkedCommand], *, decides_last: bool
) -> DialogueState:
    """Return the state after a condition on several readings, which stands behind all of them.

    Raises:
        NotComposed: Which readings are meant, or what depends on them, is unclear.
    """
    said = setting.spans_of(command.used)
    steps = state.block.steps
    if decides_last:
        if not steps or state.scope:
            raise NotComposed(message("nothing depends on the condition", context="fault"))
        before = replace(state, plan=replace(state.plan, steps=steps[:-1]), captured=None, loop=None)
        condition, before = series_condition(setting, before, command.tests)
        choice = p.If(id="", condition=condition, then=p.InOrder(id="", steps=steps[-1:]), said=said)
        plan = replace(before.plan, steps=(*before.plan.steps, choice))
        made = replace(before, plan=plan, choice=(len(before.plan.steps),), decided=command.tests, loop=None)
        return replace(made, tested_at=(state.where, state.where_scope))
    then = following[0].command if following else None
    here = isinstance(then, CaptureCommand) and (then.place is None or then.place.shape == "here")
    if here and (parted := _at_each_place(state)) is not None:
        state, scope = parted
        condition, state = until_condition(setting, state, command.tests, cast(Path, state.captured))
    else:
        if here and state.where is not None and state.where.shape != "one":
            raise NotComposed(message("it is not clear at which of them this is done", context="fault"))
        condition, state = series_condition(setting, state, command.tests)
        scope = _scope_behind(state)
    path = (*scope, len(block_at(state.plan, scope).steps))
    state = with_step(replace(state, scope=scope), p.If(id="", condition=condition, then=EMPTY, said=said))
    tested_at = (state.where, state.where_scope)
    made = replace(state, scope=(*path, "then"), choice=path, decided=command.tests, open=True, tested_at=tested_at)
    return made if here and state.loop is not None and is_inside(scope, state.loop) else replace(made, loop=None)


def at_compared(clauses: Sequence[LinkedCommand]) -> tuple[LinkedCommand, ...]:
    """Return clauses with "there" as the area that the condition before it compares with another."""
    found: list[LinkedCommand] = []
    for clause in clauses:
        before, command = found[-1].command if found else None, clause.command
        tests = before.tests.tests if isinstance(before, When) else ()
        area = tests[0].place if len(tests) == 1 and tests[0].than is not None else None
        there = isinstance(command, CaptureCommand) and command.place is not None and command.place.shape == "here"
        if area is not None and there and isinstance(command, CaptureCommand):
            clause = replace(clause, command=replace(command, place=area, relation="in"))
        found.append(clause)
    return tuple(found)


def _at_each_place(state: DialogueState) -> tuple[DialogueState, Path] | None:
    """Return the state with several captures at each place as rounds with a series of their own, and their block.

    None if the last captures are not several at each of several places.
    """
    path = state.captured
    act = None if path is None else node_at(state.plan, path).act
    if path is None or act is None or act.count < 2 or act.reading or state.loop is None or path[:-1] != state.loop:
        return None
    name = f"r{state.readings + 1}"
    body = p.InOrder(id="", steps=(replace(act, count=1, reading=name),))
    rounds = p.Repeat(id="", times=act.count, body=body, collects=name, said=act.said)
    plan = with_node(state.plan, path, rounds)
    made = replace(state, plan=plan, readings=state.readings + 1, captured=(*path, "body", 0))
    return made, state.loop


def _scope_behind(state: DialogueState) -> Path:
    """Return the block in which a condition on all readings so far stands: behind the visits, outside of them."""
    if state.scope and is_conditional(state.scope):
        return state.scope
    return ()


def series_condition(setting: Setting, state: DialogueState, tests: AllTests) -> tuple[c.Condition, DialogueState]:
    """Return the condition of tests of several readings, and the state in which the readings have names.

    Raises:
        NotComposed: Which readings are meant is unclear.
    """
    made: list[c.Condition] = []
    for test in tests.tests:
        if test.than is not None:
            one, state = _comparison(setting, state, test)
        elif test.of or tests.of_last:
            paths = _paths(setting, state, test)
            one, state = condition_on(setting, state, test, paths, tests.of_last)
        else:
            raise NotComposed(message("it is not clear which readings are tested", context="fault"))
        made.append(c.Not(condition=one) if test.negated else one)
    if len(made) == 1:
        return made[0], state
    return (c.AnyOf if tests.any_of else c.AllOf)(conditions=tuple(made)), state


def condition_on(
    setting: Setting, state: DialogueState, test: Test, paths: Sequence[Path], of_last: Any = ""
) -> tuple[c.Condition, DialogueState]:
    """Return the condition of a test on the readings of some captures together, if it is not negated."""
    name, quantity, state = _named(setting, state, test, paths)
    unit = setting.robot.quantity[quantity].unit
    if test.check == "known":
        return _known(setting, test, name, quantity, unit), state
    if test.unit and test.unit != unit:
        raise NotComposed(message("the reading before it is in another unit", context="fault"))
    single = cast(c.Compare | c.Between | c.Level, checked(test, name, quantity, setting.robot))
    if test.of:
        return Aggregate(of=test.of, condition=single), state
    how = _how_many(of_last)
    return CountReadings(test=how.check, number=how.number, percent=how.percent, condition=single), state


def _how_many(of_last: Any) -> HowMany:
    """Return how many of several readings have to pass."""
    if isinstance(of_last, HowMany):
        return of_last
    known = {"all": HowMany("eq", 100.0, percent=True), "none": HowMany("eq", 0.0), "any": HowMany("ge", 1.0)}
    return known[of_last] if of_last in known else HowMany("ge", float(of_last))


def _known(setting: Setting, test: Test, name: str, quantity: str, unit: str) -> MeanKnown:
    """Return the condition that a mean is known to so much, in percent of itself or in its unit."""
    relative = MeanKnown(reading=name, quantity=quantity, percent=test.value, at_least=_LEAST_READINGS)
    absolute = MeanKnown(reading=name, quantity=quantity, value=test.value, unit=unit, at_least=_LEAST_READINGS)
    if test.unit == "percent" and unit == "percent":
        return setting.either("percent of the mean, or percentage points?", 0, (relative, absolute))
    if test.unit == "percent":
        return relative
    if test.unit != unit:
        raise NotComposed(message("the reading before it is in another unit", context="fault"))
    return absolute


def _comparison(setting: Setting, state: DialogueState, test: Test) -> tuple[c.Condition, DialogueState]:
    """Return the comparison of the readings at one place, or in one area, with those at another."""
    other = test.than
    if other is not None and other.quantity == DIFFERENCE:
        return _difference(setting, state, test)
    if other is not None and other.quantity.startswith(NTH_READING):
        return _change(setting, state, test, other.quantity)
    if other is not None and other.place is None and test.place is not None:
        other = replace(other, place=_rest_of(setting, state, test, test.place))
    if other is None or other.place is None or test.place is None:
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    state = _parted(setting, state, test.place, other.place)
    second = replace(test, place=other.place)
    name, quantity, state = _named(setting, state, test, _paths(setting, state, test))
    than, other_quantity, state = _named(setting, state, second, _paths(setting, state, second))
    unit = setting.robot.quantity[quantity].unit
    if name == than or quantity != other_quantity or (test.unit and test.unit != unit):
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    made = CompareSeries(
        of=test.of or "mean",
        reading=name,
        than=than,
        quantity=quantity,
        test=cast(Any, test.check),
        value=test.value,
        unit=unit if test.value else "",
    )
    return made, state


def _rest_of(setting: Setting, state: DialogueState, test: Test, place: PlaceMeaning) -> PlaceMeaning | None:
    """Return the only other place of such readings ("if the wet corner is higher"); None unless there is one."""
    found: list[s.Selector] = []
    for path, node in walk(state.plan):
        if node.act is not None and fits(node, replace(test, unit=""), setting.robot):
            found += [one for one in place_of(state.plan, path).members if not _is_at(setting, one, place)]
    others = list(dict.fromkeys(found))
    return PlaceMeaning(others[0], "several") if len(others) == 1 else None


def sides_measured(setting: Setting, state: DialogueState) -> tuple[s.Selector, ...]:
    """Return the places at which what was measured last was measured, each once."""
    acts = [(path, node.act) for path, node in walk(state.plan) if node.act is not None]
    acts = [(path, act) for path, act in acts if act.action in setting.robot.action]
    measuring = [(path, act) for path, act in acts if setting.robot.action[act.action].measures]
    last = measuring[-1][1].action if measuring else ""
    places = (place_of(state.plan, path) for path, act in measuring if act.action == last)
    return tuple(dict.fromkeys(one for place in places for one in place.members))


def _difference(setting: Setting, state: DialogueState, test: Test) -> tuple[c.Condition, DialogueState]:
    """Return the test of how far two readings, or the means at two places, are apart, in either direction.

    Raises:
        NotComposed: Readings were not taken at just two places.
    """
    sides = [PlaceMeaning(one, "several") for one in sides_measured(setting, state)]
    if len(sides) != 2 or test.check not in ("gt", "ge", "lt", "le"):
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    made: list[c.Condition] = []
    for one, other in (sides, sides[::-1]):
        condition, state = _comparison(setting, state, replace(test, place=one, than=Subject(place=other)))
        made.append(condition)
    return (c.AnyOf if test.check in ("gt", "ge") else c.AllOf)(conditions=tuple(made)), state


def _change(setting: Setting, state: DialogueState, test: Test, other: str) -> tuple[c.Condition, DialogueState]:
    """Return the comparison of two readings that are known by their numbers: the last one and the one before it.

    Raises:
        NotComposed: There are none, or they measure different things.
    """
    unclear = NotComposed(message("it is not clear which readings are tested", context="fault"))
    acts = [(path, node.act) for path, node in walk(state.plan) if node.act is not None]
    found = [(path, act) for path, act in acts if wait_seconds(act.action) is None]
    taken = [path for path, act in found if act.count == 1 and setting.robot.action[act.action].measures]
    taken = [path for path in taken if not any(node_at(state.plan, path[:end]).visits_each for end in range(len(path)))]
    named: list[tuple[str, str]] = []
    for number in (int(test.quantity.removeprefix(NTH_READING)), int(other.removeprefix(NTH_READING))):
        at = number - 1 if number > 0 else len(taken) + number
        if not 0 <= at < len(taken) or len(taken) < len(found):
            raise unclear
        one, quantity, state = _named(setting, state, replace(test, quantity=""), [taken[at]])
        named.append((one, quantity))
    (name, quantity), (than, other_quantity) = named
    unit = setting.robot.quantity[quantity].unit
    if name == than or quantity != other_quantity or (test.unit and test.unit != unit):
        raise unclear
    made = CompareSeries(
        of="mean", reading=name, than=than, quantity=quantity, test=cast(Any, test.check), value=test.value,
        unit=unit if test.value else "",
    )  # fmt: skip
    return made, state


def _parted(setting: Setting, state: DialogueState, one: PlaceMeaning, other: PlaceMeaning) -> DialogueState:
    """Return the state with one for-each a place in the stead of a for-each that visits both places."""
    for number, step in enumerate(state.plan.steps):
        loop = as_for_each(step)
        if loop is None or loop.optional or loop.at_most is not None or loop.until is not None:
            continue
        parts = loop.select.members
        sides = [[part for part in parts if _is_at(setting, part, place)] for place in (one, other)]
        if len(parts) < 2 or not all(sides) or len(sides[0]) + len(sides[1]) != len(parts):
            continue
        loops = tuple(
            replace(loop, select=side[0] if len(side) == 1 else s.UnionOf(parts=tuple(side)))
            for side in sorted(sides, key=lambda side: parts.index(side[0]))
        )
        steps = (*state.plan.steps[:number], *loops, *state.plan.steps[number + 1 :])
        return replace(state, plan=replace(state.plan, steps=steps), captured=None, loop=None)
    return state


def _is_at(setting: Setting, selector: s.Selector, place: PlaceMeaning) -> bool:
    """Return True if the places of a selector are those of a phrase, or some of its area."""
    if selector == place.selector or place.selector in tuple(selector.walk()):
        return True
    zone = as_zone(place.selector)
    named = zone is not None and zone == s.InZone(zone=zone.zone) and getattr(selector, "zone", "") == zone.zone
    if named and getattr(selector, "part", "") == "all":
        return True  # free points of the zone
    if are_rows(place.selector) and not is_in_block(place.selector):
        rows = {over(place.selector, block) for block in blocks_of(selector)}
        return bool(rows & set(selector.walk()))
    meant, some = ids_of(place.selector, setting.site), ids_of(selector, setting.site)
    return meant is not None and some is not None and bool(some) and some <= meant


def _paths(setting: Setting, state: DialogueState, test: Test) -> list[Path]:
    """Return the paths of the captures whose readings are tested together.

    Raises:
        NotComposed: There are none, or it is unclear which.
    """
    found = [
        (path, node) for path, node in walk(state.plan) if node.act is not None and fits(node, test, setting.robot)
    ]
    if test.place is not None:
        place = test.place
        found = [(path, node) for path, node in found if _is_at(setting, place_of(state.plan, path), place)]
    if not found:
        raise NotComposed(message("nothing before it measures that", context="fault"))
    actions = [node.act.action for _, node in found if node.act is not None]
    if len(set(actions)) > 1:
        action = setting.either("which readings are tested?", 0, tuple(dict.fromkeys(reversed(actions))))
        found = [(path, node) for path, node in found if node.act is not None and node.act.action == action]
    paths = [path for path, _ in found]
    if len(paths) > 1 and any(len(path) > 1 for path in paths):
        ways = (paths[-1:], paths)
        return list(setting.either("the last readings, or all?", 0, ways))
    return paths


def _fits(node: p.Node, test: Test, setting: Setting) -> bool:
    """Return True if a capture measures what is tested; the precision of a mean may be in percent of it."""
    relative = test.check == "known" and test.unit == "percent"
    return fits(node, replace(test, unit="") if relative else test, setting.robot)


def place_of(plan: p.InOrder, path: Path) -> s.Selector:
    """Return the place of a capture: its own, that of the visits around it, or that of the last drive before it."""
    node = node_at(plan, path)
    if node.selector is not None:
        return node.selector
    for end in range(len(path) - 1, -1, -1):
        around = node_at(plan, path[:end])
        if around.visits_each and around.selector is not None:
            return around.selector
    number = path[0]
    before = plan.steps[: int(number)] if isinstance(number, int) else ()
    return next((step.selector for step in reversed(before) if step.selector is not None), s.Here())


def _named(setting: Setting, state: DialogueState, test: Test, paths: Sequence[Path]) -> tuple[str, str, DialogueState]:
    """Return the common name and the quantity of the readings of some captures, and the state that names them so.

    Raises:
        NotComposed: They are one reading, readings of each of several rows, or have other names already.
    """
    acts = [act for path in paths if (act := node_at(state.plan, path).act) is not None]
    measures = setting.robot.action[acts[0].action].measures
    quantity = test.quantity or (measures[0] if measures else "")
    if quantity not in measures:
        raise NotComposed(message("the reading before it measures something else", context="fault"))
    if len(paths) == 1 and test.than is None:
        _require_several(state.plan, paths[0], acts[0])
    names = {act.reading for act in acts if act.reading}
    if len(names) > 1:
        raise NotComposed(message("it is not clear which readings are tested", context="fault"))
    name = names.pop() if names else f"r{state.readings + 1}"
    if not any(act.reading for act in acts):
        state = replace(state, readings=state.readings + 1)
    plan = state.plan
    for path, act in zip(paths, acts, strict=True):
        plan = with_node(plan, path, replace(act, reading=name))
    return name, quantity, replace(state, plan=plan)


def _require_several(plan: p.InOrder, path: Path, act: p.Act) -> None:
    """Refuse a statistic of one reading, and one of the readings of each of several rows or places.

    Raises:
        NotComposed: It is one of those.
    """
    loops = [node for end in range(len(path)) if (node := node_at(plan, path[:end])).visits_each or node.rounds]
    if not loops and act.count < 2:
        raise NotComposed(message("there is only one reading", context="fault"))
    select = None if not loops or loops[-1].selector is None else loops[-1].selector
    if loops and act.count > 1:
        raise NotComposed(
            message("it is not clear whether the readings at each place are meant, or those at all", context="fault")
        )
    rows = () if select is None else select.members
    single = all((at := as_in_row(one)) is not None and at.first == at.last and is_one_row(at.of) for one in rows)
    by_rows = len(rows) > 1 and not single and all(any(is_one_row(part) for part in row.walk()) for row in rows)
    if by_rows or (select is not None and picks_per_row(select)):
        raise NotComposed(
            message("it is not clear whether the readings of each row are meant, or those of all", context="fault")
        )


# --- until ------------------------------------------------------------------------------------------------------------


def until_series(setting: Setting, state: DialogueState, tests: AllTests, said: Spans) -> DialogueState | None:
    """Return the state in which captures at one place are repeated until a test of all of them holds.

    None if the last captures are visits.
    """
    *before, last = state.block.steps or (None,)
    if last is None or last.act is None or state.loop is not None:
        return None
    act = last.act
    if act.count > 1:
        raise NotComposed(message("it is not clear whether so many are meant, or at most so many", context="fault"))
    drive = () if act.at is None else (p.GoTo(id="", place=act.at, said=act.at_said),)
    body = p.InOrder(id="", steps=(replace(act, at=None, at_said=()),))
    repeat = p.Repeat(id="", times=MOST_READINGS, body=body, said=said)
    block = replace(state.block, steps=(*before, *drive, repeat))
    path = (*state.scope, len(block.steps) - 1)
    state = replace(state, plan=with_node(state.plan, state.scope, block), captured=(*path, "body", 0))
    condition, state = until_condition(setting, state, tests, (*path, "body", 0))
    made = replace(cast(p.Repeat, node_at(state.plan, path)), until=condition)
    state = replace(state, plan=with_node(state.plan, path, made), ended_by=condition)
    return with_assumption(
        state, message("At most {count} readings are taken there.", context="assumption", count=MOST_READINGS)
    )


def until_condition(
    setting: Setting, state: DialogueState, tests: AllTests, path: Path
) -> tuple[c.Condition, DialogueState]:
    """Return the condition on the readings of a repeated capture so far, and the state that names them."""
    made: list[c.Condition] = []
    for test in tests.tests:
        if test.than is not None or test.place is not None or not _fits(node_at(state.plan, path), test, setting):
            raise NotComposed(message("it is not clear what ends then", context="fault"))
        one, state = condition_on(setting, state, test, (path,), tests.of_last)
        made.append(c.Not(condition=one) if test.negated else one)
    if len(made) == 1:
        return made[0], state
    return (c.AnyOf if tests.any_of else c.AllOf)(conditions=tuple(made)), state


def limited_rounds(state: DialogueState, count: int, said: Spans) -> DialogueState | None:
    """Return the state with a maximum number of rounds of the last repetition; None if there is none."""
    last = state.block.steps[-1] if state.block.steps else None
    if not isinstance(last, p.Repeat) or last.until is None:
        return None
    kept = tuple(text for text in state.assumed if text != _assumed_most())
    state = replace(state, assumed=kept)
    return with_last_step(
        state, replace(last, times=count, until=_with_least(last.until, count), said=(*last.said, *said))
    )


def _assumed_most() -> str:
    return message("At most {count} readings are taken there.", context="assumption", count=MOST_READINGS)


def _with_least(until: c.Condition, most: int) -> c.Condition:
    """Return a condition that needs no more readings than are taken."""
    if isinstance(until, MeanKnown):
        return replace(until, at_least=max(2, min(until.at_least, most)))
    return until


# --- places -----------------------------------------------------------------------------------------------------------


def is_by_reading(command: Command) -> bool:
    """Return True for a command at places that readings of the plan determine."""
    place = command.place if isinstance(command, CaptureCommand | DriveCommand) else None
    return place is not None and place.like is not None and place.like.kind == "read"


def with_read_place(setting: Setting, state: DialogueState, command: Command) -> tuple[DialogueState, Command]:
    """Return a command with a place that readings of the plan determine, and the state that names them.

    Raises:
        NotComposed: Which readings are meant is unclear.
    """
    place = command.place if isinstance(command, CaptureCommand | DriveCommand) else None
    if place is None or place.like is None or not is_by_reading(command):
        return state, command
    chosen = cast(s.ByReading, place.selector)
    quantity = chosen.quantity
    if action := setting.robot.action.get(quantity):
        quantity = action.measures[0] if len(action.measures) == 1 else ""
    area = None if place.per is None else PlaceMeaning(place.per, "area")
    test = Test(quantity, "gt", 0.0, place.like.side, of="maximum", place=area)
    try:
        paths = _paths(setting, state, test)
    except NotComposed as fault:
        raise _unmeasured(setting, quantity, place.like.side) from fault
    name, quantity, state = _named(setting, state, test, paths)
    known = replace(chosen, reading=name, quantity=quantity)
    made: Command = replace(cast(Any, command), place=replace(place, selector=known, like=None, per=None))
    return replace(state, loop=None), made


def _unmeasured(setting: Setting, quantity: str, unit: str) -> NotComposed:
    """Return the question for readings by which places could be chosen."""
    names = [name for name, one in setting.robot.quantity.items() if name == quantity or (unit and one.unit == unit)]
    if not names:
        return NotComposed(message("nothing before it measures that", context="fault"))
    return OpenQuestion(
        message(
            "{quantity} is not measured before that; at which places is it measured first?",
            context="question",
            quantity=say_name(names[0]),
        )
    )
