"""Constructions of work along paths: "spray rows 3 to 8", "mow every second aisle", "patrol the property line twice".

A robot's implements have words of their own: ``WORKV`` are their verbs, ``WORKN`` their nouns ("the mower").
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.parameters import with_parameter
from fieldhand.planning.grammar.meaning import UNNAMED_ROWS, Amount, Nominal, ParameterValue, Thing, WorkCommand
from fieldhand.planning.grammar.places.areas import edges
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, is_one_row, over, rows_kept
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task.nodes.work_along import RowSides, WorkHeading, WorkMode

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class Tract:
    """Rows, aisles or ground along which something is done.

    Attributes:
        selector: Trees of the rows, or the area.
        mode: How it is worked; empty for ground that is worked along its rows or lane by lane, as the implement works.
        sides: Sides of the rows.
        every: 2 for every second aisle.
        along: True if the phrase says "along".
        optional: True for as much of it as the budget allows.
        solid: True for what the robot drives around, and whose ground is not worked ("film the pond").
        heading: Direction in which an edge is driven.
    """

    selector: s.Selector
    mode: WorkMode | None
    sides: RowSides = "one"
    every: int = 1
    along: bool = False
    optional: bool = False
    solid: bool = False
    heading: WorkHeading = "any"


@construction(
    "tract: rows=rows", "tract: way=ALONG rows=rows", "tract: in_ rows=rows",
    "tract: rows=each_row", "tract: way=ALONG rows=each_row", "tract: in_ rows=each_row",
    "tract: rows=all_rows", "tract: way=ALONG rows=all_rows", "tract: in_ rows=all_rows",
    cost=0.8,
)  # fmt: skip
def rows_tract(rows: s.Selector, way: Lex | None = None) -> Tract | None:
    """Compose "along rows 3 to 8"."""
    known = are_rows(rows) or rows_kept(rows) is not None
    return Tract(rows, "rows", along=way is not None) if known else None


@construction(
    "tract: EACH [word=DET] n=count noun=ROW in_ where=region", "tract: word=DET n=count noun=ROW in_ where=region",
    cost=0.1, given=("site",),
)  # fmt: skip
def all_rows_there(n: int, noun: Lex, where: s.Selector, site: Site, word: Lex | None = None) -> Tract | None:
    """Compose "all four rows in the cool section", of a section that has four, each with all its plants."""
    if n < 2 or not noun.plural or are_rows(where) or (word is not None and "definite" not in word.features):
        return None
    plants = ids_of(where, site) or set()
    rows = [{site.trees[tree].place.id for tree in row.trees} for row in site.planting.rows]
    there = [row for row in rows if row & plants]
    return Tract(over(s.Rows(), where), "rows") if len(there) == n and all(row <= plants for row in there) else None


@construction(
    "tract: [AT] [DET] side=DIR SIDE OF rows=rows", "tract: ALONG [DET] side=DIR SIDE OF rows=rows",
    "tract: [AT] [DET] side=DIR SIDE OF rows=crop_area", "tract: ALONG [DET] side=DIR SIDE OF rows=crop_area", cost=0.0,
)  # fmt: skip
def one_side(side: Lex, rows: s.Selector) -> Tract | None:
    """Compose "the west side of row 4" and "along the west side of the carrots"."""
    return Tract(rows, "rows", sides=side.value) if side.value in SIDES else None


@construction(
    "tract: EACHSIDE OF rows=rows", "tract: two_sides OF rows=rows", "tract: part=tract [FROM] EACHSIDE", cost=0.0
)
@construction("tract: EACHSIDE OF part=tract", cost=0.1)
def both_sides(rows: s.Selector | None = None, part: Tract | None = None) -> Tract | None:
    """Compose "both sides of row 4" and "rows 3 to 8 from both sides"."""
    if part is not None:
        return replace(part, sides="both") if part.mode in ("rows", "aisles") and part.sides == "one" else None
    return None if rows is None else Tract(rows, "rows", sides="both")


@construction("tract: part=tract [COMMA] except out=rows", "tract: part=tract [COMMA] BUT [NOT] out=rows", cost=0.0)
def without_rows(part: Tract, out: s.Selector) -> Tract | None:
    """Compose "rows 3 to 8 except row 5"."""
    if part.mode != "rows" or not are_rows(out):
        return None
    return replace(part, selector=s.Excluding(places=out, of=part.selector))


@construction(
    "tract: whole=tract [COMMA] BUT ONLY rows=rows", "tract: whole=tract COMMA ONLY rows=rows",
    "tract: whole=tract [COMMA] BUT rows=rows ONLY", cost=-1.0, given=("site",),
)  # fmt: skip
def only_some_rows(whole: Tract, rows: s.Selector, site: Site) -> Tract | None:
    """Compose "rows 2 to 8, but only row 5"."""
    if whole.optional or not are_rows(rows) or not are_rows(whole.selector):
        return None
    own, among = ids_of(rows, site), ids_of(whole.selector, site)
    return replace(whole, selector=rows) if own and among and own < among else None


@construction(
    "tract: where=region", "tract: in_ where=region", "tract: where=crop_area", "tract: ALONG where=crop_area", cost=0.4
)
def ground(where: s.Selector) -> Tract | None:
    """Compose "the meadow" and "the north block"."""
    return None if are_rows(where) or where == edges() else Tract(where, None)


@construction(
    "tract: EVERYTHING",
    "tract: EVERYTHING BUT out=region",
    "tract: EVERYTHING except out=region",
    "tract: EACH OF site",
    "tract: site",
    "tract: site except out=region",
    "tract: site BUT [NOT] out=region",
    cost=0.3,
)
def whole_site(out: s.Selector | None = None) -> Tract:
    """Compose "everything but the wet corner"."""
    return Tract(s.Trees() if out is None else s.Excluding(places=out), None)


@construction("tract: [ALONG] [DET] USUAL noun=ROW", "tract: [ALONG] DET DIR noun=ROW", cost=1.0)
def unnamed_rows(noun: Lex) -> Tract | None:
    """Compose "the usual rows" and "the northern rows", which do not say which rows."""
    return Tract(UNNAMED_ROWS, "rows") if noun.plural else None


@construction("tract: EVERYTHING in_ where=region", cost=0.1)
def everything_there(where: s.Selector) -> Tract | None:
    """Compose "everything in the meadow except the slope" behind a verb of work."""
    return None if are_rows(where) or where == edges() else Tract(where, None)


@construction("tract: EACH [DET] inner=nominal", cost=0.6, given=("site",))
def every_plant(inner: Nominal, site: Site) -> Tract | None:
    """Compose "all tomatoes", where their rows have no other plants."""
    if inner.single or inner.complete or inner.pronoun or are_rows(inner.selector):
        return None
    return Tract(inner.selector, "rows") if rows_out_of(inner.selector, site) is not None else None


@construction(
    "tract: first=tract AND then=tract", "tract: first=tract COMMA AND then=tract",
    "tract: first=tract COMMA rest=tract", cost=0.3,
)  # fmt: skip
def both_tracts(first: Tract, then: Tract | None = None, rest: Tract | None = None) -> Tract | None:
    """Compose "the leek bed and the onion bed", also behind another one and a comma."""
    then = rest if then is None else then
    if then is None or (rest is not None and len(rest.selector.members) < 2):
        return None
    alike = replace(first, selector=then.selector) == then and first.selector != then.selector
    if not alike or first.mode != "rows" or first.optional:
        return None
    return replace(first, selector=s.UnionOf(parts=(*first.selector.members, *then.selector.members)))


@construction("tract: ASMANY [OF] part=tract", cost=2.0)
@construction("tract: ASMANY part=tract as_can", "tract: ASMANY noun=ROW as_can", cost=0.0)
def as_many(part: Tract | None = None, noun: Lex | None = None) -> Tract | None:
    """Compose "as many of rows 3 to 8 as you can"."""
    if noun is not None and not noun.plural:
        return None
    return replace(part or Tract(s.Rows(), "rows"), optional=True)


@construction("tract: [ALONG] [DET] noun=HEADLAND", cost=0.0)
def headlands(noun: Lex) -> Tract:
    """Compose "the headlands"."""
    del noun
    return Tract(s.Trees(), "headlands")


@construction(
    "edge_line: [DET] edge_word",
    "edge_line: [DET] EDGE OF where=region",
    "edge_line: [DET] EDGE OF site",
    "edge_line: [DET] zone=ZONEPOSS EDGE",
    "edge_line: [DET] water_edge OF where=region",
    "edge_line: [DET] zone=ZONEPOSS water_edge",
    cost=0.0,
)
def edge_line(where: s.Selector | None = None, zone: Lex | None = None) -> s.Selector | None:
    """Compose "the edge of the north block" and "the pond's edge"."""
    if zone is not None:
        return s.InZone(zone=zone.value)
    return None if where is not None and are_rows(where) else where or s.Trees()


@construction(
    "edge: line=edge_line", "edge: AROUND line=edge_line", "edge: ALONG line=edge_line",
    "edge: AROUND where=region", "edge: AROUND site",
    cost=0.1,
)  # fmt: skip
def edge(where: s.Selector | None = None, line: s.Selector | None = None) -> Tract | None:
    """Compose "the property line" and "around the north block"."""
    if line is not None:
        return Tract(line, "perimeter")
    if where is not None and are_rows(where):
        return None
    return Tract(s.Trees() if where is None else where, "perimeter")


@construction("tract: edge=edge", cost=0.0)
def edge_as_tract(edge: Tract) -> Tract:
    """Compose "around the pond" behind a verb."""
    return edge


# --- commands ---------------------------------------------------------------------------------------------------------


@construction(
    "work: verb=WORKV where=tract",
    "work: verb=WORKV where=tract how=parameter",
    "work: verb=WORKV where=tract WITH amount=amount",
    "work: verb=WORKV how=parameter where=tract",
    "work: verb=WORKV WITH amount=amount where=tract",
    "work: verb=WORKV [COMMA] how=parameter",
    "work: verb=WORKV",
    "work: verb=WORKV it=IT",
    "work: verb=WORKV it=IT how=parameter",
    "work: verb=WORKV DET it=ZONEKIND",
    "work: USE [DET] verb=WORKN where=tract",
    "work: USE [DET] verb=WORKN AT where=tract",
    "work: USE [DET] verb=WORKN where=tract how=parameter",
    "work: VISIT where=tract WITH [DET] verb=WORKN",
    "work: VISIT where=tract USE [DET] verb=WORKN",
    "work: GO where=tract WITH [DET] verb=WORKN",
    "work: TAKE [DET] verb=WORKN OF where=tract",
    "work: TAKE [DET] verb=WORKV OF where=tract",
    "work: WORKV [DET] verb=WORKN OF where=tract",
    "work: WORKV [DET] verb=WORKV OF where=tract",
    cost=0.1,
    given=("robot",),
)
def work(
    verb: Lex,
    used: int,
    robot: RobotProfile,
    where: Tract | None = None,
    how: ParameterValue | None = None,
    amount: Amount | None = None,
    it: Lex | None = None,
) -> list[WorkCommand] | None:
    """Compose "spray rows 3 to 8 at 300 l/ha" and "run the mower between rows 10 and 14"."""
    parameters: tuple[tuple[str, str | float], ...] = ()
    if amount is not None:
        how = ParameterValue(amount.number, amount.unit, ())
    if how is not None:
        made = with_parameter(Thing(verb.value), how, robot)
        if made is None:
            return None
        parameters = made.parameters
    implement = robot.action[verb.value].implement
    covers = implement is not None and implement.covers
    command = WorkCommand(action=verb.value, along=None, mode="rows", used=used, parameters=parameters)
    if where is None:
        return [replace(command, it=it is not None)]  # the rows or the area before
    if "cuts" in verb.features and (where.mode or ("area" if covers else "rows")) == "rows":
        return None  # "cut row 4" may be to prune it
    return along_tract(command, where, robot)


def along_tract(command: WorkCommand, where: Tract, robot: RobotProfile) -> list[WorkCommand]:
    """Return work along a tract, in each way that it may be meant."""
    implement = robot.action[command.action].implement
    covers = implement is not None and implement.covers
    if covers and where.solid:
        return []
    if where.mode == "aisles" and where.sides == "both":  # of an aisle, by what works on both sides at once
        if implement is None or implement.side != "both":
            return []
        where = replace(where, sides="one")
    mode = where.mode or ("area" if covers else "rows")
    command = replace(command, along=where.selector, mode=mode, sides=where.sides, every=where.every)
    command = replace(command, optional=where.optional, heading=where.heading)
    if covers and mode == "rows" and not where.along and where.sides == "one" and not is_one_row(where.selector):
        return [command, replace(command, mode="aisles")]  # beside the rows, or the ground between them?
    return [command]


@construction("work: verb=GO where=edge", "work: verb=GO where=region", cost=0.1)
def patrol(verb: Lex, where: Tract | s.Selector, used: int) -> WorkCommand | None:
    """Compose "patrol the property line" and "drive around the north block"."""
    selector = where.selector if isinstance(where, Tract) else where
    if not isinstance(where, Tract) and (are_rows(selector) or "patrols" not in verb.features):
        return None
    if selector == edges():
        return None  # "the property line" is that of the site
    heading = where.heading if isinstance(where, Tract) else "any"
    return WorkCommand(action="", along=selector, mode="perimeter", used=used, heading=heading)


@construction("work: GO where=tract", cost=0.1)
def through_aisles(where: Tract, used: int) -> WorkCommand | None:
    """Compose "drive through every second aisle"."""
    if where.mode not in ("aisles", "headlands") or where.optional:
        return None
    return WorkCommand(action="", along=where.selector, mode=where.mode, used=used, every=where.every)


@construction("work: one=work [COMMA] n=COUNT", cost=0.1)
def in_laps(one: WorkCommand, n: Lex, used: int) -> WorkCommand | None:
    """Compose "patrol the boundary twice"."""
    if one.laps != 1 or not 1 <= int(n.value) <= 100 or one.along is None:
        return None
    return replace(one, laps=int(n.value), used=used)


@construction("work: one=work [COMMA] THATONLY", "work: one=work [COMMA] ENTIRE", cost=0.2)
def nothing_else(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "mow the meadow, nothing else", before what follows, and "film row 4 from end to end"."""
    return None if one.along is None else replace(one, used=used)


