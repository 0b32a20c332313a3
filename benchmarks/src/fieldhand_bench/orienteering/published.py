"""Published results on the graphs graph20, graph30 and graph40: budget 2, failure probability 0.1."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Published:
    """A published result: mean reward of the missions that did not fail, and the fraction that failed."""

    solver: str
    graph: str
    reward: float
    failures: float


def _rows(solver: str, rewards: tuple[float, ...], failures: tuple[float, ...]) -> tuple[Published, ...]:
    graphs = ("graph20", "graph30", "graph40")
    return tuple(
        Published(solver=solver, graph=g, reward=r, failures=f)
        for g, r, f in zip(graphs, rewards, failures, strict=True)
    )


PUBLISHED = (
    *_rows("GNN tree search", (2.092, 5.592, 5.785), (0.11, 0.09, 0.07)),
    *_rows("language model", (2.095, 2.531, 2.710), (0.04, 0.10, 0.13)),
    *_rows("MILP 10 min", (3.414, 6.973, 8.843), (0.12, 0.10, 0.10)),
)


def published_for(graph: str, budget: float, failure_probability: float) -> tuple[Published, ...]:
    """Return the published results for a graph; none for other budgets or probabilities."""
    if abs(budget - 2.0) > 1e-9 or abs(failure_probability - 0.1) > 1e-9:
        return ()
    return tuple(row for row in PUBLISHED if row.graph == graph)
