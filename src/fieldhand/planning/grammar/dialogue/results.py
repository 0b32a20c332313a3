"""Wishes for results: the report states them, if the plan takes the readings."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.planning.grammar.dialogue.plans import walk
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    Setting,
    with_assumption,
)
from fieldhand.planning.grammar.dialogue.totals import also_said
from fieldhand.planning.grammar.meaning import ResultsWish


def results_reported(setting: Setting, state: DialogueState, wish: ResultsWish) -> DialogueState:
    """Return the state after a wish for a statistic of readings that are taken before it.

    Raises:
        NotComposed: Nothing before it takes such readings, or a condition decides whether they are reported.
    """
    if state.open:
        raise NotComposed(
            message("the report states the results in any case", context="fault"),
            advice=message("leave out the condition, or say what is to be done then"),
        )
    acts = [node.act.action for _, node in walk(state.plan) if node.act is not None]
    wanted = {wish.quantity} if wish.quantity else set(setting.robot.quantity)
    if not any(wanted & {*setting.robot.action[name].measures, name} for name in acts if name in setting.robot.action):
        raise NotComposed(message("nothing before it measures that", context="fault"))
    told = message(
        "'{said}': the report states every reading with its place, and the lowest, mean, median and highest one.",
        context="assumption",
        said=setting.quoted(wish.used),
    )
    *before, last = state.plan.steps
    steps = (*before, also_said(last, setting.spans_of(wish.used)))
    return with_assumption(replace(state, plan=replace(state.plan, steps=steps)), told)
