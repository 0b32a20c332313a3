"""Constructions of the direction of work: "with lanes running east to west", "film row 4 from south to north"."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

from shapely import Polygon, unary_union

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import WorkCommand
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.places.planted_rows import rows_out_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, as_zone
from fieldhand.site.model import Site
from fieldhand.task.nodes.work_along import WorkHeading

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Directions of lanes by a side of the compass to which they run.
_LANES: dict[str, WorkHeading] = {
    "north": "north_south", "south": "north_south", "east": "east_west", "west": "east_west",
}  # fmt: skip
#: Greatest angle in degrees between rows and a direction along them, and between lanes that are said to be parallel.
_ALONG_DEG, _PARALLEL_DEG = 45.0, 3.0
#: How much longer than wide something is that has a direction.
_LONG = 4.0


@construction("axis: order=ORDERED", "axis: FROM order=ORDERED", cost=0.1)
def axis_of_order(order: Lex) -> WorkHeading | None:
    """Compose "east to west"."""
    first, _, last = str(order.value[0]).partition("_to_")
    return _LANES.get(first) if first in SIDES and last in SIDES else None


@construction(
    "axis: first=DIR [DASH] second=DIR",
    "axis: first=DIR AND second=DIR",
    "axis: FROM [DET] first=DIR [FINISH] AT [DET] second=DIR [FINISH]",
    "axis: FROM [DET] first=DIR [SIDE] AT [DET] second=DIR [SIDE]",
    "axis: AT [DET] first=DIR [DASH] second=DIR LANEWORD",
    cost=0.2,
)
def axis_of_sides(first: Lex, second: Lex) -> WorkHeading | None:
    """Compose "north-south"; "north-east" is a corner."""
    sides = (first.value, second.value)
    opposite = {*sides} in ({"north", "south"}, {"east", "west"})
    return _LANES[first.value] if opposite else None


@construction("axis: word=CORNERLANES", cost=0.0)
def axis_in_one_word(word: Lex) -> WorkHeading:
    """Compose "north-south" where it is a word."""
    return "north_south" if word.text.startswith("n") else "east_west"


@construction("axis_along: PARALLEL line=region", cost=0.1, given=("site",))
def axis_along_line(line: s.Selector, site: Site) -> WorkHeading | None:
    """Compose "parallel to the fence", which runs from north to south or from east to west."""
    zone = as_zone(line)
    parts = [one.polygon for one in site.zones if zone is not None and one.name == zone.zone]
    rectangle = unary_union(parts).minimum_rotated_rectangle
    if zone is None or zone.outside or not isinstance(rectangle, Polygon):
        return None
    corners = list(rectangle.exterior.coords)[:3]
    sides = sorted(
        (math.dist(one, two), math.degrees(math.atan2(two[0] - one[0], two[1] - one[1])))
        for one, two in pairwise(corners)
    )
    if sides[1][0] < _LONG * sides[0][0]:
        return None
    off_north = abs((sides[1][1] + 90.0) % 180.0 - 90.0)
    return "north_south" if off_north <= _PARALLEL_DEG else "east_west" if off_north >= 90.0 - _PARALLEL_DEG else None


@construction("lanes: axis=axis_along", cost=0.0)
@construction(
    "lanes: [WITH] [DET] LANES [RUNS] axis=axis",
    "lanes: AT [DET] LANES [RUNS] axis=axis",
    "lanes: [WITH] [DET] LANES [MUST] RUNS axis=axis",
    "lanes: [WITH] [DET] LANES [SHOULD] RUNS axis=axis",
    "lanes: AT [DET] axis=axis LANES",
    "lanes: [WITH] [DET] axis=axis LANES",
    "lanes: RUNS [DET] LANES axis=axis",
    "lanes: AT LANES WHICH RUNS axis=axis",
    "lanes: [GO] TOANDFRO [COMMA] [RUNS] axis=axis",
    "lanes: axis=axis [COMMA] TOANDFRO",
    cost=0.1,
)
@construction("lanes: AT LANES [RUNS] axis=axis_along", "lanes: [WITH] [DET] LANES [RUNS] axis=axis_along", cost=0.1)
def lanes(axis: WorkHeading) -> WorkHeading:
    """Compose "with the lanes running east to west" and "up and down, north to south"."""
    return axis


@construction(
    "work: one=work [COMMA] [and_or_but] axis=lanes", "work: one=work FULLSTOP axis=lanes",
    "work: axis=lanes COMMA one=work",
    cost=0.1,
)  # fmt: skip
def work_in_lanes(one: WorkCommand, axis: WorkHeading, used: int) -> WorkCommand | None:
    """Compose "mow the meadow in lanes running east to west"."""
    if one.mode != "area" or one.heading != "any":
        return None
    return replace(one, heading=axis, used=used)


@construction("work: one=work [COMMA] ROWINTURN", cost=0.2)
def work_one_by_one(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "spray the Merlot rows one after the other", as rows are worked anyway."""
    return replace(one, used=used) if one.mode == "rows" else None


@construction("work: one=work [COMMA] TOANDFRO", "work: one=work [COMMA] GO TOANDFRO", cost=0.2)
def work_to_and_fro(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "mow the meadow up and down", as ground is worked anyway."""
    return replace(one, used=used) if one.mode == "area" else None


@construction("work: one=work [COMMA] axis=axis", "work: one=work [COMMA] RUNS axis=axis", cost=0.3)
def work_east_to_west(one: WorkCommand, axis: WorkHeading, used: int) -> list[WorkCommand] | None:
    """Compose "mow the meadow east to west": do its lanes run so, or does it proceed so, lane after lane?"""
    if one.mode != "area" or one.heading != "any":
        return None
    across: WorkHeading = "east_west" if axis == "north_south" else "north_south"
    return [replace(one, heading=heading, used=used) for heading in (axis, across)]


@construction(
    "work: one=work [COMMA] [and_or_but] order=ordered", "work: one=work [COMMA] GO order=ordered",
    "work: one=work [COMMA] GO ALONG [it=IT] order=ordered", "work: order=ordered [COMMA] one=work",
    cost=0.1, given=("site",),
)  # fmt: skip
def work_towards(
    one: WorkCommand, order: tuple[str, str, bool], used: int, site: Site, it: Lex | None = None
) -> WorkCommand | None:
    """Compose "film row 4 from its south end to its north end"."""
    del it
    if order[0] == "rows" and one.mode == "rows":
        return replace(one, used=used)  # "row by row", as rows are worked anyway
    first, _, last = order[0].partition("_to_")
    if one.mode not in ("rows", "aisles") or one.heading != "any" or first not in SIDES or last not in SIDES:
        return None
    if one.along is None or (not are_rows(one.along) and rows_out_of(one.along, site) is None):
        return None
    wanted = 0.0 if last in ("north", "south") else 90.0
    turned = [abs((block.bearing_deg - wanted + 90.0) % 180.0 - 90.0) for block in site.planting.blocks]
    if not turned or max(turned) > _ALONG_DEG:
        return None  # "rows 3 to 8 from west to east" is an order of the rows
    return replace(one, heading=last, used=used)


@construction(
    "work: one=work [COMMA] ONTHEWAY", "work: ONTHEWAY [COMMA] one=work", "work: TURNROUND [COMMA] [AND] one=work",
    cost=0.1,
)  # fmt: skip
def work_on_the_way_back(one: WorkCommand, used: int) -> WorkCommand | None:
    """Compose "(film row 4 from south to north,) turn round and film row 5 on the way back"."""
    if one.mode not in ("rows", "aisles") or one.heading != "any" or one.along is None:
        return None
    return replace(one, back=True, used=used)
