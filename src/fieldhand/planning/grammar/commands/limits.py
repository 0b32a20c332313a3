"""Constructions of limits on distance, time and battery."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    Amount,
    Connective,
    Home,
    Lead,
    LimitClause,
    LinkedCommand,
    PlaceMeaning,
    Said,
    Thing,
    Total,
    VisitLimit,
)
from fieldhand.planning.grammar.places.vague import as_many_of_best
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_unvisited, as_top

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_LIMITED = ("metres", "seconds", "percent")
#: Shortest distance that a limit is about, in metres.
_LEAST_DRIVEN = 1.0


@construction("less: word=UPTO", "less: word=CMP", cost=0.0)
def less(word: Lex) -> str | None:
    """Compose "less than"; "shorter than" and "younger than" tell of plants, not of the mission."""
    return "less" if word.value in (None, "UPTO", ("lt", ""), ("le", "")) else None


@construction("of_what: [OF] [DET] BATTERY", "of_what: [AT] LIMIT", "of_what: [OF] DRIVEN", cost=0.1)
def of_what() -> str:
    """Compose "of battery" and "of driving"."""
    return "of"


@construction(
    "closed: most=amount [of_what] TOPS",
    "closed: most=amount [of_what] CLOCK",
    "closed: most=amount [of_what] [COMMA] [AND] NOTMORE",
    "at_most: most=closed",
    "at_most: less most=amount [of_what] [USE]",
    "at_most: UPTO CMP most=amount [of_what]",
    "at_most: most=amount bound=BOUND",
    cost=0.1,
)
def at_most(most: Amount, bound: Lex | None = None) -> Amount | None:
    """Compose "no more than 500 m of driving", "20 minutes tops" and "half an hour or less"."""
    return most if _is_limit(most) and (bound is None or bound.value == ("le", "")) else None


@construction("so_much: most=at_most", "so_much: most=amount", "so_much: most=amount of_what", cost=0.1)
def so_much(most: Amount) -> Amount | None:
    """Compose an amount where it can only be the largest one ("within 20 minutes")."""
    return most if _is_limit(most) else None


def _is_limit(most: Amount) -> bool:
    """Return True for an amount that can limit a mission; 20 cm is no distance that a robot drives."""
    return most.unit in _LIMITED and not (most.unit == "metres" and most.number < _LEAST_DRIVEN)


@construction("in_all: time=amount INALL", "in_all: INALL time=amount", cost=0.3)
def time_in_all(time: Amount) -> Amount | None:
    """Compose "a quarter of an hour in all", which is for the whole mission."""
    return time if time.unit == "seconds" else None


@construction(
    "limit: INSIDE most=so_much",
    "limit: [subject] [MUST] USE most=so_much",
    "limit: USE most=so_much ON",
    "limit: [subject] [MUST] GO most=at_most",
    "limit: [subject] [MUST] TAKES most=at_most",
    "limit: most=amount [COMMA] EARLIEST",
    "limit: HAVE most=so_much",
    "limit: at most=at_most",
    "limit: FOR most=at_most",
    "limit: WITH most=amount AS UPPERLIMIT",
    "limit: [WITH] most=closed",
    "limit: subject [MUST] [IS] most=at_most",
    "limit: CAPAT subject [AT] most=so_much",
    "limit: subject COMMA most=at_most",
    "limit: [WITH] subject [IS] LIMITEDTO most=amount [GO]",
    "limit: [at] [DET] UPPERLIMIT [IS] [OF] [COMMA] most=so_much",
    "limit: [at] [DET] most=amount UPPERLIMIT",
    "limit: BEFORE most=amount OVERDUE",
    "limit: most=in_all",
    "limit: subject [MUST] [IS] most=in_all",
    "limit: [subject] [MUST] TAKES most=in_all",
    "limit: [subject] [MUST] USE most=in_all",
    "limit: AT [DET] most=amount LIMIT",
    "limit: AS most=so_much ALLOW",
    cost=0.3,
)
def limited_to(most: Amount, used: int) -> LimitClause | None:
    """Compose "within 500 m", "it must take no more than 20 minutes" and "time limit: 20 minutes"."""
    return LimitClause(most, False, used) if _is_limit(most) else None


@construction("limit: [WITH] [IS] LIMITEDTO most=amount [GO]", cost=0.3)
def less_than(most: Amount, used: int) -> LimitClause | None:
    """Compose "under 500 m"; "below 30 percent" tells of readings, not of the battery."""
    return None if most.unit == "percent" else limited_to(most, used)


@construction(
    "limit: said=limit [COMMA] [AND] NOTMORE",
    "limit: said=limit [COMMA] [AND] WAYBACKTOO",
    "limit: [subject] [MUST] BEDONE said=limit",
    "limit: PROVIDED said=limit",
    cost=0.2,
)
def emphasised(said: LimitClause, used: int) -> LimitClause | None:
    """Compose "within 20 minutes and not a minute more" and "be done in 20 minutes"."""
    return None if said.keep else replace(said, used=used, later=False)


@construction(
    "limit: UPTO most=amount [of_what]",
    "limit: less most=amount of_what",
    "limit: less length=amount",
    "limit: subject COMMA time=amount",
    cost=0.5,
)
def at_most_so_much(
    used: int, most: Amount | None = None, length: Amount | None = None, time: Amount | None = None
) -> LimitClause | None:
    """Compose "max 20 minutes" and "time: 20 min"; "at most 30 %" may be a reading, "distance: 20 m" one of stops."""
    if length is not None and length.unit == "percent":
        return None
    amount = most or length or time
    if amount is None or (time is not None and time.unit != "seconds"):
        return None
    return limited_to(amount, used)


@construction("limit: word=AT most=amount [of_what]", cost=0.4)
def in_time(word: Lex, most: Amount, used: int) -> LimitClause | None:
    """Compose "in 20 minutes" and "on 20 % of the battery"."""
    if most.unit == "seconds" and "in_time" in word.features:
        return LimitClause(most, False, used, later=True)
    return LimitClause(most, False, used) if most.unit == "percent" and "on_charge" in word.features else None


@construction("limit: word=THEN most=at_most", cost=0.3)
def after_at_most(word: Lex, most: Amount, used: int) -> LimitClause | None:
    """Compose "(come back) after at most 20 minutes"."""
    return LimitClause(most, False, used) if "after_doing" in word.features and most.unit == "seconds" else None


@construction("subject: [DET] DRIVEN", "subject: MISSION", "subject: [DET] BATTERY USE", "subject: IT", cost=0.1)
@construction("subject: word=DET", cost=0.3)
def subject(word: Lex | None = None) -> str | None:
    """Compose what is limited: "the driving distance", "the whole thing", "that"."""
    return "it" if word is None or "demonstrative" in word.features else None


@construction(
    "limit: [subject] WITHOUT USE check=CMP most=amount [of_what]",
    "limit: [subject] WITHOUT GO check=CMP most=amount [of_what]",
    "limit: [subject] WITHOUT [TAKES] check=CMP most=amount [of_what]",
    cost=0.3,
)
def not_more_than(check: Lex, most: Amount, used: int) -> LimitClause | None:
    """Compose "without driving more than 100 m" and "don't take longer than 20 minutes"."""
    return LimitClause(most, False, used) if check.value[0] in ("gt", "ge") and most.unit in _LIMITED else None


@construction("reserve: least=amount", "reserve: least=amount of_what", "reserve: BATTERY COMMA least=amount", cost=0.1)
def reserve(least: Amount) -> Amount | None:
    """Compose "30 % of the battery"."""
    return least if least.unit == "percent" else None


@construction(
    "reserve: least=at_least", "reserve: least=battery_at_least", "battery_at_least: least=at_least of_what", cost=0.0
)
def left_at_least(least: Amount) -> Amount:
    """Compose "at least 30 % of the battery"."""
    return least


@construction("at_least: check=CMP least=amount", "battery_at_least: [DET] BATTERY check=CMP least=amount", cost=0.1)
def at_least(check: Lex, least: Amount) -> Amount | None:
    """Compose "at least 30 % of the battery"."""
    return least if least.unit == "percent" and check.value[0] in ("gt", "ge") else None


@construction(
    "low_battery: [DET] BATTERY [IS] least=amount",
    "low_battery: [DET] BATTERY [IS] AT least=amount",
    "low_battery: [DET] BATTERY [IS] check=CMP least=amount",
    "low_battery: [DET] BATTERY REACHES least=amount",
    "low_battery: [DET] BATTERY GOUNDER least=amount",
    "low_battery: check=CMP least=amount of_what [IS] LEFT",
    "low_battery: THEREIS check=CMP least=amount [of_what] LEFT [of_what]",
    "low_battery: THEREIS check=CMP least=amount of_what",
    "low_battery: least=left_now",
    cost=0.1,
)
def low_battery(least: Amount, check: Lex | None = None) -> Amount | None:
    """Compose "the battery is down to 30 %"."""
    return least if least.unit == "percent" and (check is None or check.value[0] in ("lt", "le")) else None


@construction(
    "left_now: [THEREIS] [ONLY] least=reserve [IS] LEFT [of_what]",
    "left_now: CONTRACTED [ONLY] least=reserve LEFT [of_what]",
    "left_now: you=CONTRACTED DOWNAT least=reserve",
    cost=0.1,
)
def left_now(least: Amount, you: Lex | None = None) -> Amount | None:
    """Compose "only 30 % is left" and "you are down to 30 %"."""
    return least if you is None or "of_the_robot" in you.features else None


@construction(
    "low_battery: [DET] BATTERY [IS] [AT] level=NUM",
    "low_battery: [DET] BATTERY REACHES level=NUM",
    "low_battery: [DET] BATTERY GOUNDER level=NUM",
    "low_battery: [DET] BATTERY [IS] check=CMP level=NUM",
    cost=0.4,
)
def low_number(level: Lex, check: Lex | None = None) -> Amount | None:
    """Compose "the battery reaches 30", in percent."""
    whole = level.value == int(level.value) and 1.0 < level.value <= 100.0
    return low_battery(Amount(number=float(level.value), unit="percent"), check) if whole else None


@construction(
    "low_battery: [DET] BATTERY [IS] check=CMP part=PART",
    "low_battery: [DET] BATTERY [IS] check=CMP DET part=PART",
    "low_battery: [DET] BATTERY GOUNDER [DET] part=PART",
    "low_battery: [DET] BATTERY REACHES [DET] part=PART",
    cost=0.2,
)
def low_part(part: Lex, check: Lex | None = None) -> Amount | None:
    """Compose "the battery drops below a third"."""
    return low_battery(part_of_battery(part), check)


@construction("it_low: IT [IS] check=CMP least=amount [of_what]", "it_low: IT REACHES least=amount", cost=0.1)
@construction("it_low: IT GOUNDER least=amount", "it_low: CONTRACTED DOWNAT least=amount", cost=0.1)
@construction("it_low: CONTRACTED check=CMP least=amount", cost=0.1)
def it_is_low(least: Amount, check: Lex | None = None) -> Amount | None:
    """Compose "it is down to 30 %" behind "charge the battery when"."""
    return low_battery(least, check)


@construction(
    "limit: KEEP least=reserve [LEFT] [word=THEN]",
    "limit: WITH least=reserve LEFT [word=THEN]",
    "limit: WANT least=reserve LEFT [word=THEN]",
    "limit: least=reserve KEPT [word=THEN]",
    "limit: least=at_least LEFT [word=THEN]",
    "limit: least=battery_at_least [LEFT] [word=THEN]",
    "limit: BEFORE least=low_battery [LEFT]",
    "limit: STOP in_case least=low_battery",
    "limit: STOP AT least=reserve",
    "limit: [DET] BATTERY STAYSOVER least=amount",
    "limit: NEVERLET least=low_battery",
    "limit: WITHOUT least=low_battery",
    "limit: WITHOUT GOUNDER least=reserve",
    cost=0.3,
)
def keep(least: Amount, used: int, word: Lex | None = None) -> LimitClause | None:
    """Compose "keep at least 30 % battery" and "the battery must not go under 30 %"."""
    if least.unit != "percent" or (word is not None and "when_done" not in word.features):
        return None
    return LimitClause(least, True, used)


@construction(
    "battery_over: [DET] BATTERY [IS] check=CMP least=amount", "battery_over: [DET] BATTERY STAYSOVER least=amount",
    "battery_over: THEREIS check=CMP least=amount [of_what] LEFT",
    "battery_over: THEREIS check=CMP least=amount of_what",
    cost=0.1,
)  # fmt: skip
def battery_over(least: Amount, check: Lex | None = None) -> Amount | None:
    """Compose "the battery is above 30 %"."""
    return least if least.unit == "percent" and (check is None or check.value[0] in ("gt", "ge")) else None


@construction("until_low: UNTIL least=low_battery [LEFT]", "until_low: STAYING least=battery_over", cost=0.1)
def until_low(least: Amount) -> Amount:
    """Compose "until the battery is at 40 %" and "as long as the battery is above 40 %"."""
    return least


@construction("limit: least=until_low", cost=0.2)
def on_until_low(least: Amount, used: int) -> LimitClause:
    """Compose "until the battery is at 40 %" behind what is done until then."""
    return LimitClause(least, True, used, until=True)


@construction("limit: WITH least=amount of_what", "limit: WITH least=share", cost=0.4)
def with_so_much(least: Amount, used: int) -> list[LimitClause] | None:
    """Compose "with 30 % of the battery", which may be used or has to be left."""
    return [LimitClause(least, keep, used) for keep in (False, True)] if least.unit == "percent" else None


@construction(
    "limit: back=home WITH least=reserve [LEFT]",
    "limit: RETURN BEFORE least=low_battery [LEFT]",
    "limit: homeward in_case least=low_battery",
    "limit: in_case least=low_battery [COMMA] [STOP] [AND] homeward",
    "limit: back=homeward at=AT least=reserve [LEFT]",
    "limit: at=AT least=reserve [LEFT] [COMMA] [STOP] [AND] back=homeward",
    cost=0.2,
)
def home_with(least: Amount, used: int, back: Home | None = None, at: Lex | None = None) -> LimitClause | None:
    """Compose "be back with 30 % of the battery", "come home at 40 %" and "return if the battery drops below 25 %"."""
    if least.unit != "percent" or (back is not None and (back.then == "return_to_end" or back.to_it)):
        return None
    if at is not None and "at_level" not in at.features:
        return None
    return LimitClause(least, True, used, back=True)


@construction("homeward: back=home", cost=0.0)
@construction("homeward: TURNBACK", cost=0.1)
def homeward(used: int, back: Home | None = None) -> Home:
    """Compose "turn back" behind or before a state of the battery."""
    return Home(None, used) if back is None else back


@construction("said: HAVE most=amount FOR place=place joint=joint rest=said", cost=0.4)
def so_much_for(most: Amount, place: PlaceMeaning, joint: Connective, rest: Said, used: int) -> Said | None:
    """Compose "we have 40 minutes for the yellow trees. Photograph ...", which is about them."""
    if most.unit not in _LIMITED or place.shape not in ("several", "area"):
        return None
    own = used & ~place.tokens & ~joint.used
    for clause in rest.clauses:
        own &= ~(clause.command.used | (0 if clause.before is None else clause.before.used))
    first, *others = rest.clauses
    limit = LinkedCommand(None, LimitClause(most, False, own))
    topic = LinkedCommand(Connective(True, False, 0), Lead(place, place.tokens, relation="topic"))
    return Said((limit, topic, replace(first, before=joint), *others))


@construction(
    "total: things=things INALL",
    "total: INALL things=things",
    "total: n=count READING INALL",
    "total: TOTALLING things=things [INALL]",
    "total: TOTALLING n=count READING [INALL]",
    cost=0.1,
)
def total(used: int, things: tuple[Thing, ...] = (), n: int = 0) -> Total | None:
    """Compose "six samples in total", which must agree with the plan."""
    if things and (len(things) > 1 or not things[0].count or things[0].count < 2):
        return None
    return Total(things[0].count or 0, things[0].action, used) if things else Total(n, "", used)


@construction("share: part=PART [OF] [DET] BATTERY", cost=0.1)
def part_of_battery(part: Lex) -> Amount:
    """Compose "a quarter of the battery"."""
    return Amount(number=round(100 * part.value, 2), unit="percent")


@construction("amount: part=share", cost=0.0)
def share(part: Amount) -> Amount:
    """Compose a part of the battery as an amount."""
    return part


@construction("in_case: IF", "in_case: WHERE", "in_case: ASSOONAS", cost=0.0)
def in_case() -> str:
    """Compose "if" and "when" before a state of the battery."""
    return "if"


@construction("at: AT", "at: CMP", "at: INSIDE", "at: WITH", cost=0.0)
def at_word() -> str:
    """Compose "at" before a limit."""
    return "at"


@construction(
    "visit_limit: n=count [OFTHEM] TOPS",
    "visit_limit: n=count TREE TOPS",
    "visit_limit: n=count READING TOPS",
    "visit_limit: n=count POINT TOPS",
    "visit_limit: check=CMP n=count POINT",
    "visit_limit: check=UPTO n=count POINT",
    "visit_limit: check=UPTO n=count OFTHEM",
    "visit_limit: NEVERMORE n=count",
    "visit_limit: NEVERMORE n=count OFTHEM",
    "visit_limit: NEVERMORE n=count READING",
    "visit_limit: NEVERMORE n=count TREE",
    "visit_limit: NEVERMORE n=count POINT",
    "visit_limit: NEVERMORE n=count TOPS",
    "visit_limit: NEVERMORE n=count READING TOPS",
    "visit_limit: NEVERMORE n=count POINT TOPS",
    "visit_limit: check=CMP n=count",
    "visit_limit: check=CMP n=count READING",
    "visit_limit: check=CMP n=count TREE",
    "visit_limit: check=UPTO n=count TREE",
    "visit_limit: check=CMP n=count POINT",
    "visit_limit: check=UPTO n=count POINT",
    "visit_limit: check=UPTO n=count OFTHEM",
    "visit_limit: check=CMP n=count TIMES",
    "visit_limit: check=UPTO n=count",
    "visit_limit: check=UPTO n=count READING",
    "visit_limit: check=UPTO n=count TIMES",
    "visit_limit: check=CMP n=count OFTHEM",
    "visit_limit: STOP word=THEN n=count [TREE] [TOPS]",
    "visit_limit: STOP word=THEN n=count READING [TOPS]",
    "visit_limit: STOP word=THEN n=count POINT [TOPS]",
    "visit_limit: STOP word=THEN n=count OFTHEM [TOPS]",
    cost=0.5,
)
def visits_at_most(n: int, used: int, word: Lex | None = None, check: Lex | None = None) -> VisitLimit | None:
    """Compose "five at most", "at most five of them" and "give up after 8 trees"."""
    if (word is not None and "after_doing" not in word.features) or (
        check is not None and check.value not in (("le", ""), None, "UPTO")
    ):
        return None
    return VisitLimit(n, used)


@construction(
    "visit_limit: VISIT limit=visit_limit",
    "visit_limit: TAKE limit=visit_limit",
    "visit_limit: MEASURE limit=visit_limit",
    "visit_limit: WITH limit=visit_limit",
    "visit_limit: WHODOES limit=visit_limit",
    cost=0.0,
)
def visiting_at_most(limit: VisitLimit, used: int) -> VisitLimit | None:
    """Compose "visit no more than ten plants" behind what is done at them."""
    return None if limit.count is None else replace(limit, used=used)


@construction(
    "visit_limit: ASMANY as_can [COMMA] [AND] [NOTMORE]", "visit_limit: HOWEVERMANY as_can [COMMA] [NOTMORE]", cost=0.5
)
def as_many_of_them(used: int) -> VisitLimit:
    """Compose "as many as you can", of the places before it."""
    return VisitLimit(None, used)


@construction("place: ASMANY [OF] [other=OTHER] whole=place", cost=2.0)
@construction(
    "place: ASMANY as_can OF whole=place",
    "place: ASMANY [OF] [other=OTHER] whole=place as_can",
    "place: HOWEVERMANY [OF] whole=place as_can",
    cost=0.3,
)
def as_many_of(whole: PlaceMeaning, other: Lex | None = None) -> PlaceMeaning | None:
    """Compose "as many as you can of trees 4 to 9", "as many different trees as possible" and "however many fit"."""
    if whole.shape not in ("several", "area") or whole.per is not None or whole.optional or whole.at_most is not None:
        return None
    if are_unvisited(whole.selector) or (other is not None and "others" in other.features):
        return None
    chosen = whole.vague or as_top(whole.selector) is not None  # "of the 30 oldest trees"
    if whole.count is not None and not chosen and not all(one.named_tree for one in whole.selector.members):
        return None
    return as_many_of_best(replace(whole, shape="several", optional=True, count=None))
