"""Constructions of numbers: counts, amounts, and trees that are named by their number or code."""

from __future__ import annotations

import re
from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english.plant_words import is_kind_attribute, is_unmarked
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount, PlaceMeaning
from fieldhand.planning.grammar.words import Lex
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Numbers to choose from in place of a vague one.
VAGUE_NUMBERS = (3, 5, 10)
#: Id that ends with a number: "N300", "G4-03", "3-5".
_CODED = re.compile(r"(|.*\D)(0*[1-9]\d*)")
#: Maximum number of trees of a range of numbers.
_LONGEST_RANGE = 500


def whole(number: float) -> int | None:
    """Return a count, or None for a number that is not one."""
    return int(number) if number == int(number) and number >= 1 else None


@construction("amount: number=NUM [DASH] unit=UNIT", cost=0.2)
def amount(number: Lex, unit: Lex) -> Amount:
    """Compose "20 m" and "8 years"."""
    name, factor, offset = unit.value
    return Amount(number=round(number.value * factor + offset, 6), unit=name)


@construction("amount: word=DET unit=UNIT", cost=0.4)
def one_unit(word: Lex, unit: Lex) -> Amount | None:
    """Compose "a foot"."""
    return amount(Lex(1.0, False, "1"), unit) if "one" in word.features else None


@construction("amount: number=NUM AND DET HALF unit=UNIT", "amount: DET unit=UNIT AND DET HALF", cost=0.1)
def and_a_half(unit: Lex, number: Lex | None = None) -> Amount:
    """Compose "two and a half hours" and "an hour and a half"."""
    return amount(Lex(0.5 + (1.0 if number is None else number.value), False, ""), unit)


@construction("amount: first=amount [AND] second=amount", cost=0.3)
def hours_and_minutes(first: Amount, second: Amount) -> Amount | None:
    """Compose "1 h 30 min"."""
    if {first.unit, second.unit} != {"seconds"} or first.number % 3600 or not 0 < second.number < 3600:
        return None
    return Amount(number=first.number + second.number, unit="seconds")


@construction("count: number=NUM", cost=0.0)
def count(number: Lex) -> int | None:
    """Compose "5"."""
    return whole(number.value)


@construction("count: check=CMP number=NUM", cost=0.1)
def exact_count(check: Lex, number: Lex) -> int | None:
    """Compose "exactly 5"."""
    return whole(number.value) if check.value == ("eq", "") else None


@construction("count: first=NUM OR second=NUM", cost=0.3)
def either_count(first: Lex, second: Lex) -> list[int] | None:
    """Compose "three or four": a question between numbers."""
    counts = [number for one in (first, second) if (number := whole(one.value)) is not None]
    return counts if len(counts) == 2 else None


@construction("count: VAGUE", cost=0.0)
def vague_count() -> list[int]:
    """Compose "a few": a question between numbers."""
    return list(VAGUE_NUMBERS)


def name_of(number: Lex) -> str:
    """Return the name that a number or a word in the text gives."""
    return f"{number.value:g}" if isinstance(number.value, float) else str(number.value)


@construction("tree_id: tree=TREEID", cost=0.0)
def coded_tree(tree: Lex) -> tuple[str, ...]:
    """Compose "A12", the id of a tree."""
    return (tree.value,)


@construction("number_item: [HASH] number=NUM", "number_item: word=NUMBERED [HASH] number=NUM", cost=0.1)
def one_tree_number(number: Lex, word: Lex | None = None) -> tuple[str, ...] | None:
    """Compose "12" and "number 12", of trees."""
    if whole(number.value) is None or (word is not None and "by_id" in word.features):
        return None
    return None if word is None and _may_be_a_person(number) else (name_of(number),)


@construction("number_item: number=NUM", cost=1.2)
def tree_one(number: Lex) -> tuple[str, ...] | None:
    """Compose "one" of "tree one", where it cannot be the robot or a person."""
    return (name_of(number),) if _may_be_a_person(number) else None


def _may_be_a_person(number: Lex) -> bool:
    """Return True for the number one as a word ("at tree 12 one takes CO2")."""
    return number.value == 1 and not number.text.isdigit()


@construction("number_item: first=number_item range_to [TREE] last=number_item", cost=0.1)
def number_range(first: tuple[str, ...], last: tuple[str, ...]) -> tuple[str, ...] | None:
    """Compose "12 to 20", of trees."""
    if len(first) != 1 or len(last) != 1:
        return None
    low, high = int(first[0]), int(last[0])
    return tuple(str(k) for k in range(low, high + 1)) if low < high <= low + _LONGEST_RANGE else None


@construction("code_item: one=tree_id", cost=0.0)
def one_tree_code(one: tuple[str, ...]) -> tuple[str, ...]:
    """Compose "A12" in a list."""
    return one


