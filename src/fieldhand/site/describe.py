"""What is known of a site, in figures and in a few lines.

Both are bounded: a site of 100,000 trees, 10,000 distinct values or names of a megabyte says no more lines, and no
longer ones, than a small site. A language model's prompt holds these lines and nothing else of the site.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass

import numpy as np
from shapely.geometry import MultiPoint

from fieldhand.site.features import clean
from fieldhand.site.kinds import number_text
from fieldhand.site.model import Site, ZoneKind
from fieldhand.site.places.rectangle import smallest_rectangle
from fieldhand.task.selectors import Value

MOST_VALUES = 8
MOST_ATTRIBUTES = 20
MOST_ZONES = 12
MOST_NOTES = 5
LONGEST = 40

_KINDS: dict[ZoneKind, str] = {"boundary": "boundary", "keep_out": "keep-out", "zone": "zone"}


@dataclass(frozen=True, kw_only=True)
class AttributeSummary:
    """One attribute of the trees.

    Attributes:
        trees: How many trees have it.
        distinct: How many different values it has.
        minimum, maximum: Where all its values are numbers.
        values: The most frequent values as text, the most frequent first (ties in order of the text).
    """

    name: str
    trees: int
    distinct: int
    minimum: float | None
    maximum: float | None
    values: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class ZoneSummary:
    """All zones of one name and kind. ``trees`` stand inside or on the edge."""

    name: str
    kind: ZoneKind
    area_m2: float
    trees: int


@dataclass(frozen=True, kw_only=True)
class SiteSummary:
    """A site in figures.

    Attributes:
        first_id, last_id: Ids of the first and last tree of the file.
        east_west_m, north_south_m: Extent of the trees along true north.
        area_m2: Of the convex hull of the trees.
        turned_deg: How far the smallest rectangle around the trees is turned clockwise from true north, -45 to 45.
        spacing_m: Median distance from a tree to its nearest neighbour.
        rows: How many rows the file names; 0 where it names none.
        markers: Name, and metres east and north of the middle of the trees.
        zones, attributes: The first few; ``zones_left_out`` and ``attributes_left_out`` say how many more there are.
    """

    name: str
    source: str
    trees: int
    first_id: str
    last_id: str
    east_west_m: float
    north_south_m: float
    area_m2: float
    turned_deg: float
    spacing_m: float
    rows: int
    latitude: float
    longitude: float
    markers: tuple[tuple[str, float, float], ...]
    zones: tuple[ZoneSummary, ...]
    zones_left_out: int
    attributes: tuple[AttributeSummary, ...]
    attributes_left_out: int
    notes: tuple[str, ...]


def describe(site: Site) -> SiteSummary:
    """The site in figures; its size does not grow with the site."""
    east_west, north_south = np.ptp(site.xy, axis=0).tolist()
    zones = _zones(site)
    return SiteSummary(
        name=_short(site.name),
        source=site.source,
        trees=len(site.trees),
        first_id=site.trees[0].place.id,
        last_id=site.trees[-1].place.id,
        east_west_m=east_west,
        north_south_m=north_south,
        area_m2=float(MultiPoint(site.xy).convex_hull.area),
        turned_deg=_turned_deg(site),
        spacing_m=site.spacing_m,
        rows=len({t.row for t in site.trees} - {""}),
        latitude=site.projection.lat,
        longitude=site.projection.lon,
        markers=tuple((name, *site.markers[name].xy) for name in sorted(site.markers)),
        zones=zones[:MOST_ZONES],
        zones_left_out=max(len(zones) - MOST_ZONES, 0),
        attributes=tuple(_attribute(site, name) for name in list(site.attributes)[:MOST_ATTRIBUTES]),
        attributes_left_out=max(len(site.attributes) - MOST_ATTRIBUTES, 0),
        notes=tuple(_short(note, 160) for note in site.notes[:MOST_NOTES]),
    )


def summary_lines(site: Site) -> list[str]:
    """The site in a few lines of bounded length."""
    s = describe(site)
    lines = [
        f"Site {s.name}: {s.trees} tree{'s' * (s.trees > 1)}, ids {s.first_id} to {s.last_id} in file order.",
        f"Extent: {s.east_west_m:.0f} m east-west, {s.north_south_m:.0f} m north-south, "
        f"hull {_area_words(s.area_m2)}; spacing {s.spacing_m:.1f} m{_turned_words(s)}.",
    ]
    if s.rows:
        lines.append(f"Rows named in the file: {s.rows}.")
    lines.append(f"Markers: {'; '.join(_marker_words(m) for m in s.markers) or 'none'}.")
    lines.extend(
        f"{_KINDS[z.kind].capitalize()} {z.name!r}: {z.area_m2:.0f} m2, {z.trees} trees inside." for z in s.zones
    )
    if s.zones_left_out:
        lines.append(f"And {s.zones_left_out} more zones.")
    lines.extend(f"Attribute {_attribute_words(a, s.trees)}" for a in s.attributes)
    if s.attributes_left_out:
        lines.append(f"And {s.attributes_left_out} more attributes.")
    lines.extend(f"Note: {note}." for note in s.notes)
    return lines


def _zones(site: Site) -> tuple[ZoneSummary, ...]:
    import shapely

    found: dict[tuple[ZoneKind, str], tuple[float, np.ndarray[tuple[int], np.dtype[np.bool_]]]] = {}
    for zone in site.zones[: 4 * MOST_ZONES]:
        shapely.prepare(zone.polygon)
        inside = np.asarray(shapely.intersects_xy(zone.polygon, site.xy[:, 0], site.xy[:, 1]))
        area, before = found.get((zone.kind, zone.name), (0.0, np.zeros(len(site.trees), dtype=bool)))
        found[zone.kind, zone.name] = (area + float(zone.polygon.area), before | inside)
    more = {(z.kind, z.name) for z in site.zones[4 * MOST_ZONES :]} - set(found)
    summaries = [
        ZoneSummary(name=_short(name), kind=kind, area_m2=area, trees=int(inside.sum()))
        for (kind, name), (area, inside) in found.items()
    ]
    rest = [ZoneSummary(name=_short(name), kind=kind, area_m2=0.0, trees=0) for kind, name in sorted(more)]
    return (*summaries, *rest)


def _attribute(site: Site, name: str) -> AttributeSummary:
    held = [t.properties[name] for t in site.trees if name in t.properties]
    numbers = [v for v in held if isinstance(v, float)]
    numeric = len(numbers) == len(held)
    frequent = sorted(Counter(_value_text(v) for v in held).items(), key=lambda item: (-item[1], item[0]))
    return AttributeSummary(
        name=_short(name),
        trees=len(held),
        distinct=len(frequent),
        minimum=min(numbers) if numeric else None,
        maximum=max(numbers) if numeric else None,
        values=tuple(_short(text) for text, _ in frequent[:MOST_VALUES]),
    )


def _attribute_words(attribute: AttributeSummary, trees: int) -> str:
    if attribute.minimum is not None and attribute.maximum is not None and attribute.distinct > MOST_VALUES:
        values = f"numbers from {_figure(attribute.minimum)} to {_figure(attribute.maximum)}"
    else:
        values = ", ".join(attribute.values)
        if attribute.distinct > len(attribute.values):
            values += f" and {attribute.distinct - len(attribute.values)} more values"
    some = f" (on {attribute.trees} of the trees)" if attribute.trees < trees else ""
    return f"{attribute.name}{some}: {values}."


def _figure(number: float) -> str:
    """Four digits are enough to say how large a number is; whole numbers are told in full."""
    return number_text(number) if number == int(number) and abs(number) < 1e9 else f"{number:.4g}"


def _area_words(square_metres: float) -> str:
    return f"{square_metres / 10_000:.2f} ha" if square_metres >= 1000.0 else f"{square_metres:.0f} m2"


def _value_text(value: Value) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float) else value


def _marker_words(marker: tuple[str, float, float]) -> str:
    name, x, y = marker
    sides = [
        f"{abs(y):.0f} m {'north' if y > 0 else 'south'}" if abs(y) >= 0.5 else "",
        f"{abs(x):.0f} m {'east' if x > 0 else 'west'}" if abs(x) >= 0.5 else "",
    ]
    away = " and ".join(side for side in sides if side)
    return f"{name} {away + ' of' if away else 'in'} the middle"


def _turned_words(summary: SiteSummary) -> str:
    turned = round(summary.turned_deg)
    if summary.trees < 3 or turned == 0:
        return ""
    return f", turned {abs(turned)} degrees {'clockwise' if turned > 0 else 'anticlockwise'} from true north"


def _turned_deg(site: Site) -> float:
    corners = smallest_rectangle(site.xy)
    side = corners[1] - corners[0]
    if not side.any():
        return 0.0
    bearing = math.degrees(math.atan2(side[0], side[1]))
    return (bearing + 45.0) % 90.0 - 45.0


def _short(text: str, longest: int = LONGEST) -> str:
    text = clean(text[: 4 * longest])
    return text if len(text) <= longest else text[: longest - 3] + "..."
