"""Resolve a selector: each part works on the group left by the part nested in it, and records notes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely

from fieldhand.errors import PlaceError
from fieldhand.language import message
from fieldhand.places import place_group
from fieldhand.places.context import Context
from fieldhand.places.filters.zones import zones_called
from fieldhand.places.neighbours.distances import Origin, ZoneArea
from fieldhand.places.place_errors import nothing
from fieldhand.places.place_group import PlaceGroup
from fieldhand.places.resolution_notes import ResolutionNotes
from fieldhand.places.selector import Selector
from fieldhand.places.wording import say_selector
from fieldhand.site.model import Place, Site
from fieldhand.site.names import listed, short


def resolve(selector: Selector, site: Site, context: Context) -> tuple[Place, ...]:
    """Return the places of a selector in a defined order, each once; at least one.

    Args:
        selector: Selector to resolve, innermost part first: each part filters, orders or picks from its ``of``.
        site: The site.
        context: Position and history of the robot, for relative selectors.

    Raises:
        PlaceError: A part matches nothing or too little, or names something that the site lacks; the message says which
            part, and what the site has instead.
    """
    return Resolution(site, context).spots(selector).places


def resolve_one(selector: Selector, site: Site, context: Context) -> Place:
    """Return the one place of a selector.

    Raises:
        PlaceError: As for :func:`resolve`, or the selector has several places.
    """
    return Resolution(site, context).one(selector).places[0]


@dataclass(frozen=True, eq=False)
class ResolutionStep:
    """A resolved part of a selector: its notes and the places found."""

    selector: Selector
    notes: ResolutionNotes
    places: PlaceGroup


class Resolution:
    """Resolution of one selector on one site at one moment. Repeated parts are resolved once.

    Attributes:
        steps: Resolved parts, each after those nested in it.
    """

    def __init__(self, site: Site, context: Context, resolved: dict[str, ResolutionStep] | None = None) -> None:
        self.site = site
        self.context = context
        self.steps: list[ResolutionStep] = []
        self._resolved: dict[str, ResolutionStep] = {} if resolved is None else resolved
        self._listed: set[str] = set()

    def spots(self, selector: Selector) -> PlaceGroup:
        """Return the places that the selector leaves, at least one."""
        key = repr(selector)  # not the selector itself: selectors with 1.0 and True are equal
        if key not in self._resolved:
            notes = ResolutionNotes()
            found = selector.resolve(self, notes)
            if not len(found):
                raise nothing(self.site, selector)
            self._resolved[key] = ResolutionStep(selector, notes, found)
        if key not in self._listed:
            self._listed.add(key)
            self.steps.append(self._resolved[key])
        return self._resolved[key].places

    def one(self, selector: Selector) -> PlaceGroup:
        """Return the one place that the selector leaves."""
        found = self.spots(selector)
        if len(found) > 1:
            raise PlaceError(
                message(
                    "'{selector}' selects {count} places, but only one is allowed here",
                    count=len(found),
                    selector=short(say_selector(selector), 160),
                ),
                where=self.site.name,
                advice=message(
                    "name one of them: {places}", places=listed([p.id for p in found.keep(slice(9)).places])
                ),
            )
        return found

    def every_tree(self) -> PlaceGroup:
        """Return every tree of the site, in the order of the file."""
        return PlaceGroup.all_trees(self.site)

    def group(self, *places: Place) -> PlaceGroup:
        """Return a group of these places, each once."""
        return PlaceGroup.of(self.site, places)

    def joined(self, groups: Sequence[PlaceGroup]) -> PlaceGroup:
        """Return all places of some groups in their order, each once."""
        return place_group.joined(self.site, groups)

    def visited(self) -> PlaceGroup:
        """Return the trees that this mission has visited."""
        known = [self.site.by_id[t].index for t in self.context.visited if t in self.site.by_id]
        return PlaceGroup(site=self.site, index=np.array(known, dtype=np.intp))

    def origin(self, selector: Selector) -> Origin:
        """Return the origin of distances: the zone itself for a selector of all its trees, else its places."""
        zones = zones_called(self.site, selector.whole_zone)
        return ZoneArea(site=self.site, area=shapely.union_all(zones)) if zones else self.spots(selector)

    def reference(self, selector: Selector, of: PlaceGroup, *, picks_too: bool = True) -> PlaceGroup:
        """Return the reference group: ``of`` before visited trees (and attributes and picks) are removed.

        Args:
            selector: Selector that ``of`` results from.
            of: Places of that selector.
            picks_too: As for :meth:`Selector.reference`.
        """
        bare = selector.reference(picks_too=picks_too)
        return of if bare == selector else Resolution(self.site, self.context, self._resolved).spots(bare)
