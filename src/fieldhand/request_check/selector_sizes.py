"""Count the places of each selector of a plan on the site."""

from __future__ import annotations

from fieldhand.errors import PlaceError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task import plan as p
from fieldhand.task.frames import Task


class SelectorSizes:
    """Counts of the places of each selector of a plan.

    The plan is followed on every branch as if each visit list were visited completely. The resulting position of the
    robot seldom changes the number of places; previous visits do, so that sizes that depend on them are only possible
    values, and a size fixed by the form of a selector takes precedence.

    Attributes:
        every: Every size of a part of a selector.
    """

    def __init__(self, task: Task, site: Site) -> None:
        self.every: set[int] = set()
        self._site = site
        self._of_node: dict[str, int | None] = {}
        self._known: dict[str, tuple[Place, ...] | None] = {}
        self._from_here: dict[str, tuple[Place, ...] | None] = {}
        self._here = site.start
        self._bound: dict[str, tuple[Place, ...]] = {}
        for node in p.walk(task.composition.plan):
            self._follow(node)

    def of_node(self, node: str) -> int | None:
        """Return the number of places of a node's selector; None if it is open or there is no selector."""
        return self._of_node.get(node)

    def _follow(self, node: p.Node) -> None:
        """Count the places of a node and continue from there."""
        selector = node.selector
        if selector is None:
            self._bind(node, (self._here,))
            return
        self.every.update(n for part in selector.walk() if (n := self._size(part)) is not None)
        places = self._places(selector)
        visited = any(isinstance(part, s.NotVisited) for part in selector.walk())
        self._of_node[node.id] = selector.size.exact if places is None or visited else len(places)
        if places:
            self._bind(node, places)
            self._here = places[-1]
            self._from_here.clear()

    def _bind(self, node: p.Node, places: tuple[Place, ...]) -> None:
        if node.label:
            self._bound[node.label] = places[:1] if node.visits_each else places

    def _size(self, selector: s.Selector) -> int | None:
        found = self._places(selector)
        return selector.size.exact if found is None else len(found)

    def _places(self, selector: s.Selector) -> tuple[Place, ...] | None:
        """Return the places of a selector from the robot's assumed position; None if it has none."""
        from fieldhand.places.resolution import resolve

        known = self._from_here if selector.relative else self._known
        key = repr(selector)
        if key not in known:
            try:
                known[key] = resolve(selector, self._site, Context(here=self._here, bound=self._bound))
            except PlaceError:
                known[key] = None
        return known[key]
