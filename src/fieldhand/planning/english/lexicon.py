"""From words to terms: the shared vocabulary together with what this robot and this site are called in words."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache, cached_property
from typing import Any

from fieldhand.planning.english.inflection import forms_of, plural_of
from fieldhand.planning.english.kinds import CONTINUES, RELATIONS, TESTS
from fieldhand.planning.english.naming import Entry, Phrase, robot_entries, site_entries, split
from fieldhand.planning.english.tokens import Term, Word
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Words of the shared vocabulary that a robot's own word may replace; no function word is among them.
_REPLACEABLE = frozenset({"READING", "FILLER", "TREE", "PLACE", "EDGE", "SIDE"})
#: Orders by the compass, as the lexicon of orders calls them.
_WAYS = (("west", "east"), ("east", "west"), ("north", "south"), ("south", "north"))
_SINGLE = {"stop": "STOPMARK", "comma": "COMMA", "dash": "DASH", "sign": "AND", "hash": "NUMBERED", "silent": "FILLER"}
#: Behind "starting in the north", these go on with a place: it is no order then.
_NO_ORDER = frozenset(
    {"DIR", "MOST", "CORNER", "TREE", "IDS", "QUARTER", "HALF", "MIDDLE", "OF", "EDGE", "ROW", "SIDE", "FINISH", "ZONE"}
)
#: What a word that names a block may be besides: never an article or another word of the grammar ("a block").
_MAY_NAME = frozenset({"UNKNOWN", "ATTRVAL", "ATTR", "START", "FINISH", "DIR", "ZONE", "IDS", "NAMED", "MIDDLE"})
#: A shorter word is no word that another may be a misspelling of.
_SPELLABLE = 6
_TENS = ("twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety")
_UNITS = ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine")


@dataclass(frozen=True)
class Lexicon:
    """Phrases and what they are; the longest one that fits is taken.

    Attributes:
        own: Phrases of this robot and this site, which come before the shared ones.
        trees: Ids of trees that are not plain numbers, as the lexicon knows words.
        site: Whose rows and blocks may have names; they are looked for only where a row or a block is spoken of.
    """

    own: Mapping[Phrase, Entry]
    trees: Mapping[str, str]
    site: Site

    @cached_property
    def longest(self) -> int:
        """Words of the longest phrase."""
        return max(len(p) for p in (*self.own, *_shared()))

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """Every word that stands in some phrase, names of rows, blocks and trees among them."""
        words = {word for phrase in (*self.own, *_shared()) for word in phrase}
        names = [*self.trees, *self._rows, *self._blocks]
        return frozenset({*words, *names, *(part for name in names for part in split(name))})

    @cached_property
    def spellings(self) -> tuple[str, ...]:
        """The words of some length, which a word may be a misspelling of."""
        return tuple(sorted(word for word in self.vocabulary if len(word) >= _SPELLABLE and word.isalpha()))

    def entry(self, phrase: Phrase) -> Entry | None:
        """What a phrase is; None if it is not known."""
        return self.own.get(phrase) or _shared().get(phrase)

    def terms(self, words: list[Word]) -> list[Term]:
        """The words as terms. A word that no phrase holds is of kind ``UNKNOWN``; a full stop is ``STOPMARK``."""
        found: list[Term] = []
        at = 0
        while at < len(words):
            term, used = self._name(words, at, found) or self._match(words, at) or self._single(words[at])
            if used > 1 and self._goes_on(words, at + used, term.kind):
                term, used = self._match(words, at, longest=1) or (term, used)
            found.append(term)
            at += used
        return self._with_blocks(found)

    def _with_blocks(self, terms: list[Term]) -> list[Term]:
        """ "The home block" and "the home and river blocks" as the blocks that they name."""
        found: list[Term] = []
        for k, term in enumerate(terms):
            found.append(term)
            after = terms[k + 1].kind if k + 1 < len(terms) else ""
            if term.kind != "PLOT" or term.text.lower() not in ("block", "blocks") or after in ("NAMED", "NUM"):
                continue
            names: list[str] = []
            at = begin = len(found) - 1
            while (used := self._block_before(found, at)) is not None:
                names.insert(0, used[0])
                at = begin = used[1]
                while term.plural and at > 0 and found[at - 1].kind in ("COMMA", "AND"):
                    at -= 1
                if at == begin:
                    break
            if names:
                group, found = found[begin:], found[:begin]
                text = " ".join(t.text for t in group)
                value = tuple((name, name) for name in names)
                start, plural = group[0].start, len(names) > 1
                found.append(Term(kind="BLOCKIDS", text=text, start=start, end=term.end, value=value, plural=plural))
        return found

    def _block_before(self, terms: list[Term], at: int) -> tuple[str, int] | None:
        """The block whose name stands right before a term, and where the name begins; no article is a name."""
        for length in (3, 2, 1):
            words = terms[max(at - length, 0) : at]
            name = self._blocks.get("".join(_spelt(t.text) for t in words)) if len(words) == length else None
            if name is not None and all(t.kind in _MAY_NAME for t in words):
                return name, at - length
        return None

    @cached_property
    def _rows(self) -> Mapping[str, str]:
        """Names of rows that are not plain numbers."""
        return {_spelt(row.name): row.name for row in self.site.planting.rows if not row.name.isdigit()}

    @cached_property
    def _blocks(self) -> Mapping[str, str]:
        """Names of blocks that are not plain numbers."""
        return {_spelt(block.name): block.name for block in self.site.planting.blocks if not block.name.isdigit()}

    def _names(self, before: list[Term]) -> tuple[Mapping[str, str], str]:
        """The names that may stand behind what has been said, and of which kind they are."""
        at = len(before) - 1
        while at > 0 and before[at].kind == "NUMBERED":
            at -= 1
        listed = _joins_names(before[at])
        while listed and at > 0 and (_joins_names(before[at]) or before[at].kind in ("NAMED", "NUM", "NUMBERED")):
            at -= 1
        head = before[at]
        found: Mapping[str, str] = {}
        if head.kind == "ROW":
            found = self._rows
        elif head.kind == "PLOT" and head.text.lower() in ("block", "blocks"):
            found = self._blocks
        elif not listed and (head.kind == "TREE" or before[-1].kind == "NUMBERED"):
            return self.trees, "IDS"
        elif head.kind == "IDS" and before[-1].kind in ("COMMA", "AND"):  # "trees T89 and T158"
            return {spelt: name for spelt, name in self.trees.items() if (spelt,) not in _shared()}, "IDS"
        if listed:  # "row B and a picture": a name that is a word besides stands right behind "row"
            found = {spelt: name for spelt, name in found.items() if (spelt,) not in _shared()}
        return found, "NAMED"

    def _name(self, words: list[Word], at: int, before: list[Term]) -> tuple[Term, int] | None:
        """The own name of a tree, a row or a block behind the word for it, where it is not a plain number."""
        names, kind = self._names(before) if before else ({}, "")
        if not names:
            return None
        spelt = ""
        found: tuple[Term, int] | None = None
        for used, word in enumerate(words[at : at + 5], start=1):
            if used > 1 and word.start > words[at + used - 2].end:
                break
            spelt += word.norm
            name = names.get(spelt)
            if name is not None:
                start, end = words[at].start, word.end
                said = "".join(w.text for w in words[at : at + used])
                found = Term(kind=kind, text=said, start=start, end=end, value=(name,)), used
        return found

    def _goes_on(self, words: list[Word], at: int, kind: str) -> bool:
        """Whether a phrase is only the beginning of what is said.

        "Of each" is no "there" in "of each of the four corner trees", nor "if it is not" an "otherwise" before "low".
        """
        if at >= len(words) or kind not in ("THERE", "OTHERWISE", "IFSO", "ORDERED", "DISTINCT"):
            return False
        while kind == "ORDERED" and words[at].kind == "dash" and at + 1 < len(words):
            at += 1  # "starting in the north-west corner"
        after, _ = self._match(words, at) or self._single(words[at])
        if kind == "ORDERED":
            return after.kind in _NO_ORDER
        if kind == "DISTINCT":
            return after.kind in RELATIONS - {"FOR"}
        return after.kind in (CONTINUES | {"THERE"} if kind == "THERE" else TESTS)

    def _match(self, words: list[Word], at: int, longest: int = 99) -> tuple[Term, int] | None:
        """The longest phrase that begins here."""
        if words[at].kind not in ("word", "unit", "number"):
            return None
        phrase: list[str] = []
        best: tuple[Entry, int] | None = None
        for used, word in enumerate(words[at:], start=1):
            if word.kind == "dash":
                continue
            if word.kind not in ("word", "unit", "number") or len(phrase) >= min(longest, self.longest):
                break
            phrase.append(word.norm)
            entry = self.entry(tuple(phrase))
            if entry is not None:
                best = (entry, used)
        if best is None:
            return None
        entry, used = best
        text = " ".join(w.text for w in words[at : at + used])
        start, end = words[at].start, words[at + used - 1].end
        return Term(kind=entry.kind, text=text, start=start, end=end, value=entry.value, plural=entry.plural), used

    def _single(self, word: Word) -> tuple[Term, int]:
        if word.kind == "rank":
            return Term(kind="ORD", text=word.text, start=word.start, end=word.end, value=int(word.norm[:-2])), 1
        kind = "NUM" if word.kind == "number" else _SINGLE.get(word.kind, "UNKNOWN")
        value = float(word.norm.replace(",", "")) if kind == "NUM" else None
        return Term(kind=kind, text=word.text, start=word.start, end=word.end, value=value), 1

    def nearest(self, word: str) -> tuple[str, ...]:
        """Known words that look like this one."""
        known = {w for p in (*self.own, *_shared()) for w in p if len(w) > 3}
        spelt = word.lower()
        return tuple(w for w in get_close_matches(spelt, known, n=2, cutoff=0.8) if w != spelt)


def lexicon_for(robot: RobotProfile, site: Site) -> Lexicon:
    """The lexicon of a robot on a site. The robot's words come before the site's; none replaces function words."""
    own: dict[Phrase, Entry] = {}
    for phrase, entry in site_entries(site):
        if phrase not in _shared():
            own.setdefault(phrase, entry)
    for phrase, entry in robot_entries(robot):
        shared = _shared().get(phrase)
        if shared is None or shared.kind in _REPLACEABLE:
            own[phrase] = entry
    odd = {"".join(split(tree)): tree for tree in site.by_id if not tree.isdigit()}
    return Lexicon(own=own, trees=odd, site=site)


def _spelt(name: str) -> str:
    """A name as words of a request spell it when they are written together."""
    return "".join(split(name))


def _joins_names(term: Term) -> bool:
    """Whether a list or a range of names goes on with it."""
    return term.kind in ("COMMA", "AND", "DASH") or term.text.lower() in ("to", "through")


@cache
def _shared() -> Mapping[Phrase, Entry]:
    """The shared vocabulary, inflected. What stands later here replaces what stands before it."""
    v = vocabulary()
    entries: dict[Phrase, Entry] = {}

    def add(phrases: Iterable[str], kind: str, value: Any = None, plural: bool = False) -> None:
        for phrase in phrases:
            entries[split(phrase)] = Entry(kind=kind, value=value, plural=plural)

    add(v["silent"]["filler"], "FILLER")
    for kind, phrases in v["nouns"].items():
        add(phrases, kind)
        add(map(plural_of, phrases), kind, plural=True)
    for kind, phrases in v["verbs"].items():
        for phrase in phrases:
            for form in forms_of(phrase):
                entries.setdefault(split(form), Entry(kind=kind))
            if phrase not in ("end", "finish"):  # these are nouns first; what stands around them tells
                add([phrase], kind)
    for kind, phrases in v["words"].items():
        add(phrases, kind, kind)
    add(v["silent"]["purpose"], "PURPOSE")
    for known in v["not_yet"]:
        add(known["phrases"], "NOTYET", known["advice"])
    for phrase, kind, value in (*_numbers(v), *_compass(v)):
        add([phrase], kind, value)
    for test, phrases in v["compare"].items():
        add(phrases, "CMP", (test, ""))
    for known in v["compare_attribute"]:
        add([known["word"]], "CMP", (known["test"], known["attribute"]))
    for known in v["superlatives"]:
        add(known["words"], "SUPER", (known["attribute"], known["lowest"]))
    for level, phrases in v["levels"].items():
        add(phrases, "LEVEL", level)
    for known in v["units"]:
        for phrase in known["words"]:
            entries.setdefault(
                split(phrase), Entry(kind="UNIT", value=(known["unit"], known["factor"], known["offset"]))
            )
    add(["up to"], "UPTO")
    for by, phrases in v["orders"].items():
        add(phrases, "ORDERED", (by, "", False))
    for by, phrase in _compass_orders(v):
        add([phrase], "ORDERED", (by, "", False))
    add(_spreading(), "SPREAD")
    return entries


def _compass_orders(v: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """ "From north to south", "starting in the west", "northernmost first"."""
    for a, b in _WAYS:
        by = f"{a}_to_{b}"
        for form in ("from {} to {}", "{} to {}", "from the {} to the {}", "from {}ernmost to {}ernmost",
                     "from the {}ernmost to the {}ernmost", "from the {}ern end to the {}ern end",
                     "from the {} end to the {} end", "from the {} side to the {} side"):  # fmt: skip
            yield by, form.format(a, b)
        for form in ("{}ernmost first", "the {}ernmost first", "the {}ernmost one first", "{}most first"):
            yield by, form.format(a)
        for begin in ("starting", "beginning", "working", "going"):
            for where in ("from", "at", "in", "on"):
                for word in v["sides"][a]:
                    for end in ("", " end", " side", " edge"):
                        if word == a or end:
                            yield by, f"{begin} {where} the {word}{end}"


def _spreading() -> Iterator[str]:
    """ "Evenly spread over": how free points lie in an area."""
    for verb in ("spread", "spread out", "distributed", "scattered"):
        for where in ("over", "across", "through", "throughout", "in", "around", "within", "all over"):
            yield f"{verb} {where}"
            for how in ("evenly", "uniformly", "equally"):
                yield f"{how} {verb} {where}"
                yield f"{verb} {how} {where}"


def _numbers(v: Mapping[str, Any]) -> Iterator[tuple[str, str, Any]]:
    for word, number in v["numbers"].items():
        yield word, "NUM", float(number)
    for tens, name in enumerate(_TENS, start=2):
        for unit, digit in enumerate(_UNITS, start=1):
            yield f"{name} {digit}", "NUM", float(10 * tens + unit)
    for rank, word in enumerate(v["ranks"]["words"], start=1):
        for form in (word, f"very {word}"):
            yield form, "ORD", rank
    for word in ("last", "final", "very last"):
        yield word, "LAST", None
    for word, count in v["counts"].items():
        yield word, "COUNT", count


def _compass(v: Mapping[str, Any]) -> Iterator[tuple[str, str, str]]:
    for side, words in v["sides"].items():
        for word in words:
            yield word, "DIR", side
            yield f"{word} most", "MOST", side
        for form in ("{}ernmost", "{}most", "most {}ern", "most {}erly", "furthest {}", "farthest {}", "far {}"):
            yield form.format(side), "MOST", side
        for form in ("extreme {}", "extreme {}ern"):
            yield form.format(side), "MOST", side
    for first in ("north", "south"):
        for second in ("east", "west"):
            corner = first[0] + second[0]
            for form in ("{}{}", "{} {}", "{}{}ern", "{} {}ern", "{}ern {}ern", "{}{}erly"):
                yield form.format(first, second), "DIR", corner
            for form in ("{}{}ernmost", "{}{}most", "{} {}ernmost", "{} {}ern most", "most {}{}ern", "most {} {}ern"):
                yield form.format(first, second), "MOST", corner
            yield corner, "DIR", corner
