"""Rows and blocks in noun phrases: "row 3", "the second row from the east", "every other row", "two rows over"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places import selectors as s
from fieldhand.planning.english.asking import how_many
from fieldhand.planning.english.attributes import filtered
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.onebyone import one_by_one
from fieldhand.planning.english.rowwords import From, Over
from fieldhand.planning.english.sets import Group
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.english.ways import blocks_named, check_over, side_across
from fieldhand.planning.selections import is_in_block
from fieldhand.site.model import Site
from fieldhand.terms import CountedFrom

_WHICH = message("say which: 'row 3', 'the westernmost row', 'every other row'")


def speaks_of_rows(bag: Bag) -> bool:
    """Whether a phrase is about rows or blocks themselves."""
    return bag.has("ROW", "ROWIDS", "BLOCKIDS", "OVER")


def rows_meant(bag: Bag, group: Group, size: int | None, site: Site) -> FoundPlace:
    """The rows or blocks of a phrase, as an area.

    Args:
        group: What describes the rows.
        size: Trees that the row is said to have ("a row of 5 trees").

    Raises:
        Unclear, Question: A word of it could not be placed, or it leaves open which rows.
    """
    check_rows(bag, site)
    if group.anchor is not None:
        raise bag.fault(message("it does not say which row"), message("say 'the next row', or 'two rows to the east'"))
    head = next(word for kind in ("ROW", "ROWIDS", "BLOCKIDS", "OVER") for word in bag.words(kind))
    valued = bag.take_behind("ATTRVAL", head.start)  # "the rows ... that are yellow": their trees are
    compared, bag.compared = bag.compared, []
    if bag.has("BLOCKIDS"):
        found = _blocks(bag, group.area, site)
    elif bag.has("OVER"):
        found = _over(bag, group, site)
    elif bag.has("ROWIDS"):
        found = _numbered(bag, group.area, site)
    else:
        found = _described(bag, group, size, site)
        size = None
    if size is not None:
        raise bag.fault(message("rows cannot be selected by their number of trees"), message("leave the number out"))
    bag.put("ATTRVAL", valued)
    bag.compared = [terms for terms in compared if terms[0].start > head.start]
    tested = filtered(bag, found.selector, site)
    bag.compared = [terms for terms in compared if terms[0].start < head.start]
    bag.finish()
    if group.row_of is not None and all(part.row_of is None for part in found.selector.walk()):
        raise bag.fault(message("it names two different rows"), _WHICH)
    found = replace(found, assumed=(*found.assumed, *group.assumed))
    kept = group.kept(tested)
    return found if kept == found.selector else replace(found, selector=kept, one_by_one=_each(found, kept, site))


def check_rows(bag: Bag, site: Site) -> None:
    """A site whose trees stand in no rows has none to speak of.

    Raises:
        Unclear: It has none.
    """
    if not site.planting.blocks:
        why = message("no rows were found on this site")
        if site.planting.why:
            why = message("{what} ({why})", what=why, why=site.planting.why)
        advice = message("name trees by id, side, corner or attribute, or give the rows in the site's file")
        raise bag.fault(why, advice)


def _blocks(bag: Bag, of: s.Selector, site: Site) -> FoundPlace:
    named = bag.take("BLOCKIDS")
    bag.any = False
    known = {block.name.lower(): block.name for block in site.planting.blocks}
    known |= {str(k): block.name for k, block in enumerate(site.planting.blocks, start=1) if str(k) not in known}
    names: list[str] = []
    for first, last in () if named is None else named.value:
        names += [first] if first == last else _between(bag, first, last, list(known.values()))
    for name in names:
        if name.lower() not in known:
            there = ", ".join(block.name for block in site.planting.blocks)
            raise bag.fault(
                message("there is no block '{name}'", name=name),
                message("this site has block {there}", there=there),
            )
    blocks = tuple(s.InBlock(block=known[name.lower()], of=of) for name in dict.fromkeys(names))
    one = blocks[0] if len(blocks) == 1 else s.UnionOf(parts=blocks)
    return FoundPlace(
        selector=one, many=True, region=True, rows=True, each=bag.each, one_by_one=blocks if bag.each else ()
    )


def unnamed_block(bag: Bag, site: Site) -> bool:
    """Whether a phrase speaks of a block, and does not say which of several."""
    words = bag.words("PLOT")
    return any(t.text.lower() in ("block", "blocks") for t in words) and len(site.planting.blocks) > 1


def some_block(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "Each block", "the block": all of them, one by one, or a question which."""
    names = tuple(block.name for block in site.planting.blocks)
    plural = any(t.plural for t in bag.words("PLOT"))
    if not bag.each or not bag.only("PLOT") or bag.count not in (None, len(names)) or group.anchor is not None:
        raise Question(
            message("'{said}': which blocks?", context="question", said=text_of(bag.phrase.terms))
            if plural
            else message("'{said}': which block?", context="question", said=text_of(bag.phrase.terms)),
            tuple(message("block {name}", context="answer", name=name) for name in names[:6]),
            terms=bag.phrase.terms,
        )
    bag.take("PLOT")
    bag.finish()
    of = group.kept(group.area)
    blocks = tuple(s.InBlock(block=name, of=of) for name in names)
    return FoundPlace(
        selector=s.UnionOf(parts=blocks), many=True, region=True, rows=True, each=True, one_by_one=blocks,
        assumed=group.assumed,
    )  # fmt: skip


