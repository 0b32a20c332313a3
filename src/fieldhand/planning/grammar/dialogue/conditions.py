"""Conditions, the other case, questions, and what ends a repetition."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.language.words import say_action
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.capturing import capture, capture_once
from fieldhand.planning.grammar.dialogue.driving import drive, visits
from fieldhand.planning.grammar.dialogue.fitting import is_spoken_of
from fieldhand.planning.grammar.dialogue.plans import (
    EMPTY,
    Path,
    as_choice,
    block_at,
    for_each_at,
    is_conditional,
    is_inside,
    last_capture,
    measured,
    node_at,
    walk,
    with_node,
)
from fieldhand.planning.grammar.dialogue.series import is_of_series, until_condition, until_series, when_series
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    Spans,
    done_at,
    with_assumption,
    with_joints,
    with_last_step,
    with_step,
)
from fieldhand.planning.grammar.dialogue.tested import TREE_TESTS, condition_of, reading_before, readings_at
from fieldhand.planning.grammar.meaning import (
    BATTERY_TEST,
    LATEST_READING,
    NTH_READING,
    SAME_THRESHOLD,
    AllTests,
    CaptureCommand,
    CaptureWhere,
    Check,
    Command,
    DriveCommand,
    Home,
    Lead,
    LinkedCommand,
    Otherwise,
    PassOn,
    PlaceMeaning,
    ReadingQuestion,
    StopCommand,
    Test,
    Thing,
    UntilCondition,
    When,
)
from fieldhand.planning.grammar.words import hinted_attributes
from fieldhand.planning.selections import are_several_rows, as_some
from fieldhand.robot.model import RobotProfile
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.frames import Then

#: Comparisons to the other side of a threshold, by comparison.
_OPPOSITES: Mapping[Check, tuple[Check, ...]] = {
    "lt": ("gt", "ge"),
    "le": ("gt", "ge"),
    "gt": ("lt", "le"),
    "ge": ("lt", "le"),
}
#: A threshold is of the size of a quantity if it is less than so many times as high or low as the quantity's levels.
_SIZES = 4


def _of_what_was_asked_for(state: DialogueState, tests: AllTests) -> AllTests:
    """Return tests of "it" as those of the statistic that was asked for ("get the average ..., and if that is ...").

    Raises:
        NotComposed: There is one of each row.
    """
    if not state.asked_for or tests.of_last or not any(_is_plain(one) for one in tests.tests):
        return tests
    if state.where is not None and are_several_rows(state.where.selector):
        raise NotComposed(message("it is not clear which of them", context="fault"))
    return replace(
        tests, tests=tuple(replace(one, of=state.asked_for) if _is_plain(one) else one for one in tests.tests)
    )


def _is_plain(test: Test) -> bool:
    """Return True for a test of one reading that says no more of it than its quantity."""
    named = test.attribute or test.of or test.setting or test.place is not None or test.than is not None
    return not named and (test.quantity == "" or test.quantity.isidentifier())


def when(setting: Setting, state: DialogueState, command: When, following: Sequence[LinkedCommand]) -> DialogueState:
    """Return the state after a condition.

    Args:
        setting: Robot and site that the request is read for.
        state: State before it.
        command: Condition.
        following: Further commands of its sentence.

    Raises:
        NotComposed: What is tested, or what depends on it, is unclear.
    """
    if command.asks and following and _is_answer(following[0].command):
        return with_joints(replace(state, asked=command.tests), setting.spans_of(command.used))
    decides_last = state.commands_in_sentence > 0 and (not following or isinstance(following[0].command, Otherwise))
    if command.terse and (decides_last or not following):
        raise NotComposed(message("it does not say what depends on it", context="fault"))
    command = replace(command, tests=_of_last_threshold(state, _of_quantity(setting, command.tests)))
    command = replace(command, tests=_of_what_was_asked_for(state, command.tests))
    latest = any(test.quantity == LATEST_READING for test in command.tests.tests)
    plain = (replace(test, quantity=test.quantity.replace(LATEST_READING, "")) for test in command.tests.tests)
    command = replace(command, tests=replace(command.tests, tests=tuple(plain)))
    tests = _for_each_place(state, command.tests, following)
    if is_of_series(state, tests):
        return when_series(setting, state, replace(command, tests=tests), following, decides_last=decides_last)
    if len(command.tests.tests) > 1:
        state = _measured_at_several(setting, state, command)
    if command.measured_at is not None:
        state, taken = readings_at(setting, state, command.tests.tests[0])
        if taken:
            known = setting.either("which reading is tested?", command.used, taken)
            return _of_reading_there(setting, state, command, known, following)
    if (place := command.measured_at) is not None:
        if decides_last:
            raise NotComposed(message("it does not say what depends on it", context="fault"))
        state = _at_tested_place(setting, state, command, place)
    if not command.tests.tests:
        if (
            command.affirms
            and state.asked is None
            and state.decided is not None
            and all(one.negated for one in state.decided.tests)
        ):
            return otherwise(setting, state, setting.spans_of(command.used))  # "unless it is high ..., if it is ..."
        if state.asked is None:
            raise NotComposed(message("it is not clear what has to be so", context="fault"))
        command = replace(command, tests=state.asked)
    if command.among == "visited" and state.loop is None:
        raise NotComposed(message("it is not clear which of them", context="fault"))
    command = replace(command, tests=_for_each_place(state, command.tests, following))
    said, robot = setting.spans_of(command.used), setting.robot
    if not decides_last and command.among != "area":
        state = _at_each_of_area(setting, state, command)
    vague = [test for test in command.tests.tests if not test.quantity and not test.attribute]
    state = _with_tested_thing(setting, state, command) if vague else state
    if not decides_last:
        state = _measured_here(setting, state, command)
    if decides_last:
        return _decide_last(setting, state, command, said)
    if state.awaits_command:
        return _only_some(state, command)
    if _is_opposite(state, command.tests):
        return otherwise(setting, state, said)
    inner = state.captured is not None and is_conditional(state.captured)
    if inner and state.decided is not None and any(not test.unit for test in vague):
        before = _capture_of_choice(state)
        ways: list[Path] = [state.captured, before] if state.captured is not None and before is not None else []
        if not ways:
            raise NotComposed(message("nothing before it measures that", context="fault"))
        ways = [path for path in ways if _may_be_of(state, path, command.tests, robot)] or ways
        if before in ways and _is_other_end(state.decided, command.tests):
            ways = [before]  # "if it is low, read the air temperature; if it is high, read CO2"
        elif latest:
            ways = [way for way in ways if way != before] or ways
        state = replace(state, captured=setting.either("which reading is tested?", command.used, ways))
    if all(test.quantity == BATTERY_TEST for test in command.tests.tests):
        state = _behind_visits(state, following)
    return _choice(setting, state, command, said)


def _is_answer(command: Command) -> bool:
    """Return True for "if so" and "otherwise"."""
    return isinstance(command, Otherwise) or (isinstance(command, When) and not command.tests.tests)


def _of_last_threshold(state: DialogueState, tests: AllTests) -> AllTests:
    """Return tests with the threshold that was said last for "below that" and "lower".

    Raises:
        NotComposed: There is none, or the test is not the opposite of the last one.
    """
    if not any(test.value == SAME_THRESHOLD for test in tests.tests):
        return tests
    last = None if state.decided is None or len(state.decided.tests) != 1 else state.decided.tests[0]
    test = tests.tests[0]
    denies = (
        last is not None and last.check == test.check and last.negated
    )  # "unless it is above 35 ...; if it is above"
    opposites = (test.check,) if test.negated else _OPPOSITES.get(test.check, ())  # "under 15? ...; not under? ..."
    opposes = last is not None and last.check in opposites and not last.negated
    if last is None or len(tests.tests) > 1 or not (denies or opposes):
        raise NotComposed(message("it is not clear with what it is compared", context="fault"))
    return AllTests((replace(last, negated=opposes),))


def _is_other_end(last: AllTests, tests: AllTests) -> bool:
    """Return True if a test is of the other end of the scale than the last one: high after low, above after below."""
    if len(last.tests) != 1 or len(tests.tests) != 1:
        return False
    one, other = last.tests[0], tests.tests[0]
    if one.check == other.check == "level":
        return one.value != other.value and not one.negated and not other.negated
    return one.check in _OPPOSITES.get(other.check, ()) and not one.negated and not other.negated


def _may_be_of(state: DialogueState, path: Path, tests: AllTests, robot: RobotProfile) -> bool:
    """Return True if the thresholds of tests are of the size of what a capture measures."""
    act = node_at(state.plan, path).act
    measures = () if act is None else measured(robot, act.action)
    return bool(measures) and all(_is_plausible(test, measures[0], robot) for test in tests.tests)


def _is_plausible(test: Test, quantity: str, robot: RobotProfile) -> bool:
    """Return True if a threshold is of the size of a quantity's levels, as far as the profile has some."""
    levels = [level.value for level in robot.quantity[quantity].levels.values()]
    if not levels or test.check == "level":
        return True
    values = test.value if isinstance(test.value, tuple) else (test.value,)
    return all(min(levels) / _SIZES <= value <= max(levels) * _SIZES for value in values)


