"""What a person wants of a mission that is under way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

#: ``pause``: stand still until told otherwise. ``continue``: the pause is over. ``return``: come home now.
#: ``abort``: stop here, the mission is over.
#: ``end``: end as the Task says of an abort (Ctrl-C, a program that is told to end).
Wanted = Literal["pause", "continue", "return", "abort", "end"]


@dataclass(frozen=True, kw_only=True)
class Order:
    """An order that stands until another takes its place.

    Attributes:
        reason: Who wants it, or why, in words.
        number: Of the order in the mission's folder, from 1; 0 for one that did not come through it.
    """

    wanted: Wanted
    reason: str
    number: int = 0
