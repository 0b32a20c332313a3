"""Explain how a selector was resolved, part by part, for read-back and for questions."""

from __future__ import annotations

from dataclasses import dataclass

from fieldhand.places.context import Context
from fieldhand.places.resolution import Resolution, ResolutionStep
from fieldhand.places.selector import Selector
from fieldhand.places.wording import say_selectors
from fieldhand.site.model import Place, Site

_FEW = 6


@dataclass(frozen=True, kw_only=True)
class ResolvedPart:
    """One part of a resolved selector.

    Attributes:
        selector: The part, with those nested in it.
        words: The part in words: "the northernmost of the yellow trees".
        rule: Rule that was applied, as a short clause ("rows are counted from west"); empty where the words suffice.
        candidates: Number of places it chose from; None for a source.
        chosen: Number of places it left.
        ids: Ids of the first few of these.
        runners_up: Ids of the next few, where places were ranked.
        notes: Surprises to point out: a tie, the end of a row, a stand-in.
    """

    selector: Selector
    words: str
    rule: str
    candidates: int | None
    chosen: int
    ids: tuple[str, ...]
    runners_up: tuple[str, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """The places of a selector and how they were found.

    Attributes:
        places: Places in the order of :func:`~fieldhand.places.resolution.resolve`.
        parts: Parts in the order of their resolution, each after those nested in it.
    """

    places: tuple[Place, ...]
    parts: tuple[ResolvedPart, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """Surprises to point out, of all parts, each once."""
        return tuple(dict.fromkeys(note for part in self.parts for note in part.notes))

    @property
    def rules(self) -> tuple[str, ...]:
        """The rules that were applied, each once."""
        return tuple(dict.fromkeys(part.rule for part in self.parts if part.rule))

    def say(self) -> tuple[str, ...]:
        """Return a line for each part: "the trees of row 3: 12 of 98; rows are counted from west"."""
        return tuple(_line(part) for part in self.parts)


def explain(selector: Selector, site: Site, context: Context) -> Explanation:
    """Resolve a selector and return its places with an explanation.

    Raises:
        PlaceError: As for :func:`~fieldhand.places.resolution.resolve`.
    """
    resolution = Resolution(site, context)
    found = resolution.spots(selector)
    steps = resolution.steps
    words = say_selectors(step.selector for step in steps)
    return Explanation(places=found.places, parts=tuple(map(_part, steps, words)))


def notes(selector: Selector, site: Site, context: Context) -> tuple[str, ...]:
    """Return the surprises to point out about the places of a selector: ties, ends of rows, stand-ins.

    Raises:
        PlaceError: As for :func:`~fieldhand.places.resolution.resolve`.
    """
    steps = Resolution(site, context)
    steps.spots(selector)
    return tuple(dict.fromkeys(note for step in steps.steps for note in step.notes.remarks))


def _part(step: ResolutionStep, words: str) -> ResolvedPart:
    return ResolvedPart(
        selector=step.selector,
        words=words,
        rule=step.notes.rule,
        candidates=step.notes.candidates,
        chosen=len(step.places),
        ids=tuple(p.id for p in step.places.keep(slice(_FEW)).places),
        runners_up=step.notes.runners_up,
        notes=tuple(step.notes.remarks),
    )


def _line(part: ResolvedPart) -> str:
    of = f"{part.chosen}" if part.candidates is None else f"{part.chosen} of {part.candidates}"
    named = ", ".join(part.ids) + (f" and {part.chosen - len(part.ids)} more" if part.chosen > len(part.ids) else "")
    return "; ".join((f"{part.words}: {of} ({named})", *((part.rule,) if part.rule else ()), *part.notes))
