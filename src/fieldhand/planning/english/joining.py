"""Noun phrases joined by commas and "and": which words they share, and what one says of the other."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from fieldhand.language import message
from fieldhand.planning.english.bag import bag_of
from fieldhand.planning.english.faults import Question, text_of
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.syntax import Chain, PlacePhrase, Places
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.selections import counts_in_row, starts_here

_RANKS = ("MOST", "SUPER", "ORD", "LAST", "BACKORD")


def check_of_row(places: Places, found: list[FoundPlace]) -> None:
    """ "The first tree and the last tree of row 6": is the first that of the row too?"""
    bare = [c for c in places.chains if len(c.phrases) == 1 and bag_of(c.phrases[0]).has("ORD", "LAST")]
    if bare and any(counts_in_row(part) for f in found for part in f.selector.walk()):
        text = text_of(bare[0].terms)
        asked = message("'{said}': of the row, or of the whole site?", context="question", said=text)
        words = (f"{text} of the row", f"{text} of the site")
        choices = (
            message("{said} of the row", context="answer", said=text),
            message("{said} of the site", context="answer", said=text),
        )
        raise Question(asked, choices, terms=bare[0].terms, words=words)


def of_the_other(places: Places, found: list[FoundPlace]) -> Chain | None:
    """ "Row 4, the easternmost tree": with a comma alone, an area says where the other is; None if that is not said."""
    if len(found) != 2 or set(places.joins[0].text) - set(", "):
        return None
    areas = [f.region or f.line for f in found]
    middles = [f.selector.central for f in found]
    if not any(areas):
        areas = middles
    if areas[0] == areas[1]:
        return None
    area, inner = places.chains[areas.index(True)], places.chains[areas.index(False)]
    if areas == middles and not any(t.kind == "ADJACENT" for t in inner.terms):
        return None  # a tree, and another in the middle
    named = any(t.kind in ("IDS", "CORNER", "START", "CHARGER", "IT", "THERE", "ANOTHER", "OTHER") for t in inner.terms)
    if named or any(t.kind in ("EXCEPT", "OUTSIDE") for t in inner.terms):
        return None
    relation = replace(places.joins[0], kind="OF", text="of", value="OF")
    if found[areas.index(True)].selector.central:
        relation = replace(relation, kind="AT", text="at", value="AT")
    return Chain(phrases=(*inner.phrases, *area.phrases), relations=(*inner.relations, relation, *area.relations))


def check_comma(places: Places, found: list[FoundPlace]) -> None:
    """ "The yellow trees, every other tree": with a comma alone, the second may be of the first."""
    if all(set(join.text) <= set(", ") for join in places.joins) and sum(f.many for f in found) > 1:
        parts = [text_of(chain.terms).replace(" ,", ",") for chain in places.chains]
        asked = message(
            "'{parts}': one and the same trees, or each of them?", context="question", parts=", ".join(parts)
        )
        raise Question(
            asked,
            (message("{parts} and also {last}", context="answer", parts=", ".join(parts[:-1]), last=parts[-1]),),
            terms=places.terms,
        )


def read_as(places: Places, whole: Chain) -> str:
    """How two groups with a comma alone between them were read, as a sentence."""
    said = ", ".join(text_of(chain.terms) for chain in places.chains)
    inner = places.chains[0] if whole.phrases[0] == places.chains[0].phrases[0] else places.chains[1]
    area = next(chain for chain in places.chains if chain is not inner)
    meant = f"{text_of(inner.terms)} {whole.relations[len(inner.relations)].text} {text_of(area.terms)}"
    return message("'{said}' is read as '{meant}'.", context="assumption", said=said, meant=meant)


def from_each_other(found: list[FoundPlace]) -> list[FoundPlace]:
    """ "Tree 80 and the tree opposite": the second is counted from the first."""
    made = found[:1]
    for one in found[1:]:
        selector: Any = one.selector
        if starts_here(selector) and not made[-1].many and not made[-1].here:
            one = replace(one, selector=replace(selector, origin=made[-1].selector))
        made.append(one)
    return made


def one_each(places: Places) -> Places:
    """ "The first and last tree of row 6", "the first tree and the last tree of row 6": both are of that row."""
    last = places.chains[-1]
    head = last.phrases[0]
    rest = tuple(g for g in head.nominals if g[0].kind not in _RANKS)
    if len(places.chains) < 2 or not rest or len(rest) == len(head.nominals):
        return places
    if _of_a_row(last) and all(_is_end(chain) for chain in places.chains[:-1]):
        firsts = (replace(c, phrases=(*c.phrases, *last.phrases[1:]), relations=last.relations) for c in places.chains)
        return replace(places, chains=(*tuple(firsts)[:-1], last))
    if not all(_only_ranks(chain) for chain in places.chains[:-1]):
        return places
    counted = any(t.kind == "NUM" for c in places.chains for t in c.phrases[0].quantity)
    chains = [
        replace(
            chain,
            phrases=(_headed(chain.phrases[0], rest, plural=counted), *last.phrases[1:]),
            relations=last.relations,
        )
        for chain in places.chains[:-1]
    ]
    single = replace(last, phrases=(head if counted else _headed(head, (), plural=False), *last.phrases[1:]))
    return replace(places, chains=(*chains, single))


def _only_ranks(chain: Chain) -> bool:
    """Whether a chain is a rank and no more ("the first", "the northernmost")."""
    phrase = chain.phrases[0]
    return len(chain.phrases) == 1 and bool(phrase.nominals) and all(g[0].kind in _RANKS for g in phrase.nominals)


def _is_end(chain: Chain) -> bool:
    """Whether a chain is a tree by its rank alone ("the first tree")."""
    nominals = chain.phrases[0].nominals
    ranked = [g[0].kind for g in nominals if g[0].kind in ("ORD", "LAST", "BACKORD")]
    return len(chain.phrases) == 1 and len(ranked) == 1 and len(nominals) == 2 and nominals[1][0].kind == "TREE"


def _of_a_row(chain: Chain) -> bool:
    return len(chain.phrases) == 2 and any(g[0].kind in ("ROW", "ROWIDS") for g in chain.phrases[1].nominals)


def _headed(phrase: PlacePhrase, nominals: tuple[tuple[Term, ...], ...], *, plural: bool) -> PlacePhrase:
    """A phrase with the words that another one shares with it."""
    whole = (*phrase.nominals, *nominals)
    if not plural:
        whole = tuple(tuple(replace(t, plural=False) for t in group) for group in whole)
    return replace(phrase, nominals=whole)


def without_both(chains: tuple[Chain, ...]) -> tuple[Chain, ...]:
    """ "Both the first and the last tree": "both" announces the "and", and counts nothing."""
    first = chains[0].phrases[0]
    quantity = tuple(t for t in first.quantity if not t.text.lower().startswith("both"))
    if len(chains) != 2 or quantity == first.quantity:
        return chains
    return (replace(chains[0], phrases=(replace(first, quantity=quantity), *chains[0].phrases[1:])), chains[1])


def only_compares(chain: Chain) -> bool:
    """Whether a chain goes on with a comparison of what stands before it ("... and younger than 12")."""
    bag = bag_of(chain.phrases[0])
    return bool(bag.compared) and not chain.phrases[0].quantity and not bag.has("TREE", "PLACE", "CORNER")


def is_apposition(chain: Chain) -> bool:
    """Whether a chain says again what stands before it ("another tree, a different one")."""
    words = {t.kind for t in chain.terms}
    return bool(words & {"OTHER", "ANOTHER"}) and words <= {"OTHER", "ANOTHER", "DET", "PLACE", "IT", "NUM"}


def without_appositions(places: Places) -> Places:
    """ "Another tree, the farthest one from there": one tree, of which the second phrase says which."""
    chains, joins = [places.chains[0]], []
    for join, chain in zip(places.joins, places.chains[1:], strict=True):
        if set(join.text) <= set(", ") and _is_vague(chains[-1]) and _says_which(chain):
            chains[-1] = chain
        else:
            chains.append(chain)
            joins.append(join)
    return replace(places, chains=tuple(chains), joins=tuple(joins))


def _is_vague(chain: Chain) -> bool:
    """Whether a chain is one tree, whichever ("a tree", "another one")."""
    phrase = chain.phrases[0]
    kinds = {t.kind for group in phrase.nominals for t in group}
    some = any(t.kind in ("ANOTHER", "ANY") or t.text.lower() in ("a", "an") for t in phrase.quantity)
    plural = any(t.plural for t in phrase.terms) or any(t.kind in ("NUM", "EACH") for t in phrase.quantity)
    return some and not plural and len(chain.phrases) == 1 and kinds <= {"TREE", "PLACE", "OTHER", "WHICH"}


def _says_which(chain: Chain) -> bool:
    """Whether a chain is one certain tree ("the farthest one from there", "tree 9")."""
    phrase = chain.phrases[0]
    kinds = {t.kind for group in phrase.nominals for t in group}
    several = any(t.plural for t in phrase.terms) or any(t.kind in ("NUM", "EACH", "ANOTHER") for t in phrase.quantity)
    return not several and bool(kinds & {"FARTHEST", "FAR", "NEAREST", "MOST", "SUPER", "IDS", "STEP", "LAST"})
