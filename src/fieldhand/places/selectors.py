"""The registry of all selectors (``fh.selectors``).

To add a selector, write its file, import it here and add it to ``SELECTORS``. The plan language of Tasks
(:mod:`fieldhand.task.codec_shapes`), its schema, the definitions for language models and the benchmark of sites are
derived from ``SELECTORS``, in its order.

Example:
    >>> from fieldhand.places import selectors as s
    >>> s.Nearest(to=s.Marker(name="charger"), count=3, of=s.Rows(first="2", last="2"))
"""

from __future__ import annotations

from fieldhand.places.areas.among_extreme import AmongExtreme
from fieldhand.places.areas.corners import Corners
from fieldhand.places.areas.edge import Edge
from fieldhand.places.areas.edge_middle import EdgeMiddle
from fieldhand.places.areas.extreme import Extreme
from fieldhand.places.areas.half import Half
from fieldhand.places.areas.middle import Middle
from fieldhand.places.areas.quarter import Quarter
from fieldhand.places.earlier.done_earlier import DoneEarlier
from fieldhand.places.earlier.period import Period as Period
from fieldhand.places.earlier.top_earlier import TopEarlier
from fieldhand.places.earlier.where_earlier import WhereEarlier
from fieldhand.places.filters.excluding import Excluding
from fieldhand.places.filters.in_block import InBlock
from fieldhand.places.filters.in_zone import InZone
from fieldhand.places.filters.not_visited import NotVisited
from fieldhand.places.filters.where import Where
from fieldhand.places.filters.within import Within
from fieldhand.places.neighbours.adjacent import Adjacent
from fieldhand.places.neighbours.farthest import Farthest
from fieldhand.places.neighbours.nearest import Nearest
from fieldhand.places.picks.apart import Apart
from fieldhand.places.picks.by_reading import ByReading
from fieldhand.places.picks.evenly import Evenly
from fieldhand.places.picks.first import First
from fieldhand.places.picks.group_by_reading import GroupByReading
from fieldhand.places.picks.last import Last
from fieldhand.places.picks.nth import Nth
from fieldhand.places.picks.ordered import Ordered
from fieldhand.places.picks.quota import Quota
from fieldhand.places.picks.random_sample import RandomSample
from fieldhand.places.picks.spread import Spread
from fieldhand.places.picks.take import Take
from fieldhand.places.picks.top import Top
from fieldhand.places.points.beside import Beside
from fieldhand.places.points.grid import Grid
from fieldhand.places.points.point_at import PointAt
from fieldhand.places.points.points_in import PointsIn
from fieldhand.places.points.spaced import Spaced
from fieldhand.places.points.straight_line import StraightLine
from fieldhand.places.points.transect import Transect
from fieldhand.places.rows.across import Across
from fieldhand.places.rows.along_row import AlongRow
from fieldhand.places.rows.every_nth import EveryNth
from fieldhand.places.rows.in_row import InRow
from fieldhand.places.rows.missing import Missing
from fieldhand.places.rows.row_of import RowOf
from fieldhand.places.rows.rows import Rows
from fieldhand.places.rows.successive import Successive
from fieldhand.places.selector import Selector
from fieldhand.places.sources.bound import Bound
from fieldhand.places.sources.gate_is import GateIs
from fieldhand.places.sources.here import Here
from fieldhand.places.sources.marker import Marker
from fieldhand.places.sources.tree_is import TreeIs
from fieldhand.places.sources.trees import Trees
from fieldhand.places.sources.union_of import UnionOf

SELECTORS: tuple[type[Selector], ...] = (
    Trees,
    TreeIs,
    Marker,
    GateIs,
    Here,
    Bound,
    First,
    Last,
    Corners,
    Extreme,
    AmongExtreme,
    Middle,
    EdgeMiddle,
    Half,
    Quarter,
    Edge,
    Nearest,
    Farthest,
    Adjacent,
    NotVisited,
    Excluding,
    Where,
    Top,
    ByReading,
    GroupByReading,
    DoneEarlier,
    TopEarlier,
    WhereEarlier,
    InZone,
    Within,
    Take,
    RandomSample,
    Spread,
    Evenly,
    Quota,
    InBlock,
    Rows,
    RowOf,
    InRow,
    EveryNth,
    AlongRow,
    Across,
    Successive,
    Missing,
    Ordered,
    Nth,
    Spaced,
    Apart,
    PointsIn,
    Beside,
    Grid,
    Transect,
    StraightLine,
    PointAt,
    UnionOf,
)
