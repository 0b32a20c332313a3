"""The order in which places are visited, shared by preview and robot, so the path drawn is the path driven."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fieldhand.errors import PlaceError
from fieldhand.forecast.headings import cameras_of, in_rows
from fieldhand.language import joined, message
from fieldhand.orienteering.shortest_order import shortest_order
from fieldhand.places.context import Context
from fieldhand.places.selector import Selector
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Place, Site
from fieldhand.task import plan
from fieldhand.task.frames import Constraints, Task
from fieldhand.task.plan import AnyOrder, ForEach, Node

if TYPE_CHECKING:
    from fieldhand.site.drives import Drives


#: Maximum number of cached visiting orders per site.
_ORDERS = 64


def drives_for(site: Site, robot: RobotProfile, constraints: Constraints | None = None) -> Drives:
    """Return the drives of a robot on a site, with a clearance of half its width from tree lines and keep-outs.

    With the constraints of a mission, they keep away from what it avoids. Equal arguments give the same object, which
    caches the drives it has found.

    Raises:
        PlaceError: What the mission avoids cannot be found on the site.
    """
    from fieldhand.site.drives import Drives

    key: tuple[object, ...] = ("drives", robot.width_m, robot.standoff_m)
    known = site.cache.get(key)
    if not isinstance(known, Drives):
        known = site.cache[key] = Drives(site, robot.width_m / 2, robot.standoff_m)
    if constraints is None or not (constraints.avoid or constraints.only_gates):
        return known
    from fieldhand.forecast.closed_ground import closed_ground

    avoid = tuple((one.places, one.distance_m) for one in constraints.avoid)
    key = ("closed drives", robot.width_m, robot.standoff_m, avoid, tuple(one.gate for one in constraints.only_gates))
    closed = site.cache.get(key)
    if not isinstance(closed, Drives):
        ground = closed_ground(constraints, known)
        closed = site.cache[key] = Drives(site, known.clearance_m, known.standoff_m, closed=ground)
    return closed


def start_place(drives: Drives) -> Place:
    """Return the place where a mission starts, with the robot's stand there."""
    return drives.stands((drives.site.start,))[0]


def with_stands(drives: Drives, here: Place, places: Sequence[Place]) -> tuple[Place, ...]:
    """Return the places with the robot's stand at each; it stays put for the current place."""
    stands = here.stand is not None and here.kind != "point"
    return drives.stands([_stay(here, p) if stands and here.covers(p) else p for p in places], here)


def _stay(here: Place, place: Place) -> Place:
    """Return a place with the stand at which the robot is already."""
    return replace(place, stand=here.stand)


def reachable(drives: Drives, places: Sequence[Place]) -> tuple[tuple[Place, ...], tuple[Place, ...]]:
    """Return the reachable places and the others."""
    closed = drives.problems(places)
    return (
        tuple(p for p, reason in zip(places, closed, strict=True) if not reason),
        tuple(p for p, reason in zip(places, closed, strict=True) if reason),
    )


def order_visits(drives: Drives, here: Place, places: Sequence[Place], home: Place | None) -> tuple[int, ...]:
    """Return the order of ``places`` with the least driving from ``here``, and on to ``home`` if given.

    Args:
        drives: Drives between places of the site.
        here: The robot's place.
        places: Places to visit in any order, with stands (:func:`with_stands`).
        home: Place visited afterwards; None if unknown, or if other work comes first.

    Returns:
        Indices into ``places``, each once.

    Raises:
        DriveFault: A place cannot be reached.
    """
    if not places:
        return ()
    if len(places) == 1:
        return (0,)
    around = [here, *places] if home is None else [here, *places, home]
    # All branches of a forecast, and then the robot, need the same order.
    known = drives.site.cache.setdefault("orders", {})
    assert isinstance(known, dict)  # noqa: S101  nobody else keeps anything there
    key = (drives, home is None, tuple(p.stand or p.xy for p in around))
    if key not in known:
        lengths = np.asarray(drives.lengths(around), dtype=np.float64)
        order = shortest_order(lengths, 0, None if home is None else len(around) - 1)
        while len(known) >= _ORDERS:
            del known[next(iter(known))]
        known[key] = tuple(v - 1 for v in order if 1 <= v <= len(places))
    found: tuple[int, ...] = known[key]
    return found


