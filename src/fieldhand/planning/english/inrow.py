"""Trees by their place in a row: "the third tree of row 2", "every third tree", "5 trees down", "across the aisle"."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fieldhand.language import message
from fieldhand.language.words import COMPASS
from fieldhand.places import selectors as s
from fieldhand.planning.english.asking import how_many
from fieldhand.planning.english.attributes import filtered
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.bare import named_trees
from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.rows import check_rows
from fieldhand.planning.english.rowwords import From, Steps
from fieldhand.planning.english.sets import Group
from fieldhand.planning.english.ways import check_over, side_along, trees_named
from fieldhand.planning.selections import as_where
from fieldhand.site.model import Site
from fieldhand.terms import CountedFrom, Towards

_AMBIGUOUS_ENDS = (
    message("the northern one", context="answer"),
    message("the southern one", context="answer"),
    message("both", context="answer"),
)
_ENDS_IN_WORDS = ("the northern end", "the southern end", "both ends")


def named_in_rows(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "Trees 4 to 9 of row 2": by their numbers in the row, not by their ids.

    Raises:
        Question: Trees with these ids stand in the row too, at other places.
    """
    check_rows(bag, site)
    if group.anchor is None and _only_ids(bag) and set(bag.ids) <= trees_named(group.kept(group.area), site):
        return replace(named_trees(bag), assumed=group.assumed)
    if _says_id(bag) or any(not name.isdigit() for name in bag.ids):
        raise bag.fault(
            message("not all of these trees stand in those rows"), message("leave the row out, or name other trees")
        )
    if group.anchor is not None or _only_ids(bag):
        raise bag.fault(message("trees in a row are counted from 1"), message("say 'tree 4 of row 2', for example"))
    if bag.count is not None and bag.count != len(bag.ids):
        raise bag.fault(
            message("{count} or {names} trees?", count=bag.count, names=len(bag.ids)),
            message("make the number and the names agree"),
        )
    if bag.any:
        raise Question(
            message("'{said}': how many of them?", context="question", said=text_of(bag.phrase.terms)),
            ("1", message("all {count}", context="answer", count=len(bag.ids))),
        )
    numbers = sorted({int(name) for name in bag.ids})
    spans: list[tuple[int, int]] = []
    for number in numbers:
        if spans and number == spans[-1][1] + 1:
            spans[-1] = (spans[-1][0], number)
        else:
            spans.append((number, number))
    of = group.kept(group.area)
    counted = bag.take("COUNTEDFROM")
    if counted is not None and counted.value.far:
        raise bag.fault(message("from which side are they counted?"), message("say 'from the north', for example"))
    side: CountedFrom = "usual" if counted is None else counted.value.side
    parts = tuple(s.InRow(first=first, last=last, counted_from=side, of=of) for first, last in spans)
    selector: s.Selector = parts[0] if len(parts) == 1 else s.UnionOf(parts=parts)
    several = several_rows(of, group, site)
    if not several and counted is None and _by_id(bag, of, selector, site):
        trees = tuple(s.TreeIs(tree=name) for name in bag.ids)
        selector = trees[0] if len(trees) == 1 else s.UnionOf(parts=trees)
    bag.finish()
    many = len(numbers) > 1 or several
    return FoundPlace(selector=selector, many=many, each=bag.each or bool(group.one_by_one), assumed=group.assumed)


def excepted_in_rows(bag: Bag, group: Group, site: Site) -> s.Selector:
    """ "The trees of row 3 except trees 40 and 41": by their ids where all of these stand there, else by their numbers.

    Raises:
        Question: Both can be meant.
        Unclear: Neither can.
    """
    trees = s.UnionOf(parts=tuple(s.TreeIs(tree=name) for name in bag.ids))
    by_id = trees.parts[0] if len(bag.ids) == 1 else trees
    whole = trees_named(group.area, site)
    known = not group.area.relative
    if _only_ids(bag):
        if known and not set(bag.ids) <= whole:
            raise bag.fault(
                message("not all of these trees stand in those rows"), message("leave out the ones that do not")
            )
        return by_id
    text = text_of(bag.phrase.terms)
    numbers = [s.InRow(first=int(name), last=int(name), of=group.area) for name in bag.ids]
    counted = [trees_named(one, site) for one in numbers]
    in_rows = [name in whole for name in bag.ids]
    if not known or (all(counted) and all(in_rows) and set().union(*counted) != set(bag.ids)):
        raise Question(
            message("'{said}': by the number in the row, or by the tree's id?", context="question", said=text),
            (
                message("the {nth} tree of the row, and so on", context="answer", nth=_nth(int(bag.ids[0]))),
                message("the tree with id {ids}", context="answer", ids=bag.ids[0]),
            ),
        )
    if all(in_rows):
        return by_id
    if any(in_rows) or not all(counted):
        raise bag.fault(
            message("not all of these trees stand in those rows"), message("leave out the ones that do not")
        )
    return named_in_rows(bag, group, site).selector


