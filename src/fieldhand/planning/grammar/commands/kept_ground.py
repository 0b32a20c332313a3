"""Constructions of ground that is left as it is: "mow the meadow except the wet corner", "leave it standing"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.places import selectors as s
from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.commands.working import Tract
from fieldhand.planning.grammar.meaning import WorkCommand
from fieldhand.planning.selections import are_rows, as_zone

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("kept_ground: [DET] out=region", cost=0.0)
def kept_ground(out: s.Selector) -> s.Selector | None:
    """Compose "the wet corner", which is left as it is."""
    return out if all(as_zone(part) is not None for part in out.members) else None


@construction("kept_ground: out=kept_ground AND more=kept_ground", cost=0.1)
def more_kept_ground(out: s.Selector, more: s.Selector) -> s.Selector:
    """Compose "the wet corner and the orchid patch"."""
    return s.UnionOf(parts=(*out.members, *more.members))


@construction(
    "tract: part=tract except out=kept_ground", "tract: part=tract [COMMA] BUT [NOT] out=kept_ground",
    "tract: part=tract [COMMA] but_not out=kept_ground",
    cost=0.0,
)  # fmt: skip
def ground_but(part: Tract, out: s.Selector) -> Tract | None:
    """Compose "the meadow except the wet corner"."""
    return (
        None if part.mode is not None or are_rows(part.selector) else replace(part, selector=_rest(part.selector, out))
    )


@construction("but_not: CONTRAST NOT", "but_not: AND NOT", cost=0.0)
def but_not() -> str:
    """Compose "but not"."""
    return "but not"


@construction(
    "left_standing: LEAVE out=kept_ground UNCUT", "left_standing: LEAVE out=kept_ground ALONE",
    "left_standing: LEAVEOUT out=kept_ground", "left_standing: WITHOUT TOUCHING out=kept_ground",
    cost=0.1,
)  # fmt: skip
def left_standing(out: s.Selector) -> s.Selector:
    """Compose "leave the orchid patch standing"."""
    return out


@construction(
    "and_leave: COMMA", "and_leave: FULLSTOP", "and_leave: [COMMA] AND", "and_leave: [COMMA] CONTRAST", cost=0.0
)
def and_leave() -> str:
    """Compose "and" or "but" before "leave the orchid patch standing"."""
    return "and"


@construction("work: one=work [and_leave] out=left_standing", cost=0.1)
def work_but(one: WorkCommand, out: s.Selector, used: int) -> WorkCommand | None:
    """Compose "mow the meadow. Leave the orchid patch standing"."""
    if one.along is None or one.mode != "area" or are_rows(one.along):
        return None
    return replace(one, along=_rest(one.along, out), used=used)


def _rest(of: s.Selector, out: s.Selector) -> s.Selector:
    """Return ground without a part of it."""
    return s.Excluding(places=out, of=of)
