"""Selectors to places: what the words of a Task mean on this site, in local metres.

The definitions (docs/site.md says the same for readers; one module an idea):

- ``extent``: halves, quarters, edges, extremes, corners, middles; north is true north.
- ``neighbours``: nearest, next to, farthest, within, neighbour after neighbour, the shortest few.
- ``attributes``: tests and ranks by what the file says of the trees.
- ``resolve``: the sources, inside and outside zones, and how the parts nest.

Two sorts of parts need to be told apart when they nest. *Regions and edges* (half, quarter, edge, middle of an edge)
are those of the farm: "yellow trees in the northern half" are in the northern half of the farm, whichever way a planner
nests the two. So their extent is that of ``of`` before attributes, visited trees and picks are taken out. *Corners and
middles* are those of the group that is named ("the corners of the Kerman trees"), before visited trees are taken out.
"""

from __future__ import annotations

from fieldhand.site.places.resolve import resolve, resolve_one

__all__ = ["resolve", "resolve_one"]