def _only_ids(bag: Bag) -> bool:
    """Whether trees are named by what can be no numbers in a row: "T12", "the tree with id 12"."""
    return any(not name.isdigit() or int(name) < 1 for name in bag.ids) or _says_id(bag)


def _says_id(bag: Bag) -> bool:
    return any({"id", "ids"} & set(t.text.lower().split()) for t in bag.phrase.terms if t.kind == "IDS")


def _by_id(bag: Bag, of: s.Selector, selector: s.Selector, site: Site) -> bool:
    """ "Tree 7 in row 3" may be the seventh of the row, or the tree whose id is 7 and that stands there."""
    by_place, in_row = trees_named(selector, site), trees_named(of, site)
    by_id = set(bag.ids) & in_row
    if by_place and by_id == set(bag.ids) and by_place != by_id:
        first = bag.ids[0]
        raise Question(
            message(
                "'{said}': by the number in the row, or by the tree's id?",
                context="question",
                said=text_of(bag.phrase.terms),
            ),
            (
                message("the {nth} tree of the row, and so on", context="answer", nth=_nth(int(first))),
                message("the tree with id {first}", context="answer", first=first),
            ),
            terms=bag.phrase.terms,
            words=(f"the {_nth(int(first))} tree", f"the tree with id {first}") if len(bag.ids) == 1 else ("", ""),
        )
    return not by_place and by_id == set(bag.ids)


def _nth(number: int) -> str:
    ending = "th" if 10 <= number % 100 <= 20 else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    match ending:
        case "st":
            return message("{number}st", context="tree", number=number)
        case "nd":
            return message("{number}nd", context="tree", number=number)
        case "rd":
            return message("{number}rd", context="tree", number=number)
    return message("{number}th", context="tree", number=number)


def several_rows(of: s.Selector, group: Group, site: Site) -> bool:
    """Whether a selection may hold trees of several rows."""
    if group.one_by_one:
        return True
    if of.relative:
        return False
    index = [site.by_id[name].index for name in trees_named(of, site) if name in site.by_id]
    return len(set(site.planting.row_of[index].tolist())) > 1


def ranked_in_rows(bag: Bag, of: s.Selector, group: Group, site: Site) -> FoundPlace:
    """ "The first three trees of every row", "the last tree of row 3", "the third tree from the end of row 2"."""
    check_rows(bag, site)
    rank, last, behind = bag.take("ORD"), bag.take("LAST"), bag.take("BACKORD")
    if group.anchor is not None:
        raise bag.fault(message("it names two different trees of the row"), message("say 'the third tree of row 2'"))
    counted = bag.take("COUNTEDFROM")
    start: From = counted.value if counted is not None else From()
    if sum(t is not None for t in (rank, last, behind)) != 1 or (start.far and rank is None):
        raise bag.fault(message("it names two different trees of the row"), message("say 'the third tree of row 2'"))
    tree = bag.take("TREE", "PLACE")
    if tree is None:
        raise bag.fault(message("it does not say which trees"), message("say 'the third tree of row 2'"))
    number = int(rank.value) if rank is not None else int(behind.value) if behind is not None else 1
    if bag.count is not None and number > 1:
        raise bag.fault(
            message("a rank cannot be combined with several trees"),
            message("say which one, or how many: 'trees 4 to 6 of row 2'"),
        )
    if tree.plural and bag.count is None and number == 1:
        raise how_many(bag.phrase)
    if group.along and rank is not None and group.rows is not None and group.rows.row_of and start == From():
        text = text_of(bag.phrase.terms)
        raise Question(
            message("'{said}': counted from the end of the row, or from here?", context="question", said=text),
            (message("from the end of the row", context="answer"), message("from here", context="answer")),
        )
    first, end = number, number + (bag.count or 1) - 1
    if last is not None or behind is not None or start.far:
        first, end = -end, -first
    many = end > first or several_rows(of, group, site)
    selector = s.InRow(first=first, last=end, counted_from=side_along(bag, start.side, of, site), of=of)
    return FoundPlace(selector=selector, many=many, each=bag.each or bool(group.one_by_one))


