"""Selectors, by which a Task names places without coordinates, and their resolution on a site in local metres.

Each selector is one file with its data, its places, its wording and its size, in a folder by topic (docs/site.md
documents them for users):

- ``sources``: every tree, a tree by its id, a marker, a gate, the current place, labelled places.
- ``areas``: halves, quarters, edges, extremes, corners, middles; north is true north.
- ``filters``: by attributes, zones and blocks, distance, and previous visits.
- ``earlier``: by what earlier missions did and read on the site.
- ``neighbours``: nearest, farthest, adjacent trees.
- ``rows``: rows by name and number, trees by their number in the row, along and across rows.
- ``picks``: ordered places and the n-th of them, the first few, random and spread samples.
- ``points``: free points at a spacing or spread over a zone.

``selector`` defines the base classes, ``selectors`` registers all selectors; ``resolution`` resolves one,
``explanation`` explains how its places were found, and ``wording`` puts it into words.

Nested selectors follow three rules. *Regions and edges* (half, quarter, edge, middle of an edge) belong to the farm, or
to the named block or zone: "yellow trees in the northern half" are in the northern half of the farm, whichever way the
two are nested. Their extent is therefore that of ``of`` before rows, attributes, visited trees and picks are removed.
*Corners and middles* belong to the named group ("the corners of the Kerman trees", "the middle of row 3"), before
visited trees are removed. *Counts* (every third tree, trees 4 to 9 of a row, the second of them, 5 consecutive trees)
refer to whatever ``of`` leaves: "every third of the yellow trees" is not "the yellow ones of every third tree". The
numbers of rows never depend on other selectors.
"""
