"""Words for the plants of a site: what they are ("courgettes"), what is true of them ("grafted"), and their beds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache

from fieldhand.planning.english.inflection import plural_of
from fieldhand.planning.english.naming import NameEntry, Phrase, name_words, numbered_zones_of, split
from fieldhand.planning.english.vocabulary import vocabulary
from fieldhand.site.model import Site

#: Price of the name of an area that is one row as well: what is said of "bed 4" is said of the row.
_AS_AREA_TOO = 3.4
#: Number of values from which on an attribute names each plant rather than kinds of plants.
_MOST_KINDS = 200


@cache
def is_kind_attribute(attribute: str) -> bool:
    """Return True if the values of an attribute are kinds of plants, which are nouns: "crop", "variety"."""
    words = name_words(attribute)
    return bool(words) and set(words) <= {*vocabulary()["plants"]["kind_attributes"], "name"}


@cache
def is_unmarked(attribute: str, value: str) -> bool:
    """Return True if a kind is named without an ending whatever their number: "the basil", "the San Marzano"."""
    if set(name_words(attribute)) & {*vocabulary()["plants"]["variety_attributes"]}:
        return True
    return " ".join(split(value)) in vocabulary()["plants"]["unmarked"]


def plant_entries(site: Site, rows_too: frozenset[str]) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield what words are on a site beside what they are anyway.

    Args:
        site: The site.
        rows_too: Names of areas each of which is one row, see :func:`beds_that_are_rows`.
    """
    yield from _kinds(site)
    yield from _flags(site)
    yield from _beds(site, rows_too)


def _kinds(site: Site) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield the kinds of plants in both numbers, whichever the file has: "tomato" and "tomatoes"."""
    found: dict[tuple[Phrase, bool], list[tuple[str, str]]] = {}
    for attribute, values in site.attributes.items():
        texts = [value for value in values if isinstance(value, str) and split(value)]
        if not is_kind_attribute(attribute) or len(texts) > _MOST_KINDS:
            continue
        for text in texts:
            *head, last = split(text)
            singular = _singular(last)
            for one in {last, singular} - {""}:
                found.setdefault(((*head, one), one == last and bool(singular)), []).append((attribute, text))
            for many in _plurals(singular or last):
                found.setdefault(((*head, many), True), []).append((attribute, text))
    for (phrase, plural), meant in found.items():
        yield phrase, NameEntry(kind="ATTRVAL", value=tuple(dict.fromkeys(meant)), plural=plural)


def absent_plant(words: Sequence[str], site: Site) -> str:
    """Return the words at the beginning of others that name a plant; empty if they name none or one of the site's.

    A site whose file does not say of what kind its plants are, only of which variety, may have it.
    """
    kinds = kinds_of_plants(site)
    for count in (2, 1):
        named = tuple(words[:count])
        if not kinds or len(named) < count or named not in _known_plants():
            continue
        one = (*named[:-1], _singular(named[-1]) or named[-1])
        grown = any(split(kind)[-count:] in (named, one) for kind in kinds)
        return "" if grown else " ".join(named)
    return ""


def kinds_of_plants(site: Site) -> list[str]:
    """Return what grows on a site, as its file names it, but for the varieties."""
    varieties = {*vocabulary()["plants"]["variety_attributes"], "variety"}
    found = [
        values
        for attribute, values in site.attributes.items()
        if is_kind_attribute(attribute) and not set(name_words(attribute)) & varieties and len(values) <= _MOST_KINDS
    ]
    return [value for values in found if len(values) > 1 for value in values if isinstance(value, str)]


@cache
def _known_plants() -> frozenset[Phrase]:
    """Return the names of common plants in both numbers."""
    names = [split(name) for name in vocabulary()["plants"]["known"]]
    return frozenset({*names, *((*head, many) for *head, last in names for many in _plurals(last))})


def _plurals(noun: str) -> set[str]:
    """Return the plural of a noun; both that it may have for one in "o"."""
    return {plural_of(noun), f"{noun}es"} if noun.endswith("o") else {plural_of(noun)}


def _singular(noun: str) -> str:
    """Return the singular of a noun in the plural; empty for another noun."""
    for ending, instead in (("oes", "o"), ("ies", "y"), ("ches", "ch"), ("shes", "sh"), ("ves", "f"), ("s", "")):
        if noun.endswith(ending) and len(noun) > len(ending) + 2 and not noun.endswith(("ss", "us", "is")):
            return noun.removesuffix(ending) + instead
    return ""


def _flags(site: Site) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield what is true or false of each plant: "grafted", "ungrafted", "mildew"."""
    found: dict[Phrase, list[tuple[str, bool]]] = {}
    for attribute, values in site.attributes.items():
        if not is_flag(values):
            continue
        base = tuple(word for word in split(attribute) if word not in vocabulary()["plants"]["silent_in_flags"])
        if not base:
            continue
        *head, last = base
        forms = {last}
        if not last.endswith(("ed", "en", "y", "s", "ic", "ing")):
            forms |= {f"{last.removesuffix('e')}ed", f"{last.removesuffix('e')}y"}
        for form in forms:
            found.setdefault((*head, form), []).append((attribute, True))
            for before in ("un", "non"):
                found.setdefault((*head, f"{before}{form}"), []).append((attribute, False))
    words = vocabulary()["plants"]
    sick = [
        name for name, values in site.attributes.items() if is_flag(values) and {*split(name)} & {*words["diseases"]}
    ]
    if len(sick) == 1:  # "healthy" beside the only disease that the file records
        for phrases, value in ((words["sick"], True), (words["healthy"], False)):
            for phrase in phrases:
                found.setdefault(split(phrase), []).append((sick[0], value))
    for phrase, meant in found.items():
        yield phrase, NameEntry(kind="FLAG", value=tuple(dict.fromkeys(meant)))
        if phrase[-1].endswith("ed") and all(value for _, value in meant):
            for form in _nouns_of(phrase[-1]):
                yield (*phrase[:-1], form), NameEntry(kind="FLAGNOUN", value=tuple(meant))


