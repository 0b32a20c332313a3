"""The shared vocabulary together with what a robot and a site are called in words."""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from fieldhand.planning.english.naming import NameEntry, Phrase, parameter_entries, robot_entries, site_entries, split
from fieldhand.planning.english.place_words import short_names
from fieldhand.planning.english.plant_words import beds_that_are_rows, plant_entries, priced
from fieldhand.planning.english.shared import shared_vocabulary
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site

#: Words of the shared vocabulary that a robot's own word may replace; no function word is among them.
_REPLACEABLE = frozenset({"READING", "FILLER", "TREE", "PLACE", "EDGE", "SIDE"})
#: Categories of verbs that a robot's own verbs may replace.
_VERBS = frozenset({"TAKE", "MEASURE"})
#: An id of letters and a number, which names a tree without the word for it.
CODE = re.compile(r"([^\W\d_]+)(\d+)")


@dataclass(frozen=True)
class Lexicon:
    """Phrases and what they are; the longest one that fits is taken.

    Attributes:
        own: Phrases of this robot and this site, which come before the shared ones.
        trees: Ids of trees that are not plain numbers, as the lexicon knows words.
        site: Whose rows and blocks may have names; they are looked for only where a row or a block is spoken of.
        attributes: Attributes of the site that a word of the robot calls as well ("leaves" of a leaf sampler).
        beside: What phrases are on this site beside what they are anyway ("bed", a row where rows are beds).
    """

    own: Mapping[Phrase, NameEntry]
    trees: Mapping[str, str]
    site: Site
    attributes: Mapping[Phrase, NameEntry] = field(default_factory=dict)
    beside: Mapping[Phrase, tuple[NameEntry, ...]] = field(default_factory=dict)

    @cached_property
    def longest(self) -> int:
        """Words of the longest phrase."""
        return max(len(p) for p in (*self.own, *shared_vocabulary()))

    @cached_property
    def vocabulary(self) -> frozenset[str]:
        """Every word that stands in some phrase, names of rows, blocks and trees among them."""
        words = {word for phrase in (*self.own, *self.beside, *shared_vocabulary()) for word in phrase}
        names = [*self.trees, *self.row_names, *self.block_names]
        return frozenset({*words, *names, *(part for name in names for part in split(name))})

    def entry(self, phrase: Phrase) -> NameEntry | None:
        """Return the meaning of a phrase; None if it is not known."""
        return self.own.get(phrase) or shared_vocabulary().get(phrase)

    @cached_property
    def row_names(self) -> Mapping[str, str]:
        """Names of rows that are not plain numbers."""
        return {_spelt(row.name): row.name for row in self.site.planting.rows if not row.name.isdigit()}

    @cached_property
    def block_names(self) -> Mapping[str, str]:
        """Names of blocks that are not plain numbers."""
        return {_spelt(block.name): block.name for block in self.site.planting.blocks if not block.name.isdigit()}

    def is_zone(self, name: str) -> bool:
        """Return True if a zone has a name."""
        return any(split(zone.name) == split(name) for zone in self.site.zones)

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
    attributes: dict[Phrase, NameEntry] = {}
    rows_too = beds_that_are_rows(site)
    for phrase, entry in site_entries(site):
        known = own.get(phrase)
        if phrase not in shared_vocabulary() and (known is None or (known.kind, entry.kind) == ("ATTRVAL", "ZONE")):
            own[phrase] = priced(entry, rows_too)  # "warm section", an area rather than the value of an attribute
    for phrase, entry in parameter_entries(robot):
        if phrase not in shared_vocabulary():
            own.setdefault(phrase, entry)
    for phrase, entry in robot_entries(robot):
        shared = shared_vocabulary().get(phrase)
        if shared is None or shared.kind in _REPLACEABLE or (shared.kind in _VERBS and entry.kind in ("ACTV", "WORKV")):
            if phrase in own and own[phrase].kind == "ATTR":
                attributes[phrase] = own[phrase]
            own[phrase] = entry
    odd = {spelt(split(tree)): tree for tree in site.by_id if not tree.isdigit()}
    lexicon = Lexicon(own=own, trees=odd, site=site)
    short = {
        (word,): value
        for word, value in lexicon.short_values.items()
        if lexicon.entry((word,)) is None and len(site.attributes[value[0]]) > 1
    }
    own |= {phrase: NameEntry(kind="ATTRVAL", value=(value,)) for phrase, value in short.items()}
    beside: dict[Phrase, tuple[NameEntry, ...]] = {}
    for phrase, entry in site_entries(site):
        shared = shared_vocabulary().get(phrase)
        if shared is not None and shared.kind == "UNIT" and entry.kind == "ZONE":
            beside[phrase] = (entry,)  # "the yard"
    for phrase, entry in (*plant_entries(site, rows_too), *short_names(site)):
        shared = shared_vocabulary().get(phrase)
        is_plant = shared is not None and shared.kind == "TREE"  # a file that says of each vine that it is one
        if not is_plant and entry != own.get(phrase) and entry not in beside.get(phrase, ()):
            beside[phrase] = (*beside.get(phrase, ()), entry)
    return Lexicon(own=own, trees=odd, site=site, attributes=attributes, beside=beside)


def spelt(parts: Sequence[str]) -> str:
    """Return a name as words of a request spell it: together, but numbers apart, since "1-8" is not the number 18."""
    return ("-" if all(part.isdigit() for part in parts) else "").join(parts)


def _spelt(name: str) -> str:
    """A name as words of a request spell it when they are written together."""
    return "".join(split(name))
