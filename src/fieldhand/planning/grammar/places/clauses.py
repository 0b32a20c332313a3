"""Constructions of clauses behind a noun: "that are yellow", "older than 8 years and not in row 3".

A clause is a sequence of traits, which restrict a selection one after the other.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Likewise, Nominal, PlaceMeaning
from fieldhand.planning.grammar.places.areas import inside
from fieldhand.planning.grammar.places.chosen import Chosen
from fieldhand.planning.grammar.places.nouns import AttributeCheck, AttributeTest, that_pass
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_every_nth, as_zone, chooses_from_trees, over

GRAMMAR = Grammar()
construction = GRAMMAR.construction

_ANYWHERE = s.Trees()
#: Tests that pass where another one fails.
_OPPOSITE: dict[AttributeCheck, AttributeCheck] = {
    "lt": "ge",
    "ge": "lt",
    "gt": "le",
    "le": "gt",
    "eq": "ne",
    "ne": "eq",
    "any": "none",
    "none": "any",
}


@dataclass(frozen=True, slots=True)
class Trait:
    """One property of trees: a test of an attribute, or an area in which they are.

    Attributes:
        test: Test; None for an area.
        area: Area.
        outside: True if they are outside of the area.
        denied: True if the phrase has "not".
        earlier: Places by what earlier missions did or read there, instead of a test or an area.
    """

    test: AttributeTest | None = None
    area: s.Selector = _ANYWHERE
    outside: bool = False
    denied: bool = False
    earlier: s.Selector | None = None


Clause = tuple[Trait, ...]


@construction("trait: test=attribute_test", cost=0.6)
def tested(test: AttributeTest) -> Trait:
    """Compose "older than 8 years"."""
    return Trait(test)


@construction("trait: in_ area=region", cost=0.1)
def located(area: s.Selector) -> Trait:
    """Compose "in row 3"."""
    return Trait(area=area)


@construction("trait: OUTSIDE [OF] area=region", cost=0.1)
def located_outside(area: s.Selector) -> Trait:
    """Compose "outside the wet corner"."""
    return Trait(area=area, outside=True)


@construction(
    "is_not: WHICH ISNOT", "is_not: WHICH [IS] NOT", "is_not: WHICHPOSS NOT", "is_not: NOT", "is_not: NOTSTANDS",
    cost=0.1,
)  # fmt: skip
def is_not() -> str:
    """Compose "that are not"."""
    return "not"


@construction("traits: trait=trait", cost=0.0)
def traits(trait: Trait) -> Clause:
    """Compose "yellow", the beginning of "yellow and in row 3"."""
    return (trait,)


@construction("traits: is_not trait=trait", cost=0.0)
def denied(trait: Trait) -> Clause | None:
    """Compose "that are not older than 8 years"."""
    if trait.earlier is not None:
        return None
    if trait.test is None:
        return None if trait.outside else (replace(trait, outside=True, denied=True),)
    name, check, value = trait.test
    if isinstance(value, bool):
        return (Trait((name, check, not value), denied=True),)
    return (Trait((name, _OPPOSITE[check], value), denied=True),) if check in _OPPOSITE else None


@construction("traits: NEITHER first=trait NOR then=trait", cost=0.0)
def neither(first: Trait, then: Trait) -> Clause | None:
    """Compose "neither yellow nor in row 3"."""
    one, other = denied(first), denied(then)
    return None if one is None or other is None or first == then else (*one, *other)


@construction("traits: first=traits and_or_but [again=which_is] then=traits", cost=0.0)
def more_traits(first: Clause, then: Clause, again: str = "") -> Clause | None:
    """Compose "yellow and not in row 3"."""
    if first[-1].denied and not then[0].denied and not again:
        return None  # "not yellow and older than 8 years": older, or not both of these?
    return (*first, *then)


@construction("relative: which_is traits=traits", "relative: STANDS traits=traits", cost=0.2)
def which_clause(traits: Clause) -> Clause:
    """Compose "that are older than 8 years" and "standing in row 3"."""
    return traits


@construction("relative: traits=traits", cost=0.2)
def bare_clause(traits: Clause) -> Clause | None:
    """Compose "older than 8 years" behind a noun."""
    first = traits[0]
    return traits if first.test is not None or first.earlier is not None or first.outside else None


@construction(
    "relative: WITH traits=traits",
    "relative: [which_is] RECORDEDAS [DET] traits=traits",
    "relative: OF test=attribute_test",
    "relative: WHERE [MAPSAYS] test=attribute_test",
    cost=0.5,
)
def with_clause(traits: Clause = (), test: AttributeTest | None = None) -> Clause:
    """Compose "with a yield above 10 kg" and "where the vigor is low"."""
    return traits or (Trait(test),)


@construction("nominal: inner=nominal clause=relative", cost=0.1)
def with_attribute(inner: Nominal, clause: Clause) -> Nominal | None:
    """Compose "trees that are older than 8 years"."""
    if inner.single or inner.complete or not chooses_from_trees(inner.selector):
        return None
    for trait in clause:
        if trait.test is not None:
            inner = replace(inner, selector=that_pass(trait.test, inner.selector), tested=True)
        elif trait.earlier is not None:
            inner = replace(inner, selector=over(trait.earlier, inner.selector), tested=True)
        elif trait.outside:
            inner = replace(inner, selector=_outside(inner.selector, trait), tested=True)
        elif (there := inside(inner, trait.area, "in")) is not None:
            inner = there
        else:
            return None
    return inner


def _outside(of: s.Selector, trait: Trait) -> s.Selector:
    """Return the trees of a selection outside of an area."""
    zone = None if trait.denied else as_zone(trait.area)
    return s.Excluding(places=trait.area, of=of) if zone is None else over(of, replace(zone, outside=not zone.outside))


@construction("chosen: chosen=chosen clause=relative", cost=0.1)
def chosen_with(chosen: Chosen, clause: Clause) -> Chosen | None:
    """Compose "nearest tree to the charger that is not yellow"."""
    if chosen.choice is None or chosen.choice.by in ("nth", "numbered"):
        return None
    inner = with_attribute(chosen.inner, clause)
    return None if inner is None else replace(chosen, inner=inner)


@construction("ATTR: attribute=ATTR ONRECORD", cost=0.1)
def recorded_attribute(attribute: Lex) -> Lex:
    """Compose "(whose) moisture on the map (is below 22)"."""
    return attribute


@construction("chosen: chosen=chosen [COMMA] ONRECORD", cost=0.1)
def as_recorded(chosen: Chosen) -> Chosen | None:
    """Compose "five peppers with the lowest moisture on our list": what the site's file says of its plants."""
    return chosen if chosen.choice is not None and chosen.choice.by == "best" else None


@construction("relative: clause=relative [COMMA] ONRECORD", cost=0.1)
def recorded_clause(clause: Clause) -> Clause | None:
    """Compose "with a moisture below 30 on our list"."""
    return clause if all(trait.test is not None for trait in clause) else None


@construction("place: whole=place clause=relative", cost=0.3)
def those_with_attribute(whole: PlaceMeaning, clause: Clause) -> PlaceMeaning | None:
    """Compose "every third tree in row 4 that is yellow"."""
    if as_every_nth(whole.selector) is None or whole.per is not None:
        return None
    described = with_attribute(Nominal(whole.selector), clause)
    return None if described is None else replace(whole, selector=described.selector)


@construction("place: word=DET clause=relative", "place: ANY clause=relative", cost=0.2)
def those_of_a_description(clause: Clause, word: Lex | None = None) -> PlaceMeaning | None:
    """Compose "those older than 8 years" and "any that have mildew"."""
    if word is not None and "stands_for_noun" not in word.features:
        return None
    if clause[0].test is None and clause[0].earlier is None:
        return None
    described = with_attribute(Nominal(s.Trees()), clause)
    return (
        None if described is None else PlaceMeaning(described.selector, "several", like=Likewise("those", holds=True))
    )