def _at_each_of_area(setting: Setting, state: DialogueState, command: When) -> DialogueState:
    """Return the state at each tree of the area before a condition, where the condition is on each by itself.

    "Go along row 4 and if a tree is yellow, ..." and "at each tree of row 4, if the CO2 is high, ...".
    """
    before, tests = state.area or state.lead, command.tests.tests
    if before is None or before.place.per is not None or (isinstance(before, Lead) and before.relation == "topic"):
        return state
    if before.place.shape not in ("area", "several") or not all(test.attribute or test.quantity for test in tests):
        return state
    place = replace(before.place, shape="several", each=True)
    inside = (*state.next_step, "body")
    state = with_step(replace(state, area=None, lead=None), visits(place, setting.spans_of(before.used)))
    return replace(done_at(state, place), loop=inside)


def _only_some(state: DialogueState, command: When) -> DialogueState:
    """Return the state in which only some trees of the area are meant ("along row 3, wherever a tree is yellow")."""
    before, test = state.area or state.lead, command.tests.tests[0]
    if command.among != "area" or before is None or before.place.shape != "area" or before.place.per is not None:
        raise NotComposed(message("the condition comes before what is done there", context="fault"))
    if len(command.tests.tests) > 1 or not test.attribute or (test.negated and test.check != "eq"):
        raise NotComposed(message("the condition comes before what is done there", context="fault"))
    check = "ne" if test.negated else TREE_TESTS[test.check]
    some = s.Where(attribute=test.attribute, test=check, value=test.value, of=before.place.selector)
    place = PlaceMeaning(some, "several", each=True)
    return replace(state, area=None, lead=Lead(place, before.used | command.used))


