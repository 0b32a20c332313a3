"""What a noun phrase selects."""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.places import selectors as s
from fieldhand.planning.selections import as_edge


@dataclass(frozen=True, kw_only=True)
class FoundPlace:
    """What a noun phrase selects.

    Attributes:
        many: Several places rather than one.
        counted: The phrase says how many.
        each: The phrase says "each" or "every".
        region: An area ("the northern half"), not trees by themselves: "a picture in it" is at one tree of it.
        optional: "as many as you can".
        at_most: "up to 6".
        here: The places just spoken of ("there", "each of them").
        these: Several places that were spoken of ("each of them", "both").
        all_or_these: "the trees": those just spoken of if there are any, else all.
        rows: The area is made of rows, or of blocks.
        one_by_one: Those rows or blocks one after the other, where each of them is meant by itself.
        assumed: What was taken for granted, as sentences.
        object_only: A quantity alone ("another", "two more"): of what, the verb before says.
    """

    selector: s.Selector
    many: bool = False
    counted: int | None = None
    each: bool = False
    region: bool = False
    optional: bool = False
    at_most: int | None = None
    here: bool = False
    these: bool = False
    all_or_these: bool = False
    rows: bool = False
    one_by_one: tuple[s.Selector, ...] = ()
    assumed: tuple[str, ...] = ()
    object_only: bool = False

    @property
    def line(self) -> bool:
        """Return True if one can go along it: rows, or an edge."""
        return self.rows or as_edge(self.selector) is not None
