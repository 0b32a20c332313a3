"""Constructions of distances between captures, or between trees: "every 10 m", "stops 20 m apart"."""

from __future__ import annotations

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import Amount
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("every: EACH far=amount", cost=0.1)
def every_so_far(far: Amount) -> float | None:
    """Compose "every 10 m"."""
    return far.number if far.unit == "metres" else None


@construction(
    "apart: [WITH] far=amount APART",
    "apart: ABOUT far=amount APART",
    "apart: SPACEDBY every=every",
    "apart: SPACEDBY far=amount [APART]",
    "apart: [AT] far=amount INTERVAL",
    "apart: AT [DET] INTERVAL OF far=amount",
    "apart: [WITH] [DET] INTERVAL [OF] [COMMA] far=amount",
    "apart: EACH [ONE] far=amount APART",
    "apart: [WITH] far=amount BETWEEN [DET] POINT",
    "apart: [WITH] far=amount BETWEEN [ONE] READING [AND] [DET] [NEXTONE]",
    cost=0.1,
)
def apart(far: Amount | None = None, every: float | None = None) -> float | None:
    """Compose "10 m apart"."""
    if every is not None:
        return every
    return far.number if far is not None and far.unit == "metres" else None


@construction(
    "apart_least: ATLEAST far=amount APART",
    "apart_least: [EACH] check=CMP far=amount APART",
    "apart_least: SPACEDBY ATLEAST far=amount [APART]",
    cost=0.1,
)
def apart_at_least(far: Amount, check: Lex | None = None) -> float | None:
    """Compose "at least 10 m apart"."""
    if far.unit != "metres" or (check is not None and (check.value is None or check.value[0] not in ("ge", "gt"))):
        return None
    return far.number


@construction("spaced: dist=every", cost=0.0)
def spacing_of_one(dist: float) -> tuple[float, bool]:
    """Compose "every 10 m"."""
    return (dist, False)


@construction("spaced: dist=apart", "spaced: dist=apart_least", cost=0.0)
def spacing_of_many(dist: float) -> tuple[float, bool]:
    """Compose "10 m apart"."""
    return (dist, True)


@construction(
    "own_stops: [STOPBY] [WITH] [DET] POINT [COMMA] dist=spaced",
    "own_stops: STOPEACH dist=every",
    "own_stops: [DET] READING dist=every",
    "own_stops: ONE READING dist=every",
    "own_stops: dist=spaced REMAINS",
    "own_stops: INTERVAL COMMA far=amount",
    cost=0.1,
)
def own_stops(dist: tuple[float, bool] | float | None = None, far: Amount | None = None) -> tuple[float, bool] | None:
    """Compose "stops 20 m apart", "stop every 20 m" and "one reading every 20 m"."""
    if far is not None:
        return (far.number, False) if far.unit == "metres" else None
    return dist if isinstance(dist, tuple) else (dist or 0.0, False)
