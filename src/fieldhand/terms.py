"""Types shared by sites, selectors and conditions: compass sides, corners, comparisons, attribute values."""

from __future__ import annotations

from typing import Literal

Side = Literal["north", "east", "south", "west"]
CornerName = Literal["nw", "ne", "se", "sw"]
MarkerName = Literal["start", "end", "charger"]
Test = Literal["lt", "le", "gt", "ge", "eq", "ne"]
#: Value of a tree's attribute in a site file.
Value = str | float | bool
#: End from which rows, or trees in a row, are counted; ``usual`` is west or north, by the direction of the rows.
CountedFrom = Literal["usual", "north", "east", "south", "west"]
#: A half or a quarter of an area, or all of it.
AreaPart = Literal["all", "north", "east", "south", "west", "nw", "ne", "se", "sw"]
#: A direction of the compass, or none.
AnySide = Literal["any", "north", "east", "south", "west"]
#: A side of a tree: the aisle from which it is worked on.
TreeSide = Literal["north", "east", "south", "west", "both"]
Towards = Literal["down", "up", "north", "east", "south", "west"]