@construction("work: one=work [COMMA] NOFURTHERIN", cost=0.2)
def nothing_further_in(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "two laps along the edge, nothing further in"."""
    return None if one.along is None or one.mode != "perimeter" else replace(one, used=used)


@construction("work: one=work [COMMA] AGAINSTPEST", cost=0.2, given=("robot",))
def sprayed_against(one: WorkCommand, used: int, robot: RobotProfile) -> WorkCommand | None:
    """Compose "spray row 4 against the mildew": what the tank holds is up to the person."""
    sprays = one.action in robot.action and "spray" in robot.action[one.action].verbs
    return replace(one, used=used) if sprays and one.along is not None else None


@construction("work: one=work [COMMA] ASMANY as_can", cost=0.1)
def as_much(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "spray rows 3 to 8, as much as you can"."""
    return None if one.along is None or one.optional else replace(one, optional=True, used=used)


@construction(
    "work: one=work [COMMA] ONEPASS", "work: one=work [COMMA] AT ONEPASS", "work: one=work [COMMA] WITH ONEPASS",
    "work: one=work [COMMA] EACH AT ONEPASS", cost=0.1,
)  # fmt: skip
def in_one_pass(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "film both beds in one pass each", which is how they are filmed anyway."""
    return replace(one, used=used) if one.sides == "one" and one.laps == 1 and one.along is not None else None


@construction("two_sides: ONESIDE [COMMA] [AND] [then] OTHERSIDE", cost=0.0)
def one_side_and_the_other() -> str:
    """Compose "down one side and back up the other"."""
    return "both"


@construction(
    "work: one=work [COMMA] [FROM] EACHSIDE", "work: one=work [COMMA] [GO] two_sides",
    "work: one=work [COMMA] EACH [ONE] [FROM] EACHSIDE", "work: one=work [COMMA] EACH OF IT [FROM] EACHSIDE",
    "work: one=work FULLSTOP [GO] two_sides", "work: one=work [COMMA] [times=often] [COMMA] ONCE [FROM] EACHSIDE",
    "work: one=work [COMMA] [FROM] EACHSIDE ONCE", cost=0.1,
)  # fmt: skip
def on_both_sides(one: WorkCommand, used: int, times: int = 2) -> WorkCommand | None:
    """Compose "spray rows 3 to 8 at 300 l/ha from both sides" and "film row 3, one side and then the other"."""
    fits = one.mode == "rows" and one.sides == "one" and one.along is not None and times == 2
    return replace(one, laps=1, sides="both", used=used) if fits and one.laps in (1, 2) else None


@construction("command: one=work", cost=0.0)
def work_as_command(one: WorkCommand) -> WorkCommand:
    """Compose "mow the meadow" as a command."""
    return one
