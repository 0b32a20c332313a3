"""Names of trees by row and position, and of many trees in few words: "row 2 positions 4 to 9"."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from fieldhand.language.words import listed
from fieldhand.site.drawing.blocks import block_words
from fieldhand.site.model import Site
from fieldhand.site.names import short

#: Most rows, runs or ids named, and the longest name in characters.
_MOST_NAMED, _LONGEST = 24, 40


class PlaceNames:
    """Names of the trees of a site by row and position."""

    def __init__(self, site: Site) -> None:
        planting = site.planting
        several = len(planting.blocks) > 1
        self._rows: list[str] = []
        self._at: dict[str, tuple[int, int]] = {}
        for number, row in enumerate(planting.rows):
            own = short(row.name, _LONGEST)
            name = own if own.lower().startswith("row") else f"row {own}"
            block = f"{block_words(planting.blocks[row.block])} " if several else ""
            self._rows.append(f"{block}{name}")
            for tree, slot in zip(row.trees, row.slots, strict=True):
                self._at[site.trees[int(tree)].place.id] = (number, int(slot))

    def where(self, kind: str, place: str) -> str:
        """Return the row and position of a tree, or nothing for a place in no row."""
        found = self._at.get(place) if kind == "tree" else None
        return "" if found is None else f"{self._rows[found[0]]}, position {found[1]}"

    def name(self, kind: str, place: str) -> str:
        """Return the name of a place: "tree 152", "the end marker"."""
        known = short(place, _LONGEST)
        return {"tree": f"tree {known}", "marker": f"the {known} marker"}.get(kind, known)

    def many(self, places: Sequence[str]) -> str:
        """Name trees, each once, by row and runs of positions, or by id if in no row."""
        ids = list(dict.fromkeys(places))
        rows: dict[int, list[int]] = {}
        for place in ids:
            if place in self._at:
                row, slot = self._at[place]
                rows.setdefault(row, []).append(slot)
        parts = [f"{self._rows[row]} {_positions(sorted(slots))}" for row, slots in sorted(rows.items())]
        others = [short(place, _LONGEST) for place in ids if place not in self._at]
        if others:
            more = len(others) - _MOST_NAMED
            named = others[:_MOST_NAMED] + ([f"{more} more"] if more > 0 else [])
            parts.append(f"{'tree' if len(others) == 1 else 'trees'} {listed(named)}")
        more = len(parts) - _MOST_NAMED
        return ", ".join(parts[:_MOST_NAMED]) + (f" and in {more} more rows" if more > 0 else "")


def _positions(slots: Sequence[int]) -> str:
    """Return "position 4", or "positions 4 to 9 and 12"."""
    runs: list[list[int]] = []
    for slot in slots:
        if runs and slot == runs[-1][-1] + 1:
            runs[-1].append(slot)
        else:
            runs.append([slot])
    names = list(
        itertools.chain.from_iterable(
            [f"{run[0]} to {run[-1]}"] if len(run) > 2 else [str(slot) for slot in run] for run in runs
        )
    )
    more = len(names) - _MOST_NAMED
    if more > 0:
        names = [*names[:_MOST_NAMED], f"{more} more"]
    return f"{'position' if len(slots) == 1 else 'positions'} {listed(names)}"