def ends_of_rows(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "Both ends of each row", "the northern end of row 4", "the start of row 2"."""
    of = group.kept(filtered(bag, group.area, site))
    start, finish = bag.take("START"), bag.take("FINISH")
    tree = bag.take("TREE", "PLACE")
    direction, most = bag.take("DIR"), bag.take("MOST")
    side: CountedFrom = "usual"
    for said in (direction, most):
        if said is not None:
            if len(said.value) == 2:
                raise bag.fault(message("a row has an end on one side"), message("say north, east, south or west"))
            side = side_along(bag, said.value, of, site)
    plural = bool((finish and finish.plural) or (tree and tree.plural) or bag.count == 2)
    if bag.count not in (None, 1, 2) or (start is not None and (plural or side != "usual")):
        raise bag.fault(message("a row has two ends"), message("say 'both ends of row 3'"))
    first = s.InRow(first=1, last=1, counted_from=side, of=of)
    last = s.InRow(first=-1, last=-1, of=of)
    several = several_rows(of, group, site)
    each = bag.each or bool(group.one_by_one)
    if group.anchor is not None:  # "the end of row 3 nearest to the charger"
        if plural or bag.each or bag.any or start is not None or side != "usual" or several:
            raise bag.fault(message("it names two different ends"), message("say 'the northern end of row 3'"))
        bag.take("NEAREST")
        nearest = s.Nearest(to=group.anchor, of=s.UnionOf(parts=(first, last)))
        return FoundPlace(selector=nearest, counted=1, assumed=group.assumed)
    if start is not None or side != "usual":
        bag.any = False
        return FoundPlace(selector=first, many=several, each=each, assumed=group.assumed)
    if bag.any or bag.article in ("a", "an"):
        asked = message("'{said}': which of the two ends?", context="question", said=text_of(bag.phrase.terms))
        raise Question(asked, _AMBIGUOUS_ENDS, terms=bag.phrase.terms, words=_ENDS_IN_WORDS)
    if plural or bag.each:
        return FoundPlace(selector=s.UnionOf(parts=(first, last)), many=True, each=each, assumed=group.assumed)
    said_as = message(
        "'{said}' is the one where the count along the row ends.", context="assumption", said=text_of(bag.phrase.terms)
    )
    return FoundPlace(selector=last, many=several, each=each, assumed=(*group.assumed, said_as))


def every_nth(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "Every third tree": what stands before the noun is what is counted, what stands behind it is tested then."""
    check_rows(bag, site)
    every, begin = bag.take("EVERYNTH"), bag.take("STARTNTH")
    tree = bag.take("TREE", "PLACE")
    if every is None or tree is None or bag.count is not None or group.anchor is not None:
        raise bag.fault(
            message("every second, third, ... tree, and of which trees?"),
            message("say 'every third tree of row 2', for example"),
        )
    if bag.has("ORD", "LAST", "SUPER", "NEAREST", "NEARBY", "FARTHEST", "FAR", "OTHER", "DIR"):
        raise bag.fault(
            message("every second, third, ... tree, and of which trees?"), message("say it in two requests")
        )
    kind, start = begin.value if begin is not None else ("tree", "1")
    if kind == "row":
        raise bag.fault(
            message("counting trees has to begin at a tree"), message("say 'starting with the second tree'")
        )
    behind, compared = bag.take_behind("ATTRVAL", tree.start), bag.compared
    bag.compared = [group_ for group_ in compared if group_[0].start < tree.start]
    tested = [group_ for group_ in compared if group_[0].start > tree.start]
    area, tests = parted(group.area)
    inner = filtered(bag, area, site)
    counted = bag.take("COUNTEDFROM")
    side: CountedFrom = "usual" if counted is None else counted.value.side
    if counted is not None and counted.value.far:
        raise bag.fault(message("from which side are they counted?"), message("say 'from the north', for example"))
    selector: s.Selector = s.EveryNth(nth=int(every.value), start=int(start), counted_from=side, of=inner)
    for test in reversed(tests):
        selector = replace(test, of=selector)
    bag.compared = tested
    bag.put("ATTRVAL", behind)
    selector = group.kept(filtered(bag, selector, site))
    bag.take("PLOT")
    return FoundPlace(selector=selector, many=True, each=True)


def parted(area: s.Selector) -> tuple[s.Selector, list[s.Where]]:
    """An area without tests of attributes, and these, outermost first.

    "Every third tree of row 2 that is older than 10 years": the test stands in the phrase of the row, and it is the
    trees that are counted that are tested.
    """
    tests: list[s.Where] = []
    tested = as_where(area)
    if tested is not None:
        inner, tests = parted(tested.of)
        return inner, [tested, *tests]
    if area.members != (area,):
        found = [parted(part) for part in area.members]
        if all(one[1] == found[0][1] for one in found):
            return s.UnionOf(parts=tuple(one[0] for one in found)), found[0][1]
    of = getattr(area, "of", None)
    if of is None:
        return area, []
    inner, tests = parted(of)
    outer: Any = area
    return replace(outer, of=inner), tests


def stepped(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "5 trees down": along the row of the tree in hand, or of another one."""
    check_rows(bag, site)
    said = bag.take("STEP")
    steps: Steps = said.value if said is not None else Steps(trees=1)
    bag.take("TREE", "PLACE")
    bag.take("OTHER")
    if bag.count is not None or bag.each or bag.any or bag.has("NEAREST", "NEARBY") or not group.plain:
        raise bag.fault(
            message("it is not clear which tree is meant"), message("say 'the tree 5 trees down the row from tree 12'")
        )
    origin = group.anchor or s.Here()
    if steps.towards not in ("down", "up"):
        side_along(bag, _side(steps.towards), origin, site)
    _check_origin(bag, origin)
    selector = s.AlongRow(trees=steps.trees, towards=steps.towards, origin=origin)
    return FoundPlace(selector=selector, counted=1)


def _side(towards: Towards) -> CountedFrom:
    sides: dict[str, CountedFrom] = {"north": "north", "east": "east", "south": "south", "west": "west"}
    return sides.get(towards, "usual")


def next_in_row(bag: Bag, group: Group) -> FoundPlace | None:
    """ "The next tree in the row", "the next three trees of the row"."""
    row = group.rows
    origin = None if row is None else row.row_of
    if origin is None or row != s.RowOf(origin=origin) or group.area != row or not group.plain_rows:
        return None
    if bag.has("ATTRVAL") or bag.compared:
        return None
    bag.take("NEARBY")
    tree = bag.take("TREE", "PLACE")
    if tree is None or (tree.plural and bag.count is None):
        return None
    number = bag.count or 1
    towards: Towards = "up" if group.upwards else "down"
    parts = tuple(s.AlongRow(trees=k, towards=towards, origin=origin) for k in range(1, number + 1))
    if number == 1:
        return FoundPlace(selector=parts[0], counted=1)
    return FoundPlace(selector=s.UnionOf(parts=parts), many=True, counted=number)


def opposite(bag: Bag, group: Group, site: Site) -> FoundPlace:
    """ "The tree across the aisle", "the tree opposite tree 12"."""
    check_rows(bag, site)
    said = bag.take("OPPOSITE")
    side: CountedFrom = "usual" if said is None else said.value
    bag.take("TREE", "PLACE")
    if bag.count not in (None, 1) or bag.plural or bag.each or bag.any or not group.plain:
        raise bag.fault(message("only one tree stands opposite"), message("say 'the tree opposite tree 12'"))
    origin = group.anchor or s.Here()
    if side != "usual":
        check_over(bag, side, origin, site, message("no aisle lies to the {side}", side=COMPASS[side]))
    _check_origin(bag, origin)
    return FoundPlace(selector=s.Across(origin=origin, side=side), counted=1)


def successive_trees(bag: Bag, group: Group) -> FoundPlace:
    """ "4 trees in a row", "four consecutive trees in row 2": one after the other."""
    bag.take("CONSECUTIVE")
    if not bag.only("TREE") or bag.count is None or group.anchor is not None or bag.definite or bag.each:
        raise bag.fault(
            message("it is not clear which trees of a row are meant"),
            message("say '4 trees in a row', or name the row"),
        )
    bag.any = False
    bag.finish()
    selector = s.Successive(count=bag.count, of=group.kept(group.area))
    return FoundPlace(selector=selector, many=bag.count > 1, counted=bag.count, assumed=group.assumed)


def _check_origin(bag: Bag, origin: s.Selector) -> None:
    if origin.named_marker or isinstance(origin, s.PointsIn | s.Spaced):
        raise bag.fault(message("a marker is not in a row"), message("name the tree to count from"))
