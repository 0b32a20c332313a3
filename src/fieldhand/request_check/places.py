"""Check the places of a plan against the request: trees, rows, zones, gates, sides, attributes, order, exit."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

from fieldhand.language import Number, message
from fieldhand.places import selectors as s
from fieldhand.places.filters.attribute_dates import is_date
from fieldhand.request_check import words as w
from fieldhand.request_check.amounts import StatedAmount
from fieldhand.request_check.mismatch import PlanMismatch
from fieldhand.request_check.plan_facts import PlanFacts
from fieldhand.request_check.request_facts import RequestFacts
from fieldhand.site.model import Site
from fieldhand.task.build import FAULTED_EXITS
from fieldhand.terms import Side

_SIDES: tuple[Side, ...] = ("north", "east", "south", "west")
_CHARGER = frozenset({"charger", "dock"})
#: Words of a request that specifies a reaction to faults.
_OF_FAULTS = w.words_in("fail fails failed fault error abort aborted wrong stuck problem battery charge budget low")
_EACH_KIND = frozenset({"each", "every", "all", "per", "both", "different", "any"})
_NUMBER = re.compile("-?[0-9]{1,9}")
#: Pattern of the reverse of an order.
_REVERSED = re.compile(
    r"\brevers|\bopposite order|\bback to front|ing (?:with|from) the last\b"
    r"|\blast(?: one| tree| vine)?(?: to(?: the)?)? first\b"
)
#: Pattern of a side that refers to the one mentioned before.
_OTHER_PART = re.compile(r"\bother (?:half|side|end|edge|corner|quarter)\b")
#: Pattern of rows without a number for each.
_SOME_ROWS = re.compile(
    r"\b(?:each|every|all|per|other|last|final|next|odd|even|alternate|middle|cent(?:er|re|ral)|\w+most|by)"
    r"(?: \w+){0,3} (?:rows?|beds?|bench(?:es)?)\b"
)
#: Pattern of rows by when they were planted.
_PLANTED_FIRST = re.compile(
    r"\b(?:first|last|earliest|latest|recently|lately)[ -]*(?:sown|seeded|drilled|(?:trans)?planted)\b"
    r"|\b(?:sown|seeded|drilled|(?:trans)?planted) (?:the |most )?(?:first|last|earliest|latest|recently|lately)\b"
)

#: Pattern of rows by others beside them.
_BESIDE_ROWS = re.compile(
    r"\b(?:rows?|beds?|bench(?:es)?) (?:\w+ ){0,4}?"
    r"(?:(?:next|adjacent) to|beside|alongside|sides? of|(?:north|south|east|west) of)\b"
)
#: Pattern of the neighbours of several trees.
_BESIDE_THEM = re.compile(
    r"\b(?:(?:either|each|both) sides?|left and right|right and left) of (?:it|them|these|those|each)\b"
    r"|\b(?:their|its) (?:\w+ )?neighbou?rs\b"
    r"|\bplants? (?:\w+ )?(?:next to|beside) (?:it|them|each)\b|\bneighbou?rs? of each\b"
    r"|\band (?:\w+ ){0,3}the (?:nearest|closest) \w+"
    r"|\band (?:\w+ ){1,6}(?:next to|beside|alongside) (?:it|them|each)\b|\band (?:\w+ ){1,4}neighbou?rs?\b"
    r"|\b(?:trees?|vines?|ones?) (?:next to|beside|alongside) (?:it|them|each)\b"
    r"|\b(?:next to|beside|alongside|neighbou?rs? of|sides? of)"
    r" (?:the (?:\w+ ){0,2}\w+s|those|every|any|all|\w+s with)\b"
)
#: Words of an exception.
_LEAVES_OUT = w.NEGATIONS | w.words_in(
    "apart aside bar barring but forget ignore leave leaving minus omit save skipping"
)
#: Pattern of several sides or ends, or of one that a place names.
_SOME_SIDES = re.compile(
    r"\b(?:both|either|each|every|all|two|four|one)\b[^.;!?]{0,20}\b(?:sides?|ends?|edges?|faces?)\b|\bside of\b"
)
#: Pattern of a half that is named by a place near it, or by words that no map explains, and of both ends.
_SOME_HALF = re.compile(
    r"\bhalf (?:of (?:\w+ ){1,4})?(?:nearest|closest|next)\b"
    r"|\b(?:foot|head|lowest|highest|far|near|low) (?:end |side |part |point )?of\b"
    r"|\b(?:both|each|either|two|opposite) ends?\b|\bends of\b"
)
#: Words that continue a series of numbers: "5, 15, 25 and so on".
_SERIES = re.compile(r"\b(?:and so (?:on|forth)|etc|like that)\b|\bevery \S+ (?:after|until|up|to)\b")
#: Range of ids that differ by their number: "n300 through n310", "3-5 to 3-10".
_CODE_RANGE = re.compile(r"(?<![\w-])([a-z]+|[a-z]*\d+-)(\d+)\s*(?:to|through|thru|a|al|hasta|-|\u2013)\s*\1(\d+)\b")


def place_mismatches(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield contradictions in places."""
    yield from _trees(facts, plan)
    yield from _codes(facts, plan, site)
    yield from _rows(facts, plan, site)
    yield from _areas(facts, plan, site)
    yield from _gates(facts, plan, site)
    yield from _sides(facts, plan, site)
    yield from _attributes(facts, plan, site)
    yield from _ends(facts, plan, site)
    yield from _faults(facts, plan, site)
    yield from _order(facts, plan)


