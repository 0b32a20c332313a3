"""A contradiction between a plan and the request that it was made from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

MismatchKind = Literal[
    "count", "sensor", "threshold", "condition", "limit", "place", "side", "attribute", "order", "return", "distance",
    "number", "unheld",
]  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class PlanMismatch:
    """One contradiction.

    Attributes:
        kind: Kind of contradiction.
        what: A sentence without a full stop: what the request says and what the plan does.
        node: The node of the plan; empty where something is missing from it.
    """

    kind: MismatchKind
    what: str
    node: str = ""
