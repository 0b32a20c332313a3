"""Words that sites, selectors and conditions share: sides of the compass, corners, tests, values."""

from __future__ import annotations

from typing import Literal

Side = Literal["north", "east", "south", "west"]
CornerName = Literal["nw", "ne", "se", "sw"]
MarkerName = Literal["start", "end", "charger"]
Test = Literal["lt", "le", "gt", "ge", "eq", "ne"]
#: What a file records of a tree under one name.
Value = str | float | bool
#: Which end rows, or trees in a row, are counted from: ``usual`` is west, or north where that is the way of the row.
CountedFrom = Literal["usual", "north", "east", "south", "west"]
#: A direction of the compass, or none.
AnySide = Literal["any", "north", "east", "south", "west"]
Towards = Literal["down", "up", "north", "east", "south", "west"]
