"""Recharging, as a step or for the whole mission, and conditions on the battery."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.language import message
from fieldhand.language.words import say_duration, say_number
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.dialogue.state import (
    DialogueState,
    NotComposed,
    OpenQuestion,
    Setting,
    with_assumption,
    with_last_step,
    with_step,
)
from fieldhand.planning.grammar.meaning import MOST_LAPS, Amount, LimitClause, PlaceMeaning, RechargeClause, Test
from fieldhand.robot.model import RobotProfile
from fieldhand.task import conditions as c
from fieldhand.task import plan as p
from fieldhand.task.battery_condition import BatteryBelow


def recharged(setting: Setting, state: DialogueState, command: RechargeClause) -> DialogueState:
    """Return the state after a charge: a step of the plan, or a rule of the whole mission.

    Raises:
        NotComposed: It is not clear when it charges.
    """
    said = setting.spans_of(command.used)
    if command.always:
        return replace(state, recharging=(*state.recharging, (command, said)))
    if state.lead is not None or state.area is not None:
        raise NotComposed(message("it is not clear when the robot is to charge", context="fault"))
    step = p.Recharge(id="", until_percent=command.until, duration_s=command.seconds, said=said)
    state = with_step(state, step)
    charger = PlaceMeaning(s.Marker(name="charger"), "one")
    return replace(state, where=charger, where_scope=state.scope, loop=None, captured=None, choice=None)


def reserve_in_percent(
    setting: Setting, state: DialogueState, command: LimitClause
) -> tuple[DialogueState, LimitClause]:
    """Return a reserve with its time converted to percent of the battery, and the state that says so."""
    if not command.keep or command.amount.unit != "seconds":
        return state, command
    percent = round(driving_percent(setting.robot, command.amount.number), 1)
    taken = message(
        "'{said}' is taken as {percent} % of the battery: what {robot} takes to drive for {time}.",
        context="assumption",
        said=setting.quoted(command.used),
        percent=say_number(percent),
        robot=setting.robot.name,
        time=say_duration(command.amount.number),
    )
    return with_assumption(state, taken), replace(command, amount=Amount(number=percent, unit="percent"))


def done_until_low(setting: Setting, state: DialogueState, command: LimitClause) -> DialogueState | None:
    """Return the state after laps around an area until the battery is low; None behind what ends by itself.

    Raises:
        OpenQuestion: A capture at one place is to go on, and it does not say how often it is made.
    """
    last = state.block.steps[-1] if state.block.steps else None
    if last is None or state.awaits_command or command.amount.unit != "percent":
        return None
    if last.act is not None:
        raise OpenQuestion(message("How often?", context="question"))
    if last.work is None or not last.work.goes_around:
        return None
    times = last.work.laps if last.work.laps > 1 else MOST_LAPS
    until, said = BatteryBelow(percent=command.amount.number), setting.spans_of(command.used)
    return with_last_step(state, p.Repeat(id="", times=times, body=replace(last.work, laps=1), until=until, said=said))


def driving_percent(robot: RobotProfile, seconds: float) -> float:
    """Return the percent of a full battery that a robot takes to drive for some seconds."""
    return robot.percent(robot.speed_m_s * seconds, seconds)


def battery_condition(state: DialogueState, test: Test) -> c.Condition:
    """Return the condition of a test of the battery.

    Raises:
        NotComposed: Nothing is done before it, so that the battery of a charged robot would be tested.
    """
    if not state.plan.steps:
        raise NotComposed(
            message("the battery would be tested once, before the work: say after which work", context="fault")
        )
    below = BatteryBelow(percent=test.value)
    return c.Not(condition=below) if (test.check in ("gt", "ge")) != test.negated else below


@dataclass(frozen=True, kw_only=True)
class MeantRecharging:
    """Rules of recharging of a mission, from everything that is said of it.

    Attributes:
        below_percent, until_percent, at_most: As in :class:`~fieldhand.task.frames.Constraints`.
        said: Ranges of the request.
    """

    below_percent: float | None
    until_percent: float | None
    at_most: int | None
    said: tuple[p.Span, ...]


def recharging_of(state: DialogueState) -> MeantRecharging | None:
    """Return how the mission recharges; None if nothing is said of it. The first of several values counts."""
    if not state.recharging:
        return None
    said = [clause for clause, _ in state.recharging]
    return MeantRecharging(
        below_percent=next((one.below for one in said if one.below is not None), None),
        until_percent=next((one.until for one in said if one.until is not None), None),
        at_most=next((one.at_most for one in said if one.at_most is not None), None),
        said=tuple(span for _, spans in state.recharging for span in spans),
    )
