"""Sites for tests: from points in metres, as objects or as GeoJSON, and hypothesis strategies for them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from hypothesis import strategies as st
from shapely.geometry import Polygon

from fieldhand.places.context import Context
from fieldhand.site.feature_kinds import ZoneKind
from fieldhand.site.loader import parse_site
from fieldhand.site.model import Place, Site, Tree, Zone
from fieldhand.site.planting import Block, Planting, Row
from fieldhand.site.projection import Projection
from fieldhand.terms import Value

XY = tuple[float, float]
HOME = Projection(37.0, -120.0)


def place_at(x: float, y: float, *, kind: str = "point", id: str = "spot") -> Place:  # noqa: A002
    """A place at metres east and north of the home projection's origin."""
    lat, lon = HOME.degrees([[x, y]])[0].tolist()
    return Place(kind=kind, id=id, x=float(x), y=float(y), lat=lat, lon=lon)  # type: ignore[arg-type]


def site_of(
    points: Sequence[XY],
    *,
    markers: Mapping[str, XY] | None = None,
    zones: Sequence[tuple[str, ZoneKind, Sequence[XY] | Polygon]] = (),
    properties: Sequence[Mapping[str, Value]] = (),
    row_names: Sequence[str] = (),
) -> Site:
    """A site with trees 1, 2, 3 ... at exactly these metres east and north."""
    trees = tuple(
        Tree(
            place=place_at(x, y, kind="tree", id=str(k + 1)),
            index=k,
            feature=k + 1,
            properties=properties[k] if properties else {},
            row=row_names[k] if row_names else "",
        )
        for k, (x, y) in enumerate(points)
    )
    return Site(
        name="test site",
        trees=trees,
        markers={name: place_at(x, y, kind="marker", id=name) for name, (x, y) in (markers or {}).items()},
        zones=tuple(
            Zone(name=name, kind=kind, polygon=shape if isinstance(shape, Polygon) else Polygon(shape))
            for name, kind, shape in zones
        ),
        projection=HOME,
        sha256="0" * 64,
    )


def grid(columns: int, rows: int, *, across: float = 6.0, along: float = 4.0) -> list[XY]:
    """Points of a rectangular orchard, column by column from the west, each from south to north."""
    return [(c * across, r * along) for c in range(columns) for r in range(rows)]


def orchard(columns: int = 4, rows: int = 5, **more: Any) -> Site:
    """A rectangular orchard: 4 columns 6 m apart, 5 trees 4 m apart; trees count north, then to the next column."""
    return site_of(grid(columns, rows), **more)


def at_start(site: Site, *, visited: Sequence[str] = ()) -> Context:
    """The context of a mission that has not moved yet, or has visited some trees."""
    return Context(here=site.start, visited=tuple(visited))


def point(lon: float, lat: float, **properties: Any) -> dict[str, Any]:
    """A GeoJSON Point feature."""
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Point", "coordinates": [lon, lat]}}


def area(ring: Sequence[Sequence[float]], **properties: Any) -> dict[str, Any]:
    """A GeoJSON Polygon feature of one ring, as given."""
    coordinates = [[list(p) for p in ring]]
    return {"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": coordinates}}


def square(lon: float, lat: float, half: float = 0.0001) -> list[list[float]]:
    """A closed ring in degrees around a point."""
    w, s, e, n = lon - half, lat - half, lon + half, lat + half
    return [[w, s], [e, s], [e, n], [w, n], [w, s]]


def collection(*features: Any, **more: Any) -> bytes:
    """A GeoJSON FeatureCollection as bytes."""
    return json.dumps({"type": "FeatureCollection", "features": list(features), **more}).encode()


def read(*features: Any, **more: Any) -> Site:
    """A site read from these features."""
    return parse_site(collection(*features, **more), name="field", source="field.geojson")


metres = st.integers(-300, 300).map(lambda k: k / 4)


def points(min_size: int = 1, max_size: int = 30) -> st.SearchStrategy[list[XY]]:
    """Distinct points on a quarter-metre raster, in no order; ties in distance are common."""
    return st.lists(st.tuples(metres, metres), min_size=min_size, max_size=max_size, unique=True)


def sites(min_size: int = 1, max_size: int = 30) -> st.SearchStrategy[Site]:
    """Sites of bare trees."""
    return points(min_size, max_size).map(site_of)


def planted(blocks: Sequence[tuple[str, float, Sequence[tuple[str, Sequence[XY]]]]], **more: Any) -> Site:
    """A site whose rows are known: blocks by name and bearing, in each rows by name with trees from their usual end.

    Trees count 1, 2, 3 ... block by block and row by row; ``more`` as for :func:`site_of`, and ``order``, the order of
    the file, as positions of trees in that count.
    """
    points = [xy for _, _, rows in blocks for _, row in rows for xy in row]
    order = list(more.pop("order", range(len(points))))
    site = site_of([points[k] for k in order], **more)
    at = {k: place for place, k in enumerate(order)}
    made, count = [], 0
    for number, (name, bearing, rows) in enumerate(blocks):
        row_list = []
        for k, (row_name, row) in enumerate(rows, start=1):
            trees = np.array([at[count + j] for j in range(len(row))], dtype=np.intp)
            count += len(row)
            row_list.append(
                Row(
                    name=row_name, number=k, block=number, trees=trees, slots=np.arange(1, len(row) + 1), known="file",
                    confidence=1.0,
                )
            )  # fmt: skip
        made.append(
            Block(
                name=name, rows=tuple(row_list), bearing_deg=bearing, row_spacing_m=6.0 if len(rows) > 1 else math.nan,
                tree_spacing_m=4.0, known="file", confidence=1.0,
            )
        )  # fmt: skip
    vars(site)["planting"] = Planting(blocks=tuple(made), tree_count=len(points), why="" if made else "none are named")
    return site


def without_rows(site: Site) -> Site:
    """The site with its trees scattered, whatever rows might be seen in them."""
    vars(site)["planting"] = Planting(blocks=(), tree_count=len(site.trees), why="the trees do not stand in rows")
    return site