def _trees(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield numbered trees of the request that the plan lacks, and the reverse."""
    named = {number.lstrip("0") for _, tree in plan.trees for number in re.findall(r"\d+", tree)}
    spans = [(abs(x.first), abs(x.last)) for _, x in plan.having(s.InRow) if isinstance(x, s.InRow)]
    counted = {int(n.value) for n in plan.numbers if n.kind == "count"} | {
        abs(x.nth) for _, x in plan.having(s.Nth) if isinstance(x, s.Nth)
    }
    for amount in facts.amounts:
        n = int(amount.values[0])
        if amount.kind != "id" or str(n) in named or n in counted or any(a <= n <= b for a, b in map(sorted, spans)):
            continue
        yield PlanMismatch(
            kind="place", what=message("the request names tree {number}, but the plan does not", number=n)
        )
    if facts.spaced or _BESIDE_THEM.search(facts.text):
        return  # the trees at that distance, and those beside others, depend on the site
    spoken = facts.text.replace(" ", "")
    numbers = {str(n) for n in facts.whole_numbers}
    for node, tree in plan.trees:
        if _digits(tree) in numbers or _spelling(tree).search(spoken):
            continue
        if any(_is_between(tree.lower(), *ends) for ends in _CODE_RANGE.findall(facts.text.replace(" - ", "-"))):
            continue
        if _SERIES.search(facts.text) and _is_in_series(_digits(tree), facts.text):
            continue
        yield PlanMismatch(
            kind="place",
            what=message("the plan names tree '{tree}', but the request does not", tree=tree[:40]),
            node=node,
        )


def _spelling(tree: str) -> re.Pattern[str]:
    """Return the pattern of an id in a request without spaces: "n-25" and "n25", but not "n250"."""
    return re.compile(r"[\W_]*".join(re.escape(ch) for ch in tree.lower() if ch.isalnum()) + r"(?!\d)")


def _codes(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield ids with letters that the request names and the plan lacks ("N250, N300 and N2")."""
    named = {tree.lower() for _, tree in plan.trees}
    codes = dict.fromkeys(re.findall(r"[a-z]+\d+(?:-\d+)?", facts.text))
    if not codes or not named or _CODE_RANGE.search(facts.text.replace(" - ", "-")):
        return
    ids = {tree.place.id.lower(): tree.place.id for tree in site.trees if not tree.place.id.isdigit()}
    for code in codes:
        if code in ids and code not in named:
            what = message("the request names tree {number}, but the plan does not", number=ids[code])
            yield PlanMismatch(kind="place", what=what)


def _is_in_series(number: str, text: str) -> bool:
    """Return True if a number lies in steps between others of a text: 35 in "5, 15, 25 and so on up to 165"."""
    named = [int(one) for one in re.findall(r"\d+", text)]
    steps = ((low, high - low) for low, high in pairwise(named) if low < high)
    return number.isdigit() and any(
        low < int(number) < max(named) and (int(number) - low) % step == 0 for low, step in steps
    )


def _is_between(tree: str, prefix: str, first: str, last: str) -> bool:
    """Return True if a tree's id has a prefix and a number of a range."""
    number = tree.removeprefix(prefix)
    return tree.startswith(prefix) and number.isdigit() and int(first) <= int(number) <= int(last)


def _digits(name: str) -> str:
    """Return the number at the end of a name without leading zeros: "42" of "T042"."""
    head = name.rstrip("0123456789")
    return name[len(head) :].lstrip("0")


def _rows(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield numbered rows of the request that the plan lacks, and the reverse."""
    rows = [(node, x) for node, x in plan.having(s.Rows) if isinstance(x, s.Rows)]
    if not all(_NUMBER.fullmatch(name) for _, row in rows for name in (row.first, row.last)):
        return
    counted_there = _counts_rows_of_area(facts, plan)
    ranks = {rank for _, row in rows for rank in _ranks(row.first, site)} if counted_there else set()
    beside = _BESIDE_ROWS.search(facts.text) is not None
    ranks |= {int(row.first) + step for _, row in rows for step in (-1, 1) if beside or _is_aisle_of(row, plan)}
    ranks |= _worked_from(facts, plan)
    for amount in facts.amounts:
        if int(amount.values[0]) in ranks or not _is_row(facts, amount) or _of_named_tree(facts, plan, amount):
            continue
        if any(True for _ in plan.having(s.Across)):
            continue  # "the plant opposite in row 2"
        if not any(_holds(row, amount) for _, row in rows) and not _has_named_tree(amount, plan, site):
            what_differs = message(
                "the request names row {row}, but the plan does not", row=Number(f"{amount.values[0]:g}")
            )
            yield PlanMismatch(kind="place", what=what_differs)
    if beside or facts.unknown or _SOME_ROWS.search(facts.text) or _PLANTED_FIRST.search(facts.text):
        return
    for node, row in rows:
        for name in dict.fromkeys((row.first, row.last)):
            if counted_there and _ranks(name, site) & {*facts.whole_numbers}:
                continue
            if int(name) > 1 and int(name) not in facts.whole_numbers and not _is_named_by_plants(name, facts, site):
                yield PlanMismatch(
                    kind="place",
                    what=message("the plan names row {name}, but the request does not", name=name),
                    node=node,
                )


def _worked_from(facts: RequestFacts, plan: PlanFacts) -> set[int]:
    """Return the rows of an aisle in which the robot drives for work on one side of a row; none without such work."""
    sides = {getattr(node, "sides", "one") for node in plan.nodes}
    numbers = {*facts.whole_numbers}
    return {n for n in numbers if numbers & {n - 1, n + 1}} if sides & {*_SIDES} and "between" in facts.words else set()


def _is_aisle_of(row: s.Rows, plan: PlanFacts) -> bool:
    """Return True if a place of the plan is in the aisle beside a row."""
    return any(row in x.walk() for _, x in plan.having(s.Beside))


def _counts_rows_of_area(facts: RequestFacts, plan: PlanFacts) -> bool:
    """Return True for "the second row of the cool section", an area of the plan."""
    names = (re.escape(_name_text(name)) for _, name in plan.areas)
    return any(re.search(rf"\brow(?: \d+)? (?:in|of) (?:\w+ )?{name}\b", facts.text) for name in names)


def _ranks(name: str, site: Site) -> set[int]:
    """Return which of its block's rows a row is, 1 for the first, for each block that has one of this name."""
    return {rank for block in site.planting.blocks for rank, row in enumerate(block.rows, start=1) if row.name == name}


def _is_named_by_plants(name: str, facts: RequestFacts, site: Site) -> bool:
    """Return True if the request names a row by what its plants are: "the pumpkin bed"."""
    spoken = {w.singular(word) for word in facts.words} | facts.words
    blocks = {_name_text(block.name) for block in site.planting.blocks}
    values = _values_in_row(name, site, shared=False) - blocks
    return any(set(value.split()) & spoken for value in values)


def _values_in_row(name: str, site: Site, *, shared: bool) -> set[str]:
    """Return what the attributes say of the plants of a row: values, and the names of those that are only yes or no.

    Args:
        name: Name of the row.
        site: The site.
        shared: True for those that all its plants have in common.
    """
    plants = [
        {
            _name_text(text)
            for attribute, value in site.trees[tree].properties.items()
            for text in ((attribute, f"un{attribute}") if isinstance(value, bool) else (str(value),))
        }
        for row in site.planting.rows
        if row.name == name
        for tree in row.trees
    ]
    return (set.intersection(*plants) if shared else set.union(*plants)) if plants else set()


def _is_row(facts: RequestFacts, amount: StatedAmount) -> bool:
    """Return True if a number names a row: "row 3", "the third row", but not "every third row"."""
    if amount.kind != "ordinal":
        return amount.kind == "row"
    after = [t.text for t in facts.tokens[amount.index + 1 : amount.index + 3]]
    before = [t.text for t in facts.tokens[max(0, amount.index - 2) : amount.index]]
    return "row" in (after[:1] or [""]) and not {"every", "each"} & set(before)


def _of_named_tree(facts: RequestFacts, plan: PlanFacts, amount: StatedAmount) -> bool:
    """Return True if a row only locates a tree that the plan names by its id: "tree 25 of row 2"."""
    named = {_digits(tree) for _, tree in plan.trees}
    return any(
        a.kind == "id" and 0 < amount.index - a.index <= 8 and str(int(a.values[0])) in named for a in facts.amounts
    )


def _has_named_tree(amount: StatedAmount, plan: PlanFacts, site: Site) -> bool:
    """Return True if a tree that the plan names by its id is in that row of the site."""
    planting, wanted = site.planting, int(amount.values[0])
    stands = {int(planting.row_of[site.by_id[tree].index]) for _, tree in plan.trees if tree in site.by_id}
    return any(row == wanted - 1 or planting.rows[row].name == str(wanted) for row in stands if row >= 0)


def _holds(row: s.Rows, amount: StatedAmount) -> bool:
    first, last = int(row.first), int(row.last)
    return first < 0 or last < 0 or min(first, last) <= amount.values[0] <= max(first, last)


def _areas(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield zones and blocks of the request that the plan lacks, and the reverse."""
    pointed = _pointed(plan)
    held = {_name_text(name) for _, name in plan.areas}
    rows = {t for _, x in plan.having(s.Rows) if isinstance(x, s.Rows) for t in (x.first.lower(), x.last.lower())}
    whole = any(one.along == s.Trees() for one in plan.works) or any(x == s.Trees() for _, x in plan.selectors)
    whole = whole and not any(
        isinstance(x, s.Edge) for _, x in plan.selectors
    )  # trees at the edge, not the edge itself
    whole |= any(isinstance(x, s.Transect) and x.shape == "edge" and not x.zone for _, x in plan.having(s.Transect))
    if whole or (not plan.areas and not any(isinstance(x, s.Edge) for _, x in plan.selectors)):
        held |= {_name_text(zone.name) for zone in site.zones if zone.kind == "boundary"}
    off = 1 if _BESIDE_ROWS.search(facts.text) else 0
    beds = {name for name in facts.zones if _is_a_row_of(name, plan, off)}
    in_names = {name for name in facts.zones if any(name in one.split() for one in _marks_named(facts, site))}
    for name in sorted(facts.zones - held - rows - beds - in_names):
        if name in w.COMPASS and w.COMPASS[name] <= pointed:
            continue  # "from the north" or "the northernmost" does not mean a block called "North"
        if _is_line_of_lanes(name, facts, plan) or _is_side_of_edge(name, facts, plan):
            continue
        if not any(name in other for other in held) and not _stands_in(plan, name, site):
            yield PlanMismatch(
                kind="place", what=message("the request names '{name}', but the plan does not", name=name)
            )
    whole_sites = {zone.name for zone in site.zones if zone.kind == "boundary"}
    for node, name in plan.areas:
        if name in whole_sites and not site.trees:
            continue  # "the four corners" are those of the site
        words = {t.text for t in _tokens(name)}
        words |= {f"{word}s" for word in words if name.rpartition(" ")[2].isdecimal()}  # "beds 2 to 6" name bed 3
        words |= {f"{word}s" for word in name.split()[:-1]}  # "the orchids" name the orchid patch
        words |= {
            f"{word}{end}" for word in name.split()[-1:] for end in ("s", "es")
        }  # "the two sections" name the warm section
        if facts.unknown or words & facts.words or name.isdecimal() or facts.words & {"each", "every", "all", "both"}:
            continue
        yield PlanMismatch(
            kind="place",
            what=message("the plan names '{name}', but the request does not", name=name[:40]),
            node=node,
        )
    if facts.words & _CHARGER and "charger" not in plan.markers and not facts.words & {"recharge", "recharging"}:
        yield PlanMismatch(kind="place", what=message("the request names the charger, but the plan does not"))


def _is_line_of_lanes(name: str, facts: RequestFacts, plan: PlanFacts) -> bool:
    """Return True if the lanes of a plan run in a direction, and the request names what they are parallel to."""
    said = re.search(
        rf"\b(?:parallel (?:to|with)|in line with|lined up with|line of) (?:\w+ )?{re.escape(name)}\b", facts.text
    )
    return said is not None and any(one.heading != "any" for one in plan.works)


def _is_side_of_edge(name: str, facts: RequestFacts, plan: PlanFacts) -> bool:
    """Return True if one side of an edge is worked, and the request names the area on that side: "the paddock side"."""
    said = re.search(rf"\b{re.escape(name)}(?:'?s)? side\b", facts.text)
    return said is not None and any(one.mode == "perimeter" and one.sides not in ("one", "both") for one in plan.works)


def _is_a_row_of(name: str, plan: PlanFacts, off: int = 0) -> bool:
    """Return True if an area that is named by its number may be one of the rows of a plan: "bed 4", which is row 4.

    Args:
        name: Name of the area.
        plan: The plan.
        off: Number of rows that may lie between: 1 for "the bed next to bed 4".
    """
    number = name.rpartition(" ")[2]
    rows = [x for _, x in plan.having(s.Rows) if isinstance(x, s.Rows)]
    if not number.isdecimal():
        return False
    bounds = [(row.first, row.last) for row in rows if row.first.isdecimal() and row.last.isdecimal()]
    return any(int(first) - off <= int(number) <= int(last) + off for first, last in bounds)


def _pointed(plan: PlanFacts) -> set[Side]:
    """Return all compass sides in a plan: of places, counts, directions and orders."""
    held: set[str] = set(plan.sides)
    for _, selector in plan.selectors:
        held |= {str(getattr(selector, name, "")) for name in ("counted_from", "side", "towards")}
        corners = (*getattr(selector, "which", ()), getattr(selector, "quarter", ""))
        held |= {side for side in _SIDES if any(side[0] in corner for corner in corners)}
        held |= {side for side in _SIDES if side in str(getattr(selector, "by", ""))}
    return {side for side in _SIDES if side in held}


def _runs_along(heading: str, side: Side) -> bool:
    """Return True if a direction of work is that of a side of the compass, or its opposite."""
    axis = ("north", "south") if side in ("north", "south") else ("east", "west")
    return any(one in heading for one in axis)


def _stands_in(plan: PlanFacts, name: str, site: Site) -> bool:
    """Return True if a tree that the plan names by its id is in the zone or block of that name."""
    from fieldhand.errors import PlaceError
    from fieldhand.places.context import Context
    from fieldhand.places.resolution import resolve

    named = {tree for _, tree in plan.trees if tree in site.by_id}
    if not named:
        return False
    called = [
        x for x in (*(z.name for z in site.zones), *(b.name for b in site.planting.blocks)) if _name_text(x) == name
    ]
    for zone in called:
        try:
            inside = resolve(s.InZone(zone=zone), site, Context(here=site.start))
        except PlaceError:
            continue
        if named & {place.id for place in inside}:
            return True
    return False


def _gates(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield gates of the request that the plan lacks, and the reverse."""
    held = {_name_text(x.gate): node for node, x in plan.having(s.GateIs) if isinstance(x, s.GateIs)}
    held |= {_name_text(only.gate): plan.task.composition.plan.id for only in plan.task.constraints.only_gates}
    for name in dict.fromkeys(_name_text(gate.place.id) for gate in site.gates):
        near_it = _SOME_HALF.search(facts.text) is not None
        if f" {name} " in f" {facts.text} " and not held and name not in facts.zones and not near_it:
            yield PlanMismatch(
                kind="place", what=message("the request names '{name}', but the plan does not", name=name)
            )
    for name, node in held.items():
        if not facts.unknown and not set(name.split()) & facts.words:
            yield PlanMismatch(
                kind="place",
                what=message("the plan names '{name}', but the request does not", name=name[:40]),
                node=node,
            )


def _name_text(name: str) -> str:
    return " ".join(t.text for t in _tokens(name))


def _tokens(name: str) -> tuple[w.Token, ...]:
    return w.tokens(name.replace("_", " "))


def _marks_named(facts: RequestFacts, site: Site) -> set[str]:
    """Return the names of markers and gates in the request: "south door"."""
    names = {_name_text(one) for _, one in site.marker_names} | {_name_text(gate.place.id) for gate in site.gates}
    return {name for name in names if name and f" {name} " in f" {facts.text} "}


def _sides(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield sides of the compass of the request that the plan lacks, and the reverse."""
    by_name = {word for name in (*facts.zones, *_marks_named(facts, site)) for word in name.split()}
    by_name |= set(facts.attributes)
    spoken = {side for side in facts.sides if not any(side in name for name in by_name)}
    corners = {letter for _, x in plan.having(s.Corners) if isinstance(x, s.Corners) for c in x.which for letter in c}
    orders = {x.by for _, x in plan.having(s.Ordered) if isinstance(x, s.Ordered)}
    counted = {getattr(x, "counted_from", "") for _, x in plan.selectors}
    held = (
        set(plan.sides) | counted | {side for side in spoken if side[0] in corners or any(side in by for by in orders)}
    )
    headings = [work.heading for work in plan.works if work.heading != "any"]
    held |= {side for side in spoken if any(_runs_along(heading, side) for heading in headings)}
    held |= {work.sides for work in plan.works}
    if not any(x.counts_from_a_side for _, x in plan.selectors):
        for side in sorted(spoken - held):
            yield PlanMismatch(
                kind="side",
                what=message("the request says '{side}', but no place of the plan is there", side=side),
            )
    if facts.unknown or facts.words & w.VAGUE_SIDES or _OTHER_PART.search(facts.text) or _SOME_HALF.search(facts.text):
        return
    around = len(plan.sides) == 4 and not spoken  # each quarter, or the whole edge
    ends = frozenset() if facts.sides else plan.ends_driven
    faced = {x.part for _, x in plan.having(s.Transect) if isinstance(x, s.Transect) and x.shape == "edge"}
    if faced and _SOME_SIDES.search(facts.text):
        ends |= {side for side in _SIDES if side in faced}  # "on the paddock side", "at both ends"
    if "between" in facts.words:
        beside = [getattr(x, "side", "") for _, x in plan.having(s.Beside)]
        ends |= {side for side in _SIDES if side in beside}  # in the aisle between two rows
    for side, node in plan.sides.items():
        if side not in facts.sides and not around and side not in ends:
            yield PlanMismatch(
                kind="side",
                what=message("the plan goes to the {side}, which the request does not mention", side=side),
                node=node,
            )
    for by in sorted(orders):
        if "_to_" in by and not any(side in by for side in facts.sides) and not _REVERSED.search(facts.text):
            yield PlanMismatch(
                kind="order",
                what=message(
                    "the plan goes {direction}, but the request does not say so", direction=by.replace("_", " ")
                ),
            )


def _rows_left_out(value: str, facts: RequestFacts, plan: PlanFacts, site: Site) -> bool:
    """Return True if a plan lists rows, and leaves out those whose plants share a value: "but not the lettuce"."""
    if not any(token.text in _LEAVES_OUT for token in facts.tokens):
        return False
    listed = [(x.first, x.last) for _, x in plan.having(s.Rows) if isinstance(x, s.Rows) and x.first]
    named = {first for first, last in listed if first == last}
    own = {row.name for row in site.planting.rows if value in _values_in_row(row.name, site, shared=True)}
    return len(named) > 1 and len(named) == len(set(listed)) and bool(own) and own.isdisjoint(named)


def _attributes(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield attribute values of the request that the plan lacks, and the reverse."""
    held = {" ".join(t.text for t in _tokens(str(value))) for _, _, value in plan.values}
    for name in {end for _, x in plan.having(s.Rows) if isinstance(x, s.Rows) for end in (x.first, x.last) if end}:
        held |= _values_in_row(name, site, shared=True)
    for tree in {tree for _, tree in plan.trees if tree in site.by_id}:
        held |= {_name_text(str(value)) for value in site.by_id[tree].properties.values()}
    by_neighbours = bool(plan.trees and _BESIDE_THEM.search(facts.text)) or _BESIDE_ROWS.search(facts.text) is not None
    for word in facts.attributes:
        if _rows_left_out(word, facts, plan, site):
            continue
        if not by_neighbours and not any(word in other or other in word for other in held):
            yield PlanMismatch(
                kind="attribute",
                what=message("the request says '{word}', but the plan does not ask for that", word=word),
            )
    if facts.unknown:
        return
    stems = {w.singular(word) for word in facts.words}
    for node, attribute, value in plan.values:
        words = {t.text for t in _tokens(str(value))}
        if facts.words & _EACH_KIND and stems & {w.singular(t.text) for t in _tokens(attribute)}:
            continue  # the plan covers each variety
        if isinstance(value, str) and not is_date(value) and not words & (facts.words | stems):
            yield PlanMismatch(
                kind="attribute",
                what=message(
                    "the plan asks for {attribute} '{value}', which the request does not mention",
                    attribute=attribute,
                    value=value[:40],
                ),
                node=node,
            )


def _ends(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield a requested return that is neither the exit of the plan nor a drive in it."""
    if not facts.returns or facts.returns not in site.markers:
        return
    wanted = f"return_to_{facts.returns}"
    driven = any(
        n.only_drives and n.selector is not None and n.selector.named_marker == facts.returns for n in plan.nodes
    )
    composition = plan.task.composition
    ends = {composition.nominal, *(end for watch in composition.watches for end in (watch.response, watch.fallback))}
    if wanted not in ends and not driven:
        yield PlanMismatch(
            kind="return",
            what=message("the request ends at the {marker}, but the plan does not", marker=facts.returns),
        )


def _faults(facts: RequestFacts, plan: PlanFacts, site: Site) -> Iterator[PlanMismatch]:
    """Yield reactions to faults that are not the usual ones and were not requested."""
    if facts.unknown or facts.words & _OF_FAULTS or not site.markers:
        return
    usual = {e.fault: e.then for e in FAULTED_EXITS}
    for chosen in plan.task.composition.faulted:
        if chosen.then not in (usual[chosen.fault], plan.task.composition.nominal):
            what = f"{chosen.fault} is answered by {chosen.then}".replace("_", " ")
            what_differs = message(
                "the plan changes what happens after a fault ({what}), which the request does not ask for", what=what
            )
            yield PlanMismatch(kind="return", what=what_differs)


def _order(facts: RequestFacts, plan: PlanFacts) -> Iterator[PlanMismatch]:
    """Yield a mismatch if trees requested "in that order" are planned in another order."""
    if not any(phrase in facts.text for phrase in ("in that order", "in this order", "in the given order")):
        return
    numbers = [str(int(a.values[0])) for a in facts.amounts if a.kind == "id" and not a.through]
    named = [_digits(tree) for _, tree in plan.trees]
    if len(set(numbers)) == len(numbers) > 1 and sorted(named) == sorted(numbers) and named != numbers:
        yield PlanMismatch(
            kind="order",
            what=message(
                "the request gives the order {requested}, the plan {planned}",
                requested=", ".join(numbers),
                planned=", ".join(named),
            ),
        )
    free = [n for n in plan.nodes if n.in_any_order]
    given = any(n.keeps_order for n in plan.nodes)
    if free and not given:
        yield PlanMismatch(
            kind="order", what=message("the request fixes an order, but the plan leaves it open"), node=free[0].id
        )
