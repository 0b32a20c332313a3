"""Constructions of where the robot must not drive: "stay out of row 10", "keep 5 m from the pond", "this gate only"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.exclusions import Excluded, left_out_of
from fieldhand.planning.grammar.meaning import (
    THAT_GROUND,
    Amount,
    CaptureCommand,
    Command,
    Connective,
    DriveCommand,
    Lead,
    LinkedCommand,
    PlaceMeaning,
    Said,
    WayRule,
    WorkCommand,
)
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.planted_rows import filled_rows
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, is_drawn, is_gate, named_places, over, swapped
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("way_rule: KEEPOUT place=place [ITSELF]", "way_rule: place=place OFFLIMITS", cost=0.2)
def keep_out(place: PlaceMeaning, used: int) -> WayRule | None:
    """Compose "stay out of row 10", "avoid the pond" and "row 10 is off limits"."""
    places = kept_from(place)
    return None if places is None else WayRule(tuple((one, 0.0) for one in places), left_out=places, used=used)


@construction("way_rule: WITHOUT PASSES place=place [ITSELF]", "way_rule: word=NOT THROUGH place=place", cost=0.2)
def not_through(place: PlaceMeaning, used: int, word: Lex | None = None) -> WayRule | None:
    """Compose "do not drive through row 10" and "not through row 10"."""
    del word
    places = kept_from(place)
    return None if places is None else WayRule(tuple((one, 0.0) for one in places), used=used)


@construction("way_rule: WITHOUT PASSES IT [ITSELF]", cost=0.2)
def not_through_it(used: int) -> WayRule:
    """Compose "without driving onto it", the ground that was spoken of before."""
    return WayRule(((s.InZone(zone=THAT_GROUND), 0.0),), used=used)


@construction("around: DRIVEAROUND place=place", cost=0.2)
def around(place: PlaceMeaning, used: int) -> WayRule | None:
    """Compose "drive around the south block", beside something else that is avoided."""
    return keep_out(place, used)


@construction(
    "way_rule: KEEPOFF [check=CMP] far=amount FROM place=place",
    "way_rule: KEEPOFF [check=CMP] far=amount RADIUS FROM place=place",
    "way_rule: KEEPOFF [DET] RADIUS OF [check=CMP] far=amount FROM place=place",
    "way_rule: KEEPOFF [check=CMP] far=amount CLEAROF place=place",
    "way_rule: KEEPOFF [FAR] FROM place=place [COMMA] check=CMP far=amount",
    "way_rule: KEEPOUT place=place [COMMA] check=CMP far=amount",
    "way_rule: [KEEPOFF] NOCLOSER far=amount FROM place=place",
    "way_rule: [KEEPOFF] NOCLOSER far=amount AT place=place",
    "way_rule: GIVES place=place BERTH [check=CMP] far=amount",
    "way_rule: GIVES BERTH [check=CMP] far=amount AT place=place",
    "way_rule: COMES NOCLOSER far=amount FROM place=place",
    "way_rule: COMES NOCLOSER far=amount AT place=place",
    "way_rule: WITHOUT COMES INSIDE far=amount OF place=place",
    "way_rule: NONEWITHIN far=amount OF place=place",
    "way_rule: NONEWITHIN far=amount FROM place=place",
    "way_rule: NONEWITHIN far=amount AT place=place",
    "way_rule: [described=which_is] ATLEAST far=amount FROM place=place",
    "way_rule: [described=which_is] ATLEAST far=amount CLEAROF place=place",
    "way_rule: WITHOUT COMES closer=CLOSER far=amount AT place=place",
    "way_rule: WITHOUT COMES closer=CLOSER far=amount FROM place=place",
    cost=0.2,
)
def keep_distance(
    far: Amount,
    place: PlaceMeaning,
    used: int,
    check: Lex | None = None,
    closer: Lex | None = None,
    described: str = "",
) -> WayRule | None:
    """Compose "keep 5 m from the pond" and "do not come within 5 m of the pond"."""
    if far.unit != "metres" or (check is not None and check.value[0] not in ("gt", "ge")):
        return None
    if closer is not None and closer.value is not None and closer.value[0] not in ("lt", "le"):
        return None
    places = kept_from(place, far.number)
    kept = tuple((one, far.number) for one in places or ())
    return WayRule(kept, used=used, described=bool(described)) if kept else None


@construction("of_grass: OF GRASSWORD", cost=0.0)
def of_grass() -> str:
    """Compose "of grass" behind a width."""
    return "grass"


@construction(
    "left_around: far=amount [of_grass] [UNCUT]",
    "left_around: far=amount STRIP [of_grass] [UNCUT]",
    "left_around: DET [far=amount] STRIP [of_grass] [UNCUT]",
    "left_around: [DET] STRIP OF far=amount [of_grass] [UNCUT]",
    "left_around: DET far=amount RADIUS [of_grass] [UNCUT]",
    "left_around: BERTH far=amount [of_grass] [UNCUT]",
    cost=0.1,
)
def left_around(far: Amount | None = None) -> Amount | None:
    """Compose "four metres of grass standing" before "around the trough"."""
    return far if far is not None and far.unit == "metres" and far.number > 0 else None


@construction(
    "left_round: LEAVE far=left_around AROUND place=place",
    "left_round: LEAVE far=left_around AROUND place=place word=UNCUT",
    "left_round: LEAVE AROUND place=place far=left_around",
    cost=0.2,
)
def left_round(far: Amount, place: PlaceMeaning, used: int, word: Lex | None = None) -> WayRule | None:
    """Compose "leave four metres of grass standing around the trough", which mowing then keeps away from."""
    del word
    places = kept_from(place, far.number)
    return None if places is None else WayRule(tuple((one, far.number) for one in places), used=used)


@construction(
    "left_round: rule=left_round AND [AROUND] place=place",
    "left_round: rule=left_round COMMA [AROUND] place=place",
    cost=0.1,
)
def left_round_also(rule: WayRule, place: PlaceMeaning, used: int) -> WayRule | None:
    """Compose "leave four metres around the trough and around the weather mast"."""
    return also_from(rule, place, used)


@construction("said: before=said [joint=joint] rule=left_round", cost=0.2, given=("site", "robot"))
def grass_left_behind(
    before: Said, rule: WayRule, site: Site, robot: RobotProfile, joint: Connective | None = None
) -> Said | None:
    """Compose "mow the paddock, but leave four metres standing around the trough"."""
    return rule_behind(before, rule, site, joint) if _only_mows(before, robot) else None


@construction("said: rule=left_round joint=joint rest=said", cost=0.2, given=("site", "robot"))
def grass_left_before(rule: WayRule, joint: Connective, rest: Said, site: Site, robot: RobotProfile) -> Said | None:
    """Compose "leave four metres standing around the trough and mow the rest of the paddock"."""
    return rule_before(rule, joint, rest, site) if _only_mows(rest, robot) else None


def _only_mows(said: Said, robot: RobotProfile) -> bool:
    """Return True if all the work of some commands covers ground; from no other work is a strip left."""
    work = [one.command for one in said.clauses if isinstance(one.command, WorkCommand) and one.command.action]
    implements = [robot.action[one.action].implement for one in work]
    others = any(isinstance(one.command, CaptureCommand) for one in said.clauses)
    return bool(work) and not others and all(one is not None and one.covers for one in implements)


@construction("gates: [DET] gate=GATENAME", cost=0.0)
def one_gate(gate: Lex) -> tuple[str, ...]:
    """Compose "the east gate"."""
    return (gate.value,)


@construction("gates: first=gates AND second=gates", "gates: first=gates OR second=gates", cost=0.1)
def several_gates(first: tuple[str, ...], second: tuple[str, ...]) -> tuple[str, ...]:
    """Compose "the east gate and the west gate"."""
    return (*first, *second)


@construction("other_gate: [DET] gate=GATENAME", "other_gate: DET word=MIDDLE ONE", cost=0.0, given=("site",))
@construction(
    "other_gate: DET word=DIR ONE", "other_gate: DET word=MIDDLE", "other_gate: DET word=DIR", cost=0.1, given=("site",)
)
def other_gate(site: Site, gate: Lex | None = None, word: Lex | None = None) -> str | None:
    """Compose "the middle one", of a gate that is called so."""
    if gate is not None:
        return str(gate.value)
    first = "" if word is None else word.text.split()[0]
    named = [one.place.id for one in site.gates if first and one.place.id.casefold().split()[0] == first]
    return named[0] if len(named) == 1 else None


@construction("gates: gates=gates [COMMA] [AND] NOT other=other_gate", cost=0.0)
def rather_than(gates: tuple[str, ...], other: str) -> tuple[str, ...] | None:
    """Compose "the north door, not the middle one"."""
    return None if other in gates else gates


@construction(
    "way_rule: ONLYVIA gates=gates", "way_rule: VIAGATE gates=gates ONLY", "way_rule: word=ENTERBY gates=gates [ONLY]",
    cost=0.0,
)  # fmt: skip
def only_gates(gates: tuple[str, ...], used: int, word: Lex | None = None) -> WayRule:
    """Compose "use the east gate only" and "only through the east gate"."""
    return WayRule(gates=gates, used=used, leaves=word is not None and "leaves" in word.features)


@construction(
    "way_rule: first=way_rule AND second=way_rule",
    "way_rule: first=way_rule COMMA [AND] second=way_rule",
    "way_rule: first=way_rule AND second=around",
    "way_rule: first=way_rule COMMA [AND] second=around",
    cost=0.2,
)
def both_rules(first: WayRule, second: WayRule, used: int) -> WayRule:
    """Compose "avoid the pond and drive around the south block"."""
    avoid, gates = (*first.avoid, *second.avoid), (*first.gates, *second.gates)
    slow = (*first.slow, *second.slow)
    return WayRule(avoid, gates, left_out=(*first.left_out, *second.left_out), used=used, slow=slow)


@construction(
    "way_rule: rule=way_rule AND [FROM] place=place",
    "way_rule: rule=way_rule AND PASSES place=place",
    "way_rule: rule=way_rule OR [PASSES] place=place",
    cost=0.3,
)
def also_from(rule: WayRule, place: PlaceMeaning, used: int) -> WayRule | None:
    """Compose "keep 5 m from the pond and the charger" and "do not drive through row 3 or row 5"."""
    if not rule.avoid:
        return None
    metres = rule.avoid[-1][1]
    places = kept_from(place, metres)
    if places is None or any(one in [known for known, _ in rule.avoid] for one in places):
        return None
    avoid = (*rule.avoid, *((one, metres) for one in places))
    return replace(rule, avoid=avoid, left_out=(*rule.left_out, *(places if rule.left_out else ())), used=used)


@construction(
    "way_rule: rule=way_rule [COMMA] AND [check=CMP] far=amount FROM place=place",
    "way_rule: rule=way_rule [COMMA] AND [check=CMP] far=amount CLEAROF place=place",
    cost=0.2,
)
def also_so_far(rule: WayRule, far: Amount, place: PlaceMeaning, used: int, check: Lex | None = None) -> WayRule | None:
    """Compose "keep 3 m away from the pond and 2 m away from the charger"."""
    more = keep_distance(far, place, used, check) if rule.avoid else None
    return None if more is None else both_rules(rule, more, used)


@construction("way_rule: WHILE rule=way_rule", "way_rule: BUT rule=way_rule", "way_rule: BUT rule=around", cost=0.2)
def on_the_way(rule: WayRule, used: int) -> WayRule:
    """Compose "while avoiding the pond" and "but drive around the south block"."""
    return replace(rule, used=used)


@construction("way_rule: rule=way_rule [COMMA] WHOLETIME", "way_rule: WHOLETIME [COMMA] rule=way_rule", cost=0.1)
def all_the_time(rule: WayRule, used: int) -> WayRule:
    """Compose "keep 5 m from the pond the whole time", as every rule does."""
    return replace(rule, used=used)


@construction("excluded: KEEPOUT out=kept_out", cost=0.2)
def trees_avoided(out: Excluded, used: int) -> Excluded | None:
    """Compose "avoid the yellow trees", which are left out; an area is not driven through as well."""
    if out.place is None or kept_from(out.place) is not None:
        return None
    return replace(out, used=used)


@construction("said: before=said [joint=joint] rule=way_rule", cost=0.2, given=("site",))
def rule_behind(before: Said, rule: WayRule, site: Site, joint: Connective | None = None) -> Said | None:
    """Compose "photograph row 3. Stay out of row 5."."""
    if joint is None and rule.slow:
        return None  # "photograph every tree at 0.5 m/s in row 3"
    if rule.leaves and joint is not None and joint.then:
        return None  # "then leave through the south door": at that moment
    return Said((*_keeping(before, rule, site), LinkedCommand(joint, rule)))


@construction("out_again: OUTSAME SAMEDOOR", cost=0.1)
def out_again(used: int) -> int:
    """Compose "out the same door again", behind the gate by which it came in."""
    return used


@construction("said: before=said joint=joint out=out_again", "said: before=said out=out_again", cost=0.1)
def out_the_same_way(before: Said, out: int, joint: Connective | None = None) -> Said | None:
    """Compose "in through the south door, ... and out the same way": the only gate that it may pass."""
    rules = [one.command for one in before.clauses if isinstance(one.command, WayRule) and one.command.gates]
    if len(rules) != 1 or len(rules[0].gates) != 1:
        return None
    known = replace(rules[0], used=rules[0].used | out | (0 if joint is None else joint.used))
    return Said(tuple(replace(one, command=known) if one.command == rules[0] else one for one in before.clauses))


@construction("said: rule=way_rule joint=joint rest=said", cost=0.2, given=("site",))
def rule_before(rule: WayRule, joint: Connective, rest: Said, site: Site) -> Said | None:
    """Compose "stay out of row 5. Photograph row 3."."""
    first, *others = _keeping(rest, rule, site)
    if joint.first or first.before is not None:
        return None
    return Said((LinkedCommand(None, rule), replace(first, before=joint), *others))


def kept_from(place: PlaceMeaning, metres: float = 0.0) -> tuple[s.Selector, ...] | None:
    """Return the places of a phrase from which the robot can keep away; None for others."""
    if place.per is not None or place.optional or place.at_most is not None or place.count is not None:
        return None
    if place.shape not in ("one", "area", "several") or place.selector.relative or place.selector == s.Trees():
        return None
    members = place.selector.members
    if not metres and place.shape != "area" and not all(_has_no_trees(one) for one in members):
        return None  # "avoid the yellow trees": they are left out
    return members


def _has_no_trees(place: s.Selector) -> bool:
    """Return True for a gate or a marker."""
    return is_gate(place) or bool(place.named_marker)


def _keeping(said: Said, rule: WayRule, site: Site) -> tuple[LinkedCommand, ...]:
    """Return commands without the trees at which the robot could not work, where the request leaves a choice."""
    clauses = said.clauses
    for places, metres in rule.avoid:
        if metres or places == s.InZone(zone=THAT_GROUND) or ids_of(places, site) is None:
            continue
        clauses = tuple(
            replace(clause, command=_kept(clause.command, places, site, leaves_out=places in rule.left_out))
            for clause in clauses
        )
    return clauses


def _kept(command: Command, places: s.Selector, site: Site, *, leaves_out: bool) -> Command:
    """Return a command at trees outside of places, if it may choose among others or the places are left out."""
    if not isinstance(command, CaptureCommand | DriveCommand | Lead) or command.place is None:
        return command
    whole = command.place
    chosen = getattr(whole.selector, "of", None)
    if (
        whole.count is not None
        and chosen is not None
        and (whole.selector.any_of is not None or is_drawn(whole.selector))
    ):
        others = s.Excluding(places=places, of=chosen)  # "five vines" of those that are left
        return replace(command, place=replace(whole, selector=swapped(whole.selector, chosen, others)))
    if not leaves_out or isinstance(command, DriveCommand) or whole.count is not None or named_places(whole.selector):
        return command  # "trees 4 and 9": a check tells which of them cannot be reached
    rest = left_out_of(command, Excluded(PlaceMeaning(places, "area")), site)
    return command if rest is None else rest


# Rows of ground into which the robot drives, by a gate.


@construction(
    "into: INTO where=region", "into: AT where=region", "into: INTO where=region [COMMA] ENTERBY gates", cost=0.1
)
def into_ground(where: s.Selector) -> s.Selector | None:
    """Compose "get into the cool section" before what is done there."""
    return None if are_rows(where) else where


@construction(
    "rows_there: EACH [OF] [DET] noun=ROW [THERE]", "rows_there: EACH [OF] [DET] n=count noun=ROW [THERE]",
    "rows_there: EACH [OF] ITS noun=ROW", "rows_there: EACH [OF] ITS n=count noun=ROW", "rows_there: ITS noun=ROW",
    "rows_there: ITS n=count noun=ROW", "rows_there: DET n=count noun=ROW THERE", "rows_there: DET noun=ROW THERE",
    cost=0.0,
)  # fmt: skip
def rows_there(noun: Lex, n: int = 0) -> int:
    """Compose "all four rows there": their number, 0 if it is not said."""
    return n if noun.plural or not n else -1


@construction(
    "work: where=into [COMMA] AND verb=WORKV n=rows_there", "work: where=into COMMA verb=WORKV n=rows_there", cost=0.2,
    given=("site", "robot"),
)  # fmt: skip
def worked_there(
    where: s.Selector, verb: Lex, n: int, used: int, site: Site, robot: RobotProfile
) -> WorkCommand | None:
    """Compose "get into the cool section and film all four rows there"."""
    rows, implement = filled_rows(where, site), robot.action[verb.value].implement
    if not rows or n not in (0, len(rows)) or implement is None or implement.covers:
        return None
    return WorkCommand(action=verb.value, along=over(s.Rows(), where), mode="rows", used=used)


@construction(
    "entered_by: VIAGATE gates=gates INORDERTO", "entered_by: VIAGATE gates=gates INORDERTO INTO AND", cost=0.1
)
@construction("entered_by: VIAGATE gates=gates", cost=0.3)
def entered_by(gates: tuple[str, ...], used: int) -> WayRule:
    """Compose "use the north door to", before work on the ground behind it."""
    return WayRule(gates=gates, used=used)


@construction("said: rule=entered_by one=work", cost=0.1)
def worked_behind_gate(rule: WayRule, one: WorkCommand) -> Said | None:
    """Compose "use the north door to get into the cool section and film all four rows there"."""
    return Said((LinkedCommand(None, rule), LinkedCommand(None, one))) if one.along is not None and one.action else None


@construction("leaving: word=ENTERBY gate=place", cost=0.1)
def leaving(word: Lex, gate: PlaceMeaning, used: int) -> DriveCommand | None:
    """Compose "leave through the south door" as a drive."""
    through = "leaves" in word.features and gate.shape == "one" and is_gate(gate.selector)
    return DriveCommand(gate, used) if through else None


@construction("said: before=said joint=joint out=leaving", cost=0.1)
def left_by_gate(before: Said, joint: Connective, out: DriveCommand) -> Said | None:
    """Compose ", then leave through the south door" as a step behind others."""
    return Said((*before.clauses, LinkedCommand(joint, out))) if joint.then else None


@construction("through_to: VIAGATE gate=place AT to=place", "through_to: GO THROUGH gate=place AT to=place", cost=0.2)
def through_gate_to(gate: PlaceMeaning, to: PlaceMeaning, used: int) -> tuple[LinkedCommand, ...] | None:
    """Compose "go through the middle gate to the pond"."""
    if gate.shape != "one" or not is_gate(gate.selector) or to.shape not in ("one", "area") or to.per is not None:
        return None
    there = DriveCommand(to, to.tokens)
    through = DriveCommand(gate, used & ~to.tokens)
    return LinkedCommand(None, through), LinkedCommand(Connective(False, True, 0), there)


@construction("said: pair=through_to", "said: before=said joint=joint pair=through_to", cost=0.1)
def said_through_gate(
    pair: tuple[LinkedCommand, ...], before: Said | None = None, joint: Connective | None = None
) -> Said:
    """Compose "go through the middle gate to the pond" as a step, behind others too."""
    through, there = pair
    return Said((*(() if before is None else before.clauses), replace(through, before=joint), there))
