"""The number of places that each selector of a plan gives on the site."""

from __future__ import annotations

from fieldhand.errors import PlaceError
from fieldhand.places import selectors as s
from fieldhand.places.context import Context
from fieldhand.site.model import Place, Site
from fieldhand.task import plan as p
from fieldhand.task.frames import Task


class SelectorSizes:
    """Count the places that each selector of a plan names.

    The plan is followed step by step, every branch of it, as if each visit list were visited whole: where the robot is
    then seldom changes how many places a selector names. What has been visited before does, so those sizes are only
    taken for what may be, and what the form of a selector fixes comes first.

    Attributes:
        every: Each size that a part of a selector comes out at.
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
        """Return at how many places the selector of a node comes out; None where that is open, or it has none."""
        return self._of_node.get(node)

    def _follow(self, node: p.Node) -> None:
        """Count the places of a node, and go there."""
        selector = node.selector
        if selector is None:
            self._bind(node, (self._here,))
            return
        self.every.update(n for part in selector.walk() if (n := self._size(part)) is not None)
        found = self._places(selector)
        visited = any(isinstance(part, s.NotVisited) for part in selector.walk())
        self._of_node[node.id] = selector.size.exact if found is None or visited else len(found)
        if found:
            self._bind(node, found)
            self._here = found[-1]
            self._from_here.clear()

    def _bind(self, node: p.Node, found: tuple[Place, ...]) -> None:
        if node.label:
            self._bound[node.label] = found[:1] if node.visits_each else found

    def _size(self, selector: s.Selector) -> int | None:
        found = self._places(selector)
        return selector.size.exact if found is None else len(found)

    def _places(self, selector: s.Selector) -> tuple[Place, ...] | None:
        """Return the places of a selector from where the robot would be; None where it names none."""
        from fieldhand.places.resolution import resolve

        known = self._from_here if selector.relative else self._known
        key = repr(selector)
        if key not in known:
            try:
                known[key] = resolve(selector, self._site, Context(here=self._here, bound=self._bound))
            except PlaceError:
                known[key] = None
        return known[key]
