"""An area in front of a command: "in the northern half, photograph the yellow trees"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.places import find
from fieldhand.planning.english.syntax import Part
from fieldhand.site.model import Site

ACTS = ("act_on_objects", "act_on_places", "act_bare", "more_objects", "more_places")


def with_areas(parts: tuple[Part, ...], site: Site) -> tuple[Part, ...]:
    """ "In the northern half, photograph the yellow trees": the area in front belongs to the trees behind it."""
    made: list[Part] = []
    for part in parts:
        lead = made[-1] if made else None
        if lead is None or lead.kind != "lead" or lead.places is None or lead.relation is None:
            made.append(part)
            continue
        if part.places is None or part.kind not in ACTS or not find(lead.places, site).region:
            made.append(part)
            continue
        if len(lead.places.chains) != 1 or lead.relation.kind not in ("AT", "INSIDE"):
            raise unclear(lead.terms, "it is not clear what that area is of", "say 'the trees in the northern half'")
        area = lead.places.chains[0]
        chains = tuple(
            replace(
                chain,
                phrases=(*chain.phrases, *area.phrases),
                relations=(*chain.relations, lead.relation, *area.relations),
            )
            for chain in part.places.chains
        )
        made[-1] = replace(
            part, places=replace(part.places, chains=chains), terms=(*lead.terms, *part.terms), then=lead.then
        )
    return tuple(made)
