"""What a request of one scene comes to, whatever the order of its words: one capture, at trees that few words describe.

People say "ten trees, the best by reward, a picture of each" in more ways than a grammar has. Where all that a request
says belongs to one of a few kinds of mission, it is that mission: nothing may be left over that could change it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from fieldhand.planning.english.limits import Amount, LimitPhrase, with_amounts
from fieldhand.planning.english.naming import Naming
from fieldhand.planning.english.rewriting import silent
from fieldhand.planning.english.spacing import Stops
from fieldhand.planning.english.tokens import Term

#: Words that may stand anywhere in such a request and change nothing.
_NOISE = frozenset(
    {"DET", "OF", "AT", "WHICH", "IS", "IT", "THERE", "PLACE", "PLOT", "TREE", "GO", "VISIT", "TAKE", "MEASURE", "FOR"}
    | {"WITH", "FROM", "AND", "COMMA", "STOPMARK", "THEN", "FILLER", "READING", "ALONG", "NOORDER", "DASH", "INSIDE"}
    | {"EACHTAIL", "NOUN", "ACTV", "GLUE", "DISTINCT", "BY", "STILL", "ONLY", "AS", "PURPOSE", "USE", "ONE"}
)
#: Words of other kinds that change nothing either.
_EMPTY = frozenset(
    {"by", "around", "should", "stop", "stops", "stopping", "in total", "total", "altogether", "in all", "as if"}
)
_AREAS = frozenset({"HALF", "QUARTER", "SIDE"})
_SPACED = frozenset({"APART", "INTERVAL", "SPACEDBY"})
_MOST = frozenset({"ASMANY", "ASCAN"})


@dataclass
class _RequestScene:
    """The words of a request by what they are."""

    terms: Sequence[Term]
    noun: Term
    kinds: frozenset[str] = frozenset()
    numbers: list[Term] = field(default_factory=list)

    def one(self, kind: str) -> Term | None:
        """The only word of a kind, said once or more; None if there is none, or several that differ."""
        found = self.all(kind)
        return found[0] if found and all(t.value == found[0].value for t in found) else None

    def all(self, *kinds: str) -> list[Term]:
        return [t for t in self.terms if t.kind in kinds]

    def only(self, *kinds: str) -> bool:
        """Whether nothing is said but words of these kinds."""
        return self.kinds - _NOISE <= set(kinds)


#: Words besides that each kind of request may hold.
_OF_THE_BEST = ("SUPER", "ATTR", "NUM", "DIR", "EACH", "WHERE", "OTHER", *_AREAS)
_OF_A_ROW = ("ROW", "CONSECUTIVE", "NUM", "EACH", "ANY", "SAME", "ADJACENT", "LIMIT", "OTHER")
_OF_A_BUDGET = (
    *("AMOUNT", "EACH", "SUPER", "MORE", "UNIT", "NUMBERED", "KEEP", "UNTIL", "OTHER", "CMP", "UPTO", "WITHOUT", "NOT"),
    *("LIMIT", "MEANS", "BEFORE", "ALLOW", "TIMES", "IF", "WHERE", "OR", *_MOST),
)
_OF_STOPS = (
    *("AMOUNT", "NUM", "COUNT", "EACH", "BETWEEN", "CONSECUTIVE", "NEARBY", "ANOTHER", "WHERE", "LIMIT", *_SPACED),
)
_OF_A_WAY = ("CORNER", "DIR", "NUM", "EACH", "INORDER", "ORD", "LAST", "ANOTHER", "MORE", "REPEAT", "RETURN")
_OF_AREAS = ("ATTRVAL", "ATTR", "NUM", "DIR", "EACH", "ANY", "WHERE", *_AREAS)
_OF_CORNERS = ("CORNER", "NUM", "EACH", "ANY", "INORDER", "ORD", "NUMBERED", "WHERE", "LIMIT")


def gist(terms: Sequence[Term], glue: frozenset[str]) -> list[Term] | None:
    """The same said in the order of the grammar; None if it is no such request.

    Args:
        terms: The terms of the whole request.
        glue: Words that are not known and change nothing.
    """
    known = [replace(t, kind="GLUE") if is_empty(t, glue) else t for t in terms]
    flat = [replace(t, kind="ONE") if t.kind == "NUM" and t.value == 1 else t for t in with_amounts(known)]
    nouns = [t for t in flat if t.kind in ("NOUN", "ACTV") and isinstance(t.value, Naming) and t.value.actions]
    if not nouns or len({t.value.actions[0] for t in nouns}) != 1:
        return None
    if any(a.kind == "EACH" and b.kind in ("OTHER", "ORD") for a, b in pairwise(flat)):
        return None  # "every other corner"
    if any(t.kind == "PLOT" and t.plural for t in flat):
        return None  # "the corners of both blocks"
    noun = next((t for t in nouns if t.kind == "NOUN"), nouns[0])
    numbers = [t for t, after in pairwise([*flat, flat[-1]]) if t.kind == "NUM" and after.kind not in _AREAS]
    scene = _RequestScene(terms=flat, noun=noun, kinds=frozenset(t.kind for t in flat), numbers=numbers)
    for reading in _READINGS:
        made = reading(scene)
        if made is not None:
            return made
    return None


def is_empty(term: Term, glue: frozenset[str]) -> bool:
    """Whether a word changes nothing wherever it stands."""
    return term.text.lower() in (glue if term.kind == "UNKNOWN" else _EMPTY)


def _distinct(numbers: Sequence[Term]) -> list[Term]:
    """Numbers, each once, in the order of the text."""
    return list({t.value: t for t in reversed(numbers)}.values())[::-1]


def _take(scene: _RequestScene, *rest: Term) -> list[Term]:
    """ "Take a picture", and what follows."""
    noun = scene.noun
    verb = silent("TAKE", noun.start)
    return [noun, *rest] if noun.kind == "ACTV" else [verb, noun, *rest]


def _word(kind: str, near: Term, text: str = "", *, plural: bool = False) -> Term:
    """A word that the request does not say."""
    return Term(kind=kind, text=text, start=near.start, end=near.start, value=kind, plural=plural)


def _trees(near: Term) -> Term:
    return _word("TREE", near, plural=True)


def _at(scene: _RequestScene) -> list[Term]:
    return [] if scene.noun.kind == "ACTV" else [_word("AT", scene.noun, "at")]


def _area(scene: _RequestScene) -> list[Term] | None:
    """ "In the northern half"; nothing if no area is said, None if several are."""
    said, sides = scene.all(*_AREAS), scene.all("DIR")
    if not said and not sides:
        return []
    side = scene.one("DIR")
    if side is None or len({t.kind for t in said}) > 1 or not (said or scene.all("PLOT")):
        return None
    part = replace(said[0], plural=False) if said else _word("SIDE", side, "side")
    return [_word("AT", side, "in"), _word("DET", side, "the"), side, part]


def _best(scene: _RequestScene) -> list[Term] | None:
    """ "The 10 trees with the highest reward"."""
    best, attribute, count = scene.one("SUPER"), scene.one("ATTR"), _distinct(scene.numbers)
    area = _area(scene)
    if best is None or len(count) != 1 or area is None or not scene.only(*_OF_THE_BEST):
        return None
    if not any(t.kind == "TREE" and t.plural for t in scene.terms):
        return None  # "two pictures of the tree with the highest yield"
    if attribute is None and not best.value[0]:
        return None
    which = _word("WHICH", best, "with the")
    ranked = [which, best] if attribute is None or best.value[0] else [which, best, attribute]
    return _take(scene, *_at(scene), _word("DET", count[0], "the"), count[0], _trees(count[0]), *ranked, *area)


def _some_of_a_row(scene: _RequestScene) -> list[Term] | None:
    """ "3 trees of a row of 5"."""
    counts = sorted(_distinct(scene.numbers), key=lambda t: float(t.value))
    row = next(iter(scene.all("ROW", "CONSECUTIVE")), None)
    if row is None or len(counts) != 2 or not scene.only(*_OF_A_ROW):
        return None
    if any(t.plural for t in scene.all("ROW")) or any(t.text.lower() in ("each", "every") for t in scene.all("EACH")):
        return None
    few, many = counts
    along = [_word("GO", row, "drive"), _word("ALONG", row, "along"), _word("DET", row, "a"), replace(row, kind="ROW")]
    trees = [_word("OF", many, "of"), many, _trees(many), _word("AND", many, "and")]
    return [*along, *trees, *_take(scene, *_at(scene), few, _word("THERE", few, "of them"))]


def _corners(scene: _RequestScene) -> list[Term] | None:
    """ "The four corner trees, in any order"."""
    counts = _distinct(scene.numbers)
    corner = next(iter(scene.all("CORNER")), None)
    if corner is None or scene.all("DIR") or not scene.only(*_OF_CORNERS) or len(counts) > 1:
        return None
    if counts and counts[0].value != 4:
        return None
    if not counts and not (corner.plural or scene.all("EACH")):
        return None
    each = _word("EACH", corner, "each")
    return _take(scene, *_at(scene), each, replace(corner, plural=False))


def _as_many_as_fit(scene: _RequestScene) -> list[Term] | None:
    """ "As many trees as possible within 100 m"."""
    amount = scene.one("AMOUNT")
    if amount is None or scene.numbers or not isinstance(amount.value, Amount):
        return None
    unit = amount.value.unit
    tests = {t.value[0] for t in scene.all("CMP")}
    many = scene.all(*_MOST) or [t for t in scene.all("SUPER") if not t.value[1] and not t.value[0]]
    if unit not in ("metres", "seconds") or not many or scene.all("ATTR") or tests & {"ge", "eq"}:
        return None
    if not scene.only(*_OF_A_BUDGET) or not any(t.kind == "TREE" for t in scene.terms):
        return None
    limit = LimitPhrase(unit=unit, amount=amount.value.number, said=amount.span)
    budget = Term(kind="BUDGET", text=amount.text, start=amount.start, end=amount.end, value=limit)
    first = many[0]
    wanted = [_word("ASMANY", first, "as many"), _trees(first), _word("ASCAN", first, "as you can")]
    return _take(scene, *_at(scene), *wanted, _word("COMMA", amount, ","), budget)


def _apart(scene: _RequestScene) -> list[Term] | None:
    """ "Three readings, 15 m apart"."""
    amount, counts = scene.one("AMOUNT"), _distinct(scene.numbers)
    times = scene.one("COUNT")
    if amount is None or not isinstance(amount.value, Amount) or amount.value.unit != "metres":
        return None
    if len(counts) + (times is not None) != 1 or not scene.only(*_OF_STOPS) or scene.all("INSIDE", "ALONG", "WITH"):
        return None
    count = counts[0] if times is None else replace(times, kind="NUM", value=float(times.value))
    if any(t.kind == "TREE" for t in scene.terms) or scene.noun.kind == "ACTV":
        return None  # trees at a distance are trees, not points
    stops = Stops(apart_m=amount.value.number, every=False, least=False)
    spacing = Term(kind="EVERYM", text=amount.text, start=amount.start, end=amount.end, value=stops)
    return [silent("TAKE", scene.noun.start), count, scene.noun, spacing]


def _in_an_area(scene: _RequestScene) -> list[Term] | None:
    """ "The yellow trees of the northern half", "four trees on the east side"."""
    area, kind, counts = _area(scene), scene.one("ATTRVAL"), _distinct(scene.numbers)
    if not area or len(counts) > 1 or not scene.only(*_OF_AREAS) or not any(t.kind == "TREE" for t in scene.terms):
        return None
    if scene.all("ATTRVAL") and kind is None:
        return None
    every = [t for t in scene.all("EACH") if not t.text.lower().startswith("both")]
    if not counts and kind is None and not every:
        return None
    how_many = counts[0] if counts else _word("EACH", scene.noun, "every")
    described = [] if kind is None else [replace(kind, plural=False)]
    return _take(scene, *_at(scene), how_many, *described, _trees(how_many), *area)


def _one_after_another(scene: _RequestScene) -> list[Term] | None:
    """ "A picture at the north-west, then the north-east corner ..."."""
    sides = scene.all("DIR")
    ways = [t for t in sides if len(str(t.value)) == 2]
    if len(ways) < 2 or len(ways) != len(sides) or len({t.value for t in ways}) != len(ways):
        return None
    counts = _distinct(scene.numbers)
    if not scene.all("CORNER") or not scene.only(*_OF_A_WAY) or not _at_each(scene, ways):
        return None
    if "NOORDER" in scene.kinds or (counts and [t.value for t in counts] not in ([len(ways)], _to(len(ways)))):
        return None
    ranks = [t.value for t in scene.all("ORD")]
    if ranks != sorted(ranks):
        return None
    made: list[Term] = []
    for side in ways:
        corner = [_word("DET", side, "the"), side, _word("CORNER", side, "corner")]
        made += [*_take(scene, *_at(scene), *corner), _word("STOPMARK", side, ".")]
    return made


def _at_each(scene: _RequestScene, ways: Sequence[Term]) -> bool:
    """Whether the capture is asked for at each place, not only at the first or the last one."""
    if scene.all("EACH") or any(t.plural for t in scene.all("CORNER")):
        return True
    if len(scene.all("NOUN", "ACTV", "ANOTHER", "MORE", "REPEAT")) >= len(ways):
        return True
    moves = [t for t in scene.all("GO", "VISIT", "RETURN") if t.start > ways[0].start and not _ends_series(t)]
    return scene.noun.start < ways[0].start and not moves


def _ends_series(term: Term) -> bool:
    """Whether "finish at the last corner" is said of what is taken rather than of the way home."""
    return term.kind == "RETURN" and term.text.lower().startswith(("finish", "end"))


def _to(number: int) -> list[float]:
    """The numbers from 2 on: of "stop one ... stop two ...", the first is no number of things."""
    return [float(k) for k in range(2, number + 1)]


_READINGS: tuple[Callable[[_RequestScene], list[Term] | None], ...] = (
    _best,
    _some_of_a_row,
    _corners,
    _as_many_as_fit,
    _apart,
    _in_an_area,
    _one_after_another,
)


def said_in_order(terms: Sequence[Term]) -> str:
    """Terms in their own order as a sentence, for people."""
    words = [t.text or t.kind.lower() for t in terms]
    return re.sub(r" +([,.])", r"\1", " ".join(words)).rstrip(". ")
