"""Commands to work along rows, through aisles, over areas and along their edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.commands.going_round import mounted_side, usual_way
from fieldhand.planning.grammar.commands.laps import goes_around, is_thin
from fieldhand.planning.grammar.dialogue.open_amounts import require_amounts
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    Spans,
    with_step,
)
from fieldhand.planning.grammar.dialogue.that_ground import ground_spoken_of
from fieldhand.planning.grammar.meaning import UNNAMED_ROWS, DriveCommand, WorkCommand
from fieldhand.planning.grammar.places.counted import row_itself
from fieldhand.planning.grammar.places.planted_rows import filled_rows
from fieldhand.planning.grammar.places.sampling import bare_points, is_keep_out
from fieldhand.planning.grammar.row_by_row import MOST_ONE_BY_ONE, one_by_one
from fieldhand.planning.selections import are_rows, is_one_row
from fieldhand.task import plan as p
from fieldhand.task.nodes.work_along import WorkHeading

_OPPOSITE: dict[WorkHeading, WorkHeading] = {"north": "south", "south": "north", "east": "west", "west": "east"}


def work_along(setting: Setting, state: DialogueState, command: WorkCommand) -> DialogueState:
    """Return the state after work along rows or over an area, which may be that to which the robot was just sent.

    Raises:
        NotComposed: It does not say where, or the place before it has its own work to come.
    """
    said: Spans = setting.spans_of(command.used)
    along, mode = command.along, command.mode
    if along == UNNAMED_ROWS:
        raise OpenQuestion(message("'{said}': which rows?", context="question", said=setting.quoted(command.used)))
    if along is None and state.area is None and state.lead is None and (ground := _ground_of(state)) is not None:
        along, mode = ground, "area"
    if along is None:
        before = state.area or state.lead
        named = before is not None and before.place.shape == "area" and not before.place.selector.relative
        ground = before.place.selector if before is not None and named else None if before else ground_spoken_of(state)
        if ground is None or (before is None and not command.it):
            raise NotComposed(
                message("it does not say where", context="fault"),
                advice=message("say along which rows, between which rows, or over which area"),
            )
        along, said = ground, (*(() if before is None else setting.spans_of(before.used)), *said)
        state = replace(state, area=None, lead=None)
        implement = setting.robot.action[command.action].implement
        if not are_rows(along) and implement is not None and implement.covers:
            mode = "area"
    elif state.awaits_command:
        elsewhere = state.area is not None and state.area.place.selector != along
        state = driven_to_ground(setting, state) if elsewhere else state
    if state.awaits_command:
        area = state.area or state.lead
        if area is None or area.place.shape != "area" or area.place.selector != along:
            raise NotComposed(message("it is not clear at which of two places this is done", context="fault"))
        said = (*setting.spans_of(area.used), *said)
        state = replace(state, area=None, lead=None)
    if mode == "rows" and command.along is None and is_keep_out(along, setting.site):
        mode = "perimeter"
    if mode == "perimeter" and not command.faced and is_keep_out(along, setting.site):
        _require_facing(setting, command)
    if command.edge_side:
        _require_side(setting, command, along, mode)
    require_amounts(setting, command.action, command.parameters, command.used)
    node = p.WorkAlong(
        action=command.action,
        parameters=command.parameters,
        along=along,
        mode=mode,
        sides=command.sides,
        every=command.every,
        heading=_heading_back(state) if command.back else command.heading,
        laps=command.laps,
        optional=command.optional,
        said=said,
    )
    rows = _each_row(along, setting) if command.rests_rows else ()
    if command.rests_rows and not 0 < len(rows) <= MOST_ONE_BY_ONE:
        raise NotComposed(message("it is not clear along which rows", context="fault"))
    once = replace(node, laps=1)
    state = _with_rests(state, once, command, said, rows) if command.rest_s else with_step(state, node)
    return replace(state, loop=None, captured=None, where=None, commands_in_sentence=state.commands_in_sentence + 1)


def _heading_back(state: DialogueState) -> WorkHeading:
    """Return the direction opposite to that of the work before; any if it has none.

    Raises:
        NotComposed: No work stands before.
    """
    steps = state.plan.steps
    last = steps[-1] if steps else None
    if not isinstance(last, p.WorkAlong):
        raise NotComposed(message("no work stands before this, on the way back from which it is done", context="fault"))
    return _OPPOSITE.get(last.heading, "any")


def _each_row(along: s.Selector, setting: Setting) -> Sequence[s.Selector]:
    """Return rows one by one, as they are named, or by their numbers: whole ones by their names."""
    if all(is_one_row(part) for part in along.members):
        return along.members
    whole = [row_itself(row, setting.site) for row in filled_rows(along, setting.site)]
    return sorted(whole, key=lambda row: (len(row.first), row.first)) or one_by_one(along, setting.site)


def _with_rests(
    state: DialogueState, once: p.WorkAlong, command: WorkCommand, said: Spans, rows: Sequence[s.Selector]
) -> DialogueState:
    """Return the state after work in laps with a rest between one and the next, or row by row with rests."""
    rest = p.Wait(id="", seconds=command.rest_s, said=said)
    if command.rests_rows:
        for row in rows:
            state = with_step(with_step(state, replace(once, along=row)), rest)
        return state
    rounds: p.Node = p.InOrder(id="", steps=(once, rest))
    if command.rests_last:
        return with_step(state, p.Repeat(id="", times=command.laps, body=rounds, said=said))
    if command.laps > 2:
        rounds = p.Repeat(id="", times=command.laps - 1, body=rounds, said=said)
        return with_step(with_step(state, rounds), once)
    return with_step(with_step(with_step(state, once), rest), once)


def driven_along(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state after a drive along rows at which nothing is said to be done ("drive along rows 3 to 8")."""
    area = state.area
    if area is None or state.lead is not None or state.open or not _is_along(area):
        return state
    node = p.WorkAlong(along=area.place.selector, said=setting.spans_of(area.used))
    return with_step(replace(state, area=None), node)