def captured_where(setting: Setting, state: DialogueState, command: CaptureWhere) -> DialogueState:
    """Return the state after captures at those of the last places where a reading passes a test.

    Raises:
        NotComposed: No reading was taken at several places.
    """
    if state.ended_by is not None or state.order is not None:
        raise NotComposed(message("it is not clear which of those", context="fault"))
    command = replace(command, tests=_of_quantity(setting, command.tests))
    command = replace(command, tests=_named_quantity(setting, command))
    of_trees = all(test.attribute for test in command.tests.tests)
    state = state if of_trees else _measured_at_each(setting, state, command)
    known = state.captured is not None and is_inside(state.captured, state.loop or ())
    if (state.loop is None and not (of_trees and state.awaits_command)) or not (known or of_trees):
        raise NotComposed(message("it is not clear which of those", context="fault"))
    if of_trees and _chosen_by(state, {test.attribute for test in command.tests.tests}):
        raise NotComposed(
            message("it is not clear which of those", context="fault")
        )  # the yellow trees, the green ones
    scope, said = state.scope, command.used & ~command.capture.used
    clause = LinkedCommand(None, command.capture)
    state = when(setting, replace(state, commands_in_sentence=0), When(command.tests, said), (clause,))
    loop = state.loop
    state = capture(setting, state, command.capture)
    done = state.commands_in_sentence + 1
    return replace(state, scope=scope, loop=loop, commands_in_sentence=done)


def _named_quantity(setting: Setting, command: CaptureWhere) -> AllTests:
    """Return a test of trees that are measured first with what is measured, which may be each quantity of its unit."""
    tests = command.tests.tests
    if command.area is None or len(tests) != 1 or tests[0].quantity or tests[0].attribute or not tests[0].unit:
        return command.tests
    if tests[0].check == "level":
        return command.tests  # "hot" of the air, or of the canopy?
    known = dict.fromkeys(name for action in setting.robot.actions for name in action.measures)
    names = [name for name in known if setting.robot.quantity[name].unit == tests[0].unit]
    if not names:
        return command.tests
    name = setting.either("what is measured?", command.used, names)
    return replace(command.tests, tests=(replace(tests[0], quantity=name),))


def _chosen_by(state: DialogueState, attributes: set[str]) -> bool:
    """Return True if the places of the last for-each were chosen by one of some attributes."""
    chosen = None if state.loop is None else for_each_at(state.plan, state.loop[:-1]).select
    return chosen is not None and any(getattr(part, "attribute", "") in attributes for part in chosen.walk())


def _measured_here(setting: Setting, state: DialogueState, command: When) -> DialogueState:
    """Return the state after the reading that a condition names was taken where the robot was sent, if it was not yet.

    "Go to tree 5. If the CO2 is high, ..." takes it at tree 5.
    """
    tests = command.tests.tests
    quantities = {test.quantity for test in tests}
    action = setting.action_measuring(next(iter(quantities))) if len(quantities) == 1 else None
    steps = state.block.steps
    if action is None or command.measured_at is not None or command.tests.of_last or not steps:
        return state
    visited = state.loop is not None and block_at(state.plan, state.loop) == EMPTY
    if not (visited or steps[-1].only_drives) or any(_measures(node, action) for _, node in walk(state.plan)):
        return state
    state = _assumed_first(setting, state, action, command.used)
    return capture(setting, state, CaptureCommand((Thing(action),), None, command.used))


