"""What a selector may know of the mission when it resolves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from fieldhand.site.model import Place


@dataclass(frozen=True, kw_only=True)
class Context:
    """Where the robot is and has been.

    Attributes:
        here: The place in hand; the start before the first drive.
        visited: Ids of the trees at which this mission has stopped, in that order, each once.
        bound: Places by the label that a node bound.
    """

    here: Place
    visited: tuple[str, ...] = ()
    bound: Mapping[str, tuple[Place, ...]] = field(default_factory=dict)
