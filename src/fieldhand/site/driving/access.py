"""How places reach open ground: those in the band along its edges over hard ground, by their exits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fieldhand.site.driving.graph import Indices, Links, Points


@dataclass(frozen=True, eq=False)
class Access:
    """How one place reaches soft ground.

    Attributes:
        at: The place.
        radius: Within this of the place a way may use hard ground; 0 for a place on soft ground.
        exits: The place itself, then the points by which it can be left, shape (m, 2).
        walked: Metres from the place to each exit (inf: not reached), and by which exit.
        links: The nodes of the ground that it reaches, and by which exit.
    """

    at: Points
    radius: float
    exits: Points
    walked: Points
    walked_by: Indices
    links: Links
    links_by: Indices

    def points_to(self, exit_: int) -> list[Points]:
        """The points from the place to one of its exits."""
        points = [self.exits[exit_]]
        while exit_ > 0:
            exit_ = int(self.walked_by[exit_])
            points.append(self.exits[exit_])
        return points[::-1]

    def points_to_node(self, node: int) -> list[Points]:
        """The points from the place to the exit by which it reaches this node of the ground."""
        return self.points_to(int(self.links_by[np.flatnonzero(self.links.nodes == node)[0]]))


@dataclass(frozen=True, kw_only=True, eq=False)
class Exits:
    """The exits of several places, one after the other.

    Attributes:
        owner: The position of the place.
        at, walked: As of its access.
        centre, radius: Where its way may use hard ground.
    """

    owner: Indices
    at: Points
    walked: Points
    centre: Points
    radius: Points

    def disks(self, which: Indices) -> tuple[Points, Points]:
        """Centres and radii of some exits' places."""
        return self.centre[which], self.radius[which]


def exits_of(accesses: Sequence[Access]) -> Exits:
    """The exits of these places."""
    owner = np.repeat(np.arange(len(accesses)), [len(a.exits) for a in accesses])
    return Exits(
        owner=owner,
        at=np.concatenate([np.empty((0, 2)), *(a.exits for a in accesses)]),
        walked=np.concatenate([np.empty(0), *(a.walked for a in accesses)]),
        centre=np.array([a.at for a in accesses]).reshape(-1, 2)[owner],
        radius=np.array([a.radius for a in accesses])[owner],
    )
