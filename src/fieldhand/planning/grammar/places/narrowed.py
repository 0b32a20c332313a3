"""Constructions of areas of which only a part is meant: "the paddock, but only the western half"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.selections import as_zone, part_on_side
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction

#: Least share of a zone that lies in the zone that it is a part of.
_INSIDE = 0.9


@construction(
    "region: whole=region [COMMA] BUT ONLY part=region", "region: whole=region COMMA ONLY part=region",
    "region: whole=region [COMMA] BUT part=region ONLY", "region: whole=region COMMA part=region ONLY",
    cost=-1.0, given=("site",),
)  # fmt: skip
def only_a_part_of_it(whole: s.Selector, part: s.Selector, site: Site) -> s.Selector | None:
    """Compose "the paddock, but only the western half" and "the meadow, just the wet corner", which lies in it."""
    if len(whole.members) > 1 or len(part.members) > 1:
        return None
    zone = as_zone(part)
    if zone is not None and lies_inside(zone, whole, site):
        return replace(zone, of=whole)
    return part_on_side(part, whole)


def lies_inside(part: s.Selector, whole: s.Selector, site: Site) -> bool:
    """Return True if a zone lies inside another one, but for a strip along its edge."""
    names = [zone.zone if (zone := as_zone(one)) is not None else "" for one in (part, whole)]
    inner, outer = ([zone.polygon for zone in site.zones if zone.name == name] for name in names)
    if len(inner) != 1 or len(outer) != 1:
        return False
    return bool(inner[0].intersection(outer[0]).area >= _INSIDE * inner[0].area and inner[0].area < outer[0].area)