def _between(bag: Bag, first: str, last: str, names: list[str]) -> list[str]:
    if first not in names or last not in names or names.index(last) < names.index(first):
        raise bag.fault(
            message("no blocks go from '{first}' to '{last}'", first=first, last=last),
            message("name each of them"),
        )
    return names[names.index(first) : names.index(last) + 1]


def _over(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "Two rows over", "the next row": from the row of the tree in hand."""
    said = bag.take("OVER")
    over: Over = said.value if said is not None else Over(rows=1)
    bag.take("ROW")
    if bag.has("TREE", "PLACE") or bag.count is not None:
        raise bag.fault(
            message("it is not clear which tree is meant"), message("say 'the tree two rows over', or 'the next row'")
        )
    bag.any = False
    origin = group.row_of or s.Here()
    ways = {block.runs_east_west for block in blocks_named(origin, site)}
    rows = over.rows
    assumed: str = ""
    if over.side:
        check_over(bag, over.side, origin, site, message("no row lies further {side}", side=COMPASS[over.side]))
        if len(ways) > 1:  # the selection counts rows by their numbers: a side along them would be lost
            raise bag.fault(
                message("the rows of this site run different ways"), message("name the row, or say 'the next row'")
            )
        rows = -rows if over.side in ("west", "north") else rows
    else:
        words, way = text_of(bag.phrase.terms), _way(rows, ways)
        higher = message(
            "'{said}' is counted towards higher row numbers ({compass}).", context="assumption", said=words, compass=way
        )
        lower = message(
            "'{said}' is counted towards lower row numbers ({compass}).", context="assumption", said=words, compass=way
        )
        assumed = higher if rows > 0 else lower
    selector = s.RowOf(origin=origin, over=rows, of=group.area)
    return FoundPlace(selector=selector, many=True, region=True, rows=True, assumed=(assumed,) if assumed else ())


def _way(rows: int, ways: set[bool]) -> str:
    sides = {("south" if way else "east") if rows > 0 else ("north" if way else "west") for way in ways}
    return " or ".join(sorted(sides))


def _numbered(bag: Bag, of: s.Selector, site: Site) -> FoundPlace:
    """Rows by their numbers or names."""
    named = bag.take("ROWIDS")
    every = bag.take("EVERYNTH")
    bag.any = False
    ranges: tuple[tuple[str, str], ...] = () if named is None else named.value
    for first, last in ranges:
        for name in dict.fromkeys((first, last)):
            _in_one_block(bag, f"row {name}", name, of, site)
    if bag.count is not None and len(ranges) != bag.count and all(first == last for first, last in ranges):
        raise bag.fault(
            message("{count} or {names} rows?", count=bag.count, names=len(ranges)),
            message("make the number and the names agree"),
        )
    nth = 1 if every is None else int(every.value)
    if every is not None and (len(ranges) > 1 or ranges[0][0] == ranges[0][1]):
        raise bag.fault(
            message("every second, third, ... row, and of which rows?"),
            message("say 'every third row starting with row 2', for example"),
        )
    areas = of.members if all(is_in_block(part) for part in of.members) else (of,)
    parts = tuple(s.Rows(first=first, last=last, every=nth, of=area) for area in areas for first, last in ranges)
    selector = parts[0] if len(parts) == 1 else s.UnionOf(parts=parts)
    return _area(selector, bag, site, several=(named is not None and named.plural) or len(areas) > 1)


def _described(bag: Bag, group: Group, size: int | None, site: Site) -> FoundPlace:
    """Rows by rank, by side, by "every", or as a row spoken of."""
    of = group.area
    row = bag.take("ROW")
    plural = bool(row and row.plural)
    counted: Term | None = bag.take("COUNTEDFROM")
    start: From = counted.value if counted is not None else From()
    if size is not None:
        return _of_size(bag, of, size)
    if (every := bag.take("EVERYNTH")) is not None:
        begin = bag.take("STARTNTH")
        kind, first = begin.value if begin is not None else ("row", "")
        if kind == "tree" or bag.count is not None or start.far:
            raise bag.fault(
                message("every second, third, ... row, and counted from where?"),
                message("say 'every third row starting with row 2'"),
            )
        called = f"row {first}"
        if kind == "parity":
            if not plural and every.text.split()[0].lower() not in ("every", "each"):
                raise Question(message("'{said}': which row?", context="question", said=text_of(bag.phrase.terms)))
            _check_numbers(bag, of, site)
            called = f"the {text_of(bag.phrase.terms)}".replace("the the", "the")
        if first:
            _in_one_block(bag, called, first, of, site)
        rows = s.Rows(first=first, every=int(every.value), counted_from=side_across(bag, start.side, of, site), of=of)
        bag.each = True
        return _area(rows, bag, site, several=True)
    ranked = _ranked(bag, start, of, site)
    if ranked is not None:
        return ranked
    if counted is not None or bag.any:
        raise bag.fault(message("it does not say which row"), _WHICH)
    if bag.has("MIDDLE"):
        return _middle(bag, of, site)
    if (bag.each or (plural and bag.definite)) and not bag.pointing:
        rows = s.Rows(of=of)
        there = len(one_by_one(rows, site))
        if bag.count is not None and bag.count != there:
            asked = message(
                "'{said}': there are {there} rows, not {count}",
                context="question",
                said=text_of(bag.phrase.terms),
                there=there,
                count=bag.count,
            )
            every_row = message("all of them", context="answer")
            raise Question(asked, (every_row,), terms=bag.phrase.terms, words=("all rows",))
        return _area(rows, bag, site, several=True)
    same = bag.take("SAME") is not None
    if (bag.definite or same or bag.article in ("its", "their")) and not plural and bag.count in (None, 1):
        origin = group.row_of or s.Here()
        return FoundPlace(selector=s.RowOf(origin=origin, of=of), many=True, region=True, rows=True)
    some = tuple(_row(row.name) for row in site.planting.rows[:3])
    which = message("'{said}': which row?", context="question", said=text_of(bag.phrase.terms))
    if plural:
        which = message("'{said}': which rows?", context="question", said=text_of(bag.phrase.terms))
    raise Question(which, some, terms=bag.phrase.terms)


def _check_numbers(bag: Bag, of: s.Selector, site: Site) -> None:
    """Rows are even or odd where they are called by their numbers, and none is left out.

    Raises:
        Unclear: They have other names.
    """
    for block in blocks_named(of, site):
        if [row.name for row in block.rows] != [str(k) for k in range(1, len(block.rows) + 1)]:
            raise bag.fault(
                message("these rows are not numbered one after the other"),
                message("say 'every other row', or name the rows"),
            )


def _of_size(bag: Bag, of: s.Selector, size: int) -> FoundPlace:
    """ "A row of 5 trees": 5 trees of one row, one after the other."""
    if bag.definite or bag.each or bag.count not in (None, 1) or not bag.only():
        raise bag.fault(message("it does not say which rows"), message("say 'a row of 5 trees', or name the row"))
    bag.any = False
    return FoundPlace(selector=s.Successive(count=size, of=of), many=size > 1, region=True, rows=True, counted=size)


def _ranked(bag: Bag, start: From, of: s.Selector, site: Site) -> FoundPlace | None:
    """ "The third row", "the last two rows", "the westernmost row", "the second row from the east"."""
    most, rank, behind = bag.take("MOST"), bag.take("ORD"), bag.take("BACKORD")
    last = bag.take("LAST")
    if most is None and rank is None and behind is None and last is None:
        return None
    if sum(t is not None for t in (last, behind)) + (start.far and rank is not None) > 1 or bag.has("EVERYNTH"):
        raise bag.fault(message("it names two different rows"), _WHICH)
    side: CountedFrom = start.side
    if most is not None:
        if start != From() or len(most.value) == 2 or last is not None or behind is not None:
            raise bag.fault(message("it names two different rows"), _WHICH)
        side = most.value
    side = side_across(bag, side, of, site)
    number = int(rank.value) if rank is not None else int(behind.value) if behind is not None else 1
    count = bag.count or 1
    if count > 1 and number > 1:
        raise bag.fault(message("a rank cannot be combined with several rows"), message("say which one, or how many"))
    if bag.plural and bag.count is None:
        raise how_many(bag.phrase)
    first, end = (number, number + count - 1)
    if last is not None or behind is not None or start.far:
        first, end = -end, -first
    bag.any = False
    _in_one_block(bag, f"the {text_of(bag.phrase.terms)}".replace("the the", "the"), "", of, site)
    blocks = blocks_named(of, site)
    if side == "usual" and first > 0 and not any(str(first) == row.name for block in blocks for row in block.rows):
        side = "north" if blocks[0].runs_east_west else "west"  # by number, whatever the names are
    rows = s.Rows(first=str(first), last=str(end), counted_from=side, of=of)
    return _area(rows, bag, site, several=count > 1)


def _middle(bag: Bag, of: s.Selector, site: Site) -> FoundPlace:
    bag.take("MIDDLE")
    _in_one_block(bag, "the middle row", "", of, site)
    blocks = blocks_named(of, site)
    if len(blocks) > 1:
        raise bag.fault(message("blocks have a middle row each"), message("name the block"))
    rows = blocks[0].rows
    if len(rows) % 2 == 0 or bag.plural or bag.count not in (None, 1):
        half = len(rows) // 2
        choices = tuple(_row(row.name) for row in rows[half - 1 : half + 1])
        raise Question(
            message(
                "'{said}': there are {count} rows", context="question", said=text_of(bag.phrase.terms), count=len(rows)
            ),
            choices,
            terms=bag.phrase.terms,
        )
    number = rows[len(rows) // 2].name
    return _area(s.Rows(first=number, last=number, of=of), bag, site, several=False)


def _in_one_block(bag: Bag, called: str, name: str, of: s.Selector, site: Site) -> None:
    """Which block's row is meant has to be said where several have such a row.

    Raises:
        Question: It does not say.
    """
    if is_in_block(of):
        return
    blocks = [
        block
        for block in site.planting.blocks
        if not name or any(name.lower() in (row.name.lower(), str(row.number)) for row in block.rows)
    ]
    exact = [block for block in blocks if name and any(name == row.name for row in block.rows)]
    if exact and not name.isdigit():
        blocks = exact
    if len(blocks) > 1:
        choices = tuple(
            message("{row} of block {name}", context="answer", row=called, name=block.name) for block in blocks[:6]
        )
        raise Question(
            message("'{said}': of which block?", context="question", said=text_of(bag.phrase.terms)),
            choices,
            terms=bag.phrase.terms,
        )


def _area(selector: s.Selector, bag: Bag, site: Site, *, several: bool) -> FoundPlace:
    """Rows as an area; each by itself where the words say so, or there are several."""
    each = bag.each
    ones = one_by_one(selector, site) if each else ()
    return FoundPlace(selector=selector, many=True, region=True, rows=True, each=each and several, one_by_one=ones)


def _each(found: FoundPlace, kept: s.Selector, site: Site) -> tuple[s.Selector, ...]:
    return one_by_one(kept, site) if found.one_by_one else ()


def _row(name: str) -> str:
    """Return a row as a choice to answer with."""
    return message("row {name}", context="answer", name=name)
