"""Constructions of the straight line between two places, along which captures are taken."""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import PlaceMeaning
from fieldhand.planning.selections import as_zone
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class SamplingLine:
    """The straight line from one place to another along which samples are taken."""

    start: s.Selector
    end: s.Selector

    def over(
        self, area: s.Selector | None, site: Site, *, count: int = 0, apart_m: float = 0.0
    ) -> s.StraightLine | None:
        """Return so many places, or places so far apart, on the line; None if an area is named beside it."""
        del site
        if area not in (None, s.Trees()):
            return None
        return s.StraightLine(start=self.start, end=self.end, count=0 if apart_m else count, apart_m=apart_m)


@construction("line_end: at=place", "line_end: where=region", cost=0.0)
def line_end(at: PlaceMeaning | None = None, where: s.Selector | None = None) -> s.Selector | None:
    """Compose "the road gate" behind "in a straight line from"."""
    if at is not None:
        return at.selector if at.shape == "one" and at.per is None else None
    zone = None if where is None else as_zone(where)
    return zone if zone is not None and not zone.outside and not zone.margin_m and zone.of == s.Trees() else None


@construction(
    "line: FROM start=line_end range_to end=line_end",
    "line: BETWEEN start=line_end AND end=line_end",
    "line: RUNS FROM start=line_end range_to end=line_end",
    cost=0.1,
)
def line(start: s.Selector, end: s.Selector) -> SamplingLine:
    """Compose "from the road gate to the forest gate"."""
    return SamplingLine(start, end)


@construction("adverbial_place: MIDWAY line=line", "place: [DET] MIDDLE line=line", cost=0.1)
def midway(line: SamplingLine) -> PlaceMeaning:
    """Compose "halfway between the trough and the mast"."""
    return PlaceMeaning(s.StraightLine(start=line.start, end=line.end, count=1), "one")


@construction(
    "path_over: AT [DET] STRAIGHTLINE line=line",
    "path_over: ALONG [DET] STRAIGHTLINE line=line",
    "path_over: GO [DET] STRAIGHTLINE line=line",
    "path_over: GO AT [DET] STRAIGHTLINE line=line",
    "path_over: GO ALONG [DET] STRAIGHTLINE line=line",
    "path_over: line=line AT [DET] STRAIGHTLINE",
    "path_over: GO line=line AT [DET] STRAIGHTLINE",
    "path_over: GO DIRECTLY line=line",
    "path_over: DIRECTLY line=line",
    cost=0.1,
)
def straight_line(line: SamplingLine) -> tuple[SamplingLine, None]:
    """Compose "in a straight line from the road gate to the forest gate"."""
    return line, None


@construction(
    "path_over: AT [DET] STRAIGHTLINE range_to end=line_end",
    "path_over: GO AT [DET] STRAIGHTLINE range_to end=line_end",
    cost=0.2,
)
def straight_line_to(end: s.Selector) -> tuple[SamplingLine, None]:
    """Compose "in a straight line to the forest gate", from the place where the robot is."""
    return SamplingLine(s.Here(), end), None


@construction("path_over: line=line", "path_over: GO line=line", cost=0.6, given=("site",))
def line_over_ground(line: SamplingLine, site: Site) -> tuple[SamplingLine, None] | None:
    """Compose "every 20 m from the road gate to the forest gate" where no rows lead another way."""
    return None if site.trees else (line, None)
