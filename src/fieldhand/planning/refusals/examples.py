"""Requests to suggest in place of one that cannot be planned: made from its parts, or from names of the site.

None is suggested that was not planned first.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import islice

from fieldhand.language.words import article
from fieldhand.planning.english.naming import name_words
from fieldhand.planning.english.wishes import Offers
from fieldhand.planning.grammar.places.vague import qualities
from fieldhand.planning.planner import Outcome, Planned
from fieldhand.planning.refusals.understood import ParsedRequest, UnderstoodPart
from fieldhand.robot.model import Action
from fieldhand.site.model import Site
from fieldhand.task.plan import walk

#: Plans a request as the English planner does, without help where it is refused.
PlanRequest = Callable[[str], Outcome]

#: Maximum number of requests that are planned to find one that can be suggested.
_MOST_TRIES = 8
#: An attribute with more different texts than this is a name or an id.
_MOST_TEXTS = 50
#: Attributes that requests name in other ways.
#: An area at the end of a place phrase.
_AREA = re.compile(
    r"\b(?:in|of|from) ((?:the )?(?:rows? \S|block \S|\S+ (?:block|half|quarter|zone)\b).*)$", re.IGNORECASE
)
_NO_PROPERTIES = frozenset({"id", "row", "block"})


def first_planned(candidates: Iterable[str], plan: PlanRequest) -> str:
    """Return the first request that can be planned without a question or a warning; empty if none of the first can."""
    for text in islice(filter(None, dict.fromkeys(candidates)), _MOST_TRIES):
        outcome = plan(text)
        if isinstance(outcome, Planned) and not outcome.task.command.warnings and _captures(outcome):
            return text
    return ""


def _captures(planned: Planned) -> bool:
    return any(node.act is not None for node in walk(planned.task.composition.plan))


def examples(
    parts: Sequence[UnderstoodPart], parsed: ParsedRequest, *, whole: str, topic: Offers, measured: bool
) -> Iterator[str]:
    """Yield requests to suggest, the nearest to what was asked for first.

    Args:
        parts: Parts of the request that were understood.
        parsed: The request.
        whole: The request without what cannot be planned; empty if nothing is left.
        topic: What the request named and the site or the robot lacks; requests about such things come first.
        measured: True if a measured attribute of the trees is nearer to what was asked for than a named one.
    """
    site, robot = parsed.site, parsed.robot
    noun = "vine" if any(word.norm in ("vine", "vines") for word in parsed.words) else "tree"
    requests = [tidy(part.text) for part in parts if part.planned is not None]
    if len(requests) > 1:
        yield " ".join(requests)
    yield from sorted(requests, key=len, reverse=True)[:2]
    things = [thing for part in parts for thing in part.things]
    capture = capture_words(robot.action[things[0].action] if things else robot.actions[0])
    by_rank, by_name = list(_measured(site, noun)), list(_named(site, noun))
    properties = [*by_rank, *by_name] if measured else [*by_name, *by_rank]
    places = [part for part in parts if part.place is not None]
    areas = [part.text for part in places if part.place is not None and part.place.shape == "area"]
    areas += [found[1] for part in places if (found := _AREA.search(part.text))]
    if topic == "properties":
        yield from (f"{capture} {one} in {area}." for area in areas for one in properties[:1])
        yield from (f"{capture} {one}." for one in properties[:1])
    yield whole
    if topic == "places":
        spots = [zone.name for zone in site.zones if zone.kind != "boundary"] + list(site.markers)
        yield from (f"{capture} the 3 {noun}s nearest to the {spot}." for spot in spots[:2])
    for part in sorted(places, key=lambda part: len(part.text), reverse=True):
        yield from (f"{capture} {place}." for place in _places_of(part, noun))
    yield from (f"{capture} every {noun} in {area}." for area in areas)
    if not site.trees:
        named = (f"{'' if zone.name[-1:].isdecimal() else 'the '}{zone.name}" for zone in site.zones_of("zone"))
        yield from (f"{capture} 5 points in {zone}." for zone in named)
        return
    yield from (f"{capture} {place}." for place in (*_rows(site, noun), f"{noun} {site.trees[0].place.id}"))


def _places_of(part: UnderstoodPart, noun: str) -> Iterator[str]:
    """Yield place phrases that name trees at a place that was understood."""
    text = part.text
    if part.place is not None and part.place.shape == "area":
        yield f"every {noun} {text}" if text.lower().startswith("between") else f"every {noun} in {text}"
        yield f"every {noun} in {text}"
    if part.place is not None and not part.place.selector.named_marker:
        bare = text.removeprefix("the ")
        yield text if " " in bare or re.search(r"[0-9]", bare) else f"the {bare} {noun}s"
    else:
        yield f"the 3 {noun}s nearest to {text}"


def _rows(site: Site, noun: str) -> Iterator[str]:
    """Yield a row of the site, with its block if there are several."""
    blocks = site.planting.blocks
    if not blocks or not blocks[0].rows:
        return
    row = blocks[0].rows[min(2, len(blocks[0].rows) - 1)]
    inside = f" of block {blocks[0].name}" if len(blocks) > 1 else ""
    yield f"every {noun} in row {row.name}{inside}"


def _named(site: Site, noun: str) -> Iterator[str]:
    """Yield trees by the values of an attribute."""
    for name, values in site.attributes.items():
        texts = [value for value in values if isinstance(value, str)]
        if name not in _NO_PROPERTIES and 1 < len(texts) <= _MOST_TEXTS:
            yield f"every {texts[0]} {noun}"


def _measured(site: Site, noun: str) -> Iterator[str]:
    """Yield trees by the rank of an attribute, first by one that says how good they are."""
    for name in dict.fromkeys((*qualities(site), *site.attributes)):
        values = site.attributes[name]
        if name not in _NO_PROPERTIES and len(values) > 1 and all(isinstance(value, float) for value in values):
            yield f"the 10 {noun}s with the lowest {' '.join(name_words(name))}"


def capture_words(action: Action) -> str:
    """Return how a request asks for an action, up to its place."""
    words = action.words or (action.name.replace("_", " "),)
    if action.name.startswith("take"):
        return f"Take {article('picture' if 'picture' in words else words[0])} of"
    word = min((word for word in words if "reading" not in word), key=len, default=words[0])
    longer = [one for one in words if one.endswith(f" {word}")]
    word = longer[0] if longer else word
    return f"Measure {word.upper() if re.search(r'[0-9]', word) else word} at"


def tidy(text: str) -> str:
    """Return a clause as a sentence."""
    text = " ".join(text.split())
    text = re.sub(r"\b(\w+) \1\b", r"\1", re.sub(r" (?=[,.;:!?])", "", text)).strip(" ,;:.")
    return f"{text[:1].upper()}{text[1:]}." if text else ""
