"""Terms arranged for the grammar: sentences, each with its amounts, limits, ids and separators."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from fieldhand.language import message
from fieldhand.planning.english.allowing import with_allowances
from fieldhand.planning.english.faults import unclear
from fieldhand.planning.english.kinds import PLACES, RELATIONS, VERBS
from fieldhand.planning.english.limits import with_amounts, with_limits
from fieldhand.planning.english.opposites import with_opposites
from fieldhand.planning.english.passive import with_passives
from fieldhand.planning.english.rowwords import with_row_ids, with_row_words
from fieldhand.planning.english.separators import separated
from fieldhand.planning.english.spacing import with_orders, with_spacing
from fieldhand.planning.english.timing import in_time
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.english.wordclass import classed, with_at_most, with_ids
from fieldhand.task.plan import Span

#: Nouns that a compass word needs behind it ("the north-east corner").
_NEEDS_HEAD = frozenset(
    {"TREE", "CORNER", "EDGE", "HALF", "QUARTER", "SIDE", "FINISH", "PLOT", "MIDDLE", "PLACE", "DIR", "MOST", "ATTRVAL"}
    | {"ROW", "OVER"}
)
_NAMED = frozenset({"TREE", "PLACE", "IDS", "CORNER"})
#: What leaves are called where their colour is said ("with yellow leaves"), not where they are sampled.
_FOLIAGE = frozenset({"leaf", "leaves", "foliage"})
#: In a clause that gives a reason, these would be something to do or to decide.
_MORE_THAN_A_REASON = VERBS | {"NUM", "AMOUNT", "IF", "OTHERWISE", "TREE", "CORNER", "WHETHER", "BUDGET", "FITS"}
#: A reason with words that are not known is one all the same, but for these.
_A_DEED = frozenset({"NUM", "AMOUNT", "IF", "OTHERWISE", "TREE", "CORNER", "BUDGET", "FITS", "NOUN", "ACTV", "IDS"})
#: Where a terse "what, where" ends, and what makes a sentence one that says more than that.
_CLAUSE_ENDS = frozenset({"COMMA", "AND", "THEN", "OTHERWISE", "IF", "WHERE", "UNLESS", "BUDGET", "NOORDER", "INORDER"})
_SAID_FULLY = VERBS | {
    "IF",
    "WHERE",
    "UNLESS",
    "WHETHER",
    "OTHERWISE",
    "TRY",
    "FITS",
    "BUDGET",
    "EXCEPT",
    "ISNOT",
    "NOT",
}
#: How a place begins that stands alone in front of a colon.
_OPENS = frozenset({"DET", "MIDDLE", "MOST", "DIR", "CORNER", "TREE", "ORD", "LAST", "NEAREST", "FARTHEST", "ANOTHER"})
#: A clause that begins with one of these says what is to be done.
_TO_DO = frozenset({"in order to", "so as to", "so that we", "so that i", "so we can", "so i can"})


@dataclass(frozen=True, kw_only=True)
class ArrangedSentence:
    """A sentence ready for the grammar.

    Attributes:
        then: It begins with "then", "after that", "from there" or the like.
    """

    terms: tuple[Term, ...]
    then: bool = False


@dataclass(frozen=True, kw_only=True)
class Arranged:
    """The sentences of a request, and what of it needs no grammar.

    Attributes:
        filler: Where words stand that mean nothing to a plan.
        reasons: What is said as a reason.
        remarks: What is said besides.
    """

    sentences: tuple[ArrangedSentence, ...]
    filler: tuple[Span, ...] = ()
    reasons: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Asked:
    """The terms that ask for something, where the others stand, and the reasons among these with their text."""

    terms: tuple[Term, ...]
    filler: tuple[Span, ...] = ()
    reasons: tuple[str, ...] = ()


def arrange(asked: Asked) -> Arranged:
    """Arrange the terms of a request.

    Raises:
        Unclear: An order or a limit that means nothing here.
    """
    kept, filler, reasons = list(asked.terms), list(asked.filler), asked.reasons
    sentences: list[ArrangedSentence] = []
    for group in in_time(with_opposites(_split(kept, filler))):
        sentence, silent = _sentence(group)
        filler += silent
        if any(t.kind not in ("SEP", "JOIN") for t in sentence.terms):
            sentences.append(sentence)
        else:
            filler += [t.span for t in sentence.terms]
    return Arranged(sentences=tuple(sentences), filler=tuple(filler), reasons=tuple(reasons))


def _split(terms: list[Term], filler: list[Span]) -> Iterable[list[Term]]:
    group: list[Term] = []
    for term in terms:
        if term.kind == "STOPMARK":
            filler.append(term.span)
            yield group
            group = []
        else:
            group.append(term)
    yield group


def without_filler(terms: Iterable[Term], request: str) -> Asked:
    """What a request asks for, without words that mean nothing to a plan, and without the reasons that it gives.

    Raises:
        Unclear: A reason holds something to do, or "instead" replaces nothing.
    """
    terms = list(terms)
    kept: list[Term] = []
    filler: list[Span] = []
    reasons: list[str] = []
    at = 0
    while at < len(terms):
        term = terms[at]
        at += 1
        if term.kind in ("FILLER", "ONLY"):
            filler.append(term.span)
        elif term.kind == "INSTEAD":
            if not _contrasted(kept):
                raise unclear(
                    [term], message("it does not say what to replace"), message("say only what is to be done")
                )
            filler.append(term.span)
        elif term.kind == "PURPOSE":
            end = at
            while end < len(terms) and terms[end].kind not in ("COMMA", "STOPMARK", "THEN"):
                end += 1
            clause = terms[at:end]
            if any(t.kind == "UNKNOWN" for t in clause) and not any(t.kind in _A_DEED for t in clause):
                filler.append((term.start, clause[-1].end))
                reasons.append(request[term.start : clause[-1].end])
                at = end
            elif term.text.lower() in _TO_DO and clause and clause[0].kind in VERBS:
                kept.append(replace(term, kind="AND"))
            elif any(t.kind in _MORE_THAN_A_REASON for t in clause):
                advice = message("say what is to be done in a sentence of its own, and leave the reason out")
                raise unclear([term, *clause], message("is this a reason, or something to do?"), advice)
            else:
                last = clause[-1] if clause else term
                filler.append((term.start, last.end))
                reasons.append(request[term.start : last.end])
                at = end
        else:
            kept.append(term)
    return Asked(terms=tuple(kept), filler=tuple(filler), reasons=tuple(reasons))


def _contrasted(before: list[Term]) -> bool:
    """Whether a case has been named that "instead" stands against."""
    for term in reversed(before):
        if term.kind == "STOPMARK":
            return False
        if term.kind in ("OTHERWISE", "IF", "TRY", "WHERE", "UNLESS"):
            return True
    return False


def _sentence(terms: list[Term]) -> tuple[ArrangedSentence, list[Span]]:
    terms = with_spacing(with_amounts(with_allowances(with_passives(terms))))
    terms = with_row_words(with_ids(with_row_ids(terms)))
    terms = with_at_most(classed(with_orders(terms)))
    terms = with_limits(terms)
    terms = _tersely(_with_heads(terms))
    terms, then, silent = separated(terms)
    return ArrangedSentence(terms=tuple(terms), then=then), silent


def _ranks_go_on(terms: list[Term]) -> bool:
    """Whether another rank and its tree follow ("... and at the last tree")."""
    kinds = [t.kind for t in terms if t.kind not in ("AND", "COMMA", "DET", "AT", "OF")]
    apart = any(t.kind in ("AT", "OF") for t in terms[:2])  # without it they are ranks of one noun
    return apart and len(kinds) > 1 and kinds[0] in ("ORD", "LAST") and kinds[1] == "TREE"


def _tersely(terms: list[Term]) -> list[Term]:
    """ "Soil moisture, tree 88" and "tree 30 first, nitrate": what, and where, with no verb and no preposition."""
    comma = next((k for k, t in enumerate(terms) if t.kind in ("COMMA", "DASH")), 0)
    before, after = terms[:comma], terms[comma + 1 :]
    ends = next((k for k, t in enumerate(after) if t.kind in _CLAUSE_ENDS), len(after))
    clause = after[:ends]
    if not before or not clause or any(t.kind in _SAID_FULLY for t in (*before, *clause)):
        return terms
    what = [any(t.kind in ("NOUN", "READING") for t in part) for part in (before, clause)]
    where = [any(t.kind in PLACES for t in part) for part in (before, clause)]
    if what == [True, False] and where == [False, True]:
        return [*before, replace(terms[comma], kind="AT"), *after]
    if what == [False, True] and where == [True, True] and terms[comma].text == ":" and before[0].kind in _OPENS:
        # "The middle of the east edge: a picture of two adjacent trees": what stands before the colon is gone to.
        return [replace(before[0], kind="AT", text="", end=before[0].start), *terms]
    if what == [False, True] and where == [True, False]:
        # "First the westernmost tree, ...", "tree 30 first, ...": the word says when, not which.
        place = [t for t in before if t.kind != "THEN" and not _first_of_all(t, before)]
        if place and place[0].kind not in RELATIONS:
            when = [replace(t, kind="THEN") for t in before if t not in place]
            at = replace(place[0], kind="AT", text="", end=place[0].start)
            return [*when, at, *place, *terms[comma:]]
    return terms


def _first_of_all(term: Term, among: list[Term]) -> bool:
    """Whether "first" stands at either end of what it is said of."""
    return term.kind == "ORD" and term.value == 1 and term in (among[0], among[-1])


def _with_heads(terms: list[Term]) -> list[Term]:
    """ "The north-east, then the south-west corner": a compass word alone borrows the noun of the next."""
    found: list[Term] = []
    headed: Term | None = None  # "one" in "the north-east one", for which its noun stands
    for index, term in enumerate(terms):
        if term is headed:
            continue
        ahead_kinds = [*(t.kind for t in terms[index + 1 : index + 3]), "", ""]
        apart = term.kind == "THERE" and term.text.lower() in ("from it", "of it") and index
        if apart and terms[index - 1].kind in ("FARTHEST", "NEAREST", "FAR"):
            cut = term.start + len(term.text.split()[0])
            found += [replace(term, kind="FROM", end=cut), replace(term, kind="IT", text="it", start=cut)]
            continue
        if (
            term.kind == "THERE"
            and term.text.lower() == "at the tree"
            and ahead_kinds[0] in ("FARTHEST", "NEAREST", "FAR")
        ):
            cut = term.end - len("tree")
            found.append(replace(term, kind="AT", text="at the", end=cut))
            found.append(replace(term, kind="TREE", text="tree", start=cut, value=None))
            continue
        described = ahead_kinds[0] in ("FARTHEST", "FAR", "NEARBY") and ahead_kinds[1] not in _NAMED
        if term.kind == "COMMA" and described and index and terms[index - 1].kind in ("TREE", "PLACE"):
            found.append(replace(term, kind="WHICH"))  # "another tree, as far away as possible"
            continue
        closes = index and terms[index - 1].kind in ("FARTHEST", "FAR", "NEARBY") and ahead_kinds[0] == "FOR"
        if term.kind == "COMMA" and closes and any(t.kind == "WHICH" for t in found[-3:]):
            found.append(replace(term, kind="WHICH"))  # "test another tree, as far off as you can get, for moisture"
            continue
        found.append(term)
        after = terms[index + 1].kind if index + 1 < len(terms) else ""
        if term.kind == "NOUN" and term.text.lower() in _FOLIAGE and index and terms[index - 1].kind == "ATTRVAL":
            found[-1] = replace(
                term, kind="ATTR", value=tuple(name for name, _ in terms[index - 1].value), plural=False
            )
        listed = after in ("AND", "COMMA") and any(t.kind in ("TREE", "ATTRVAL") for t in terms[index + 1 : index + 4])
        if term.kind == "ATTRVAL" and term.plural and after not in _NEEDS_HEAD | {"ATTR", "ATTRVAL"} and not listed:
            found.append(replace(term, kind="TREE", text="", start=term.end, value=None))  # "6 Carmels"
        if term.kind in ("ORD", "LAST") and after in ("AND", "COMMA") and _ranks_go_on(terms[index + 1 :]):
            found.append(
                replace(term, kind="TREE", text="", start=term.end, value=None)
            )  # "the first and the last tree"
        one = after == "PLACE" and terms[index + 1].text.lower() == "one"
        if term.kind != "DIR" or (after in _NEEDS_HEAD and not one):
            continue
        heads = [t for t in terms if t.kind in ("CORNER", "HALF", "QUARTER", "SIDE", "EDGE")]
        if one:
            heads = [t for t in heads if t.start < term.start]
        ahead = next((t for t in heads if t.start > term.start), heads[-1] if heads else None)
        if ahead is not None:
            headed = terms[index + 1] if one else None
            at = term if headed is None else headed
            found.append(replace(ahead, text="", start=term.end, end=at.end, plural=False))
    return found
