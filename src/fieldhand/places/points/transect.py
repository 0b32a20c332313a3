"""Selector of plants, or free points, along a sampling path across an area: a W, a zigzag, a Z, an X, or its edge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from fieldhand.language import counted, message
from fieldhand.language.words import COMPASS, say_number, say_zone
from fieldhand.places.areas.area_words import say_area, sides_of_part
from fieldhand.places.count_range import ANY, CountRange, exactly
from fieldhand.places.filters.in_block import InBlock
from fieldhand.places.noun_phrase import NounPhrase, many, one
from fieldhand.places.selector import FromGroup, Selector
from fieldhand.places.sources.trees import Trees
from fieldhand.terms import AreaPart, Side

if TYPE_CHECKING:
    from fieldhand.places.place_group import PlaceGroup
    from fieldhand.places.resolution import Resolution
    from fieldhand.places.resolution_notes import ResolutionNotes
    from fieldhand.places.wording import SelectorWording
    from fieldhand.site.model import Site

#: Form of the path: alternating from one long side of the area to the other, the letter Z or X in its corners, or its
#: edge.
PathShape = Literal["zigzag", "z", "x", "edge"]


#: Distance in metres of points along an edge from it, inside of it, unless another is asked for.
OFF_EDGE_M = 1.5


@dataclass(frozen=True, kw_only=True)
class Transect(FromGroup):
    """``count`` trees of ``of`` nearest to equally spaced points, or to points ``apart_m`` metres apart, of a path
    across it: a ``zigzag`` of ``legs`` (4 are a W, 1 is a diagonal), a ``z`` or an ``x``. With ``zone`` (``part``),
    free points there; without trees, on the whole site. Along an ``edge``, or its ``part`` that faces a
    side, free points ``off_m`` inside of it, outside of a keep-out."""

    count: int = 0
    apart_m: float = 0.0
    shape: PathShape = "zigzag"
    legs: int = 4
    zone: str = ""
    part: AreaPart = "all"
    off_m: float = OFF_EDGE_M
    of: Selector = Trees()

    reference_rule = "of"

    @classmethod
    def example(cls, site: Site) -> Transect:
        block = site.planting.blocks[0].name if len(site.planting.blocks) > 1 else ""
        return cls(count=20, of=InBlock(block=block)) if block else cls(count=20)

    def resolve(self, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        from fieldhand.places.points.on_path import points_on_path

        if self.on_ground or self.shape == "edge" or not resolution.site.trees:
            return points_on_path(resolution.site, self, notes)
        return super().resolve(resolution, notes)

    def choose(self, of: PlaceGroup, resolution: Resolution, notes: ResolutionNotes) -> PlaceGroup:
        """Return the trees in the order of the path.

        Raises:
            PlaceError: There are too few trees, or the number of points or legs is not possible.
        """
        from fieldhand.places.filters.zones import outside_keep_outs
        from fieldhand.places.points.on_path import trees_on_path

        return trees_on_path(outside_keep_outs(of, notes).once(self.count), self, notes)

    def phrase(self, wording: SelectorWording) -> NounPhrase:
        path, group = self._path, wording.phrase(self.of)
        if self.shape == "edge":
            return self._along_edge()
        over = say_area(self.zone, self.part) if self.on_ground else group.group()
        if self.apart_m:
            text = message(
                "the points every {metres} m along {path} across {area}",
                metres=say_number(self.apart_m),
                path=path,
                area=over,
            )
            return many(text)
        if self.on_ground:
            points = counted("{count} point", "{count} points", self.count)
            text = message("{points} along {path} across {area}", points=points, path=path, area=over)
        else:
            text = message("{count} of {trees}, along {path} across them", count=self.count, trees=over, path=path)
        return one(text) if self.count == 1 else many(text)

    def _along_edge(self) -> NounPhrase:
        area = say_zone(self.zone) if self.zone else message("the whole site")
        if self.off_m < 0.0:
            area = message("{area}, {metres} m outside of it", area=area, metres=say_number(-self.off_m))
        elif self.off_m != OFF_EDGE_M:
            area = message("{area}, {metres} m from it", area=area, metres=say_number(self.off_m))
        if self.part != "all":
            return self._along_side(area)
        if self.apart_m:
            return many(
                message(
                    "the points every {metres} m along the edge of {area}", metres=say_number(self.apart_m), area=area
                )
            )
        points = counted("{count} point", "{count} points", self.count)
        text = message("{points} along the edge of {area}", points=points, area=area)
        return one(text) if self.count == 1 else many(text)

    def _along_side(self, area: str) -> NounPhrase:
        side = COMPASS[self.part]
        if self.apart_m:
            metres = say_number(self.apart_m)
            return many(
                message(
                    "the points every {metres} m along the {side} side of {area}", metres=metres, side=side, area=area
                )
            )
        if self.count == 1:
            return one(message("the middle of the {side} side of {area}", side=side, area=area))
        points = counted("{count} point", "{count} points", self.count)
        return many(message("{points} along the {side} side of {area}", points=points, side=side, area=area))

    @property
    def on_ground(self) -> bool:
        """True if the points are named by their ground rather than by trees."""
        return bool(self.zone) or self.part != "all"

    @property
    def single(self) -> bool:
        return self.count == 1 and not self.apart_m

    @property
    def size(self) -> CountRange:
        return exactly(self.count) if self.count and not self.apart_m else ANY

    @property
    def sides(self) -> tuple[Side, ...]:
        return sides_of_part(self.part)

    @property
    def keeps_order(self) -> bool:
        return True

    @property
    def _path(self) -> str:
        if self.shape != "zigzag":
            return message("a Z") if self.shape == "z" else message("an X")
        if self.legs == 4:
            return message("a W")
        if self.legs == 1:
            return message("a diagonal")
        return message("a zigzag of {count} legs", count=self.legs)
