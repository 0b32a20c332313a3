"""Constructions of the parameters that a robot's profile declares for its actions: a depth, a view."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from fieldhand.planning.english.naming import Naming
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    DEFAULT_VALUE,
    LAST_THING,
    OPEN_VALUE,
    SAME_VALUE,
    UNSAID_THING,
    Amount,
    CaptureCommand,
    DriveCommand,
    Home,
    InAnOrder,
    Lead,
    LimitClause,
    LinkedCommand,
    ParameterValue,
    Said,
    StopCommand,
    Thing,
    VisitLimit,
    WayRule,
    When,
    WorkCommand,
)
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import Parameter, RobotProfile

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Values that are no choices of a parameter.
_NO_CHOICES = (SAME_VALUE, DEFAULT_VALUE, OPEN_VALUE)
#: Commands without captures inside them.
_PLAIN = (
    CaptureCommand | DriveCommand | Home | InAnOrder | Lead | LimitClause | StopCommand | VisitLimit | WayRule | When
)
#: Units of parameters by the unit of an amount, each with its size in that unit.
_SIZES: Mapping[str, Mapping[str, float]] = {
    "metres": {"m": 1.0, "cm": 0.01, "mm": 0.001},
    "seconds": {"s": 1.0, "ms": 0.001, "min": 60.0, "h": 3600.0},
    "percent": {"%": 1.0, "percent": 1.0},
    "degC": {"degC": 1.0, "°C": 1.0, "C": 1.0},
}


@construction(
    "parameter: word=AT amount=amount",
    "parameter: word=AT amount=amount name=PARAMETER",
    "parameter: amount=amount name=PARAMETER",
    "parameter: amount=amount DOWNTO",
    "parameter: word=AT [DET] name=PARAMETER OF amount=amount",
    cost=0.2,
)
def parameter(amount: Amount, word: Lex | None = None, name: Lex | None = None) -> ParameterValue | None:
    """Compose "at 30 cm", "25 cm deep" and "at a depth of 40 cm"."""
    if word is not None and "setting" not in word.features:
        return None
    return ParameterValue(amount.number, amount.unit, () if name is None else tuple(name.value))


@construction(
    "setting: [WITH] [DET] name=PARAMETER [COMMA] [OF] amount=amount",
    "setting: [DET] name=PARAMETER IS amount=amount",
    "setting: [DET] name=PARAMETER SHOULD amount=amount",
    "setting: [WITH] [DET] name=PARAMETER [COMMA] [OF] [DET] choice=CHOICE",
    "setting: [WITH] [DET] choice=CHOICE [DASH] name=PARAMETER",
    "setting: USE [DET] choice=CHOICE [DASH] name=PARAMETER",
    "setting: in_ [DET] choice=CHOICE [DASH] name=PARAMETER",
    "setting: word=AT [DET] DEFAULTWORD name=PARAMETER",
    "setting: [WITH] [DET] DEFAULTWORD name=PARAMETER",
    "setting: how=setting REMAINS",
    cost=0.1,
)
def setting(
    name: Lex | None = None,
    amount: Amount | None = None,
    choice: Lex | None = None,
    word: Lex | None = None,
    how: ParameterValue | None = None,
) -> list[ParameterValue] | None:
    """Compose "depth: 10 cm", "view: ground" and "standard depth", which name the parameter."""
    if name is None or (word is not None and "setting" not in word.features):
        return None if how is None else [how]
    names = tuple(name.value)
    if choice is not None:
        return [value for value in chosen(choice) if value.names[0] in names] or None
    return [ParameterValue(amount.number, amount.unit, names) if amount else ParameterValue(DEFAULT_VALUE, "", names)]


@construction(
    "pushed: PUSHPROBE [PROBEDOWN] amount=amount",
    "pushed: PUSHPROBE amount=amount DOWNTO",
    "pushed: PUSHPROBE amount=amount name=PARAMETER",
    "pushed: PUSHPROBE [PROBEDOWN] [DET] name=PARAMETER OF amount=amount",
    cost=0.1,
)
def pushed(amount: Amount, name: Lex | None = None) -> ParameterValue | None:
    """Compose "push the probe down to 25 cm"."""
    names = () if name is None else tuple(name.value)
    return ParameterValue(amount.number, amount.unit, names) if amount.unit == "metres" else None


@construction("pushed: MEASURE [IT] how=parameter", "pushed: MEASURE EACH how=parameter", cost=0.1)
@construction("pushed: TAKE [EACH] READING how=parameter", "pushed: TAKE IT how=parameter", cost=0.1)
@construction("pushed: MEASURE [EACH] READING how=parameter", cost=0.1)
def measured_down_to(how: ParameterValue) -> ParameterValue | None:
    """Compose "probe 15 cm deep" behind what is measured."""
    return how if how.unit == "metres" and not isinstance(how.value, str) else None


@construction(
    "rough_depth: ROUGHDEPTH", "rough_depth: [BITMORE] DEEPER [THANUSUAL]",
    "going_deep: GO rough_depth [THISTIME]", "going_deep: PUSHPROBE [PROBEDOWN] rough_depth [THISTIME]",
    "going_deep: THISTIME [GO] rough_depth", cost=0.1,
)  # fmt: skip
def rough_depth() -> str:
    """Compose "a bit deeper than usual" and "go deeper than usual this time"."""
    return "depth"


@construction(
    "parameter: [BUT] ROUGHAMOUNT", "parameter: [BUT] depth=rough_depth [THISTIME]",
    "parameter: [BUT] depth=going_deep", cost=0.3, given=("robot",),
)  # fmt: skip
def open_amount(robot: RobotProfile, depth: str | None = None) -> ParameterValue | None:
    """Compose "not too much" and "deeper than usual", which give no number; the dialogue asks for it."""
    numbers = {one.name for action in robot.actions for one in action.parameters if _is_bounded(one)}
    names = tuple(sorted(name for name in numbers if ("depth" in name) == (depth is not None)))
    return ParameterValue(OPEN_VALUE, "", names) if names else None


@construction("capture: said=capture FULLSTOP [BUT] depth=going_deep", cost=0.3, given=("robot",))
def capture_so_deep(said: CaptureCommand, used: int, depth: str, robot: RobotProfile) -> CaptureCommand | None:
    """Compose "measure moisture at tree 4. Go deeper this time."."""
    return capture_with(said, used, robot, how=open_amount(robot, depth))


@construction("parameter: how=setting", cost=0.1)
def by_setting(how: ParameterValue) -> ParameterValue:
    """Compose "of a depth of 40 cm"."""
    return how


@construction("parameter: [DET] choice=CHOICE", cost=0.2)
def chosen(choice: Lex) -> list[ParameterValue]:
    """Compose "the trunk"."""
    return [ParameterValue(value, "", (name,)) for name, value in choice.value]


@construction(
    "thing: one=thing how=parameter",
    "thing: one=thing [COMMA] amount=amount",
    cost=0.2,
    given=("robot",),
)
def thing_with(
    one: Thing, robot: RobotProfile, how: ParameterValue | None = None, amount: Amount | None = None
) -> Thing | None:
    """Compose "soil moisture at 30 cm" and "soil moisture, 30 cm"."""
    value = how if amount is None else ParameterValue(amount.number, amount.unit, ())
    if value is None or (isinstance(value.value, str) and value.value not in _NO_CHOICES):
        return None
    return with_parameter(one, value, robot)


@construction("thing: one=thing OF how=parameter", "thing: one=thing OF ITS choice=CHOICE", cost=0.2, given=("robot",))
def thing_of(
    one: Thing, robot: RobotProfile, how: ParameterValue | None = None, choice: Lex | None = None
) -> list[Thing] | None:
    """Compose "a picture of the trunk"."""
    values = chosen(choice) if choice is not None else [how] if how is not None and isinstance(how.value, str) else []
    return [made for value in values if (made := with_parameter(one, value, robot)) is not None] or None


@construction(
    "thing: ANOTHER [ONE] OF how=parameter",
    "thing: [DET] other=ONE OF how=parameter",
    cost=0.6,
    given=("robot",),
)
def another_of(how: ParameterValue, robot: RobotProfile, n: int = 1, other: Lex | None = None) -> list[Thing] | None:
    """Compose "one of the ground" behind "take a picture of tree 4 and"."""
    if not isinstance(how.value, str) or (other is not None and other.plural):
        return None
    made = [with_parameter(Thing(action.name, count=n), how, robot) for action in robot.actions]
    return [one for one in made if one is not None] or None


@construction(
    "thing: [DET] choice=CHOICE [DASH] name=PARAMETER", "thing: n=count choice=CHOICE [DASH] name=PARAMETER",
    cost=0.6, given=("robot",),
)  # fmt: skip
def view_of(choice: Lex, name: Lex, robot: RobotProfile, n: int | None = None) -> list[Thing] | None:
    """Compose "a trunk view" as what is taken."""
    values = [value for value in chosen(choice) if value.names[0] in name.value]
    things = [Thing(action.name, count=n, plural=name.plural) for action in robot.actions]
    made = [with_parameter(one, value, robot) for one in things for value in values]
    return [one for one in made if one is not None] or None


@construction("capture: how=parameter", cost=1.5, given=("robot",))
@construction("capture: AGAIN how=parameter", "capture: how=parameter AGAIN", cost=0.6, given=("robot",))
def again_with(how: ParameterValue, used: int, robot: RobotProfile) -> list[CaptureCommand] | None:
    """Compose "(then) again at 40 cm", of what was captured last."""
    return [CaptureCommand((replace(one, count=None),), None, used) for one in another_with(how, robot) or ()] or None


@construction("thing: ONE how=parameter", "thing: ANOTHER [ONE] how=parameter", cost=0.8, given=("robot",))
def another_with(how: ParameterValue, robot: RobotProfile) -> list[Thing] | None:
    """Compose "one at 60 cm", of what was captured last."""
    if isinstance(how.value, str):
        return None
    made = [with_parameter(Thing(action.name, count=1), how, robot) for action in robot.actions]
    fitting = {one.parameters for one in made if one is not None}
    return [Thing(LAST_THING, count=1, parameters=parameters) for parameters in fitting] or None


def _with_value(thing: Thing, value: ParameterValue, robot: RobotProfile) -> Thing | None:
    """Return a capture with a parameter; one that refers to the last one with that of the actions that have it."""
    if thing.action != LAST_THING:
        return with_parameter(thing, value, robot)
    made = [with_parameter(replace(thing, action=action.name), value, robot) for action in robot.actions]
    fitting = {one.parameters for one in made if one is not None}
    return replace(thing, parameters=fitting.pop()) if len(fitting) == 1 else None


@construction("NOUN: choice=CHOICE [DASH] [name=PARAMETER] noun=NOUN", cost=0.1, given=("robot",))
def noun_of(choice: Lex, noun: Lex, robot: RobotProfile, name: Lex | None = None) -> list[Lex] | None:
    """Compose "trunk photos" and "ground-view photograph"."""
    naming: Naming = noun.value
    if not naming.actions or naming.parameters:
        return None
    thing = Thing(naming.actions[0])
    values = [value for value in chosen(choice) if name is None or value.names[0] in name.value]
    made = [with_parameter(thing, value, robot) for value in values]
    named = [replace(naming, parameters=one.parameters) for one in made if one is not None]
    return [replace(noun, value=one) for one in named] or None


@construction(
    "capture: said=capture [COMMA] how=parameter",
    "capture: said=capture [COMMA] [AND] THISTIME how=parameter",
    "capture: said=capture [COMMA] named=setting",
    "capture: said=capture COMMA INEACH how=parameter",
    "capture: said=capture FULLSTOP INEACH how=parameter",
    "capture: said=capture COMMA GROUPALL how=parameter",
    "capture: named=setting COMMA said=capture",
    "capture: said=capture AND how=parameter",
    "capture: how=parameter COMMA said=capture",
    "capture: said=capture COMMA amount=amount",
    "capture: said=capture [COMMA] [AND] THISTIME amount=amount",
    cost=0.5,
    given=("robot",),
)
def capture_with(
    said: CaptureCommand,
    used: int,
    robot: RobotProfile,
    how: ParameterValue | None = None,
    named: ParameterValue | None = None,
    amount: Amount | None = None,
) -> CaptureCommand | None:
    """Compose "measure moisture along row 1, 25 cm deep" and "photograph tree 4, view: ground"."""
    value = named or (how if amount is None else ParameterValue(amount.number, amount.unit, ()))
    if value is None or (named is None and isinstance(value.value, str) and value.value not in _NO_CHOICES):
        return None
    made = tuple(_with_value(one, value, robot) for one in said.things)
    if all(one is None for one in made):
        return None
    things = tuple(one if new is None else new for one, new in zip(said.things, made, strict=True))
    return replace(said, things=things, used=used)


@construction("work: one=work [COMMA] [BUT] ROUGHAMOUNT", "work: ROUGHAMOUNT one=work", cost=0.3, given=("robot",))
def work_so_much(one: WorkCommand, used: int, robot: RobotProfile) -> WorkCommand | None:
    """Compose "spray row 3, but not too much"."""
    how = open_amount(robot)
    made = None if how is None else with_parameter(Thing(one.action, parameters=one.parameters), how, robot)
    return None if made is None else replace(one, parameters=made.parameters, used=used)


@construction(
    "said: before=said FULLSTOP how=setting",
    "said: before=said COMMA how=setting",
    "said: before=said [COMMA] [AND] how=pushed",
    "said: before=said FULLSTOP how=pushed",
    "said: how=setting FULLSTOP before=said",
    cost=0.3,
    given=("robot",),
)
def setting_of_all(before: Said, how: ParameterValue, used: int, robot: RobotProfile) -> list[Said] | None:
    """Compose "moisture at trees 4 and 9. Depth: 10 cm.", of all captures that have the parameter or of the last."""
    own, made = used, dict[int, LinkedCommand]()
    unsaid = [number for number, one in enumerate(before.clauses) if _is_unsaid(one)]
    for clause in before.clauses:
        if not isinstance(clause.command, _PLAIN):
            return None
        own &= ~(clause.command.used | (clause.before.used if clause.before is not None else 0))
    for number, clause in enumerate(before.clauses):
        command = clause.command
        if isinstance(command, CaptureCommand):
            changed = capture_with(command, command.used, robot, named=how)
            made |= {} if changed is None else {number: replace(clause, command=changed)}
    if unsaid and not made:
        return _each_probed_so(before, unsaid[-1], how, own, robot)
    if made:
        last = made[max(made)]
        made[max(made)] = replace(last, command=replace(last.command, used=last.command.used | own))
    ways = (made, {max(made): made[max(made)]}) if len(made) > 1 else (made,) if made else ()
    return [Said(tuple(way.get(k, clause) for k, clause in enumerate(before.clauses))) for way in ways]


def _is_unsaid(clause: LinkedCommand) -> bool:
    """Return True for a capture that its command does not name ("check tree 4")."""
    command = clause.command
    return isinstance(command, CaptureCommand) and [one.action for one in command.things] == [UNSAID_THING]


def _each_probed_so(before: Said, number: int, how: ParameterValue, own: int, robot: RobotProfile) -> list[Said]:
    """Return commands with each capture that has such a parameter for the one that is not named."""
    found: list[Said] = []
    clause = before.clauses[number]
    command = clause.command
    if not isinstance(command, CaptureCommand):
        return found
    for action in robot.actions:
        made = with_parameter(replace(command.things[0], action=action.name, verb=""), how, robot)
        if made is not None:
            one = replace(clause, command=replace(command, things=(made,), used=command.used | own))
            found.append(Said((*before.clauses[:number], one, *before.clauses[number + 1 :])))
    return found


@construction(
    "thing: one=thing [COMMA] [AND] NOT [OF] [DET] choice=CHOICE [ONE]",
    "thing: one=thing [COMMA] [AND] NOT [DET] choice=CHOICE NOUN",
    "thing: NOT [DET] choice=CHOICE CONTRAST one=thing",
    cost=0.2,
)
def thing_and_not(one: Thing, choice: Lex) -> Thing | None:
    """Compose "ground photos, not canopy ones"."""
    given = dict(one.parameters)
    return one if all(name in given and given[name] != value for name, value in choice.value) else None


@construction("capture: said=capture [COMMA] [AND] NOT [OF] [DET] choice=CHOICE [ONE]", cost=0.3)
def capture_and_not(said: CaptureCommand, choice: Lex, used: int) -> CaptureCommand | None:
    """Compose "photograph the ground at tree 4, not the canopy"."""
    agrees = any(thing_and_not(one, choice) is not None for one in said.things)
    return replace(said, used=used) if agrees else None


@construction(
    "parameter: word=AT DET SAME name=PARAMETER",
    "parameter: [DET] SAME name=PARAMETER",
    "parameter: WITH DET SAME name=PARAMETER",
    cost=0.2,
)
def same_parameter(name: Lex, word: Lex | None = None) -> ParameterValue | None:
    """Compose "at the same depth"."""
    if word is not None and "setting" not in word.features:
        return None
    return ParameterValue(SAME_VALUE, "", tuple(name.value))


@construction(
    "value: ONCE how=parameter",
    "value: how=parameter",
    "value: ONE [READING] how=parameter",
    "value: READING how=parameter",
    cost=0.1,
)
def one_of_several_values(how: ParameterValue) -> ParameterValue | None:
    """Compose "one reading at 10 cm", of several that are taken."""
    return None if isinstance(how.value, str) else how


@construction(
    "and_again: [COMMA] AND [then] [AGAIN]",
    "and_again: [COMMA] AND [then] ANOTHER",
    "and_again: [COMMA] AND [then] ANOTHER ONE",
    "and_again: [COMMA] AND [then] ANOTHER READING",
    "and_again: COMMA [then] [AGAIN]",
    "and_again: then [AGAIN]",
    cost=0.0,
)
def and_again() -> str:
    """Compose "and again", between values of which each is taken."""
    return "and"


@construction("parameters: [FIRSTONE] first=value and_again second=value", cost=0.1)
def two_parameters(first: ParameterValue, second: ParameterValue) -> tuple[ParameterValue, ...]:
    """Compose "at 10 cm and at 50 cm"."""
    return first, second


@construction("parameters: first=parameters and_again last=value", cost=0.1)
def more_parameters(first: tuple[ParameterValue, ...], last: ParameterValue) -> tuple[ParameterValue, ...]:
    """Compose "at 10 cm, at 30 cm and at 50 cm"."""
    return (*first, last)


@construction("amounts: first=NUM", "amounts: first=amount", cost=0.0)
def first_of_amounts(first: Lex | Amount) -> tuple[Lex | Amount, ...]:
    """Compose "10" of "10, 30 and 60 cm"."""
    return (first,)


@construction("amounts: first=amounts and_again then=NUM", "amounts: first=amounts and_again then=amount", cost=0.0)
def more_amounts(first: tuple[Lex | Amount, ...], then: Lex | Amount) -> tuple[Lex | Amount, ...]:
    """Compose "10, 30" of "10, 30 and 60 cm"."""
    return (*first, then)


@construction(
    "parameters: [word=AT] first=amounts and_again last=amount",
    "parameters: word=AT PARAMETER [OF] first=amounts and_again last=amount",
    "parameters: word=AT first=amounts and_again AT last=amount",
    "parameters: [word=AT] first=amounts and_again last=NUM",
    "parameters: word=AT first=amounts and_again AT last=NUM",
    cost=0.1,
)
def one_unit_of_several(
    first: tuple[Lex | Amount, ...], last: Lex | Amount, word: Lex | None = None
) -> tuple[ParameterValue, ...] | None:
    """Compose "at 10, 30 and 50 cm"; metres, into which every length is turned, hide the unit of the first numbers."""
    said = [one for one in (*first, last) if isinstance(one, Amount)]
    if (word is not None and "setting" not in word.features) or not said:
        return None
    if not all(one.unit == "metres" and 0 < one.number < 1 for one in said):
        return None
    if isinstance(last, Lex) and not isinstance(first[0], Amount):
        return None  # "at 10, 30 cm and 50"
    numbers = [one.number if isinstance(one, Amount) else round(one.value / 100, 6) for one in (*first, last)]
    return tuple(ParameterValue(number, "metres", ()) for number in numbers)


@construction("things: one=thing each=parameters", cost=0.3, given=("robot",))
def thing_at_each(one: Thing, each: tuple[ParameterValue, ...], robot: RobotProfile) -> tuple[Thing, ...] | None:
    """Compose "soil moisture at 10 cm and at 50 cm"."""
    made = tuple(with_parameter(one, value, robot) for value in each)
    things = tuple(thing for thing in made if thing is not None)
    return things if len(things) == len(made) == len(set(each)) else None


@construction(
    "capture: said=capture each=parameters",
    "capture: said=capture COMMA each=parameters",
    "capture: said=capture [COMMA] WITH each=parameters",
    "capture: each=parameters COMMA said=capture",
    cost=0.4,
    given=("robot",),
)
def capture_at_each(
    said: CaptureCommand, each: tuple[ParameterValue, ...], used: int, robot: RobotProfile
) -> list[CaptureCommand] | None:
    """Compose "measure moisture at tree 5 at depths of 20 and 40 cm"; "twice" there is once at each, or twice."""
    made = [thing_at_each(replace(one, count=None), each, robot) for one in said.things]
    if not all(one.count in (None, 1, len(each)) for one in said.things):
        return None
    things = tuple(thing for each_of_one in made if each_of_one is not None for thing in each_of_one)
    if len(things) != len(each) * len(made):
        return None
    whole = replace(said, things=things, used=used)
    return [replace(whole, times=1), whole] if said.times == len(each) else [whole]


def with_parameter(thing: Thing, value: ParameterValue, robot: RobotProfile) -> Thing | None:
    """Return a capture with a parameter; None if its action has none that the value fits."""
    action = robot.action.get(thing.action)
    fitting = [] if action is None else list(_fitting(action.parameters, value))
    taken = {name for name, _ in thing.parameters}
    if value.value == DEFAULT_VALUE and action is not None:
        known = {parameter.name for parameter in action.parameters} & {*value.names}
        return thing if known and not known & taken else None
    if len(fitting) == 1 and isinstance(value.value, str) and fitting[0] in thing.parameters:
        return thing  # "the trunk ..., using the trunk view"
    if len(fitting) != 1 or fitting[0][0] in taken:
        return None
    return replace(thing, parameters=(*thing.parameters, fitting[0]))


def _fitting(parameters: tuple[Parameter, ...], value: ParameterValue) -> Iterator[tuple[str, str | float]]:
    """Yield the name and the value of each parameter that a value fits."""
    for one in parameters:
        if value.value in (SAME_VALUE, OPEN_VALUE):
            if one.name in value.names and (value.value == SAME_VALUE or _is_bounded(one)):
                yield one.name, value.value
        elif isinstance(value.value, str):
            if value.value in one.choices and one.name in value.names:
                yield one.name, value.value
        elif (number := in_unit_of(one, value)) is not None and _is_within(one, number):
            yield one.name, number


def in_unit_of(parameter: Parameter, value: ParameterValue) -> float | None:
    """Return a number in the unit of a parameter; None if it has another unit, or another parameter is named."""
    if isinstance(value.value, str) or parameter.kind != "number":
        return None
    if value.names and parameter.name not in value.names:
        return None
    size = 1.0 if value.unit == parameter.unit else _SIZES.get(value.unit, {}).get(parameter.unit)
    return None if size is None else round(value.value / size, 6)


def _is_bounded(parameter: Parameter) -> bool:
    """Return True for a number of which a question can state the range."""
    return parameter.kind == "number" and parameter.minimum is not None and parameter.maximum is not None


def _is_within(parameter: Parameter, number: float) -> bool:
    low, high = parameter.minimum, parameter.maximum
    return (low is None or low <= number) and (high is None or number <= high)
