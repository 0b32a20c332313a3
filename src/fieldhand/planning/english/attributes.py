"""What a phrase says of the trees themselves: variety, age, colour, yield."""

from __future__ import annotations

from fieldhand.language import Number, message, named
from fieldhand.language.words import listed
from fieldhand.places import selectors as s
from fieldhand.planning.english.bag import Bag
from fieldhand.planning.english.faults import Question, unclear
from fieldhand.planning.english.tokens import Term
from fieldhand.site.model import Site
from fieldhand.terms import Test

#: Tests and their opposites.
OPPOSITE: dict[Test, Test] = {"lt": "ge", "ge": "lt", "gt": "le", "le": "gt", "eq": "ne", "ne": "eq"}
_UNIT_HINTS = {"years": "age", "kg": "yield"}


def number_of(term: Term) -> float:
    """The number of a number or an amount."""
    return float(term.value if term.kind == "NUM" else term.value.number)


def filtered(bag: Bag, of: s.Selector, site: Site) -> s.Selector:
    """The trees that zones, attributes and comparisons of a phrase leave.

    Raises:
        Unclear, Question: The site has no such attribute, or several.
    """
    while (zone := bag.take("ZONE")) is not None:
        of = s.InZone(zone=zone.value, of=of)
        bag.take("SIDE")
    while bag.has("AMOUNT") and (amount := bag.words("AMOUNT")[0]).value.unit in _UNIT_HINTS:  # "four year old trees"
        name = attribute_of(bag, "", bag.take("AMOUNT"), site)
        of = s.Where(attribute=name, test="eq", value=amount.value.number, of=of)
    for group in bag.compared:
        of = _compared(group, bag, of, site)
    bag.compared = []
    values = []
    while (value := bag.take("ATTRVAL")) is not None:
        values.append(value)
    # "Golden Hills trees with yellow leaves": the attribute is said of one of the values.
    word = bag.take("ATTR") if values and bag.has("ATTR") else None
    meant = next((v for v in values if word is not None and any(n in word.value for n, _ in v.value)), None)
    if word is not None and meant is None:
        raise bag.fault(message("'{said}' is not a {kind}", said=values[0].text, kind=word.text))
    for value in values:
        of = s.Where(attribute=_one(value, word if value is meant else None), test="eq", value=_text(value, bag), of=of)
    return of


def attribute_of(bag: Bag, hint: str, amount: Term | None, site: Site) -> str:
    """Which attribute of the site a comparison or a superlative is about."""
    word = bag.take("ATTR")
    if word is not None:
        if len(word.value) > 1:
            raise Question(
                message(
                    "'{said}' can be {value}: which is meant?",
                    context="question",
                    said=word.text,
                    value=listed(word.value, "or"),
                ),
                tuple(word.value),
            )
        return str(word.value[0])
    if not hint and amount is not None and amount.kind == "AMOUNT":
        hint = _UNIT_HINTS.get(amount.value.unit, "")
    if not hint:
        raise bag.fault(
            message("it does not say which attribute to compare"),
            message("say which: {known}", known=known(site)),
        )
    return hinted(hint, bag.phrase.terms, site)


def hinted(hint: str, terms: tuple[Term, ...], site: Site) -> str:
    """The attribute whose name holds a word."""
    fitting = [name for name in site.attributes if hint in name.lower().replace("-", "_").split("_")]
    if len(fitting) == 1:
        return fitting[0]
    if fitting:
        raise Question(
            message("which of {fitting} is meant?", context="question", fitting=listed(fitting)), tuple(fitting)
        )
    raise unclear(
        terms,
        message("this site records no {hint} of its trees", hint=named(hint, "attribute hint")),
        message("it records: {known}", known=known(site)),
    )


def known(site: Site) -> str:
    """The attributes that a site records, as words."""
    return ", ".join(list(site.attributes)[:8]) or message("none")


def _compared(group: tuple[Term, ...], bag: Bag, of: s.Selector, site: Site) -> s.Selector:
    negated = any(t.kind in ("NOT", "ISNOT") for t in group)
    terms = [t for t in group if t.kind not in ("NOT", "ISNOT", "JOIN")]
    head = terms[0]
    if head.kind == "ATTRVAL":
        word = bag.take("ATTR") if bag.has("ATTR") else None
        if word is not None and not any(name in word.value for name, _ in head.value):
            raise bag.fault(message("'{said}' is not a {kind}", said=head.text, kind=word.text))
        return s.Where(attribute=_one(head, word), test="ne", value=_text(head, bag), of=of)
    if head.kind == "BETWEEN":
        low, high = number_of(terms[1]), number_of(terms[2])
        if low > high:
            raise bag.fault(
                message("no value lies between {low} and {high}", low=Number(f"{low:g}"), high=Number(f"{high:g}")),
                message("put the lower number first"),
            )
        if negated:
            raise bag.fault(message("'not between' is two comparisons"), message("say 'below ...' or 'above ...'"))
        attribute = attribute_of(bag, "", terms[1], site)
        return s.Where(
            attribute=attribute, test="le", value=high, of=s.Where(attribute=attribute, test="ge", value=low, of=of)
        )
    test, hint = head.value
    test = OPPOSITE[test] if negated else test
    return s.Where(attribute=attribute_of(bag, hint, terms[1], site), test=test, value=number_of(terms[1]), of=of)


def _one(value: Term, named: Term | None) -> str:
    """The attribute that a text stands under; the phrase may name it ("variety Carmel")."""
    names = tuple(name for name, _ in value.value)
    if named is not None:
        names = tuple(n for n in names if n in named.value)
    if len(names) > 1:
        raise Question(
            message(
                "'{said}' is a value of {names}: which is meant?",
                context="question",
                said=value.text,
                names=listed(names),
            ),
            names,
        )
    return str(names[0])


def _text(value: Term, bag: Bag) -> str:
    del bag
    return str(value.value[0][1])
