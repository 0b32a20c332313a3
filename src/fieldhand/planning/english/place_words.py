"""Names of places in short: "the gate" of the lane gate, "the paddock" of the horse paddock, "the orchids' patch"."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.planning.english.inflection import plural_of
from fieldhand.planning.english.naming import NameEntry, Phrase, split
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.site.model import Site

#: Price of a short name, which may be another place's as well.
_SHORT = 1.7
#: Price of a short name that is a word for the site as well ("the paddock"): which of the two is asked.
_OR_THE_SITE = 0.8
#: Heads of names of ground on which the plants before them grow: "the orchids" of the orchid patch.
_GROWN = frozenset({"patch", "bed", "strip", "border", "plot", "corner", "garden", "clump", "stand"})
#: Words that tell trees apart as well as places: "the north one".
_COMPASS = frozenset({"north", "east", "south", "west", "northern", "eastern", "southern", "western"})
#: Maximum number of places that may be meant by one short name; more are none of them.
_MOST = 5


def short_names(site: Site) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield the short names of the zones and gates of a site, and the words for all of its gates."""
    named = {zone.name: split(zone.name) for zone in site.zones if zone.kind != "boundary"}
    whole = {*named.values(), *(split(gate.place.id) for gate in site.gates)}
    heads: dict[str, list[str]] = {}
    for name, words in named.items():
        if len(words) > 1 and not words[-1].isdecimal():
            heads.setdefault(_head(words), []).append(name)
    markers = {split(name)[-1] for _, name in site.marker_names if split(name)}
    gates: dict[str, list[str]] = {}
    for gate in site.gates:
        words = split(gate.place.id)
        gates.setdefault(words[-1] if words and not words[-1].isdecimal() else "gate", []).append(gate.place.id)
    outlines = {split(zone.name) for zone in site.zones if zone.kind == "boundary" and zone.name}
    for outline in outlines - whole:
        yield outline, NameEntry(kind="PLOT", cost=_SHORT)
    plots = {*vocabulary()["nouns"]["PLOT"], *(" ".join(outline) for outline in outlines)}
    for head, names in heads.items():
        if head in _vague() or (head,) in whole or head in gates or head in markers:
            continue
        for name in names if len(names) <= _MOST else ():
            cost = _SHORT + _OR_THE_SITE - 1.0 if (head,) in outlines else _OR_THE_SITE if head in plots else _SHORT
            yield (head,), NameEntry(kind="ZONE", value=name, cost=cost)
    yield from _kinds_of_ground(site)
    for name, words in named.items():
        if len(words) == 2 and words[-1] in vocabulary()["plants"]["containers"] and (words[0],) not in whole:
            yield words[:1], NameEntry(kind="ZONE", value=name, cost=_SHORT)
        if len(words) == 2 and words[-1] in _GROWN and (grown := (plural_of(words[0]),)) not in whole:
            yield grown, NameEntry(kind="ZONE", value=name, cost=_SHORT)
        if len(words) == 2 and len(heads.get(words[-1], ())) > 1 and words[0] not in _COMPASS:
            yield (words[0], "one"), NameEntry(kind="ZONE", value=name, cost=_SHORT)
        if len(words) == 2:
            for owner in {f"{words[0]}'s", f"{words[0]}s'", f"{words[0]}s", words[0].removesuffix("s")} - {words[0]}:
                yield (owner, words[1]), NameEntry(kind="ZONE", value=name)
    for head, names in gates.items():
        for name in names if len(names) <= _MOST and (head,) not in whole else ():
            yield (head,), NameEntry(kind="GATENAME", value=name, cost=_SHORT)
        yield (plural_of(head),), NameEntry(kind="GATES", value=tuple(names), plural=True)
        yield (head,), NameEntry(kind="GATES", value=tuple(names))


def _kinds_of_ground(site: Site) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield the nouns that several zones have in common ("section" of the warm section), and those for every zone."""
    zones = {zone.name: split(zone.name) for zone in site.zones if zone.kind == "zone" and split(zone.name)}
    unnumbered = {name: words for name, words in zones.items() if not words[-1].isdecimal()}
    kinds: dict[str, list[str]] = {}
    for name, words in unnumbered.items():
        if len(words) > 1 and words[-1] == _head(words):
            kinds.setdefault(words[-1], []).append(name)
    kinds["zone"] = list(unnumbered)
    for head, names in kinds.items():
        if len(names) > 1:
            yield (head,), NameEntry(kind="ZONEKIND", value=tuple(names))
            yield (plural_of(head),), NameEntry(kind="ZONEKIND", value=tuple(names), plural=True)


def _head(words: Phrase) -> str:
    """Return the noun of a name: "patch" of "orchid patch", "strip" of "strip under the oak"."""
    behind = next((at for at, word in enumerate(words) if word in vocabulary()["plants"]["prepositions"]), len(words))
    return words[max(behind, 1) - 1]


def _vague() -> frozenset[str]:
    """Return the nouns that name a part of any area, and no place by themselves."""
    return frozenset(vocabulary()["plants"]["vague_places"])
