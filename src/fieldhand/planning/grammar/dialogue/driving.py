"""Commands to drive, to return and to visit places in an order."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal, cast

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.places.picks.ordered import Order
from fieldhand.planning.grammar.dialogue.fitting import in_area, in_each_row, of_each_before, of_each_row
from fieldhand.planning.grammar.dialogue.plans import (
    EMPTY,
    as_for_each,
    for_each_at,
    is_conditional,
    is_inside,
    with_node,
)
from fieldhand.planning.grammar.dialogue.series import limited_rounds
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    Spans,
    done_at,
    with_assumption,
    with_joints,
    with_step,
)
from fieldhand.planning.grammar.meaning import DriveCommand, Home, InAnOrder, Lead, PlaceMeaning, VisitLimit
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.sampling import bare_points
from fieldhand.planning.grammar.places.vague import as_many_of_best
from fieldhand.planning.selections import (
    are_rows,
    as_every_nth,
    as_in_row,
    as_ordered,
    as_some,
    blocks_of,
    chooses_from_trees,
    is_gate,
    is_next_to_here,
    is_one_row,
    measures_distance,
    starts_here,
    swapped,
    with_number,
)
from fieldhand.site.model import Site
from fieldhand.task import plan as p
from fieldhand.terms import Side

#: Sides from which trees are counted if nothing else is said.
_USUAL_SIDES = frozenset({"north", "west"})


def drive(setting: Setting, state: DialogueState, command: DriveCommand) -> DialogueState:
    """Return the state after a drive to one or several places, or into an area of which more is said."""
    said, place = setting.spans_of(command.used), command.place
    if command.begins and place.selector == s.Marker(name="start"):
        return with_joints(state, said)  # every mission begins there
    if command.begins and state.plan.steps:
        raise NotComposed(message("where to begin has to be said before the work", context="fault"))
    command = replace(command, begins=command.begins and not command.to)  # "start at the trough", and drive on from it
    area, leads = state.area, False
    if state.lead is not None and place.shape == "those" and state.lead.place.shape in ("one", "several"):
        before = state.lead  # "our focus is the oldest trees: drive to them"
        return drive(setting, replace(state, lead=None), DriveCommand(before.place, before.used | command.used))
    if state.lead is not None and state.lead.place.shape == "one" and place.shape in ("one", "step"):
        leads = True
        before = state.lead  # "From tree 4 drive to tree 9."
        state = replace(state, lead=None)
        if before.place.selector == s.Marker(name="start") and not state.plan.steps:
            state = with_joints(state, setting.spans_of(before.used))  # every mission begins there
        else:
            state = drive(setting, state, DriveCommand(before.place, before.used))
    if area is not None and place.shape == "one" and not place.selector.relative and not area.along:
        leads = True  # "Go to row 3, then go to tree 5."
        if is_there(setting, area, place):
            state, place = replace(state, area=None), in_area(setting, area, place)
            said = (*setting.spans_of(area.used), *said)
        else:
            state = enter(setting, state, area)
    if area is not None and place.shape == "several" and chooses_from_trees(place.selector):
        state, place = replace(state, area=None), in_area(setting, area, place)  # "drive down row 3, visit every tree"
        said = (*setting.spans_of(area.used), *said)
    lead = state.lead
    if lead is not None and lead.place.shape == "area" and place.shape in ("one", "several"):
        rows = lead.place.per
        if rows is not None and place.per is not None:
            raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
        there = in_area(setting, lead, place) if rows is None else in_each_row(rows, place)
        state, place = replace(state, lead=None, each_of=rows), there  # "in row 3 (in each row), visit every tree"
        said = (*setting.spans_of(lead.used), *said)
    elif lead is None:
        place = of_each_before(state, place) or place
    require_known(setting, state, place, command.used)
    if state.awaits_command:
        raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
    if place.shape == "several" and place.per is not None:
        place = of_each_row(setting, place)
    if not leads and _stands_idle(state) and not place.selector.relative and not command.returns:
        raise NotComposed(message("it does not say what to do at the place before", context="fault"))
    if place.shape in ("one", "step"):
        state = with_step(replace(state, loop=None), p.GoTo(id="", place=place.selector, said=said))
        return done_at(replace(state, returned=command.returns), place)
    if place.shape == "area" and place.per is None:
        where = state.where if place.selector.relative else place
        return replace(state, area=command, where=where, where_scope=state.scope, loop=None)
    if place.shape == "nearby":
        return replace(state, lead=Lead(place, command.used))  # how many depends on what is done there
    if place.shape == "several" and place.per is None:
        inside = (*state.next_step, "body")
        state = with_step(state, visits(place, said))
        return replace(done_at(state, place), loop=inside)
    raise NotComposed(message("it is not clear where to", context="fault"))


def is_there(setting: Setting, area: DriveCommand, place: PlaceMeaning | None) -> bool:
    """Return True if the next place is one of the area that the robot was sent to, which both readings may be."""
    if place is None or not chooses_from_trees(place.selector):
        return False
    return setting.either("of that area, or of the whole site?", area.used, (True, False))


def enter(setting: Setting, state: DialogueState, area: DriveCommand) -> DialogueState:
    """Return the state after a drive to any tree of the area that the robot was sent to, or into its middle."""
    selector = area.place.selector
    one = PlaceMeaning(bare_points(selector, setting.site, 1) or s.Take(count=1, of=selector), "one")
    return drive(setting, replace(state, area=None), DriveCommand(one, area.used))


def _stands_idle(state: DialogueState) -> bool:
    """Return True if the robot was just sent to a place where nothing has been done yet; a gate is passed."""
    steps = state.block.steps
    last = steps[-1] if steps else None
    return last is not None and last.only_drives and not (last.selector is not None and is_gate(last.selector))


def visits(place: PlaceMeaning, said: Spans) -> p.ForEach:
    """Return a for-each over places, with nothing to do at them yet."""
    return p.ForEach(
        id="",
        select=place.selector,
        body=EMPTY,
        optional=place.optional,
        at_most=place.at_most,
        order="given" if place.in_order else "best",
        reward="" if place.ranked is None else place.ranked[0],
        reward_by="value" if place.ranked is None else place.ranked[1],
        said=said,
    )


def _counts_in_no_row(part: s.Selector, site: Site) -> bool:
    """Return True for "plant 7" where several rows have one, and the ids of plants are no numbers."""
    number = part.named_tree
    if not number.isdigit() or any(tree.place.id.isdigit() for tree in site.trees):
        return False
    return sum(1 <= int(number) <= len(row.trees) for row in site.planting.rows) > 1


def require_known(setting: Setting, state: DialogueState, place: PlaceMeaning | None, used: int) -> None:
    """Refuse places that refer to one which is not known, or which an optional step may leave out.

    Raises:
        NotComposed: The place is not known.
    """
    if place is not None and place.shape == "unknown":
        said = setting.quoted(used)
        if measures_distance(place.selector) and any(are_rows(part) for part in place.selector.walk()):
            raise NotComposed(message("what is near, the tree or the row?"), advice=message("name the row"))
        if measures_distance(place.selector):
            raise OpenQuestion(message("'{said}': within how many metres?", context="question", said=said))
        if place.selector == s.Trees():
            raise OpenQuestion(message("'{said}': which ones?", context="question", said=said))
        several = message("'{said}': which rows?", context="question", said=said)
        raise OpenQuestion(several if place.count else message("'{said}': which row?", context="question", said=said))
    if place is not None and place.shape == "nowhere":
        raise NotComposed(place.fault)
    parts = [] if place is None or place.shape in ("here", "those") else list(place.selector.walk())
    if any((row := as_in_row(part)) is not None and not any(are_rows(of) for of in row.of.walk()) for part in parts):
        raise NotComposed(
            message("'{said}' could be counted in several ways", said=setting.quoted(place.tokens if place else used)),
            advice=message("say of which row and from which end: 'the third tree of row 4 from the north'"),
        )
    if any(_counts_in_no_row(part, setting.site) for part in parts):
        raise OpenQuestion(message("'{said}': which row?", context="question", said=setting.quoted(used)))
    from_here = [part for part in parts if starts_here(part)]
    if from_here:
        if state.where is None or (state.where.shape != "one" and not is_inside(state.scope, state.loop or (-1,))):
            asked = message("'{said}': from which tree?", context="question", said=setting.quoted(used))
            raise OpenQuestion(asked)
        sides = {part.towards for part in from_here if isinstance(part, s.AlongRow)} & {*SIDES}
        if not all(_rows_run_to(side, setting.site) for side in sides):
            raise NotComposed(message("the rows have no end on that side", context="fault"))
    after_several = state.where is not None and state.where.shape == "several"
    beside_it = any(is_next_to_here(part) for part in parts)
    if beside_it and after_several and not is_inside(state.scope, state.loop or (-1,)):
        raise NotComposed(message("it is not clear next to which of them", context="fault"))
    refers = not parts or s.Here() in parts
    if refers and state.where is not None and may_be_left_out(state):
        said = setting.quoted(used)
        asked = message("'{said}': where, if what comes before it is left out?", context="question", said=said)
        raise OpenQuestion(asked)


def may_be_left_out(state: DialogueState) -> bool:
    """Return True if the last command stands in a block that does not contain the next one."""
    return state.where_scope is not None and not is_inside(state.scope, state.where_scope)


def _rows_run_to(side: str, site: Site) -> bool:
    """Return True if the rows of the site run towards a side."""
    east_west = {45 <= block.bearing_deg % 180 <= 135 for block in site.planting.blocks}
    return east_west == {side in ("east", "west")}


def go_home(setting: Setting, state: DialogueState, command: Home) -> DialogueState:
    """Return the state after the end of the mission was said: a drive if it is the end in one case only."""
    said = setting.spans_of(command.used)
    if state.awaits_command:
        raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
    if state.home is not None:
        raise NotComposed(message("the mission cannot end in two ways", context="fault"))
    if command.to_it:
        marker = _marker_spoken_of(state)
        if marker.named_marker == "charger":
            return drive(setting, state, DriveCommand(PlaceMeaning(marker, "one"), command.used, returns=True))
        command = replace(command, then="return_to_start" if marker.named_marker == "start" else "return_to_end")
    if command.then is None:
        markers = setting.site.markers
        if not {"start", "end"} & set(markers):
            raise NotComposed(message("it is not clear where that is", context="fault"))
        command = replace(command, then="return_to_start" if "start" in markers else "return_to_end")
        if command.then == "return_to_start":
            said_home = setting.quoted(command.used).strip(" ,;")
            back = message("'{said}' means back to the start.", context="assumption", said=said_home)
            state = with_assumption(state, back)
    steps = state.block.steps
    if steps and steps[-1].ends_plan:
        return replace(state, nominal=command.then, nominal_said=said)
    if not is_conditional(state.scope):
        state = replace(state, scope=())  # the way home is never optional
    if state.loop is not None and is_inside(state.scope, state.loop):
        # "at each tree ..., if it is high, go home": the other trees are not visited then
        stopped = with_step(state, p.StopMission(id="", said=said))
        return replace(stopped, nominal=command.then, commands_in_sentence=state.commands_in_sentence + 1)
    if state.scope:
        return replace(drive(setting, state, _way_home(command)), in_case=command.then)
    return replace(state, nominal=command.then, nominal_said=said, home=command, open=False)


def _marker_spoken_of(state: DialogueState) -> s.Selector:
    """Return the marker from which the last places were measured ("every tree within 7 m of the start").

    Raises:
        NotComposed: There is none, or one of the places may be meant.
    """
    last = state.where
    markers = [] if last is None else [part for part in last.selector.walk() if part.named_marker]
    if last is None or last.shape != "several" or len(markers) != 1:
        raise NotComposed(message("it is not clear what to return to", context="fault"))
    return markers[0]


def driven_home(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state with the return as a drive, since something follows it."""
    home = state.home
    if home is None:
        return state
    if home.when_done:
        raise NotComposed(message("something follows the end of the mission", context="fault"))
    return drive(setting, replace(without_home(state), scope=()), _way_home(home))