def _assumed_first(setting: Setting, state: DialogueState, action: str, used: int) -> DialogueState:
    """Return the state after it was assumed that a reading is taken where a condition asks for it.

    Raises:
        OpenQuestion: The words may as well mean what the site records of its plants.
    """
    said = setting.quoted(used).lower()
    for name in setting.robot.action[action].measures if action in setting.robot.action else ():
        recorded = hinted_attributes(name.rpartition("_")[2], setting.site)
        own = [word for word in setting.robot.quantity[name].words if word not in recorded]
        if recorded and not any(word in said for word in own):
            raise OpenQuestion(
                message(
                    "'{said}': is the value that the site records meant, or one that is measured first?",
                    context="question",
                    said=setting.quoted(used),
                )
            )
    first = message(
        "'{said}' is measured first ({action}), there.",
        context="assumption",
        said=setting.quoted(used),
        action=say_action(action, 1),
    )
    return with_assumption(state, first)


def _measures(node: p.Node, action: str) -> bool:
    """Return True for a capture by an action."""
    return node.act is not None and node.act.action == action


def _of_quantity(setting: Setting, tests: AllTests) -> AllTests:
    """Return tests of what an action measures, where they name the action ("in the thermal picture").

    Raises:
        NotComposed: The action measures nothing, or several quantities.
    """
    made = []
    for test in tests.tests:
        action = setting.robot.action.get(test.quantity)
        if action is not None and len(action.measures) != 1:
            raise NotComposed(message("nothing before it measures that", context="fault"))
        made.append(test if action is None else replace(test, quantity=action.measures[0]))
    return replace(tests, tests=tuple(made))


def _measured_at_each(setting: Setting, state: DialogueState, command: CaptureWhere) -> DialogueState:
    """Return the state after the reading that a test needs was taken at each of the places that were named for it.

    Raises:
        NotComposed: The places are others than the last ones, and the reading is not named.
    """
    area = command.area
    if area is None and not state.awaits_command:
        return state
    if (
        area is not None
        and state.loop is not None
        and state.where is not None
        and area.selector == state.where.selector
    ):
        return state
    action = setting.action_measuring(command.tests.tests[0].quantity)
    if action is None or (area is not None and state.awaits_command):
        raise NotComposed(message("it is not clear what is measured, and where", context="fault"))
    place = area if area is not None else PlaceMeaning(s.Trees(), "several", each=True)
    state = _assumed_first(setting, state, action, command.used)
    return capture(setting, state, CaptureCommand((Thing(action, plural=True),), place, command.used))


def _decide_last_at_each(setting: Setting, state: DialogueState, command: When, said: Spans) -> DialogueState | None:
    """Return the state in which a reading taken at each of several places decides the last captures there.

    None if the last captures are the first ones there.
    """
    body = state.loop
    if body is None or body[:-1] != (*state.scope, len(state.block.steps) - 1):
        return None
    steps, number = block_at(state.plan, body).steps, len(state.things)
    if len(steps) <= number or any(step.act is None for step in steps):
        return None
    tested = (*body, len(steps) - number - 1)
    tests = command.tests
    if len(steps) == number + 1:  # "a second reading whenever the first is below 400 ppm"
        one_of = {f"{NTH_READING}1": ""}
        tests = replace(
            tests, tests=tuple(replace(test, quantity=one_of.get(test.quantity, test.quantity)) for test in tests.tests)
        )
    condition, state = condition_of(setting, replace(state, captured=tested), tests)
    if state.captured != tested:
        raise NotComposed(message("nothing before it measures that", context="fault"))
    steps = block_at(state.plan, body).steps
    choice = p.If(id="", condition=condition, then=p.InOrder(id="", steps=steps[-number:]), said=said)
    plan = with_node(state.plan, body, p.InOrder(id="", steps=(*steps[:-number], choice)))
    path = (*body, len(steps) - number)
    return replace(state, plan=plan, choice=path, decided=command.tests, tested_at=(state.where, state.where_scope))


def _with_tested_thing(setting: Setting, state: DialogueState, command: When) -> DialogueState:
    """Return the state in which "it" is the chosen one of several readings that were taken at once."""
    measuring = [thing for thing in state.things if measured(setting.robot, thing.action)]
    if len(measuring) < 2:
        return state
    thing = setting.either("which reading is tested?", command.used, measuring)
    taken = [
        path
        for path, node in walk(state.plan)
        if node.act is not None and node.act.action == thing.action and path[:-1] == (state.captured or ())[:-1]
    ]
    if not taken:
        raise NotComposed(message("nothing before it measures that", context="fault"))
    return replace(state, captured=taken[-1])


def _capture_of_choice(state: DialogueState) -> Path | None:
    """Return the path of the capture that the last condition tests."""
    choice = None if state.choice is None else as_choice(node_at(state.plan, state.choice))
    reading = "" if choice is None else getattr(choice.condition, "reading", "")
    return next((path for path, node in walk(state.plan) if node.act and reading and node.act.reading == reading), None)


