"""Describe a site in words for people."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import asdict
from typing import Any

from fieldhand.site.describe.aisles import aisle_table
from fieldhand.site.describe.driving import DrivingSummary, driving_lines
from fieldhand.site.describe.figures import (
    MOST_VALUES,
    AttributeSummary,
    SiteSummary,
    describe,
)
from fieldhand.site.describe.rows import (
    RowSummary,
    block_name,
    block_words,
    counting_words,
    row_table,
    table_lines,
)
from fieldhand.site.feature_kinds import ZoneKind, number_text
from fieldhand.site.model import Site
from fieldhand.site.names import listed

_KINDS: dict[ZoneKind, str] = {"boundary": "boundary", "keep_out": "keep-out", "zone": "zone"}
#: More rows than this are listed on request only.
_MOST_ROWS = 30


def report_lines(site: Site, driving: DrivingSummary | None = None, *, all_rows: bool = False) -> list[str]:
    """Return the description of a site in lines of text.

    Args:
        site: Site to describe.
        driving: Drivable parts for a robot, if they are to be included.
        all_rows: List every row, even if there are many.
    """
    s = describe(site)
    drivable = [] if driving is None else driving_lines(driving)
    return [*_site_lines(s), *_row_lines(site, s, all_rows=all_rows), *drivable, *_place_lines(s)]


def report_record(site: Site, driving: DrivingSummary | None = None) -> dict[str, Any]:
    """Return the description of a site for programs, with every row and every aisle."""
    record = asdict(describe(site))
    record["row_table"] = [asdict(row) for row in row_table(site)]
    record["aisle_table"] = [asdict(aisle) for aisle in aisle_table(site)]
    if driving is not None:
        record["driving"] = asdict(driving)
    return record


def _site_lines(s: SiteSummary) -> list[str]:
    ids = f"ids {s.first_id} to {s.last_id} in file order" if s.trees > 1 else f"id {s.first_id}"
    if not s.trees:
        return [
            f"Site {s.name}: no trees, only areas.",
            f"Extent: {s.east_west_m:.0f} m east-west, {s.north_south_m:.0f} m north-south, "
            f"hull {_area_words(s.area_m2)}.",
        ]
    return [
        f"Site {s.name}: {s.trees:,} tree{'s' * (s.trees > 1)}, {ids}.",
        f"Extent: {s.east_west_m:.0f} m east-west, {s.north_south_m:.0f} m north-south, "
        f"hull {_area_words(s.area_m2)}; spacing {s.spacing_m:.1f} m{_turned_words(s)}.",
    ]


def _planting_lines(s: SiteSummary, most: int) -> list[str]:
    """Return a line for each block, and one for the trees in no row."""
    if not s.blocks:
        return [f"Rows: none; {s.why_no_row or 'the trees do not stand in rows'}."]
    several = len(s.blocks) + s.blocks_left_out > 1
    lines = [
        f"{'' if several else 'Rows: '}{_lower(block_words(b, several=several), several)}" for b in s.blocks[:most]
    ]
    if len(s.blocks) + s.blocks_left_out > most:
        lines.append(f"And {len(s.blocks) + s.blocks_left_out - most} more blocks; {s.rows:,} rows in all.")
    ways = list(dict.fromkeys(counting_words(b) for b in s.blocks))
    lines.append(
        f"{_capital(ways[0])}."
        if len(ways) == 1
        else f"Rows are counted from {listed([f'{b.counted_from} in {_in_block(b.name)}' for b in s.blocks[:most]])}."
    )
    if s.in_no_row:
        ids = ", ".join(s.in_no_row_ids) + (" ..." if s.in_no_row > len(s.in_no_row_ids) else "")
        text = s.why_no_row or f"{s.in_no_row:,} tree{'s' * (s.in_no_row != 1)} not in a row"
        lines.append(f"{_capital(text)}: {ids}.")
    return lines


def _row_lines(site: Site, s: SiteSummary, *, all_rows: bool) -> list[str]:
    """Return the blocks with their rows: all rows if there are few, else the shortest and the longest."""
    lines = _planting_lines(s, len(s.blocks))
    if not s.blocks:
        return lines
    several = len(s.blocks) > 1
    if all_rows or s.rows <= _MOST_ROWS:
        return [*lines, *(f"  {line}" for line in table_lines(row_table(site), several=several))]
    row_ends = itertools.chain.from_iterable(_ends_of(b.shortest, b.longest, several) for b in s.blocks)
    return [*lines, *row_ends, f"  (--rows lists all {s.rows:,} rows)"]


def _ends_of(shortest: RowSummary, longest: RowSummary, several: bool) -> Iterator[str]:
    where = f"{block_name(shortest.block)}: " if several else ""
    if shortest.trees == longest.trees:
        yield f"  {where}every row has {shortest.trees:,} trees"
        return
    yield f"  {where}shortest {_row_words(shortest)}, longest {_row_words(longest)}"


def _row_words(row: RowSummary) -> str:
    return f"row {row.name} ({row.trees:,} tree{'s' * (row.trees != 1)}, {row.length_m:.0f} m)"


def _place_lines(s: SiteSummary) -> list[str]:
    """Return the markers, gates, zones, attributes and notes."""
    lines = [f"Markers: {'; '.join(marker_words(m) for m in s.markers) or 'none'}."]
    if s.gates:
        lines.append(f"Gates: {', '.join(f'{name!r} {width:.1f} m wide' for name, width in s.gates)}.")
    lines.extend(
        f"{_KINDS[z.kind].capitalize()} {z.name!r}: {_area_words(z.area_m2)}, "
        f"{z.trees:,} tree{'s' * (z.trees != 1)} inside."
        for z in s.zones
    )
    if s.zones_left_out:
        lines.append(f"And {s.zones_left_out} more zones.")
    lines.extend(f"Attribute {_attribute_words(a, s.trees)}" for a in s.attributes)
    if s.attributes_left_out:
        lines.append(f"And {s.attributes_left_out} more attributes.")
    lines.extend(f"Note: {note}." for note in s.notes)
    return lines


def _attribute_words(attribute: AttributeSummary, trees: int) -> str:
    if attribute.minimum is not None and attribute.maximum is not None and attribute.distinct > MOST_VALUES:
        values = f"numbers from {figure_words(attribute.minimum)} to {figure_words(attribute.maximum)}"
    else:
        values = ", ".join(attribute.values)
        if attribute.distinct > len(attribute.values):
            values += f" and {attribute.distinct - len(attribute.values)} more values"
    some = f" (on {attribute.trees} of the trees)" if attribute.trees < trees else ""
    return f"{attribute.name}{some}: {values}."


def figure_words(number: float) -> str:
    """Return a number with four significant digits, or a whole number in full."""
    return number_text(number) if number == int(number) and abs(number) < 1e9 else f"{number:.4g}"


def _area_words(square_metres: float) -> str:
    if square_metres >= 1000.0:
        return f"{square_metres / 10_000:.2f} ha"
    return f"{square_metres:.0f} m2" if square_metres >= 1.0 else f"{square_metres:.1f} m2"


def marker_words(marker: tuple[str, float, float]) -> str:
    """Return the name of a marker and its position relative to the middle of the trees."""
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


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _lower(text: str, keep: bool) -> str:
    return text if keep else text[:1].lower() + text[1:]


def _in_block(name: str) -> str:
    called = block_name(name)
    return called if called == name else called[0].lower() + called[1:]