@construction("code_item: first=tree_id range_to [TREE] last=tree_id", cost=0.0, given=("site",))
def code_range(first: tuple[str, ...], last: tuple[str, ...], site: Site) -> tuple[str, ...] | None:
    """Compose "N300 through N310", where the ids differ by their number only."""
    low, high = (_CODED.fullmatch(one[0]) for one in (first, last))
    if low is None or high is None or low[1] != high[1]:
        return None
    begin, end = int(low[2]), int(high[2])
    if not begin < end <= begin + _LONGEST_RANGE:
        return None
    width = len(low[2])  # "G4-03" to "G4-13"
    names = tuple(f"{low[1]}{number:0{width}d}" for number in range(begin, end + 1))
    return names if all(name in site.by_id for name in names) else None


@construction(
    "tree_ids: TREE [start=FROM] item=number_item",
    "tree_ids: TREE [start=FROM] item=code_item",
    "tree_ids: start=FROM item=code_item",
    "tree_ids: start=FROM TREE item=number_item",
    "tree_ids: TREE NUMBERED [HASH] item=code_item",
    cost=0.1,
)
def trees_by_number(item: tuple[str, ...], start: Lex | None = None) -> tuple[str, ...] | None:
    """Compose "tree 12", "trees 12 to 20" and "trees from N300 to N310"."""
    return None if start is not None and len(item) == 1 else item


@construction("tree_ids: item=code_item", cost=0.4)
def bare_code(item: tuple[str, ...]) -> tuple[str, ...]:
    """Compose "A12" without the word "tree"."""
    return item


@construction("tree_ids: word=NUMBERED [HASH] number=NUM", cost=0.8)
def bare_number(word: Lex, number: Lex) -> tuple[str, ...] | None:
    """Compose "number 140" without the word "tree"."""
    return None if "negates" in word.features else one_tree_number(number)


@construction("place: [DET] TREE word=NUMBERED [HASH] number=NUM", cost=0.3)
def tree_with_id(word: Lex, number: Lex) -> PlaceMeaning | None:
    """Compose "the tree with id 7"."""
    if "by_id" not in word.features or whole(number.value) is None:
        return None
    return PlaceMeaning(s.TreeIs(tree=name_of(number)), "one")


@construction("place: whole=place except [DET] TREE word=NUMBERED [HASH] number=NUM", cost=0.1)
def except_tree_with_id(whole: PlaceMeaning, word: Lex, number: Lex) -> PlaceMeaning | None:
    """Compose "every tree in the same row except the tree with id 12"."""
    left_out = tree_with_id(word, number)
    if left_out is None or not whole.selector.relative:  # elsewhere it is known which trees stand there
        return None
    if whole.shape not in ("several", "area") or whole.count is not None or whole.per is not None:
        return None
    return replace(whole, selector=s.Excluding(places=left_out.selector, of=whole.selector))


@construction(
    "tree_ids: first=tree_ids [COMMA] AND [TREE] item=number_item",
    "tree_ids: first=tree_ids COMMA [TREE] item=number_item",
    "tree_ids: first=tree_ids TREE item=number_item",
    "tree_ids: first=tree_ids [COMMA] [AND] [TREE] item=code_item",
    cost=0.2,
)
def longer_tree_list(first: tuple[str, ...], item: tuple[str, ...]) -> tuple[str, ...]:
    """Compose "trees 12, 15 and 20 to 25"."""
    return (*first, *item)


@construction("tree_ids: first=tree_ids number=NUM", cost=0.3)
def unmarked_tree_list(first: tuple[str, ...], number: Lex) -> tuple[str, ...] | None:
    """Compose "trees 12 15 20"; in "at tree 12 one takes" the second number is none."""
    return (*first, name_of(number)) if number.text.isdigit() else None


@construction(
    "tree_ids: first=tree_ids [COMMA] ANDSOON up_to [TREE] last=tree_id",
    "tree_ids: first=tree_ids [COMMA] ANDSOON up_to [TREE] number=NUM",
    "tree_ids: first=tree_ids [COMMA] [AND] EACH step=NUM [THEN] up_to [TREE] last=tree_id",
    "tree_ids: first=tree_ids [COMMA] [AND] EACH step=NUM [THEN] up_to [TREE] number=NUM",
    cost=0.2,
    given=("site",),
)
def and_so_on(
    first: tuple[str, ...],
    site: Site,
    last: tuple[str, ...] = (),
    number: Lex | None = None,
    step: Lex | None = None,
) -> tuple[str, ...] | None:
    """Compose "5, 15, 25 and so on up to 165" and "N100, N200 and every hundred after that until N2000"."""
    named = [_CODED.fullmatch(name) for name in (*first, name_of(number) if number is not None else last[0])]
    codes = [one for one in named if one is not None]
    if len(codes) != len(named) or len({one[1] for one in codes}) > 1 or len(first) < 2:
        return None
    begin, second, *_, end = (int(one[2]) for one in codes)
    every = second - begin
    if every < 1 or (step is not None and step.value != every) or not 0 < end - begin <= 500 * every:
        return None
    names = tuple(f"{codes[0][1]}{number:0{len(codes[0][2])}d}" for number in range(begin, end + 1, every))
    if names[: len(first)] != first or names[-1] != codes[-1][0]:
        return None  # "5, 15, 25 and so on up to 163"
    return names if all(name in site.by_id for name in names) else None