def _for_each_place(state: DialogueState, tests: AllTests, following: Sequence[LinkedCommand]) -> AllTests:
    """Return tests of any of several readings as tests of each, where what depends on them is done at that place."""
    command = following[0].command if following else None
    there = isinstance(command, CaptureCommand) and command.place is not None and command.place.shape == "here"
    if tests.of_last == "any" and state.loop is not None and there:
        return replace(tests, of_last="")
    places = {node.act.at for _, node in walk(state.plan) if node.act is not None and node.act.at is not None}
    spoken_of = isinstance(command, CaptureCommand) and is_spoken_of(command.place)
    if tests.of_last == "any" and state.loop is None and spoken_of and len(places) > 1:
        # "at tree 4 and at tree 9 ...; if either one is low, a picture there": at that one
        raise NotComposed(message("it is not clear at which of them this is done", context="fault"))
    return tests


def _choice(setting: Setting, state: DialogueState, command: When, said: Spans) -> DialogueState:
    """Return the state in which the next commands depend on tests."""
    tests = command.tests
    condition, state = condition_of(setting, state, tests)
    tested = None if state.captured is None else node_at(state.plan, state.captured).act
    if tested is not None and any(test.setting for test in tests.tests):
        state = replace(state, things=(Thing(tested.action, parameters=tested.parameters),))  # "at the same depth"
    scope = _scope_of_test(setting, state, command)
    path = (*scope, len(block_at(state.plan, scope).steps))
    state = with_step(replace(state, scope=scope), p.If(id="", condition=condition, then=EMPTY, said=said))
    tested_at = (state.where, state.where_scope)
    return replace(state, scope=(*path, "then"), choice=path, decided=tests, open=True, tested_at=tested_at)


def _behind_visits(state: DialogueState, following: Sequence[LinkedCommand]) -> DialogueState:
    """Return the state in which the battery is tested behind the visits, unless more is done at each of them."""
    then = following[0].command if following else None
    at_each = isinstance(then, CaptureCommand) and is_spoken_of(then.place)
    at_each = at_each or any(isinstance(one.command, StopCommand | PassOn | Home) for one in following)
    return state if at_each else replace(state, loop=None, captured=None)


def _scope_of_test(setting: Setting, state: DialogueState, command: When) -> Path:
    """Return the block in which the tested capture stands: the condition comes behind it.

    Raises:
        NotComposed: Which tree is tested is unclear.
    """
    if all(test.attribute for test in command.tests.tests):
        return _scope_at_tree(setting, state, command)
    if state.open and state.scope[-1:] == ("otherwise",) and is_inside(state.scope, (state.captured or ())[:-1]):
        return state.scope  # "otherwise, if it is low, ..."
    if state.captured is not None:
        return state.captured[:-1]
    return state.loop if state.loop is not None else state.scope


def _scope_at_tree(setting: Setting, state: DialogueState, command: When) -> Path:
    """Return the block of a condition on the tree: that of the visit, and not of a condition before it."""
    around = state.loop if state.loop is not None else ()
    scope = state.scope if is_inside(state.scope, around) else around
    if state.where_scope is not None and not is_inside(scope, state.where_scope) and is_conditional(state.where_scope):
        raise NotComposed(message("it is not clear which tree is meant", context="fault"))
    ways = [scope, around] if is_conditional(scope[len(around) :]) else [scope]
    return setting.either("in that case only, or in each?", command.used, ways)


def _decide_last(setting: Setting, state: DialogueState, command: When, said: Spans) -> DialogueState:
    """Return the state in which a condition decides the last command."""
    steps, robot = state.block.steps, setting.robot
    if not steps:
        raise NotComposed(message("nothing depends on the condition", context="fault"))
    if (measured := _measured_before_last(setting, state, command, said)) is not None:
        return measured
    inside = (*state.scope, len(steps) - 1)
    if (at_each := _decide_last_at_each(setting, state, command, said)) is not None:
        return at_each
    if (ended := _home_from_visits(setting, state, command, said)) is not None:
        return ended
    state = replace(state, captured=reading_before(state.plan, inside, robot))
    condition, state = condition_of(setting, state, command.tests)
    if all(test.attribute for test in command.tests.tests):
        return _decide_last_at_tree(state, condition, said)
    if state.captured is None or is_inside(state.captured, inside):
        raise NotComposed(message("nothing before it measures that", context="fault"))
    last = p.InOrder(id="", steps=state.block.steps[-1:])
    state = with_last_step(state, p.If(id="", condition=condition, then=last, said=said))
    return replace(state, choice=inside, decided=command.tests, loop=None, tested_at=(state.where, state.where_scope))


