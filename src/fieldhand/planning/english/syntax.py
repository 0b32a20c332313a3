"""The grammar's parts as data, and the parser that makes them."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from fieldhand.planning.english.arrange import ArrangedSentence
from fieldhand.planning.english.faults import spans_of
from fieldhand.planning.english.separators import Break
from fieldhand.planning.english.tokens import Term
from fieldhand.task.plan import Span

Quantity = tuple[Term, ...]


@dataclass(frozen=True, kw_only=True)
class PlacePhrase:
    """A place, or a group of them: how many, and every word that says which."""

    quantity: Quantity = ()
    nominals: tuple[tuple[Term, ...], ...] = ()
    there: Term | None = None

    @property
    def terms(self) -> tuple[Term, ...]:
        """Every term of it."""
        inner = tuple(t for group in self.nominals for t in group)
        return (*self.quantity, *inner, *((self.there,) if self.there else ()))


@dataclass(frozen=True, kw_only=True)
class Chain:
    """Noun phrases, each tied to the one before it by a relation ("a tree in the middle of the orchard")."""

    phrases: tuple[PlacePhrase, ...]
    relations: tuple[Term, ...] = ()

    @property
    def terms(self) -> tuple[Term, ...]:
        """Every term of it."""
        return (*(t for p in self.phrases for t in p.terms), *self.relations)


@dataclass(frozen=True, kw_only=True)
class Places:
    """Chains joined by commas and "and"."""

    chains: tuple[Chain, ...]
    joins: tuple[Term, ...] = ()

    @property
    def terms(self) -> tuple[Term, ...]:
        """Every term of it."""
        return (*(t for c in self.chains for t in c.terms), *self.joins)


@dataclass(frozen=True, kw_only=True)
class Object:
    """Something to capture: how many, and its noun."""

    noun: Term
    quantity: Quantity = ()

    @property
    def terms(self) -> tuple[Term, ...]:
        """Every term of it."""
        return (*self.quantity, self.noun)


@dataclass(frozen=True, kw_only=True)
class ClausePart:
    """One part of a sentence.

    Attributes:
        kind: Name of the grammar's rule.
        then: "then" stands before it.
        bare: No comma, "and" or "then" stands before it.
        joined: "and" stands before it.
        listed: A colon stands before it.
        verb: Its verb, if it has one.
        objects: What to capture.
        places: Where.
        relation: The relation that ties the places to the verb ("at", "of", "next to").
        spacing: "15 m apart", "every 20 m".
        tails: Words such as "twice", "again", "in any order", "there".
        terms: Every term of the part, in order.
    """

    kind: str
    terms: tuple[Term, ...]
    then: bool = False
    bare: bool = False
    joined: bool = False
    listed: bool = False
    verb: Term | None = None
    objects: tuple[Object, ...] = ()
    places: Places | None = None
    relation: Term | None = None
    spacing: Term | None = None
    tails: tuple[Term, ...] = ()

    @property
    def said(self) -> tuple[Span, ...]:
        """Where it stands in the request."""
        return spans_of(self.terms)


@dataclass(frozen=True, kw_only=True)
class NotParsed:
    """A sentence that the grammar does not accept: the first term that does not fit, and the sentence's range."""

    term: Term
    said: Span
    after: tuple[Term, ...] = field(default=())


def parse(sentence: ArrangedSentence) -> tuple[ClausePart, ...] | NotParsed:
    """The parts of a sentence."""
    from lark import Token
    from lark.exceptions import UnexpectedInput

    terms = sentence.terms
    tokens = [Token(t.kind, t) for t in terms]
    whole = (min(t.start for t in terms), max(t.end for t in terms))
    try:
        tree = _parser().parse(tokens, start="start")
    except UnexpectedInput as error:
        token = getattr(error, "token", None)
        term = token.value if token is not None and isinstance(token.value, Term) else terms[-1]
        return NotParsed(term=term, said=whole)
    parts: list[ClausePart] = []
    then, bare, joined, listed = sentence.then, False, False, False
    for child in tree.children:
        if isinstance(child, Token):
            brk: Break = child.value.value
            then, bare, joined, listed = brk.then, not child.value.text, brk.joined, brk.listed
            continue
        parts.append(replace(_part(child, then), bare=bare, joined=joined, listed=listed))
        then = bare = joined = listed = False
    return tuple(parts)


