"""Constructions of captures along a sampling path or on a grid: "20 samples in a W through the north block"."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.clauses import Adjunct, once
from fieldhand.planning.grammar.meaning import CaptureCommand, PlaceMeaning
from fieldhand.planning.grammar.places.sampling import SamplingPath, grid_selector
from fieldhand.planning.selections import as_some, chooses_from_trees, over
from fieldhand.site.model import Site

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@dataclass(frozen=True, slots=True)
class _Route:
    """A path and the area that it crosses; None for the place of the command, or the site."""

    path: SamplingPath
    where: s.Selector | None
    site: Site = field(compare=False)


@dataclass(frozen=True, slots=True)
class _Cells:
    """The side of the cells of a grid in metres, and the area that it covers; None for the place of the command."""

    every_m: float
    where: s.Selector | None
    site: Site = field(compare=False)


def _area(command: CaptureCommand, where: s.Selector | None) -> s.Selector | None:
    """Return the area of an adjunct within the area of its command; None for the site."""
    place = command.place
    if place is None:
        return where
    return place.selector if where is None else over(place.selector, where)


def _along(command: CaptureCommand, route: _Route) -> CaptureCommand | None:
    """Return a command at as many places along the path as there are captures or trees, or at its spacing."""
    place = command.place
    if place is not None and (place.per is not None or not chooses_from_trees(place.selector)):
        return None
    some = None if place is None else as_some(place.selector)
    if some is not None and some.count > 1 and all(one.count in (None, 1) for one in command.things):
        area = some.of if route.where is None else over(some.of, route.where)
        return _at(command, route.path.over(area, route.site, count=some.count), some.count)
    if place is not None and place.shape != "area":
        return None
    area_there = _area(command, route.where)
    counts = {one.count for one in command.things}
    count = next(iter(counts)) if len(counts) == 1 else None
    if command.spacing is not None:
        if count not in (None, 1):
            return None
        made = route.path.over(area_there, route.site, apart_m=command.spacing)
        return _at(replace(command, spacing=None), made, None)
    if count is None or count < 2:
        return None
    return _at(command, route.path.over(area_there, route.site, count=count), count)


def _on_grid(command: CaptureCommand, cells: _Cells) -> CaptureCommand | None:
    """Return a command at the places of a grid over the area."""
    place = command.place
    if command.spacing is not None or any(one.count not in (None, 1) for one in command.things):
        return None
    if place is not None:
        whole = place.shape == "area" or (place.shape == "several" and place.count is None)
        if not whole or place.per is not None or not chooses_from_trees(place.selector):
            return None
    return _at(command, grid_selector(cells.every_m, _area(command, cells.where), cells.site), None)


def _at(command: CaptureCommand, selector: s.Selector, count: int | None) -> CaptureCommand:
    there = PlaceMeaning(selector, "several", count=count, each=count is None)
    return replace(command, things=once(command.things), place=there, relation="at")


@construction("adjunct: along=path_over", cost=0.2, given=("site",))
def along_path(along: tuple[SamplingPath, s.Selector | None], site: Site) -> Adjunct:
    """Compose "in a W through the north block", of so many samples."""
    return Adjunct(_along, _Route(*along, site), may_lead=True, lays_out=True)


@construction("adjunct: on=grid_over", cost=0.2, given=("site",))
def on_grid(on: tuple[float, s.Selector | None], site: Site) -> Adjunct:
    """Compose "on a 20 m grid over the meadow"."""
    return Adjunct(_on_grid, _Cells(*on, site), may_lead=True, lays_out=True)
