"""Constructions of what is true or false of each plant: "grafted tomatoes", "cucumbers with mildew", "covered ones"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.clauses import Clause, Trait
from fieldhand.planning.grammar.places.nouns import AttributeTest, that_pass
from fieldhand.planning.grammar.places.numbered import ids_of
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_where
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("attribute_test: flag=FLAG", cost=0.4)
def is_so(flag: Lex) -> list[AttributeTest]:
    """Compose "grafted" behind a noun."""
    return [(name, "eq", value) for name, value in flag.value]


@construction(
    "attribute_test: UNDERIT [DET] flag=FLAGNOUN", "attribute_test: WITH [DET] flag=FLAGNOUN [ONTHEM]",
    "attribute_test: [DET] flag=FLAGNOUN ONTHEM", "attribute_test: DET flag=FLAGNOUN", cost=0.4,
)  # fmt: skip
def has_it(flag: Lex) -> list[AttributeTest]:
    """Compose "under covers" and "a cover on it" of "that have a cover on it", for what is covered."""
    return is_so(flag)


@construction("attribute_test: word=WITHOUT [DET] flag=FLAGNOUN [ONTHEM]", cost=0.4)
@construction("attribute_test: LACKS [DET] flag=FLAGNOUN [ONTHEM]", cost=0.4)
@construction("attribute_test: word=NOT UNDERIT [DET] flag=FLAGNOUN", cost=0.2)
def has_it_not(flag: Lex, word: Lex | None = None) -> list[AttributeTest] | None:
    """Compose "without a cover" and "no cover" of "that have no cover"."""
    return None if word is not None and word.features.isdisjoint({"leaves_out", "denies"}) else is_not_so(flag)


def is_not_so(flag: Lex) -> list[AttributeTest]:
    """Return the tests of "not grafted"."""
    return [(name, "eq", not value) for name, value in flag.value]


@construction("nominal: flag=FLAG inner=nominal", "owner: flag=FLAG inner=owner", cost=0.2)
def such(flag: Lex, inner: Nominal) -> list[Nominal] | None:
    """Compose "grafted tomatoes"."""
    if inner.single or inner.complete or inner.pronoun or inner.tested:
        return None
    return [replace(inner, selector=that_pass(test, inner.selector)) for test in is_so(flag)]


@construction("nominal: flag=FLAG", cost=1.6)
def such_ones(flag: Lex) -> list[Nominal] | None:
    """Compose "two grafted" of "two grafted and two ungrafted plants"; "mildew" is no plant."""
    if not flag.text.endswith(("ed", "en")):
        return None
    return [Nominal(that_pass(test, s.Trees()), plural=True, unmarked=True) for test in is_so(flag)]


@construction("nominal: NON [DASH] flag=FLAG inner=nominal", "nominal: NOT [DASH] flag=FLAG inner=nominal", cost=0.2)
def not_such(flag: Lex, inner: Nominal) -> list[Nominal] | None:
    """Compose "non-grafted tomatoes"."""
    if inner.single or inner.complete or inner.pronoun or inner.tested:
        return None
    return [replace(inner, selector=that_pass(test, inner.selector)) for test in is_not_so(flag)]


@construction("relative: WITH flag=FLAG", "relative: [which_is] SHOWING flag=FLAG", cost=0.1)
def with_it(flag: Lex) -> list[Clause]:
    """Compose "with mildew" and "that show mildew"."""
    return [(Trait(test),) for test in is_so(flag)]


@construction("relative: word=WITHOUT flag=FLAG", "relative: [which_is] LACKS flag=FLAG", cost=0.1)
def without_it(flag: Lex, word: Lex | None = None) -> list[Clause] | None:
    """Compose "without mildew" and "free of mildew"."""
    if word is not None and "leaves_out" not in word.features:
        return None
    return [(Trait(test, denied=True),) for test in is_not_so(flag)]


@construction("place: [DET] flag=FLAG noun=ONE", "place: each=EACH flag=FLAG noun=ONE", cost=0.4)
def those_that_are_so(flag: Lex, noun: Lex, each: Lex | None = None) -> list[PlaceMeaning] | None:
    """Compose "the grafted ones" and "every grafted one", of plants or rows that were named before."""
    if each is None and not noun.plural and "plural" not in noun.features:
        return None
    return [
        PlaceMeaning(s.Where(attribute=name, test="eq", value=value), "several", like=Likewise("value"))
        for name, value in flag.value
    ]


@construction("few_such: n=count flag=FLAG [ONE]", "few_such: ASMANY flag=FLAG ONE", cost=0.1)
@construction("few_such: n=count no=WITHOUT", "few_such: n=count ONE no=WITHOUT", cost=0.1)
@construction("few_such: n=count [ONE] clause=relative", cost=0.1)
def few_such(
    n: int = 0, flag: Lex | None = None, no: Lex | None = None, clause: Clause | None = None
) -> list[tuple[int, AttributeTest | None]] | None:
    """Compose "two healthy ones", "two that are healthy", "two without" and "as many healthy ones"."""
    if clause is not None:
        traits = [one for one in clause if isinstance(one, Trait)]
        return [(n, traits[0].test)] if len(traits) == len(clause) == 1 else None
    if no is not None:
        return [(n, None)] if "leaves_out" in no.features else None
    return [(n, test) for test in is_so(flag)] if flag is not None else None


@construction(
    "place: whole=place [COMMA] AND few=few_such", "place: whole=place [COMMA] TOGETHERWITH few=few_such",
    cost=0.2, given=("site",),
)  # fmt: skip
def with_few_others(whole: PlaceMeaning, few: tuple[int, AttributeTest | None], site: Site) -> PlaceMeaning | None:
    """Compose "every cucumber with mildew and two healthy ones", of the same kind."""
    n, test = few
    of = as_where(whole.selector)
    if whole.shape != "several" or of is None or whole.per is not None or whole.optional or whole.count is not None:
        return None
    opposite = (of.attribute, of.test, not of.value) if isinstance(of.value, bool) else None
    if opposite is None or of.test != "eq" or test not in (None, opposite):
        return None
    others = s.Where(attribute=of.attribute, test="eq", value=not of.value, of=of.of)
    wanted = n or len(ids_of(of, site) or ())
    if not 0 < wanted <= len(ids_of(others, site) or ()):
        return None
    return replace(whole, selector=s.UnionOf(parts=(of, s.Take(count=wanted, of=others))))
