"""What a request of several steps comes to where its sentences do not fit the grammar: each clause said plainly.

A clause is a test, something to take, a place to go to, a repetition or an end. What it is shows in a few of its words;
these are put in the order of the grammar, and the rest must be words that change nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fieldhand.planning.english.clauses import CAPTURES, PLACE, TESTS, clauses_of, is_participle
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.rewriting import silent
from fieldhand.planning.english.tokens import Term

_BETWEEN = frozenset({"DET", "OF", "AT", "NEXTTO", "NEAR", "WITH", "WHICH", "FROM", "INSIDE"})
_NOISE = frozenset(
    {"DET", "IS", "IT", "WHICH", "OF", "AT", "FOR", "WITH", "FROM", "PLACE", "READING", "FILLER", "GLUE", "THERE"}
    | {"WORK", "STILL", "AGAIN", "PURPOSE", "AS", "BY", "EACHTAIL", "ONE", "MORE", "THANEQ", "USE", "INSTEAD"}
    | {"ONLY", "TIMES"}
)
_ENDS = frozenset({"RETURN", "FINISH", "START", "STOP", "GOHOME"})
#: How far away a tree is.
_AFAR = frozenset({"FARTHEST", "FAR"})
_OTHERS = frozenset({"ANOTHER", "OTHER", "DET", "TREE", "NUM", "OF", "ONE", "PLACE", "GLUE"})


@dataclass
class _Clause:
    """The terms of a clause, and what kind of step it is."""

    terms: list[Term]
    kind: str = ""
    said: list[Term] = field(default_factory=list)  # in the order of the grammar
    place: list[Term] = field(default_factory=list)
    action: str = ""  # what is taken; of a repetition, with which capture it begins
    done: bool = False  # "once it is photographed": only what was not done before
    before: bool = False  # "before returning": what stands behind it comes first


def steps(terms: Sequence[Term], glue: frozenset[str]) -> list[Term] | None:
    """The same said in plain sentences; None if a clause is none of these steps.

    Args:
        terms: The terms of the whole request.
        glue: Words that are not known and change nothing.
    """
    sentences: list[list[_Clause]] = []
    for sentence in clauses_of(terms, glue):
        clauses = [_read(clause) for clause in sentence]
        if any(
            before is not None and before.kind == "repeat" and _details(after) for before, after in pairwise(clauses)
        ):
            return None
        if any(clause is None or _leaves_out(clause) for clause in clauses):
            return None
        known = [c for c in clauses if c is not None and c.kind]
        sentences.append([c for c in known if not c.before] + [c for c in known if c.before])
    if not _is_told_in_order(sentences):
        return None
    kept = [[c for c in sentence if c.kind] for sentence in sentences]
    kinds = [c.kind for sentence in kept for c in sentence]
    idle = any(kind == "go" and after in ("go", "end", "") for kind, after in pairwise([*kinds, ""]))
    made = [term for sentence in kept for term in _said(sentence)]
    return made if made and not idle else None


def _is_told_in_order(sentences: Sequence[Sequence[_Clause]]) -> bool:
    """Leave out what is said twice: a tree "there" behind its place, what was done. False if a repetition differs."""
    before: _Clause | None = None
    taken: list[str] = []
    for clause in (c for sentence in sentences for c in sentence):
        if clause.kind == "repeat":
            if clause.action and clause.action != (taken or [""])[0]:
                return False
            clause.kind = "act"
        elif clause.done and clause.action in taken:
            clause.kind = ""
            continue
        elif clause.action:
            taken.append(clause.action)
        if before is not None and clause.kind == "go" and _says_other(clause, before):
            clause.kind = ""
            continue
        if before is not None and before.kind == "go" and clause.place and _describe_one(before.place, clause.place):
            described = [*clause.place, *(t for t in before.place if t.kind in _AFAR)]
            clause.said = _in_place_of(clause.said, clause.place, described)
            clause.place, before.kind = described, ""
        elif before is not None and before.kind == "go" and _is_bare(clause.place):
            if clause.kind == "go":
                clause.kind = ""
                continue
            clause.said = [t for t in clause.said if not any(t is p for p in (*clause.place, *_at(clause.place)))]
            clause.said = [t for t in clause.said if not (t.kind == "AT" and t.start == t.end)]
        elif before is not None and before.kind == clause.kind == "go" and _is_bare(before.place):
            before.kind = ""
        before = clause
    return True


def _says_other(clause: _Clause, before: _Clause) -> bool:
    """ "Another tree (a different one)": said twice."""
    kinds = {t.kind for t in clause.terms}
    again = bool(kinds & {"ANOTHER", "OTHER"}) and kinds <= _OTHERS
    return again and any(t.kind in ("ANOTHER", "OTHER") for t in before.place)


def _describe_one(first: Sequence[Term], second: Sequence[Term]) -> bool:
    """ "As far away as possible, ... at another tree": how far the tree is, and the tree."""
    far = any(t.kind in _AFAR for t in first) and {t.kind for t in first} <= _AFAR | {"DET", "FROM", "OF", "AT"}
    return far and {t.kind for t in second} <= {"ANOTHER", "OTHER", "TREE", "DET", "ANY", "OF"}


def _in_place_of(said: Sequence[Term], old: Sequence[Term], new: Sequence[Term]) -> list[Term]:
    at = next((k for k, t in enumerate(said) if t is old[0]), len(said))
    kept = [t for t in said if not any(t is o for o in old)]
    return [*kept[:at], *new, *kept[at:]]


def _details(clause: _Clause | None) -> bool:
    """ "..., with its two pictures", "including the picture": what is repeated, said again."""
    first = clause.terms[0] if clause is not None else None
    return first is not None and (first.kind == "WITH" or first.text.lower().split()[:1] in (["with"], ["including"]))


def _is_bare(place: Sequence[Term]) -> bool:
    """ "A tree", "that tree": the one that the robot has come to."""
    return bool(place) and {t.kind for t in place} <= {"TREE", "DET", "ANY", "OF"} and not any(t.plural for t in place)


def _leaves_out(clause: _Clause) -> bool:
    """Whether a word that could change something is not said again."""
    number = _quantity(clause.terms)
    left = [t for t in clause.terms if t.kind in PLACE - {"EACH", "ANY", "PLOT", "TREE"} and t not in clause.said]
    if any(t.kind == "NUM" and not _counts(t, clause.terms) for t in clause.place):
        return True
    if clause.kind == "act" and any(t.kind == "ORD" and t.value != 1 for t in clause.said):
        return True  # which one that is depends on where the count begins
    step = any(t.kind in ("ALONG", "WAY") for t in clause.said)
    return any(t not in number and not (step and t.kind in ("ANOTHER", "OTHER")) for t in left)


def _counts(number: Term, terms: Sequence[Term]) -> bool:
    """Whether a number stands right before the trees that it counts."""
    behind = [t.kind for t in terms[terms.index(number) + 1 :]][:1]
    return not behind or behind[0] in PLACE | {"OF"}


def _read(terms: list[Term]) -> _Clause | None:
    """What a clause is; without a kind if it says nothing, None if it is no step."""
    kinds = {t.kind for t in terms}
    clause = _Clause(terms=terms)
    if kinds & TESTS:
        return _test(clause)
    if kinds & {"OTHERWISE"} or (kinds & {"IF", "WHERE"} and kinds & {"NOT", "ISNOT"} and not kinds & PLACE):
        clause.kind, clause.said = "otherwise", [_word("OTHERWISE", terms[0], "otherwise")]
        return clause if kinds <= _NOISE | {"OTHERWISE", "IF", "WHERE", "NOT", "ISNOT"} else None
    if "IFSO" in kinds:
        return clause if kinds <= _NOISE | {"IFSO"} else None
    if "BEFORE" in kinds and not kinds & (PLACE | {"NOUN", "ACTV", "REPEAT"}):
        if "AS" in kinds:
            clause.kind, clause.said = "repeat", [_word("REPEAT", terms[0], "repeat the process")]
        return clause if kinds <= _NOISE | {"BEFORE", "TAKE", "WORK"} else None  # "what it did before"
    when = any(t.kind == "WHERE" or t.text.lower() == "once" for t in terms)
    if when:
        terms = [t for t in terms if t.kind != "WHERE" and t.text.lower() != "once"]
        kinds = {t.kind for t in terms}
        clause.done = any(is_participle(t) for t in terms if t.kind in CAPTURES)
        if not clause.done and kinds & {"NOUN", "ACTV"}:
            return None
    if "UNTIL" in kinds and kinds & PLACE and not kinds & {"NOUN", "ACTV"}:
        terms = [t for t in terms if t.kind != "UNTIL"]  # "continue until you are at another tree"
        kinds = {t.kind for t in terms}
    if kinds & {"IF", "WHERE", "UNTIL", "WHETHER", "NOT", "ISNOT", "EXCEPT", "WITHOUT", "UNKNOWN", "NOTYET", "BUDGET"}:
        return None
    place = _place(terms)
    nouns = [t for t in terms if t.kind in ("NOUN", "ACTV") and isinstance(t.value, Naming) and t.value.actions]
    ends = kinds & _ENDS
    if ends and terms[0].kind == "BEFORE":
        clause.before = True  # "before returning to the end, ..."
        terms = terms[1:]
        kinds = {t.kind for t in terms}
    allowed = _NOISE | PLACE | _BETWEEN | {"TAKE", "MEASURE", "GO", "VISIT", "NOUN", "ACTV", "COUNT"}
    if "REPEAT" in kinds or ("WORK" in kinds and "AGAIN" in kinds and not nouns):
        clause.kind, clause.place = "repeat", place
        clause.action = nouns[0].value.actions[0] if nouns else ""
        head = next((t for t in terms if t.kind == "REPEAT"), _word("REPEAT", terms[0], "repeat the process"))
        clause.said = [head, *_at(place)]
        return clause if kinds <= allowed | {"REPEAT"} and (place or not nouns) else None
    if "AGAIN" in kinds and kinds & {"IT", "READING"} and kinds & {"TAKE", "MEASURE"} and not nouns and not place:
        return _one_more(clause)
    if kinds & {"AGAIN", "WORK"} and kinds & {"TAKE", "MEASURE", "GO", "AGAIN"} and not (nouns or place or ends):
        return None  # something is done that is not said here
    if ends and not nouns:
        clause.kind, clause.said = "end", _end(terms)
        at_last = len(place) == 1 and place[0].kind == "LAST"
        return clause if kinds <= allowed | _ENDS and (not place or at_last) else None
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
        clause.place, clause.action = place, noun.value.actions[0]
        if noun.kind == "ACTV" and "IT" in kinds and not place:
            noun = replace(noun, kind="NOUN")  # "photograph it"
        elif noun.kind == "ACTV" and place and place[0].kind == "EACH" and "IT" in kinds:
            each = replace(place[0], kind="EACHTAIL", value="EACHTAIL")
            clause.said = [verb, replace(noun, kind="NOUN"), each]
            return clause
        named = [noun, *place] if noun.kind == "ACTV" else [verb, *counted, noun, *_at(place)]
        clause.said = [*named, *again]
        return clause if noun.kind == "NOUN" or place else None
    if kinds & {"TAKE", "MEASURE"} and kinds & {"ANOTHER", "MORE", "AGAIN"} and not any(t.kind == "DIR" for t in place):
        return _one_more(clause)
    if place and any(t.kind in CAPTURES and t.text.lower() not in ("do", "does") for t in terms):
        return None  # of what, is not said here
    if place:
        if kinds & {"HALF", "QUARTER", "SIDE", "EDGE", "ZONE"} and not kinds & {"MIDDLE", "TREE"}:
            return None  # what is to be done in an area stands in its own clause
        clause.kind, clause.place = "go", place
        clause.said = [_word("GO", place[0], "go"), _word("AT", place[0], "to"), *place]
    return clause


def _one_more(clause: _Clause) -> _Clause | None:
    """ "Take another one there", "measure it again": what was taken last, at the same tree."""
    terms = clause.terms
    named = [
        t for t in terms if t.kind in PLACE - {"ANOTHER", "TREE", "ANY"} and not (t.kind == "NUM" and t.value == 1)
    ]
    if named or any(t.kind == "TREE" and t.plural for t in terms):
        return None
    tree = next((k for k, t in enumerate(terms) if t.kind == "TREE"), None)
    if tree and terms[tree - 1].kind == "ANOTHER":
        return None
    clause.kind, clause.place = "act", []
    another = next((t for t in terms if t.kind == "ANOTHER"), _word("ANOTHER", terms[0], "another"))
    clause.said = [_word("TAKE", another, "take"), another]
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
        _NOISE | TESTS | {"IF", "WHERE", "NOUN", "AMOUNT", "NUM", "NOT", "ISNOT", "ORD", "TREE", "MEASURE", "TAKE"}
    )
    if not kinds <= allowed | {"GO", "VISIT", "AT"} or sum(t.kind in ("NOT", "ISNOT") for t in terms) > 1:
        return None
    tests = [t for t in terms if t.kind in TESTS]
    amounts = [t for t in terms if t.kind in ("AMOUNT", "NUM")]
    nouns = [t for t in terms if t.kind == "NOUN"]
    if len(nouns) == 2 and set(nouns[0].value.actions) & set(nouns[1].value.actions):
        nouns = nouns[1:]  # "the temperature in the photograph"
    if len(tests) != 1 or len(nouns) > 1 or tests[0].kind == "BETWEEN" or len(amounts) != (tests[0].kind == "CMP"):
        return None
    ranks = [t for t in terms if t.kind == "ORD" and t.value == 1][:1]  # "the second" is what was taken last
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
    drives = any(t.kind in ("RETURN", "GO", "AT", "GOHOME", "DET", "PLACE") for t in terms)
    drives = drives or any("marker" in t.text.lower() for t in terms)
    if where is None or not drives:
        return [_word("STOP", terms[0], "stop")]
    return [_word("RETURN", where, "return"), _word("AT", where, "to"), _word("DET", where, "the"), where]


def _at(place: Sequence[Term]) -> list[Term]:
    return [_word("AT", place[0], "at"), *place] if place else []


def _place(terms: Sequence[Term]) -> list[Term]:
    """The words that say where, with those between them, in the order of the text."""
    of_noun = _quantity(terms)
    named = [k for k, t in enumerate(terms) if t.kind in PLACE and not any(t is q for q in of_noun)]
    ways = [k for k in named if terms[k].kind in ("ALONG", "WAY") and k > 1 and terms[k - 1].kind == "TREE"]
    if ways and terms[ways[0] - 2].kind == "NUM":
        return list(terms[ways[0] - 2 : ways[0] + 1])  # "another random point, 5 trees down"
    if not named or not any(terms[k].kind not in ("NUM", "EACH", "ANY", "ORD", "OTHER") for k in named):
        return []
    first = named[0]
    if first and terms[first - 1].kind == "DET":
        first -= 1
    run = terms[first : named[-1] + 1]
    place = [t for t in run if t.kind in PLACE | _BETWEEN]
    twice = {k for k, (t, after) in enumerate(pairwise(place)) if t.kind == after.kind == "AT"}
    return [t for k, t in enumerate(place) if k not in twice]


def _said(clauses: Sequence[_Clause]) -> list[Term]:
    """The clauses of a sentence as sentences of the grammar."""
    if not clauses:
        return []
    made: list[Term] = []
    end = clauses[-1].terms[-1]
    ordered = list(clauses)
    if clauses[-1].kind in ("test", "otherwise") and len(clauses) > 1:
        for k in range(len(ordered) - 1):  # "take CO2 if it is low": the test behind what it decides
            if ordered[k].kind in ("act", "end") and ordered[k + 1].kind in ("test", "otherwise"):
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