def _home_from_visits(setting: Setting, state: DialogueState, command: When, said: Spans) -> DialogueState | None:
    """Return the state in which a reading at one of several places ends the visits ("... and come home if it is hot").

    None if the last command is no return, or the reading was not taken at each of the places before it.
    """
    *before, last = state.block.steps
    marker = last.selector.named_marker if last.only_drives and last.selector is not None else ""
    if marker not in ("start", "end") or not before or not before[-1].visits_each or state.scope:
        return None
    visits = (len(before) - 1,)
    reading = reading_before(state.plan, (len(before),), setting.robot)
    if reading is None or not is_inside(reading, visits):
        return None
    plan = replace(state.plan, steps=tuple(before))
    condition, state = condition_of(setting, replace(state, plan=plan, captured=reading), command.tests)
    loop = for_each_at(state.plan, visits)
    plan = with_node(state.plan, visits, replace(loop, until=condition, said=(*loop.said, *said)))
    nominal: Then = "return_to_start" if marker == "start" else "return_to_end"
    return replace(state, plan=plan, nominal=nominal, nominal_said=last.said, loop=None, ended_by=condition)


def _of_reading_there(
    setting: Setting, state: DialogueState, command: When, known: Path, following: Sequence[LinkedCommand]
) -> DialogueState:
    """Return the state after a condition on a reading that was taken at another place ("if tree 31 was high, ...")."""
    said, place = setting.spans_of(command.used), command.measured_at
    is_last = known == last_capture(state.plan)
    places = [step.selector for step in state.plan.steps[: int(known[0]) + 1] if step.selector is not None]
    place = None if place is None else replace(place, selector=places[-1], like=None)
    state = replace(state, captured=known, loop=None)
    if state.commands_in_sentence and (not following or isinstance(following[0].command, Otherwise)):
        return _decided_by(setting, state, command, said)
    state = _choice(setting, replace(state, scope=()), command, said)
    then = following[0].command if following else None
    at = then.place if isinstance(then, CaptureCommand) else None
    goes_there = at is not None and is_spoken_of(at) and at.shape != "those" and not is_last
    if isinstance(then, CaptureCommand) and then.place is None and not is_last:
        goes_there = setting.either("there, or where the robot is?", then.used, (True, False))
    return replace(state, lead=Lead(place, command.used)) if goes_there and place is not None else state


def _decided_by(setting: Setting, state: DialogueState, command: When, said: Spans) -> DialogueState:
    """Return the state in which a reading at another place decides the last command ("..., but only if 31 was high").

    Raises:
        NotComposed: That reading was not taken before the command.
    """
    condition, state = condition_of(setting, state, command.tests)
    steps = state.block.steps
    drives = len(steps) > 1 and steps[-2].only_drives and steps[-2].said == steps[-1].said
    first = len(steps) - (2 if drives else 1)
    if state.scope or state.captured is None or is_inside(state.captured, (first,)):
        raise NotComposed(message("nothing before it measures that", context="fault"))
    choice = p.If(id="", condition=condition, then=p.InOrder(id="", steps=steps[first:]), said=said)
    plan = replace(state.plan, steps=(*steps[:first], choice))
    made = replace(state, plan=plan, choice=(first,), decided=command.tests, loop=None)
    return replace(made, tested_at=(state.where, state.where_scope))


def _measured_before_last(setting: Setting, state: DialogueState, command: When, said: Spans) -> DialogueState | None:
    """Return the state in which a reading that was not taken yet is taken first, and decides the last captures.

    "Measure CO2 at tree 30 only if the canopy temperature is above 36 degC." None if the reading was taken already.
    """
    quantities = {test.quantity for test in command.tests.tests}
    action = setting.action_measuring(next(iter(quantities))) if len(quantities) == 1 else None
    *rest, last = state.block.steps
    if action is None or command.tests.of_last or any(_measures(node, action) for _, node in walk(state.plan)):
        return None
    if (
        last.visits_each
        and last.children
        and last.children[0].children
        and all(step.act for step in last.children[0].children)
    ):
        place, body = None, last.children[0]
        inside: Path = (*state.scope, len(rest), "body")
    elif last.act is not None and len(state.things) == 1 and (last.act.at is not None or state.where is not None):
        place, body = last.act, p.InOrder(id="", steps=(replace(last.act, at=None, at_said=()),))
        inside = state.scope
    else:
        return None
    state = _assumed_first(setting, state, action, command.used)
    first = p.Act(id="", action=action, count=1, parameters=(), said=said)
    if place is not None:
        first = replace(first, at=place.at, at_said=place.at_said)
        path: Path = (*inside, len(rest))
        plan = with_node(state.plan, state.scope, p.InOrder(id="", steps=(*rest, first)))
    else:
        path = (*inside, 0)
        plan = with_node(state.plan, inside, p.InOrder(id="", steps=(first,)))
    condition, state = condition_of(setting, replace(state, plan=plan, captured=path), command.tests)
    block = block_at(state.plan, inside)
    choice = p.If(id="", condition=condition, then=body, said=said)
    plan = with_node(state.plan, inside, replace(block, steps=(*block.steps, choice)))
    made = replace(state, plan=plan, choice=(*inside, len(block.steps)), decided=command.tests)
    return replace(made, tested_at=(state.where, state.where_scope))


