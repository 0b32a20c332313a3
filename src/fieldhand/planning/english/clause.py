"""What a clause of a request is: a test, something to take, a place to go to, a repetition or an end.

That shows in a few of its words, which are put in the order of the grammar; the rest must be words that change nothing.
"""

from __future__ import annotations

from collections.abc import Sequence, Set
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fieldhand.planning.english.clauses import CAPTURES, PLACE, TESTS, is_participle
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
_NOT = frozenset({"NOT", "ISNOT"})
#: What a clause of one of these kinds may hold.
_STEP = _NOISE | PLACE | _BETWEEN | {"TAKE", "MEASURE", "GO", "VISIT", "NOUN", "ACTV", "COUNT"}
_MORE_THAN_A_STEP = _NOT | {"IF", "WHERE", "UNTIL", "WHETHER", "EXCEPT", "WITHOUT", "UNKNOWN", "NOTYET", "BUDGET"}


@dataclass
class Clause:
    """The terms of a clause, and what kind of step it is."""

    terms: list[Term]
    kind: str = ""
    said: list[Term] = field(default_factory=list)  # in the order of the grammar
    place: list[Term] = field(default_factory=list)
    action: str = ""  # what is taken; of a repetition, with which capture it begins
    done: bool = False  # "once it is photographed": only what was not done before
    before: bool = False  # "before returning": what stands behind it comes first

    @property
    def kinds(self) -> frozenset[str]:
        """The kinds of its terms."""
        return frozenset(t.kind for t in self.terms)

    def has(self, kinds: Set[str]) -> bool:
        """Whether it has a term of one of these kinds."""
        return any(t.kind in kinds for t in self.terms)


def read_clause(terms: list[Term]) -> Clause | None:
    """What a clause is; without a kind if it says nothing, None if it is no step."""
    clause = Clause(terms=terms)
    if clause.has(TESTS):
        return _test(clause)
    if clause.has({"OTHERWISE"}) or (clause.has({"IF", "WHERE"}) and clause.has(_NOT) and not clause.has(PLACE)):
        clause.kind, clause.said = "otherwise", [word("OTHERWISE", terms[0], "otherwise")]
        return clause if clause.kinds <= _NOISE | _NOT | {"OTHERWISE", "IF", "WHERE"} else None
    if clause.has({"IFSO"}):
        return clause if clause.kinds <= _NOISE | {"IFSO"} else None
    if clause.has({"BEFORE"}) and not clause.has(PLACE | _ENDS | {"NOUN", "ACTV", "REPEAT"}):
        return _as_before(clause)
    if not _is_plain(clause) or clause.has(_MORE_THAN_A_STEP):
        return None
    place = _place(clause.terms)
    nouns = [t for t in clause.terms if t.kind in ("NOUN", "ACTV") and isinstance(t.value, Naming) and t.value.actions]
    for reading in (_repetition, _ending, _taking, _going):
        found = reading(clause, place, nouns)
        if found is not None:
            return clause if found else None
    return clause


def _as_before(clause: Clause) -> Clause | None:
    """ "Do as before": the same again; "what it did before": no more than that."""
    if clause.has({"AS"}):
        clause.kind, clause.said = "repeat", [word("REPEAT", clause.terms[0], "repeat the process")]
    return clause if clause.kinds <= _NOISE | {"BEFORE", "TAKE", "WORK"} else None


def _is_plain(clause: Clause) -> bool:
    """Take "when", "until" and "before" off what is done or gone to. False if they say when something else is done."""
    if any(_is_when(t) for t in clause.terms[:2]):
        clause.terms = [t for t in clause.terms if not _is_when(t)]
        clause.done = any(is_participle(t) for t in clause.terms if t.kind in CAPTURES)
        if not clause.done and clause.has({"NOUN", "ACTV"}):
            return False
    if clause.has({"UNTIL"}) and clause.has(PLACE) and not clause.has({"NOUN", "ACTV"}):
        clause.terms = [t for t in clause.terms if t.kind != "UNTIL"]  # "continue until you are at another tree"
    if clause.terms and clause.terms[0].kind == "BEFORE" and clause.has(_ENDS):
        clause.before, clause.terms = True, clause.terms[1:]
    return bool(clause.terms)


def _is_when(term: Term) -> bool:
    return term.kind == "WHERE" or term.text.lower() == "once"


def _repetition(clause: Clause, place: list[Term], nouns: list[Term]) -> bool | None:
    """ "Repeat the process there", "take that again": whether it is one; None if it is something else."""
    if clause.has({"REPEAT"}) or (clause.has({"WORK"}) and clause.has({"AGAIN"}) and not nouns):
        clause.kind, clause.place = "repeat", place
        clause.action = nouns[0].value.actions[0] if nouns else ""
        head = next(
            (t for t in clause.terms if t.kind == "REPEAT"), word("REPEAT", clause.terms[0], "repeat the process")
        )
        clause.said = [head, *at(place)]
        return clause.kinds <= _STEP | {"REPEAT"} and bool(place or not nouns)
    takes = clause.has({"TAKE", "MEASURE"})
    if takes and not nouns and not place and clause.has({"AGAIN"}) and clause.has({"IT", "READING"}):
        return _one_more(clause)
    if clause.has({"AGAIN", "WORK"}) and (takes or clause.has({"GO", "AGAIN"})):
        return None if nouns or place or clause.has(_ENDS) else False  # something is done that is not said here
    return None


