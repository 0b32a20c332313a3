"""Constructions of the end of what was asked for before: "once that's done", "when you have them all"."""

from __future__ import annotations

from dataclasses import replace

from fieldhand.planning.grammar.chart import Grammar
from fieldhand.planning.grammar.meaning import DriveCommand, Home
from fieldhand.planning.grammar.words import Lex

GRAMMAR = Grammar()
construction = GRAMMAR.construction


@construction("then: done_first", cost=0.0)
def when_that_is_done() -> str:
    """Compose "once that's done", before what follows."""
    return "then"


@construction("them_done: CARGO", "them_done: THEMALL", "them_done: several=GROUPALL", "them_done: EACH ONE", cost=0.1)
@construction(
    "them_done: [DET] EACH [DET] GROUPNOUN", "them_done: DET [LAST] GROUPNOUN", "them_done: DET LAST ONE",
    "them_done: EACH [DET] READING", "them_done: DET [LAST] READING", "them_done: EACH [DET] NOUN",
    "them_done: DET [LAST] NOUN",
    cost=0.1,
)  # fmt: skip
def them_done(several: Lex | None = None) -> str:
    """Compose "them all", "the last one" and "all the readings", as what is done."""
    del several
    return "them"


@construction(
    "all_done: [MISSION] [IS] DONE", "all_done: CONTRACTED DONE", "all_done: [MISSION] [IS] DONE WITH them_done",
    "all_done: CONTRACTED DONE WITH them_done", "all_done: HASGOT them_done", "all_done: them_done [IS] DONE",
    "all_done: them_done [IS] verb", "all_done: them_done [IS] ACTV", "all_done: IT AREALL DONE",
    "all_done: IT AREALL verb", "all_done: IT AREALL ACTV",
    cost=0.1,
)  # fmt: skip
def all_done() -> str:
    """Compose "you have them all" and "all of them are done"."""
    return "done"


@construction("done_first: soon all_done", "done_first: word=THEN HASGOT them_done", cost=0.1)
@construction("done_first: word=THEN DET LAST ONE", "done_first: word=THEN DET LAST GROUPNOUN", cost=0.1)
@construction("done_first: word=THEN DET LAST READING", "done_first: WITH them_done verb", cost=0.1)
@construction("done_first: WITH them_done DONE", cost=0.1)
def done_first(word: Lex | None = None) -> str | None:
    """Compose "once that's done" and "after the last one"."""
    return "done" if word is None or "after_doing" in word.features else None


@construction("home: way=home [COMMA] done_first", cost=0.3)
def home_when_that_is_done(way: Home, used: int) -> Home:
    """Compose "come back when you've been round"."""
    return replace(way, used=used, when_done=True)


@construction("drive: way=drive [COMMA] done_first", cost=0.2)
def drive_when_done(way: DriveCommand, used: int) -> DriveCommand:
    """Compose "go to the charger when you're finished"."""
    return replace(way, used=used)
