"""Selectors to places: what the words of a Task mean on this site, in local metres.

The definitions (docs/site.md says the same for readers; one module an idea):

- ``extent``: halves, quarters, edges, extremes, corners, middles; north is true north.
- ``neighbours``: nearest, next to, farthest, within, neighbour after neighbour, the shortest few.
- ``attributes``: tests and ranks by what the file says of the trees.
- ``counted``, ``byrow``: blocks, rows by name and number, trees by their number in the row.
- ``hand``: along the row of the tree in hand, across to the next row, several of one row.
- ``ordering``: an order that is to be kept, and the n-th in it.
- ``points``, ``room``: free points at a spacing or spread over a zone, and where they may lie.
- ``resolve``: the sources, inside and outside zones, and how the parts nest; ``explain``: how it came to its places.
- ``words``: selectors in words, for messages and read-back.

Three sorts of parts need to be told apart when they nest. *Regions and edges* (half, quarter, edge, middle of an edge)
are those of the farm, or of the block or zone that is named: "yellow trees in the northern half" are in the northern
half of the farm, whichever way a planner nests the two. So their extent is that of ``of`` before rows, attributes,
visited trees and picks are taken out. *Corners and middles* are those of the group that is named ("the corners of the
Kerman trees", "the middle of row 3"), before visited trees are taken out. *What counts* (every third tree, trees 4 to 9
of a row, the second of them, 5 one after the other) counts what ``of`` leaves, whatever that is: "every third of the
yellow trees" is not "the yellow ones of every third tree". Rows themselves have one number each, whatever is left of
them.
"""
