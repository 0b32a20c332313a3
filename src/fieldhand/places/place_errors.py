"""Errors for selectors that match nothing: the part at fault, and the alternatives on the site."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Literal

from fieldhand.errors import NoPlaceError, PlaceError
from fieldhand.language import counted, joined, message, shaped
from fieldhand.places.wording import say_selector
from fieldhand.site.feature_kinds import number_text, phrase
from fieldhand.site.names import listed, say_block, short

if TYPE_CHECKING:
    from fieldhand.places.filters.where import Where
    from fieldhand.places.rows.rows import Rows
    from fieldhand.places.selector import Selector
    from fieldhand.site.model import Site
    from fieldhand.site.planting import Block
    from fieldhand.terms import Value

#: Maximum number of rows or values listed; beyond it only the first and last, or least and greatest, are named.
_MOST = 8
#: Maximum length of a name in the search for similar ones.
_LONGEST = 40


def no_such_tree(site: Site, tree: str) -> PlaceError:
    """Return the error for an unknown tree id."""
    if not site.trees:
        return PlaceError(
            message("there is no tree '{id}'", id=short(tree)),
            where=site.name,
            advice=message("this site has no trees; name a zone, or points in one"),
        )
    near = _alike(tree, [t.place.id for t in site.trees[:5000]])
    first, last = site.trees[0].place.id, site.trees[-1].place.id
    return PlaceError(
        message("there is no tree '{id}'", id=short(tree)),
        where=site.name,
        advice=message(
            "{did_you_mean} the {count} trees are {first} to {last}",
            did_you_mean=near,
            count=len(site.trees),
            first=short(first),
            last=short(last),
        ),
    )


def no_such_gate(site: Site, gate: str) -> PlaceError:
    """Return the error for an unknown gate."""
    names = [g.place.id for g in site.gates]
    has = message("its gates are {names}", names=listed(names)) if names else message("it has no gates")
    near = _alike(gate, names)
    return PlaceError(
        message("there is no gate '{name}'", name=short(gate)),
        where=site.name,
        advice=joined(" ", (near, has)) if near else has,
    )


def no_such_zone(site: Site, zone: str) -> PlaceError:
    """Return the error for a name that is neither a zone nor a block."""
    return _no_such_area(site, "zone", zone)


def no_such_block(site: Site, block: str) -> PlaceError:
    """Return the error for a name that is neither a block nor a zone."""
    return _no_such_area(site, "block", block)


def no_such_row(site: Site, blocks: Sequence[Block], name: str) -> PlaceError:
    """Return the error for a row that none of these blocks has."""
    names = list(dict.fromkeys(row.name for block in blocks for row in block.rows))
    has = counted("there is {count} row", "there are {count} rows", len(names))
    if len(names) <= _MOST:
        has = message("{rows}: {names}", rows=has, names=listed(names))
    else:
        has = message("{rows}, {first} to {last}", rows=has, first=short(names[0]), last=short(names[-1]))
    near = "" if name.lstrip("-").isdecimal() else _alike(name, names)
    what = message("there is no row '{name}'", name=short(name))
    if len(site.planting.blocks) > 1:
        what = message("{what} in {blocks}", what=what, blocks=listed([say_block(b.name) for b in blocks]))
    return PlaceError(what, where=site.name, advice=joined(" ", (near, has)) if near else has)


def row_in_several_blocks(site: Site, selector: Rows, blocks: Sequence[str]) -> PlaceError:
    """Return the error for a row name that several blocks share."""
    one = selector.first == selector.last or not (selector.first and selector.last)
    if one:
        rows = message("row {name}", name=short(selector.first or selector.last))
    else:
        rows = message(
            "rows {first} to {last} {from_side}", first=short(selector.first), last=short(selector.last), from_side=""
        )
    return PlaceError(
        counted(
            "{rows} is in {blocks} blocks: {names}",
            "{rows} are in {blocks} blocks: {names}",
            1 if one else 2,
            rows=rows,
            blocks=len(blocks),
            names=listed(blocks),
        ),
        where=site.name,
        advice=message('name the block: "{rows} of {block}"', rows=rows, block=short(blocks[-1])),
    )


def no_such_attribute(site: Site, attribute: str) -> PlaceError:
    """Return the error for an unknown attribute."""
    names = list(site.attributes)
    if names:
        has = message(
            "{did_you_mean} the trees have {names}", did_you_mean=_alike(attribute, names), names=listed(names)
        )
    else:
        has = message("the trees of this site have no attributes")
    return PlaceError(message("no tree has an attribute '{name}'", name=short(attribute)), where=site.name, advice=has)


def no_such_value(site: Site, selector: Where) -> PlaceError:
    """Return the error for a value that no tree of the site has."""
    name = next(k for k in site.attributes if k == selector.attribute or phrase(k) == phrase(selector.attribute))
    values = [value_text(v) for v in site.attributes[name]]
    numbers = [v for v in site.attributes[name] if isinstance(v, float)]
    if numbers and len(numbers) == len(values) > _MOST:
        has = message("it goes from {low} to {high}", low=number_text(min(numbers)), high=number_text(max(numbers)))
    else:
        has = message("the values are {values}", values=listed(values))
    near = _alike(value_text(selector.value), values)
    return PlaceError(
        message("no tree has {name} {value}", name=short(name), value=short(value_text(selector.value))),
        where=site.name,
        advice=joined(" ", (near, has)) if near else has,
    )


def no_such_value_here(site: Site, selector: Where, values: Sequence[Value]) -> PlaceError:
    """Return the error for a value that trees of the site have, but none of this group."""
    error = nothing(site, selector)
    if not values:
        return error
    has = message("the values are {values}", values=listed([value_text(v) for v in values]))
    return PlaceError(error.what, where=site.name, advice=has)


def not_comparable(selector: Where) -> PlaceError:
    """Return the error for a numeric comparison with something that is no number."""
    return PlaceError(
        message(
            "{name} cannot be above or below '{value}'",
            name=short(selector.attribute),
            value=short(value_text(selector.value)),
        ),
        advice=message("compare it with a number, or test only whether it is equal"),
    )


def not_a_number(attribute: str) -> PlaceError:
    """Return the error for an attribute that is no number on any tree, where one is required."""
    return PlaceError(
        message("{name} is not a number", name=short(attribute)),
        advice=message("test only whether it equals a value; above, below and highest need numbers"),
    )


def nothing(site: Site, selector: Selector, of: str = "") -> PlaceError:
    """Return the error for a part of a selector that matches nothing."""
    if not site.trees:
        return PlaceError(
            message("this site records no plants: {trees}", trees=_shortened(say_selector(selector))),
            where=site.name,
            advice=message("name an area and a number of points: '10 points in the meadow'"),
        )
    what = message("nothing on this site matches {trees}", trees=_shortened(say_selector(selector)))
    return NoPlaceError(
        message("{what} ({why})", what=what, why=of) if of else what,
        where=site.name,
        advice=message("ask for other trees"),
    )


def too_few(site: Site, selector: Selector, wanted: int, there_are: int) -> PlaceError:
    """Return the error for fewer places than requested."""
    if there_are:
        only = counted("there is only {count}", "there are only {count}", there_are)
    else:
        only = message("there are none")
    return PlaceError(
        counted(
            "{count} was asked for, but {there_are}: {trees}",
            "{count} were asked for, but {there_are}: {trees}",
            wanted,
            there_are=only,
            trees=_shortened(say_selector(selector)),
        ),
        where=site.name,
        advice=message("ask for at most {count}", count=there_are) if there_are else message("ask for other trees"),
    )


def _shortened(text: str) -> str:
    """Return a phrase shortened to one line, in any language."""
    return shaped(text, _within_a_line)


def _within_a_line(text: str) -> str:
    return short(text, 160)


def value_text(value: Value) -> str:
    """Return an attribute value as people write it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float) else str(value)


