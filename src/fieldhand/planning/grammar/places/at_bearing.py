"""Constructions of points at a distance and in a direction: "10 m west of the trough", "20 m north of it"."""

from __future__ import annotations

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import THAT_GROUND, Amount, PlaceMeaning
from fieldhand.planning.grammar.places.compass import SIDES
from fieldhand.planning.grammar.words import Lex
from fieldhand.planning.selections import as_zone
from fieldhand.terms import Side

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("metres_list: far=amount", "metres_list: DET POINT far=amount", cost=0.0)
def so_far(far: Amount) -> tuple[float, ...] | None:
    """Compose "10 m" before "west of the trough"."""
    return (far.number,) if far.unit == "metres" and far.number > 0.0 else None


@construction(
    "metres_list: near=NUM [COMMA] AND more=metres_list", "metres_list: near=NUM COMMA more=metres_list",
    "metres_list: far=amount [COMMA] AND more=metres_list", "metres_list: far=amount COMMA more=metres_list", cost=0.0,
)  # fmt: skip
def further_on(more: tuple[float, ...], near: Lex | None = None, far: Amount | None = None) -> tuple[float, ...] | None:
    """Compose "10, 20 and 30 m" and "10 m and 20 m"."""
    first = so_far(far) if far is not None else (near.value,) if near is not None and near.value > 0.0 else None
    return (*first, *more) if first is not None and first[0] not in more else None


@construction("toward: side=DIR", "toward: AT DET side=DIR", cost=0.0)
def toward(side: Lex) -> Side | None:
    """Compose "west" and "to the west"."""
    return side.value if side.value in SIDES else None


@construction("bearing_origin: at=place", "bearing_origin: where=region", "bearing_origin: it=IT", cost=0.0)
def bearing_origin(
    at: PlaceMeaning | None = None, where: s.Selector | None = None, it: Lex | None = None
) -> s.Selector | None:
    """Compose "the trough", "tree 4" and "it" behind "10 m west of"."""
    if it is not None:
        return s.InZone(zone=THAT_GROUND)  # or whatever was named last
    if at is not None:
        single = at.shape == "one" and at.per is None and not at.refers_back and not at.selector.relative
        return at.selector if single else None
    zone = None if where is None else as_zone(where)
    return zone if zone is not None and zone == s.InZone(zone=zone.zone) else None


@construction(
    "bearing_place: far=metres_list towards=toward OF of=bearing_origin",
    "bearing_place: far=metres_list towards=toward FROM of=bearing_origin",
    "bearing_place: far=metres_list FROM of=bearing_origin towards=toward",
    cost=0.1,
)
def at_bearing(far: tuple[float, ...], towards: Side, of: s.Selector) -> PlaceMeaning:
    """Compose "10 m and 20 m west of the trough"."""
    points = tuple(s.PointAt(metres=metres, towards=towards, origin=of) for metres in far)
    if len(points) == 1:
        return PlaceMeaning(points[0], "one")
    return PlaceMeaning(s.UnionOf(parts=points), "several", count=len(points), each=True)


@construction("place: at=bearing_place", cost=0.1)
def bearing_place(at: PlaceMeaning) -> PlaceMeaning:
    """Compose "10 m west of the trough" as a place."""
    return at


@construction(
    "bearing_place: far=metres_list MORE towards=toward", "bearing_place: far=metres_list WAY towards=toward", cost=0.1
)
def further_towards(far: tuple[float, ...], towards: Side) -> PlaceMeaning | None:
    """Compose "10 m further west" of the place where the robot is."""
    return PlaceMeaning(s.PointAt(metres=far[0], towards=towards), "one") if len(far) == 1 else None
