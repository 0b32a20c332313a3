"""Phrases for picks from a group of trees: "the 3 northernmost of the yellow trees"."""

from __future__ import annotations

from fieldhand.language import counted, message
from fieldhand.places.noun_phrase import NounPhrase, clauses, many, one


def superlative(word: str, count: int) -> str:
    """Return a superlative such as "northernmost", inflected for a number of trees."""
    match word:
        case "northernmost":
            return counted("northernmost", "northernmost", count)
        case "easternmost":
            return counted("easternmost", "easternmost", count)
        case "southernmost":
            return counted("southernmost", "southernmost", count)
        case "westernmost":
            return counted("westernmost", "westernmost", count)
        case "nearest":
            return counted("nearest", "nearest", count)
    return counted("farthest", "farthest", count)


def foremost_phrase(word: str, count: int, group: NounPhrase) -> NounPhrase:
    """Return the phrase for the first trees by a measure: "the 3 nearest trees"."""
    which = superlative(word, count)
    if count == 1:
        if group.plain:
            return one(message("the {northernmost} tree", northernmost=which))
        return one(message("the {northernmost} of {trees}", context="one", northernmost=which, trees=group.group()))
    if group.plain:
        return many(message("the {count} {northernmost} trees", count=count, northernmost=which))
    return many(message("the {count} {northernmost} of {trees}", count=count, northernmost=which, trees=group.group()))


def picked_phrase(group: NounPhrase, count: int, which: str, *, that_is: bool = True) -> NounPhrase:
    """Return the phrase for trees picked from a group by a criterion.

    Args:
        group: Phrase of the group.
        count: Number of trees.
        which: Criterion: "nearest to the middle of the site", "with the highest yield".
        that_is: Phrase the criterion as a relative clause: "that is nearest to ...".
    """
    build = one if count == 1 else many
    if not that_is:
        clause = which
    elif group.whose or group.after or group.among:
        clause = counted("that is {nearest_to}", "that are {nearest_to}", count, nearest_to=which)
    else:
        clause = counted("{nearest_to}", "{nearest_to}", count, nearest_to=which)
    if group.closed:
        if count == 1:
            return build(message("the one of {trees} {clause}", trees=group.group(), clause=clause))
        return build(message("the {count} of {trees} {clause}", count=count, trees=group.group(), clause=clause))
    if count == 1:
        return build(
            message("the {adjectives} tree {clauses}", adjectives=group.adjectives(1), clauses=clauses(group, clause))
        )
    return build(
        message(
            "the {count} {adjectives} trees {clauses}",
            count=count,
            adjectives=group.adjectives(),
            clauses=clauses(group, clause),
        )
    )


def the_most(word: str) -> str:
    """Return a superlative with its article, for notes: "the northernmost"."""
    return message("the {northernmost}", northernmost=superlative(word, 1))
