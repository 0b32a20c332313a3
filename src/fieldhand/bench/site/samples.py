"""Each selector as a planner would write it, for any site that has rows, a zone and attributes."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fieldhand.places.selectors import (
    Across,
    Adjacent,
    AlongRow,
    AmongExtreme,
    Apart,
    Bound,
    Corners,
    Edge,
    EdgeMiddle,
    EveryNth,
    Excluding,
    Extreme,
    Farthest,
    First,
    GateIs,
    Half,
    Here,
    InBlock,
    InRow,
    InZone,
    Last,
    Marker,
    Middle,
    Nearest,
    Nth,
    Ordered,
    Other,
    PointsIn,
    Quarter,
    Random,
    RowOf,
    Rows,
    Selector,
    Spaced,
    Spread,
    Successive,
    Take,
    Top,
    TreeIs,
    Trees,
    Union,
    Where,
    Within,
)
from fieldhand.site.model import Site
from fieldhand.terms import Side

LABEL = "seen"


def samples(site: Site) -> Mapping[str, Selector]:
    """A selector of each kind by name, and some that nest; for a context in which a tree is in hand and bound."""
    tree = TreeIs(tree=site.trees[len(site.trees) // 2].place.id)
    zone = next((z.name for z in site.zones if z.kind == "zone"), "")
    block = site.planting.blocks[0].name if site.planting.blocks else ""
    old = Where(attribute="age_years", test="gt", value=10.0)
    single: tuple[Selector, ...] = (
        Trees(),
        tree,
        Marker(name="start"),
        GateIs(gate=site.gates[0].place.id if site.gates else ""),
        Here(),
        Bound(label=LABEL),
        First(),
        Last(),
        Corners(),
        Extreme(side="north", count=3),
        AmongExtreme(side="east"),
        Middle(),
        EdgeMiddle(side="east"),
        Half(side="north"),
        Quarter(quarter="se"),
        Edge(side="west"),
        Nearest(to=Here(), count=5, adjacent=True),
        Farthest(origin=Here(), count=5),
        Adjacent(near=Here(), count=5),
        Other(),
        Excluding(places=Half(side="south")),
        Where(attribute="variety", test="eq", value="Kerman"),
        Top(attribute="yield_kg", count=10),
        InZone(zone=zone),
        Within(distance_m=20.0, to=Here()),
        Take(count=10, of=old),
        Random(count=10, of=old),
        Spread(count=10, of=old),
        InBlock(block=block),
        Rows(first="2", last="-2", every=2, of=InBlock(block=block)),
        RowOf(over=1),
        InRow(first=2, last=-2),
        EveryNth(nth=3),
        AlongRow(trees=3),
        Across(),
        Successive(count=4),
        Ordered(by="rows"),
        Nth(nth=2, of=Ordered(by="north_to_south")),
        Spaced(apart_m=15.0),
        Apart(apart_m=25.0, count=5),
        PointsIn(zone=zone, count=9),
        Union(parts=(First(), Last(), Corners())),
    )
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
        "10 trees not visited, nearest first": Take(count=10, of=Other(of=Half(side="west"))),
    }
    return {type(selector).__name__: selector for selector in single} | nested


def _half_of_first_rows(site: Site) -> Side:
    """The half of the site in which the third row of the first block stands for the most part."""
    rows = site.planting.blocks[0].rows if site.planting.blocks else ()
    if len(rows) < 3:
        return "north"
    middle = (site.xy[:, 1].min() + site.xy[:, 1].max()) / 2
    return "north" if np.median(site.xy[rows[2].trees, 1]) > middle else "south"
