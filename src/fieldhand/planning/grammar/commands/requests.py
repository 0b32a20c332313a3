"""Constructions of requests: commands, and what joins them."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import (
    LAST_THING,
    LAST_THINGS,
    After,
    Again,
    Allowed,
    AllTests,
    CaptureCommand,
    CaptureWhere,
    Command,
    Connective,
    Correction,
    DriveCommand,
    Failing,
    Home,
    InAnOrder,
    InTurn,
    Lead,
    LimitClause,
    LinkedCommand,
    Otherwise,
    PaceClause,
    PassOn,
    PlaceMeaning,
    RankCommand,
    ReadingQuestion,
    Reordered,
    Said,
    SettleClause,
    StopCommand,
    Test,
    Thing,
    UntilCondition,
    WayRule,
    When,
    WorkCommand,
)
from fieldhand.planning.grammar.places.numbers import named_trees
from fieldhand.planning.grammar.places.sampling import bare_zone
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_excluding, named_places, swapped
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Clauses that a command may follow without a connective.
_LEADS_ON = (
    When | Otherwise | Lead | LimitClause | WayRule | Allowed | InAnOrder | Failing | After | PaceClause | SettleClause
)

#: Features of words for what is done before everything else ("before all of that", "before you set off").
_BEFORE_ALL = ("of_several", "before_all")


@construction(
    "command: one=capture",
    "command: one=drive",
    "command: one=lead",
    "command: one=home",
    "command: one=halt",
    "command: one=when",
    "command: one=capture_where",
    "command: one=otherwise",
    "command: one=pass_on",
    "command: one=limit",
    "command: one=recharging",
    "command: one=allow",
    "command: one=until",
    "command: one=visit_limit",
    "command: one=total",
    "command: one=ranked_first",
    "command: one=again",
    "command: one=order",
    "command: one=after",
    "command: one=question",
    "command: one=failing",
    "command: one=reordered",
    "command: one=pace",
    "command: one=settle",
    cost=0.0,
)
def command(one: Command) -> Command:
    """Compose "take a picture"."""
    return one


@construction("and_or_but: word=AND", "and_or_but: word=CONTRAST", cost=0.0)
def and_or_but(word: Lex) -> Lex:
    """Compose "and" and "but" between commands; "but" joins no places."""
    return word


@construction("joint: [COMMA] both=and_or_but COMMA [then] [COMMA]", cost=0.3)
def joint_with_comma(used: int, both: Lex, then: str = "") -> Connective:
    """Compose ", and, then"."""
    return Connective(False, bool(then), used, both=True, contrasts="contrast" in both.features)


@construction(
    "joint: [COMMA] [and_or_but] word=FIRSTLY [COMMA]",
    "joint: FULLSTOP [and_or_but] word=FIRSTLY [COMMA]",
    "joint: COMMA BUT word=FIRSTLY",
    cost=0.2,
)
def but_first(used: int, word: Lex) -> Connective:
    """Compose ", but first" and "before all of that,"."""
    return Connective(False, True, used, first=True, of_all=not word.features.isdisjoint(_BEFORE_ALL))


@construction("joint: [COMMA] both=and_or_but [after=then]", "joint: COMMA [after=then]", "joint: after=then", cost=0.2)
def joint(used: int, after: str = "", both: Lex | None = None) -> Connective | None:
    """Compose "and", and "then" that adds another place ("a picture of row 3, then of row 4")."""
    bare = not after and both is None
    contrasts = both is not None and "contrast" in both.features
    if after == "from here":
        return None
    return Connective(False, False, used, both=both is not None, contrasts=contrasts, bare=bare, in_turn=bool(after))


@construction("joint: [before=COMMA] [both=and_or_but] then=then [COMMA]", cost=0.1)
def then_joint(used: int, then: str, before: Lex | None = None, both: Lex | None = None) -> Connective:
    """Compose "and then"; "from there" alone begins a sentence."""
    from_here = then == "from here"
    full = from_here and before is None and both is None
    return Connective(full, True, used, from_here=from_here, begins=then == "at first")


@construction(
    "joint: [COMMA] and_or_but [COMMA] AFTEREACH [COMMA]", "joint: COMMA AFTEREACH [COMMA]",
    "joint: [COMMA] and_or_but [COMMA] INEACHCASE [COMMA]", cost=0.1,
)  # fmt: skip
def after_each(used: int) -> Connective:
    """Compose "and after each one", before the place opposite it."""
    return Connective(False, False, used, both=True, each=True)


@construction("joint: FULLSTOP [and_or_but]", cost=0.1)
def full_stop(used: int) -> Connective:
    """Compose "."."""
    return Connective(True, False, used)


@construction("joint: FULLSTOP word=OPENER [COMMA]", cost=0.1)
def full_stop_opener(word: Lex, used: int) -> Connective | None:
    """Compose ". Right,"."""
    return None if "before_all" in word.features else Connective(True, True, used)


@construction("joint: FULLSTOP word=THEN COMMA", cost=0.3)
def full_stop_after(word: Lex, used: int) -> Connective | None:
    """Compose ". After," at the beginning of a sentence."""
    return Connective(True, True, used) if "after_doing" in word.features else None


@construction("joint: FULLSTOP [and_or_but] then=then [COMMA]", cost=0.1)
def full_stop_then(used: int, then: str) -> Connective:
    """Compose ". Then"."""
    return Connective(True, True, used, from_here=then == "from here", begins=then == "at first")


@construction("joint: INORDERTO", cost=1.0)
def in_order_to(used: int) -> Connective:
    """Compose "to", before what is done at the place."""
    return Connective(False, True, used, purpose=True)


@construction("opening: FIRSTONE", cost=0.0)
def opening(used: int) -> Connective:
    """Compose "first" at the beginning of a request."""
    return Connective(False, True, used)


@construction("before: word=BEFORE", cost=0.0)
def before(word: Lex, used: int) -> Connective | None:
    """Compose "before" at the beginning of a request."""
    return Connective(False, True, used) if "before_doing" in word.features else None


@construction("said: word=before last=command [COMMA] rest=said", cost=0.3)
def before_last(word: Connective, last: Command, rest: Said) -> Said | None:
    """Compose "before going back to the start, photograph tree 4", of one sentence."""
    if not isinstance(last, Home | CaptureCommand | DriveCommand):
        return None
    if any(clause.before is not None and clause.before.full for clause in rest.clauses):
        return None
    return Said((*rest.clauses, LinkedCommand(replace(word, full=not isinstance(last, Home)), last)))


@construction("said: before=said joint=joint word=before last=command [COMMA] one=command", cost=0.3)
def before_home(before: Said, joint: Connective, word: Connective, last: Command, one: Command) -> Said | None:
    """Compose ". Before coming back, photograph tree 9"."""
    if not isinstance(one, CaptureCommand | DriveCommand) or not isinstance(last, Home):
        return None
    return Said((*before.clauses, LinkedCommand(joint, one), LinkedCommand(replace(word, full=False), last)))


@construction(
    "command: STARTWITH one=capture",
    "command: STARTWITH one=drive",
    "command: word=ENDWITH one=capture",
    "command: word=ENDWITH one=drive",
    cost=0.2,
)
def in_turn(one: CaptureCommand | DriveCommand, used: int, word: Lex | None = None) -> InTurn:
    """Compose "start with CO2 at tree 4" and "finish with a picture of tree 9"."""
    made = replace(one, used=used)
    if isinstance(made, CaptureCommand) and made.relation == "bare":
        made = replace(made, relation="at")
    return InTurn(made, word is None, used)


@construction("placed: place=place WITH things=things", "placed: place=place BY one=capture", cost=0.0)
def captured_at(
    place: PlaceMeaning, things: tuple[Thing, ...] = (), one: CaptureCommand | None = None
) -> CaptureCommand | None:
    """Compose "(begin at) tree 46 with a picture"."""
    if place.shape not in ("one", "several") or (one is not None and one.place is not None):
        return None
    return CaptureCommand(things or (() if one is None else one.things), place, 0)


@construction("command: STARTING one=placed", "command: word=ENDING one=placed", cost=0.2)
def in_turn_there(one: CaptureCommand, used: int, word: Lex | None = None) -> InTurn | None:
    """Compose "begin at tree 46 with a picture" and "end at tree 46 by measuring CO2"."""
    marked = one.place is not None and one.place.selector.named_marker  # "end at the charger": the robot stays there
    ends = word is not None and "ends_there" in word.features and not marked
    return InTurn(replace(one, used=used), word is None, used) if word is None or ends else None


@construction(
    "corrects: CORRECTION COMMA", "corrects: CORRECTION [COMMA] corrects", "corrects: word=CORRECTION", cost=0.0
)
def corrects(word: Lex | None = None) -> str | None:
    """Compose "no, wait,"; "no tree 5" corrects nothing."""
    if word is None:
        return "no"
    return None if "negates" in word.features else word.text


@construction(
    "command: corrects=corrects place=place",
    "command: corrects=corrects relation=relation place=place",
    cost=0.2,
)
def correction(place: PlaceMeaning, used: int, corrects: str, relation: str = "") -> Correction | None:
    """Compose "no wait, tree 9"; "wait at tree 9" asks to wait there."""
    return None if relation and corrects == "wait" else Correction(place, used)


@construction("scratched: SCRATCH place=place", "scratched: SCRATCH trees=numbers", cost=0.1, given=("site",))
def scratched(site: Site, place: PlaceMeaning | None = None, trees: tuple[str, ...] = ()) -> PlaceMeaning | None:
    """Compose "scratch tree 4" and, on a site whose trees have numbers, "scratch 4"."""
    if place is not None:
        return place
    return named_trees(trees) if all(name in site.by_id for name in trees) else None


@construction(
    "command: old=scratched [COMMA] [AND] corrects place=place",
    "command: old=scratched [COMMA] [AND] corrects trees=numbers",
    cost=0.2,
    given=("site",),
)
def correction_of(
    old: PlaceMeaning, used: int, site: Site, place: PlaceMeaning | None = None, trees: tuple[str, ...] = ()
) -> Correction | None:
    """Compose "scratch tree 4, make it tree 9"."""
    new = scratched(site, place, trees)
    return None if new is None else Correction(new, used, old=old)


@construction("said: before=said DASH one=command", cost=0.3)
def corrected_by_dash(before: Said, one: Command) -> Said | None:
    """Compose "take a picture of tree 4 - no, tree 9" and what follows the second dash."""
    last = before.clauses[-1].command
    joint = None if isinstance(one, Correction) else Connective(False, False, 0, bare=True)
    fits = isinstance(one, Correction | Reordered) or isinstance(last, Correction)
    return Said((*before.clauses, LinkedCommand(joint, one))) if fits else None


@construction(
    "reordered: [CORRECTION] [COMMA] SWAP", "reordered: [CORRECTION] [COMMA] SWAP COMMA one=reordered", cost=0.2
)
def swapped_steps(used: int, one: Reordered | None = None) -> Reordered:
    """Compose "actually, the other way round"."""
    return Reordered(None if one is None else one.first, used, swapped=True)


@construction(
    "reordered: place=place FIRSTONE",
    "reordered: [CONTRAST] place=place BEFORE second=place",
    "reordered: BUT place=place BEFORE second=place",
    cost=0.3,
)
def comes_first(place: PlaceMeaning, used: int, second: PlaceMeaning | None = None) -> Reordered | None:
    """Compose "tree 9 first" and "tree 9 before tree 4", behind the steps."""
    return Reordered(place, used, then=second) if place.shape in ("one", "several", "area") else None


@construction("said: last=home COMMA rest=said", "said: last=home FULLSTOP rest=said", cost=0.2)
def home_when_done(last: Home, rest: Said) -> Said | None:
    """Compose "come back when done: photograph tree 4"."""
    then = rest.clauses[0].before is not None and rest.clauses[0].before.then  # "meet me at the start, then ..."
    return Said((*rest.clauses, LinkedCommand(None, last))) if last.when_done and not then else None


@construction("said: last=drive COMMA rest=said", "said: last=drive FULLSTOP rest=said", cost=0.2)
def ending_there(last: DriveCommand, rest: Said) -> Said | None:
    """Compose "finish at the charger: photograph tree 4"."""
    then = rest.clauses[0].before is not None and rest.clauses[0].before.then
    return Said((*rest.clauses, LinkedCommand(None, last))) if last.ends and not then else None


@construction("joint: word=BEFORE", cost=0.3)
def before_doing(word: Lex, used: int) -> Connective | None:
    """Compose "before"."""
    return Connective(False, True, used, precedes=True) if "before_doing" in word.features else None


@construction("then: word=ONTHEWAY", cost=0.1)
def then_on_the_way(word: Lex) -> str:
    """Compose "on the way back" before what is done then."""
    return "homewards" if "homewards" in word.features else "then"


@construction("then: word=THEN", cost=0.0)
def then(word: Lex) -> str | None:
    """Compose "then"."""
    if "after_doing" in word.features:
        return None
    if "from_here" in word.features:
        return "from here"
    return "at first" if "begins" in word.features else "then"


@construction("joint: [COMMA] WHILE", cost=0.3)
def meanwhile(used: int) -> Connective:
    """Compose "while", before another capture at the same place."""
    return Connective(False, False, used, both=True)


@construction(
    "then: [DET] ORD LABEL IS [INORDERTO]",
    "then: [DET] NEXTONE LABEL IS [INORDERTO]",
    "then: [DET] LAST LABEL IS [INORDERTO]",
    cost=0.1,
)
def next_task_is() -> str:
    """Compose "your next task is to"."""
    return "then"


@construction(
    "capture: place=place IS TAKE WITH things=things",
    "capture: MUST things=things IS verb relation place=place",
    cost=0.5,
)
def is_done(place: PlaceMeaning, things: tuple[Thing, ...], used: int) -> CaptureCommand | None:
    """Compose "(after) row 2 has been done with the thermal camera" and "should the CO2 be taken at tree 4"."""
    return CaptureCommand(tuple(replace(one, plural=place.shape == "area") for one in things), place, used)


@construction("capture: act=capture [COMMA] place=here", cost=0.5)
def done_there(act: CaptureCommand, place: PlaceMeaning, used: int) -> CaptureCommand | None:
    """Compose "photograph the ground there"."""
    known = (
        act.place is None or act.place == place or (act.place.shape == place.shape == "here" and not act.place.itself)
    )
    relation = "plain" if act.relation == "bare" else act.relation
    return replace(act, place=place, used=used, relation=relation) if known and act.spacing is None else None


@construction("in_the_end: one=capture [COMMA] word=THEN", cost=0.1)
def in_the_end(one: CaptureCommand, word: Lex, used: int) -> CaptureCommand | None:
    """Compose "photograph it afterwards", behind something else."""
    done = "when_done" in word.features and "before_doing" not in word.features
    return replace(one, used=used) if done else None


@construction("said: before=said joint=joint one=in_the_end", cost=0.2)
def captured_afterwards(before: Said, joint: Connective, one: CaptureCommand) -> Said:
    """Compose "... and photograph it afterwards", as it comes next anyway."""
    return Said((*before.clauses, LinkedCommand(joint, one)))


@construction("capture: one=capture [COMMA] THISTIME", "capture: THISTIME [COMMA] one=capture", cost=0.2)
def captured_this_time(one: CaptureCommand, used: int) -> CaptureCommand:
    """Compose "this time photograph it"."""
    return replace(one, used=used)


@construction("capture: TAKE INSTEAD things=things [relation] [place=place]", cost=0.4)
def take_instead(things: tuple[Thing, ...], used: int, place: PlaceMeaning | None = None) -> CaptureCommand:
    """Compose "take instead a picture", in another case."""
    return CaptureCommand(things, place, used, instead=True)


@construction("capture: things=things OF place=place", "capture: ONE OF place=place", cost=1.2, given=("site",))
def another_of_each(
    place: PlaceMeaning, used: int, site: Site, things: tuple[Thing, ...] = (Thing(LAST_THING, count=1),)
) -> CaptureCommand | None:
    """Compose "(and then) one of the tree on each side of it" and "(followed by) one of the trough"."""
    one_more = [(one.action, one.count) for one in things] == [(LAST_THING, 1)]
    free = bool(bare_zone(place.selector, site)) if place.shape == "area" else place.shape == "one"
    named = free and not place.refers_back and (place.shape == "area" or place.selector.named_tree)
    return CaptureCommand(things, place, used, relation="of") if one_more and (place.each or named) else None


@construction("thing: DET SAME reading=READING", cost=0.5)
def same_reading(reading: Lex) -> Thing | None:
    """Compose "the same measurement"."""
    return None if reading.plural else Thing(LAST_THING)


@construction("things: WHICHONE things=things IS", cost=0.3)
def what_it_is(things: tuple[Thing, ...]) -> tuple[Thing, ...]:
    """Compose "what the air temperature is"."""
    return things


@construction("here: SAME noun=TREE", cost=0.3)
def same_tree(noun: Lex) -> PlaceMeaning | None:
    """Compose "same tree"."""
    return None if noun.plural else PlaceMeaning(s.Here(), "here", one_tree=True)


@construction(
    "thing: word=DET rank=ORD ONE", "thing: word=DET rank=ORD reading=READING", "thing: word=DET rank=ORD", cost=1.5
)
def second_one(word: Lex, rank: Lex, reading: Lex | None = None) -> Thing | None:
    """Compose "a second one", of what was captured last."""
    if "indefinite" not in word.features or rank.value < 2 or (reading is not None and reading.plural):
        return None
    return Thing(LAST_THING, count=1)


@construction("things: several=GROUPALL AGAIN", "things: DET SAME n=count", cost=0.5)
def those_things(several: Lex | None = None, n: int = 0) -> tuple[Thing, ...] | None:
    """Compose "both again" and "the same two", of what was captured together."""
    if several is not None and "of_trees" in several.features:
        return None
    number = 2 if several is not None and "two" in several.features else n or None
    return None if n == 1 else (Thing(LAST_THINGS, count=number, plural=True),)


@construction("again: one=again [COMMA] INORDER", cost=0.2)
def again_in_that_order(one: Again, used: int) -> Again | None:
    """Compose "both again, same order"."""
    return replace(one, used=used) if one.times else None


@construction("capture: MEASURE it=IT [AGAIN] relation place=place", "capture: MEASURE it=IT AGAIN", cost=0.8)
def measured_elsewhere(it: Lex, used: int, place: PlaceMeaning | None = None) -> CaptureCommand | None:
    """Compose "(if the CO2 at the mast is high,) read it at the trough", of what was captured last."""
    single = place is None or (place.shape in ("one", "several", "area") and not place.refers_back)
    if "of_several" in it.features or not single:
        return None
    return CaptureCommand((Thing(LAST_THING, count=1),), place, used)


@construction("capture: AGAIN", "capture: AGAIN place=here", "capture: MEASURE AGAIN", cost=1.5)
def once_more(used: int, place: PlaceMeaning | None = None) -> CaptureCommand:
    """Compose "(and then) once more", of what was captured last."""
    return CaptureCommand((Thing(LAST_THING, count=1),), place, used)


@construction(
    "after: word=THEN done=capture",
    "after: word=THEN done=drive",
    "after: HAVINGDONE done=capture",
    "after: HAVINGDONE done=drive",
    cost=0.2,
)
def after_doing(done: CaptureCommand | DriveCommand, used: int, word: Lex | None = None) -> After | None:
    """Compose "after photographing tree 4" and "having photographed tree 4"."""
    return After(done, used) if word is None or "after_doing" in word.features else None


@construction("opened: OPENER [COMMA]", "opened: OPENER [COMMA] then [COMMA]", cost=0.0)
def opener(used: int) -> Connective:
    """Compose "right," at the beginning of a request."""
    return Connective(False, True, used)


@construction("opened: word=then [COMMA]", cost=0.0)
def then_at_first(word: str, used: int) -> Connective | None:
    """Compose "firstly," at the beginning of a request."""
    return None if word == "homewards" else Connective(False, True, used)


@construction("opened: SEENAS site AS [DET] RECTANGLE [COMMA] [AND]", cost=0.0)
def as_a_rectangle(used: int) -> Connective:
    """Compose "treat the farm as a rectangle and", which is what its corners are of anyway."""
    return Connective(False, True, used)


@construction("said: first=opening one=command", "said: first=opened one=command", cost=0.2)
def first_of_all(first: Connective, one: Command) -> Said:
    """Compose "first go to tree 4"."""
    return Said((LinkedCommand(first, one),))


@construction("said: one=capture FIRSTONE", "said: one=drive FIRSTONE", "said: one=work FIRSTONE", cost=0.2)
@construction("said: one=capture word=FIRSTLY", cost=0.2)
def what_is_first(one: CaptureCommand | DriveCommand | WorkCommand, used: int, word: Lex | None = None) -> Said | None:
    """Compose "photograph tree 4 first"; "photograph trees 4 and 9, tree 9 first" is an order."""
    if word is not None and "before_all" not in word.features:
        return None
    where = one.along if isinstance(one, WorkCommand) else None if one.place is None else one.place.selector
    places = () if where is None else named_places(where)
    if len(set(places)) < len(places):
        return None
    return Said((LinkedCommand(Connective(False, True, used & ~one.used), one),))


@construction("said: before=said joint=joint tests=first_tested COMMA act=capture [COMMA] AND halts", cost=0.3)
def first_captured(before: Said, joint: Connective, tests: AllTests, act: CaptureCommand, used: int) -> Said:
    """Compose ". At the first one over 39 degC, measure CO2 and stop"."""
    own = used & ~act.used & ~joint.used & ~before.used
    there = LinkedCommand(Connective(False, False, 0, bare=True), replace(act, relation="at"))
    return Said((*before.clauses, LinkedCommand(joint, UntilCondition(tests, own)), there))


@construction("said: one=command", cost=0.0)
def first_command(one: Command) -> Said:
    """Compose "take a picture"."""
    return Said((LinkedCommand(None, one),))


@construction("said: WITH one=capture", cost=0.6)
def begins_with(one: CaptureCommand, used: int) -> Said:
    """Compose "(start at sunrise) with a picture of tree 4", of which the time is read by itself."""
    return Said((LinkedCommand(None, replace(one, used=used)),))


@construction(
    "command: WHODOES one=capture",
    "command: WHODOES one=drive",
    "command: WHODOES one=home",
    "command: WHODOES one=halt",
    cost=0.3,
)
def who_does(one: CaptureCommand | DriveCommand | Home | StopCommand, used: int) -> Command:
    """Compose "it measures CO2", of the robot."""
    return replace(one, used=used)


@construction("said: before=said joint=joint one=command", cost=0.3)
def next_command(before: Said, joint: Connective, one: Command) -> Said | None:
    """Compose "take a picture and go to tree 4"."""
    if joint.purpose and isinstance(one, Lead):
        return None  # "from tree 30 to tree 37"
    if joint.precedes and isinstance(one, Lead) and _contrasts(before.clauses[-1]):
        return None  # "trees 4 and 9, but tree 9 before tree 12"
    if joint.then and isinstance(one, Lead) and one.relation == "of" and one.place.shape == "area":
        return None  # "the tree at the end of row 3"
    if joint.begins and isinstance(before.clauses[-1].command, CaptureCommand | WorkCommand):
        joint = replace(joint, first=True, of_all=True)  # "photograph row 3. First of all, read CO2 at tree 4"
    return Said((*before.clauses, LinkedCommand(joint, one)))


@construction("said: before=said [COMMA] word=OPENER one=command", cost=0.3)
def so_command(before: Said, word: Lex, one: Command, used: int) -> Said | None:
    """Compose "(is it high), so take a picture"."""
    if "consequence" not in word.features or not isinstance(before.clauses[-1].command, When):
        return None
    joint = Connective(False, False, used & ~one.used & ~before.used)
    return Said((*before.clauses, LinkedCommand(joint, one)))


def _contrasts(clause: LinkedCommand) -> bool:
    """Return True for places behind "but", or at all of some places but others."""
    place = getattr(clause.command, "place", None)
    left_out = place is not None and any(as_excluding(part) is not None for part in place.selector.walk())
    return left_out or (clause.before is not None and clause.before.contrasts)


@construction("said: one=terse", cost=0.4)
def first_terse(one: When) -> Said | None:
    """Compose "is it above 30 degC at tree 4", behind which stands what is done then."""
    return Said((LinkedCommand(None, one),)) if one.measured_at is not None else None


@construction("said: before=said joint=joint one=terse", cost=0.4)
def next_terse(before: Said, joint: Connective, one: When) -> Said | None:
    """Compose ". Above 30 degC", behind which stands what is done then."""
    return None if isinstance(before.clauses[-1].command, When) else Said((*before.clauses, LinkedCommand(joint, one)))


@construction(
    "said: before=said [COMMA] [and_or_but] one=drive_on", "said: before=said FULLSTOP one=drive_on", cost=0.3
)
def then_on_to(before: Said, one: DriveCommand) -> Said:
    """Compose "(drive to tree 4 and measure CO2), then to tree 9"."""
    return Said((*before.clauses, LinkedCommand(Connective(False, True, 0), one)))


@construction("said: before=said one=command", cost=0.8)
def without_joint(before: Said, one: Command) -> Said | None:
    """Compose "take a picture if it is high"."""
    last = before.clauses[-1].command
    match one:
        case InTurn() | Reordered() | CaptureWhere() | ReadingQuestion() | Failing() | RankCommand():
            return None
        case Again():
            follows = isinstance(last, When | Otherwise)
        case Otherwise():
            follows = any(isinstance(clause.command, When) for clause in before.clauses)
        case Lead():
            follows = isinstance(last, Otherwise | Allowed)
        case PassOn():
            follows = isinstance(last, When | Otherwise)
        case CaptureCommand():
            follows = isinstance(last, _LEADS_ON | DriveCommand)
        case StopCommand() | DriveCommand() | Home():
            follows = isinstance(last, _LEADS_ON)
        case _:
            follows = True
    return Said((*before.clauses, LinkedCommand(None, one))) if follows else None


@construction(
    "elsewhere: [ONLY] WITH place=place",
    "elsewhere: WITH [ONLY] place=place",
    "elsewhere: [ONLY] WITH place=place ONLY",
    cost=0.1,
)
def elsewhere(place: PlaceMeaning, used: int) -> Again:
    """Compose "only with its two neighbours", in another case."""
    return Again(place, used)


@construction("said: before=said [COMMA] one=elsewhere", cost=0.3)
def goes_on_elsewhere(before: Said, one: Again) -> Said | None:
    """Compose "(continue with all plants of the row,) otherwise only with its two neighbours"."""
    otherwise = isinstance(before.clauses[-1].command, Otherwise)
    return Said((*before.clauses, LinkedCommand(None, one))) if otherwise else None


@construction(
    "said: before=said [COMMA] [then] ALSO one=lead", "said: before=said [COMMA] [then] one=lead ALSO", cost=0.3
)
def also_there(before: Said, one: Lead, used: int) -> Said | None:
    """Compose "(if it is below 3 degrees,) also in the wet corner", where the same is done."""
    if not isinstance(before.clauses[-1].command, When):
        return None
    return Said((*before.clauses, LinkedCommand(None, replace(one, used=used & ~before.used))))


@construction("said: before=said [COMMA] times=often case=allow", cost=-3.0)
def more_often_if_it_fits(before: Said, times: int, case: Allowed, used: int) -> Said | None:
    """Compose "(film the pond,) twice if the battery allows": once in any case."""
    last = before.clauses[-1].command
    own = used & ~before.used & ~case.used
    if (
        times < 2
        or not isinstance(last, WorkCommand | CaptureCommand)
        or (isinstance(last, CaptureCommand) and last.times > 1)
    ):
        return None
    if isinstance(last, WorkCommand):
        again: Command | None = None if last.laps > 1 or last.rest_s else replace(last, laps=times - 1, used=own)
    else:
        again = None if last.place is None else replace(last, times=times - 1, used=own)
    fits = LinkedCommand(Connective(False, False, 0, both=True), case)
    return None if again is None else Said((*before.clauses, fits, LinkedCommand(None, again)))


@construction("said: before=said joint=joint one=lead case=allow", cost=-3.0)
@construction("said: before=said joint=joint also=ALSO one=lead [COMMA] case=allow", cost=-4.0)
def added_there_if_it_fits(
    before: Said, joint: Connective, one: Lead, case: Allowed, also: Lex | None = None
) -> Said | None:
    """Compose "(mow the slope,) and the bank too, if there is time", of which only the bank may be left out."""
    if not (case.adds or also) or joint.full or joint.purpose or joint.precedes:
        return None
    fits = LinkedCommand(replace(joint, both=True), case)
    return Said((*before.clauses, fits, LinkedCommand(None, one)))


@construction(
    "said: before=said joint=joint STOP AND way=home ASSOONAS tests=tests",
    "said: before=said joint=joint STOP AND way=home WHERE tests=tests",
    "said: before=said joint=joint STOP AND way=home IF tests=tests",
    cost=0.3,
)
def stopped_and_home(before: Said, joint: Connective, way: Home, tests: AllTests, used: int) -> Said:
    """Compose "... Stop and come home as soon as one is above 500 ppm."."""
    own = used & ~way.used & ~before.used
    ends = LinkedCommand(joint, UntilCondition(tests, own))
    return Said((*before.clauses, ends, LinkedCommand(Connective(False, False, 0, both=True), way)))


@construction("said: before=said FULLSTOP BY level=LEVEL DEFINED test=predicate [by=measured_by]", cost=0.2)
def with_level(before: Said, level: Lex, test: Test, used: int, by: str = "") -> Said | None:
    """Compose "... By hot I mean over 37 degC.", of what was said to be hot."""
    own = used & ~before.used
    clauses = tuple(replace(one, command=_at_threshold(one.command, level, test, by, own)) for one in before.clauses)
    return Said(clauses) if clauses != before.clauses else None


def _at_threshold(command: Command, level: Lex, test: Test, by: str, used: int) -> Command:
    """Return a command with a test in place of the tests of a level."""
    if not isinstance(command, When | CaptureWhere | UntilCondition):
        return command
    tests = tuple(
        replace(test, quantity=one.quantity or by, negated=test.negated != one.negated, unit=test.unit or one.unit)
        if one.check == "level" and one.value == level.value
        else one
        for one in command.tests.tests
    )
    if tests == command.tests.tests:
        return command
    return replace(command, tests=replace(command.tests, tests=tests), used=command.used | used)


@construction(
    "fallback: place=place",
    "fallback: place=place REMAINS",
    "fallback: [USE] place=place INSTEAD",
    "fallback: TAKE [IT] [relation] place=place [INSTEAD]",
    "fallback: GO [AT] place=place INSTEAD",
    cost=0.0,
)
def fallback(place: PlaceMeaning) -> PlaceMeaning:
    """Compose "use tree 5 instead" and "tree 5 will do"."""
    return place


@construction(
    "said: before=said joint=joint one=failing [COMMA] [then] place=fallback",
    "said: before=said [COMMA] OR [COMMA] one=failing [COMMA] place=fallback",
    "said: before=said [COMMA] OR place=place one=failing",
    cost=0.4,
)
def or_there(
    before: Said, one: Failing, place: PlaceMeaning, used: int, joint: Connective | None = None
) -> Said | None:
    """Compose "photograph tree 4 or, failing that, tree 5" and "... If it can't be reached, use tree 5 instead."."""
    last = before.clauses[-1].command
    if place.shape != "one" or not isinstance(last, CaptureCommand | DriveCommand):
        return None
    if last.place is None or last.place.shape != "one":
        return None
    failing = replace(one, used=used & ~before.used)
    beside = swapped(place.selector, s.Here(), last.place.selector)  # "the tree next to it", which is not reached
    there = replace(last, place=replace(place, selector=beside, beside=False), used=place.tokens)
    return Said((*before.clauses, LinkedCommand(joint, failing), LinkedCommand(None, there)))


@construction("said: first=place [COMMA] OR [COMMA] one=failing [COMMA] second=place COMMA act=capture", cost=0.4)
def either_there(first: PlaceMeaning, one: Failing, second: PlaceMeaning, act: CaptureCommand) -> Said | None:
    """Compose "tree 4 or, failing that, tree 5: a picture"."""
    if first.shape != "one" or second.shape != "one" or act.place is not None or len(act.things) > 1:
        return None
    here, there = (replace(act, place=place, used=act.used | place.tokens, relation="at") for place in (first, second))
    return Said((LinkedCommand(None, here), LinkedCommand(None, one), LinkedCommand(None, there)))


@construction(
    "said: REPEAT times=often COMMA rest=said",
    "said: times=often [OVER] COMMA rest=said",
    "said: [TAKE] times=count ROUND COMMA rest=said",
    "said: [TAKE] times=count ROUND OF COMMA rest=said",
    cost=0.3,
)
def so_often_first(times: int, rest: Said, used: int) -> Said:
    """Compose "do this three times: photograph tree 4 and measure CO2 at tree 9"."""
    again = Again(None, used & ~rest.used, times=times, in_all=True, whole=True)
    return Said((LinkedCommand(None, again), *rest.clauses))


@construction("said: one=order COMMA FULLSTOP rest=said", cost=0.2)
def order_of_list(one: InAnOrder, rest: Said) -> Said:
    """Compose "in this order:", above the lines of a list."""
    first, *others = rest.clauses
    return Said((LinkedCommand(None, one), replace(first, before=Connective(False, False, 0, bare=True)), *others))


@construction("lead: WHOLETHING", cost=0.5)
def all_of_it(used: int) -> Lead:
    """Compose "the whole thing", of an area that is named beside it."""
    return Lead(PlaceMeaning(s.Trees(), "several", each=True, there=True, tokens=used), used, relation="")


@construction("lead: place=place AGAIN", cost=0.8)
def there_again(place: PlaceMeaning, used: int) -> Lead | None:
    """Compose "(tree 4, then tree 9, then) tree 4 again"."""
    return Lead(place, used, relation="") if place.shape == "one" else None


@construction("stops_at_end: FULLSTOP [FULLSTOP]", cost=0.0)
def stops_at_end() -> str:
    """Compose "."."""
    return "."


@construction("request: [FULLSTOP] said=said [stops_at_end]", cost=0.0)
def request(said: Said) -> Said:
    """Compose "take a picture at tree 4."."""
    return said


@construction(
    "closing: mark=COMMA [AND] [then] [COMMA] CLOSING",
    "closing: mark=AND [then] [COMMA] CLOSING",
    "closing: [then] [COMMA] word=CLOSING",
    "closing: mark=FULLSTOP [AND] [then] CLOSING",
    "closing: closing CLOSING",
    "closing: closing COMMA CLOSING",
    "closing: closing FULLSTOP CLOSING",
    cost=0.2,
)
def closing(used: int, word: Lex | None = None, mark: Lex | None = None) -> StopCommand | None:
    """Compose "and that's it", which says that nothing follows; "the gate end" is a place."""
    del mark
    return None if word is not None and "ends" in word.features else StopCommand(used)


@construction(
    "closing: [COMMA] [AND] INBETWEEN [COMMA] PASSON", "closing: FULLSTOP [AND] INBETWEEN [COMMA] PASSON", cost=0.2
)
def nothing_between(used: int) -> StopCommand:
    """Compose ". In between, nothing", behind two places."""
    return StopCommand(used)


@construction("said: before=said end=closing joint=joint last=home", cost=0.3)
def closed_then_home(before: Said, end: StopCommand, joint: Connective, last: Home) -> Said:
    """Compose "..., nothing else, then back to the start"."""
    return Said((*before.clauses, LinkedCommand(replace(joint, used=joint.used | end.used), last)))


@construction("request: [FULLSTOP] said=said end=closing [stops_at_end]", cost=0.2)
def closed_request(said: Said, end: StopCommand) -> Said:
    """Compose "take a picture at tree 4, and that's it"."""
    return Said((*said.clauses, LinkedCommand(Connective(True, False, 0), end)))