def visits_in_order(
    node: ForEach,
    drives: Drives,
    here: Place,
    places: Sequence[Place],
    home: Place | None,
    robot: RobotProfile | None = None,
) -> tuple[Place, ...]:
    """Return the places that a for-each drives to, in order, each with its stand.

    With ``at_most``, a given order is truncated; with a free order, places are selected by nearest neighbour. A robot
    with a camera on one side that does not turn on the spot then goes along each row in one direction.
    """
    kept = list(with_stands(drives, here, places))
    if node.at_most is not None and node.at_most < len(kept):
        if node.order == "best" and not node.optional:
            chain = _nearest_neighbours(np.asarray(drives.lengths([here, *kept])), node.at_most)
            kept = [kept[i] for i in chain]
        elif not node.optional:
            kept = kept[: node.at_most]
    if node.order == "given":
        return tuple(kept)
    ordered = tuple(kept[i] for i in order_visits(drives, here, kept, home))
    camera = None if robot is None or robot.turn_deg_s is not None else cameras_of(node, robot).get(node.id)
    return in_rows(drives, ordered, camera) if camera is not None and camera.lateral else ordered


def steps_in_order(node: AnyOrder, site: Site, drives: Drives, context: Context, home: Place | None) -> tuple[int, ...]:
    """Return the order of an any-order set's steps with the least driving between where they begin.

    The end of a step does not count, and a step with several places begins at the nearest of them. Steps without a
    place of their own, or whose first place readings determine, come last in the given order, as do optional ones that
    cannot be reached.

    Raises:
        PlaceError: A step's place cannot be resolved.
        DriveFault: A place cannot be reached.
    """
    begins: dict[int, Place] = {}
    for index, step in enumerate(node.steps):
        places = first_places(step, site, context)
        if step.is_optional_step:
            places, _ = reachable(drives, places)
        if places:
            begins[index] = min(places, key=lambda p: (p.x - context.here.x) ** 2 + (p.y - context.here.y) ** 2)
    placed = list(begins)
    order = order_visits(drives, context.here, [begins[i] for i in placed], home)
    return (*(placed[i] for i in order), *(i for i in range(len(node.steps)) if i not in begins))


def first_places(node: Node, site: Site, context: Context) -> tuple[Place, ...]:
    """Return the places of a node's first selector; empty if the node stays at the current place, or if the readings of
    the mission determine them.
    """
    from fieldhand.places.resolution import resolve

    for inner in plan.walk(node):
        selector = inner.selector
        if selector is None:
            continue
        if selector.decided_by_readings:
            return ()
        try:
            return resolve(selector, site, context)
        except PlaceError as error:
            raise at_node(error, inner) from error
    return ()


def place_of(node: Node, selector: Selector, site: Site, context: Context) -> Place:
    """Return the single place of a selector.

    Raises:
        PlaceError: It gives no place or several; ``where`` names the node.
    """
    from fieldhand.places.resolution import resolve_one

    try:
        return resolve_one(selector, site, context)
    except PlaceError as error:
        raise at_node(error, node) from error


def places_of(node: Node, selector: Selector, site: Site, context: Context) -> tuple[Place, ...]:
    """Return the places of a selector, at least one.

    Raises:
        PlaceError: It gives none; ``where`` names the node.
    """
    from fieldhand.places.resolution import resolve

    try:
        places = resolve(selector, site, context)
    except PlaceError as error:
        raise at_node(error, node) from error
    if not places:
        raise PlaceError(
            message("no place on this site is selected"),
            where=node.id,
            advice=message("check what the words select"),
        )
    return tuple(places)


def at_node(error: PlaceError, node: Node) -> PlaceError:
    """Return the error, located at the plan node that names the place."""
    if error.where == node.id or error.where.startswith(f"{node.id}, "):
        return error
    where = joined(", ", (node.id, error.where)) if error.where else node.id
    return type(error)(error.what, where=where, advice=error.advice)


def ends_plan(root: Node, node_id: str) -> bool:
    """Return True if nothing follows a node in the plan."""
    way = way_to(root, node_id)
    return bool(way) and not any(outer.goes_on_after(inner) for outer, inner in itertools.pairwise(way))


def way_to(root: Node, node_id: str) -> tuple[Node, ...]:
    """Return the nodes from the root of a plan to a node, both included; empty if the node does not exist."""
    if root.id == node_id:
        return (root,)
    for child in root.children:
        way = way_to(child, node_id)
        if way:
            return (root, *way)
    return ()


def home_if_last(task: Task, site: Site, node_id: str, here: Place) -> Place | None:
    """Return home if a node ends the plan and the mission ends there, else None.

    This is the rule by which :func:`order_visits` gets its ``home``.
    """
    if task.composition.nominal == "stay" or not ends_plan(task.composition.plan, node_id):
        return None
    return site.home(task.composition.nominal, here)


def _nearest_neighbours(lengths: np.ndarray[tuple[int, ...], np.dtype[np.float64]], count: int) -> list[int]:
    """Return indices by nearest neighbour, starting from the first row."""
    far = lengths.copy()
    far[:, 0] = np.inf
    at, chain = 0, []
    for _ in range(count):
        at = int(far[at].argmin())
        far[:, at] = np.inf
        chain.append(at - 1)
    return chain
