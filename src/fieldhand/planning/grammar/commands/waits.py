"""Constructions of waits: "wait there for 10 minutes", "let the sensor settle for 20 s before each reading"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    Again,
    Amount,
    CaptureCommand,
    Connective,
    DriveCommand,
    LinkedCommand,
    PlaceMeaning,
    Said,
    SettleClause,
    Thing,
    wait_thing,
)
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: The longest wait of a plan in seconds.
LONGEST_WAIT_S = 86_400.0


@construction(
    "duration: [FOR] time=amount",
    "duration: FOR [DET] WAITN OF time=amount",
    "duration: [FOR] time=amount [AND] NOTMORE",
    "duration: [FOR] DET time=amount",
    cost=0.1,
)
def duration(time: Amount) -> float | None:
    """Compose "for 10 minutes"."""
    return time.number if time.unit == "seconds" and 0.0 < time.number <= LONGEST_WAIT_S else None


@construction(
    "wait: WAITV time=duration",
    "wait: STAYV time=duration",
    "wait: STOP time=duration",
    "wait: STOPEACH time=duration",
    "wait: GIVEIT time=duration [TOSETTLE]",
    "wait: GIVETIME time=duration TOSETTLE",
    "wait: LETSETTLE time=duration",
    cost=0.2,
)
def wait(time: float) -> float:
    """Compose "wait for 10 minutes" and "let it settle for 5 minutes"."""
    return time


@construction(
    "wait: [verb] DET WAITN OF time=amount",
    "wait: [verb] DET time=amount [DASH] WAITN",
    "wait: [verb] time=amount [DASH] WAITN",
    "wait: USEV time=amount",
    cost=0.2,
)
def wait_noun(time: Amount) -> float | None:
    """Compose "a pause of 10 minutes", "make a 30-second stop" and "spend half an hour"."""
    return duration(time)


@construction(
    "wait: [verb] DET number=NUM [DASH] unit=ORD [DASH] WAITN",
    "wait: [verb] number=NUM [DASH] unit=ORD [DASH] WAITN",
    cost=0.2,
)
def wait_of_seconds(number: Lex, unit: Lex) -> float | None:
    """Compose "a 30-second pause", whose unit is an ordinal as well."""
    return duration(Amount(number=float(number.value), unit="seconds")) if unit.value == 2 else None


@construction("capture: time=wait", cost=0.2)
def wait_here(time: float, used: int) -> CaptureCommand:
    """Compose "wait for 10 minutes" at the place spoken of."""
    return CaptureCommand((wait_thing(time),), None, used)


@construction(
    "capture: time=wait place=here",
    "capture: WAITV place=here time=duration",
    "capture: STAYV place=here time=duration",
    "capture: STOP place=here time=duration",
    "capture: STOPEACH place=here time=duration",
    "capture: place=here time=wait",
    cost=0.2,
)
def wait_there(time: float, place: PlaceMeaning, used: int) -> CaptureCommand:
    """Compose "wait there for 10 minutes" and "pause for 30 seconds at each"."""
    return CaptureCommand((wait_thing(time),), place, used)


@construction("capture: STAY time=duration", cost=0.2)
def stay_there(time: float, used: int) -> CaptureCommand:
    """Compose "stay there for 10 minutes"."""
    return CaptureCommand((wait_thing(time),), PlaceMeaning(s.Here(), "here"), used)


@construction(
    "capture: time=wait word=relation place=place",
    "capture: WAITV word=relation place=place time=duration",
    "capture: STAYV word=relation place=place time=duration",
    "capture: STOP word=relation place=place time=duration",
    "capture: STOPEACH word=relation place=place time=duration",
    cost=0.2,
)
def wait_at(time: float, word: str, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "wait 10 minutes at tree 4" and "stay at the charger for half an hour"."""
    return None if word in ("of", "lead") else CaptureCommand((wait_thing(time),), place, used)


@construction(
    "capture: WAITV",
    "capture: WAITV place=here",
    "capture: WAITV relation place=place",
    "capture: LETSETTLE",
    cost=2.5,
)
def wait_for_how_long(used: int, place: PlaceMeaning | None = None) -> CaptureCommand:
    """Compose "wait at tree 4", which leaves open for how long."""
    return CaptureCommand((wait_thing(0.0),), place, used)


