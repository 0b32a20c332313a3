"""From words to terms: the shared vocabulary together with what this robot and this site are called in words."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from fieldhand.planning.english.kinds import CONTINUES, RELATIONS, TESTS
from fieldhand.planning.english.naming import NameEntry, Phrase, robot_entries, site_entries, split
from fieldhand.planning.english.shared import shared_vocabulary
from fieldhand.planning.english.tokens import Term, Word
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Words of the shared vocabulary that a robot's own word may replace; no function word is among them.
_REPLACEABLE = frozenset({"READING", "FILLER", "TREE", "PLACE", "EDGE", "SIDE"})
_SINGLE = {"stop": "STOPMARK", "comma": "COMMA", "dash": "DASH", "sign": "AND", "hash": "NUMBERED", "silent": "FILLER"}
#: Behind "starting in the north", these go on with a place: it is no order then.
_NO_ORDER = frozenset(
    {"DIR", "MOST", "CORNER", "TREE", "IDS", "QUARTER", "HALF", "MIDDLE", "OF", "EDGE", "ROW", "SIDE", "FINISH", "ZONE"}
)
#: What a word that names a block may be besides: never an article or another word of the grammar ("a block").
_MAY_NAME = frozenset({"UNKNOWN", "ATTRVAL", "ATTR", "START", "FINISH", "DIR", "ZONE", "IDS", "NAMED", "MIDDLE"})
#: A shorter word is no word that another may be a misspelling of.
_SPELLABLE = 6
#: An id of letters and a number, which names a tree without the word for it.
CODE = re.compile(r"([^\W\d_]+)(\d+)")


@dataclass(frozen=True)
class Lexicon:
    """Phrases and what they are; the longest one that fits is taken.

    Attributes:
        own: Phrases of this robot and this site, which come before the shared ones.
        trees: Ids of trees that are not plain numbers, as the lexicon knows words.
        site: Whose rows and blocks may have names; they are looked for only where a row or a block is spoken of.
    """

    own: Mapping[Phrase, NameEntry]
    trees: Mapping[str, str]
    site: Site

    @cached_property
    def longest(self) -> int:
        """Words of the longest phrase."""
        return max(len(p) for p in (*self.own, *shared_vocabulary()))

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """Every word that stands in some phrase, names of rows, blocks and trees among them."""
        words = {word for phrase in (*self.own, *shared_vocabulary()) for word in phrase}
        names = [*self.trees, *self.row_names, *self.block_names]
        return frozenset({*words, *names, *(part for name in names for part in split(name))})

    @cached_property
    def spellings(self) -> tuple[str, ...]:
        """The words of some length, which a word may be a misspelling of."""
        return tuple(sorted(word for word in self.vocabulary if len(word) >= _SPELLABLE and word.isalpha()))

    def entry(self, phrase: Phrase) -> NameEntry | None:
        """What a phrase is; None if it is not known."""
        return self.own.get(phrase) or shared_vocabulary().get(phrase)

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
            name = self.block_names.get("".join(_spelt(t.text) for t in words)) if len(words) == length else None
            if name is not None and all(t.kind in _MAY_NAME for t in words):
                return name, at - length
        return None

    @cached_property
    def row_names(self) -> Mapping[str, str]:
        """Names of rows that are not plain numbers."""
        return {_spelt(row.name): row.name for row in self.site.planting.rows if not row.name.isdigit()}

    @cached_property
    def block_names(self) -> Mapping[str, str]:
        """Names of blocks that are not plain numbers."""
        return {_spelt(block.name): block.name for block in self.site.planting.blocks if not block.name.isdigit()}

    @cached_property
    def codes(self) -> frozenset[str]:
        """Return the letters with which the tree ids begin, for ids of letters and a number."""
        found = (CODE.fullmatch(tree) for tree in self.site.by_id)
        return frozenset(code[1].lower() for code in found if code is not None)

    @cached_property
    def short_values(self) -> Mapping[str, tuple[str, str]]:
        """Return attributes with their values by the first word of a value of several words, if it names just one."""
        found: dict[str, set[tuple[str, str]]] = {}
        for attribute, values in self.site.attributes.items():
            for value in values:
                if isinstance(value, str) and len(split(value)) > 1:
                    found.setdefault(split(value)[0], set()).add((attribute, value))
        return {word: next(iter(meant)) for word, meant in found.items() if len(meant) == 1}

    @cached_property
    def _coded(self) -> Mapping[str, str]:
        """Ids of trees that are letters and a number, which mean trees without the word: "at N250"."""
        taken = {word for phrase in (*self.own, *shared_vocabulary()) for word in phrase}
        coded = re.compile(r"[^\W\d_]+\d+")
        return {spelt: name for spelt, name in self.trees.items() if coded.fullmatch(spelt) and spelt not in taken}

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
            found = self.row_names
        elif head.kind == "PLOT" and head.text.lower() in ("block", "blocks"):
            found = self.block_names
        elif not listed and (head.kind == "TREE" or before[-1].kind == "NUMBERED"):
            return self.trees, "IDS"
        elif head.kind == "IDS" and before[-1].kind in ("COMMA", "AND"):  # "trees T89 and T158"
            return {spelt: name for spelt, name in self.trees.items() if (spelt,) not in shared_vocabulary()}, "IDS"
        if listed:  # "row B and a picture": a name that is a word besides stands right behind "row"
            found = {spelt: name for spelt, name in found.items() if (spelt,) not in shared_vocabulary()}
        return (found, "NAMED") if found else (self._coded, "IDS")

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
        best: tuple[NameEntry, int] | None = None
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


#: Lexicons made last, each for its robot and site: the requests of a session are about few of them, and making one
#: takes 40 ms for 4,500 trees.
_made: deque[tuple[RobotProfile, Site, Lexicon]] = deque(maxlen=4)


def lexicon_for(robot: RobotProfile, site: Site) -> Lexicon:
    """Return the lexicon of a robot on a site, which is kept for the next request.

    The robot's words come before the site's; none replaces function words.
    """
    for known_robot, known_site, lexicon in tuple(_made):
        if known_robot is robot and known_site is site:
            return lexicon
    lexicon = _lexicon_of(robot, site)
    _made.append((robot, site, lexicon))
    return lexicon


def _lexicon_of(robot: RobotProfile, site: Site) -> Lexicon:
    own: dict[Phrase, NameEntry] = {}
    for phrase, entry in site_entries(site):
        if phrase not in shared_vocabulary():
            own.setdefault(phrase, entry)
    for phrase, entry in robot_entries(robot):
        shared = shared_vocabulary().get(phrase)
        if shared is None or shared.kind in _REPLACEABLE or (shared.kind == "TAKE" and entry.kind == "ACTV"):
            own[phrase] = entry
    odd = {"".join(split(tree)): tree for tree in site.by_id if not tree.isdigit()}
    lexicon = Lexicon(own=own, trees=odd, site=site)
    short = {
        (word,): value
        for word, value in lexicon.short_values.items()
        if lexicon.entry((word,)) is None and len(site.attributes[value[0]]) > 1
    }
    own |= {phrase: NameEntry(kind="ATTRVAL", value=(value,)) for phrase, value in short.items()}
    return Lexicon(own=own, trees=odd, site=site)


def _spelt(name: str) -> str:
    """A name as words of a request spell it when they are written together."""
    return "".join(split(name))


def _joins_names(term: Term) -> bool:
    """Whether a list or a range of names goes on with it."""
    return term.kind in ("COMMA", "AND", "DASH") or term.text.lower() in ("to", "through")
