"""Commands to capture something: at one place, at each of several, or where the last command was."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.language.words import say_action
from fieldhand.places import selectors as s
from fieldhand.planning.english.plant_words import is_unmarked
from fieldhand.planning.grammar.dialogue.driving import (
    drive,
    enter,
    may_be_left_out,
    ordered,
    require_known,
    visits,
)
from fieldhand.planning.grammar.dialogue.fitting import (
    along_row,
    fitted,
    in_area,
    in_each_row,
    is_spoken_of,
    of_each_before,
    spaced,
    within_area,
)
from fieldhand.planning.grammar.dialogue.likewise import single_places
from fieldhand.planning.grammar.dialogue.open_amounts import require_amounts
from fieldhand.planning.grammar.dialogue.plans import (
    EMPTY,
    as_choice,
    as_for_each,
    block_at,
    captures_at_last_place,
    drawn_again,
    for_each_at,
    is_conditional,
    is_inside,
    node_at,
    with_node,
)
from fieldhand.planning.grammar.dialogue.repeating import (
    done_more_times,
    driven_to_and_fro,
    moved_to,
    process_again,
    repeated_in,
)
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Path,
    Setting,
    Spans,
    done_at,
    with_assumption,
    with_capture,
    with_last_step,
    with_step,
)
from fieldhand.planning.grammar.dialogue.unsaid import named_things
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    LAST_THINGS,
    SAME_VALUE,
    UNSAID_THING,
    Again,
    CaptureCommand,
    DriveCommand,
    InAnOrder,
    Lead,
    PlaceMeaning,
    Thing,
)
from fieldhand.planning.grammar.places.compass import AWAY_FROM
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.sampling import bare_points, bare_zone, beside_objects, is_keep_out
from fieldhand.planning.selections import (
    AREAS,
    anchors,
    are_rows,
    as_corners,
    as_every_nth,
    as_in_row,
    as_some,
    as_where,
    as_zone,
    chooses_from_trees,
    counts_in_row,
    drawn_like,
    from_nearest_row,
    is_across,
    is_by_attribute,
    is_end_of_site,
    is_one_row,
    is_row_of_place,
    landmark_of,
    over,
    picks_from_all,
    some_of,
    specifies_part,
    swapped,
)
from fieldhand.task import plan as p
from fieldhand.task.conditions import Condition


def _of_some(command: CaptureCommand) -> CaptureCommand:
    """Return captures of which "some" are taken: so many in a zone, and one of each plant that is named.

    Raises:
        NotComposed: They are the others.
    """
    if not any(one.some for one in command.things):
        return command
    place = command.place
    is_open = place is not None and place.shape == "area" and as_zone(place.selector) is not None
    if any(one.some and (one.count is None) == is_open for one in command.things):
        raise NotComposed(message("how many?", context="fault"))
    return replace(command, things=tuple(replace(one, some=False) for one in command.things))


def capture(setting: Setting, state: DialogueState, command: CaptureCommand) -> DialogueState:
    """Return the state after a capture."""
    command = _of_some(command)
    if command.relation == "lead" and command.place is not None and command.place.shape == "one":
        state = drive(setting, state, DriveCommand(command.place, command.used))
        command = replace(command, place=None)
    if (
        state.area is not None
        and command.place is None
        and _is_one_more(command)
        and is_one_row(state.area.place.selector)
    ):
        state = enter(setting, state, state.area)  # "move two rows over and take another"
    state, begun = _along_from_its_end(state, command)
    same = any(one.action == LAST_THING and one.count is None for one in command.things)
    there = command.place or (state.lead.place if state.lead is not None else None)
    of_all = there is not None and there.shape == "area" and not bare_points(there.selector, setting.site, 1)
    area = command.place if command.place is not None and command.place.shape == "area" else None
    if same and command.spacing is None and (of_all or area is not None):
        if area is not None and area.per is None and command.times == 1 and not any(t.more for t in command.things):
            return repeated_in(setting, state, area.selector, command.used)
        raise NotComposed(message("at every tree, or at how many?", context="fault"))
    state, command = _with_unsaid_again(setting, state, command)
    state, things = named_things(setting, state, command)
    things = meant_things(setting, state, things)
    for thing in things:
        require_amounts(setting, thing.action, thing.parameters, command.used)
    place, state, before = _place_of(setting, state, command)
    before = (*begun, *before)
    tokens = 0 if command.place is None else command.place.tokens & command.used
    at_said = (*before, *setting.spans_of(tokens or command.used))
    said = setting.spans_of(command.used & ~tokens or command.used)
    whole = (*before, *setting.spans_of(command.used))
    if command.spacing is not None:
        if place is not None and place.shape == "several":
            line, once = spaced(setting, None, things, command.spacing, command.used)
            return _lines_at_each(state, replace(command, things=once), place, line, whole)
        place, things = spaced(setting, place, things, command.spacing, command.used)
    if _may_be_the_same(state, command, place):
        raise NotComposed(message("it is not clear whether it is taken once more", context="fault"))
    same = same or _is_one_more(command)
    if same and place is not None and state.where is not None and place.shape == "one":
        mark = landmark_of(state.where.selector, place.selector)  # "the tree next to the pond and one farthest from it"
        place = place if mark is None else replace(place, selector=swapped(place.selector, s.Here(), mark))
    place = _those_again(state, place)
    if place is not None and place.shape == "those" and place.each and place.count:
        place = _as_many_as_named(setting, state, place)
    if place is not None and place.shape == "those" and (place.count or place.at_most):
        return _at_some_of_those(state, replace(command, things=things), place, whole)
    if place is not None and state.where is None and not state.plan.steps:
        place = replace(place, selector=from_nearest_row(place.selector))
    if place is not None and is_across(place.selector) and place.per is not None:
        place = _across_among(setting, state, place)
    if place is not None and is_across_each(state, place):
        inside = replace(state, scope=state.loop or ())
        made = capture_once(inside, replace(command, things=things), place, said, at_said)
        return replace(made, scope=state.scope, loop=state.loop, where=state.where, where_scope=state.where_scope)
    require_known(setting, state, place, command.used)
    if place is None or place.shape in ("here", "those"):
        return _at_the_same_place(setting, state, replace(command, things=things, place=place), whole)
    if place.selector == s.Trees() and place.shape == "several" and state.plan.steps and not place.optional:
        raise NotComposed(
            message("it is not clear whether each of those is meant, or each tree of the site", context="fault")
        )
    if command.relation == "along" and place.shape == "area" and is_keep_out(place.selector, setting.site):
        asked = message("'{said}': at how many places?", context="question", said=setting.quoted(command.used))
        raise OpenQuestion(asked)
    spots = beside_objects(place.selector, setting.site) if place.shape == "area" and place.per is None else ()
    if len(spots) == 1:
        place = PlaceMeaning(spots[0], "one")
    elif spots:
        place = PlaceMeaning(s.UnionOf(parts=spots), "several", count=len(spots), each=True, in_order=place.in_order)
    refuse_keep_out(setting, place)
    place, things = _at_end_of_row(setting, state, command, place, things)
    place, things = fitted(setting, place, things, command.relation, command.used)
    if state.where is not None and any(one.more and (one.count or 0) > 1 for one in command.things):
        place = replace(place, selector=drawn_like(place.selector, state.where.selector))
    if place.shape == "one":
        return capture_once(state, replace(command, things=things), place, said, at_said)
    state = replace(state, loop=None)
    return _capture_at_each(setting, state, replace(command, things=things), place, said, at_said)


def _at_end_of_row(
    setting: Setting, state: DialogueState, command: CaptureCommand, place: PlaceMeaning, things: tuple[Thing, ...]
) -> tuple[PlaceMeaning, tuple[Thing, ...]]:
    """Return "(one plant at the north end and) two at the south end": so many there, or at so many plants?"""
    end, number = as_in_row(place.selector), command.things[0].count or 1
    refers = [one.action for one in command.things] == [LAST_THING] and not command.things[0].more
    at_end = end is not None and end.first == end.last == 1 and end.counted_from != "usual"
    if not refers or number < 2 or end is None or not at_end or state.where is None:
        return place, things
    several = replace(place, selector=replace(end, last=number), shape="several", count=number)
    once = tuple(replace(one, count=None) for one in things)
    return setting.either("so many there, or at so many plants?", command.used, ((place, things), (several, once)))


def refuse_keep_out(setting: Setting, place: PlaceMeaning) -> None:
    """Refuse an area into which the robot cannot drive; "at the pond", another reading, is at its edge.

    Raises:
        NotComposed: Ground that the robot cannot enter is among the areas.
    """
    areas = place.selector.members if place.shape == "area" and place.per is None else ()
    for area in areas:
        name = bare_zone(area, setting.site)
        if name and is_keep_out(area, setting.site):
            raise NotComposed(message("{name} is a keep-out zone", name=name), advice=message("say 'at its edge'"))


def is_across_each(state: DialogueState, place: PlaceMeaning | None) -> bool:
    """Return True for the tree across the aisle from each of the places of the same sentence."""
    several = state.where is not None and state.where.shape == "several" and state.loop is not None
    if state.where is not None and any(as_corners(one) is not None for one in state.where.selector.walk()):
        return False  # "each corner and the tree opposite": across the aisle, or in the opposite corner?
    across = place is not None and is_across(place.selector) and place.selector.relative
    return several and across and state.commands_in_sentence > 0 and not is_inside(state.scope, state.loop or (-1,))


def _across_among(setting: Setting, state: DialogueState, place: PlaceMeaning) -> PlaceMeaning:
    """Return the tree across the aisle without the description of it, which fits wherever the robot then is.

    Raises:
        NotComposed: It does not fit everywhere.
    """
    last = state.where
    origins = None if last is None or last.per is not None else ids_of(last.selector, setting.site)
    known = None if place.per is None else ids_of(place.per, setting.site)
    across = [ids_of(swapped(place.selector, s.Here(), s.TreeIs(tree=one)), setting.site) for one in origins or ()]
    if not across or known is None or not all(one is not None and one <= known for one in across):
        raise NotComposed(
            message("what stands across the aisle is not everywhere one of those", context="fault"),
            advice=message("say 'the tree across the aisle'"),
        )
    return replace(place, per=None)


def _along_from_its_end(state: DialogueState, command: CaptureCommand) -> tuple[DialogueState, Spans]:
    """Return the state for captures along a row from the end to which the robot was sent, and the spans of that.

    Raises:
        NotComposed: The end was named without its side.
    """
    end = None if state.where is None else as_in_row(state.where.selector)
    steps, place = state.plan.steps, command.place
    if end is None or place is None or len(steps) != 1 or not steps[0].only_drives or not is_one_row(end.of):
        return state, ()
    of_trees = place.selector == s.Trees() and place.shape == "several"
    along = of_trees or ((every := as_every_nth(place.selector)) is not None and every.of == s.Trees())
    if not along or end.first != end.last or abs(end.first) != 1 or place.per is not None or state.awaits_command:
        return state, ()
    if end.counted_from == "usual" or end.first == -1:
        raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
    order = InAnOrder(AWAY_FROM[end.counted_from], "", False, command.used)
    begun = replace(state, plan=EMPTY, where=None, loop=None, captured=None, order=order)
    return replace(begun, lead=Lead(PlaceMeaning(end.of, "area"), 0)), steps[0].said


def _may_be_the_same(state: DialogueState, command: CaptureCommand, place: PlaceMeaning | None) -> bool:
    """Return True for "one reading at each corner" as a sentence behind one that names a reading at the corners."""
    counted = any(one.action == LAST_THING and one.count and not one.more for one in command.things)
    known = None if state.where is None else state.where.selector
    return counted and not state.commands_in_sentence and place is not None and place.selector == known


def _is_one_more(command: CaptureCommand) -> bool:
    """Return True for "another one" of what was captured last."""
    return [(one.action, one.count) for one in command.things] == [(LAST_THING, 1)]


def _those_again(state: DialogueState, place: PlaceMeaning | None) -> PlaceMeaning | None:
    """Return the places of the last command for "those", where its for-each cannot be continued."""
    last = state.where
    if place is not None and place.shape == "those" and last is not None and last.shape == "one" and state.loop is None:
        named = single_places(state)  # "at tree 4, then at tree 9. Take a picture of both."
        both = PlaceMeaning(s.UnionOf(parts=named), "several", count=2, each=True)
        return both if len(named) == 2 else place
    if place is None or place.shape != "those" or state.loop is not None or last is None or last.shape != "several":
        return place
    if last.selector.relative or last.per is not None or last.optional or last.at_most is not None:
        return place
    return replace(last, selector=drawn_again(last.selector), each=place.each)


def capture_once(
    state: DialogueState, command: CaptureCommand, place: PlaceMeaning, said: Spans, at_said: Spans
) -> DialogueState:
    """Return the state after captures at one place.

    Args:
        state: State before them.
        command: Captures.
        place: Place.
        said, at_said: Words of the captures, and of the place.
    """
    state = replace(state, loop=None)
    for number, thing in enumerate(command.things):
        act = _act(thing, command.times, said)
        if number == 0:
            act = replace(act, at=place.selector, at_said=at_said)
        state = with_capture(state, act, state.scope)
    return done_at(replace(state, things=command.things), place)


def _capture_at_each(
    setting: Setting,
    state: DialogueState,
    command: CaptureCommand,
    place: PlaceMeaning,
    said: Spans,
    at_said: Spans,
) -> DialogueState:
    """Return the state after captures at each of several places."""
    loop = visits(place, at_said)
    if state.order is not None:
        loop = ordered(setting, loop, state.order, setting.spans_of(state.order.used))
        state = replace(state, order=None)
    inside = (*state.next_step, "body")
    state = with_step(state, loop)
    state = _with_captures(state, command.things, command.times, said, inside)
    return replace(done_at(state, place), things=command.things, loop=inside)


def _with_captures(
    state: DialogueState, things: tuple[Thing, ...], times: int, said: Spans, scope: Path
) -> DialogueState:
    """Return the state after captures in a block."""
    for thing in things:
        state = with_capture(state, _act(thing, times, said), scope)
    return state


def _act(thing: Thing, times: int, said: Spans) -> p.Act:
    """Return the step of a capture."""
    count = (thing.count or 1) * times
    return p.Act(id="", action=thing.action, count=count, parameters=thing.parameters, said=said)


def _with_unsaid_again(
    setting: Setting, state: DialogueState, command: CaptureCommand
) -> tuple[DialogueState, CaptureCommand]:
    """Return a capture that is not named as the last one if a test of it decides it ("if it is high, check tree 9")."""
    if not state.open or len(state.things) != 1 or [one.action for one in command.things] != [UNSAID_THING]:
        return state, command
    (last,) = state.things
    same = message(
        "'{said}': the same as before is taken ({action}).",
        context="assumption",
        said=setting.quoted(command.used),
        action=say_action(last.action, 1),
    )
    things = (replace(last, count=None, plural=command.things[0].plural),)
    return with_assumption(state, same), replace(command, things=things)


def meant_things(setting: Setting, state: DialogueState, things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Return captures, those that refer to the last ones resolved.

    Raises:
        NotComposed: What they refer to is unclear.
    """
    things = _with_same_values(state, things)
    if things[0].action == LAST_THINGS:
        if len(things) > 1 or len(state.things) < 2 or things[0].count not in (None, len(state.things)):
            raise NotComposed(message("it is not clear what another one is meant", context="fault"))
        return state.things
    if not any(thing.action == LAST_THING for thing in things):
        return things
    if len(things) == 1 and not state.things and (read := _read_earlier_there(setting, state)):
        return (replace(things[0], action=read),)
    if len(things) != 1 or len(state.things) != 1:
        raise NotComposed(message("it is not clear what another one is meant", context="fault"))
    if may_be_left_out(state):
        raise NotComposed(message("it is not clear whether that may be left out too", context="fault"))
    if things[0].count is None and _depends(state):
        raise NotComposed(message("it is not clear whether the same condition decides that", context="fault"))
    last = state.things[0]
    given = dict(last.parameters)
    action = setting.robot.action.get(last.action)
    known = given.keys() | {parameter.name for parameter in (() if action is None else action.parameters)}
    if not known >= dict(things[0].parameters).keys():
        raise NotComposed(message("it is not clear what another one is meant", context="fault"))
    parameters = tuple((given | dict(things[0].parameters)).items())
    return (replace(things[0], action=last.action, parameters=parameters),)