def _require_side(setting: Setting, command: WorkCommand, along: s.Selector, mode: str) -> None:
    """Refuse a side of an edge that is not the one on which the robot drives anyway.

    It drives inside a fence that stands around the site, around what is solid, and on both sides of any other fence.

    Raises:
        NotComposed: It drives elsewhere.
    """
    fence = is_keep_out(along, setting.site)
    inside = fence and goes_around(along, setting.site)
    around = fence and not is_thin(along, setting.site)
    if mode == "perimeter" and {"inside": inside, "outside": around}[command.edge_side]:
        return
    if mode == "perimeter" and not fence and command.edge_side == "inside":
        return
    raise NotComposed(
        message("on which side of it the robot drives cannot be said yet", context="fault"),
        advice=message("leave the side out: it drives along both sides of a fence where it can"),
    )


def _require_facing(setting: Setting, command: WorkCommand) -> None:
    """Refuse a direction in which an implement on one side faces away from what it is driven around.

    Raises:
        NotComposed: It faces away from it.
    """
    hand = mounted_side(command.action, setting.robot)
    if hand is None or command.heading in ("any", usual_way(hand, outside=True)):
        return
    if command.heading in ("clockwise", "counterclockwise"):
        raise NotComposed(
            message("that way round it faces away from what it is driven around", context="fault"),
            advice=message("say the other direction, or 'looking outwards'"),
        )


def driven_to_ground(setting: Setting, state: DialogueState) -> DialogueState:
    """Return the state after a drive to ground where nothing is said to be done ("then go to the trough")."""
    area = state.area
    if area is None or state.lead is not None or area.along or area.begins or area.returns:
        return state
    if is_keep_out(area.place.selector, setting.site) or not area.to:
        return state
    middle = bare_points(area.place.selector, setting.site, 1) if area.place.shape == "area" else None
    if middle is None:
        return state
    return with_step(replace(state, area=None), p.GoTo(id="", place=middle, said=setting.spans_of(area.used)))


def _ground_of(state: DialogueState) -> s.Selector | None:
    """Return the zone in which the last captures were made, which "mow it" refers to; None if there is none."""
    if state.where is None:
        return None
    zones = {str(getattr(part, "zone", "")) for part in state.where.selector.members}
    zone = zones.pop()
    return s.InZone(zone=zone) if zone and not zones else None


def _is_along(area: DriveCommand) -> bool:
    selector = area.place.selector
    named = are_rows(selector) and not selector.relative
    return bool(area.along) and not area.begins and not area.returns and named and selector != s.Rows()
