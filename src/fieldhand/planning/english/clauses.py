"""The clauses of a request: its sentences cut where a new step begins, each word as what it is in a plain clause."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from fieldhand.planning.english.gist import is_empty
from fieldhand.planning.english.limits import with_amounts
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.tokens import Term

CAPTURES = frozenset({"TAKE", "MEASURE", "ACTV"})
TESTS = frozenset({"CMP", "LEVEL", "BETWEEN"})
#: Words that say where.
PLACE = frozenset(
    {"TREE", "ANOTHER", "OTHER", "NEARBY", "NEAREST", "FAR", "FARTHEST", "MIDDLE", "PLOT", "MOST", "DIR", "CORNER"}
    | {"SIDE", "ORD", "LAST", "ANY", "NUM", "IDS", "ADJACENT", "EACH", "STEP", "HALF", "QUARTER", "ZONE", "EDGE"}
    | {"CONSECUTIVE", "ALONG", "WAY"}
)
_OPENS = frozenset({"IF", "WHERE", "WHETHER", "OTHERWISE", "IFSO", "GO", "VISIT", "RETURN", "REPEAT", "STOP", "UNTIL"})
_OPENS = _OPENS | CAPTURES | {"BEFORE"}
_LINKS = frozenset({"COMMA", "AND", "THEN", "OR", "DASH"})
_BEFORE_NOUNS = frozenset({"DET", "NUM", "ORD", "ANOTHER", "MORE", "OF", "WITH", "WHICH"})
#: A reading that "calls for", "leads to" or "requires" something: a test and what it decides.
_DECIDES = frozenset(
    {"means", "calls", "leads", "requires", "triggers", "needs", "asks", "demands", "prompts", "warrants", "earns"}
    | {"gets", "sends", "brings", "tells", "mean", "call", "lead", "require", "trigger", "followed", "results", "then"}
)
#: What is done over again: "the same routine", "the process once more".
_WORK = frozenset(
    {"process", "procedure", "routine", "sequence", "series", "steps", "task", "tasks", "work", "job", "everything"}
    | {"thing", "things", "all", "drill", "exercise", "operation", "actions", "what", "whole", "measurements", "cycle"}
)
#: Whose reading or middle it is shows in the word behind.
_OWNERS = frozenset({"orchard", "farm", "field", "block", "plot", "tree", "photo", "picture", "image", "photograph"})
#: What a number in front of a clause counts.
_COUNTED = frozenset({"task", "step", "stop", "job", "move", "thing", "action", "up", "off", "of", "all"})


def clauses_of(terms: Sequence[Term], glue: frozenset[str]) -> Iterator[list[list[Term]]]:
    """The clauses of each sentence.

    Args:
        terms: The terms of the whole request.
        glue: Words that are not known and change nothing.
    """
    known = [t if t.kind in ("NUM", "ORD") or not is_empty(t, glue) else replace(t, kind="GLUE") for t in terms]
    flat = _without_start(with_amounts([t for t in known if t.kind != "FILLER"]))
    for sentence in _sentences(_in_plain_kinds(flat)):
        yield list(_clauses(_without_counting(sentence)))


def is_participle(term: Term) -> bool:
    """Whether a verb says what was done: "photographed"."""
    words = term.text.lower().split()
    return bool(words) and (words[-1].endswith("ed") or words[-1] in ("taken", "shot", "read", "done"))


def _in_plain_kinds(terms: Sequence[Term]) -> list[Term]:
    """Nouns that look like verbs as nouns; "the same routine" as what it repeats; "the orchard's" as nothing."""
    plain: list[Term] = []
    for k, term in enumerate(terms):
        before = plain[-1].kind if plain else ""
        if (
            term.kind == "ACTV"
            and before in _BEFORE_NOUNS
            and not is_participle(term)
            and isinstance(term.value, Naming)
        ):
            plain.append(replace(term, kind="NOUN"))
        elif term.kind == "MEASURE" and before in ("DET", "NUM", "ANOTHER", "MORE", "OF"):
            plain.append(replace(term, kind="READING"))
        elif term.kind == "REPEAT" and before == "DET" and " " not in term.text:
            plain.append(replace(term, kind="READING"))  # "if the repeat is low, too"
        elif term.kind == "SAME" and any(t.kind == "REPEAT" for t in plain[-3:]):
            plain.append(replace(term, kind="GLUE"))
        elif (
            term.kind == "ORD" and before in ("NOUN", "PLOT", "MIDDLE", "TREE", "ALONG") and _ends(terms[k + 1 : k + 2])
        ):
            continue  # "the middle of the field first, ..."
        elif term.kind == "FARTHEST" and any(t.kind == "FARTHEST" for t in plain[-2:]):
            continue
        elif term.kind == "UNKNOWN" and term.text.lower().removesuffix("'s") in _OWNERS and "'" in term.text:
            plain.append(replace(term, kind="GLUE"))
        elif term.kind == "SAME" and not any(
            t.kind in ("TREE", "ROW", "PLACE", "NOUN", "ACTV") for t in terms[k + 1 : k + 3]
        ):
            plain.append(replace(term, kind="REPEAT", text="do the same", value="REPEAT"))
        elif term.kind in ("UNKNOWN", "GLUE") and term.text.lower() in _WORK:
            plain.append(replace(term, kind="WORK"))
        else:
            plain.append(term)
    return plain


def _ends(behind: Sequence[Term]) -> bool:
    return not behind or behind[0].kind in ("COMMA", "STOPMARK", "THEN")


def _without_counting(sentence: list[Term]) -> list[Term]:
    """A sentence without the number of the step that it is: "First, ...", "Your third task is ..."."""
    for k, term in enumerate(sentence[:3]):
        if term.kind not in ("DET", "GLUE", "WORK", "ORD"):
            break
        behind = sentence[k + 1] if k + 1 < len(sentence) else None
        counts = behind is not None and (behind.kind == "COMMA" or behind.text.lower() in _COUNTED)
        if term.kind == "ORD" and counts:
            return [*sentence[:k], *sentence[k + 1 :]]
    return sentence


def _without_start(terms: list[Term]) -> list[Term]:
    """The terms without "from the starting point": where every mission begins."""
    for k, term in enumerate(terms):
        if term.kind == "STOPMARK" and k > 3:
            break
        if term.kind == "START" and not any(t.kind in ("RETURN", "AMOUNT", "NEAREST", "NEAR") for t in terms[:k]):
            begin = k
            while begin > 0 and terms[begin - 1].kind in ("DET", "FROM", "AT", "OF", "FOR", "GLUE"):
                begin -= 1
            return [*terms[:begin], *terms[k + 1 :]]
    return terms


def _sentences(terms: Sequence[Term]) -> Iterator[list[Term]]:
    sentence: list[Term] = []
    for term in terms:
        if term.kind == "STOPMARK":
            if term.text.strip() == "?" and _asks(sentence):
                sentence.append(replace(term, kind="COMMA"))  # "Below 400 ppm? Then ..."
                continue
            yield sentence
            sentence = []
        else:
            sentence.append(term)
    yield sentence


def _asks(sentence: Sequence[Term]) -> bool:
    """Whether a question ends with its test: what follows it is what the answer decides."""
    tests = [k for k, t in enumerate(sentence) if t.kind in TESTS]
    return bool(tests) and not any(t.kind in _OPENS | {"NOUN"} for t in sentence[tests[-1] :])


def _clauses(sentence: Sequence[Term]) -> Iterator[list[Term]]:
    clause: list[Term] = []
    for term in sentence:
        asks = clause and clause[0].kind == "IF" and not any(t.kind in TESTS for t in clause)
        if asks and term.kind != "COMMA" and (term.kind in _LINKS or term.kind in _OPENS - {"IF"}):
            if term.kind not in _LINKS:
                clause.append(term)
            continue
        if term.kind in _LINKS or (_tests_wholly(clause) and term.text.lower().split()[:1] and _decides(term)):
            if clause:
                yield clause
            clause = []
            continue
        full = any(t.kind in PLACE | TESTS | {"NOUN", "ACTV", "REPEAT", "STOP", "OTHERWISE", "FINISH"} for t in clause)
        if term.kind in _OPENS and full and not (term.kind in CAPTURES and is_participle(term)):
            yield clause
            clause = []
        clause.append(term)
        if term.kind == "OTHERWISE":
            yield clause
            clause = []
    if clause:
        yield clause


def _tests_wholly(clause: Sequence[Term]) -> bool:
    """Whether a clause ends with a test that is said to its end."""
    return any(t.kind in TESTS for t in clause) and clause[-1].kind in (
        "AMOUNT",
        "NUM",
        "LEVEL",
        "GLUE",
        "READING",
        "THERE",
    )


def _decides(term: Term) -> bool:
    return term.kind in ("UNKNOWN", "GLUE", "TAKE", "READING") and term.text.lower().split()[0] in _DECIDES