def _read_earlier_there(setting: Setting, state: DialogueState) -> str:
    """Return the action whose readings of earlier missions choose the place ("where CO2 was highest ..., read it")."""
    parts = () if state.where is None else state.where.selector.walk()
    read = {getattr(part, "quantity", "") for part in parts if part.uses_records} - {""}
    actions = [one.name for one in setting.robot.actions if read & {*one.measures}]
    return actions[0] if len(read) == 1 and len(actions) == 1 else ""


def _with_same_values(state: DialogueState, things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Return captures with the values that parameters had before, where "the same depth" is said.

    Raises:
        NotComposed: The parameter had no value, or several.
    """
    made: list[Thing] = []
    for thing in things:
        given = dict(thing.parameters)
        for name in [name for name, value in thing.parameters if value == SAME_VALUE]:
            before = {value for one in (*state.things, *made) for known, value in one.parameters if known == name}
            if len(before) != 1:
                raise NotComposed(message("it is not clear what is the same", context="fault"))
            given[name] = before.pop()
        made.append(replace(thing, parameters=tuple(given.items())))
    return tuple(made)


def _depends(state: DialogueState) -> bool:
    """Return True if a condition decides the last capture, and does not decide the next one."""
    return state.captured is not None and is_conditional(state.captured[len(state.scope) :])


def _row_spoken_of(state: DialogueState) -> s.Selector | None:
    """Return the row in which the last place is, if its words name one: "halfway along bed 7"."""
    if state.where is None or state.where.shape != "one":
        return None
    rows = {part for part in state.where.selector.walk() if are_rows(part) and is_one_row(part)}
    return rows.pop() if len(rows) == 1 else None


def _place_of(
    setting: Setting, state: DialogueState, command: CaptureCommand
) -> tuple[PlaceMeaning | None, DialogueState, Spans]:
    """Return the place of a command, with the area or lead before it, the state without these, and their spans."""
    place, before = command.place, state.lead or state.area
    if command.within is not None:
        if before is not None:
            raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
        before = Lead(command.within, 0)
    if place is not None and place.there:
        area = state.within if before is None and state.within is not None else None
        if area is None and before is None and place.inside and (row := _row_spoken_of(state)) is not None:
            place = replace(place, inside=False, selector=over(place.selector, row))
        elif area is None and (before is None or before.place.shape != "area"):
            raise NotComposed(message("it is not clear where that is", context="fault"))
        place = replace(place, there=False, inside=False)
    if before is None:
        place = of_each_before(state, place)
        place = _contrasted(setting, state, place, command.used)
        return within_area(place, state.within), state, ()
    state, said = replace(state, lead=None, area=None), setting.spans_of(before.used)
    first = before.place
    if isinstance(before, DriveCommand) and place is not None and is_row_of_place(first.selector):
        further = along_row(before, place)
        if further is not None:
            return further, state, said
    if place is not None and first.selector in anchors(place.selector):
        return place, state, said  # "begin at the pond: ... the five trees closest to it"
    if isinstance(before, DriveCommand) and place is not None and (middle := _bare_middle(setting, first, place)):
        return place, drive(setting, state, DriveCommand(middle, before.used)), ()  # "go to the tap, photograph row 3"
    if first.shape == "area" and first.per is None:
        return in_area(setting, before, place), replace(state, within=first.selector), said
    if first.per is not None and place is not None and place.per is None and place.shape in ("one", "several"):
        if first.shape != "area":
            raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
        return in_each_row(first.per, place), replace(state, each_of=first.per), said
    if first.shape == "one" and (place is None or place.shape in ("here", "nearby", "step")):
        moves = place is not None and place.shape != "here"
        return place if moves else None, drive(setting, state, DriveCommand(first, before.used)), ()
    if first.shape in ("several", "nearby") and is_spoken_of(place):
        return _some_of_them(first, place), state, said
    of_these = place is not None and isinstance(before, Lead) and before.relation == "of" and first.shape == "several"
    if of_these and place is not None and all(picks_from_all(part) for part in place.selector.members):
        return replace(place, selector=over(place.selector, first.selector)), state, said  # "of these the oldest"
    every = None if place is None else as_every_nth(place.selector)
    if place is not None and every is not None and every.of == s.Trees() and first.shape == "several":
        return replace(place, selector=over(every, first.selector)), state, said
    raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))


def _bare_middle(setting: Setting, area: PlaceMeaning, place: PlaceMeaning) -> PlaceMeaning | None:
    """Return the middle of an area where nothing grows, before what is done at plants elsewhere; None otherwise."""
    if area.shape != "area" or area.per is not None or not setting.site.trees or is_spoken_of(place):
        return None
    named = all(one.named_tree for one in place.selector.members)
    chosen = named or (chooses_from_trees(place.selector) and not place.selector.relative)
    of_trees = place.shape in ("one", "several") and chosen
    middle = bare_points(area.selector, setting.site, 1) if of_trees or are_rows(place.selector) else None
    return None if middle is None or is_keep_out(area.selector, setting.site) else PlaceMeaning(middle, "one")


def _contrasted(setting: Setting, state: DialogueState, place: PlaceMeaning | None, used: int) -> PlaceMeaning | None:
    """Return "the last tree" behind one of a row as that of this row, and "the oldest" behind one of an area."""
    last = None if state.where is None else state.where.selector
    if place is None or last is None or place.per is not None:
        return place
    row = as_in_row(last)
    if row is not None and is_one_row(row.of) and is_end_of_site(place.selector):
        number = 1 if isinstance(place.selector, s.First) else -1
        of_row = replace(place, selector=replace(row, first=number, last=number))
        contrasts = abs(row.first) == 1
        return of_row if contrasts else setting.either("of that row, or of the site?", used, (of_row, place))
    alike = type(last) is type(place.selector) and specifies_part(place.selector)
    along = as_every_nth(place.selector) is not None and as_some(last) is None
    area = getattr(last, "of", None) if alike else next((part for part in last.walk() if are_rows(part)), None)
    open_area = (alike or along) and state.within is None and getattr(place.selector, "of", None) == s.Trees()
    if not open_area or not isinstance(area, AREAS):
        return place
    of_area = replace(place, selector=over(place.selector, area))
    return setting.either("of that area, or of the site?", used, (of_area, place))


def _some_of_them(whole: PlaceMeaning, place: PlaceMeaning | None) -> PlaceMeaning:
    """Return as many of places as are said of them ("of trees 4 to 9, ... at any two").

    Raises:
        NotComposed: They are not that many, or it is not known how many they are.
    """
    if place is None or (place.count is None and place.at_most is None):
        return whole
    if place.count is not None and place.count == whole.count:
        return whole
    open_number = whole.shape != "several" or whole.per is not None or whole.optional or whole.at_most is not None
    if place.count is None or open_number or (whole.count is not None and place.count > whole.count):
        raise NotComposed(message("it is not clear which of them", context="fault"))
    some = some_of(whole.selector, place.count)
    return replace(whole, selector=some, shape="one" if place.count == 1 else "several", count=place.count)


def _lines_at_each(
    state: DialogueState, command: CaptureCommand, place: PlaceMeaning, line: PlaceMeaning, said: Spans
) -> DialogueState:
    """Return the state after captures along a line at each of several places."""
    inside = (*state.next_step, "body")
    each = p.ForEach(id="", select=place.selector, body=EMPTY, said=said)
    state = with_step(replace(state, loop=None), each)
    spots = p.ForEach(id="", select=line.selector, body=EMPTY, said=said)
    state = with_step(replace(state, scope=inside), spots)
    state = _with_captures(state, command.things, command.times, said, (*inside, 0, "body"))
    return replace(done_at(state, place), things=command.things, scope=inside[:-2], loop=inside)


def _as_many_as_named(setting: Setting, state: DialogueState, place: PlaceMeaning) -> PlaceMeaning:
    """Return "both plants" as those that were named before.

    Raises:
        NotComposed: Not so many were named.
    """
    before = state.where
    named = None if before is None else before.count or len(ids_of(before.selector, setting.site) or ())
    if named not in (None, 0, place.count):
        raise NotComposed(message("it is not clear which of them", context="fault"))
    return replace(place, count=None)


def _at_some_of_those(state: DialogueState, command: CaptureCommand, place: PlaceMeaning, said: Spans) -> DialogueState:
    """Return the state after captures at some of the places that the robot was sent to ("at 3 of them")."""
    steps = state.block.steps
    loop = as_for_each(steps[-1]) if steps else None
    if loop is None or loop.body != EMPTY or loop.optional or loop.at_most is not None:
        raise NotComposed(message("it is not clear which of them", context="fault"))
    some = loop.select if place.count is None else some_of(loop.select, place.count)
    state = with_last_step(state, replace(loop, select=some, at_most=place.at_most))
    state = _with_captures(state, command.things, command.times, said, (*state.scope, len(steps) - 1, "body"))
    return replace(state, things=command.things, commands_in_sentence=state.commands_in_sentence + 1)


def _at_the_same_place(setting: Setting, state: DialogueState, command: CaptureCommand, said: Spans) -> DialogueState:
    """Return the state after captures where the last command was: at each of its places if it went to several."""
    if command.place is None and not state.plan.steps:
        asked = message("'{said}': at which tree or trees?", context="question", said=setting.quoted(command.used))
        raise OpenQuestion(asked)
    if command.place is None and state.block.steps and state.block.steps[-1].work is not None:
        raise NotComposed(message("it does not say where", context="fault"))  # at the end of the last row?
    if command.place is not None and state.where is None:
        raise NotComposed(message("which place is meant?", context="fault"))
    if command.place is not None and not command.place.itself and _is_of_other_case(state, command.place):
        raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
    if command.place is None and state.where is not None and state.where.in_order and _nothing_done_there(state):
        raise NotComposed(
            message("it is not clear whether this is done at each of them, or at the last", context="fault")
        )  # "go to tree 4, then tree 9 and take a picture"
    scope = state.scope
    if state.ended_by is not None and state.loop is not None:
        state, scope = _where_it_ended(state, state.loop, state.ended_by)
    elif state.loop is not None and not is_inside(scope, state.loop):
        scope = state.loop
    elif command.place is not None and command.place.shape == "those" and state.loop is None:
        raise NotComposed(message("which places are meant?", context="fault"))
    actions, done = {thing.action for thing in command.things}, {thing.action for thing in state.things}
    if command.relation == "each" and actions <= done and state.loop is not None:
        loop = for_each_at(state.plan, state.loop[:-1])  # "from three trees, one sample per tree"
        return replace(state, plan=with_node(state.plan, state.loop[:-1], replace(loop, said=(*loop.said, *said))))
    here = state.captured is not None and scope == state.captured[:-1] and command.relation == "plain"
    if command.place is not None and (command.place.shape == "those" or here) and actions <= done:
        raise NotComposed(message("it is not clear whether this is done once more", context="fault"))
    state = _with_captures(state, command.things, command.times, said, scope)
    return replace(state, things=command.things, commands_in_sentence=state.commands_in_sentence + 1)


def _is_of_other_case(state: DialogueState, place: PlaceMeaning) -> bool:
    """Return True if a place begins the other case of a condition, and may be one of the first case."""
    if not state.scope or state.scope[-1] != "otherwise" or state.block.steps:
        return False
    choice = as_choice(node_at(state.plan, state.scope[:-1]))
    nodes = () if choice is None else tuple(p.walk(choice.then))
    named = [
        node for node in nodes if node.selector is not None and not (node.only_drives and node.selector.named_marker)
    ]
    return any(not (node.visits_each and place.one_tree) for node in named)


def _nothing_done_there(state: DialogueState) -> bool:
    """Return True if the robot was sent to several places, and nothing has been done at them yet."""
    return state.loop is not None and block_at(state.plan, state.loop) == EMPTY


def _where_it_ended(state: DialogueState, body: Path, condition: Condition) -> tuple[DialogueState, Path]:
    """Return the state with a block for what is done where a condition ends a for-each, and the path of the block."""
    block = block_at(state.plan, body)
    last = block.steps[-1] if block.steps else None
    if last is None or not last.is_choice:
        choice = p.If(id="", condition=condition, then=EMPTY, said=())
        block = replace(block, steps=(*block.steps, choice))
        state = replace(state, plan=with_node(state.plan, body, block))
    return state, (*body, len(block.steps) - 1, "then")


def capture_elided(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state after what was done last at a place named at the end ("..., then at the southernmost tree")."""
    lead = state.lead
    if lead is not None and (worked := _work_elided(setting, state, lead)) is not None:
        return worked
    if lead is None or not state.things or lead.place.shape not in ("one", "several", "area"):
        return state
    if lead.relation == "topic":
        return state
    lead = _all_of_kind(state, lead)
    if lead.relation == "" and lead.place.selector.named_marker:
        raise NotComposed(message("it is not clear from which place that is measured", context="fault"))
    part = lead.place.selector == s.Trees() or specifies_part(lead.place.selector)
    if lead.relation == "" and part and _is_some_of_area(state.where):
        raise NotComposed(
            message("it is not clear whether these are some of the places before, or others", context="fault")
        )  # "take CO2 in row 9. Every other tree."
    if state.where is not None and is_end_of_site(state.where.selector) and counts_in_row(lead.place.selector):
        raise NotComposed(message("the first or last of which trees?", context="fault"))
    if state.where is not None and (mark := landmark_of(state.where.selector, lead.place.selector)) is not None:
        lead = replace(lead, place=replace(lead.place, selector=swapped(lead.place.selector, s.Here(), mark)))
    things = state.things
    follows = state.sequenced or bool(state.scope)
    of_each = follows and _is_kind(state.where) and all(one.count is None for one in things)  # "the kale, then bed 3"
    if lead.place.shape != "area":
        things = tuple(replace(thing, count=None) for thing in things)
    elif bare_points(lead.place.selector, setting.site, 1) is not None and all(
        one.count in (None, 1) for one in things
    ):
        things = tuple(replace(thing, count=None) for thing in things)  # "at the trough, at the tap and at the heap"
    elif (
        not of_each
        and not (_are_of_each(things) and (state.where is None or _is_area(state.where)))
        and (
            lead.relation == "" or not (state.where is None or _is_area(state.where) or are_rows(state.where.selector))
        )
    ):
        raise NotComposed(message("at every tree, or at how many?", context="fault"))
    of_each = of_each or (state.where is not None and state.where.shape == "several")
    of_each = of_each and lead.place.shape == "area"
    again = CaptureCommand(things, lead.place, lead.used, relation="of" if of_each else lead.relation)
    return capture(setting, replace(state, lead=None), again)


def _all_of_kind(state: DialogueState, lead: Lead) -> Lead:
    """Return "(photograph the kale, then) the basil" as all of it, like the kind before, though it may be one plant."""
    some = as_some(lead.place.selector)
    whole = lead.place.shape == "area"
    kind = as_where(lead.place.selector) if whole else None if some is None or some.count != 1 else as_where(some.of)
    before = state.where
    if kind is None or before is None or before.shape != "several" or not is_by_attribute(before.selector):
        return lead
    if before.optional or not (state.sequenced or state.scope):
        return lead  # "as many onions as you can, the Sturon first"
    marked = not isinstance(kind.value, str) or not is_unmarked(kind.attribute, kind.value)
    if before.count is not None or (marked and not whole):
        return lead
    return replace(lead, place=replace(lead.place, selector=kind, shape="several", count=None))


def _work_elided(setting: Setting, state: DialogueState, lead: Lead) -> DialogueState | None:
    """Return the state after the last work was done at another place, too ("mow the slope, then the wet corner")."""
    before = state.block.steps
    if not before and state.scope and node_at(state.plan, state.scope[:-1]).is_optional_step:
        before = block_at(state.plan, state.scope[:-2]).steps[: int(state.scope[-2])]  # "and the bank too, if it fits"
    last = before[-1].work if before else None
    place = lead.place
    if last is None or not last.action or place.shape != "area" or place.per is not None or lead.relation == "topic":
        return None
    if last.mode not in ("rows", "area") or are_rows(place.selector) != are_rows(last.along) or place.like is not None:
        return None
    node = replace(last, id="", along=place.selector, said=setting.spans_of(lead.used))
    return with_step(replace(state, lead=None), node)


def _is_some_of_area(place: PlaceMeaning | None) -> bool:
    """Return True for so many trees of an area, whichever these are."""
    some = None if place is None else as_some(place.selector)
    return some is not None and isinstance(some.of, AREAS)


def _is_area(place: PlaceMeaning | None) -> bool:
    """Return True for all trees of areas; "the yellow trees in row 1, then in row 3" means the yellow ones there."""
    parts = () if place is None else tuple(place.selector.walk())
    return bool(parts) and all(isinstance(part, (*AREAS, s.UnionOf, s.Trees, s.Ordered)) for part in parts)


def _is_kind(place: PlaceMeaning | None) -> bool:
    """Return True for all plants of a description, wherever they grow."""
    if place is None or place.shape != "several" or place.count is not None or place.optional:
        return False
    parts = tuple(place.selector.walk())
    return is_by_attribute(place.selector) and not any(isinstance(part, AREAS) for part in parts)


def _are_of_each(things: tuple[Thing, ...]) -> bool:
    """Return True for captures in the plural without a number, which are made at each tree of an area."""
    return bool(things) and all(thing.plural and thing.count is None for thing in things)


def capture_again(setting: Setting, state: DialogueState, command: Again) -> DialogueState:
    """Return the state after what was done at the last place was done at another one."""
    if command.drives:
        return driven_to_and_fro(setting, capture_elided(setting, state), command)
    if command.times:
        return done_more_times(setting, capture_elided(setting, state), command)
    place, steps = command.place, _steps_before(state)
    of_several = place is not None and place.shape in ("several", "area") and place.per is None
    if place is not None and of_several and not steps and state.open and state.scope:
        there = _moved_from(state.tested_at[0], place)
        return capture(setting, state, CaptureCommand((Thing(LAST_THING, plural=True),), there, command.used))
    if place is not None and place.shape == "area" and place.per is None:
        return repeated_in(setting, state, place.selector, command.used)
    if place is None or not steps or steps[-1].is_choice:
        return process_again(setting, state, command)
    if place.per is not None or steps[-1].is_optional_step or steps[-1].caught:
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    if place.shape not in ("one", "several"):
        raise NotComposed(message("it is not clear what is repeated, and where", context="fault"))
    said = setting.spans_of(command.used)
    captures = [replace(act, at=None, at_said=(), reading="", said=said) for act in captures_at_last_place(steps)]
    if not captures:
        raise NotComposed(message("it is not clear what is repeated", context="fault"))
    if place.shape == "one":
        state, inside = drive(setting, state, DriveCommand(place, command.used)), state.scope
    else:
        loop = p.ForEach(id="", select=place.selector, body=EMPTY, said=said)
        inside = (*state.next_step, "body")
        state = replace(with_step(state, loop), loop=inside)
    for act in captures:
        state = with_capture(state, act, inside)
    return done_at(state, place)


def _moved_from(tested: PlaceMeaning | None, place: PlaceMeaning) -> PlaceMeaning:
    """Return the places of another area that are chosen like those of the readings that the last condition tests."""
    if tested is None or tested.shape not in ("one", "several") or place.each or place.count is not None:
        return place
    there = moved_to(tested.selector, place.selector)
    if there == place.selector and (place.shape == "several" or tested.shape == "one"):
        return place
    return replace(tested, selector=there, each=tested.shape == "several", tokens=place.tokens)


def _steps_before(state: DialogueState) -> tuple[p.Node, ...]:
    """Return the steps before the next command if it stands in the plan itself, or begins an optional step there."""
    if not state.scope:
        return state.plan.steps
    *outer, number, _ = state.scope
    begins_optional = not outer and not state.block.steps and state.plan.steps[-1].is_optional_step
    return state.plan.steps[:-1] if begins_optional and number == len(state.plan.steps) - 1 else ()
