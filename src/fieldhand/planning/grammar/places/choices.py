"""Constructions of places that leave open which are meant: each returns its meanings, and the plans differ in them."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.compass import CORNERS
from fieldhand.planning.grammar.places.numbers import name_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import are_rows, chooses_from_trees, is_one_row, leaves_out
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction
_ANYWHERE = s.Trees()


@construction("nominal: inner=nominal FREECHOICE", cost=0.2)
def of_your_choice(inner: Nominal) -> Nominal | None:
    """Compose "trees of your choice", of which something else says how many."""
    return None if inner.single or inner.complete or not inner.plural else inner


@construction("place: first=place OR second=place", "place: ANY first=place OR second=place", cost=0.9)
def one_or_the_other(first: PlaceMeaning, second: PlaceMeaning) -> list[PlaceMeaning] | None:
    """Compose "tree 5 or tree 6"."""
    if leaves_out(first.selector):
        return None  # "all leeks but no onions or carrots"
    if first.shape != second.shape or first.shape not in ("one", "several", "area") or first.per or second.per:
        return None
    return [first, second]


@construction("rows: first=rows OR second=rows", cost=0.9)
def one_row_or_the_other(first: s.Selector, second: s.Selector) -> list[s.Selector]:
    """Compose "row 3 or row 4"."""
    return [first, second]


@construction("place: [DET] first=tree_ids OR n=NUM", cost=0.4)
def one_number_or_the_other(first: tuple[str, ...], n: Lex) -> list[PlaceMeaning] | None:
    """Compose "tree 5 or 6"."""
    if len(first) != 1:
        return None
    return [PlaceMeaning(s.TreeIs(tree=name), "one") for name in (*first, name_of(n))]


@construction(
    "place: word=DET noun=CORNER [tree=TREE]", "place: word=DET noun=CORNER [tree=TREE] in_ where=region", cost=0.4
)
def some_corner(
    word: Lex, noun: Lex, tree: Lex | None = None, where: s.Selector = _ANYWHERE
) -> list[PlaceMeaning] | None:
    """Compose "the corner" and "the corner of the north block"."""
    if noun.plural or (tree is not None and tree.plural) or "definite" not in word.features:
        return None
    if are_rows(where) or not chooses_from_trees(where):
        return None
    return [PlaceMeaning(s.Corners(which=(corner,), of=where), "one") for corner in CORNERS]


@construction(
    "place: ANY noun=FINISH in_ rows=rows",
    "place: ANY FINISH TREE in_ rows=rows",
    "place: [DET] TREE in_ ANY noun=FINISH in_ rows=rows",
    "place: [DET] TREE AT DET noun=CORNER in_ rows=rows",
    "place: DET noun=CORNER in_ rows=rows",
    cost=0.3,
)
def either_end(rows: s.Selector, noun: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "either end of row 3" and "the corner of row 3"."""
    if (noun is not None and noun.plural) or not is_one_row(rows):
        return None
    return [PlaceMeaning(s.InRow(first=at, last=at, of=rows), "one") for at in (1, -1)]


@construction(
    "place: ANY noun=FINISH in_ rows=rows", "place: ANY noun=FINISH in_ rows=rows AND in_ then=rows",
    "place: ANY noun=FINISH in_ rows=rows AND then=rows", "place: ANY noun=FINISH in_ rows=each_row",
    "place: ANY noun=FINISH in_ rows=rows AND ANY FINISH in_ then=rows",
    "place: [DET] TREE in_ ANY noun=FINISH in_ rows=rows", "place: [DET] TREE in_ ANY noun=FINISH in_ rows=each_row",
    cost=0.1,
)  # fmt: skip
def either_end_of_several(rows: s.Selector, noun: Lex, then: s.Selector | None = None) -> PlaceMeaning | None:
    """Compose "either end of beds 5 and 8" and "either end of bed 5 and of bed 8", the two ends of each."""
    if then is not None:
        rows = s.UnionOf(parts=(*rows.members, *then.members))
    if noun.plural or not are_rows(rows) or is_one_row(rows):
        return None
    ends = tuple(s.InRow(first=at, last=at, of=rows) for at in (1, -1))
    return PlaceMeaning(s.UnionOf(parts=ends), "several")


@construction(
    "place: word=DET [ODD] noun=ROW",
    "place: word=DET EVEN noun=ROW",
    "place: word=DET OTHER noun=ROW",
    "place: whole=place in_ word=DET noun=ROW",
    "place: whole=place in_ word=DET ODD noun=ROW",
    "place: whole=place in_ word=DET EVEN noun=ROW",
    "place: whole=place in_ word=DET OTHER noun=ROW",
    "place: n=count noun=ROW",
    "place: whole=place in_ n=count noun=ROW",
    cost=0.5,
)
def unknown_row(
    noun: Lex, word: Lex | None = None, n: int | None = None, whole: PlaceMeaning | None = None
) -> PlaceMeaning | None:
    """Compose "every tree in a row", which does not say in which."""
    if word is not None and ("indefinite" not in word.features or noun.plural):
        return None
    if whole is not None and (whole.shape not in ("one", "several") or not chooses_from_trees(whole.selector)):
        return None
    return PlaceMeaning(s.Rows(), "unknown", count=n)


@construction(
    "place: [DET] DIR noun=ROW",
    "place: [DET] ranking noun=ROW",
    "place: [DET] MIDDLE noun=ROW",
    "place: [DET] USUAL noun=ROW",
    "place: whole=place in_ [DET] USUAL noun=ROW",
    "place: whole=place in_ [DET] DIR noun=ROW",
    "place: whole=place in_ [DET] ranking noun=ROW",
    cost=0.8,
)
def vague_rows(noun: Lex, whole: PlaceMeaning | None = None) -> PlaceMeaning | None:
    """Compose "the northern rows", "the top row" and "the usual rows", which do not say which ones."""
    if whole is not None and (whole.shape not in ("one", "several") or not chooses_from_trees(whole.selector)):
        return None
    return PlaceMeaning(s.Rows(), "unknown", count=2 if noun.plural else None)


@construction(
    "place: [DET] USUAL [n=count] noun=TREE", "place: [DET] [n=count] USUAL noun=TREE",
    "place: [DET] USUAL [n=count] noun=POINT", "place: [DET] [n=count] USUAL noun=POINT", cost=0.8,
)  # fmt: skip
def usual_places(noun: Lex, n: int | None = None) -> PlaceMeaning:
    """Compose "the usual spots", which does not say which ones."""
    return PlaceMeaning(s.Trees(), "unknown", count=n or (2 if noun.plural else None))


@construction(
    "rows: DET MIDDLE [n=count] noun=ROW",
    "rows: DET MIDDLE [n=count] noun=ROW in_ where=block",
    cost=0.2,
    given=("site",),
)
def middle_rows(
    noun: Lex, site: Site, n: int | None = None, where: s.Selector | None = None
) -> list[s.Selector] | None:
    """Compose "the middle row": of an even number of rows there are two."""
    blocks = [one for one in site.planting.blocks if where in (None, s.InBlock(block=one.name))]
    if noun.plural != (n is not None) or len(blocks) != 1 or n not in (None, 2):
        return None
    names, of = [row.name for row in blocks[0].rows], where or s.Trees()
    half = len(names) // 2
    if n == 2:
        return [s.Rows(first=names[half - 1], last=names[half], of=of)] if len(names) % 2 == 0 else None
    middle = names[half : half + 1] if len(names) % 2 else names[half - 1 : half + 1]
    return [s.Rows(first=name, last=name, of=of) for name in middle]
