"""Phrases without a noun for trees: ids alone, and quantities alone ("another", "two more", "each")."""

from __future__ import annotations

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.sets import Group, nested
from fieldhand.planning.english.syntax import PlacePhrase
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.selections import some_of


def named_trees(bag: Bag) -> FoundPlace:
    """Trees by their ids."""
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
    bag.finish()
    trees = tuple(s.TreeIs(tree=tree) for tree in bag.ids)
    if len(trees) == 1:
        return FoundPlace(selector=trees[0])
    return FoundPlace(selector=s.UnionOf(parts=trees), many=True, each=bag.each)


def quantity_alone(bag: Bag, group: Group, phrase: PlacePhrase, relations: list[Term]) -> FoundPlace:
    """ "Another", "two more", "each": of what, the verb before says; of whom, what describes it."""
    if bag.up_to or bag.as_many:
        raise bag.fault(message("it does not say of what"), message("say 'as many trees as you can', for example"))
    if bag.pointing and bag.plural_article and bag.count is None and not group.empty:
        return FoundPlace(selector=nested(group, s.Trees()), many=True)  # "all trees except | those in row 3"
    if bag.article and bag.count is None and not (bag.another or bag.each or bag.any):
        raise unclear(phrase.terms, message("a place was expected"))
    if bag.each and not bag.another and group.empty:
        return FoundPlace(selector=s.Here(), here=True, these=True)  # "photograph both"
    bag.more = False
    number = bag.count or (1 if bag.another else None)
    if group.empty:
        return FoundPlace(selector=s.Trees(), object_only=True, counted=number, each=bag.each)
    selector = nested(group, s.Trees())
    partitive = all(relation.kind in ("OF", "EXCEPT") for relation in relations)
    if partitive and bag.each and not bag.count:
        return FoundPlace(selector=selector, many=True, each=True)  # "all but the yellow trees"
    if partitive and bag.count and not group.single:
        return FoundPlace(selector=some_of(selector, bag.count), many=bag.count > 1, counted=bag.count)
    return FoundPlace(
        selector=selector, object_only=True, counted=number, each=bag.each, many=True, region=group.region
    )