def _decide_last_at_tree(state: DialogueState, condition: c.Condition, said: Spans) -> DialogueState:
    """Return the state in which a condition on the tree decides the last capture, at the tree or at each of several."""
    *rest, last = state.block.steps
    if last.visits_each and last.children:
        choice = p.If(id="", condition=condition, then=last.children[0], said=said)
        steps: tuple[p.Node, ...] = (*rest, last.with_children([p.InOrder(id="", steps=(choice,))]))
        path: Path = (*state.scope, len(rest), "body", 0)
    elif last.act is not None and last.act.at is not None and as_some(last.act.at) is not None:
        return _decide_last_at_tree(_each_of_area(state), condition, said)
    elif last.act is not None and last.act.at is not None:
        here = replace(last.act, at=None, at_said=())
        choice = p.If(id="", condition=condition, then=p.InOrder(id="", steps=(here,)), said=said)
        steps = (*rest, p.GoTo(id="", place=last.act.at, said=last.act.at_said), choice)
        path = (*state.scope, len(rest) + 1)
    else:
        raise NotComposed(message("it is not clear which tree is meant", context="fault"))
    plan = with_node(state.plan, state.scope, p.InOrder(id="", steps=steps))
    return replace(state, plan=plan, choice=path, decided=None, loop=None, captured=None)


def _each_of_area(state: DialogueState) -> DialogueState:
    """Return the state after the last capture at each tree of the area that the robot was sent along.

    "Drive along row 5 and take a picture if the vine is a Merlot", "go down row 4 measuring CO2 until it is high".

    Raises:
        NotComposed: It is no capture in such an area.
    """
    *rest, last = state.block.steps
    some = None if last.act is None or last.act.at is None else as_some(last.act.at)
    if last.act is None or some is None or some.count != 1 or some.of != state.within or len(state.things) != 1:
        raise NotComposed(message("it is not clear which tree is meant", context="fault"))
    body = p.InOrder(id="", steps=(replace(last.act, at=None, at_said=()),))
    each = p.ForEach(id="", select=some.of, body=body, said=last.act.at_said)
    plan = with_node(state.plan, state.scope, p.InOrder(id="", steps=(*rest, each)))
    inside = (*state.scope, len(rest), "body")
    return replace(state, plan=plan, loop=inside, captured=(*inside, 0), where=PlaceMeaning(some.of, "several"))


def _is_opposite(state: DialogueState, tests: AllTests) -> bool:
    """Return True if a test is the last one negated: its commands are the other case."""
    last = state.decided
    if last is None or state.choice is None or len(tests.tests) != 1 or len(last.tests) != 1:
        return False
    one, other = tests.tests[0], last.tests[0]
    negated = replace(other, negated=not other.negated, quantity=one.quantity, place=one.place, setting=one.setting)
    return one == negated and one.quantity in ("", other.quantity) and one.place in (None, other.place)


def ends_among_visits(state: DialogueState) -> bool:
    """Return True if the last condition decides in each of several visits that the mission ends there."""
    if state.choice is None:
        return False
    choice = as_choice(node_at(state.plan, state.choice))
    visits = any(node_at(state.plan, state.choice[:end]).visits_each for end in range(len(state.choice)))
    ends = choice is not None and bool(choice.then.children) and choice.then.children[-1].ends_plan
    return visits and ends


def otherwise(setting: Setting, state: DialogueState, said: Spans, *, in_all: bool = False) -> DialogueState:
    """Return the state in which the next commands are done if the last condition is false.

    Args:
        setting: Robot and site that the request is read for.
        state: State before it.
        said: Words that say so.
        in_all: True if every condition before it is false ("in all other cases").

    Raises:
        NotComposed: To which condition it belongs is unclear.
    """
    if state.choice is None and state.asked is not None:
        test = state.asked.tests[0]
        opposite = AllTests((replace(test, negated=not test.negated),))
        return when(setting, with_joints(replace(state, asked=None), said), When(opposite, 0), ())
    choice = None if state.choice is None else as_choice(node_at(state.plan, state.choice))
    if state.choice is None or choice is None or choice.otherwise is not None:
        raise NotComposed(message("to which 'if' does it belong?", context="fault"))
    steps, number = block_at(state.plan, state.choice[:-1]).steps, state.choice[-1]
    case, branch = state.choice, "otherwise"
    both = replace(choice, otherwise=EMPTY, said=(*choice.said, *said))
    if choice.then == EMPTY:  # "if it is low, leave it, otherwise ..."
        both, branch = replace(both, condition=_denied(choice.condition), otherwise=None), "then"
    plan = with_node(state.plan, state.choice, both)
    if isinstance(number, int) and number > 0 and steps[number - 1].is_choice:
        before = as_choice(steps[number - 1])
        if not in_all or before is None or before.otherwise is not None or number != len(steps) - 1:
            raise NotComposed(message("to which 'if' does it belong?", context="fault"))
        nested = replace(before, otherwise=p.InOrder(id="", steps=(both,)))
        plan = with_node(plan, state.choice[:-1], p.InOrder(id="", steps=(*steps[: number - 1], nested)))
        case = (*state.choice[:-1], number - 1, "otherwise", 0)
    tested = _capture_of_choice(state)  # what was captured in the first case was not in this one
    where, where_scope = state.tested_at  # the robot stands where it was when the condition was tested
    return replace(
        state,
        plan=plan,
        choice=case,
        scope=(*case, branch),
        open=True,
        loop=_loop_around(state),
        captured=state.captured if tested is None else tested,
        where=where,
        where_scope=where_scope,
    )