def _no_such_area(site: Site, kind: Literal["zone", "block"], name: str) -> PlaceError:
    zones = list(dict.fromkeys(z.name for z in site.zones))
    blocks = [b.name for b in site.planting.blocks]
    near = _alike(name, [*zones, *blocks] if kind == "zone" else [*blocks, *zones])
    has_zones = message("its zones are {names}", names=listed(zones)) if zones else message("it has no zones")
    has_blocks = message("its blocks are {names}", names=listed(blocks)) if blocks else message("it has no blocks")
    if kind == "zone":
        has = has_zones
        if len(blocks) > 1:
            has = message("{zones}, its blocks {names}", zones=has, names=listed(blocks))
        what = message("there is no zone '{name}'", name=short(name))
    else:
        has = has_blocks
        if zones and len(blocks) != 1:
            has = message("{blocks}, its zones {names}", blocks=has, names=listed(zones))
        what = message("there is no block '{name}'", name=short(name))
    return PlaceError(what, where=site.name, advice=joined(" ", (near, has)) if near else has)


def _alike(name: str, names: Iterable[str]) -> str:
    by_lower = {n.lower()[:_LONGEST]: n for n in names}
    near = difflib.get_close_matches(name.lower()[:_LONGEST], list(by_lower)[:5000], n=1, cutoff=0.6)
    return message("did you mean '{name}'?", name=short(by_lower[near[0]])) if near else ""
