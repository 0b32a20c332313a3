"""Stops at a spacing: "three measurements 15 m apart", "every 20 m along row 4"; and points spread over a zone."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import Number, message
from fieldhand.places import selectors as s
from fieldhand.planning.english.counting import Wanted
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.onebyone import one_by_one, spread_over
from fieldhand.planning.english.syntax import ClausePart
from fieldhand.planning.selections import zone_of_points
from fieldhand.site.model import Site

#: Rows that are left to the planner.
_ANY_ROW = (["a", "row"], ["any", "row"], ["one", "row"], ["some", "row"], ["one of", "rows"])
_LINE = message("say along which row, or in which zone: 'every 20 m along row 4'")


def as_stops(part: ClausePart, wanted: Wanted) -> tuple[ClausePart, Wanted]:
    """ "In four spots 20 m apart": so many captures, each at a stop of its own."""
    chain = part.places.chains[0] if part.places is not None and len(part.places.chains) == 1 else None
    if part.spacing is not None and chain is not None and [t.text.lower() for t in chain.terms] in _ANY_ROW:
        return replace(part, places=None, relation=None), wanted  # the nearest one will do
    if part.spacing is None or chain is None or any(number is not None for _, number in wanted):
        return part, wanted
    head = chain.phrases[0]
    numbers = [int(t.value) for t in head.quantity if t.kind == "NUM"]
    spots = [t for group in head.nominals for t in group if t.kind not in ("OTHER", "WHICH", "IS")]
    if len(numbers) != 1 or [t.kind for t in spots] != ["PLACE"] or spots[0].text.lower() in ("ones", "one"):
        return part, wanted
    rest = replace(chain, phrases=chain.phrases[1:], relations=chain.relations[1:]) if chain.relations else None
    places = None if rest is None or part.places is None else replace(part.places, chains=(rest,))
    relation = chain.relations[0] if chain.relations else None
    return replace(part, places=places, relation=relation), tuple((action, numbers[0]) for action, _ in wanted)


def stops_of(found: FoundPlace | None, part: ClausePart, wanted: Wanted, site: Site) -> FoundPlace:
    """The free points of a command with a spacing.

    Raises:
        Unclear, Question: How many there are or on which line they lie does not stand there.
    """
    spacing = part.spacing
    apart = 0.0 if spacing is None else spacing.value.apart_m
    if not apart > 0:
        raise unclear(
            part.terms if spacing is None else [spacing], message("stops need a distance above 0 m between them")
        )
    counts = {count for _, count in wanted}
    if len(counts) > 1:
        raise Question(
            message("'{said}': how many of each?", context="question", said=text_of(part.terms)),
            (message("as many of each", context="answer"),),
        )
    count = next(iter(counts)) or 0
    if count > 1 and spacing is not None and spacing.value.every:
        raise Question(
            message(
                "'{said}': {count} stops, or {count} at every stop?",
                context="question",
                said=text_of(part.terms),
                count=count,
            ),
            (
                message("{count} stops {apart} m apart", context="answer", count=count, apart=Number(f"{apart:g}")),
                message("{count} at every stop", context="answer", count=count),
            ),
            terms=(spacing,),
            words=(f"{apart:g} m apart", ""),
        )
    if count == 1:
        raise unclear(
            part.terms,
            message("a single stop cannot have a distance to another"),
            message("say how many, or leave the distance out"),
        )
    if found is None:
        if not count:
            raise Question(
                message("'{said}': how many, or along which row?", context="question", said=text_of(part.terms)),
                ("3", "5", message("along row 1", context="answer")),
            )
        return _found(s.Spaced(apart_m=apart, count=count), count)
    selector = found.selector
    if zone := zone_of_points(selector):
        return _found(s.Spaced(apart_m=apart, count=count, zone=zone), count)
    if found.rows:
        return _in_rows(found, part, s.Spaced(apart_m=apart, count=count, of=selector), site)
    if selector.single and not found.many and count:
        return _found(s.Spaced(apart_m=apart, count=count, near=selector), count)
    if found.region:
        raise unclear(part.terms, message("stops at a distance need a line"), _LINE)
    number = count or found.counted or 0
    if number < 2 or spacing is None or (count and found.counted not in (None, count)):
        raise unclear(
            part.terms, message("how many trees is that?"), message("say 'three trees 15 m apart', for example")
        )
    area = selector.any_of or selector
    return FoundPlace(
        selector=s.Apart(apart_m=apart, count=number, least=spacing.value.least, of=area), many=True, counted=number
    )


def _in_rows(found: FoundPlace, part: ClausePart, stops: s.Spaced, site: Site) -> FoundPlace:
    """Stops along one row, or along each of several."""
    area = found.selector
    relative = area.relative
    rows = found.one_by_one or (() if relative else one_by_one(area, site))
    if relative or len(rows) <= 1:
        return _found(stops, stops.count)
    if stops.count and not found.one_by_one:
        many = stops.count
        raise Question(
            message(
                "'{said}': {many} along each row, or {many} in all?",
                context="question",
                said=text_of(part.terms),
                many=many,
            ),
            (message("{many} along each row", context="answer", many=many),),
        )
    return _found(spread_over(stops, area, rows), stops.count)


def _found(selector: s.Selector, count: int) -> FoundPlace:
    return FoundPlace(selector=selector, many=True, counted=count or None)


def points_over(found: FoundPlace, part: ClausePart, wanted: Wanted) -> FoundPlace:
    """ "5 soil samples spread over the wet corner": free points of a zone, as many as there are captures."""
    if isinstance(found.selector, s.PointsIn):
        return found
    zone = zone_of_points(found.selector)
    if not zone:
        raise unclear(
            part.terms,
            message("points can be spread only over a zone of the site"),
            message("name a zone, or say how many trees"),
        )
    counts = {count for _, count in wanted}
    count = next(iter(counts))
    if len(counts) > 1 or count is None:
        raise Question(
            message("'{said}': at how many points?", context="question", said=text_of(part.terms)), ("3", "5")
        )
    return FoundPlace(selector=s.PointsIn(zone=zone, count=count), many=count > 1, counted=count)
