"""Every way that a mission can go: its conditions either way, its actions inside a try failing or not."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Literal

from fieldhand.forecast import routes
from fieldhand.forecast.steps import Decision, Walk
from fieldhand.forecast.walk import walk
from fieldhand.robot.model import RobotProfile
from fieldhand.site.model import Site
from fieldhand.task import plan
from fieldhand.task.frames import Task

if TYPE_CHECKING:
    from fieldhand.forecast.expected import Expected
    from fieldhand.site.drives import Drives

#: So many walks are looked at, and so many steps in all of them, before the rest is left.
MAX_WALKS = 256
MAX_STEPS = 40_000
#: The walks that come first are worth more: the longest and the shortest are among them.
MAX_STEPS_ALIKE = 200_000
_ALIKE = 4

_Kind = Literal["holds", "fails"]


@dataclass(frozen=True, kw_only=True)
class Branches:
    """What was found.

    Attributes:
        walks: Distinct ones, no two with the same decisions. The first answers every condition with yes.
        complete: Whether these are all there are.
    """

    walks: tuple[Walk, ...]
    complete: bool


def branches(
    task: Task,
    site: Site,
    robot: RobotProfile,
    *,
    drives: Drives | None = None,
    charge_percent: float = 100.0,
    limit: int = MAX_WALKS,
    seed: int | None = None,
) -> Branches:
    """Walk a Task along every branch, within bounds.

    First come the walks on which each condition has the same answer every time; they are the longest and the shortest.
    Then answers are changed one by one, the early ones first, until all were seen or a bound is met. ``seed`` is for
    :func:`fieldhand.forecast.walk.walk`.

    Raises:
        PlaceError: A selector gives nothing on one of the branches; ``where`` names the node.
        DriveFault: A place that cannot be reached on one of them.
        TaskError: A walk comes to more nodes than any mission.
    """
    ways = drives or routes.drives_for(site, robot)
    found: dict[tuple[Decision, ...], Walk] = {}
    kept: dict[object, Expected] = {}
    steps = 0

    def look(script: _Script) -> Walk:
        nonlocal steps
        walked = walk(
            task,
            site,
            robot,
            holds=script.holds,
            fails=script.fails,
            drives=ways,
            charge_percent=charge_percent,
            seed=seed,
            kept=kept,
        )
        steps += len(walked.steps)
        found.setdefault(walked.decisions, walked)
        return walked

    for answers in _alike(task):
        if len(found) < limit and steps < MAX_STEPS_ALIKE:
            look(_Script((), answers))
    if () in found:
        # A walk on which nothing is decided is the only one, however long it is.
        return Branches(walks=tuple(found.values()), complete=True)
    # Each prefix of answers is tried once: a walk proposes to turn each answer that its own prefix did not give.
    open_prefixes: deque[tuple[bool, ...]] = deque([()])
    while open_prefixes and len(found) < limit and steps < MAX_STEPS:
        prefix = open_prefixes.popleft()
        given = tuple(d.answer for d in look(_Script(prefix, {})).decisions)
        open_prefixes.extend((*given[:i], not given[i]) for i in range(len(prefix), len(given)))
    return Branches(walks=tuple(found.values()), complete=not open_prefixes)


class _Script:
    """Answers in their order; after them, what is told for a node, else that it holds, and that it does not fail."""

    def __init__(self, prefix: tuple[bool, ...], told: dict[str, bool]) -> None:
        self._prefix = prefix
        self._told = told
        self._asked = 0

    def holds(self, node_id: str) -> bool:
        return self._answer(node_id, True)

    def fails(self, node_id: str) -> bool:
        return self._answer(node_id, False)

    def _answer(self, node_id: str, default: bool) -> bool:
        position, self._asked = self._asked, self._asked + 1
        return self._prefix[position] if position < len(self._prefix) else self._told.get(node_id, default)


def _alike(task: Task) -> Iterator[dict[str, bool]]:
    """Told answers for the first few conditions, in every combination; the others hold in all, or in none."""
    asked = [n.id for n in plan.walk(task.composition.plan) if plan.condition_of(n) is not None]
    some, others = asked[:_ALIKE], asked[_ALIKE:]
    for answers in product((True, False), repeat=len(some)):
        for default in (True, False) if others else (True,):
            yield {**dict.fromkeys(others, default), **dict(zip(some, answers, strict=True))}
