"""Requests to begin with: examples that name what this site has and ask for what this robot can do."""

from __future__ import annotations

from collections.abc import Iterator

from fieldhand.planning.english.naming import name_words
from fieldhand.planning.grammar.places.vague import qualities
from fieldhand.planning.planner import Planned, Planner
from fieldhand.planning.refusals.examples import capture_words
from fieldhand.robot.model import Action, RobotProfile
from fieldhand.site.model import Site

#: Examples returned at most, and requests planned at most to find them.
_MOST, _MOST_TRIES = 6, 14
#: Imperatives of work that Spanish requests name.
_SPANISH_WORK = {"mow": "Siega", "spray": "Pulveriza"}
_NO_KINDS = frozenset({"id", "row", "block", "kind", "marker-symbol"})


def site_examples(site: Site, robot: RobotProfile, planner: Planner, *, language: str = "en") -> tuple[str, ...]:
    """Return requests that are planned on a site with a robot, without a question or a warning.

    Args:
        site: Site whose rows, attributes and zones the requests name.
        robot: Robot whose actions they ask for.
        planner: Planner that has to understand them.
        language: Language of the requests; English where there are none in it.
    """
    candidates = {"es": _spanish}.get(language, _english)(site, robot)
    found: list[str] = []
    for tries, text in enumerate(dict.fromkeys(candidates)):
        if len(found) == _MOST or tries == _MOST_TRIES:
            break
        outcome = planner.plan(text, site, robot)
        if isinstance(outcome, Planned) and not outcome.task.command.warnings:
            found.append(text)
    return tuple(found)


def _english(site: Site, robot: RobotProfile) -> Iterator[str]:
    noun = "vine" if "vine" in site.attributes.get("kind", ()) else "tree"
    pictures = [action for action in robot.actions if action.name.startswith("take")]
    readings = [action for action in robot.actions if action.measures]
    capture = capture_words((pictures or list(robot.actions))[0])
    block = site.planting.blocks[0].name if len(site.planting.blocks) > 1 else ""
    inside = f" of block {block}" if block else ""
    yield f"{capture} the four corner {noun}s, in any order."
    for action in _with_implement(robot):
        yield f"{(action.verbs or action.words or (action.name,))[0].capitalize()} between rows 2 and 4{inside}."
    for reading in readings:
        if pictures and reading not in pictures:
            yield f"{capture_words(reading)} the middle {noun}. If it is low, take 2 pictures of nearby {noun}s."
    yield f"{capture} every {noun} in row {_row(site)}{inside}."
    yield from (f"{capture} every {value} {noun}." for value in _texts(site)[:1])
    yield from (f"{capture} the 10 {noun}s with the lowest {words}." for words in _ranks(site)[:1])
    yield f"{capture} as many {noun}s as you can within 300 meters."
    yield from (
        f"{capture_words(one)} the 3 {noun}s nearest to the {spot}." for one in readings[:1] for spot in _spots(site)
    )
    yield from (f"{capture} 5 points in the {zone.name}." for zone in site.zones_of("zone"))


def _spanish(site: Site, robot: RobotProfile) -> Iterator[str]:
    if "vine" in site.attributes.get("kind", ()):
        the, every, many, middle, near, old = "las", "cada vid", "vides", "la vid", "cercanas", "viejas"
    else:
        the, every, many, middle, near, old = "los", "cada árbol", "árboles", "el árbol", "cercanos", "viejos"
    block = site.planting.blocks[0].name if len(site.planting.blocks) > 1 else ""
    inside = f" del bloque {block}" if block else ""
    can_read = {measured for action in robot.actions for measured in action.measures}
    yield f"Toma una foto de {the} cuatro {many} de las esquinas."
    for action in _with_implement(robot):
        if action.name in _SPANISH_WORK:
            yield f"{_SPANISH_WORK[action.name]} entre las filas 2 y 4{inside}."
    if "co2" in can_read:
        yield f"Mide el CO2 en {middle} del medio. Si es bajo, toma 2 fotos de {many} {near}."
    yield f"Toma una foto de {every} de la fila {_row(site)}{inside}."
    yield from (f"Toma una foto de {the} 10 {many} con menor {words}." for words in _ranks(site)[:1])
    yield f"Toma fotos de {the} 5 {many} más {old}."
    yield f"Fotografía tantos {many} como puedas en 300 metros."
    yield f"Fotografía {every} de la mitad norte."


def _with_implement(robot: RobotProfile) -> list[Action]:
    return [action for action in robot.actions if action.implement is not None]


def _row(site: Site) -> str:
    """Return the name of a row of the first block, the third if it has as many."""
    rows = site.planting.blocks[0].rows if site.planting.blocks else ()
    return str(rows[min(2, len(rows) - 1)].name) if rows else "1"


def _texts(site: Site) -> list[str]:
    """Return a value of each attribute that divides the plants into a few kinds."""
    kinds = (value for name, value in site.attributes.items() if name not in _NO_KINDS)
    texts = ([value for value in values if isinstance(value, str)] for values in kinds)
    return [values[0] for values in texts if 1 < len(values) <= 20]


def _ranks(site: Site) -> list[str]:
    """Return the words of the attributes that rank the plants, first of those that say how good a plant is."""
    numbers = {
        name
        for name, values in site.attributes.items()
        if name not in _NO_KINDS and len(values) > 1 and all(isinstance(value, float) for value in values)
    }
    return [
        " ".join(name_words(name)) for name in dict.fromkeys((*qualities(site), *site.attributes)) if name in numbers
    ]


def _spots(site: Site) -> Iterator[str]:
    """Yield the names of places that requests can refer to."""
    yield from (zone.name for zone in site.zones if zone.kind != "boundary" and zone.name)
    yield from site.markers
