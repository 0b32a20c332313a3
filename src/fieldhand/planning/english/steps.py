"""What a request of several steps comes to where its sentences do not fit the grammar: each clause said plainly.

A clause is a test, something to take, a place to go to, a repetition or an end. What it is shows in a few of its words;
these are put in the order of the grammar, and the rest must be words that change nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fieldhand.planning.english.gist import is_empty
from fieldhand.planning.english.limits import with_amounts
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.rewriting import silent
from fieldhand.planning.english.tokens import Term

_CAPTURES = frozenset({"TAKE", "MEASURE", "ACTV"})
_OPENS = frozenset({"IF", "WHERE", "WHETHER", "OTHERWISE", "IFSO", "GO", "VISIT", "RETURN", "REPEAT", "STOP", "UNTIL"})
_OPENS = _OPENS | _CAPTURES
_LINKS = frozenset({"COMMA", "AND", "THEN", "OR", "DASH"})
_TESTS = frozenset({"CMP", "LEVEL", "BETWEEN"})
#: Words that say where.
_PLACE = frozenset(
    {"TREE", "ANOTHER", "OTHER", "NEARBY", "NEAREST", "FAR", "FARTHEST", "MIDDLE", "PLOT", "MOST", "DIR", "CORNER"}
    | {"SIDE", "ORD", "LAST", "ANY", "NUM", "IDS", "ADJACENT", "EACH", "STEP", "HALF", "QUARTER", "ZONE", "EDGE"}
    | {"CONSECUTIVE", "ALONG", "WAY"}
)
_BETWEEN = frozenset({"DET", "OF", "AT", "NEXTTO", "NEAR", "WITH", "WHICH", "FROM", "INSIDE"})
_NOISE = frozenset(
    {"DET", "IS", "IT", "WHICH", "OF", "AT", "FOR", "WITH", "FROM", "PLACE", "READING", "FILLER", "GLUE", "THERE"}
    | {"STILL", "AGAIN", "PURPOSE", "AS", "BY", "EACHTAIL", "ONE", "MORE", "THANEQ", "USE", "INSTEAD", "ONLY", "TIMES"}
)


@dataclass
class _Clause:
    """The terms of a clause, and what kind of step it is."""

    terms: list[Term]
    kind: str = ""
    said: list[Term] = field(default_factory=list)  # in the order of the grammar


def steps(terms: Sequence[Term], glue: frozenset[str]) -> list[Term] | None:
    """The same said in plain sentences; None if a clause is none of these steps.

    Args:
        terms: The terms of the whole request.
        glue: Words that are not known and change nothing.
    """
    known = [replace(t, kind="GLUE") if is_empty(t, glue) else t for t in terms if t.kind != "FILLER"]
    flat = _without_start(with_amounts(known))
    made: list[Term] = []
    kinds: list[str] = []
    for sentence in _sentences(flat):
        clauses = [_read(clause) for clause in _clauses(sentence)]
        if any(clause is None or _leaves_out(clause) for clause in clauses):
            return None
        known_kinds = [c for c in clauses if c is not None and c.kind]
        kinds += [c.kind for c in known_kinds]
        made += _said(known_kinds)
    idle = any(kind == "go" and after in ("go", "end", "") for kind, after in pairwise([*kinds, ""]))
    return made if made and not idle else None


def _leaves_out(clause: _Clause) -> bool:
    """Whether a word that could change something is not said again."""
    number = _quantity(clause.terms)
    left = [t for t in clause.terms if t.kind in _PLACE - {"EACH", "ANY", "PLOT", "TREE"} and t not in clause.said]
    if clause.kind == "act" and any(t.kind == "ORD" and t.value != 1 for t in clause.said):
        return True  # which one that is depends on where the count begins
    step = any(t.kind in ("ALONG", "WAY") for t in clause.said)
    return any(t not in number and not (step and t.kind in ("ANOTHER", "OTHER")) for t in left)


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
    tests = [k for k, t in enumerate(sentence) if t.kind in _TESTS]
    return bool(tests) and not any(t.kind in _OPENS | {"NOUN"} for t in sentence[tests[-1] :])


def _clauses(sentence: Sequence[Term]) -> Iterator[list[Term]]:
    clause: list[Term] = []
    for term in sentence:
        if term.kind in _LINKS:
            if clause:
                yield clause
            clause = []
            continue
        full = any(t.kind in _PLACE | _TESTS | {"NOUN", "ACTV", "REPEAT", "STOP"} for t in clause)
        if term.kind in _OPENS and full and not (term.kind in _CAPTURES and _is_participle(term)):
            yield clause
            clause = []
        clause.append(term)
    if clause:
        yield clause


def _is_participle(term: Term) -> bool:
    words = term.text.lower().split()
    return bool(words) and (words[-1].endswith("ed") or words[-1] in ("taken", "shot", "read", "done"))


def _read(terms: list[Term]) -> _Clause | None:
    """What a clause is; without a kind if it says nothing, None if it is no step."""
    kinds = {t.kind for t in terms}
    clause = _Clause(terms=terms)
    if kinds & _TESTS:
        return _test(clause)
    if kinds & {"OTHERWISE"} or (kinds & {"IF", "WHERE"} and kinds & {"NOT", "ISNOT"} and not kinds & _PLACE):
        clause.kind, clause.said = "otherwise", [_word("OTHERWISE", terms[0], "otherwise")]
        return clause if kinds <= _NOISE | {"OTHERWISE", "IF", "WHERE", "NOT", "ISNOT"} else None
    if "IFSO" in kinds:
        return clause if kinds <= _NOISE | {"IFSO"} else None
    if kinds & {"IF", "WHERE", "UNTIL", "WHETHER", "NOT", "ISNOT", "EXCEPT", "WITHOUT", "UNKNOWN", "NOTYET", "BUDGET"}:
        return None
    place = _place(terms)
    nouns = [t for t in terms if t.kind in ("NOUN", "ACTV") and isinstance(t.value, Naming) and t.value.actions]
    ends = kinds & {"RETURN", "FINISH", "START", "STOP", "GOHOME"}
    allowed = _NOISE | _PLACE | _BETWEEN | {"TAKE", "MEASURE", "GO", "VISIT", "NOUN", "ACTV", "COUNT"}
    if "REPEAT" in kinds:
        clause.kind = "act"
        clause.said = [next(t for t in terms if t.kind == "REPEAT"), *_at(place)]
        return clause if kinds <= allowed | {"REPEAT"} and not nouns else None
    if ends and not nouns:
        clause.kind, clause.said = "end", _end(terms)
        return clause if kinds <= allowed | {"RETURN", "FINISH", "START", "STOP", "GOHOME"} and not place else None
    if not kinds <= allowed:
        return None
    if nouns:
        clause.kind = "act"
        noun = next((t for t in nouns if t.kind == "NOUN"), nouns[0])
        if len({t.value.actions[0] for t in nouns}) != 1:
            return None
        again = [t for t in terms if t.kind in ("AGAIN", "COUNT")][:1]
        verb = silent("TAKE", noun.start)
        number = _quantity(terms)
        if any(t.kind == "ANOTHER" for t in number) and not again:
            again = [_word("AGAIN", noun, "again")]
        counted = [t for t in number if t.kind == "NUM"]
        named = [noun, *place] if noun.kind == "ACTV" else [verb, *counted, noun, *_at(place)]
        clause.said = [*named, *again]
        return clause if noun.kind == "NOUN" or place else None
    if place:
        if kinds & {"HALF", "QUARTER", "SIDE", "EDGE", "ZONE"} and not kinds & {"MIDDLE", "TREE"}:
            return None  # what is to be done in an area stands in its own clause
        clause.kind, clause.said = "go", [_word("GO", place[0], "go"), _word("AT", place[0], "to"), *place]
    return clause


def _quantity(terms: Sequence[Term]) -> list[Term]:
    """The number that stands right before what is to be taken: "two pictures", "another sample"."""
    at = next((k for k, t in enumerate(terms) if t.kind == "NOUN"), 0)
    begin = at
    while begin > 0 and terms[begin - 1].kind in ("NUM", "ANOTHER", "MORE"):
        begin -= 1
    return list(terms[begin:at])


def _test(clause: _Clause) -> _Clause | None:
    """ "The CO2 is below 400 ppm", "a low reading": the test of a reading."""
    terms = clause.terms
    kinds = {t.kind for t in terms}
    allowed = (
        _NOISE | _TESTS | {"IF", "WHERE", "NOUN", "AMOUNT", "NUM", "NOT", "ISNOT", "ORD", "TREE", "MEASURE", "TAKE"}
    )
    if not kinds <= allowed | {"GO"} or sum(t.kind in ("NOT", "ISNOT") for t in terms) > 1:
        return None
    tests = [t for t in terms if t.kind in _TESTS]
    amounts = [t for t in terms if t.kind in ("AMOUNT", "NUM")]
    nouns = [t for t in terms if t.kind == "NOUN"]
    if len(tests) != 1 or len(nouns) > 1 or tests[0].kind == "BETWEEN" or len(amounts) != (tests[0].kind == "CMP"):
        return None
    ranks = [t for t in terms if t.kind == "ORD"][:1]
    subject = [_word("DET", t, "the") for t in ranks or nouns[:1]] + ranks
    subject += nouns or ([_word("READING", ranks[0], "reading")] if ranks else [_word("IT", tests[0], "it")])
    negated = any(t.kind in ("NOT", "ISNOT") for t in terms)
    still = [t for t in terms if t.kind == "STILL"][:1]
    clause.kind = "test"
    verb = _word("ISNOT" if negated else "IS", tests[0], "is not" if negated else "is")
    head = next((t for t in terms if t.kind in ("IF", "WHERE")), None)
    opening = _word("IF", terms[0], "if") if head is None else replace(head, kind="IF", value="if")
    clause.said = [opening, *subject, verb, *still, tests[0], *amounts]
    return clause


def _end(terms: Sequence[Term]) -> list[Term]:
    where = next((t for t in terms if t.kind in ("FINISH", "START")), None)
    drives = any(t.kind in ("RETURN", "GO", "AT", "GOHOME", "DET") for t in terms)
    if where is None or not drives:
        return [_word("STOP", terms[0], "stop")]
    return [_word("RETURN", where, "return"), _word("AT", where, "to"), _word("DET", where, "the"), where]


def _at(place: Sequence[Term]) -> list[Term]:
    return [_word("AT", place[0], "at"), *place] if place else []


def _place(terms: Sequence[Term]) -> list[Term]:
    """The words that say where, with those between them, in the order of the text."""
    of_noun = _quantity(terms)
    named = [k for k, t in enumerate(terms) if t.kind in _PLACE and not any(t is q for q in of_noun)]
    ways = [k for k in named if terms[k].kind in ("ALONG", "WAY") and k > 1 and terms[k - 1].kind == "TREE"]
    if ways and terms[ways[0] - 2].kind == "NUM":
        return list(terms[ways[0] - 2 : ways[0] + 1])  # "another random point, 5 trees down"
    if not named or not any(terms[k].kind not in ("NUM", "EACH", "ANY", "ORD", "OTHER") for k in named):
        return []
    first = named[0]
    if first and terms[first - 1].kind == "DET":
        first -= 1
    run = terms[first : named[-1] + 1]
    return [t for t in run if t.kind in _PLACE | _BETWEEN]


def _said(clauses: Sequence[_Clause]) -> list[Term]:
    """The clauses of a sentence as sentences of the grammar."""
    if not clauses:
        return []
    made: list[Term] = []
    end = clauses[-1].terms[-1]
    ordered = list(clauses)
    if clauses[-1].kind in ("test", "otherwise") and len(clauses) > 1:
        for k in range(len(ordered) - 1):  # "take CO2 if it is low": the test behind what it decides
            if ordered[k].kind == "act" and ordered[k + 1].kind in ("test", "otherwise"):
                ordered[k], ordered[k + 1] = ordered[k + 1], ordered[k]
    for k, clause in enumerate(ordered):
        before = ordered[k - 1].kind if k else ""
        anew = "otherwise" in [c.kind for c in ordered[:k]] and before in ("act", "go") and _names_another(clause)
        if anew or (clause.kind == "test" and before not in ("", "otherwise")):
            made.append(_word("STOPMARK", clause.said[0], "."))
        elif k:
            made.append(_word("COMMA", clause.said[0], ","))
        made += clause.said
    return [*made, _word("STOPMARK", end, ".")]


def _names_another(clause: _Clause) -> bool:
    return any(t.kind in ("ANOTHER", "OTHER", "FARTHEST", "MOST") for t in clause.said)


def _word(kind: str, near: Term, text: str = "") -> Term:
    """A word that the request does not say."""
    return Term(kind=kind, text=text, start=near.start, end=near.start, value=kind)
