"""Meanings that constructions compose: amounts, places, captures, conditions and commands."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, Literal

from fieldhand.places import selectors as s
from fieldhand.places.series_statistics import Statistic
from fieldhand.task.nodes.work_along import RowSides, WorkHeading, WorkMode
from fieldhand.task.watches import Fallback, Response, WatchCondition

#: What a place phrase means: one place, several places, an area whose trees are meant, places just spoken of (``here``,
#: ``those``), trees around of which another phrase says how many (``nearby``), a step along the row, rows of which
#: the phrase does not say which (``unknown``), or what the site cannot have (``nowhere``).
Shape = Literal["one", "several", "area", "here", "those", "nearby", "step", "unknown", "nowhere"]


#: Tests of a reading or of an attribute.
Check = Literal["lt", "le", "gt", "ge", "eq", "level", "between", "known"]

#: How a drive goes along a row; empty if it goes to a place.
Along = Literal["", "along", "down", "up"]


@dataclass(frozen=True, slots=True)
class HowMany:
    """The number of several readings that pass a test, or their share in percent, compared with a bound."""

    check: Literal["lt", "le", "gt", "ge", "eq"]
    number: float
    percent: bool = False


#: How many of several readings pass a test.
OfLast = Literal["", "all", "any", "none"] | int | HowMany

#: Threshold of a test that says no other than the last one ("below that", "lower").
SAME_THRESHOLD = "="
#: Action of a capture that refers to the last one ("another one").
LAST_THING = "*"
#: Action of captures that refer to all that was captured together last ("both again").
LAST_THINGS = "**"
#: Action of a capture that is not named ("check tree 4").
UNSAID_THING = "?"
#: Actions of captures that only what was said before, or a person, can tell.
UNKNOWN_THINGS = frozenset({LAST_THING, LAST_THINGS, UNSAID_THING})
#: Value of a parameter that is the one it had before ("at the same depth").
SAME_VALUE = "="
#: Value of a parameter of which only is said that it is little or much ("not too much").
OPEN_VALUE = "?"
#: Maximum number of laps around an area.
MOST_LAPS = 100
#: Seconds between captures that are made every so often, which it does not say.
NOW_AND_THEN_S = 1e-3
#: Rows that a command does not name ("the usual rows"), for which the dialogue asks.
UNNAMED_ROWS = s.Rows(first="unnamed rows", last="the last of the unnamed rows")
#: Rows that were named before ("these rows"), until the dialogue knows which.
THOSE_ROWS = s.Rows(first="those rows", last="the last of those rows")
#: The rows that were not named before: "each of the others".
OTHER_ROWS = s.Excluding(places=THOSE_ROWS, of=s.Rows())
#: Zone that was spoken of before ("mow it"), until the dialogue knows which.
THAT_GROUND = "that ground"
#: Value of a parameter that is the profile's own ("at the standard depth").
DEFAULT_VALUE = ""
#: Quantity of a test of a reading of the request by its number: "^1" is the first, "^-1" the last.
NTH_READING = "^"
#: Quantity of the other side of a test of how far two readings, or two means, are apart.
DIFFERENCE = "^difference"
#: Quantity of a test of the latest reading of several ("that one").
LATEST_READING = "^^"


@dataclass(frozen=True, kw_only=True)
class Amount:
    """A number with a unit, converted to metres, seconds, degC, ppm, percent, years or kg."""

    number: float
    unit: str


@dataclass(frozen=True, slots=True)
class Nominal:
    """A noun phrase without its determiner.

    Attributes:
        selector: Places that fit the description.
        plural: True for a noun in the plural.
        single: True if the description fits one place only ("northernmost tree").
        complete: Number of places if the description lists them all ("corners": 4), 0 otherwise.
        kind: Kind of its noun.
        of_side: True if an adjective before it names the side on which it stands ("northern tree").
        pronoun: True for "one", which stands for a noun before it.
        tested: True if a clause behind the noun describes it ("that are older than 8 years").
        vague: Attribute by which trees are described without a value ("weak vines").
        unmarked: True for a noun that has one form for one and for several ("basil", "Sungold").
    """

    selector: s.Selector
    plural: bool = False
    single: bool = False
    complete: int = 0
    kind: Literal["tree", "corner", "point"] = "tree"
    tested: bool = False
    pronoun: bool = False
    of_side: bool = False
    vague: str = ""
    unmarked: bool = False

    def counts(self, number: int) -> bool:
        """Return True if its noun can name so many places: "three trees" and "one tree", but not "three tree"."""
        return self.unmarked or self.plural == (number != 1)


@dataclass(frozen=True, slots=True)
class Likewise:
    """A side that is named by one named before it: "the other half", "the southern one"; or the best of those ranked.

    Attributes:
        kind: Half, quarter or corner, ``extreme`` for the tree or the row that is farthest to the side, ``ranked``,
            ``rest`` for the others of those, ``nth`` for one of several that were named, ``those`` for others of that
            description, ``value`` for those with another value ("the green ones"), ``read`` for those with the
            highest readings ("the hottest one"), whose unit is ``side``, or ``compared`` for the one of two that has
            the lower or the higher mean (``lt`` or ``gt`` as ``side``); empty if it is of the kind of the one before.
        number: Which one of several, from 1 on; -1 for the last.
        side: Side of the compass; empty for the opposite side.
        holds: True if the places are inside it; of ``those``, if the phrase describes them.
        of_number: Number of those of which it is one, if the phrase says it ("the last of the four").
    """

    kind: Literal[
        "", "half", "quarter", "corner", "extreme", "ranked", "rest", "nth", "those", "value", "read", "compared"
    ]
    side: str = ""
    holds: bool = False
    number: int = 0
    of_number: int = 0


@dataclass(frozen=True, slots=True)
class PlaceMeaning:
    """A place phrase.

    Attributes:
        selector: Places that are meant; ignored for ``here`` and ``those``.
        shape: Whether they are one, several, an area, or those spoken of before.
        count: Number of places, if the phrase gives one.
        each: True if the phrase says "each" or "every".
        optional: True for "as many as you can".
        at_most: Maximum number of visits ("up to 6").
        in_order: True if the places are visited in the order in which they are named.
        like: Side that the places are on, or which they are, by one named before.
        itself: True for "the tree itself", and no other place that was spoken of.
        one_tree: True for "that tree", which is none of several places.
        beside: True for a place near one that was spoken of ("the tree closest to it").
        there: True if the phrase says that they are in the area spoken of ("every tree there").
        inside: True if it says so of the row in which the place before it is ("every lettuce in it").
        per: Rows of each of which the selector says something by itself ("the oldest tree of each row").
        fault: Why the site cannot have it, for ``nowhere``.
        vague: Attribute by which they are chosen if neither a number nor a value was given ("the oldest trees").
        ranked: Attribute of which the highest or lowest values are visited first, if as many as possible are.
        tokens: Tokens of the phrase, as a bit mask; they do not tell two meanings apart.
    """

    selector: s.Selector
    shape: Shape
    count: int | None = None
    each: bool = False
    optional: bool = False
    at_most: int | None = None
    in_order: bool = False
    there: bool = False
    inside: bool = False
    itself: bool = False
    one_tree: bool = False
    beside: bool = False
    like: Likewise | None = None
    per: s.Selector | None = None
    fault: str = ""
    vague: str = ""
    ranked: tuple[str, Literal["highest", "lowest"]] | None = None
    tokens: int = field(default=0, compare=False)

    @property
    def refers_back(self) -> bool:
        """True if only places named before tell which ones are meant; "the oldest one" may be that of all.

        "Those with mildew" may be all that there are, too.
        """
        if self.like is None or (self.like.kind == "those" and self.like.holds):
            return False
        return self.like.kind != "ranked"

    def with_tokens(self, used: int) -> PlaceMeaning:
        """Return the meaning of a phrase of these tokens."""
        return replace(self, tokens=used)


@dataclass(frozen=True, slots=True)
class ParameterValue:
    """A value that a phrase gives to a parameter of an action.

    Attributes:
        value: Number in ``unit``, or one of the parameter's choices.
        unit: Unit of a number, as in :class:`Amount`, or the profile's own.
        names: Parameters that the phrase may name; empty if it names none.
    """

    value: float | str
    unit: str
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Thing:
    """One kind of capture.

    Attributes:
        action: Action.
        count: Number of captures, if the phrase says it.
        plural: True for a noun in the plural.
        parameters: Parameters that the phrase gives.
        more: True for "another" and "two more", which are taken besides those before.
        verb: Verb of a capture that is not named: ``look`` ("check tree 4") or ``sample``; empty for another one.
        some: True for "some samples", whose number is open in a zone with plants, but not where the plants are named.
    """

    action: str
    count: int | None = None
    plural: bool = False
    parameters: tuple[tuple[str, str | float], ...] = ()
    more: bool = False
    verb: Literal["", "look", "sample"] = ""
    some: bool = False


#: Beginning of the action of a wait, which is read as a capture and becomes a wait when the plan is complete.
_WAIT = "wait for "


def wait_thing(seconds: float) -> Thing:
    """Return a wait as what is done at a place."""
    return Thing(f"{_WAIT}{seconds!r}", count=1)


def wait_seconds(action: str) -> float | None:
    """Return the seconds of the action of a wait; None for an action of the robot."""
    return float(action.removeprefix(_WAIT)) if action.startswith(_WAIT) else None


def rested_things(once: tuple[Thing, ...], times: int, seconds: float) -> tuple[Thing, ...]:
    """Return captures several times, with a wait between one time and the next."""
    again = (wait_thing(seconds), *once)
    return (*once, *(again * (times - 1)))


@dataclass(frozen=True, slots=True)
class SettleClause:
    """A wait before each capture of some actions; of all, if the phrase names none (``LAST_THING``)."""

    seconds: float
    actions: tuple[str, ...]
    used: int


@dataclass(frozen=True, slots=True)
class PaceClause:
    """A driving speed.

    Attributes:
        speed: Metres per second; 0 if the phrase does not say it ("slowly").
        used: Tokens of the phrase.
        at_most: True if the phrase only forbids to drive faster.
        slowly: True for "slowly" without a number.
        share: Share of the robot's own speed that was said, or of the speed at which it works; 0 for a number.
    """

    speed: float
    used: int = 0
    at_most: bool = False
    slowly: bool = False
    share: float = 0.0


@dataclass(frozen=True, slots=True)
class CaptureCommand:
    """A command to capture something, at a place or where the robot is.

    Attributes:
        things: Captures.
        place: Place; None if the phrase names none.
        used: Tokens of the phrase.
        times: Number of repetitions ("twice").
        relation: ``of`` or ``at``, which ties the captures to the place; ``lead`` if the place was
            named first; ``bare`` for captures without a verb, which only a condition can have; ``plain`` for those
            without a verb at the place spoken of, which are not made twice.
        spacing: Distance between the captures along a line, in metres.
        within: Area or rows in which the place is, if the phrase names them by themselves ("in row 3, at the ...").
        instead: True if it is done in place of what another case has.
        every_s: Seconds from one time to the next, if it is done again and again ("every ten minutes").
        for_s: Seconds for which it is done again and again ("for an hour").
        of: Statistic that is asked for, which "it" means behind it ("the average CO2 of"); empty for the readings.
    """

    things: tuple[Thing, ...]
    place: PlaceMeaning | None
    used: int
    times: int = 1
    spacing: float | None = None
    relation: str = "at"
    within: PlaceMeaning | None = None
    instead: bool = False
    every_s: float = 0.0
    for_s: float = 0.0
    of: Statistic | Literal[""] = ""


@dataclass(frozen=True, slots=True)
class DriveCommand:
    """A command to drive somewhere.

    Attributes:
        place: Where to.
        used: Tokens of the phrase.
        begins: True if the work begins there.
        returns: True if the robot comes back there.
        along: Direction along a row, if the robot drives along it.
        picks: True if the places are only chosen ("take three trees").
        ends: True if nothing is done behind it ("ending at the charger").
        instead: True if what another case has is done there ("go five trees south instead").
        pace: Speed of the drive, if the phrase says it ("drive slowly to tree 4").
        to: True for a drive to an area, and not around it or through it.
    """

    place: PlaceMeaning
    used: int
    begins: bool = False
    returns: bool = False
    picks: bool = False
    along: Along = ""
    ends: bool = False
    instead: bool = False
    pace: PaceClause | None = None
    to: bool = False


@dataclass(frozen=True, slots=True)
class WorkCommand:
    """A command to work along a path, or to drive along it.

    Attributes:
        action: Action of an implement; empty to drive only.
        along: Rows or area; None if the phrase names none.
        mode: How it is worked.
        used: Tokens of the phrase.
        sides, every, heading, laps, optional, parameters: As of the plan node.
        rest_s: Seconds of rest between laps.
        rests_last: True if it rests after the last lap as well.
        rests_rows: True if it rests at the end of each row instead.
        back: True if it is done on the way back from the work before it, in the other direction.
        edge_side: Side of an edge on which the phrase says that it drives.
        faced: True if the phrase says what the implement faces.
        it: True if the phrase refers to the ground by "it".
    """

    action: str
    along: s.Selector | None
    mode: WorkMode
    used: int
    sides: RowSides = "one"
    every: int = 1
    heading: WorkHeading = "any"
    laps: int = 1
    optional: bool = False
    parameters: tuple[tuple[str, str | float], ...] = ()
    rest_s: float = 0.0
    rests_last: bool = False
    rests_rows: bool = False
    back: bool = False
    edge_side: Literal["", "inside", "outside"] = ""
    faced: bool = False
    it: bool = False


@dataclass(frozen=True, slots=True)
class Lead:
    """A place at which the next command is done ("at tree 4, ..."), or what was done last.

    Attributes:
        place: Place.
        used: Tokens of the phrase.
        relation: Word that ties the place to what is done there; ``topic`` if it is what the next sentences are about.
        things: Captures that the next command can refer to, if the phrase names them.
        begins: True if the work begins there ("starting with row 1").
    """

    place: PlaceMeaning
    used: int
    relation: str = "at"
    things: tuple[Thing, ...] = ()
    begins: bool = False


@dataclass(frozen=True, slots=True)
class RankCommand:
    """Trees that are ranked by an attribute, of which a later command names the best."""

    trees: PlaceMeaning
    attribute: str
    used: int


@dataclass(frozen=True, slots=True)
class Home:
    """A return at the end of the mission: to a marker, or to the usual one of the site.

    Attributes:
        then: Where to.
        used: Tokens of the phrase.
        to_it: True if it is to a marker that was named before.
        when_done: True if the phrase says that nothing follows ("when you are done").
    """

    then: Literal["return_to_start", "return_to_end"] | None
    used: int
    to_it: bool = False
    when_done: bool = False


@dataclass(frozen=True, slots=True)
class StopCommand:
    """The end of the mission at this point, where the robot also stays with ``stays``."""

    used: int
    stays: bool = False


@dataclass(frozen=True, slots=True)
class LimitClause:
    """A limit on distance, time or battery.

    Attributes:
        amount: Largest amount; with ``keep`` the amount that must be left.
        keep: True for an amount that must be left.
        used: Tokens of the phrase.
        back: True for an amount that must be left on the return.
        later: True if it may be when the work begins as well ("in two hours").
        until: True if the work goes on until so much is left ("until the battery is at 40 %").
    """

    amount: Amount
    keep: bool
    used: int
    back: bool = False
    later: bool = False
    until: bool = False


#: Quantity of a test of the battery's charge.
BATTERY_TEST = "the battery"


@dataclass(frozen=True, slots=True)
class RechargeClause:
    """A charge of the battery: a step of the plan, or with ``always`` whenever it is needed.

    Attributes:
        below: Charge in percent below which it charges although more work would fit.
        until: Charge in percent at which charging ends.
        at_most: Maximum number of charges.
        seconds: Time at the charger.
    """

    used: int
    always: bool = False
    below: float | None = None
    until: float | None = None
    at_most: int | None = None
    seconds: float | None = None


@dataclass(frozen=True, slots=True)
class SlowPlace:
    """A place at which the robot drives slowly.

    Attributes:
        places: The place.
        metres: Distance from it in metres, 0 for the place itself; None if the phrase says only "near".
        pace: Speed.
    """

    places: s.Selector
    metres: float | None
    pace: PaceClause | None = None


@dataclass(frozen=True, slots=True)
class WayRule:
    """Where the robot must not drive, and the only gates that it may pass.

    Attributes:
        avoid: Places, each with the distance in metres to keep from it; 0 to keep out of it.
        gates: The only gates that it may pass; empty for all.
        left_out: Those of the places whose trees are left out as well ("stay out of"), not only driven past ("not
            through").
        used: Tokens of the phrase.
        slow: Places at which it drives slowly.
        leaves: True if the phrase says by which gate it leaves.
        described: True if the phrase describes the last places only ("that are at least 20 m from the pond").
    """

    avoid: tuple[tuple[s.Selector, float], ...] = ()
    gates: tuple[str, ...] = ()
    left_out: tuple[s.Selector, ...] = ()
    used: int = 0
    slow: tuple[SlowPlace, ...] = ()
    leaves: bool = False
    described: bool = False


@dataclass(frozen=True, slots=True)
class Test:
    """A test of a reading or of an attribute; the dialogue finds the reading.

    Attributes:
        quantity: Quantity that the phrase names; empty if it names none ("it").
        check: Kind of the test.
        value: Threshold, (low, high), or the name of a level.
        unit: Unit that the phrase names; empty if none.
        negated: True for "is not".
        attribute: Attribute of the tree that is tested instead of a reading; empty for a reading.
        place: Place of the reading, if the phrase names it ("the one at the south end").
        setting: Parameters of the reading, if the phrase names them ("the 15 cm value").
        of: Statistic of several readings that is tested ("the average"); empty for one reading.
        than: What they are compared with, if with other readings; ``value`` is then the difference.
    """

    quantity: str
    check: Check
    value: Any
    unit: str = ""
    negated: bool = False
    attribute: str = ""
    place: PlaceMeaning | None = None
    setting: tuple[tuple[str, str | float], ...] = ()
    of: Statistic | Literal[""] = ""
    than: Subject | None = None


@dataclass(frozen=True, slots=True)
class Subject:
    """A reading that is tested, as a phrase describes it.

    Attributes:
        quantity: Quantity of the reading; empty if the phrase names none ("it").
        place: Place of the reading.
        setting: Parameters of the reading.
        of: Statistic of several readings; empty for one reading.
    """

    quantity: str = ""
    place: PlaceMeaning | None = None
    setting: tuple[tuple[str, str | float], ...] = ()
    of: Statistic | Literal[""] = ""


@dataclass(frozen=True, slots=True)
class AllTests:
    """Tests that are all required, or of which one is enough (``any_of``).

    Attributes:
        tests: Tests.
        any_of: True if one of them is enough.
        of_last: What is said of the last several readings together: ``all`` or ``any`` of them pass, or so many; empty
            for a test of one reading.
    """

    tests: tuple[Test, ...]
    any_of: bool = False
    of_last: OfLast = ""

    @property
    def of_series(self) -> bool:
        """True if what is tested is no reading by itself: a statistic, a share, or fewer than so many of several."""
        return any(test.of for test in self.tests) or (isinstance(self.of_last, HowMany) and not self.at_least)

    @property
    def at_least(self) -> int:
        """The number of readings of which at least so many have to pass; 0 for another test."""
        if isinstance(self.of_last, HowMany):
            more = {"gt": 1, "ge": 0}.get(self.of_last.check)
            return 0 if more is None or self.of_last.percent else int(self.of_last.number) + more
        return self.of_last if isinstance(self.of_last, int) else 0


@dataclass(frozen=True, slots=True)
class When:
    """A condition on what follows it, or on the command before it.

    Attributes:
        tests: Tests; none for "if so".
        among: What it may choose from: the trees of an area ("wherever a tree is yellow"), or the places visited last
            ("those above 30 degC").
        terse: True for a test without "if" ("above 30 degC: a picture").
        asks: True for a question ("is it above 30 degC?"), which "if so" may answer.
        affirms: True for "if it is", of a test that was denied before ("unless it is high, ..., if it is, ...").
    """

    tests: AllTests
    used: int
    among: Literal["", "area", "visited"] = ""
    terse: bool = False
    asks: bool = False
    affirms: bool = False

    @property
    def measured_at(self) -> PlaceMeaning | None:
        """The place of the only reading that is tested, if the condition names one."""
        return self.tests.tests[0].place if len(self.tests.tests) == 1 else None


@dataclass(frozen=True, slots=True)
class CaptureWhere:
    """A capture at those of several places where a reading passes a test ("... at those that are hot").

    Attributes:
        tests: Test of the reading.
        capture: Capture, without a place.
        used: Tokens of the phrase.
        area: Places at which the tested reading is taken first, if the phrase names them.
    """

    tests: AllTests
    capture: CaptureCommand
    used: int
    area: PlaceMeaning | None = None


@dataclass(frozen=True, slots=True)
class Allowed:
    """Work that is done only if the budget allows it: what follows it, or the command before it.

    Attributes:
        used: Tokens of the phrase.
        unsaid: True if the phrase does not say that the budget decides ("if possible").
        adds: True if it is about what was added last ("and the bank too, if there is time").
    """

    used: int
    unsaid: bool = False
    adds: bool = False


@dataclass(frozen=True, slots=True)
class UntilCondition:
    """A condition that ends the repetition before it."""

    tests: AllTests
    used: int


@dataclass(frozen=True, slots=True)
class VisitLimit:
    """The maximum number of visits of the places before it; without ``count`` as many as the budget allows."""

    count: int | None
    used: int


@dataclass(frozen=True, slots=True)
class Total:
    """A number of captures that must agree with the plan; ``action`` is empty for captures of any kind."""

    count: int
    action: str
    used: int


@dataclass(frozen=True, slots=True)
class Reported:
    """A wish to be told what the report of the mission says anyway ("and tell me the average").

    Attributes:
        used: Tokens of the phrase.
        of: The only statistic that it names; empty for other figures.
    """

    used: int
    of: Statistic | Literal[""] = ""


@dataclass(frozen=True, slots=True)
class Again:
    """A command to do what was done at the last place again, at another place or there.

    Attributes:
        place: Other place; None if the phrase names none.
        used: Tokens of the phrase.
        times: Number of repetitions of all that was done so far; 0 if the phrase gives none.
        in_all: True if the number includes what was done so far.
        whole: True if the phrase says that all of it is repeated, from the first place on.
        both: True if the phrase says that it was done at two places ("both again").
        rest_s: Seconds of the wait before each repetition ("half an hour later").
        drives: Places between which the robot only drives, which is all that is repeated.
        battery: Charge of the battery in percent at which it ends; None if the phrase gives none.
    """

    place: PlaceMeaning | None
    used: int
    times: int = 0
    in_all: bool = False
    whole: bool = False
    both: bool = False
    rest_s: float = 0.0
    drives: tuple[PlaceMeaning, ...] = ()
    battery: float | None = None


@dataclass(frozen=True, slots=True)
class After:
    """A command that is done before the others of its sentence, or was done already ("after photographing it")."""

    done: CaptureCommand | DriveCommand
    used: int


@dataclass(frozen=True, slots=True)
class InTurn:
    """A command that is done before or after all others ("start with ...", "finish with ...")."""

    command: CaptureCommand | DriveCommand
    first: bool
    used: int


@dataclass(frozen=True, slots=True)
class Correction:
    """A place that is meant in the stead of the last one ("no wait, tree 9"), or of the one that it names.

    Attributes:
        place: Place that is meant.
        used: Tokens of the phrase.
        old: Place that is not meant ("scratch tree 4, make it tree 9"); None for the last one.
    """

    place: PlaceMeaning
    used: int
    old: PlaceMeaning | None = None


@dataclass(frozen=True, slots=True)
class Reordered:
    """An order of the steps before it that is said behind them.

    Attributes:
        first: Place that comes first ("tree 9 first"); None if it is not said.
        used: Tokens of the phrase.
        swapped: True if two steps change places ("the other way round").
        then: Place that comes after it, if the phrase names it ("tree 9 before tree 4").
    """

    first: PlaceMeaning | None
    used: int
    swapped: bool = False
    then: PlaceMeaning | None = None


@dataclass(frozen=True, slots=True)
class ReadingQuestion:
    """A reading to be taken, and a test of it that "if so" refers to."""

    tests: AllTests
    place: PlaceMeaning | None
    used: int


@dataclass(frozen=True, slots=True)
class Failing:
    """The case in which the command before it fails.

    Attributes:
        used: Tokens of the phrase.
        action: Action that fails, if the phrase names it.
        at_one: True if it may fail at each of several places by itself ("at one of them").
        place: Place that cannot be reached, if the phrase names it; it is that of the command before.
    """

    used: int
    action: str = ""
    at_one: bool = False
    place: PlaceMeaning | None = None


@dataclass(frozen=True, slots=True)
class InAnOrder:
    """The order of visits.

    It is that of their mention (``by`` empty) or its reverse, any order, one by one, by compass or attribute.
    """

    by: str
    attribute: str
    descending: bool
    used: int


@dataclass(frozen=True, slots=True)
class Otherwise:
    """The case in which the last condition is false.

    Attributes:
        used: Tokens of the phrase.
        in_all: True for "in all other cases", in which each of the conditions before it is false.
    """

    used: int
    in_all: bool = False


@dataclass(frozen=True, slots=True)
class PassOn:
    """Nothing that is done in a case ("leave it", "carry on with the next tree").

    Attributes:
        used: Tokens of the phrase.
        to_next: True if it is said of one of several places that are visited.
    """

    used: int
    to_next: bool = False


@dataclass(frozen=True, slots=True)
class Connective:
    """The connective between two commands.

    Attributes:
        full: True if it separates sentences.
        then: True if it says that one follows the other.
        both: True if it contains "and" or "but".
        contrasts: True if it contains "but".
        first: True if it says that what follows is to be done before ("but first").
        of_all: True if it is to be done before all others ("before all of that").
        from_here: True if what follows begins where the robot is then ("from there").
        bare: True if it is only a comma.
        purpose: True for "to" before what is done at the place.
        precedes: True for "before".
        in_turn: True for "then" that adds another place ("row 3, then row 4").
        each: True for "and after each one", before what is done then.
        begins: True for "first of all", which begins a list unless something was to be done before it.
    """

    full: bool
    then: bool
    used: int
    first: bool = False
    of_all: bool = False
    both: bool = False
    contrasts: bool = False
    from_here: bool = False
    bare: bool = False
    purpose: bool = False
    precedes: bool = False
    in_turn: bool = False
    each: bool = False
    begins: bool = False


#: Conditions that are checked throughout the mission.
Conditions = tuple[WatchCondition, ...]


@dataclass(frozen=True, slots=True)
class WatchResponse:
    """The response of the robot to a condition that begins to hold.

    Attributes:
        response: Response.
        at_most_s: Maximum of a wait in seconds; None if it is not said.
        fallback: What follows the maximum; empty if it is not said.
        over: True if the phrase says that the robot goes on when it is over.
        pace: Speed of a robot that drives slowly.
        stands: True for "stop", after which the robot stays where it is if it does not end.
    """

    response: Response
    at_most_s: float | None = None
    fallback: Fallback | None = None
    over: bool = False
    stands: bool = False
    pace: PaceClause | None = None


@dataclass(frozen=True, slots=True)
class WatchCommand:
    """Conditions that are checked throughout the mission, and the response to each.

    Attributes:
        conditions: Conditions; none for a sentence about the response to those before.
        reaction: Response.
        used: Tokens of the phrase.
        during: Actions during which they are checked; empty for the whole mission.
    """

    conditions: Conditions
    reaction: WatchResponse
    used: int
    during: tuple[str, ...] = ()


Command = (
    CaptureCommand
    | DriveCommand
    | WorkCommand
    | Lead
    | Home
    | StopCommand
    | LimitClause
    | WayRule
    | RechargeClause
    | When
    | CaptureWhere
    | Otherwise
    | PassOn
    | Allowed
    | UntilCondition
    | VisitLimit
    | Total
    | Reported
    | RankCommand
    | Again
    | InAnOrder
    | After
    | ReadingQuestion
    | Failing
    | InTurn
    | Correction
    | Reordered
    | PaceClause
    | SettleClause
    | WatchCommand
)


@dataclass(frozen=True, slots=True)
class LinkedCommand:
    """A command with the connective before it."""

    before: Connective | None
    command: Command


@dataclass(frozen=True, slots=True)
class Said:
    """The clauses of a request, in order."""

    clauses: tuple[LinkedCommand, ...]

    @property
    def used(self) -> int:
        """The tokens of the commands and of what joins them."""
        used = 0
        for clause in self.clauses:
            used |= clause.command.used | (0 if clause.before is None else clause.before.used)
        return used
