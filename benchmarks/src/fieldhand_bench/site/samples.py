"""Examples of each selector and of nested ones, for any site that has rows, a zone and attributes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fieldhand.places.reading_series import EXAMPLE_QUANTITY
from fieldhand.places.selector import Selector
from fieldhand.places.selectors import (
    SELECTORS,
    EveryNth,
    Half,
    InBlock,
    InZone,
    NotVisited,
    Ordered,
    Rows,
    Take,
    Top,
    Where,
)
from fieldhand.site.earlier_missions import EarlierCapture, EarlierMission, EarlierMissions, EarlierValue
from fieldhand.site.model import Site
from fieldhand.terms import Side


def samples(site: Site) -> Mapping[str, Selector]:
    """Return an example of each selector, and nested ones, by name; their context needs a current and a bound tree."""
    zone, block = InZone.example(site).zone, InBlock.example(site).block
    nested: dict[str, Selector] = {
        "every third old tree of rows 2 to 5 of a block in one half": EveryNth(
            nth=3,
            of=Where(
                attribute="age_years",
                test="gt",
                value=10.0,
                of=Rows(first="2", last="5", of=InBlock(block=block, of=Half(side=_half_of_first_rows(site)))),
            ),
        ),
        "the 10 best trees outside the zone, row by row": Ordered(
            by="rows", of=Top(attribute="yield_kg", count=10, of=InZone(zone=zone, outside=True))
        ),
        "10 trees not visited, nearest first": Take(count=10, of=NotVisited(of=Half(side="west"))),
    }
    return {cls.__name__: cls.example(site) for cls in SELECTORS} | nested


def with_records(site: Site) -> Site:
    """Return the site with an earlier mission, which took a thermal picture of every third tree."""
    at = "2026-06-10T08:00:00+00:00"
    captures = tuple(
        EarlierCapture(
            place=tree.place.id,
            at=at,
            action="take_thermal_picture",
            values=(EarlierValue(name=EXAMPLE_QUANTITY, value=31.0, unit="degC"),),
        )
        for tree in site.trees[::3]
    )
    mission = EarlierMission(id="m1", begun=at, captures=captures)
    return site.with_earlier(EarlierMissions(as_of="2026-06-17T08:00:00+00:00", missions=(mission,)))


def _half_of_first_rows(site: Site) -> Side:
    """Return the half of the site that contains most of the third row of the first block."""
    rows = site.planting.blocks[0].rows if site.planting.blocks else ()
    if len(rows) < 3:
        return "north"
    middle = (site.xy[:, 1].min() + site.xy[:, 1].max()) / 2
    return "north" if np.median(site.xy[rows[2].trees, 1]) > middle else "south"
