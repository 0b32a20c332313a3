"""What to say when a selector finds nothing: which part of it, and what the site has instead."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Literal

from fieldhand.errors import PlaceError
from fieldhand.site.features import clean
from fieldhand.site.kinds import number_text
from fieldhand.site.model import Site
from fieldhand.site.planting import Block
from fieldhand.task.selectors import Rows, Selector, Top, Value, Where

_MOST = 8
_LONGEST = 40


def no_such_tree(site: Site, tree: str) -> PlaceError:
    """There is no tree with that id."""
    near = _alike(tree, [t.place.id for t in site.trees[:5000]])
    first, last = site.trees[0].place.id, site.trees[-1].place.id
    return PlaceError(
        f"there is no tree {short(tree)!r}",
        where=site.name,
        advice=f"{near}the {len(site.trees)} trees are {short(first)} to {short(last)}",
    )


def no_such_zone(site: Site, zone: str) -> PlaceError:
    """There is no zone of that name, nor a block."""
    return _no_such_area(site, "zone", zone)


def no_such_block(site: Site, block: str) -> PlaceError:
    """There is no block of that name, nor a zone."""
    return _no_such_area(site, "block", block)


def no_rows(site: Site) -> PlaceError:
    """The trees of this site stand in no rows."""
    return PlaceError(
        "this site has no rows",
        where=site.name,
        advice=f"{site.planting.why or 'the trees stand in no rows'}; ask by ids, by the compass or by zones",
    )


def no_such_row(site: Site, blocks: Sequence[Block], said: str) -> PlaceError:
    """None of these blocks has a row that is called so."""
    from fieldhand.site.places.counted import block_words

    names = list(dict.fromkeys(row.name for block in blocks for row in block.rows))
    of = f" in {listed([block_words(b) for b in blocks])}" if len(site.planting.blocks) > 1 else ""
    has = f"there are {len(names)} rows" if len(names) > 1 else "there is 1 row"
    span = f": {listed(names)}" if len(names) <= _MOST else f", {short(names[0])} to {short(names[-1])}"
    return PlaceError(
        f"there is no row {short(said)!r}{of}",
        where=site.name,
        advice=("" if said.lstrip("-").isdecimal() else _alike(said, names)) + has + span,
    )


def row_in_several_blocks(site: Site, selector: Rows, blocks: Sequence[str]) -> PlaceError:
    """Rows are called the same in several blocks."""
    one = selector.first == selector.last or not (selector.first and selector.last)
    said = f"row {short(selector.first or selector.last)}"
    rows = said if one else f"rows {short(selector.first)} to {short(selector.last)}"
    return PlaceError(
        f"{rows} {'is' if one else 'are'} in {len(blocks)} blocks: {listed(blocks)}",
        where=site.name,
        advice=f'say of which block: "{rows} of {short(blocks[-1])}"',
    )


def no_such_attribute(site: Site, attribute: str) -> PlaceError:
    """The trees have no attribute of that name."""
    names = list(site.attributes)
    has = f"the trees have {listed(names)}" if names else "the trees of this site have no attributes"
    return PlaceError(
        f"no tree has an attribute {short(attribute)!r}", where=site.name, advice=_alike(attribute, names) + has
    )


def no_such_value(site: Site, selector: Where) -> PlaceError:
    """No tree of the whole site has that value."""
    from fieldhand.site.kinds import phrase

    name = next(k for k in site.attributes if k == selector.attribute or phrase(k) == phrase(selector.attribute))
    values = [value_text(v) for v in site.attributes[name]]
    numbers = [v for v in site.attributes[name] if isinstance(v, float)]
    if numbers and len(numbers) == len(values) > _MOST:
        has = f"it goes from {number_text(min(numbers))} to {number_text(max(numbers))}"
    else:
        has = f"the values are {listed(values)}"
    return PlaceError(
        f"no tree has {short(name)} {short(value_text(selector.value))}",
        where=site.name,
        advice=_alike(value_text(selector.value), values) + has,
    )


def not_a_number(selector: Where | Top, which: Literal["value", "attribute"]) -> PlaceError:
    """A comparison that needs numbers has something else."""
    if which == "value" and isinstance(selector, Where):
        return PlaceError(
            f"{short(selector.attribute)} cannot be above or below {short(value_text(selector.value))!r}",
            advice="compare with a number, or ask whether it is equal",
        )
    return PlaceError(
        f"{short(selector.attribute)} is not a number", advice="it can be equal to a value, not above, below or highest"
    )


def nothing(site: Site, selector: Selector, of: str = "") -> PlaceError:
    """This part of the selector leaves nothing."""
    from fieldhand.site.places.words import say_selector

    return PlaceError(
        f"nothing on this site matches {short(say_selector(selector), 160)}" + (f" ({of})" if of else ""),
        where=site.name,
        advice="ask for other trees",
    )


def too_few(site: Site, selector: Selector, wanted: int, there_are: int) -> PlaceError:
    """Fewer than were asked for."""
    from fieldhand.site.places.words import say_selector

    only = f"there {'is' if there_are == 1 else 'are'} only {there_are}" if there_are else "there are none"
    return PlaceError(
        f"{wanted} {'is' if wanted == 1 else 'are'} asked for and {only}: {short(say_selector(selector), 160)}",
        where=site.name,
        advice=f"ask for at most {there_are}" if there_are else "ask for other trees",
    )


def listed(names: Sequence[str]) -> str:
    """The first few, and how many more."""
    shown = ", ".join(short(n) for n in names[:_MOST])
    return shown + (f" and {len(names) - _MOST} more" if len(names) > _MOST else "")


def short(text: str, longest: int = _LONGEST) -> str:
    """Text on one line and not too long."""
    text = clean(text)
    return text if len(text) <= longest else text[: longest - 3] + "..."


def value_text(value: Value) -> str:
    """A value as people write it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return number_text(value) if isinstance(value, float) else str(value)


def _no_such_area(site: Site, kind: Literal["zone", "block"], name: str) -> PlaceError:
    zones = list(dict.fromkeys(z.name for z in site.zones))
    blocks = [b.name for b in site.planting.blocks]
    has = {
        "zone": f"its zones are {listed(zones)}" if zones else "it has no zones",
        "block": f"its blocks are {listed(blocks)}" if blocks else "it has no blocks",
    }
    other = {"zone": blocks, "block": zones}[kind]
    others = f", its {'blocks' if kind == 'zone' else 'zones'} {listed(other)}" if other and len(blocks) != 1 else ""
    return PlaceError(
        f"there is no {kind} {short(name)!r}",
        where=site.name,
        advice=_alike(name, [*zones, *blocks] if kind == "zone" else [*blocks, *zones]) + has[kind] + others,
    )


def _alike(name: str, names: Iterable[str]) -> str:
    by_lower = {n.lower()[:_LONGEST]: n for n in names}
    near = difflib.get_close_matches(name.lower()[:_LONGEST], list(by_lower)[:5000], n=1, cutoff=0.6)
    return f"did you mean {short(by_lower[near[0]])!r}? " if near else ""