def _denied(condition: c.Condition) -> c.Condition:
    """Return the condition that is true where another one is not."""
    return condition.condition if isinstance(condition, c.Not) else c.Not(condition=condition)


def pass_on(setting: Setting, state: DialogueState, command: PassOn) -> DialogueState:
    """Return the state after a case in which nothing is done.

    Raises:
        NotComposed: It is said of no case, and of none of several places.
    """
    if command.to_next and state.loop is None:
        raise NotComposed(message("it is not clear which one is next", context="fault"))
    return replace(in_no_case(state, setting.spans_of(command.used)), open=False)


def in_no_case(state: DialogueState, said: Spans) -> DialogueState:
    """Return the state after words of the last condition on which nothing depends.

    Raises:
        NotComposed: There is no condition.
    """
    choice = None if state.choice is None else as_choice(node_at(state.plan, state.choice))
    if state.choice is None or choice is None:
        raise NotComposed(message("to which 'if' does it belong?", context="fault"))
    rest = None if choice.otherwise == EMPTY else choice.otherwise
    more = replace(choice, otherwise=rest, said=(*choice.said, *said))
    return replace(state, plan=with_node(state.plan, state.choice, more))


def _loop_around(state: DialogueState) -> Path | None:
    """Return the body of the last for-each if the condition stands in it; places of the other case are not meant."""
    return state.loop if state.loop is not None and is_inside(state.choice or (), state.loop) else None


def until(setting: Setting, state: DialogueState, command: UntilCondition) -> DialogueState:
    """Return the state in which readings taken in the last for-each, or the readings at one place, end it."""
    tests = _of_quantity(setting, command.tests)
    of_several = tests.of_series or tests.at_least > 0
    if of_several and state.within is None:
        said = setting.spans_of(command.used)
        if (repeated := until_series(setting, state, tests, said)) is not None:
            return repeated
    if state.loop is None and state.within is not None and state.block.steps:
        state = _each_of_area(state)
    if state.loop is None or state.captured is None or not is_inside(state.captured, state.loop):
        raise NotComposed(message("it is not clear what ends then", context="fault"))
    path = state.loop[:-1]
    if of_several:
        condition, state = until_condition(setting, state, tests, state.captured)
    else:
        tests = replace(tests, of_last="")
        if command.tests.of_last not in ("", "any"):
            raise NotComposed(message("it is not clear what ends then", context="fault"))
        condition, state = condition_of(setting, state, tests)
    loop = for_each_at(state.plan, path)
    said = (*loop.said, *setting.spans_of(command.used))
    plan = with_node(state.plan, path, replace(loop, until=condition, said=said))
    return replace(state, plan=plan, ended_by=condition)


def question(setting: Setting, state: DialogueState, command: ReadingQuestion) -> DialogueState:
    """Return the state after the reading that a question is about; "if so" tests it."""
    action = setting.action_measuring(command.tests.tests[0].quantity)
    if action is None:
        raise NotComposed(message("it is not clear what is measured", context="fault"))
    state = capture(setting, state, CaptureCommand((Thing(action),), command.place, command.used))
    return replace(state, asked=command.tests)


def _at_tested_place(setting: Setting, state: DialogueState, command: When, place: PlaceMeaning) -> DialogueState:
    """Return the state at the place that a condition names, after its reading was taken if one is tested."""
    if command.tests.tests[0].attribute:
        return drive(setting, state, DriveCommand(place, command.used))
    return _measured(setting, state, command.tests.tests[0].quantity, place, command.used)


def _measured_at_several(setting: Setting, state: DialogueState, command: When) -> DialogueState:
    """Return the state after the readings of a condition were taken at each of its places, as far as they were not."""
    for test in command.tests.tests:
        state, taken = readings_at(setting, state, test)
        if test.place is not None and not taken:
            state = replace(_measured(setting, state, test.quantity, test.place, command.used), where=None)
    return state


def _measured(setting: Setting, state: DialogueState, quantity: str, place: PlaceMeaning, used: int) -> DialogueState:
    """Return the state after the reading that a condition asks for, at a place of its own."""
    action = setting.action_measuring(quantity)
    if action is None or place.shape != "one":
        raise NotComposed(message("it is not clear what is measured, and where", context="fault"))
    said = setting.spans_of(used)
    state = _assumed_first(setting, state, action, used)
    return capture_once(state, CaptureCommand((Thing(action),), place, used), place, said, said)
