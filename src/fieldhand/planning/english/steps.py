"""What a request of several steps comes to where its sentences do not fit the grammar: each clause said plainly."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from fieldhand.planning.english.clause import Clause, at, leaves_out, read_clause, word
from fieldhand.planning.english.clauses import clauses_of
from fieldhand.planning.english.tokens import Term

#: How far away a tree is.
_AFAR = frozenset({"FARTHEST", "FAR"})
_OTHERS = frozenset({"ANOTHER", "OTHER", "DET", "TREE", "NUM", "OF", "ONE", "PLACE", "GLUE"})


def steps(terms: Sequence[Term], glue: frozenset[str]) -> list[Term] | None:
    """The same said in plain sentences; None if a clause is none of these steps.

    Args:
        terms: The terms of the whole request.
        glue: Words that are not known and change nothing.
    """
    sentences: list[list[Clause]] = []
    for sentence in clauses_of(terms, glue):
        clauses = [read_clause(clause) for clause in sentence]
        if any(
            before is not None and before.kind == "repeat" and _details(after) for before, after in pairwise(clauses)
        ):
            return None
        if any(clause is None or leaves_out(clause) for clause in clauses):
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


def _is_told_in_order(sentences: Sequence[Sequence[Clause]]) -> bool:
    """Leave out what is said twice: a tree "there" behind its place, what was done. False if a repetition differs."""
    before: Clause | None = None
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
            clause.said = [t for t in clause.said if not any(t is p for p in (*clause.place, *at(clause.place)))]
            clause.said = [t for t in clause.said if not (t.kind == "AT" and t.start == t.end)]
        elif before is not None and before.kind == clause.kind == "go" and _is_bare(before.place):
            before.kind = ""
        before = clause
    return True


def _says_other(clause: Clause, before: Clause) -> bool:
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


def _details(clause: Clause | None) -> bool:
    """ "..., with its two pictures", "including the picture": what is repeated, said again."""
    first = clause.terms[0] if clause is not None else None
    return first is not None and (first.kind == "WITH" or first.text.lower().split()[:1] in (["with"], ["including"]))


def _is_bare(place: Sequence[Term]) -> bool:
    """ "A tree", "that tree": the one that the robot has come to."""
    return bool(place) and {t.kind for t in place} <= {"TREE", "DET", "ANY", "OF"} and not any(t.plural for t in place)


def _said(clauses: Sequence[Clause]) -> list[Term]:
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
            made.append(word("STOPMARK", clause.said[0], "."))
        elif k:
            made.append(word("COMMA", clause.said[0], ","))
        made += clause.said
    return [*made, word("STOPMARK", end, ".")]


def _names_another(clause: Clause) -> bool:
    return any(t.kind in ("ANOTHER", "OTHER", "FARTHEST", "MOST") for t in clause.said)
