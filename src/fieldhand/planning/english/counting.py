"""A number of captures and a kind of place: "2 pictures of nearby trees" are two trees, "2 pictures of a tree" one."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.language import message
from fieldhand.places import selectors as s
from fieldhand.planning.english.asking import each_or_in_all, every_or_how_many
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.found import FoundPlace
from fieldhand.planning.english.syntax import ClausePart, Object
from fieldhand.planning.selections import are_several_rows, as_nearest, named_places, some_of

Wanted = tuple[tuple[str, int | None], ...]


def number_of_objects(thing: Object) -> int | None:
    """How many captures an object asks for; None if it does not say.

    Raises:
        Unclear: Its quantity says something else.
    """
    number: int | None = None
    for term in thing.quantity:
        if term.kind == "NUM":
            if number is not None or term.value != int(term.value) or not 1 <= term.value <= 1000:
                raise unclear(thing.terms, message("it is not clear how many"), message("say one whole number"))
            number = int(term.value)
        elif term.kind == "UPTO":
            raise unclear(thing.terms, message("captures need one number"), message("say 'of up to 6 trees'"))
        elif term.kind == "ORD" and term.value != 1 and thing.quantity[0].text.lower() in ("a", "an"):
            continue  # "a second reading" is one more
        elif term.kind == "ORD" and term.value != 1:
            raise unclear(thing.terms, message("a number is needed there, not a rank"), message("say how many"))
    return number


def counts_each(found: FoundPlace | None, part: ClausePart) -> bool:
    """Whether a count is meant at each place ("2 pictures at each corner") rather than in all."""
    return (found is not None and found.each) or any(t.kind == "EACHTAIL" for t in part.tails)


def counted(found: FoundPlace, part: ClausePart, wanted: Wanted) -> FoundPlace:
    """The places of a command, its number of captures taken as a number of places where it is one.

    Raises:
        Question: It can be either.
    """
    numbers = {count for _, count in wanted if count is not None}
    count = max(numbers, default=None)
    plural = bool(part.objects) and part.objects[0].noun.plural
    if any(t.kind == "ASMANY" for o in part.objects for t in o.quantity):
        return replace(found, many=True, optional=True)
    if found.rows and found.region:
        return found if found.optional else _in_rows(found, part, count, plural)
    if found.optional or counts_each(found, part):
        return found
    if found.at_most is not None:
        return found if count in (None, 1) else _either(part, count, found.at_most)
    if found.region:
        return _in_area(found, part, count, plural)
    if not found.many or count is None or count == 1:
        if found.many and found.counted is None and as_nearest(found.selector) is not None:
            raise Question(message("how many trees nearby?", context="question"), ("2", "3", "4"))
        return found
    if len(numbers) > 1 or (len(wanted) > 1 and any(n != count for _, n in wanted)):
        raise Question(
            message("'{said}': how many at each of the places?", context="question", said=text_of(part.terms)),
            (message("{count} at each", context="answer", count=count), message("1 at each", context="answer")),
        )
    if found.counted is not None:
        return found if count == found.counted else _either(part, count, found.counted)
    selector = found.selector
    if (nearest := as_nearest(selector)) is not None:
        return replace(found, selector=replace(nearest, count=count), counted=count)
    if named := named_places(selector):
        return found if len(named) == count else _either(part, count, len(named))
    return FoundPlace(selector=some_of(selector, count), many=True, counted=count)


def _either(part: ClausePart, count: int, size: int) -> FoundPlace:
    raise each_or_in_all(
        part,
        message(
            "{count} captures at {size} places: {count} at each of them, or {count} in all?",
            context="question",
            count=count,
            size=size,
        ),
        (
            message("{count} at each of them", context="answer", count=count),
            message("{count} in all", context="answer", count=count),
        ),
        count,
    )


def _in_rows(found: FoundPlace, part: ClausePart, count: int | None, plural: bool) -> FoundPlace:
    """Captures in rows: at every tree of them ("pictures of row 3"), or at so many trees."""
    text = text_of(part.terms)
    whole = found.selector == s.Rows() and not found.one_by_one
    if count is None and plural and not whole:
        return found
    of_it = part.relation is None or part.relation.kind == "OF"
    if count is None and (whole or of_it or not _says_one(part)):
        raise every_or_how_many(part)
    number = count or 1
    if found.one_by_one:
        parts: tuple[s.Selector, ...] = tuple(s.Take(count=number, of=row) for row in found.one_by_one)
        return FoundPlace(selector=s.UnionOf(parts=parts), many=True, each=True)
    if counts_each(found, part) and not isinstance(found.selector, s.Successive):
        raise Question(
            message(
                "'{said}': {number} at each tree, or {number} in each row?",
                context="question",
                said=text,
                number=number,
            ),
            (message("{number} in each row", context="answer", number=number),),
        )
    if count is None and are_several_rows(found.selector):
        asked = message("'{said}': one in each of them, or one in all?", context="question", said=text)
        raise each_or_in_all(
            part, asked, (message("one in each of them", context="answer"), message("one in all", context="answer")), 1
        )
    return FoundPlace(selector=some_of(found.selector, number), many=number > 1, counted=number)


def _says_one(part: ClausePart) -> bool:
    """Whether the command says that it wants one ("a picture")."""
    return bool(part.objects) and any(t.text.lower() in ("a", "an", "one") for t in part.objects[0].quantity)


def _in_area(found: FoundPlace, part: ClausePart, count: int | None, plural: bool) -> FoundPlace:
    """Captures in an area: at one tree of it, at as many as there are captures, or at every tree."""
    if count is None and plural:
        if found.selector == s.Trees():
            raise every_or_how_many(part)
        return found
    of_it = part.relation is None or part.relation.kind == "OF"
    if count is None and (found.selector == s.Trees() or of_it):  # "a picture of the northern half"
        raise every_or_how_many(part)
    number = count or 1
    return FoundPlace(selector=some_of(found.selector, number), many=number > 1, counted=number)