def parse_places(terms: tuple[Term, ...]) -> Places | None:
    """Terms as places; None if they are none."""
    from lark import Token
    from lark.exceptions import UnexpectedInput

    try:
        tree = _parser().parse([Token(t.kind, t) for t in terms], start="places")
    except UnexpectedInput:
        return None
    return _places(tree)


@cache
def _parser() -> Any:
    from lark import Lark

    from fieldhand.planning.english.term_lexer import TermLexer

    grammar = (files("fieldhand.planning.english") / "grammar.lark").read_text(encoding="utf-8")
    options = {"parser": "lalr", "lexer": TermLexer, "start": ["start", "places"], "maybe_placeholders": False}
    return Lark(grammar, **options, cache=_tables())


def _tables() -> str | bool:
    """Return the file that keeps the parser's tables, which take a tenth of a second to build; False for none.

    It stands beside the modules as they are compiled, and is trusted as they are. Lark builds the tables anew where
    grammar, options or versions have changed.
    """
    folder = Path(__file__).parent / "__pycache__"
    return str(folder / "grammar.tables") if os.access(folder, os.W_OK) else False


def _terms(tree: Any) -> tuple[Term, ...]:
    from lark import Token

    found: list[Term] = []
    for child in tree.children:
        if isinstance(child, Token):
            found.append(child.value)
        else:
            found.extend(_terms(child))
    return tuple(found)


def _part(tree: Any, then: bool) -> ClausePart:
    from lark import Token

    fields: dict[str, Any] = {"tails": ()}
    for child in _flat(tree):
        if isinstance(child, Token):
            if child.type == "EVERYM":
                fields["spacing"] = child.value
            if child.type in ("GO", "VISIT", "RETURN", "GOHOME", "STOP", "REPEAT") and "verb" not in fields:
                fields["verb"] = child.value
            continue
        match child.data:
            case "verb":
                fields.setdefault("verb", _terms(child)[0])
            case "objects":
                fields["objects"] = _objects(child)
            case "places":
                fields["places"] = _places(child)
            case "where":
                fields["relation"] = _terms(child.children[0])[0]
                fields["places"] = _places(child.children[1])
            case "rel_or_for":
                fields["relation"] = _terms(child)[0]
            case "tail" | "bare_tail":
                fields["tails"] = (*fields["tails"], *_terms(child))
            case _:
                pass
    return ClausePart(kind=str(tree.data), terms=_terms(tree), then=then, **fields)


def _flat(tree: Any) -> Iterator[Any]:
    """The children of a part, those of a distance and its line among them."""
    for child in tree.children:
        if getattr(child, "data", None) == "spaced":
            yield from child.children
        else:
            yield child


def _objects(tree: Any) -> tuple[Object, ...]:
    from lark import Token

    found: list[Object] = []
    for child in tree.children:
        if isinstance(child, Token):
            continue
        inner = _terms(child)
        found.append(Object(noun=inner[-1], quantity=inner[:-1]))
    return tuple(found)


def _places(tree: Any) -> Places:
    from lark import Token

    chains = tuple(_chain(child) for child in tree.children if not isinstance(child, Token))
    return Places(chains=chains, joins=tuple(child.value for child in tree.children if isinstance(child, Token)))


def _chain(tree: Any) -> Chain:
    phrases: list[PlacePhrase] = []
    relations: list[Term] = []
    for child in tree.children:
        if child.data == "relation":
            relations.append(_terms(child)[0])
            continue
        quantity: Quantity = ()
        nominals: list[tuple[Term, ...]] = []
        there: Term | None = None
        for inner in child.children:
            data = getattr(inner, "data", None)
            if data == "quantity":
                quantity = _terms(inner)
            elif data == "nominal":
                nominals.append(_terms(inner))
            else:
                there = inner.value
        phrases.append(PlacePhrase(quantity=quantity, nominals=tuple(nominals), there=there))
    return Chain(phrases=tuple(phrases), relations=tuple(relations))