def without_home(state: DialogueState) -> DialogueState:
    """Return the state without the end of the mission."""
    return replace(state, home=None, nominal=None, nominal_said=())


def _way_home(home: Home) -> DriveCommand:
    """Return the drive to the place where the mission ends."""
    marker = s.Marker(name="start" if home.then == "return_to_start" else "end")
    return DriveCommand(PlaceMeaning(marker, "one"), home.used)


def put_in_order(setting: Setting, state: DialogueState, command: InAnOrder) -> DialogueState:
    """Return the state with the last for-each in an order; an order that is said first waits for its places."""
    said = setting.spans_of(command.used)
    if command.by == "any" and command.attribute:  # "always going to the nearest one next"
        told = message(
            "'{said}': the places are visited in the order in which all of the drives together are shortest.",
            context="assumption",
            said=setting.quoted(command.used),
        )
        state, command = with_assumption(state, told), replace(command, attribute="")
    if command.by == "each" and state.area is not None:
        place = replace(state.area.place, each=True)  # "along row 3 tree by tree"
        return replace(state, area=replace(state.area, place=place, used=state.area.used | command.used))
    if not command.by and _are_in_order(state):
        return _with_order_said(state, said)  # "tree 100, then 23, then 157, in that order"
    if command.by == "any" and state.loop is None and _may_change_places(state):
        free = p.AnyOrder(id="", steps=state.plan.steps, said=said)
        return replace(state, plan=p.InOrder(id="", steps=(free,)), captured=None, choice=None, where=None)
    if state.loop is None:
        if state.order is not None or (state.commands_in_sentence and state.lead is None):
            raise NotComposed(message("an order needs several places", context="fault"))
        return replace(state, order=command)
    path = state.loop[:-1]
    loop = for_each_at(state.plan, path)
    actions = [child.act.action for child in loop.body.children if child.act is not None]
    if command.by == "reverse" and len(set(actions)) < len(actions):  # "then again in the opposite order"
        raise NotComposed(message("it is not clear in which order", context="fault"))
    return replace(state, plan=with_node(state.plan, path, ordered(setting, loop, command, said)))