@construction("capture: GO [towards] place=place FOR time=amount", cost=0.4)
def go_for_a_time(time: Amount, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "go to the charger for 10 minutes"."""
    seconds = duration(time)
    known = place.shape == "one" and seconds is not None
    return CaptureCommand((wait_thing(seconds or 0.0),), place, used) if known else None


@construction(
    "each_capture: EACH things=things",
    "each_capture: [DET] things=things",
    "each_capture: TAKE EACH things=things",
    "each_capture: TAKE [DET] things=things",
    "each_capture: MEASURE EACH things=things",
    "each_capture: MEASURE [DET] things=things",
    cost=0.1,
)
def each_capture(things: tuple[Thing, ...]) -> tuple[str, ...]:
    """Compose "each picture" and "taking the reading"."""
    return tuple(one.action for one in things)


@construction(
    "each_capture: EACH READING",
    "each_capture: DET READING",
    "each_capture: READING",
    "each_capture: EACH ONE",
    "each_capture: TAKE EACH READING",
    "each_capture: TAKE [DET] READING",
    "each_capture: MEASURE",
    "each_capture: MEASURE EACH READING",
    cost=0.2,
)
def each_reading() -> tuple[str, ...]:
    """Compose "each reading", of whatever is captured."""
    return (LAST_THING,)


@construction("each_capture: verb=ACTV", "each_capture: verb=ACTV EACH TREE", cost=0.2)
def each_act(verb: Lex) -> tuple[str, ...]:
    """Compose "photographing"."""
    return (verb.value.actions[0],)


@construction("settle_wait: time=wait", "settle_wait: WITH time=wait", cost=0.1)
def settle_wait(time: float) -> float:
    """Compose "let the sensor settle for 20 s"."""
    return time


@construction("settle_wait: SETTLEV time=duration", cost=0.1)
def settled(time: float) -> float:
    """Compose "settling for 20 s"."""
    return time


@construction(
    "settle: time=settle_wait before=BEFORE actions=each_capture",
    "settle: before=BEFORE actions=each_capture [COMMA] time=settle_wait",
    cost=0.2,
)
def settle(time: float, before: Lex, actions: tuple[str, ...], used: int) -> SettleClause | None:
    """Compose "wait 20 s before each reading"."""
    return SettleClause(time, actions, used) if "before_doing" in before.features else None


@construction(
    "said: time=settle_wait before=BEFORE [EACH] one=capture",
    "said: before=BEFORE [EACH] one=capture [COMMA] time=settle_wait",
    cost=0.4,
)
def settle_before(time: float, before: Lex, one: CaptureCommand, used: int) -> Said | None:
    """Compose "let the sensor settle for 20 s before each reading of CO2 at the yellow trees"."""
    if "before_doing" not in before.features or one.place is None:
        return None
    clause = SettleClause(time, tuple(thing.action for thing in one.things), used & ~one.used)
    first = LinkedCommand(None, replace(one, relation="at" if one.relation == "bare" else one.relation))
    return Said((first, LinkedCommand(None, clause)))


@construction(
    "once_more_act: AGAIN",
    "once_more_act: MEASURE IT AGAIN",
    "once_more_act: TAKE IT AGAIN",
    "once_more_act: MEASURE AGAIN",
    "once_more_act: [TAKE] ANOTHER [ONE]",
    "once_more_act: [TAKE] ANOTHER READING",
    cost=0.2,
)
def once_more_act() -> str:
    """Compose "and again"."""
    return "again"


@construction(
    "later: time=amount LATER", "later: word=THEN time=amount", "later: word=THEN ANOTHER time=amount", cost=0.1
)
def later(time: Amount, word: Lex | None = None) -> float | None:
    """Compose "ten minutes later" and "after ten minutes"."""
    return duration(time) if word is None or "after_doing" in word.features else None


@construction("from_now: word=AT time=amount", cost=0.1)
def from_now(word: Lex, time: Amount) -> float | None:
    """Compose "in ten minutes", of what is repeated; of other work it is the time that it may take."""
    return duration(time) if word.text == "in" else None


@construction(
    "again: one=again [COMMA] time=later",
    "again: time=later [COMMA] one=again",
    "again: one=again [COMMA] [and_or_but] time=rest",
    "again: one=again [COMMA] time=recurs",
    "again: what=round [COMMA] time=later",
    "again: time=later [COMMA] what=round",
    "again: one=again time=from_now",
    "again: time=from_now [COMMA] one=again",
    "again: what=round [AGAIN] time=from_now",
    "again: time=from_now [COMMA] what=round [AGAIN]",
    "again: what=round AGAIN time=later",
    "again: time=later [COMMA] what=round AGAIN",
    cost=0.1,
)
def repeated_later(
    time: float | Amount, used: int, one: Again | None = None, what: tuple[bool, bool] = (False, False)
) -> Again | None:
    """Compose "do it all again half an hour later" and "three rounds, ten minutes apart"."""
    seconds = duration(time) if isinstance(time, Amount) else time
    if seconds is None or (one is not None and (one.place is not None or one.rest_s)):
        return None
    known = one or Again(None, used, times=1, whole=what[0])
    return replace(known, times=known.times or 1, rest_s=seconds, used=used)


@construction(
    "said: before=said joint=joint once_more_act time=later",
    "said: before=said joint=joint time=later [COMMA] once_more_act",
    "said: before=said joint=joint once_more_act time=from_now",
    "said: before=said joint=joint time=from_now [COMMA] once_more_act",
    cost=0.3,
)
def again_later(before: Said, joint: Connective, time: float, used: int) -> Said | None:
    """Compose "read CO2 at tree 4, and again ten minutes later"."""
    own = used & ~joint.used
    for clause in before.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    wait = CaptureCommand((wait_thing(time),), None, own)
    again = CaptureCommand((Thing(LAST_THING, count=1),), None, own)
    return Said(
        (*before.clauses, LinkedCommand(joint, wait), LinkedCommand(Connective(False, True, 0, both=True), again))
    )


@construction(
    "said: before=said joint=joint time=later [COMMA] one=capture",
    "said: before=said joint=joint time=later [COMMA] one=drive",
    cost=0.5,
)
def later_done(before: Said, joint: Connective, time: float, one: CaptureCommand | DriveCommand, used: int) -> Said:
    """Compose "read CO2 at tree 4. Ten minutes later, photograph tree 9"."""
    own = used & ~joint.used & ~one.used
    for clause in before.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    wait = CaptureCommand((wait_thing(time),), None, own)
    then = Connective(False, True, 0, both=True)
    return Said((*before.clauses, LinkedCommand(joint, wait), LinkedCommand(then, one)))
