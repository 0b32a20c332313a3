"""Summarize the names on a site in lines of bounded length, for the prompt of a language model.

Names come first and in full: markers, gates, zones, keep-outs, blocks and their rows, attributes with their values or
ranges. If they do not fit, each kind is reduced to fewer examples, with the total number and a note that any of them
may be named; no kind of name is left out.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from fieldhand.site.counting import rows_from
from fieldhand.site.describe.figures import SiteSummary, describe, value_text
from fieldhand.site.describe.lines import figure_words, marker_words
from fieldhand.site.describe.rows import block_summary, counting_words, direction_words, shortened
from fieldhand.site.feature_kinds import ZoneKind
from fieldhand.site.model import Site, Zone
from fieldhand.terms import Value

#: Number of names shown of each kind, and the characters of each, from the longest summary to the shortest.
_LEVELS = ((60, 40), (30, 40), (16, 32), (10, 24), (6, 20), (4, 16), (3, 12), (2, 10), (1, 8), (0, 8))
#: Greatest total length in characters of the names of one kind.
_LONGEST = 340
#: Up to this many numbers are listed; more are given as a range.
_FEW_NUMBERS = 8
#: Number of attributes with their own line; the names of all others share one.
_MOST_ATTRIBUTES = 30
_MOST_NOTES = 3
_NUMBERED = re.compile(r"(.*?)(0|[1-9]\d{0,8})")
_ZONES: dict[ZoneKind, str] = {"zone": "Zones", "keep_out": "Keep-outs", "boundary": "Boundaries"}


def summary_lines(site: Site, fits: Callable[[Sequence[str]], bool] | None = None) -> list[str]:
    """Return a summary of the site in a few lines of bounded length, with every kind of name on it.

    A site of 100,000 trees, 10,000 distinct values or names of a megabyte gives no more and no longer lines than a
    small site. The prompt of a language model contains only these lines about the site.

    Args:
        site: Site to summarize.
        fits: Function that returns True if lines are short enough. The longest summary that fits is returned, else the
            shortest one.
    """
    lines: list[str] = []
    figures = describe(site)
    for most, longest in _LEVELS:
        lines = _Summary(site, figures, most, longest).lines()
        if fits is None or fits(lines):
            break
    return lines


class _Summary:
    """A summary of a site with a limited number of names of each kind and a limited length of each name."""

    def __init__(self, site: Site, figures: SiteSummary, most: int, longest: int) -> None:
        self._site, self._figures, self._most, self._longest = site, figures, most, longest

    def lines(self) -> list[str]:
        """Return all lines: extent, rows, places, attributes, notes."""
        notes = self._site.notes[:_MOST_NOTES] if self._most >= _LEVELS[3][0] else ()
        return [
            self._extent(),
            *self._blocks(),
            f"Markers: {'; '.join(self._marker(m) for m in self._figures.markers) or 'none'}.",
            f"Gates: {self._names([g.place.id for g in self._site.gates], 'gates') or 'none'}.",
            *self._zones(),
            *self._attributes(),
            *(f"Note: {shortened(note, 160)}." for note in notes),
        ]

    def _marker(self, marker: tuple[str, float, float]) -> str:
        """Return a marker with the name that the site's file gives it."""
        kind, x, y = marker
        name = dict(self._site.marker_names).get(kind, kind)
        called = "" if name == kind else f" (called {shortened(name, self._longest)})"
        return marker_words((f"{kind}{called}", x, y))

    def _extent(self) -> str:
        s = self._figures
        ids = f"ids {s.first_id} to {s.last_id} in file order" if s.trees > 1 else f"id {s.first_id}"
        return (
            f"Site {shortened(s.name, self._longest)}: {s.trees:,} tree{'s' * (s.trees > 1)}, {shortened(ids, 60)}; "
            f"{s.east_west_m:.0f} m east-west, {s.north_south_m:.0f} m north-south, trees {s.spacing_m:.1f} m apart."
        )

    def _blocks(self) -> Iterator[str]:
        """Yield a line for each block with its rows; only the names if there are many blocks."""
        site, s = self._site, self._figures
        blocks = site.planting.blocks
        if not blocks:
            yield f"Rows: none; {s.why_no_row or 'the trees do not stand in rows'}."
            return
        shown = blocks if len(blocks) <= max(1, min(self._most, 8)) else ()
        for block in shown:
            rows, _ = rows_from(site, block, "usual")
            b = block_summary(site, block)
            apart = "" if b.row_spacing_m is None else f", {b.row_spacing_m:.1f} m apart"
            numbered = self._names([row.name for row in rows], "rows")
            yield (
                f"Block {shortened(block.name, self._longest)}: {b.trees:,} trees in {len(rows):,} rows, {numbered}, "
                f"{direction_words(b.bearing_deg)}{apart}; {counting_words(b)}."
            )
        if not shown:
            named = self._names([block.name for block in blocks], "blocks")
            most = max(len(block.rows) for block in blocks)
            yield f"Blocks: {named}; {s.rows:,} rows in all, at most {most:,} in one block, numbered from 1 in each."
            yield f"In block {shortened(s.blocks[0].name, self._longest)} {counting_words(s.blocks[0])}."
        if s.in_no_row:
            yield f"Trees in no row: {s.in_no_row:,}."

    def _zones(self) -> Iterator[str]:
        """Yield a line for each kind of area: the names, with their numbers of trees if there are few."""
        for kind, title in _ZONES.items():
            zones: dict[str, list[Zone]] = {}
            for zone in self._site.zones_of(kind):
                if zone.name:
                    zones.setdefault(zone.name, []).append(zone)
            if not zones:
                continue
            text = self._names(list(zones), title.lower())
            if kind == "zone" and len(zones) <= min(self._most, 12):
                parts = (
                    f"{shortened(name, self._longest)} ({self._inside(same):,} trees)" for name, same in zones.items()
                )
                text = ", ".join(parts)
            yield f"{title}: {text}."

    def _inside(self, zones: Sequence[Zone]) -> int:
        import shapely

        xy = self._site.xy
        inside = np.zeros(len(xy), dtype=bool)
        for zone in zones:
            inside |= np.asarray(shapely.intersects_xy(zone.polygon, xy[:, 0], xy[:, 1]))
        return int(inside.sum())

    def _attributes(self) -> Iterator[str]:
        names = list(self._site.attributes)
        alone = names[: min(_MOST_ATTRIBUTES, 4 * self._most)]
        for name in alone:
            yield f"Attribute {shortened(name, self._longest)}{self._held(name)}: {self._values(name)}."
        if len(names) > len(alone):
            title = "Further attributes" if alone else "Attributes"
            yield f"{title}: {self._names(names[len(alone) :], 'attributes')}."

    def _held(self, name: str) -> str:
        trees = self._site.trees
        held = sum(name in tree.properties for tree in trees)
        return f" (of {held:,} trees)" if held < len(trees) else ""

    def _values(self, name: str) -> str:
        """Return the values of an attribute: all values, a range, or their number with examples."""
        values = self._site.attributes[name]
        if len(values) == len(self._site.trees) > 1 and self._is_id(name):
            return "the id of the tree"
        numbers = [v for v in values if isinstance(v, float)]
        if len(numbers) == len(values) > min(_FEW_NUMBERS, max(self._most, 1)):
            return f"numbers from {figure_words(min(numbers))} to {figure_words(max(numbers))}"
        shown = self._names(self._by_frequency(name, values), "values", number=False)
        return shown + self._in_one_block(name, values)

    def _in_one_block(self, name: str, values: Sequence[Value]) -> str:
        """Return which values all stand in one of several blocks ("; Syrah only in block South"); empty if none do."""
        blocks = self._site.planting.blocks
        if name == "block" or not 1 < len(blocks) <= min(self._most, 8) or len(values) > min(self._most, 8):
            return ""
        found: dict[str, set[str]] = {}
        for block in blocks:
            for tree in (self._site.trees[k] for row in block.rows for k in row.trees):
                if name in tree.properties:
                    found.setdefault(value_text(tree.properties[name]), set()).add(block.name)
        alone = [(value, *held) for value, held in sorted(found.items()) if len(held) == 1]
        if not alone or len(found) < 2:
            return ""
        longest = self._longest
        return "".join(f"; {shortened(v, longest)} only in block {shortened(b, longest)}" for v, b in alone)

    def _is_id(self, name: str) -> bool:
        return all(str(value_text(t.properties.get(name, ""))) == t.place.id for t in self._site.trees)

    def _by_frequency(self, name: str, values: Sequence[Value]) -> list[str]:
        """Return the values as text: in sorted order if all are shown, else the most frequent first."""
        if len(values) <= self._most:
            return [value_text(v) for v in values]
        held = Counter(value_text(t.properties[name]) for t in self._site.trees if name in t.properties)
        return [text for text, _ in sorted(held.items(), key=lambda item: (-item[1], item[0]))]

    def _names(self, names: Sequence[str], kind: str, *, number: bool = True) -> str:
        """Return names of one kind as a list, with runs of numbers as ranges; or their number with examples."""
        runs = _runs(names) if number else list(names)
        shown = [shortened(text, 2 * self._longest) for text in runs[: self._most]]
        while shown and sum(map(len, shown)) + 2 * len(shown) > _LONGEST:
            shown.pop()
        if len(shown) == len(runs):
            return ", ".join(shown)
        example = f", for example {', '.join(shown)}" if shown else ""
        return f"{len(names):,} {kind}{example}; any of them may be named"


def _runs(names: Sequence[str]) -> list[str]:
    """Return the names with each run of three or more consecutive numbers as a range: "R1 to R40"."""
    found: list[str] = []
    k = 0
    while k < len(names):
        end = k
        while end + 1 < len(names) and _follows(names[end], names[end + 1]):
            end += 1
        found += [f"{names[k]} to {names[end]}"] if end - k >= 2 else names[k : end + 1]
        k = end + 1
    return found


def _follows(one: str, other: str) -> bool:
    """Return True if the second name is the first one with the next number."""
    a, b = _NUMBERED.fullmatch(one), _NUMBERED.fullmatch(other)
    return a is not None and b is not None and a[1] == b[1] and int(b[2]) == int(a[2]) + 1
