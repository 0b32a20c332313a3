"""Names of the compass: the four sides, and the corners between them."""

from __future__ import annotations

from typing import get_args

from fieldhand.terms import CornerName, Side

SIDES: tuple[Side, ...] = get_args(Side)
CORNERS: tuple[CornerName, ...] = get_args(CornerName)
