"""Names of the readings that a plan uses as a series: only those have to be kept."""

from __future__ import annotations

from fieldhand.task import conditions
from fieldhand.task.plan import Node, walk


def collected(plan: Node) -> frozenset[str]:
    """Return the readings of which a condition or a selector of the plan needs all that were taken."""
    found: set[str] = set()
    for node in walk(plan):
        if node.tested is not None:
            found |= conditions.series(node.tested)
        if node.selector is not None:
            found |= {part.by_series[0] for part in node.selector.walk() if part.by_series is not None}
    return frozenset(found)