def _may_change_places(state: DialogueState) -> bool:
    """Return True for several captures, each at a place of its own, of which none depends on another."""
    steps = state.plan.steps
    alone = all(step.act is not None and step.selector is not None and not step.selector.relative for step in steps)
    return alone and len(steps) > 1 and not state.scope and not state.awaits_command and not state.sequenced


def with_order_kept(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state at the end of commands that are done in the order that was announced ("in this order: ...")."""
    order = state.order
    if order is None or order.by or not _are_in_order(state):
        return state
    return put_in_order(setting, replace(state, order=None), order)


def _are_in_order(state: DialogueState) -> bool:
    """Return True for several commands that are done one after the other, or several captures at each place."""
    if state.scope or state.awaits_command:
        return False
    steps = state.plan.steps
    if len(steps) == 1 and (loop := as_for_each(steps[0])) is not None:
        named = len(loop.select.members) > 1 or loop.select.keeps_order
        return len(loop.body.children) > 1 and not named
    return len(steps) > 1


def _with_order_said(state: DialogueState, said: Spans) -> DialogueState:
    """Return the state with the places that were named one by one in that order, where that was said."""
    for number, step in enumerate(state.plan.steps):
        loop = as_for_each(step)
        if loop is not None and len(loop.select.members) > 1 and not loop.optional and loop.at_most is None:
            state = replace(state, plan=with_node(state.plan, (number,), replace(loop, order="given")))
    only = as_for_each(state.plan.steps[0]) if len(state.plan.steps) == 1 else None
    if only is None:
        return with_joints(state, said)
    return replace(state, plan=with_node(state.plan, (0,), replace(only, said=(*only.said, *said))))


def ordered(setting: Setting, loop: p.ForEach, command: InAnOrder, said: Spans) -> p.ForEach:
    """Return a for-each in an order.

    Raises:
        NotComposed: The places are not fixed, or what the order refers to is unclear.
    """
    said = (*loop.said, *said)
    if command.by == "any" and loop.order != "best":
        raise NotComposed(message("the places cannot have two different orders", context="fault"))
    if command.by in ("each", "any"):
        return replace(loop, said=said)
    known = as_ordered(loop.select)
    if known is not None and known.by == command.by != "attribute":
        return replace(loop, said=said)  # "starting at the north end ..., and work your way south"
    if known is not None and known.by == command.by and known.attribute in (command.attribute, ""):
        way = replace(known, attribute=command.attribute, descending=command.descending)
        return replace(loop, select=way, said=said)  # "in order of age, oldest first"
    only_in_order = loop.order == "given" and known is None and len(loop.select.members) == 1
    if only_in_order and command.by and command.by != "reverse":
        loop = replace(loop, order="best")  # "in order from north to south"
    if loop.optional and loop.order == "best" and command.by == "attribute" and not loop.reward:
        first: Literal["highest", "lowest"] = "highest" if command.descending else "lowest"
        return replace(loop, reward=command.attribute, reward_by=first, said=said)  # "as many as you can, oldest first"
    if loop.order == "given" or loop.optional or loop.at_most is not None:
        raise NotComposed(message("an order of places cannot be combined with a choice of how many", context="fault"))
    if command.by == "reverse":
        backwards = _reversed(loop.select, setting.site)
        every, ordered = as_every_nth(loop.select), as_ordered(backwards)
        if every is not None and ordered is not None:
            side = cast(Side, ordered.by.partition("_to_")[0])
            ways = (every, replace(every, counted_from=side))
            backwards = replace(ordered, of=setting.either("counted from there?", command.used, ways))
        return replace(loop, select=backwards, order="given", said=said)
    if not command.by:
        return replace(loop, order="given", said=said)
    by = cast(Order, command.by)
    counted = _counted_from(setting, loop.select, command)
    select = s.Ordered(by=by, attribute=command.attribute, descending=command.descending, of=counted)
    return replace(loop, select=select, order="given", said=said)


def _counted_from(setting: Setting, select: s.Selector, command: InAnOrder) -> s.Selector:
    """Return trees that are counted along their rows from the side where the visits begin.

    Raises:
        NotComposed: The rows do not run that way.
        Fork: The numbers may be those of the row as well ("trees 1 to 6, from the south").
    """
    if command.by in ("attribute", "rows"):
        return select
    side = command.by.partition("_to_")[0]
    along = side in SIDES and _rows_run_to(side, setting.site)
    for part in tuple(select.walk()):
        every, some = as_every_nth(part), as_in_row(part)
        if every is not None and every.counted_from == "usual":
            if not along:
                raise NotComposed(
                    message("it is not clear whether the trees are counted or visited from there", context="fault")
                )
            select = swapped(select, every, replace(every, counted_from=cast(Side, side)))
        elif some is not None and along and side not in _USUAL_SIDES and _are_foremost(some):
            ways = (replace(some, counted_from=cast(Side, side)), some)
            select = swapped(select, some, setting.either("counted from there?", command.used, ways))
    return select


def _are_foremost(some: s.InRow) -> bool:
    """Return True for the first few trees of rows, which the phrase counts from no side."""
    return some.counted_from == "usual" and 1 == some.first < some.last


def _reversed(select: s.Selector, site: Site) -> s.Selector:
    """Return places in the reverse of the order in which they are named, or of that of their row.

    Raises:
        NotComposed: They have no order that could be reversed.
    """
    members = select.members
    if len(members) > 1 and all(one.single for one in members):
        return s.UnionOf(parts=tuple(reversed(members)))
    rows = {part for part in select.walk() if are_rows(part)}
    named = {part.block for part in blocks_of(select)}
    runs = {one.runs_east_west for one in site.planting.blocks if not named or one.name in named}
    if len(rows) != 1 or len(runs) != 1 or not is_one_row(rows.pop()):
        raise NotComposed(message("it is not clear which order is reversed", context="fault"))
    return s.Ordered(by="east_to_west" if runs.pop() else "south_to_north", of=select)


def limit_visits(setting: Setting, state: DialogueState, command: VisitLimit) -> DialogueState:
    """Return the state with a maximum number of visits of the last for-each, or as many as the budget allows.

    Raises:
        NotComposed: It has one, or visits a number of places that was named.
    """
    if state.loop is None:
        said = setting.spans_of(command.used)
        rounds = None if command.count is None else limited_rounds(state, command.count, said)
        if rounds is None:
            raise NotComposed(message("it is not clear of what so many are meant", context="fault"))
        return rounds
    path = state.loop[:-1]
    loop = for_each_at(state.plan, path)
    counted = state.where is not None and state.where.count is not None
    if command.count is None and state.where is not None and state.where.vague:
        ranked = as_many_of_best(replace(state.where, selector=loop.select))
        loop, counted = replace(loop, select=ranked.selector), False
        if ranked.ranked is not None:
            loop = replace(loop, reward=ranked.ranked[0], reward_by=ranked.ranked[1])
    if command.count is None and as_some(loop.select) is None:
        counted = False  # "from the ten oldest trees, as many as you can"
    if loop.optional or loop.at_most is not None or counted:
        raise NotComposed(message("it is not clear whether so many are meant, or at most so many", context="fault"))
    said = (*loop.said, *setting.spans_of(command.used))
    select = loop.select if command.count is None else with_number(loop.select, command.count)
    limited = replace(loop, select=select, at_most=command.count, optional=command.count is None, said=said)
    return replace(state, plan=with_node(state.plan, path, limited))
