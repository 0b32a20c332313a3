"""Constructions of what is understood and cannot be planned: each says why, and what to say instead.

They are looked at only if a request has no reading, and are part of no other construction.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fieldhand.language import Number, message
from fieldhand.language.words import listed, say_name
from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.going_round import Hand, mounted_side
from fieldhand.planning.grammar.commands.parameters import in_unit_of, with_parameter
from fieldhand.planning.grammar.commands.waits import LONGEST_WAIT_S
from fieldhand.planning.grammar.earlier.work import EarlierWork
from fieldhand.planning.grammar.meaning import Amount, CaptureCommand, Nominal, ParameterValue, PlaceMeaning, Thing
from fieldhand.planning.grammar.places.lines import SamplingLine
from fieldhand.planning.grammar.places.sampling import is_keep_out
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import (
    as_zone,
    measures_distance,
)
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

GRAMMAR = Grammar()

#: Words in the names of the attributes of which a description tells too little.
_TOLD = ("", "=", "vigor", "age", "height", "yield")
#: Category of these phrases.
IMPOSSIBLE = "impossible"


@dataclass(frozen=True, slots=True)
class Impossible:
    """A phrase that cannot be planned.

    Attributes:
        what: Why not, as part of a sentence about the phrase.
        advice: What to say instead.
    """

    what: str
    advice: str


def construction(
    *patterns: str, given: tuple[str, ...] = ()
) -> Callable[[Callable[..., Impossible | None]], Callable[..., Impossible | None]]:
    """Register a function that says why the phrases of some patterns cannot be planned."""
    return GRAMMAR.construction(*(f"{IMPOSSIBLE}: {pattern}" for pattern in patterns), given=given)


@construction("number=NUM inner=nominal")
def no_such_number(number: Lex, inner: Nominal) -> Impossible | None:
    """Compose "0 trees" and "12 corners"."""
    if inner.complete and number.value > inner.complete:
        what = message(
            "there are {count} such corners, not {number}", count=inner.complete, number=Number(f"{number.value:g}")
        )
        return Impossible(what, message("say how many"))
    if number.value >= 1 and number.value == int(number.value):
        return None
    return Impossible(message("it is not clear how many"), message("say how many as a whole number above 0"))


@construction(
    "n=count READING INSUCCESSION [IS] predicate", "n=count CONSECUTIVE READING [IS] predicate",
    "n=count noun=NOUN INSUCCESSION [IS] predicate", "n=count CONSECUTIVE noun=NOUN [IS] predicate",
    "n=count TREE INSUCCESSION [IS] predicate", "n=count CONSECUTIVE TREE [IS] predicate",
    "n=count INSUCCESSION [IS] predicate", "n=count READING [IS] predicate INSUCCESSION",
)  # fmt: skip
def readings_in_succession(n: int, noun: Lex | None = None) -> Impossible | None:
    """Compose "two readings in a row are below 25 percent"."""
    del noun
    if n < 2:
        return None
    return Impossible(
        message("readings that follow each other are not counted by themselves"),
        message("say 'stop when {count} readings are below ...', or 'stop at the first reading below ...'", count=n),
    )


@construction("PARALLEL region", "PARALLEL place")
def askew() -> Impossible:
    """Compose "parallel to the hedge", which runs neither from north to south nor from east to west."""
    return Impossible(
        message("lanes run from north to south or from east to west"), message("say 'in lanes from north to south'")
    )


@construction(
    "WORKV [ALONG] fence=region [COMMA] ordered",
    "WORKV [ALONG] fence=region FROM place",
    "WORKV [ALONG] fence=region up_to [DET] DIR FINISH",
    "WORKV [ALONG] fence=region up_to ITS DIR FINISH",
    given=("site",),
)
def part_of_fence(fence: s.Selector, site: Site) -> Impossible | None:
    """Compose "film the fence from south to north"."""
    if not is_keep_out(fence, site):
        return None
    return Impossible(
        message("an edge is worked all the way round, or along one side of it"),
        message("say the side: 'film the west side of the fence from south to north'"),
    )


@construction("apart_least", given=("site",))
def points_apart(site: Site) -> Impossible | None:
    """Compose "at least 8 m apart" where no trees grow, of points that are drawn."""
    if site.trees:
        return None
    return Impossible(
        message("points keep no least distance from each other"), message("say 'spread evenly', or 'on a 10 m grid'")
    )


@construction("VAGUESPACING")
def unsaid_spacing() -> Impossible:
    """Compose "every few metres"."""
    return Impossible(
        message("it does not say how far apart"), message("say the distance, 'every 10 m', or how many: 'at 8 places'")
    )


@construction("word=EACH noun=GATES", "word=EACH [OF] DET noun=GATES")
def both_of_several_gates(word: Lex, noun: Lex) -> Impossible | None:
    """Compose "both gates" of three."""
    if "two" not in word.features or len(noun.value) == 2:
        return None
    return Impossible(
        message("there are not two of them, but {count}: {gates}", count=len(noun.value), gates=listed(noun.value)),
        message("name those that are meant"),
    )


@construction("BETWEEN low=NUM AND high=NUM", "BETWEEN low=NUM AND high=amount", "BETWEEN low=amount AND high=amount")
def nothing_between(low: Lex | Amount, high: Lex | Amount) -> Impossible | None:
    """Compose "between 40 and 30"."""
    first, last = (one.number if isinstance(one, Amount) else one.value for one in (low, high))
    if first < last:
        return None
    what = message("no value lies between {low} and {high}", low=Number(f"{first:g}"), high=Number(f"{last:g}"))
    return Impossible(what, message("put the lower number first"))


@construction("FROM TREEID range_to TREEID", "BETWEEN TREEID AND TREEID")
def part_of_a_row() -> Impossible:
    """Compose "from G4-03 to H2-13" behind work along a row."""
    return Impossible(
        message("these two trees do not stand in one row"), message("name two trees of one row, or the rows")
    )


@construction("[DET] DIR HALF in_ rows", "[DET] DIR EDGE in_ rows", "[DET] DIR QUARTER in_ rows")
def half_of_rows() -> Impossible:
    """Compose "the northern half of row 3"."""
    return Impossible(
        message("a row has no halves or edges"), message("say 'the first 10 trees of row 3', or 'from the north'")
    )


@construction("[DET] side=DIR HALF in_ [DET] edge=DIR EDGE")
def half_of_edge(side: Lex, edge: Lex) -> Impossible | None:
    """Compose "the northern half of the southern edge"."""
    across = {"north", "south"} if side.value in ("north", "south") else {"east", "west"}
    if edge.value not in across:
        return None
    return Impossible(
        message("that edge has no part on that side"), message("say a side along the edge, or the whole edge")
    )


@construction("EACH ORD CORNER", "EACH OTHER CORNER")
def every_nth_corner() -> Impossible:
    """Compose "every other corner"."""
    return Impossible(
        message("the corners have no order"), message("name them: 'the north-west and the south-east corner'")
    )


@construction("DET rank=ORD [inner=nominal]")
def counted_somehow(rank: Lex, inner: Nominal | None = None) -> Impossible | None:
    """Compose "the third tree" of the site, whose trees have no order."""
    if rank.value == 1 or (inner is not None and (inner.selector != s.Trees() or inner.kind != "tree")):
        return None
    what = message("'{said}' could be counted in several ways", said=rank.text)
    return Impossible(what, message("say of which row and from which end: 'the third tree of row 4 from the north'"))


@construction("NUM POINT in_ where=region", "NUM POINT AT where=region")
def points_outside_zones(where: s.Selector) -> Impossible | None:
    """Compose "3 points in row 4"."""
    if any(as_zone(part) is not None for part in where.walk()):
        return None
    return Impossible(
        message("which trees does it refer to?"), message("say 'trees', or name a zone: '4 points in the wet corner'")
    )


@construction("NUM RANDOM POINT")
def points_at_random() -> Impossible:
    """Compose "3 random points" of no zone."""
    return Impossible(
        message("random points are drawn in a zone"),
        message("name the zone: '3 random points in the wet corner', or say '3 random trees'"),
    )


@construction("ROW NEAREST [AT] place", "ROW FARTHEST FROM place", "ROW BESIDE place", "ROW NEXTTO place")
def row_near_a_place() -> Impossible:
    """Compose "the row nearest to the charger"."""
    return Impossible(message("what is near, the tree or the row?"), message("name the row"))


@construction("amount DIR OF place", "amount DIR FROM place")
def distance_in_a_direction() -> Impossible:
    """Compose "10 m north of tree 5"."""
    return Impossible(
        message("a distance in a direction is no place where a tree stands"),
        message("say 'the nearest tree to the north of tree 5', or count trees: '3 trees north of tree 5'"),
    )


@construction("UPTO NUM things", "CMP NUM things")
def up_to_so_many_captures() -> Impossible:
    """Compose "up to 8 pictures"."""
    return Impossible(message("captures need one number"), message("say 'of up to 6 trees'"))


@construction("trigger")
def reacting_otherwise() -> Impossible:
    """Compose "if it rains", which decides about no step."""
    return Impossible(
        message("what the robot detects all the time decides about no single step"),
        message("say what it does then: 'if it rains, come home', or wait, skip that tree, or end the mission"),
    )


@construction("UNTILOVER FOR least=amount", "UNTILOVER ATLEAST least=amount", "UNTILOVER FOR ATLEAST least=amount")
def over_for_so_long(least: Amount) -> Impossible | None:
    """Compose "until they have been gone for a minute"."""
    if least.unit != "seconds":
        return None
    return Impossible(
        message("how long it must be over before the robot goes on is set in its profile (clear_s)"),
        message("say 'until it is over', or 'at most 5 minutes' for the longest wait"),
    )


@construction("hottest read_noun when=PERIOD", "read_noun with_most when=PERIOD")
def hottest_without_a_number(when: Lex) -> Impossible | None:
    """Compose "the hottest trees of last week"."""
    if when.value.unsaid:
        return None
    return Impossible(message("it does not say how many"), message("say how many: 'the 10 hottest trees of last week'"))


@construction("nominal work=WORKSAID", "DET work=WORKSAID")
def done_without_a_period(work: Lex) -> Impossible | None:
    """Compose "the trees that we visited"."""
    said: EarlierWork = work.value
    if said.needs_period or said.selectors(None):
        return None
    return Impossible(
        message("it does not say when that was"),
        message("give a period: 'visited yesterday', 'already visited', 'not visited in the last 3 days'"),
    )


@construction("work=WORKSAID PERIOD", "work=WORKWHERE PERIOD")
def done_by_something_else(work: Lex) -> Impossible:
    """Compose "we did yesterday", which describes no trees where it stands."""
    del work
    return Impossible(
        message("what was done before describes trees, and none here"),
        message("say it of trees: 'the trees of row 3 not visited yesterday', or 'skip the ones done yesterday'"),
    )


@construction(
    "trigger [COMMA] HOLD AT place [UNTILOVER]", "trigger [COMMA] HOLD AT region [UNTILOVER]",
    "trigger [COMMA] HOLD at_edge [UNTILOVER]", "trigger [COMMA] HOLD zone_beside [UNTILOVER]",
    "trigger [COMMA] HOLD BESIDE place [UNTILOVER]", "trigger [COMMA] HOLD BESIDE region [UNTILOVER]",
    "trigger [COMMA] HOLD NEAR place [UNTILOVER]", "trigger [COMMA] HOLD NEAR region [UNTILOVER]",
    "trigger [COMMA] drive [COMMA] AND HOLD [UNTILOVER]",
)  # fmt: skip
def waits_elsewhere() -> Impossible:
    """Compose "if it rains, wait beside the barn until it stops"."""
    return Impossible(
        message("when this happens, the robot can wait where it is or come home for good, but not wait elsewhere"),
        message("say only 'wait', or 'come home'"),
    )


@construction("AISLE")
def in_an_aisle() -> Impossible:
    """Compose "the aisle"."""
    return Impossible(
        message("an aisle is not a place where something can be done"),
        message("say along which row, at which trees, or 'in the middle of the aisle between rows 3 and 4'"),
    )


@construction("WORKV where=place")
def work_at_places(where: PlaceMeaning) -> Impossible | None:
    """Compose "spray tree 4"."""
    if where.shape == "area":
        return None
    return Impossible(
        message("this is done while driving along a path, not at single trees"),
        message("say along which rows, between which rows, or over which area"),
    )


@construction("first=place NEAR place", "first=place NEAREST [AT] place")
def single_and_near(first: PlaceMeaning) -> Impossible | None:
    """Compose "the northernmost tree near the charger"."""
    if first.shape != "one" or measures_distance(first.selector):
        return None
    return Impossible(message("it is not clear what is near to what"), message("say it in two steps"))


@construction("WITHOUT COMES NEAR place", "WITHOUT COMES NEAREST [AT] place", "WITHOUT PASSESBY place")
def keep_away_somehow() -> Impossible:
    """Compose "do not drive near the pond"."""
    return Impossible(
        message("it is not said how far to keep from it"),
        message("give a distance, 'keep 5 m from the pond', or say 'stay out of the wet corner'"),
    )


@construction(
    "[DET] word=VAGUEADJ TREE",
    "[DET] OLD TREE",
    "TREE OF VAGUEADJ ATTR",
    "TREE WITH VAGUEADJ ATTR",
    "VAGUEADJ [DASH] ATTR TREE",
)
def without_a_value(word: Lex | None = None) -> Impossible | None:
    """Compose "the old trees" and "vines of low vigor"; dry ones may be what the robot is to find out."""
    if word is not None and word.value[0] not in _TOLD:
        return None
    return Impossible(
        message("it does not say from which value on"),
        message("say 'older than 8 years', or 'the ten oldest trees'"),
    )


@construction("GRID")
def on_a_grid() -> Impossible:
    """Compose "on a grid", which does not say how wide it is."""
    return Impossible(
        message("it does not say how wide the grid is"),
        message("say 'on a 20 m grid'; its cells are squares"),
    )


@construction("path_over")
def along_a_path() -> Impossible:
    """Compose "in a W", which does not say at how many places."""
    return Impossible(
        message("it does not say at how many places along the path"),
        message("say '20 trees in a W through the north block', or 'every 10 m along a zigzag'"),
    )


@construction("ROW OF inner=nominal")
def rows_of_a_kind(inner: Nominal) -> Impossible | None:
    """Compose "rows of Carmel trees"."""
    if inner.selector == s.Trees():
        return None
    return Impossible(message("a row is not chosen by its trees"), message("name the rows, or say 'every Carmel tree'"))


@construction("[DET] DIR ROW")
def rows_on_a_side() -> Impossible:
    """Compose "the northern rows"."""
    return Impossible(
        message("it is not clear which rows"),
        message("name them, or count them from a side: 'the first three rows from the west'"),
    )


@construction("NUM ROWSOVER", "NUM ROW DIR", "NUM ROW NEAR")
def rows_over() -> Impossible:
    """Compose "two rows over from tree 80"."""
    return Impossible(
        message("it is not clear which tree of that row"), message("go to the tree first, then say 'go 2 rows east'")
    )


@construction("noun=ROW ends=FINISH")
def ends_of_rows(noun: Lex, ends: Lex) -> Impossible | None:
    """Compose "the row ends"."""
    if noun.plural or not ends.plural:
        return None
    return Impossible(message("of which rows?"), message("say 'both ends of row 3', or 'both ends of every row'"))


@construction("rate=work_rate", given=("robot",))
def rate_out_of_bounds(rate: Amount, robot: RobotProfile) -> Impossible | None:
    """Compose "with 1200 litres per hectare", more than the sprayer gives."""
    return parameter_out_of_bounds(ParameterValue(rate.number, rate.unit, ()), robot)


@construction("how=parameter", given=("robot",))
def parameter_out_of_bounds(how: ParameterValue, robot: RobotProfile) -> Impossible | None:
    """Compose "at 90 cm", deeper than the probe can go."""
    known = [one for action in robot.actions for one in action.parameters]
    numbers = [(one, number) for one in known if (number := in_unit_of(one, how)) is not None]
    if not numbers or any(with_parameter(Thing(action.name), how, robot) for action in robot.actions):
        return None
    one, number = numbers[0]
    what = message(
        "{number} {unit} is not between {low} and {high} {unit}",
        number=Number(f"{number:g}"),
        unit=one.unit,
        low=Number(f"{one.minimum or 0.0:g}"),
        high=Number(f"{one.maximum or 0.0:g}"),
    )
    return Impossible(what, message("the robot's profile gives the bounds of the {name}", name=one.name))


@construction("act=capture [COMMA] how=parameter", given=("robot",))
def without_parameter(act: CaptureCommand, how: ParameterValue, robot: RobotProfile) -> Impossible | None:
    """Compose "take a picture at a depth of 20 cm", of an action that has no depth."""
    actions = [robot.action[one.action] for one in act.things if one.action in robot.action]
    if not actions or any(with_parameter(Thing(one.name), how, robot) for one in actions):
        return None
    if any(in_unit_of(parameter, how) is not None for one in actions for parameter in one.parameters):
        return None  # out of bounds
    (first, *_) = actions
    own = [say_name(one.name) for one in first.parameters]
    name = say_name(first.name)
    if own:
        what = message("'{action}' has no such parameter; it has: {parameters}", action=name, parameters=listed(own))
    else:
        what = message("'{action}' has no parameters", action=name)
    return Impossible(what, message("leave it out, or say it of an action that has it"))


@construction("WAITV [FOR] time=amount", "STAYV [FOR] time=amount")
def too_long(time: Amount) -> Impossible | None:
    """Compose "wait for 30 hours"."""
    if time.unit != "seconds" or 0.0 < time.number <= LONGEST_WAIT_S:
        return None
    return Impossible(message("a wait lasts at most 24 hours"), message("say a shorter time, or plan two missions"))


@construction(
    "WORKV [DET] [AISLEPATH] line=line",
    "WORKV [DET] [AISLEPATH] AT [DET] STRAIGHTLINE line=line",
    "WORKV [DET] STRIP line=line",
)
@construction("WORKV [DET] [AISLEPATH] path=path_over", "WORKV [DET] STRIP path=path_over")
def work_along_a_line(path: tuple[object, object] | None = None, line: SamplingLine | None = None) -> Impossible | None:
    """Compose "mow a path from the barn door to the gate"."""
    along = line if path is None else path[0]
    if not isinstance(along, SamplingLine) or along.start.named_tree:
        return None  # from tree to tree it is a part of a row
    return Impossible(
        message("work along a straight line between two places cannot be said yet"),
        message("name an area, rows, or the edge along which it works; 'drive to the gate' is possible"),
    )


@construction("way=CLOCKWISE")
def direction_around(way: Lex) -> Impossible:
    """Compose "anticlockwise" behind points along an edge, or behind what is no round."""
    if "against" in way.features:
        return Impossible(
            message("points along an edge are visited clockwise, and only drives around an area the other way"),
            message("leave it out, or say only the drive: 'drive anticlockwise around the pond'"),
        )
    return Impossible(
        message("only a drive around an area and points along its edge have this direction"),
        message("leave it out, or name the area: 'drive clockwise around the pond'"),
    )


@construction("kept=hand_kept", given=("robot",))
def on_the_other_hand(kept: tuple[Hand, s.Selector | None], robot: RobotProfile) -> Impossible | None:
    """Compose "on your left" of a robot whose implement works to the right."""
    sides = {mounted_side(action.name, robot) for action in robot.actions} - {None, kept[0]}
    if len(sides) != 1:
        return None
    if sides == {"left"}:
        return Impossible(message("the implement works to the left"), message("say 'on your left', or leave it out"))
    return Impossible(message("the implement works to the right"), message("say 'on your right', or leave it out"))


@construction("amount=amount FROM [DET] EDGE", "amount=amount CLEAROF [DET] EDGE")
def distance_from_edge(amount: Amount) -> Impossible | None:
    """Compose "4 metres from the edge" behind a drive around an area."""
    if amount.unit != "metres":
        return None
    return Impossible(
        message("how far from an edge it drives along it cannot be said yet"),
        message("leave it out: it drives as near as it can"),
    )
