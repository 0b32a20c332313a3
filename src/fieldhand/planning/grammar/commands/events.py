"""Constructions of conditions that hold all the time: "if it rains, come home", "stop if someone is in the row"."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.conditions import reading_is
from fieldhand.planning.grammar.meaning import (
    Amount,
    CaptureCommand,
    Conditions,
    Connective,
    Home,
    LinkedCommand,
    PaceClause,
    PassOn,
    Said,
    Subject,
    Test,
    WatchCommand,
    WatchResponse,
)
from fieldhand.planning.grammar.words import Lex
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.watches import EventAbsent, EventBeyond, EventHolds, ReadingBeyond, WatchCondition
from fieldhand.terms import Test as Comparison

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: The reading taken last.
_IT = Subject()


@construction("happens: one=EVENT", cost=0.0)
@construction("such: one=EVENTNOUN", cost=0.0)
def event(one: Lex) -> Conditions:
    """Compose "someone is in the row" and "rain"."""
    return (one.value,)


@construction("happens: one=NOEVENT", cost=0.1)
def no_event(one: Lex) -> Conditions:
    """Compose "nobody is in the row"."""
    return (opposite_of(one.value),)


@construction("happens: first=happens OR [if_] second=happens", "such: first=such OR second=such", cost=0.1)
@construction("happens: first=happens COMMA second=happens", cost=0.4)
def either(first: Conditions, second: Conditions) -> Conditions | None:
    """Compose "it rains or the wind is over 5 m/s"."""
    return (*first, *second) if not {*first} & {*second} else None


@construction("fine: one=NOEVENT", "fine: other=EVENT", cost=0.0)
def fine(one: Lex | None = None, other: Lex | None = None) -> Conditions | None:
    """Compose "nobody is in the row" as what has to hold: what is watched is the opposite."""
    if one is not None:
        return (one.value,)
    return None if other is None else (opposite_of(other.value),)


@construction("fine: first=fine AND [if_] second=fine", "fine: first=fine AND DURING second=fine", cost=0.1)
def both_fine(first: Conditions, second: Conditions) -> Conditions | None:
    """Compose "the gate is open and nobody is in the row"."""
    return either(first, second)


def opposite_of(condition: EventHolds | EventBeyond) -> WatchCondition:
    """Return the condition that holds when another does not."""
    if isinstance(condition, EventHolds):
        return EventAbsent(event=condition.event)
    return replace(condition, test=_OPPOSITE[condition.test])


_OPPOSITE: Mapping[Comparison, Comparison] = {"lt": "ge", "le": "gt", "gt": "le", "ge": "lt"}


@construction(
    "proviso: [BUT] [AND] [WORKON] ONLYDURING on=fine",
    "proviso: ONLYWORK DURING on=fine",
    cost=0.1,
)
def only_while(on: Conditions, used: int) -> WatchCommand:
    """Compose "only while the gate is open": meanwhile the robot waits."""
    return WatchCommand(on, WatchResponse("wait"), used)


@construction("proviso: DURING one=NOEVENT", cost=0.4)
def as_long_as(one: Lex, used: int) -> WatchCommand:
    """Compose "as long as it does not rain"."""
    return WatchCommand((one.value,), WatchResponse("wait"), used)


@construction(
    "proviso: [BUT] [AND] [WORKON] ONLYIF on=fine",
    "proviso: ONLYWORK HAPPENS on=fine",
    cost=0.2,
    given=("site",),
)
def only_if(on: Conditions, used: int, site: Site) -> list[WatchCommand]:
    """Compose "only if nobody is in the row", which leaves open where the robot is otherwise."""
    return [WatchCommand(on, reaction, used) for reaction in no_work(site)]


@construction(
    "proviso: [WORKON] UNLESSEVER on=happens", "proviso: [WORKON] UNLESSSUCH on=such", cost=0.2, given=("site",)
)
def unless(on: Conditions, used: int, site: Site) -> list[WatchCommand]:
    """Compose "unless it rains", which leaves open where the robot is then."""
    return [WatchCommand(on, reaction, used) for reaction in no_work(site)]


@construction("said: before=said [joint=joint] rule=proviso", cost=0.2)
def proviso_behind(before: Said, rule: WatchCommand, joint: Connective | None = None) -> Said:
    """Compose "photograph row 3 only while the gate is open"."""
    return Said((*before.clauses, LinkedCommand(joint, rule)))


@construction("said: rule=proviso joint=joint rest=said", cost=0.2)
def proviso_before(rule: WatchCommand, joint: Connective, rest: Said) -> Said | None:
    """Compose "only while the gate is open, photograph row 3"."""
    first, *others = rest.clauses
    if joint.first or first.before is not None:
        return None
    return Said((LinkedCommand(None, rule), replace(first, before=joint), *others))


@construction("any_time: ANYTIME", cost=0.0)
def any_time() -> str:
    """Compose "at any time"."""
    return "any"


@construction(
    "trigger: [any_time] [COMMA] HAPPENS on=happens [COMMA] [any_time]",
    "trigger: [any_time] [COMMA] DURING on=happens",
    "trigger: [any_time] [COMMA] INSUCH on=such",
    "trigger: HAPPENS any_time [COMMA] on=happens",
    cost=0.1,
)
def trigger(on: Conditions) -> Conditions:
    """Compose "if someone is in the row at any time"."""
    return on


@construction(
    "trigger: any_time [COMMA] HAPPENS test=test",
    "trigger: HAPPENS test=test any_time",
    "trigger: HAPPENS any_time [COMMA] test=test",
    "trigger: HAPPENS test=ever",
    cost=0.2,
    given=("robot",),
)
def reading(test: Test, robot: RobotProfile) -> Conditions | None:
    """Compose "if the air gets hotter than 40 degrees at any time"."""
    known = robot.quantity.get(test.quantity)
    if known is None or test.attribute or test.place is not None or test.setting or test.negated:
        return None
    if test.check not in ("lt", "le", "gt", "ge") or test.unit not in ("", known.unit):
        return None
    if not isinstance(test.value, float | int):
        return None
    return (ReadingBeyond(quantity=known.name, test=test.check, value=float(test.value), unit=known.unit),)


@construction(
    "ever: [subject=measured] IS ANYTIME test=predicate", "ever: subject=measured ANYTIME test=predicate", cost=0.2
)
def ever(test: Test, subject: Subject = _IT) -> Test | None:
    """Compose "CO2 is ever above 600 ppm"."""
    return None if subject.place is not None else reading_is(test, subject)


@construction(
    "reacts: way=home", "reacts: HOLD [AND] way=home", "reacts: STANDSTILL [AND] way=home", cost=0.0, given=("site",)
)
@construction("reacts: STANDSTILL COMMA way=home", "reacts: STOPWORK [COMMA] [AND] way=home", cost=0.1, given=("site",))
@construction("reacts: ENDALL [COMMA] [AND] way=home", cost=0.1, given=("site",))
def goes_home(way: Home, site: Site) -> WatchResponse | None:
    """Compose "come home" and "stop and come home"."""
    if way.to_it or not {"start", "end"} & set(site.markers):
        return None
    return WatchResponse(way.then or _home(site))


def _home(site: Site) -> Literal["return_to_start", "return_to_end"]:
    return "return_to_start" if "start" in site.markers else "return_to_end"


@construction("reacts: STANDSTILL", cost=0.6)
def stands_still() -> WatchResponse:
    """Compose "stop"."""
    return WatchResponse("wait", stands=True)


@construction("reacts: how=pace", cost=0.0)
def drives_slowly(how: PaceClause) -> WatchResponse:
    """Compose "drive at 0.3 m/s" and "slow down"."""
    return WatchResponse("slow", pace=how)


@construction("reacts: HOLD", cost=0.0)
def holds() -> WatchResponse:
    """Compose "wait"."""
    return WatchResponse("wait")


@construction("reacts: STOPWORK", "reacts: NOWORK", cost=0.1, given=("site",))
def no_work(site: Site) -> list[WatchResponse]:
    """Compose "don't work", which leaves open where the robot is meanwhile."""
    return [WatchResponse("wait"), WatchResponse(_home(site))]


@construction("reacts: first=reacts [COMMA] [AND] second=reacts", cost=0.2)
def skips_on(first: WatchResponse, second: WatchResponse) -> WatchResponse | None:
    """Compose "skip that tree and go on with the next"."""
    return first if first.response == second.response == "skip" else None


@construction("reacts: ENDALL", cost=0.0)
def ends() -> WatchResponse:
    """Compose "end the mission"."""
    return WatchResponse("end")


@construction("reacts: SKIPVISIT", cost=0.0)
@construction("reacts: one=pass_on", cost=0.3)
def skips(one: PassOn | None = None) -> WatchResponse | None:
    """Compose "skip that tree"."""
    return WatchResponse("skip") if one is None or one.to_next else None


@construction("reacts: SKIPROW", cost=0.0)
def skips_row() -> WatchResponse:
    """Compose "skip the row"."""
    return WatchResponse("skip_row")


@construction("lasting: most=at_most", "lasting: FOR most=at_most", "lasting: INSIDE most=amount", cost=0.0)
def lasting(most: Amount) -> Amount | None:
    """Compose "for at most 10 minutes"."""
    return most if most.unit == "seconds" else None


@construction("lasting_so: FOR most=amount", "lasting_so: most=amount", cost=0.1)
def lasting_so(most: Amount) -> Amount | None:
    """Compose "for 10 minutes"."""
    return most if most.unit == "seconds" else None


@construction(
    "reacts: first=reacts [COMMA] [AND] STANDSTILL", "reacts: STANDSTILL [COMMA] [AND] first=reacts",
    "reacts: STANDSTILL [DET] WORKN [COMMA] AND first=reacts", "reacts: STANDSTILL WORKV [COMMA] AND first=reacts",
    cost=0.3,
)  # fmt: skip
@construction("reacts: STANDSTILL then [COMMA] first=reacts", cost=0.3)
def stops_first(first: WatchResponse) -> WatchResponse | None:
    """Compose "stop and wait for 5 minutes"."""
    return first if first.response == "wait" and not first.stands else None


@construction("reacts: first=reacts UNTILOVER", "reacts: first=reacts [COMMA] UNTILOVER COMMA", cost=0.0)
def until_over(first: WatchResponse) -> WatchResponse | None:
    """Compose "wait until it is over"."""
    return replace(first, over=True) if first.response in ("wait", "slow") and not first.over else None


@construction(
    "reacts: first=reacts [COMMA] most=lasting",
    "reacts: first=reacts [COMMA] CONTRAST most=lasting",
    "reacts: first=reacts [COMMA] BUT most=lasting",
    "reacts: first=reacts [COMMA] AND HOLD most=lasting",
    "reacts: first=reacts COMMA most=lasting_so",
    "reacts: first=reacts [COMMA] CONTRAST most=lasting_so",
    "reacts: first=reacts [COMMA] BUT most=lasting_so",
    "reacts: first=reacts [COMMA] AND HOLD most=lasting_so",
    cost=0.1,
)
def for_so_long(first: WatchResponse, most: Amount) -> WatchResponse | None:
    """Compose "wait for at most 10 minutes"."""
    if first.response != "wait" or first.at_most_s is not None or most.number < 1.0:
        return None
    return replace(first, at_most_s=most.number)


@construction("reacts: first=reacts most=lasting_so", cost=0.1)
def waits_so_long(first: WatchResponse, most: Amount) -> WatchResponse | None:
    """Compose "wait 10 minutes"; in "wait until it has been dry for 10 minutes", the wait ends later than that."""
    return None if first.over else for_so_long(first, most)


@construction(
    "reacts: first=reacts [COMMA] [AND] then [COMMA] GOON",
    "reacts: first=reacts [COMMA] AND GOON",
    "reacts: first=reacts COMMA GOON",
    "reacts: first=reacts [COMMA] [AND] [then] GOON ONCEOVER",
    "reacts: first=reacts [COMMA] [AND] ONCEOVER [COMMA] GOON",
    "reacts: first=reacts FULLSTOP GOON ONCEOVER",
    cost=0.1,
)
def goes_on(first: WatchResponse) -> WatchResponse | None:
    """Compose "wait until they are gone, then go on", or "skip it and go on"."""
    if first.response == "wait" and (first.fallback is not None or (first.over and first.at_most_s is not None)):
        return None
    if first.response == "wait" and first.at_most_s is not None:
        return replace(first, fallback="go_on")
    return replace(first, over=True) if first.response in ("wait", "skip", "skip_row", "slow") else None


@construction(
    "reacts: first=reacts [COMMA] [AND] then [COMMA] second=reacts",
    "reacts: first=reacts [COMMA] AND second=reacts",
    "reacts: first=reacts COMMA second=reacts",
    "reacts: first=reacts [COMMA] [AND] [then] IFSTILL [COMMA] second=reacts",
    "reacts: first=reacts [COMMA] [AND] [then] second=reacts IFSTILL",
    "reacts: first=reacts FULLSTOP [AND] IFSTILL [COMMA] second=reacts",
    "reacts: first=reacts FULLSTOP then [COMMA] second=reacts",
    cost=0.2,
)
def then_reacts(first: WatchResponse, second: WatchResponse) -> WatchResponse | None:
    """Compose "wait for 5 minutes and then come home"."""
    if first.response != "wait" or first.fallback is not None or first.at_most_s is None:
        return None
    fallback = second.response
    if fallback == "wait" or fallback == "skip_row" or fallback == "slow":
        return None
    return replace(first, fallback=fallback)


@construction(
    "lets_by: GIVEWAY on=such [PASSBY]", "lets_by: LETPASS on=such PASSBY", "lets_by: LETPASS on=happens PASSBY",
    cost=0.1,
)  # fmt: skip
def lets_by(on: Conditions) -> Conditions:
    """Compose "give way to people" and "let people pass"."""
    return on


@construction("command: on=lets_by", "command: on=lets_by [COMMA] [AND] [then] GOON", cost=0.1)
def waits_for_them(on: Conditions, used: int) -> WatchCommand:
    """Compose "let people pass", for whom the robot waits."""
    return WatchCommand(on, WatchResponse("wait", over=True), used)


@construction("command: rule=command UNTILOVER", "command: rule=command PASSBY", cost=0.1)
def watched_until_over(rule: WatchCommand, used: int) -> WatchCommand | None:
    """Compose "stop for people until they have moved on" and "wait for people to pass"."""
    if not isinstance(rule, WatchCommand) or rule.during:
        return None
    made = until_over(rule.reaction)
    return None if made is None else replace(rule, reaction=replace(made, stands=False), used=used)


@construction("command: rule=command [COMMA] [AND] GOON ONCEOVER", cost=0.1)
def going_on_once_over(rule: WatchCommand, used: int) -> WatchCommand | None:
    """Compose "stand still if anybody comes and go on once they have left"."""
    made = goes_on(rule.reaction) if isinstance(rule, WatchCommand) and not rule.during else None
    return None if made is None else replace(rule, reaction=replace(made, stands=False), used=used)


@construction("reacts: STANDSTILL [DET] WORKN", "reacts: STANDSTILL [DET] WORKV", cost=0.3)
def stops_its_work() -> WatchResponse:
    """Compose "stop the mower"."""
    return WatchResponse("wait", stands=True)


@construction(
    "command: on=trigger [COMMA] [then] reaction=reacts",
    "command: reaction=reacts [COMMA] on=trigger",
    "command: any_time COMMA reaction=reacts on=trigger",
    cost=0.0,
)
def watch(on: Conditions, reaction: WatchResponse, used: int) -> WatchCommand:
    """Compose "if it rains, come home"."""
    return WatchCommand(on, reaction, used)


@construction("phase: DURING work=WORKV", "phase: DURING work=WORKN", "phase: DURING DET work=WORKN", cost=0.0)
def during_work(work: Lex) -> tuple[str, ...]:
    """Compose "while spraying"."""
    return (work.value,)


@construction("phase: DURING act=capture", cost=0.2)
def during_captures(act: CaptureCommand) -> tuple[str, ...] | None:
    """Compose "while taking pictures"."""
    if act.place is not None:
        return None
    return tuple(dict.fromkeys(thing.action for thing in act.things))


@construction(
    "command: part=phase COMMA rule=command",
    "command: rule=command [COMMA] part=phase",
    cost=0.3,
)
def in_a_part(part: tuple[str, ...], rule: WatchCommand, used: int) -> WatchCommand | None:
    """Compose "while spraying, stop if the wind is above 5 m/s"."""
    if not isinstance(rule, WatchCommand) or rule.during:
        return None
    return replace(rule, during=part, used=used)


@construction("command: on=happens ends=FULLSTOP reaction=reacts", cost=0.3)
def asked_event(on: Conditions, ends: Lex, reaction: WatchResponse, used: int) -> WatchCommand | None:
    """Compose "anyone nearby? wait until they are gone"."""
    return WatchCommand(on, reaction, used) if "question" in ends.features else None


@construction(
    "command: on=trigger [COMMA] [then] reaction=reacts FULLSTOP limit=more",
    "command: reaction=reacts [COMMA] on=trigger FULLSTOP limit=more",
    "command: reaction=reacts [COMMA] on=trigger [COMMA] [CONTRAST] limit=more",
    "command: reaction=reacts [COMMA] on=trigger [COMMA] [BUT] limit=more",
    cost=0.2,
)
def watch_for(on: Conditions, reaction: WatchResponse, limit: WatchResponse, used: int) -> WatchCommand | None:
    """Compose "stop if someone is in the row. Wait at most 10 minutes, then come home."."""
    if reaction.response != "wait" or reaction.at_most_s is not None or limit.at_most_s is None:
        return None
    return WatchCommand(on, replace(limit, stands=reaction.stands and limit.stands), used)


@construction("more: HOLD most=lasting", "more: most=lasting", cost=0.1)
def wait_so_long(most: Amount) -> WatchResponse | None:
    """Compose "wait at most 10 minutes"."""
    return WatchResponse("wait", at_most_s=most.number) if most.number >= 1.0 else None


@construction(
    "more: first=more [COMMA] [AND] [then] [COMMA] second=reacts",
    "more: first=more [COMMA] [AND] [then] IFSTILL [COMMA] second=reacts",
    "more: first=more FULLSTOP IFSTILL [COMMA] second=reacts",
    "more: first=more FULLSTOP then [COMMA] second=reacts",
    "more: first=more [COMMA] [AND] [then] GOON",
    cost=0.1,
)
def wait_then(first: WatchResponse, second: WatchResponse | None = None) -> WatchResponse | None:
    """Compose "wait at most 10 minutes, then come home"."""
    return replace(first, fallback="go_on") if second is None else then_reacts(first, second)
