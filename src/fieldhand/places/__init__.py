"""Selectors: how a Task names places without coordinates, and the places that they come to on a site, in local metres.

Each selector is a file with its data, places, words and size, in a folder by its question (docs/site.md gives the
definitions to readers):

- ``sources``: what names places outright: every tree, a tree by its id, a marker, a gate, the place in hand.
- ``areas``: halves, quarters, edges, extremes, corners, middles; north is true north.
- ``filters``: by attributes, zones and blocks, distance, and what was visited.
- ``neighbours``: nearest, farthest, neighbour after neighbour.
- ``rows``: rows by name and number, trees by their number in the row, along and across rows.
- ``picks``: an order that is to be kept and the n-th in it, the first few, some drawn or spread.
- ``points``: free points at a spacing or spread over a zone.

``selector`` says what every selector gives, ``selectors`` registers them; ``resolution`` resolves one, ``explanation``
gives the way to its places, ``wording`` says it.

Three sorts of parts need to be told apart when they nest. *Regions and edges* (half, quarter, edge, middle of an edge)
are those of the farm, or of the block or zone that is named: "yellow trees in the northern half" are in the northern
half of the farm, whichever way a planner nests the two. So their extent is that of ``of`` before rows, attributes,
visited trees and picks are taken out. *Corners and middles* are those of the group that is named ("the corners of the
Kerman trees", "the middle of row 3"), before visited trees are taken out. *What counts* (every third tree, trees 4 to 9
of a row, the second of them, 5 one after the other) counts what ``of`` leaves, whatever that is: "every third of the
yellow trees" is not "the yellow ones of every third tree". Rows themselves have one number each, whatever is left of
them.
"""
