"""Words for rows, positions along them and steps from row to row, as one term each.

What they become: ``ROWIDS`` and ``BLOCKIDS`` (rows and blocks by number or name), ``EVERYNTH`` ("every third") and
``STARTNTH`` ("starting with the second"), ``BACKORD`` ("the second to last"), ``COUNTEDFROM`` ("from the east"),
``STEP`` ("5 trees down"), ``OVER`` ("two rows further east", "the next row"), ``OPPOSITE`` ("across the aisle").
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from fieldhand.language import message
from fieldhand.planning.english.faults import Question, text_of, unclear
from fieldhand.planning.english.rewriting import Rule, merged, rewritten, silent
from fieldhand.planning.english.tokens import Term
from fieldhand.planning.english.wordclass import COUNTED
from fieldhand.terms import CountedFrom, Towards

_AISLE_ADVICE = message("the robot drives in the aisles by itself: name the rows, or the trees")
#: Not a side by itself before one of these ("5 trees to the south | corner").
_NO_HEAD = r"(?!<(?:TREE|CORNER|EDGE|HALF|QUARTER|SIDE|FINISH|PLOT|MIDDLE|DIR|MOST|ROW|ZONE)[.>])"
_SIDE = r"<DIR\.(?:north|east|south|west)>"
_WAY = rf"(?:<MORE>|<WAY>)?(?:<AT\.to><DET>)?{_SIDE}{_NO_HEAD}"
#: "Down the row" with nothing said of which row, or "down" alone.
_DOWN = (
    r"(?:<MORE>|<WAY>)?<ALONG>(?:(?:<DET>|<SAME>)+<ROW>(?!<OF>)|(?!<DET>|<ROW|<SAME>|<EACH|<ANY>|<NUM|<OVER>|<IDS>))"
)
_FURTHER = r"(?:<WAY>(?:(?:<ALONG>)?(?:<DET>|<SAME>)+<ROW>)?|<MORE>)(?!<TREE>|<ROW)"
_IN_ROW = r"(?:<ALONG>(?:<DET>|<SAME>)*<ROW>(?!<OF>))?"
_HEAD = r"(?:<TREE>|<ROW>)"


@dataclass(frozen=True, kw_only=True)
class Steps:
    """So many trees along the row; ``bare`` if no word says that one tree is meant ("5 trees down")."""

    trees: int
    towards: Towards = "down"
    bare: bool = False


@dataclass(frozen=True, kw_only=True)
class Over:
    """So many rows from the row in hand, towards a side or by their numbers."""

    rows: int
    side: str = ""


@dataclass(frozen=True, kw_only=True)
class From:
    """Which end is counted from: a side, or the ``usual`` one; ``far`` from the other end."""

    side: CountedFrom = "usual"
    far: bool = False


def with_row_ids(terms: list[Term]) -> list[Term]:
    """ "Row 3", "rows 2, 4 and 7", "rows 2 to 5" and "block B" as the ranges that they name."""
    found: list[Term] = []
    at = 0
    while at < len(terms):
        term = terms[at]
        block = term.kind == "PLOT" and term.text.lower() in ("block", "blocks")
        ranges, end = _ranges(terms, at + 1, term) if term.kind == "ROW" or block else ((), at)
        if not ranges:
            after = terms[at + 1] if at + 1 < len(terms) else None
            if (block or term.kind == "ROW") and after is not None and after.kind == "UNIT" and len(after.text) == 1:
                raise unclear(
                    [term, after], message("nothing on this site has that name")
                )  # "block C": no degrees are meant
            found.append(term)
            at += 1
            continue
        kind = "BLOCKIDS" if block else "ROWIDS"
        several = len(ranges) > 1 or ranges[0][0] != ranges[0][1]
        found.append(merged(terms[at:end], kind, ranges, plural=several))
        at = end
    return found


def _ranges(terms: list[Term], at: int, head: Term) -> tuple[tuple[tuple[str, str], ...], int]:
    """Numbers and names, single or as ranges, and where they end."""
    found: list[tuple[str, str]] = []
    end = at
    while True:
        start = end
        while start < len(terms) and (
            terms[start].kind == "NUMBERED" or (found and terms[start].kind in ("COMMA", "AND", head.kind))
        ):
            start += 1
        named = _name(terms, start)
        if not named:
            break
        first, after = named, start + 1
        through = terms[after : after + 1]
        last = ""
        if through and (through[0].kind == "DASH" or through[0].text.lower() in ("to", "through", "up to")):
            last = _name(terms, after + 1)
            after += 2 if last else 0
        if found and after < len(terms) and terms[after].kind in COUNTED:
            break  # "row 2 and 3 | trees"
        found.append((first, last or first))
        end = after
    return tuple(dict.fromkeys(found)), end


def _name(terms: list[Term], at: int) -> str:
    if at >= len(terms):
        return ""
    term = terms[at]
    if term.kind == "NAMED":
        return str(term.value[0])
    if term.kind == "NUM" and term.value == int(term.value):
        return str(int(term.value))
    return ""


def with_row_words(terms: list[Term]) -> list[Term]:
    """Everything else that is said of rows.

    Raises:
        Unclear: An aisle is named as a place.
    """
    terms = _starts(rewritten(terms, _RULES))
    aisles = [t for t in terms if t.kind == "AISLE"]
    if aisles:
        raise unclear(aisles, message("an aisle is not a place where something can be done"), _AISLE_ADVICE)
    return _with_relations(terms)


def _every(group: list[Term], _before: Term | None) -> list[Term] | None:
    """ "Every third", "every other", "alternate", "every 3 | trees"."""
    last = group[-1]
    if group[0].kind == "EACH" and group[0].text.lower().startswith("all"):
        return None  # "all the other trees" are those that are left
    nth = 2 if last.kind in ("OTHER", "ALTERNATE") else int(last.value)
    return [merged(group, "EVERYNTH", nth)] if nth >= 2 else None


def _even_or_odd(group: list[Term], _before: Term | None) -> list[Term] | None:
    """ "The even rows", "all odd-numbered rows"; "even" alone is another word elsewhere."""
    word = group[-1].text.lower()
    if not word.startswith(("even", "odd")):
        return None
    every = merged(group, "EVERYNTH", 2)
    return [every, replace(silent("STARTNTH", every.end), value=("parity", "2" if word.startswith("even") else "1"))]


def _from_behind(group: list[Term], _before: Term | None) -> list[Term]:
    """ "Second to last", "next to last", "last but one"."""
    rank = next((int(t.value) for t in group if t.kind == "ORD"), 2)
    return [merged(group, "BACKORD", rank)]


def _step(group: list[Term], before: Term | None) -> list[Term]:
    """ "5 trees down", "three trees up the row", "5 trees to the south", "the third tree along"."""
    head = group[0]
    words = " ".join(t.text.lower() for t in group[2:])
    side = next((t.value for t in group if t.kind == "DIR"), "")
    towards: Towards = side or ("up" if "up" in words.split() else "down")  # type: ignore[assignment]
    one = before is not None and (before.kind in ("TREE", "PLACE", "DET", "ANOTHER", "OTHER") or before.kind == "ORD")
    bare = head.kind == "NUM" and not one
    return [merged(group, "STEP", Steps(trees=int(head.value), towards=towards, bare=bare))]


def _over(group: list[Term], _before: Term | None) -> list[Term]:
    """ "Two rows over", "the next row", "the row to the east"."""
    rows = next((int(t.value) for t in group if t.kind == "NUM"), 1)
    side = next((t.value for t in group if t.kind == "DIR"), "")
    return [merged(group, "OVER", Over(rows=-rows if group[0].kind == "PREVIOUS" else rows, side=side))]


def _counted_from(group: list[Term], _before: Term | None) -> list[Term]:
    head = next(k for k, t in enumerate(group) if t.kind in ("TREE", "ROW", "IDS"))
    behind = next(k for k, t in enumerate(group) if t.kind == "FROM")
    row = [t for t in group[head + 1 : behind] if t.kind != "COMMA"]
    rest = [t for t in group[head + 1 :] if t.kind == "COMMA"] + group[behind:]
    side: CountedFrom = next((t.value for t in rest if t.kind == "DIR"), "usual")
    far = side == "usual" and any(t.kind == "FINISH" for t in rest)
    return [*group[: head + 1], merged(rest, "COUNTEDFROM", From(side=side, far=far)), *row]


def _opposite(group: list[Term], _before: Term | None) -> list[Term]:
    side = next((t.value for t in group if t.kind == "DIR"), "usual")
    return [merged(group, "OPPOSITE", side)]


def _opposite_to(group: list[Term], _before: Term | None) -> list[Term]:
    """ "The tree opposite | tree 12": the place that it is opposite to."""
    return [group[0], silent("FROM", group[0].end), *group[1:]]


def _same_as(group: list[Term], _before: Term | None) -> list[Term]:
    return [group[0], replace(group[1], kind="OF")]


def _pointing(group: list[Term], _before: Term | None) -> list[Term] | None:
    """ "In that row"."""
    return [replace(group[0], kind="DET"), group[1]] if group[0].text.lower() == "that" else None


def _tree_of_row(group: list[Term], _before: Term | None) -> list[Term]:
    """ "Row 3 tree 5"; with a comma it could be a list."""
    row, *_, tree = group
    if len(group) > 2:
        said = text_of(group)
        raise Question(
            message("'{said}': {tree} of {row}, or both?", context="question", said=said, tree=tree.text, row=row.text),
            (
                message("{tree} of {row}", context="answer", tree=tree.text, row=row.text),
                message("both", context="answer"),
            ),
            terms=group,
            words=(f"{tree.text} of {row.text}", f"{tree.text} and {row.text}"),
        )
    return [tree, silent("OF", tree.end), row]


def _next_few(group: list[Term], _before: Term | None) -> list[Term]:
    """ "The next 3 trees" as "the 3 next trees"."""
    return [group[1], replace(group[0], kind="NEARBY"), group[2]]


_RULES: tuple[Rule, ...] = (
    (re.compile(r"<ROWIDS>(?:<COMMA>)?<IDS>(?!<OF>|<AT[.>])"), _tree_of_row),
    (re.compile(r"<WHICH><ROW>"), _pointing),
    (re.compile(r"<THEN\.next><NUM\.\w+><TREE>"), _next_few),
    (re.compile(r"<EACH\.(?:every|each)><ORD\.\d+>|<EACH\.(?:every|all_the)><OTHER\.other>"), _every),
    (re.compile(r"(?:<EACH\.\w+>|<DET>)*(?:<STILL>|<PARITY>)(?=<ROW>)"), _even_or_odd),
    (re.compile(r"(?:<EACH\.(?:every|each)>)?<ALTERNATE>|<EACH\.(?:every|each)><NUM\.\w+>(?=<TREE>|<ROW>)"), _every),
    (re.compile(r"<ORD\.\d+>(?:<AT\.to>)?<LAST>|<NEXTTO><LAST>|<LAST><AND\.but><NUM\.one>|<PENULT>"), _from_behind),
    (re.compile(r"<ROW><AS>"), _same_as),
    (re.compile(rf"(?:<NUM\.\w+>|<ORD\.\d+>)<TREE>(?:{_DOWN}|{_WAY}{_IN_ROW}|{_FURTHER})"), _step),
    (re.compile(rf"<NUM\.\w+><ROWSOVER>(?:(?:<AT\.to><DET>)?{_SIDE}(?:<SIDE>)?)?"), _over),
    (re.compile(rf"<NUM\.\w+><ROW>(?:{_WAY}|<MORE>|<WAY>)"), _over),
    (re.compile(rf"(?:<THEN\.next><ROW>|<PREVIOUS>)(?:(?:<AT\.to>|<AT\.on>)<DET>{_SIDE}(?:<SIDE>)?)?"), _over),
    (re.compile(rf"<ROW>(?:<AT\.to>|<AT\.on>)<DET>{_SIDE}(?:<SIDE>)?(?!<OF>|<TREE>|<CORNER>)"), _over),
    (
        re.compile(
            rf"(?:(?:<ORD\.\d+>|<LAST>|<EVERYNTH>|<BACKORD>)(?:<NUM\.\w+>|<ATTRVAL>)*{_HEAD}|<IDS>)(?:(?:<OF>|<AT\.in>|<ALONG>)<ROWIDS>)?(?:<COMMA>)?<FROM>(?:<DET>)?"
            rf"(?:{_SIDE}(?:<SIDE>|<EDGE>|<FINISH\.\w+>)?{_NO_HEAD}|<FINISH\.end>|<START>)"
        ),
        _counted_from,
    ),
    (re.compile(rf"<OPPOSITE>(?:<AT\.to>|<AT\.on>)<DET>{_SIDE}(?:<SIDE>)?{_NO_HEAD}|<OPPOSITE>"), _opposite),
    (re.compile(r"<OPPOSITE>(?:<DET>|<IDS>|<IT>|<MOST\.\w+>)"), _opposite_to),
)
_STARTING = re.compile(
    r"(?:<COMMA>)?<GO\.(?:starting|beginning|start|begin)>(?:(?:<WITH>|<AT\.\w+>|<FROM>)(?:<DET>)?|<WHICH>)"
    r"(?:<ROWIDS>|<ORD\.\d+>(?:<TREE>|<ROW>|<PLACE\.one>|<NUM\.one>)?)(?:<COMMA>)?(?!<NOUN>|<TREE>|<NUM)"
)


def _starts(terms: list[Term]) -> list[Term]:
    """ "Every third row, starting with row 2": where the count begins stands beside the count."""
    every = [t for t in terms if t.kind == "EVERYNTH"]
    if len(every) != 1 or any(t.kind == "STARTNTH" for t in terms):
        return terms
    moved: list[Term] = []

    def take_out(group: list[Term], before: Term | None) -> list[Term] | None:
        if moved or before is None or before.start < every[0].start:
            return None
        said = next(t for t in group if t.kind in ("ROWIDS", "ORD"))
        if said.kind == "ROWIDS" and said.plural:
            raise unclear(group, message("it can begin with one row only"))
        kind = "row" if said.kind == "ROWIDS" or any(t.kind == "ROW" for t in group) else ""
        kind = "tree" if any(t.kind == "TREE" for t in group) else kind
        start = said.value[0][0] if said.kind == "ROWIDS" else str(said.value)
        moved.append(merged(group, "STARTNTH", (kind, start)))
        return []

    terms = rewritten(terms, ((_STARTING, take_out),))
    if not moved:
        return terms
    at = next(k for k, t in enumerate(terms) if t.kind == "EVERYNTH")
    return [*terms[: at + 1], moved[0], *terms[at + 1 :]]


def _with_relations(terms: list[Term]) -> list[Term]:
    """ "Take a picture | 5 trees down": a step behind what is taken says where."""
    found: list[Term] = []
    for term in terms:
        place = term.kind in ("STEP", "OVER", "OPPOSITE", "EVERYNTH")
        if place and found and found[-1].kind in ("NOUN", "READING", "COUNT", "REPEAT"):
            found.append(silent("AT", term.start))
        found.append(term)
    return found