def _nouns_of(participle: str) -> set[str]:
    """Return the nouns of which a participle may be made: "cover" and "covers" of "covered", "net" of "netted"."""
    stem = participle.removesuffix("ed")
    single = {stem, f"{stem}e"} | ({stem[:-1]} if stem[-1:] == stem[-2:-1] else set())
    return single | {plural_of(one) for one in single}


def is_flag(values: tuple[str | float | bool, ...]) -> bool:
    """Return True if the values of an attribute are only yes and no."""
    words = {*vocabulary()["plants"]["affirmed"], *vocabulary()["plants"]["denied"]}
    return bool(values) and all(
        isinstance(value, bool) or (isinstance(value, str) and value.strip().lower() in words) for value in values
    )


def _beds(site: Site, rows_too: frozenset[str]) -> Iterator[tuple[Phrase, NameEntry]]:
    """Yield the words for a bed as words for a row, where the beds are the rows or have no areas of their own."""
    if not site.planting.rows:
        return
    rows = {split(head) for head in rows_too}
    named = {word for zone in site.zones for word in split(zone.name)}
    for phrase in {*rows, *map(split, vocabulary()["plants"]["beds"])}:
        if phrase in rows or named.isdisjoint({phrase[-1], plural_of(phrase[-1])}) or phrase[-1:] in rows:
            yield phrase, NameEntry(kind="ROW")
            yield (*phrase[:-1], plural_of(phrase[-1])), NameEntry(kind="ROW", plural=True)


def beds_that_are_rows(site: Site) -> frozenset[str]:
    """Return what areas are called that differ in their number, if each holds just the plants of the row with it.

    Such are "bed 1" to "bed 8" where row 1 grows in bed 1, row 2 in bed 2, and so on.
    """
    from fieldhand.places.filters.zones import in_zones
    from fieldhand.places.place_group import PlaceGroup

    rows: dict[str, list[set[int]]] = {}
    for row in site.planting.rows:
        rows.setdefault(row.name, []).append(set(row.trees.tolist()))
    every = PlaceGroup.all_trees(site)
    found: set[str] = set()
    for head, numbered in numbered_zones_of(site).items():
        plants = {number: in_zones(every, zone) for number, zone in numbered}
        if all(group is not None and rows.get(n) == [set(group.index.tolist())] for n, group in plants.items()):
            found.add(head)
    return frozenset(found)


def priced(entry: NameEntry, rows_too: frozenset[str]) -> NameEntry:
    """Return the meaning of a phrase, with the price of an area that is one row as well."""
    named = entry.value if entry.kind == "ZONE" else entry.value[0][1] if entry.kind == "NUMBEREDZONE" else ""
    return replace(entry, cost=_AS_AREA_TOO) if str(named).rpartition(" ")[0] in rows_too else entry
