"""Constructions of recharging: as often as needed, below a charge, as a step; and of batteries that are tested."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    BATTERY_TEST,
    AllTests,
    Amount,
    CaptureCommand,
    Command,
    Connective,
    DriveCommand,
    Home,
    Lead,
    LimitClause,
    LinkedCommand,
    PlaceMeaning,
    RechargeClause,
    Said,
    StopCommand,
    Test,
    When,
)
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_FULL = 100.0
#: Shapes of places that were spoken of before.
_SPOKEN_OF = ("here", "those")


@construction("charge_it: RECHARGE", "charge_it: RECHARGE [DET] BATTERY", cost=0.1)
def charge_it() -> str:
    """Compose "recharge" and "charge the battery"."""
    return "charge"


@construction("charge_it: inner=charge_it AT [DET] CHARGER", cost=0.1)
def charge_there(inner: str) -> str:
    """Compose "recharge at the charger"."""
    return inner


@construction("charge_far: CHARGETO level=amount", "charge_far: CHARGETO [AT] level=amount of_what", cost=0.1)
def charge_to(level: Amount) -> float | None:
    """Compose "to 80 %" and "until it is at 90 % charge"."""
    return level.number if level.unit == "percent" else None


@construction("charge_far: CHARGEFULL", cost=0.1)
def charge_fully() -> float:
    """Compose "fully" and "until it is full"."""
    return _FULL


@construction(
    "go_on: [COMMA] [AND] GOONAFTER",
    "go_on: [COMMA] [AND] [then] GOONAFTER",
    "go_on: FULLSTOP [then] GOONAFTER",
    cost=0.1,
)
def go_on() -> str:
    """Compose "and go on"."""
    return "go on"


@construction(
    "charged: charge_it",
    "charged: charge_it far=charge_far",
    "charged: charge_it far=charge_far AT [DET] CHARGER",
    "charged: AT [DET] CHARGER [COMMA] charge_it [far=charge_far]",
    cost=0.0,
)
def charged(used: int, far: float | None = None) -> RechargeClause:
    """Compose "recharge to 80 %", which is a step of the plan unless more is said."""
    return RechargeClause(used, until=far)


@construction("recharging: one=charged [go_on]", cost=0.4)
def charge_now(one: RechargeClause, used: int) -> RechargeClause:
    """Compose "charge to 80 % and go on"."""
    return replace(one, used=used)


@construction(
    "recharging: one=charged FOR time=amount [go_on]",
    "recharging: charge_it FOR time=amount far=charge_far [go_on]",
    cost=0.3,
)
def charge_for(
    time: Amount, used: int, one: RechargeClause | None = None, far: float | None = None
) -> RechargeClause | None:
    """Compose "charge for 20 minutes"."""
    until = far if one is None else one.until
    return RechargeClause(used, until=until, seconds=time.number) if time.unit == "seconds" else None


@construction(
    "recharging: one=charged ASNEEDED [go_on]",
    "recharging: charge_it ASNEEDED far=charge_far [go_on]",
    "recharging: ASNEEDED [COMMA] one=charged [go_on]",
    "recharging: MAYCHARGE [ASNEEDED] [go_on]",
    "recharging: MAYCHARGE far=charge_far [go_on]",
    cost=0.2,
)
def as_often_as_needed(used: int, one: RechargeClause | None = None, far: float | None = None) -> RechargeClause:
    """Compose "recharge as often as needed" and "you may recharge"."""
    return RechargeClause(used, always=True, until=far if one is None else one.until)


@construction(
    "recharging: one=charged in_case below=low_battery [go_on]",
    "recharging: one=charged in_case below=it_low [go_on]",
    "recharging: charge_it in_case below=low_battery [COMMA] [AND] far=charge_far [go_on]",
    "recharging: one=charged BEFORE below=low_battery [go_on]",
    "recharging: one=charged at=AT below=reserve [go_on]",
    "recharging: one=charged below=below_charge [go_on]",
    "recharging: in_case below=low_battery [COMMA] [then] one=charged [go_on]",
    "recharging: MAYCHARGE in_case below=low_battery [go_on]",
    cost=0.2,
)
def charge_below(
    below: Amount,
    used: int,
    one: RechargeClause | None = None,
    far: float | None = None,
    at: Lex | None = None,
) -> RechargeClause | None:
    """Compose "recharge when the battery is below 30 %"."""
    if below.unit != "percent" or (at is not None and at.text != "at"):
        return None
    return RechargeClause(used, always=True, below=below.number, until=one.until if one is not None else far)


@construction("below_charge: check=CMP least=amount [of_what]", cost=0.2)
def below_charge(check: Lex, least: Amount) -> Amount | None:
    """Compose "below 30 %"."""
    return least if least.unit == "percent" and check.value[0] in ("lt", "le") else None


@construction("each_time: WHERE", "each_time: ASSOONAS", cost=0.0)
def each_time() -> str:
    """Compose "whenever" before a state of the battery; "if" may be a test made once."""
    return "whenever"


@construction(
    "recharging: go=drive each_time below=low_battery [go_on]",
    "recharging: each_time below=low_battery [COMMA] [then] go=drive [go_on]",
    "recharging: go=drive in_case below=low_battery [AND] [then] one=charged [go_on]",
    "recharging: in_case below=low_battery [COMMA] [then] go=drive [COMMA] [AND] [then] one=charged [go_on]",
    cost=0.2,
)
def to_the_charger_below(
    go: DriveCommand, below: Amount, used: int, one: RechargeClause | None = None
) -> RechargeClause | None:
    """Compose "if the battery is below 30 %, drive to the charger and recharge"."""
    if go.place.selector.named_marker != "charger" or below.unit != "percent":
        return None
    return RechargeClause(used, always=True, below=below.number, until=None if one is None else one.until)


@construction(
    "recharging: go=drive ASNEEDED [go_on]",
    "recharging: ASNEEDED [COMMA] go=drive [go_on]",
    "recharging: ASNEEDED [COMMA] go=drive AND one=charged [go_on]",
    "recharging: go=drive ASNEEDED [AND] one=charged [go_on]",
    "recharging: go=drive [AND] one=charged ASNEEDED [go_on]",
    cost=0.2,
)
def to_the_charger_as_needed(go: DriveCommand, used: int, one: RechargeClause | None = None) -> RechargeClause | None:
    """Compose "go back to the charger whenever necessary"."""
    if go.place.selector.named_marker != "charger":
        return None
    return RechargeClause(used, always=True, until=None if one is None else one.until)


@construction(
    "recharging: one=charged check=CMP n=often [go_on]",
    "recharging: MAYCHARGE [check=CMP] n=often [go_on]",
    "recharging: WITH [check=CMP] n=count CHARGES",
    "recharging: check=CMP n=count CHARGES",
    "recharging: n=count CHARGES TOPS",
    cost=0.2,
)
def charge_at_most(
    n: int, used: int, one: RechargeClause | None = None, check: Lex | None = None
) -> RechargeClause | None:
    """Compose "recharge at most twice" and "with up to three charges"."""
    if n < 1 or (check is not None and check.value[0] not in ("le", "lt")):
        return None
    most = n - 1 if check is not None and check.value[0] == "lt" else n
    return RechargeClause(used, always=True, until=None if one is None else one.until, at_most=most) if most else None


@construction(
    "recharging: first=recharging COMMA rest=recharge_detail",
    "recharging: first=recharging AND rest=recharge_detail",
    cost=0.2,
)
@construction("recharging: first=recharging rest=recharge_detail", cost=0.2)
def recharge_in_detail(first: RechargeClause, rest: RechargeClause, used: int) -> RechargeClause | None:
    """Compose "recharge as often as needed, up to 90 %"."""
    if not first.always or (first.until is not None and rest.until is not None):
        return None
    return replace(
        first,
        used=used,
        until=first.until if rest.until is None else rest.until,
        at_most=first.at_most if rest.at_most is None else rest.at_most,
    )


@construction("recharge_detail: far=charge_far", cost=0.1)
def charged_so_far(far: float, used: int) -> RechargeClause:
    """Compose "up to 90 %" behind a recharging."""
    return RechargeClause(used, always=True, until=far)


@construction("recharge_detail: check=CMP n=often", cost=0.1)
def so_often(check: Lex, n: int, used: int) -> RechargeClause | None:
    """Compose "at most twice" behind a recharging."""
    if check.value[0] != "le":
        return None
    return RechargeClause(used, always=True, at_most=n)


@construction(
    "limit: KEEP time=amount [OF] [DET] BATTERY [LEFT]",
    "limit: WITH time=amount [OF] [DET] BATTERY LEFT",
    "limit: KEEP [check=CMP] time=amount [OF] [DET] BATTERY [LEFT]",
    "limit: KEEP [DET] BATTERY FOR time=amount",
    cost=0.2,
)
def battery_for(time: Amount, used: int, check: Lex | None = None) -> LimitClause | None:
    """Compose "keep 30 minutes of battery"."""
    if time.unit != "seconds" or (check is not None and check.value[0] not in ("ge", "gt")):
        return None
    return LimitClause(time, True, used)


@construction(
    "test: [DET] BATTERY [IS] check=CMP level=amount",
    "test: [DET] BATTERY [IS] check=CMP level=amount of_what",
    "test: THEREIS check=CMP level=amount [of_what] LEFT",
    "test: THEREIS check=CMP level=amount of_what",
    cost=1.0,
)
def battery_test(check: Lex, level: Amount) -> Test | None:
    """Compose "the battery is above 60 %"."""
    kind = check.value[0]
    if level.unit != "percent" or kind not in ("lt", "le", "gt", "ge"):
        return None
    return Test(BATTERY_TEST, kind, level.number, "percent")


@construction("test: [DET] BATTERY GOUNDER level=amount", "test: [DET] BATTERY REACHES level=amount", cost=1.0)
def battery_falls(level: Amount) -> Test | None:
    """Compose "the battery falls below 40 %"."""
    return Test(BATTERY_TEST, "le", level.number, "percent") if level.unit == "percent" else None


@construction("straight_way: [GO] STRAIGHTTO place=place", cost=0.0)
def straight_way(place: PlaceMeaning, used: int) -> DriveCommand:
    """Compose "go straight to the charger", after which nothing is done."""
    return DriveCommand(place, used)


@construction(
    "given_up: in_case below=low_battery [COMMA] [then] STOP [COMMA] [AND] [then] way=drive",
    "given_up: STOP AND way=drive in_case below=low_battery",
    "given_up: way=drive AND STOP in_case below=low_battery",
    "given_up: IF below=low_battery [COMMA] [then] [STOP] [COMMA] [AND] way=straight_way",
    "given_up: [STOP] [AND] way=straight_way IF below=low_battery",
    cost=0.1,
)
def given_up(below: Amount, way: DriveCommand, used: int) -> tuple[When, DriveCommand] | None:
    """Compose "if the battery falls below 40 %, leave the rest and drive to the charger"."""
    return (_low(below, used & ~way.used), way) if way.place.shape == "one" else None


def _low(below: Amount, used: int) -> When:
    return When(AllTests((Test(BATTERY_TEST, "le", below.number, "percent"),)), used)


@construction("said: before=said joint=joint case=given_up", cost=0.1)
def given_up_below(before: Said, joint: Connective, case: tuple[When, DriveCommand]) -> Said | None:
    """Compose "... If the battery falls below 40 %, leave the rest and drive to the charger.", of captures."""
    when, way = case
    return _given_up_after(before, LinkedCommand(joint, when), way)


@construction(
    "said: before=said [COMMA] [OR] SOONER in_case below=low_battery",
    "said: before=said [COMMA] [BUT] SOONER in_case below=low_battery",
    "said: before=said [COMMA] [OR] in_case below=low_battery [COMMA] SOONER",
    cost=0.2,
)
def sooner_if_low(before: Said, below: Amount, used: int) -> Said | None:
    """Compose "(..., then back to the charger,) or straight there if the battery drops below 40 %"."""
    own, last = used, before.clauses[-1].command
    for clause in before.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    if isinstance(last, Home):
        return Said((*before.clauses, LinkedCommand(None, LimitClause(below, True, own))))
    if not isinstance(last, DriveCommand):
        return None
    return _given_up_after(before, LinkedCommand(None, _low(below, own)), replace(last, used=0))


def _given_up_after(before: Said, when: LinkedCommand, way: DriveCommand) -> Said | None:
    """Return captures after each of which the robot drives to a place for good if a test of the battery passes.

    A drive to that place behind them is the end of the mission in any case.
    """
    *clauses, last = before.clauses
    goes = isinstance(last.command, DriveCommand) and last.command.place.shape == "one"
    final: tuple[LinkedCommand, ...] = ()
    if goes and isinstance(last.command, DriveCommand) and clauses:
        same = last.command.place.selector == way.place.selector
        if not same or last.command.along:
            return None
        final = (LinkedCommand(replace(last.before or Connective(False, True, 0), full=True), last.command),)
    else:
        clauses = list(before.clauses)
    if not all(_has_place(clause.command) for clause in clauses) or isinstance(clauses[0].command, Lead):
        return None
    ends = LinkedCommand(Connective(False, False, 0, both=True), StopCommand(0, stays=True))
    found: list[LinkedCommand] = []
    for number, clause in enumerate(clauses):
        is_last = number == len(clauses) - 1
        tested = when if is_last else LinkedCommand(Connective(True, False, 0), replace(when.command, used=0))
        joined = replace(clause.before or Connective(True, False, 0), full=True) if number else clause.before
        begun = replace(clause, before=joined)
        found += [begun, tested, LinkedCommand(None, way if is_last else replace(way, used=0)), ends]
    return Said((*found, *final))


def _has_place(command: Command) -> bool:
    """Return True for captures at places of their own, and for a further place of the captures before it."""
    if isinstance(command, Lead):
        return command.relation not in ("topic", "")
    return isinstance(command, CaptureCommand) and command.place is not None and command.place.shape not in _SPOKEN_OF
