"""Places of which something else is said than of the others: "one picture in each bed, but three in bed 5"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.plans import as_for_each, with_node
from fieldhand.planning.grammar.dialogue.state import DialogueState, Setting
from fieldhand.planning.grammar.meaning import CaptureCommand, Connective
from fieldhand.planning.grammar.places.exceptions import drawn_from
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.selections import swapped


def without_exceptional(
    setting: Setting, state: DialogueState, command: CaptureCommand, joint: Connective | None
) -> DialogueState:
    """Return the state without the visits in whose stead a command has others: behind "but", or with another number.

    Args:
        setting: Robot and site that the request is read for.
        state: State before the command.
        command: Captures, each of a known action.
        joint: Connective before them.
    """
    steps, place = state.block.steps, command.place
    loop = as_for_each(steps[-1]) if steps else None
    if joint is None or joint.then or joint.first or place is None or loop is None or loop.optional:
        return state
    acts = [act for child in loop.body.children if (act := child.act) is not None]
    same = len(acts) == len(loop.body.children) and {a.action for a in acts} == {one.action for one in command.things}
    number = command.times * max((one.count or 1 for one in command.things), default=1)
    other_number = joint.bare and all(act.count != number for act in acts)
    if not same or not (joint.contrasts or other_number):
        return state
    area = drawn_from(place.selector) or place.selector
    part = None if area.relative else ids_of(area, setting.site)
    if not part:
        return state
    kept: list[s.Selector] = []
    whole: set[str] = set()
    for one in loop.select.members:
        base = drawn_from(one) or one
        among = ids_of(base, setting.site) or set()
        whole |= among
        if not among <= part:
            kept.append(swapped(one, base, s.Excluding(places=area, of=base)) if among & part else one)
    if not part < whole or not kept:
        return state
    select = kept[0] if len(kept) == 1 else s.UnionOf(parts=tuple(kept))
    path = (*state.scope, len(steps) - 1)
    return replace(state, plan=with_node(state.plan, path, replace(loop, select=select)))
