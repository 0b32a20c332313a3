"""Names of the compass: the four sides, and the corners between them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args

from fieldhand.places.picks.ordered import Order
from fieldhand.terms import CornerName, Side

SIDES: tuple[Side, ...] = get_args(Side)
CORNERS: tuple[CornerName, ...] = get_args(CornerName)
#: Order of visits that begins at a side.
AWAY_FROM: Mapping[Side, Order] = {
    "north": "north_to_south",
    "east": "east_to_west",
    "south": "south_to_north",
    "west": "west_to_east",
}
