"""An area in front of a command: "in the northern half, photograph the yellow trees", "drive down row 3 and ..."."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.hand import ACTS
from fieldhand.planning.english.places import are_several, find
from fieldhand.planning.english.rewriting import silent
from fieldhand.planning.english.syntax import Chain, ClausePart, Places
from fieldhand.planning.english.tokens import Term
from fieldhand.site.model import Site

#: A phrase with one of these says itself where its trees are.
_SAID = frozenset(
    {"ROW", "ROWIDS", "BLOCKIDS", "OVER", "STEP", "OPPOSITE", "IT", "THERE", "CHARGER", "CORNER", "ZONE", "ANOTHER"}
    | {"NEARBY", "NEAREST", "FARTHEST", "FAR", "NEXTTO", "NEAR", "WITHIN", "PLOT", "EVERYWHERE"}
)
_ELSEWHERE = ("go", "visit", "lead", "come_back", "stop", "repeat")
_BETWEEN = ("order", "budget", "distinct")


def with_areas(parts: tuple[ClausePart, ...], site: Site) -> tuple[ClausePart, ...]:
    """The parts of a sentence, an area in front of a command put behind the trees that it is about."""
    made: list[ClausePart] = []
    area: ClausePart | None = None  # rows along which the robot was sent, for the rest of the sentence
    for part in parts:
        at = next((k for k in range(len(made) - 1, -1, -1) if made[k].kind not in _BETWEEN), None)
        lead = None if at is None else made[at]
        if lead is not None and lead.kind == "go" and _stops(part) and _goes_along(lead, site):
            stop = _stop_along(lead, part)
            if stop is not None:
                made[made.index(lead)] = stop
                area = lead
                continue
        goes_on = part.kind == "lead" and area is not None and any(m.kind in ACTS for m in made)
        if goes_on and area is not None and area.places is not None and _open(part, ids=False):
            found = None if part.places is None else find(part.places, site)
            if part.places is not None and found is not None and not found.region:  # "..., and at the last tree"
                made.append(replace(part, places=_in_area(part.places, area, area.places.chains[0])))
                continue
        if part.kind not in ACTS:
            area = None if part.kind in _ELSEWHERE else area
            made.append(part)
            continue
        if at is not None and lead is not None and lead.kind in ("lead", "go", "visit"):
            merged = _merged(lead, part, site)
            if merged is not None:
                del made[at]
                area = lead
                made.append(merged)
                continue
            if _goes_along(lead, site) and any(_is_each(t) for t in part.tails):
                made[at] = replace(lead, kind="visit")
        elif area is not None and part.places is not None and area.places is not None and _open(part, ids=False):
            part = replace(part, places=_in_area(part.places, area, area.places.chains[0]))
        made.append(part)
    return tuple(made)


def _stops(part: ClausePart) -> bool:
    return part.kind in ("visit", "lead", "go") and part.places is not None and part.spacing is None


def _stop_along(lead: ClausePart, part: ClausePart) -> ClausePart | None:
    """ "Drive down row 3, stop at every third tree and ..."."""
    if part.places is None or lead.places is None or not _open(part, ids=False) or len(lead.places.chains) != 1:
        return None
    if part.relation is not None and part.relation.kind not in ("AT", "FOR"):
        return None
    places = _in_area(part.places, lead, lead.places.chains[0])
    return replace(part, places=places, terms=(*lead.terms, *part.terms), then=lead.then)


def _merged(lead: ClausePart, part: ClausePart, site: Site) -> ClausePart | None:
    """A command with the area, the rows or the spacing in front of it; None if they do not belong to it."""
    if lead.spacing is not None and part.spacing is not None:
        raise unclear(lead.terms, message("stops cannot have two different distances"), message("say one"))
    spacing = part.spacing or lead.spacing
    whole = replace(part, spacing=spacing, terms=(*lead.terms, *part.terms), then=lead.then)
    if lead.places is None:
        return whole if lead.spacing is not None else None
    found = find(lead.places, site)
    edge = found.line and not found.rows and lead.relation is not None and lead.relation.kind == "ALONG"
    if lead.kind != "lead" and not (found.rows or edge):
        return None
    if part.places is None:
        return _without_places(lead, whole, found) if found.rows or spacing is not None or edge else None
    if not (found.region or found.rows):
        return None if spacing is part.spacing else _clash(lead)
    areal = ("AT", "INSIDE", "ALONG", "FOR") if found.rows else ("AT", "INSIDE")
    if lead.kind == "lead" and (lead.relation is None or lead.relation.kind not in areal):
        raise unclear(
            lead.terms,
            message("it is not clear to what that area belongs"),
            message("say 'the trees in the northern half'"),
        )
    if len(lead.places.chains) != 1:
        raise unclear(
            lead.terms,
            message("it is not clear to what that area belongs"),
            message("say 'the trees in the northern half'"),
        )
    area = lead.places.chains[0]
    some = _some_of_them(whole, area) or _in_each(whole, lead, area)
    if some is not None:
        return some
    if lead.kind != "lead" and not _open(part, ids=True):
        step = any(t.kind == "STEP" for t in part.places.terms) and found.selector == s.RowOf()
        return whole if step else None
    tails = tuple(t for t in whole.tails if t.kind != "THERE" or are_several(t))
    return replace(whole, places=_in_area(part.places, lead, area), tails=tails if found.rows else whole.tails)


def _clash(lead: ClausePart) -> ClausePart:
    raise unclear(
        lead.terms, message("stops at a distance need a line of their own"), message("say 'every 20 m along row 4'")
    )


def _without_places(lead: ClausePart, whole: ClausePart, found: FoundPlace) -> ClausePart | None:
    """ "In row 3, take 5 pictures": the rows are where it is done."""
    if not found.region or any(_is_each(t) for t in whole.tails):
        return None
    tails = tuple(t for t in whole.tails if t.kind != "THERE")
    relation = lead.relation or silent("AT", lead.terms[-1].end)
    return replace(whole, places=lead.places, relation=relation, tails=tails)


def _some_of_them(part: ClausePart, area: Chain) -> ClausePart | None:
    """ "Drive along a row of 5 trees and take a picture at 3 of them"."""
    them = next(
        (t for t in part.tails if t.kind == "THERE" and t.text.lower().startswith("of ") and are_several(t)), None
    )
    places = part.places
    if them is None or places is None or len(places.chains) != 1 or len(places.chains[0].phrases) != 1:
        return None
    phrase = places.chains[0].phrases[0]
    if phrase.nominals or phrase.there is not None or not all(t.kind in ("NUM", "ANY") for t in phrase.quantity):
        return None
    chain = Chain(phrases=(phrase, *area.phrases), relations=(replace(them, kind="OF", value="OF"), *area.relations))
    tails = tuple(t for t in part.tails if t is not them)
    return replace(part, places=replace(places, chains=(chain,)), tails=tails)


def _in_each(part: ClausePart, lead: ClausePart, area: Chain) -> ClausePart | None:
    """ "Visit rows 2 and 4 and take 2 pictures in each": in each of the rows."""
    chains = part.places.chains if part.places is not None else ()
    alone = len(chains) == 1 and len(chains[0].phrases) == 1 and not chains[0].phrases[0].nominals
    quantity = chains[0].phrases[0].quantity if alone else ()
    if not quantity or any(t.kind != "EACH" for t in quantity) or lead.places is None:
        return None
    rows = replace(area.phrases[0], quantity=(*quantity, *area.phrases[0].quantity))
    chain = replace(area, phrases=(rows, *area.phrases[1:]))
    return replace(part, places=replace(lead.places, chains=(chain,)))


def _in_area(places: Places, lead: ClausePart, area: Chain) -> Places:
    relation = lead.relation or silent("AT", lead.terms[-1].end)
    if relation.kind == "FOR":
        relation = replace(relation, kind="AT")
    chains = tuple(
        replace(
            chain,
            phrases=(*chain.phrases, *area.phrases),
            relations=(*chain.relations, relation, *area.relations),
        )
        for chain in places.chains
    )
    return replace(places, chains=chains)


def _goes_along(lead: ClausePart, site: Site) -> bool:
    return lead.kind == "go" and lead.places is not None and find(lead.places, site).rows


def _is_each(term: Term) -> bool:
    return term.kind == "THERE" and are_several(term)


def _open(part: ClausePart, *, ids: bool) -> bool:
    """Whether a command does not say itself where its trees are."""
    return part.places is not None and is_open(part.places, ids=ids)


def is_open(places: Places, *, ids: bool = False) -> bool:
    """Whether places could be those of any rows ("every third tree"); trees by their ids only if asked for."""
    kinds = {t.kind for t in places.terms if not (t.kind == "NEARBY" and t.text.lower() == "next")}
    return not kinds & _SAID and (ids or "IDS" not in kinds)
