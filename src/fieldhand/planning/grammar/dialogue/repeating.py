"""Repeating a process: what was done since the last place, with its conditions, at another place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.driving import drive, visits
from fieldhand.planning.grammar.dialogue.other_ground import ground_of, in_zone, on_ground, zone_of_points
from fieldhand.planning.grammar.dialogue.plans import (
    Path,
    as_choice,
    as_for_each,
    block_at,
    walk,
    with_node,
    with_selector,
)
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    done_at,
    with_step,
)
from fieldhand.planning.grammar.meaning import Again, DriveCommand, PlaceMeaning, wait_thing
from fieldhand.planning.grammar.places.sampling import bare_zone, whole_zone
from fieldhand.planning.selections import (
    are_rows,
    blocks_of,
    is_in_block,
    is_one_row,
    moves_on,
    over,
    replaceable_area,
    swapped,
)
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.aggregates import Aggregate, CompareSeries, CountReadings, MeanKnown
from fieldhand.task.battery_condition import BatteryBelow


def process_again(setting: Setting, state: DialogueState, command: Again) -> DialogueState:
    """Return the state after the last process was repeated at the place named last.

    The process begins at the last place before that one. If it contains the command to repeat it, it is repeated
    without that branch. Captures that were already made at the new place are not made again.

    Raises:
        NotComposed: What is repeated, or where, is unclear.
    """
    if command.place is not None and command.place.shape == "several" and command.place.per is None:
        return _process_at_each(setting, state, command, command.place)
    if command.place is not None:
        if command.place.shape != "one":
            raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
        state = drive(setting, state, DriveCommand(command.place, command.used))
    if state.awaits_command or state.open:
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    steps = state.block.steps
    here = _last_place(steps, len(steps))
    if here is None:
        raise NotComposed(message("it is not clear where it is repeated", context="fault"))
    process = _process_before(state.plan, state.scope, here)
    done = [step for step in steps[here:] if not step.only_drives]
    rest = _not_done(process, done)
    if not rest or not _can_be_repeated(process):
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    names = _Names(state.readings)
    made = _named(done, process, names)
    first = len(steps) - len(done)
    plan = with_node(state.plan, state.scope, p.InOrder(id="", steps=(*steps[:first], *made)))
    said = setting.spans_of(command.used)
    copies = tuple(_renamed(step, names, said) for step in rest)
    block = block_at(plan, state.scope)
    plan = with_node(plan, state.scope, replace(block, steps=(*block.steps, *copies)))
    captured = [path for path, node in walk(plan) if node.act is not None and path[: len(state.scope)] == state.scope]
    return replace(
        state, plan=plan, readings=names.last, captured=captured[-1], loop=None, choice=None, things=(), open=False,
        commands_in_sentence=state.commands_in_sentence + 1,
    )  # fmt: skip


def _process_at_each(setting: Setting, state: DialogueState, command: Again, place: PlaceMeaning) -> DialogueState:
    """Return the state after the process since the last place was repeated at each of several places.

    Raises:
        NotComposed: What is repeated is unclear.
    """
    if state.awaits_command or state.open or state.scope:
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    process = _process_before(state.plan, state.scope, len(state.block.steps))
    if not process or not _can_be_repeated(process):
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    said, names = setting.spans_of(command.used), _Names(state.readings)
    body = p.InOrder(id="", steps=tuple(_renamed(step, names, said) for step in process))
    inside = (*state.next_step, "body")
    state = with_step(state, replace(visits(place, said), body=body))
    captured = next(
        (path for path, node in walk(state.plan) if node.act is not None and path[: len(inside)] == inside), None
    )
    done = replace(state, readings=names.last, captured=captured, choice=None, decided=None, things=())
    return done_at(replace(done, loop=inside), place)


def driven_to_and_fro(setting: Setting, state: DialogueState, command: Again) -> DialogueState:
    """Return the state after the robot drove between places several times, with nothing done there.

    Raises:
        NotComposed: A place before it has its own work to come.
        OpenQuestion: It does not say how often.
    """
    if not command.times:
        asked = message("'{said}': how many times?", said=setting.quoted(command.used))
        raise OpenQuestion(asked, command.used)
    if state.awaits_command or state.open or state.scope:
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    said = setting.spans_of(command.used)
    body = p.InOrder(id="", steps=tuple(p.GoTo(id="", place=one.selector, said=said) for one in command.drives))
    node = p.Repeat(id="", times=command.times, body=body, until=_until_battery(command), said=said)
    state = with_step(replace(state, captured=None, loop=None, choice=None, things=()), node)
    return replace(state, where=None, commands_in_sentence=state.commands_in_sentence + 1)


def _until_battery(command: Again) -> BatteryBelow | None:
    return None if command.battery is None else BatteryBelow(percent=command.battery)


def done_more_times(setting: Setting, state: DialogueState, command: Again) -> DialogueState:
    """Return the state after all that was done so far, at one place or at each of several, was done several times.

    Raises:
        NotComposed: What is repeated is unclear.
    """
    steps = state.plan.steps
    if state.scope or state.awaits_command or state.open or not steps or not _can_be_repeated(steps):
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    if command.both and len([step for step in steps if step.selector is not None]) != 2:
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    begin = 0 if command.whole else _last_stride(steps)  # "go 10 trees further down the row, repeat that twice more"
    before, steps = steps[:begin], steps[begin:]
    if steps[0].selector is None or (not command.whole and any(step.selector is not None for step in steps[1:])):
        raise NotComposed(message("it is not clear from which place on", context="fault"))
    said, names = setting.spans_of(command.used), _Names(state.readings)
    last = replace(state, captured=None, loop=None, choice=None, things=())
    rest = (p.Act(id="", action=wait_thing(command.rest_s).action, said=said),) if command.rest_s else ()
    if command.in_all and not rest:
        until, body = _until_battery(command), p.InOrder(id="", steps=steps)
        every = p.Repeat(id="", times=command.times, body=body, until=until, said=said)
        return with_step(replace(last, plan=p.InOrder(id="", steps=before)), every)
    copies = tuple(_renamed(step, names, said) for step in steps)
    last = replace(last, readings=names.last)
    if command.in_all:  # "three rounds, ten minutes apart" rests twice
        plan = p.InOrder(id="", steps=(*before, *((*steps, *rest) if command.times == 2 else ())))
        if command.times > 2:
            body = p.InOrder(id="", steps=(*steps, *rest))
            plan = p.InOrder(id="", steps=(*before, p.Repeat(id="", times=command.times - 1, body=body, said=said)))
        return replace(last, plan=replace(plan, steps=(*plan.steps, *copies)))
    if command.times == 1 and (command.whole or rest):
        return replace(last, plan=replace(state.plan, steps=(*state.plan.steps, *rest, *copies)))
    return with_step(
        last, p.Repeat(id="", times=command.times, body=p.InOrder(id="", steps=(*rest, *copies)), said=said)
    )


def _last_stride(steps: Sequence[p.Node]) -> int:
    """Return the index of the last step that goes along or across rows from where the robot is, if no place follows it.

    0 if there is none.
    """
    named = [number for number, step in enumerate(steps) if step.selector is not None]
    place = steps[named[-1]].selector if named else None
    return named[-1] if place is not None and moves_on(place) else 0


def repeated_in(setting: Setting, state: DialogueState, area: s.Selector, used: int) -> DialogueState:
    """Return the state after what was done in the last area was done in another one of its kind ("... in row 4").

    Raises:
        NotComposed: What is repeated is unclear.
    """
    steps = state.plan.steps
    area = _of_same_block(area, steps)
    bare, zone = bare_zone(area, setting.site), whole_zone(area)
    places = [(zone and ground_of(step)) or (None if bare else _place_in(step, area)) for step in steps]
    if state.scope or not steps or state.awaits_command:
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    old = next((place for place in reversed(places) if place is not None), None)
    first = len(steps)
    while first > 0 and (places[first - 1] == old or not _selects(steps[first - 1])):
        first -= 1
    while first < len(steps) and places[first] is None:
        first += 1
    again = steps[first:]
    if old is None or not again or not _can_be_repeated(again):
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    if area.relative and (len(again) > 1 or isinstance(old, str) or not is_one_row(old)):
        raise NotComposed(message("it is not clear from which tree", context="fault"))
    names, said = _Names(state.readings), setting.spans_of(used)
    moved = [on_ground(step, zone) if isinstance(old, str) else _moved(step, old, area) for step in again]
    copies = tuple(_renamed(step, names, said) for step in moved)
    plan = p.InOrder(id="", steps=(*steps, *copies))
    captured = [path for path, node in walk(plan) if node.act is not None]
    visits = as_for_each(copies[-1])
    return replace(
        state, plan=plan, readings=names.last, captured=captured[-1] if captured else None, choice=None, open=False,
        where_scope=(), loop=None if visits is None else (len(plan.steps) - 1, "body"),
        where=None if visits is None else PlaceMeaning(visits.select, "several"),
        commands_in_sentence=state.commands_in_sentence + 1,
    )  # fmt: skip


def moved_to(places: s.Selector, area: s.Selector) -> s.Selector:
    """Return the places of another area that are chosen like some places; all of it if these are none of an area."""
    zone = whole_zone(area)
    if zone and zone_of_points(places):
        return in_zone(places, zone)
    part = replaceable_area(places, area)
    return area if part is None else swapped(places, part, area)


def _of_same_block(area: s.Selector, steps: Sequence[p.Node]) -> s.Selector:
    """Return rows without a block as those of the only block of some steps ("vines of row 3 of block 2 ... row 4")."""
    if not are_rows(area) or is_in_block(area):
        return area
    blocks = {
        block
        for step in steps
        for node in p.walk(step)
        if node.selector is not None
        for block in blocks_of(node.selector)
    }
    return over(area, blocks.pop()) if len(blocks) == 1 else area


def _selects(step: p.Node) -> bool:
    """Return True if a step names a place."""
    return any(node.selector is not None for node in p.walk(step))


def _place_in(step: p.Node, area: s.Selector) -> s.Selector | None:
    """Return the area of a step, if it is of the kind of another one and all places of the step are in it."""
    found = {replaceable_area(node.selector, area) for node in p.walk(step) if node.selector is not None}
    return found.pop() if len(found) == 1 else None


def _moved(step: p.Node, old: s.Selector, new: s.Selector) -> p.Node:
    """Return a step with one area in the place of another."""
    if step.act is not None:
        return step.act if step.act.at is None else replace(step.act, at=swapped(step.act.at, old, new))
    if step.selector is not None:
        step = with_selector(step, swapped(step.selector, old, new))
    return step.with_children([_moved(child, old, new) for child in step.children])


def _last_place(steps: Sequence[p.Node], end: int) -> int | None:
    """Return the index of the last step before an index that goes to a place of its own."""
    for number in range(end - 1, -1, -1):
        step = steps[number]
        if step.only_drives or (step.act is not None and step.act.at is not None):
            return number
        if step.visits_each:
            raise NotComposed(message("it is not clear whether it is repeated at each of them", context="fault"))
    return None


def _process_before(plan: p.InOrder, scope: Path, end: int) -> tuple[p.Node, ...]:
    """Return the steps since the last place before a step of a block, without that place.

    Args:
        plan: Plan.
        scope: Path of the block.
        end: Index of the step, which goes to the new place.
    """
    steps = block_at(plan, scope).steps[:end]
    begin = _last_place(steps, len(steps))
    while begin is None:
        scope, number, branch = _block_around(scope)
        outer = block_at(plan, scope).steps
        choice = as_choice(outer[number])
        if branch != "then" or choice is None or choice.otherwise is not None:
            raise NotComposed(message("it is not clear what is repeated", context="fault"))
        inner = (replace(choice, then=p.InOrder(id="", steps=tuple(steps))),) if steps else ()
        steps = (*outer[:number], *inner)
        begin = _last_place(outer, number)
    first = steps[begin]
    at_place = () if first.act is None else (replace(first.act, at=None, at_said=()),)
    return (*at_place, *steps[begin + 1 :])


def _block_around(scope: Path) -> tuple[Path, int, str]:
    """Return the path of the block around a block, the index of the step that contains it, and the branch.

    Raises:
        NotComposed: The block is the plan itself.
    """
    if len(scope) < 2:
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    *outer, number, branch = scope
    if not isinstance(number, int) or not isinstance(branch, str):
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    return tuple(outer), number, branch


def _not_done(process: Sequence[p.Node], done: Sequence[p.Node]) -> Sequence[p.Node]:
    """Return the steps of a process that remain where its first captures were made already.

    Raises:
        NotComposed: Something else was done there.
    """
    for old, new in zip(process, done, strict=False):
        if old.act is None or new.act is None or (old.act.action, old.act.count) != (new.act.action, new.act.count):
            raise NotComposed(message("it is not clear what is repeated", context="fault"))
    if len(done) > len(process):
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    return process[len(done) :]


def _can_be_repeated(process: Sequence[p.Node]) -> bool:
    """Return True if a process only captures, drives, visits, and decides by readings of its own."""
    nodes = [node for step in process for node in p.walk(step)]
    return not any(
        (node.selector is not None and node.selector.decided_by_readings)
        or node.ends_plan
        or node.is_optional_step
        or node.caught
        or getattr(node, "until", None)
        for node in nodes
    )


@dataclass
class _Names:
    """New names of readings by their old ones.

    Attributes:
        last: Number of the last name.
        new: New names.
    """

    last: int
    new: dict[str, str] = field(default_factory=dict)

    def of(self, reading: str) -> str:
        """Return the new name of a reading."""
        if reading not in self.new:
            self.last += 1
            self.new[reading] = f"r{self.last}"
        return self.new[reading]


def _named(done: Sequence[p.Node], process: Sequence[p.Node], names: _Names) -> tuple[p.Node, ...]:
    """Return captures that were made already, with names for the readings that the process tests."""
    found: list[p.Node] = []
    for old, new in zip(process, done, strict=False):
        if old.act is None or new.act is None or not old.act.reading:
            found.append(new)
        elif new.act.reading:
            names.new[old.act.reading] = new.act.reading
            found.append(new)
        else:
            found.append(replace(new.act, reading=names.of(old.act.reading)))
    return tuple(found)


def _renamed(step: p.Node, names: _Names, said: tuple[p.Span, ...]) -> p.Node:
    """Return a copy of a step with new names of its readings, said by other words."""
    if step.act is not None:
        reading = names.of(step.act.reading) if step.act.reading else ""
        return replace(step.act, reading=reading, said=said, at_said=said if step.act.at is not None else ())
    if (choice := as_choice(step)) is not None:
        step = replace(choice, condition=_retested(choice.condition, names))
    if step.collects:
        step = replace(cast(Any, step), collects=names.of(step.collects))
    return replace(step, said=said).with_children([_renamed(child, names, said) for child in step.children])


def _retested(condition: c.Condition, names: _Names) -> c.Condition:
    """Return a condition on the readings of the new names."""
    match condition:
        case c.Compare() | c.Between() | c.Level():
            return replace(condition, reading=names.new.get(condition.reading, condition.reading))
        case c.AllOf() | c.AnyOf():
            return replace(condition, conditions=tuple(_retested(one, names) for one in condition.conditions))
        case c.Not():
            return replace(condition, condition=_retested(condition.condition, names))
        case Aggregate() | CountReadings():
            return replace(condition, condition=cast(Any, _retested(condition.condition, names)))
        case MeanKnown():
            return replace(condition, reading=names.new.get(condition.reading, condition.reading))
        case CompareSeries(reading=one, than=other):
            return replace(condition, reading=names.new.get(one, one), than=names.new.get(other, other))
        case _:
            return condition