@construction("up_to: UNTIL", "up_to: UPTO", "up_to: CMP", "up_to: range_to", cost=0.0)
def until_word() -> str:
    """Compose "up to" and "until" before the last of a series."""
    return "to"


@construction(
    "range_to: word=AT", "range_to: word=ALONG", "range_to: word=DASH", "range_to: UNTIL", "range_to: RANGETO", cost=0.0
)
def range_word(word: Lex | None = None) -> str | None:
    """Compose "to" and "through"."""
    return "to" if word is None or "range" in word.features else None


@construction("place: [DET] trees=tree_ids", cost=0.1)
def named_trees(trees: tuple[str, ...]) -> PlaceMeaning:
    """Compose "the trees 12 and 15"."""
    if len(trees) == 1:
        return PlaceMeaning(s.TreeIs(tree=trees[0]), "one")
    return PlaceMeaning(s.UnionOf(parts=tuple(s.TreeIs(tree=t) for t in trees)), "several", count=len(trees))


@construction(
    "place: [DET] kind=ATTRVAL trees=tree_ids", "place: EACH [DET] kind=ATTRVAL trees=tree_ids",
    "place: [DET] kind=ATTRVAL NUMBERED trees=tree_ids",
    cost=0.1, given=("site",),
)  # fmt: skip
def named_plants_of_kind(kind: Lex, trees: tuple[str, ...], site: Site) -> PlaceMeaning | None:
    """Compose "carrots 3-5, 3-10 and 3-15" and "the peppers G5-03 and G5-04"."""
    kinds = [(name, text) for name, text in kind.value if is_kind_attribute(name)]
    plants = [site.by_id[tree].properties for tree in trees if tree in site.by_id]
    if not kinds or (kind.plural != (len(trees) > 1) and not all(is_unmarked(*one) for one in kinds)):
        return None
    if len(plants) < len(trees) or not any(all(one.get(name) == text for one in plants) for name, text in kinds):
        fault = message("not all of these plants are of that kind", context="fault")
        return replace(named_trees(trees), shape="nowhere", fault=fault)
    return named_trees(trees)


@construction("place: EACH [DET] trees=tree_ids", cost=0.1)
def each_named_tree(trees: tuple[str, ...]) -> PlaceMeaning:
    """Compose "each of trees 12 and 15"."""
    named = named_trees(trees)
    return replace(named, each=True) if named.shape == "several" else named


@construction(
    "between_trees: BETWEEN [TREE] first=number_item AND [TREE] last=number_item",
    "between_trees: BETWEEN [TREE] first=tree_id AND [TREE] last=tree_id",
    cost=0.1,
    given=("site",),
)
def between_trees(first: tuple[str, ...], last: tuple[str, ...], site: Site) -> tuple[str, ...] | None:
    """Compose "between 20 and 30", of trees."""
    return number_range(first, last) if first[0].isdigit() else code_range(first, last, site)


@construction("place: [DET] noun=TREE every=between_trees", "place: EACH [DET] noun=TREE every=between_trees", cost=0.2)
def trees_between(noun: Lex, every: tuple[str, ...]) -> list[PlaceMeaning] | None:
    """Compose "the trees between 20 and 30": with these two, or without them?"""
    return [named_trees(every), named_trees(every[1:-1])] if len(every) > 3 and noun.plural else None


@construction("owned_by: [DET] trees=tree_ids POSS", "owned_by: [DET] [TREE] code=TREEIDPOSS", cost=0.1)
def owned_by_tree(trees: tuple[str, ...] = (), code: Lex | None = None) -> PlaceMeaning | None:
    """Compose "tree 40's"."""
    names = trees if code is None else (code.value,)
    return named_trees(names) if len(names) == 1 else None


@construction("numbers: first=number_item", cost=0.0)
def one_number(first: tuple[str, ...]) -> tuple[str, ...]:
    """Compose "12" without the word "tree"."""
    return first


@construction(
    "numbers: first=numbers [COMMA] AND item=number_item", "numbers: first=numbers COMMA item=number_item", cost=0.1
)
def more_numbers(first: tuple[str, ...], item: tuple[str, ...]) -> tuple[str, ...]:
    """Compose "12, 15 and 20"."""
    return (*first, *item)