def _ending(clause: Clause, place: list[Term], nouns: list[Term]) -> bool | None:
    if not clause.has(_ENDS) or nouns:
        return None
    where = next((t for t in clause.terms if t.kind in ("FINISH", "START")), None)
    drives = clause.has({"RETURN", "GO", "AT", "GOHOME", "DET", "PLACE"}) or any(
        "marker" in t.text for t in clause.terms
    )
    clause.kind, clause.said = "end", [word("STOP", clause.terms[0], "stop")]
    back = next((t for t in clause.terms if t.kind in ("RETURN", "GOHOME")), None)
    if where is None and back is not None:
        clause.said = [back]
    elif where is not None and drives:
        clause.said = [word("RETURN", where, "return"), word("AT", where, "to"), word("DET", where, "the"), where]
    at_last = len(place) == 1 and place[0].kind == "LAST"
    return clause.kinds <= _STEP | _ENDS and (not place or at_last)


def _taking(clause: Clause, place: list[Term], nouns: list[Term]) -> bool | None:
    """ "Take two pictures at another tree", "photograph it": whether it is that; None without anything to take."""
    if not clause.kinds <= _STEP or (nouns and len({t.value.actions[0] for t in nouns}) != 1):
        return False
    if not nouns:
        more = clause.has({"TAKE", "MEASURE"}) and clause.has({"ANOTHER", "MORE", "AGAIN"})
        if more and not any(t.kind == "DIR" for t in place):
            return _one_more(clause)
        takes = any(t.kind in CAPTURES and t.text.lower() not in ("do", "does") for t in clause.terms)
        return False if place and takes else None  # of what, is not said here
    noun = next((t for t in nouns if t.kind == "NOUN"), nouns[0])
    number = quantity(clause.terms)
    again = [t for t in clause.terms if t.kind in ("AGAIN", "COUNT")][:1]
    if any(t.kind == "ANOTHER" for t in number) and not again:
        again = [word("AGAIN", noun, "again")]
    clause.kind, clause.place, clause.action = "act", place, noun.value.actions[0]
    verb, it = silent("TAKE", noun.start), clause.has({"IT"})
    if noun.kind == "ACTV" and it and place and place[0].kind == "EACH":
        clause.said = [verb, replace(noun, kind="NOUN"), replace(place[0], kind="EACHTAIL", value="EACHTAIL")]
    elif noun.kind == "ACTV" and not (it and not place):
        clause.said = [noun, *place, *again]
        return bool(place)
    else:
        counted = [t for t in number if t.kind == "NUM"]
        clause.said = [verb, *counted, replace(noun, kind="NOUN"), *at(place), *again]
    return True


def _going(clause: Clause, place: list[Term], _nouns: list[Term]) -> bool | None:
    if not place:
        return None
    if clause.has({"HALF", "QUARTER", "SIDE", "EDGE", "ZONE"}) and not clause.has({"MIDDLE", "TREE"}):
        return False  # what is to be done in an area stands in its own clause
    clause.kind, clause.place = "go", place
    clause.said = [word("GO", place[0], "go"), word("AT", place[0], "to"), *place]
    return True


def _one_more(clause: Clause) -> bool:
    """ "Take another one there", "measure it again": what was taken last, at the same tree."""
    terms = clause.terms
    named = [
        t for t in terms if t.kind in PLACE - {"ANOTHER", "TREE", "ANY"} and not (t.kind == "NUM" and t.value == 1)
    ]
    if named or any(t.kind == "TREE" and t.plural for t in terms):
        return False
    tree = next((k for k, t in enumerate(terms) if t.kind == "TREE"), None)
    if tree and terms[tree - 1].kind == "ANOTHER":
        return False
    clause.kind, clause.place = "act", []
    another = next((t for t in terms if t.kind == "ANOTHER"), word("ANOTHER", terms[0], "another"))
    clause.said = [word("TAKE", another, "take"), another]
    return True


def _test(clause: Clause) -> Clause | None:
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
    subject = [word("DET", t, "the") for t in ranks or nouns[:1]] + ranks
    subject += nouns or ([word("READING", ranks[0], "reading")] if ranks else [word("IT", tests[0], "it")])
    negated = any(t.kind in ("NOT", "ISNOT") for t in terms)
    still = [t for t in terms if t.kind == "STILL"][:1]
    clause.kind = "test"
    verb = word("ISNOT" if negated else "IS", tests[0], "is not" if negated else "is")
    head = next((t for t in terms if t.kind in ("IF", "WHERE")), None)
    opening = word("IF", terms[0], "if") if head is None else replace(head, kind="IF", value="if")
    clause.said = [opening, *subject, verb, *still, tests[0], *amounts]
    return clause


def leaves_out(clause: Clause) -> bool:
    """Whether a word that could change something is not said again."""
    number = quantity(clause.terms)
    if number and clause.kind == "repeat":
        return True
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


def _place(terms: Sequence[Term]) -> list[Term]:
    """The words that say where, with those between them, in the order of the text."""
    of_noun = quantity(terms)
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


def quantity(terms: Sequence[Term]) -> list[Term]:
    """The number that stands right before what is to be taken: "two pictures", "another sample"."""
    at = next((k for k, t in enumerate(terms) if t.kind == "NOUN"), 0)
    begin = at
    while begin > 0 and terms[begin - 1].kind in ("NUM", "ANOTHER", "MORE"):
        begin -= 1
    return list(terms[begin:at])


def at(place: Sequence[Term]) -> list[Term]:
    """A place with "at" before it; nothing where there is no place."""
    return [word("AT", place[0], "at"), *place] if place else []


def word(kind: str, near: Term, text: str = "") -> Term:
    """A word that the request does not say."""
    return Term(kind=kind, text=text, start=near.start, end=near.start, value=kind)
